//! Tables of a study: one with a row per point, one with a row per replicate.

mod columns;
mod csv;
mod json;
pub mod shown;

pub use json::write_json;

use self::columns::Value;
use super::folder::Staging;
use super::parquet::{Column, Parquet};
use crate::Failure;
use spunlaid::study::{Journal, PointResults, Record, ReplicateOutcome, Study, results_of_point};

/// Number of values that are collected before they are written.
const VALUES: usize = 1 << 18;

/// Writes `results.csv`, `results.parquet` and `replicates.parquet`, and returns the statistics of the points.
///
/// Rows are written as they are read, so that memory does not grow with the number of replicates.
pub fn write(
    staging: &Staging<'_>,
    study: &Study,
    journal: &mut Journal,
) -> Result<Vec<PointResults>, Failure> {
    let create = |name: &str, columns: &[Column]| {
        Parquet::create(staging.place(name), columns, VALUES.div_ceil(columns.len()))
    };
    let points = columns::columns_of_points(study);
    let mut csv = csv::Csv::create(staging.place("results.csv"), &points)?;
    let mut results = create("results.parquet", &points)?;
    let mut replicates = create("replicates.parquet", &columns::columns_of_replicates(study))?;
    let mut all = Vec::with_capacity(study.points.len());
    for index in 0..study.points.len() {
        let point = results_of_point(study, journal, index)?;
        let row = point_row(study, index, &point);
        csv.add(&row)?;
        add(&mut results, &row)?;
        for record in journal.records(index, u64::MAX)? {
            add(&mut replicates, &replicate_row(study, index, &record))?;
        }
        all.push(point);
    }
    csv.finish()?;
    for (table, name) in [(results, "results.parquet"), (replicates, "replicates.parquet")] {
        table.finish()?.sync_all().map_err(Failure::unwritable(&staging.place(name).1))?;
    }
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

fn add(table: &mut Parquet, row: &[Value]) -> Result<(), Failure> {
    for (column, value) in row.iter().enumerate() {
        match value {
            Value::Whole(value) => table.extend_whole(column, [*value]),
            Value::Number(value) => table.extend(column, [*value]),
            Value::Word(word) => table.push_text(column, word),
        }
    }
    table.flush_when_full()
}
