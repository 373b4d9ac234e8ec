//! Names and contents of the columns.

use super::super::table::{Column, ColumnValues, Value, whole};
use spunlaid::study::{Quantity, Study};

/// The input columns: the key and its SI unit, `air.velocity_m_s`.
fn inputs(study: &Study) -> impl Iterator<Item = Column> {
    study.inputs().map(|input| Column {
        holds: if input.words.is_empty() { ColumnValues::Optional } else { ColumnValues::Text },
        name: input.column(),
    })
}

/// The inputs of a point.
pub(super) fn values(study: &Study, point: usize) -> impl Iterator<Item = Value> {
    let values = study.inputs().zip(&study.points[point].values);
    values.map(|(input, value)| input.word(*value).map_or(Value::Number(*value), Value::Word))
}

pub(super) fn columns_of_points(study: &Study) -> Vec<Column> {
    let mut columns = vec![whole("point"), whole("seed")];
    columns.extend(inputs(study));
    columns.extend([whole("n"), whole("lost")]);
    for quantity in &study.quantities {
        columns.extend(quantity_columns(quantity).map(optional));
    }
    columns
}

pub(super) fn columns_of_replicates(study: &Study) -> Vec<Column> {
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
