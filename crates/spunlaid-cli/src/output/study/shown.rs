//! Measures as tables for readers show them, by their names.

use crate::numbers::plus_minus;
use spunlaid::study::{PointResults, measure};

/// The head of a column: `Amplitude in y (mm)`.
pub(crate) fn head(name: &str) -> String {
    measure(name).map_or_else(|| name.to_owned(), |(_, of)| format!("{} ({})", of.label, of.unit.shown))
}

/// Mean ± standard error at a point.
pub(crate) fn cell(results: &PointResults, name: &str) -> String {
    let (mean, error) = results.of(name).unwrap_or((f64::NAN, None));
    in_unit(name, mean, error)
}

/// A value ± its error, in the unit of a measure.
pub(crate) fn in_unit(name: &str, value: f64, error: Option<f64>) -> String {
    let factor = measure(name).map_or(1.0, |(_, of)| of.unit.per_si);
    plus_minus(value * factor, error.map(|error| error * factor))
}
