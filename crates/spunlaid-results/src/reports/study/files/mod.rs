//! Tables of a study: one with a row per point, one with a row per replicate.

pub(crate) mod json;
pub mod shown;

use crate::Failure;
use crate::files::folder::Staging;
use crate::files::table::{Column, ColumnValues, Value, whole};
use spunlaid_experiment::study::results_of_point;
use spunlaid_experiment::{Journal, PointResults, Quantity, Record, ReplicateOutcome, Study};

/// Writes `results.csv`, `results.parquet` and `replicates.parquet`, and returns the statistics of the points.
///
/// Rows are written as they are read, so that memory does not grow with the number of replicates. The statistics are
/// complete before a table gathers rows: what it frees would otherwise lie between them, in pieces of no use.
pub fn write(
    staging: &Staging<'_>,
    study: &Study,
    journal: &mut Journal,
) -> Result<Vec<PointResults>, Failure> {
    let points = 0..study.points.len();
    let all = points.clone().map(|index| results_of_point(study, journal, index));
    let all = all.collect::<Result<Vec<_>, _>>()?;
    let mut table = staging.table("results", &["csv", "parquet"], &columns_of_points(study))?;
    points.clone().try_for_each(|index| table.add(&point_row(study, index, &all[index])))?;
    table.finish()?;
    let mut table = staging.table("replicates", &["parquet"], &columns_of_replicates(study))?;
    for index in points {
        for record in journal.records(index, u64::MAX)? {
            table.add(&replicate_row(study, index, &record))?;
        }
    }
    table.finish()?;
    Ok(all)
}

fn point_row(study: &Study, index: usize, results: &PointResults) -> Vec<Value> {
    let point = &study.points[index];
    let mut row = vec![Value::Whole(index as i64 + 1), Value::Whole(point.experiment.seed() as i64)];
    row.extend(inputs_of(study, index));
    row.extend([Value::Whole(results.n as i64), Value::Whole(results.lost as i64)]);
    for (index, quantity) in study.quantities.iter().enumerate() {
        row.extend([results.mean(index), results.error(index)].map(Value::Number));
        if quantity.further_errors().next().is_some() {
            let whole = results.total_error(&study.quantities, index);
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
    row.extend(inputs_of(study, index));
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

/// The input columns: the key and its SI unit, `air.velocity_m_s`.
fn inputs(study: &Study) -> impl Iterator<Item = Column> {
    study.inputs().map(|input| Column {
        holds: if input.words().is_empty() { ColumnValues::Optional } else { ColumnValues::Text },
        name: input.column(),
    })
}

/// The inputs of a point.
fn inputs_of(study: &Study, point: usize) -> impl Iterator<Item = Value> {
    let values = study.inputs().zip(&study.points[point].values);
    values.map(|(input, value)| input.word(*value).map_or(Value::Number(*value), Value::Word))
}

fn columns_of_points(study: &Study) -> Vec<Column> {
    let mut columns = vec![whole("point"), whole("seed")];
    columns.extend(inputs(study));
    columns.extend([whole("n"), whole("lost")]);
    for quantity in &study.quantities {
        columns.extend(quantity_columns(quantity).map(optional));
    }
    columns
}

fn columns_of_replicates(study: &Study) -> Vec<Column> {
    let mut columns = vec![whole("point"), whole("replicate"), whole("seed")];
    columns.extend(inputs(study));
    columns.extend(study.quantities.iter().map(|quantity| optional(&quantity.column)));
    columns
}

/// The columns of a quantity: its mean, its standard error, and its error by all causes if it has others.
fn quantity_columns(quantity: &Quantity) -> impl Iterator<Item = String> {
    let ends = ["", "_se", "_whole_error"];
    ends.into_iter()
        .take(if quantity.further_errors().next().is_none() { 2 } else { 3 })
        .map(|end| format!("{}{end}", quantity.column))
}

fn optional(name: impl Into<String>) -> Column {
    Column { name: name.into(), holds: ColumnValues::Optional }
}
