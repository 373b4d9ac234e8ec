//! Bundles of a study: what a machine needs to make some of its replicates, and what it gives back.

use crate::failure::raised_as;
use crate::source::full_path;
use crate::watched::{Watch, watched};
use pyo3::prelude::*;
use spunlaid::experiment::study::fly_bundle as fly;
use spunlaid::experiment::{Batch, Experiment, Point, Record, ReplicateOutcome};
use spunlaid::ground::Error;
use spunlaid::input::{read_case, read_spinline, read_web, write_experiment};
use spunlaid::simulation::LaydownSource;
use spunlaid_results::Failure;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;

/// What is computed, as any machine reads it: what it is, the text of its file, and a checksum over all of it.
pub(crate) type Packed = (String, String, u32);
/// A point of a bundle: its index in the study, what it is, the text of its file, a checksum over all of it,
/// and the replicates to make, from the first to before the last.
pub(crate) type BundlePart = (u64, String, String, u32, u64, u64);

/// What a machine gives back of a replicate: its point and its number, its measures, and of a fibre that was lost,
/// which has none, node and time.
pub(crate) type Row = (u64, u64, Vec<f64>, Option<(u64, f64)>);

/// What a machine needs to make batches of points.
pub(crate) fn parts(points: &[Point], batches: &[Batch]) -> Vec<BundlePart> {
    let part = |Batch { point, replicates: Range { start, end } }: &Batch| {
        let (noun, text, sum) = packed(&points[*point].experiment);
        (*point as u64, noun, text, sum, *start, *end)
    };
    batches.iter().map(part).collect()
}

/// What is computed, for another machine.
fn packed(experiment: &Experiment) -> Packed {
    let experiment = make_portable(experiment);
    (experiment.noun().to_owned(), write_experiment(&experiment), checksum(&experiment))
}

/// What [`packed`] has packed; None if it is another one on this machine.
fn unpacked(noun: &str, text: &str, sum: u32) -> Result<Option<Experiment>, Error> {
    Ok(Some(read(noun, text)?).filter(|experiment| checksum(experiment) == sum))
}

/// The error of a machine on which something is another one than on the client.
///
/// * `what` – that is another one: "point 3: its case or web"
fn another(py: Python<'_>, what: &str) -> PyErr {
    let text = format!(
        "{what} is another one on this machine, because a file that it names has another content here, or \
         this machine has another version of spunlaid; give all machines the same"
    );
    raised_as(py, "ClusterError", text)
}

/// The same on any machine that has the files, which have full paths.
fn make_portable(experiment: &Experiment) -> Experiment {
    match experiment {
        Experiment::Case(case) => case.with_files_at(full_path).into(),
        Experiment::Spinline(spec) => Experiment::Spinline(Box::new(spec.with_files_at(full_path))),
        Experiment::Web(web) => {
            let mut web = web.with_files_at(full_path);
            for layer in &mut web.layers {
                // It is read from this file.
                if let LaydownSource::Case { path, .. } = &mut layer.source {
                    *path = PathBuf::from(WEB);
                }
            }
            web.into()
        }
    }
}

/// What the file of a web is called that is sent along.
const WEB: &str = "web.toml";

/// What was sent, read again. Tensions of flights were found before it was sent, and are numbers.
fn read(noun: &str, text: &str) -> Result<Experiment, Error> {
    Ok(match noun {
        "web" => read_web((text, WEB), &[])?.spec.into(),
        "spinline" => {
            let read = read_spinline((text, "spinline.toml"), &[])?;
            Experiment::Spinline(Box::new(read.spec))
        }
        _ => read_case((text, "case.toml"), &[])?.0.into(),
    })
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
) -> PyResult<Vec<Row>> {
    let watch = Watch::default();
    let simulated = watched(py, &watch, None, || {
        let mut points: Vec<Point> = Vec::new();
        let mut known: BTreeMap<&str, usize> = BTreeMap::new();
        let mut batches = Vec::new();
        for (number, noun, text, sum, start, end) in &parts {
            let point = match known.get(text.as_str()) {
                Some(point) => *point,
                None => {
                    let Some(experiment) = unpacked(noun, text, *sum)? else { return Ok(Err(*number)) };
                    known.insert(text, points.len());
                    points.push(Point { values: Vec::new(), experiment });
                    points.len() - 1
                }
            };
            batches.push(Batch { point, replicates: *start..*end });
        }
        Ok::<_, Failure>(Ok((fly(&points, &sides, &batches, watch.control(Some(threads)))?, batches)))
    })?;
    let (records, batches) =
        simulated.map_err(|number| another(py, &format!("point {}: its case or web", number + 1)))?;
    // Two points may have the same case, so a record is found by its point here and its replicate there.
    let mut at: BTreeMap<(usize, u64), Vec<u64>> = BTreeMap::new();
    for (batch, (number, ..)) in batches.iter().zip(&parts) {
        for replicate in batch.replicates.clone() {
            at.entry((batch.point, replicate)).or_default().push(*number);
        }
    }
    let row = |Record { point, replicate, outcome }: Record| {
        let owner = at.get_mut(&(point as usize, replicate)).and_then(Vec::pop).unwrap_or(point);
        match outcome {
            ReplicateOutcome::Measured(values) => (owner, replicate, values.to_vec(), None),
            ReplicateOutcome::Lost { node, time } => (owner, replicate, Vec::new(), Some((node, time))),
        }
    };
    Ok(records.into_iter().map(row).collect())
}

/// A record of [`fly_bundle`].
pub(crate) fn record((point, replicate, values, lost): Row) -> Record {
    let outcome = match lost {
        Some((node, time)) => ReplicateOutcome::Lost { node, time },
        None => ReplicateOutcome::Measured(values.into_iter().collect()),
    };
    Record { point, replicate, outcome }
}
