//! Names and contents of the columns.

use super::super::parquet::{Column, Holds};
use spunlaid::study::{MEASURES, Study};

/// A value in a row.
#[derive(Clone, Copy, Debug)]
pub enum Value {
    Whole(i64),
    /// NaN counts as missing.
    Number(f64),
    Word(&'static str),
}

/// The input columns: the key and its SI unit, `air.velocity_m_s`.
fn inputs(study: &Study) -> impl Iterator<Item = Column> {
    study.inputs().map(|input| Column {
        holds: if input.words.is_empty() { Holds::Optional } else { Holds::Text },
        name: input.column(),
    })
}

/// The inputs of a point.
pub(super) fn values(study: &Study, point: usize) -> impl Iterator<Item = Value> {
    let values = study.inputs().zip(&study.points[point].values);
    values.map(|(input, value)| input.word(*value).map_or(Value::Number(*value), Value::Word))
}

pub(super) fn of_points(study: &Study) -> Vec<Column> {
    let mut columns = vec![whole("point"), whole("seed")];
    columns.extend(inputs(study));
    columns.extend([whole("n"), whole("lost")]);
    for measure in &MEASURES {
        columns.extend([number(measure.column), number(format!("{}_se", measure.column))]);
    }
    columns
}

pub(super) fn of_fibres(study: &Study) -> Vec<Column> {
    let mut columns = vec![whole("point"), whole("replicate"), whole("seed")];
    columns.extend(inputs(study));
    columns.extend(MEASURES.iter().map(|measure| number(measure.column)));
    columns
}

fn whole(name: &str) -> Column {
    Column { name: name.to_owned(), holds: Holds::Whole }
}

fn number(name: impl Into<String>) -> Column {
    Column { name: name.into(), holds: Holds::Optional }
}
