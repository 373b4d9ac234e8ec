//! The rows of a curtain: each meets air that the row before has warmed and dragged along.

use super::{MICROMETRES, MM};
use spunlaid::spinline::Solution;
use spunlaid_charts::{Axis, Chart, Figure, Series};

/// Diameter and freezing point of each row.
pub(super) fn figure(prefix: &str, rows: &[Solution]) -> Figure {
    let title = "Rows of the curtain";
    let along = || Axis::linear("Row, from the side of the quench").in_column("row");
    let points = |value: fn(&Solution) -> f64| -> Vec<_> {
        rows.iter().enumerate().map(|(i, row)| ((i + 1) as f64, value(row), None)).collect()
    };
    let diameter = Chart::new(
        &format!("{prefix}_rows_diameter"),
        title,
        along(),
        Axis::linear("Diameter *d*, cold (µm)"),
    )
    .scatter(Series::circles("filament").unlabelled(), &points(|row| row.final_diameter * MICROMETRES));
    let freezing = Chart::new(
        &format!("{prefix}_rows_freezing"),
        title,
        along(),
        Axis::linear("Freezing point, below the die (mm)"),
    )
    .scatter(Series::circles("filament").unlabelled(), &points(|row| row.freezing.distance * MM));
    Figure::stacked(
        &format!("{prefix}_rows"),
        title,
        &[&diameter.sized(640.0, 300.0), &freezing.sized(640.0, 300.0)],
        "Each row meets the air that the rows before it have warmed and dragged along. The air does not mix \
        between the rows in this model.",
    )
}
