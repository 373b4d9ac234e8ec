//! Bundles of a study: what a machine needs to make some of its replicates, and what it gives back.

use crate::failure::raised_as;
use crate::state::full_path;
use crate::watched::{Watch, watched};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use spunlaid::case::Case;
use spunlaid::error::Error;
use spunlaid::input::{
    Unread, parse_case, parse_spinline, parse_web_and_cases, write_case, write_spinline, write_web,
};
use spunlaid::layers::{LaydownSource, WebSpec};
use spunlaid::observe::MEASURES;
use spunlaid::study::{Batch, Experiment, Point, Record, ReplicateOutcome, fly_bundle as fly};
use spunlaid_results::Failure;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

/// A point of a bundle: its index in the study, the text of its case, or of its web with those of the cases that it flies and the
/// numbers of their layers, a checksum over all of it, and the replicates to make, from the first to before the last.
pub(crate) type BundlePart = (u64, String, Cases, u32, u64, u64);
/// Layers of a web, and the texts of their cases; None for a case.
pub(crate) type Cases = Option<Vec<(usize, String)>>;

/// Columns of the records before the numbers: point, replicate, whether the fibre was lost. Of a lost fibre the numbers are the
/// node and the time.
const HEAD: usize = 3;

/// What a machine needs to make batches of points.
pub(crate) fn parts(points: &[Point], batches: &[Batch]) -> Vec<BundlePart> {
    let part = |Batch { point, replicates: Range { start, end } }: &Batch| {
        let (text, cases, sum) = packed(&points[*point].experiment);
        (*point as u64, text, cases, sum, *start, *end)
    };
    batches.iter().map(part).collect()
}

/// The text of what is computed, with the texts of the cases that it flies, and a checksum over all of it.
pub(crate) fn packed(experiment: &Experiment) -> (String, Cases, u32) {
    let experiment = make_portable(experiment);
    let (text, cases) = match &experiment {
        Experiment::Case(case) => (write_case(case), None),
        Experiment::Spinline(spec) => (write_spinline(spec), None),
        Experiment::Web(web) => {
            (write_web(web), Some(flown(web).map(|(layer, case)| (layer, write_case(case))).collect()))
        }
    };
    (text, cases, checksum(&experiment))
}

/// What [`packed`] has packed; None if it is another one on this machine.
pub(crate) fn unpacked(text: &str, cases: &Cases, sum: u32) -> Result<Option<Experiment>, Error> {
    Ok(Some(read(text, cases)?).filter(|experiment| checksum(experiment) == sum))
}

/// The error of a machine on which something is another one than on the client.
///
/// * `what` – that is another one: "point 3: its case or web"
pub(crate) fn another(py: Python<'_>, what: &str) -> PyErr {
    let text = format!(
        "{what} is another one on this machine, because a file that it names has another content here, or \
         this machine has another version of spunlaid; give all machines the same"
    );
    raised_as(py, "ClusterError", text)
}

/// The same on any machine that has the files: full paths of files, and names in place of the paths of cases, which are sent
/// along.
fn make_portable(experiment: &Experiment) -> Experiment {
    match experiment {
        Experiment::Case(case) => Experiment::Case(case.with_files_at(full_path)),
        Experiment::Spinline(spec) => Experiment::Spinline(Box::new(spec.with_files_at(full_path))),
        Experiment::Web(web) => {
            let mut web = web.clone();
            for (number, layer) in web.layers.iter_mut().enumerate() {
                match &mut layer.source {
                    LaydownSource::Case { path, case } => {
                        *path = case_file_name(number);
                        *case = Arc::new(case.with_files_at(full_path));
                    }
                    LaydownSource::Results { folder, .. } => {
                        *folder = full_path(folder);
                    }
                    LaydownSource::Surrogate(_) => {}
                }
            }
            Experiment::Web(web)
        }
    }
}

/// The name of the case of a layer that is sent along.
fn case_file_name(layer: usize) -> PathBuf {
    PathBuf::from(format!("layer-{}.toml", layer + 1))
}

/// The cases that a web flies, with the numbers of their layers.
fn flown(web: &WebSpec) -> impl Iterator<Item = (usize, &Case)> {
    web.layers.iter().enumerate().filter_map(|(number, layer)| match &layer.source {
        LaydownSource::Case { case, .. } => Some((number, &**case)),
        _ => None,
    })
}

