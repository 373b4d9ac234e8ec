//! What the columns are called and hold.

use super::column;
use spunlaid::study::{MEASURES, Study};
use spunlaid::units::Dimension;

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

/// `air.velocity_m_s`: the key and its SI unit.
pub(crate) fn column_name(key: &str, dimension: Dimension) -> String {
    let unit = match dimension {
        Dimension::Length => "_m",
        Dimension::Velocity => "_m_s",
        Dimension::Time => "_s",
        Dimension::Frequency => "_hz",
        Dimension::Rate => "_1_s",
        Dimension::Density => "_kg_m3",
        Dimension::Pressure => "_pa",
        Dimension::KinematicViscosity => "_m2_s",
        Dimension::Acceleration => "_m_s2",
        Dimension::Ratio => "",
    };
    format!("{key}{unit}")
}

/// Names of the inputs' columns.
fn inputs(study: &Study) -> impl Iterator<Item = String> {
    study.inputs().map(|(key, dimension)| column_name(key, dimension))
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
