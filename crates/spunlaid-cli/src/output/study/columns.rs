//! What the columns are called and hold.

use super::super::parquet::{Column, Holds};
use spunlaid::study::{MEASURES, Study};
use spunlaid::units::Dimension;

/// A value in a row.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Value {
    Whole(i64),
    /// NaN counts as missing.
    Number(f64),
}

/// `air.velocity_m_s`: the key and its SI unit.
fn column_name(key: &str, dimension: Dimension) -> String {
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
    let mut columns = vec![whole("point"), whole("seed")];
    columns.extend(inputs(study).map(number));
    columns.extend([whole("n"), whole("lost")]);
    for measure in &MEASURES {
        columns.extend([number(measure.column), number(format!("{}_se", measure.column))]);
    }
    columns
}

pub(super) fn of_fibres(study: &Study) -> Vec<Column> {
    let mut columns = vec![whole("point"), whole("replicate"), whole("seed")];
    columns.extend(inputs(study).map(number));
    columns.extend(MEASURES.iter().map(|measure| number(measure.column)));
    columns
}

fn whole(name: &str) -> Column {
    Column { name: name.to_owned(), holds: Holds::Whole }
}

fn number(name: impl Into<String>) -> Column {
    Column { name: name.into(), holds: Holds::Optional }
}
