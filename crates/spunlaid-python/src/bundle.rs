//! Bundles of a study: what a machine needs to fly some of its fibres, and what it gives back.

use crate::failure::raised_as;
use crate::watched::{Watch, watched};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use spunlaid::case::Case;
use spunlaid::ensemble::Computing;
use spunlaid::input::{parse_case, write_case};
use spunlaid::lanes::Isa;
use spunlaid::observe::MEASURES;
use spunlaid::study::{Batch, Landing, Point, Record, fly_bundle as fly};
use spunlaid_results::Failure;
use std::collections::BTreeMap;
use std::ops::Range;

/// A point of a bundle: its index in the study, the text of its case, the checksum of the case, and the replicates to fly,
/// from the first to before the last.
pub(crate) type Part = (u64, String, u32, u64, u64);

/// Columns of the records: point, replicate, whether the fibre was lost, then the measures; of a lost fibre the node and
/// the time.
const COLUMNS: usize = 3 + MEASURES.len();

/// What a machine needs to fly batches of points.
pub(crate) fn parts(points: &[Point], batches: &[Batch]) -> Vec<Part> {
    let part = |Batch { point, replicates: Range { start, end } }: &Batch| {
        let case = crate::state::absolute(&points[*point].case);
        (*point as u64, write_case(&case), checksum(&case), *start, *end)
    };
    batches.iter().map(part).collect()
}

/// A checksum over all that a fibre's results depend on, also over the content of files.
fn checksum(case: &Case) -> u32 {
    crc32fast::hash(format!("{case:?}").as_bytes())
}

/// Flies a bundle. See Study.bundle, which makes it.
#[pyfunction]
#[pyo3(signature = (parts, threads = 1))]
pub(crate) fn fly_bundle(
    py: Python<'_>,
    parts: Vec<Part>,
    threads: usize,
) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let watch = Watch::default();
    let computing = Computing {
        threads: threads.max(1),
        isa: Isa::detect(),
        stop: &watch.stop,
        fibre_steps: &watch.done,
        recorder: None,
    };
    let flown = watched(py, &watch, None, || {
        let mut points: Vec<Point> = Vec::new();
        let mut read: BTreeMap<&str, usize> = BTreeMap::new();
        let mut batches = Vec::new();
        for (number, text, sum, start, end) in &parts {
            let point = match read.get(text.as_str()) {
                Some(point) => *point,
                None => {
                    let (case, _) = parse_case(text, "case.toml", &[])?;
                    if checksum(&case) != *sum {
                        return Ok(Err(*number));
                    }
                    read.insert(text, points.len());
                    points.push(Point { values: Vec::new(), case });
                    points.len() - 1
                }
            };
            batches.push(Batch { point, replicates: *start..*end });
        }
        Ok::<_, Failure>(Ok((fly(&points, &batches, computing)?, batches)))
    })?;
    let (records, batches) = flown.map_err(|number| {
        let text = format!(
            "point {}: its case is another one on this machine, because a file that it names has another content here, or \
             this machine has another version of spunlaid; give all machines the same",
            number + 1
        );
        raised_as(py, "ClusterError", text)
    })?;
    // Two points may have the same case, so a record is found by its point here and its replicate there.
    let mut rows = Vec::with_capacity(records.len() * COLUMNS);
    let mut at: BTreeMap<(usize, u64), Vec<u64>> = BTreeMap::new();
    for (batch, (number, ..)) in batches.iter().zip(&parts) {
        for replicate in batch.replicates.clone() {
            at.entry((batch.point, replicate)).or_default().push(*number);
        }
    }
    for record in &records {
        let owner = at.get_mut(&(record.point as usize, record.replicate)).and_then(Vec::pop);
        let (lost, values) = match record.landing {
            Landing::Measured(values) => (0.0, values),
            Landing::Lost { node, time } => {
                let mut values = [0.0; MEASURES.len()];
                (values[0], values[1]) = (node as f64, time);
                (1.0, values)
            }
        };
        rows.extend([owner.unwrap_or(record.point) as f64, record.replicate as f64, lost]);
        rows.extend(values);
    }
    PyArray1::from_vec(py, rows).reshape([records.len(), COLUMNS])
}

/// The records of [`fly_bundle`].
pub(crate) fn records(rows: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<Record>> {
    let rows = rows.as_array();
    if rows.ncols() != COLUMNS {
        return Err(PyValueError::new_err(format!("records have {COLUMNS} columns, not {}", rows.ncols())));
    }
    let of = |row: numpy::ndarray::ArrayView1<'_, f64>| {
        let landing = if row[2] == 0.0 {
            Landing::Measured(std::array::from_fn(|i| row[3 + i]))
        } else {
            Landing::Lost { node: row[3] as u64, time: row[4] }
        };
        Record { point: row[0] as u64, replicate: row[1] as u64, landing }
    };
    Ok(rows.rows().into_iter().map(of).collect())
}
