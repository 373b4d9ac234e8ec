//! Tables of a study: a row per point, a row per fibre.

mod columns;
mod csv;
mod parquet;

pub(crate) use self::columns::column_name;
use self::columns::{Column, Value};
use crate::failure::Failure;
use spunlaid::study::{Journal, Landing, MEASURES, PointResults, Record, Study, results_of_point};
use std::path::Path;

/// Writes `results.csv`, `results.parquet` and `replicates.parquet` to a folder; gives what the points amount to.
///
/// Rows are written as they are read: memory does not grow with the fibres.
pub(crate) fn write(
    folder: &Path,
    study: &Study,
    journal: &mut Journal,
) -> Result<Vec<PointResults>, Failure> {
    let points = columns::of_points(study);
    let mut csv = csv::Csv::create(&folder.join("results.csv"), &points)?;
    let mut results = parquet::Parquet::create(&folder.join("results.parquet"), &points)?;
    let fibres = columns::of_fibres(study);
    let mut replicates = parquet::Parquet::create(&folder.join("replicates.parquet"), &fibres)?;
    let mut all = Vec::with_capacity(study.points.len());
    for index in 0..study.points.len() {
        let point = results_of_point(journal, index)?;
        let row = point_row(study, index, &point);
        csv.add(&row)?;
        results.add(&row)?;
        for record in journal.records(index, u64::MAX).map_err(spunlaid::error::Error::from)? {
            replicates.add(&fibre_row(study, index, &record))?;
        }
        all.push(point);
    }
    csv.finish()?;
    results.finish()?;
    replicates.finish()?;
    Ok(all)
}

fn point_row(study: &Study, index: usize, results: &PointResults) -> Vec<Value> {
    let point = &study.points[index];
    let mut row = vec![Value::Whole(index as i64 + 1), Value::Whole(point.case.run.seed as i64)];
    row.extend(point.values.iter().map(|value| Value::number(*value)));
    row.extend([Value::Whole(results.n as i64), Value::Whole(results.lost as i64)]);
    for (mean, error) in results.mean.iter().zip(&results.standard_error) {
        row.extend([Value::number(*mean), Value::Number(*error)]);
    }
    row
}

fn fibre_row(study: &Study, index: usize, record: &Record) -> Vec<Value> {
    let point = &study.points[index];
    let mut row = vec![
        Value::Whole(index as i64 + 1),
        Value::Whole(record.replicate as i64 + 1),
        Value::Whole(point.case.run.seed as i64),
    ];
    row.extend(point.values.iter().map(|value| Value::number(*value)));
    match record.landing {
        Landing::Measured(measured) => row.extend(measured.iter().map(|value| Value::number(*value))),
        Landing::Lost { .. } => row.extend([Value::Number(None); MEASURES.len()]),
    }
    row
}

fn column(name: impl Into<String>, whole: bool) -> Column {
    Column { name: name.into(), whole }
}
