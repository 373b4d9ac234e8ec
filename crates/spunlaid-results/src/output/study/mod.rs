//! Tables of a study: one with a row per point, one with a row per replicate.

mod columns;
mod json;
pub mod shown;

pub use json::write_json;

use super::folder::Staging;
use super::table::Value;
use crate::Failure;
use spunlaid::study::{Journal, PointResults, Record, ReplicateOutcome, Study, results_of_point};

/// Writes `results.csv`, `results.parquet` and `replicates.parquet`, and returns the statistics of the points.
///
/// Rows are written as they are read, so that memory does not grow with the number of replicates.
pub fn write(
    staging: &Staging<'_>,
    study: &Study,
    journal: &mut Journal,
) -> Result<Vec<PointResults>, Failure> {
    let points = columns::columns_of_points(study);
    let mut results = staging.table("results", &["csv", "parquet"], &points)?;
    let columns = columns::columns_of_replicates(study);
    let mut replicates = staging.table("replicates", &["parquet"], &columns)?;
    let mut all = Vec::with_capacity(study.points.len());
    for index in 0..study.points.len() {
        let point = results_of_point(study, journal, index)?;
        results.add(&point_row(study, index, &point))?;
        for record in journal.records(index, u64::MAX)? {
            replicates.add(&replicate_row(study, index, &record))?;
        }
        all.push(point);
    }
    results.finish()?;
    replicates.finish()?;
    Ok(all)
}

fn point_row(study: &Study, index: usize, results: &PointResults) -> Vec<Value> {
    let point = &study.points[index];
    let mut row = vec![Value::Whole(index as i64 + 1), Value::Whole(point.experiment.seed() as i64)];
    row.extend(columns::values(study, index));
    row.extend([Value::Whole(results.n as i64), Value::Whole(results.lost as i64)]);
    for (index, quantity) in study.quantities.iter().enumerate() {
        row.extend([results.mean[index], results.errors[index]].map(Value::Number));
        if quantity.further_errors().next().is_some() {
            let whole = results.whole_error(&study.quantities, index);
            row.push(Value::Number(whole.unwrap_or(f64::NAN)));
        }
    }
    row
}

fn replicate_row(study: &Study, index: usize, record: &Record) -> Vec<Value> {
    let point = &study.points[index];
    let mut row = vec![
        Value::Whole(index as i64 + 1),
        Value::Whole(record.replicate as i64 + 1),
        Value::Whole(point.experiment.seed() as i64),
    ];
    row.extend(columns::values(study, index));
    match &record.outcome {
        ReplicateOutcome::Measured(measured) => {
            row.extend(measured.iter().map(|value| Value::Number(*value)))
        }
        ReplicateOutcome::Lost { .. } => {
            row.extend(std::iter::repeat_n(Value::Number(f64::NAN), study.quantities.len()))
        }
    }
    row
}
