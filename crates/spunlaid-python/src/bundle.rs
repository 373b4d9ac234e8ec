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

/// A point of a bundle, as any machine reads it; a dictionary in Python.
#[derive(FromPyObject, IntoPyObject)]
pub(crate) struct BundlePart {
    /// Its index in the study.
    #[pyo3(item)]
    point: u64,
    /// What is computed: a case, a web or a spinline.
    #[pyo3(item)]
    noun: String,
    /// The text of its file.
    #[pyo3(item)]
    text: String,
    /// See [`checksum`].
    #[pyo3(item)]
    checksum: u32,
    /// The first of its replicates.
    #[pyo3(item)]
    first: u64,
    /// The one after the last of them.
    #[pyo3(item)]
    end: u64,
}

/// What a machine gives back of a replicate; a dictionary in Python.
#[derive(FromPyObject, IntoPyObject)]
pub(crate) struct ComputedReplicate {
    #[pyo3(item)]
    point: u64,
    #[pyo3(item)]
    replicate: u64,
    /// Its measures; none of a lost fibre.
    #[pyo3(item)]
    values: Vec<f64>,
    /// Node and time of a fibre that was lost.
    #[pyo3(item)]
    lost: Option<(u64, f64)>,
}

/// What a machine needs to make batches of points.
pub(crate) fn parts(points: &[Point], batches: &[Batch]) -> Vec<BundlePart> {
    let part = |Batch { point, replicates: Range { start, end } }: &Batch| {
        let experiment = make_portable(&points[*point].experiment);
        BundlePart {
            point: *point as u64,
            noun: experiment.noun().to_owned(),
            text: write_experiment(&experiment),
            checksum: checksum(&experiment),
            first: *start,
            end: *end,
        }
    };
    batches.iter().map(part).collect()
}

/// What [`parts`] has packed; None if it is another one on this machine.
fn unpacked(part: &BundlePart) -> Result<Option<Experiment>, Error> {
    Ok(Some(read(&part.noun, &part.text)?).filter(|experiment| checksum(experiment) == part.checksum))
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
) -> PyResult<Vec<ComputedReplicate>> {
    let watch = Watch::default();
    let simulated = watched(py, &watch, None, || {
        let mut points: Vec<Point> = Vec::new();
        let mut known: BTreeMap<&str, usize> = BTreeMap::new();
        let mut batches = Vec::new();
        for part in &parts {
            let point = match known.get(part.text.as_str()) {
                Some(point) => *point,
                None => {
                    let Some(experiment) = unpacked(part)? else { return Ok(Err(part.point)) };
                    known.insert(&part.text, points.len());
                    points.push(Point { values: Vec::new(), experiment });
                    points.len() - 1
                }
            };
            batches.push(Batch { point, replicates: part.first..part.end });
        }
        Ok::<_, Failure>(Ok((fly(&points, &sides, &batches, watch.control(Some(threads)))?, batches)))
    })?;
    let (records, batches) =
        simulated.map_err(|number| another(py, &format!("point {}: its case or web", number + 1)))?;
    // Two points may have the same case, so a record is found by its point here and its replicate there.
    let mut at: BTreeMap<(usize, u64), Vec<u64>> = BTreeMap::new();
    for (batch, part) in batches.iter().zip(&parts) {
        for replicate in batch.replicates.clone() {
            at.entry((batch.point, replicate)).or_default().push(part.point);
        }
    }
    let row = |Record { point, replicate, outcome }: Record| {
        let point = at.get_mut(&(point as usize, replicate)).and_then(Vec::pop).unwrap_or(point);
        let (values, lost) = match outcome {
            ReplicateOutcome::Measured(values) => (values.to_vec(), None),
            ReplicateOutcome::Lost { node, time } => (Vec::new(), Some((node, time))),
        };
        ComputedReplicate { point, replicate, values, lost }
    };
    Ok(records.into_iter().map(row).collect())
}

/// A record of [`fly_bundle`].
pub(crate) fn record(computed: ComputedReplicate) -> Record {
    let ComputedReplicate { point, replicate, values, lost } = computed;
    let outcome = match lost {
        Some((node, time)) => ReplicateOutcome::Lost { node, time },
        None => ReplicateOutcome::Measured(values.into_iter().collect()),
    };
    Record { point, replicate, outcome }
}