/// What was sent, read again. Tensions of flights were found before it was sent, and are numbers.
fn read(text: &str, cases: &Cases) -> Result<Experiment, Error> {
    let Some(cases) = cases else {
        // A case has a fibre; a spinline alone has none.
        if !text.contains("\n[fibre]\n") {
            let read = parse_spinline(text, "spinline.toml", &[]).map_err(Unread::refuse)?;
            return Ok(Experiment::Spinline(Box::new(read.spec)));
        }
        return Ok(Experiment::Case(parse_case(text, "case.toml", &[]).map_err(Unread::refuse)?.0));
    };
    let cases = cases.iter().map(|(layer, text)| (case_file_name(*layer), text.clone())).collect();
    let read = parse_web_and_cases(text, "web.toml", cases);
    Ok(Experiment::Web(read.map_err(Unread::refuse)?.spec))
}

/// A checksum over all that the results depend on, also over the content of files.
fn checksum(experiment: &Experiment) -> u32 {
    crc32fast::hash(format!("{experiment:?}").as_bytes())
}

/// Flies a bundle. See Study.bundle, which makes it.
#[pyfunction]
#[pyo3(signature = (parts, sides, threads = 1))]
pub(crate) fn fly_bundle(
    py: Python<'_>,
    parts: Vec<BundlePart>,
    sides: Vec<f64>,
    threads: usize,
) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let watch = Watch::default();
    let flown = watched(py, &watch, None, || {
        let mut points: Vec<Point> = Vec::new();
        let mut known: BTreeMap<(&str, &Cases), usize> = BTreeMap::new();
        let mut batches = Vec::new();
        for (number, text, cases, sum, start, end) in &parts {
            let point = match known.get(&(text.as_str(), cases)) {
                Some(point) => *point,
                None => {
                    let Some(experiment) = unpacked(text, cases, *sum)? else { return Ok(Err(*number)) };
                    known.insert((text, cases), points.len());
                    points.push(Point { values: Vec::new(), experiment });
                    points.len() - 1
                }
            };
            batches.push(Batch { point, replicates: *start..*end });
        }
        Ok::<_, Failure>(Ok((fly((&points, &sides), &batches, watch.run_control(Some(threads)))?, batches)))
    })?;
    let (records, batches) =
        flown.map_err(|number| another(py, &format!("point {}: its case or web", number + 1)))?;
    // Webs are never lost, so their first record has all their numbers.
    let numbers =
        records.first().and_then(|record| record.outcome.measured()).map_or(MEASURES.len(), <[f64]>::len);
    // Two points may have the same case, so a record is found by its point here and its replicate there.
    let mut rows = Vec::with_capacity(records.len() * (HEAD + numbers));
    let mut at: BTreeMap<(usize, u64), Vec<u64>> = BTreeMap::new();
    for (batch, (number, ..)) in batches.iter().zip(&parts) {
        for replicate in batch.replicates.clone() {
            at.entry((batch.point, replicate)).or_default().push(*number);
        }
    }
    for record in &records {
        let owner = at.get_mut(&(record.point as usize, record.replicate)).and_then(Vec::pop);
        let (lost, values) = match &record.outcome {
            ReplicateOutcome::Measured(values) => (0.0, values.to_vec()),
            ReplicateOutcome::Lost { node, time } => {
                let mut values = vec![0.0; numbers];
                (values[0], values[1]) = (*node as f64, *time);
                (1.0, values)
            }
        };
        rows.extend([owner.unwrap_or(record.point) as f64, record.replicate as f64, lost]);
        rows.extend(values);
    }
    PyArray1::from_vec(py, rows).reshape([records.len(), HEAD + numbers])
}

/// The records of [`fly_bundle`], with so many numbers each.
pub(crate) fn records(rows: &PyReadonlyArray2<'_, f64>, numbers: usize) -> PyResult<Vec<Record>> {
    let rows = rows.as_array();
    let columns = HEAD + numbers;
    if rows.ncols() != columns {
        return Err(PyValueError::new_err(format!("records have {columns} columns, not {}", rows.ncols())));
    }
    let record = |row: numpy::ndarray::ArrayView1<'_, f64>| {
        let outcome = if row[2] == 0.0 {
            ReplicateOutcome::Measured((0..numbers).map(|i| row[HEAD + i]).collect())
        } else {
            ReplicateOutcome::Lost { node: row[3] as u64, time: row[4] }
        };
        Record { point: row[0] as u64, replicate: row[1] as u64, outcome }
    };
    Ok(rows.rows().into_iter().map(record).collect())
}
