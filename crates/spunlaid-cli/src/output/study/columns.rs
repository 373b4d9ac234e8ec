//! What the columns are called and hold.

use super::column;
use spunlaid::study::{MEASURES, Study};

/// A column.
#[derive(Clone, Debug)]
pub(crate) struct Column {
    pub(crate) name: String,
    /// Of whole numbers, never missing; else of numbers, which may be.
    pub(crate) whole: bool,
}

/// A value in a row.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Value {
    Whole(i64),
    Number(Option<f64>),
}

impl Value {
    /// What is no number is missing.
    pub(crate) fn number(value: f64) -> Self {
        Self::Number(value.is_finite().then_some(value))
    }
}

/// Names of the inputs' columns, the key and its SI unit: `air.velocity_m_s`.
fn inputs(study: &Study) -> impl Iterator<Item = String> {
    study.inputs().map(|(key, dimension)| format!("{key}{}", dimension.suffix()))
}

pub(super) fn of_points(study: &Study) -> Vec<Column> {
    let mut columns = vec![column("point", true), column("seed", true)];
    columns.extend(inputs(study).map(|name| column(name, false)));
    columns.extend([column("n", true), column("lost", true)]);
    for measure in &MEASURES {
        columns.extend([column(measure.column, false), column(format!("{}_se", measure.column), false)]);
    }
    columns
}

pub(super) fn of_fibres(study: &Study) -> Vec<Column> {
    let mut columns = vec![column("point", true), column("replicate", true), column("seed", true)];
    columns.extend(inputs(study).map(|name| column(name, false)));
    columns.extend(MEASURES.iter().map(|measure| column(measure.column, false)));
    columns
}
