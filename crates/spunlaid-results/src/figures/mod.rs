//! What the figures of several reports share.

pub(crate) mod drag_laws;
pub(crate) mod effects;

use spunlaid_charts::palette::{BLUE, Colour, GREEN, INK, ORANGE, PURPLE, VERMILION};
use spunlaid_charts::{Chart, Series};

/// Colours of the series of a figure.
pub(crate) const COLOURS: [Colour; 6] = [BLUE, VERMILION, GREEN, ORANGE, PURPLE, INK];

/// Markers with bars, joined by a thin line.
pub(crate) fn joined(chart: Chart, series: Series, spots: &[(f64, f64, Option<f64>)]) -> Chart {
    let line = series.clone().adorning().unmarked().width(1.0);
    chart.line(line, spots.iter().map(|(x, y, _)| (*x, *y))).scatter(series, spots)
}

/// Label of an axis: `Length laid (m)`.
pub(crate) fn with_unit(label: &str, unit: &str) -> String {
    if unit.is_empty() { label.to_owned() } else { format!("{label} ({unit})") }
}
