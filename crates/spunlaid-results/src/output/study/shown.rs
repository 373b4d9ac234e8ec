//! Measures as tables for readers show them, by their names.

use crate::numbers::plus_minus;
use spunlaid::study::{PointResults, Study, measure};

/// The measures that tables show, the most important first.
pub fn measures(study: &Study) -> [&'static str; 6] {
    if study.points.first().is_some_and(|point| point.case.line.is_some()) {
        let lengths = ["half_correlation_length_md", "half_correlation_length_cd"];
        return ["sigma_md", "sigma_cd", lengths[0], lengths[1], "noise", "orientation_md"];
    }
    ["amplitude_y", "amplitude_z", "frequency_y", "frequency_z", "mean_x", "strain_99"]
}

/// The head of a column: `Amplitude in y (mm)`.
pub fn head(name: &str) -> String {
    match measure(name) {
        Some((_, of)) if of.unit.shown.is_empty() => of.label.to_owned(),
        Some((_, of)) => format!("{} ({})", of.label, of.unit.shown),
        None => name.to_owned(),
    }
}

/// Mean ± standard error at a point.
pub fn cell(results: &PointResults, name: &str) -> String {
    let (mean, error) = results.of(name).unwrap_or((f64::NAN, None));
    in_unit(name, mean, error)
}

/// A value ± its error, in the unit of a measure.
pub fn in_unit(name: &str, value: f64, error: Option<f64>) -> String {
    let factor = measure(name).map_or(1.0, |(_, of)| of.unit.per_si);
    plus_minus(value * factor, error.map(|error| error * factor))
}
