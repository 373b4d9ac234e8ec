//! The table of a spinline for the terminal.

use super::words::{doubt, influence, model_error, numerical_error, shown};
use crate::numbers::number_to;
use spunlaid::input::Influence;
use spunlaid::observe::{OF_SPINLINES, SpinlineMeasure};
use spunlaid::spinline::{FreezingCause, Solution};
use std::fmt::Write;

/// Influences that are told.
const TOLD: usize = 3;

/// The measures, what decides the diameter, and what is known of the errors.
///
/// * `rows` – the solution of each row of the curtain, the quenched side first
pub fn text(rows: &[Solution], influences: &[Influence]) -> String {
    let Some(first) = rows.first() else { return String::new() };
    let mut text = match rows.len() {
        1 => "spinline, steady state\n".to_owned(),
        count => format!("spinline, steady state: the first of {count} rows\n"),
    };
    let widest = OF_SPINLINES.iter().map(|measure| measure.label.chars().count()).max().unwrap_or(0);
    for measure in OF_SPINLINES.iter().filter(|measure| !measure.is_residual) {
        let row =
            format!("  {:<widest$}  {:>8} {}", measure.label, shown(measure, first), measure.unit.shown);
        let _ = writeln!(text, "{}{}", row.trim_end(), beside(measure, first));
    }
    if let [first, .., last] = rows {
        let micrometres = |row: &Solution| number_to(row.final_diameter * 1e6, 4);
        let _ = writeln!(
            text,
            "rows of the curtain, the quenched side first\n  Diameter, cold: {} µm in the first row, {} µm in the last",
            micrometres(first),
            micrometres(last)
        );
    }
    if !influences.is_empty() {
        let _ = writeln!(text, "what decides the diameter");
        for one in influences.iter().take(TOLD) {
            let _ = writeln!(text, "  {}", influence(one));
        }
    }
    let of_model = model_error(first.has_low_birefringence);
    let _ = writeln!(text, "errors\n  {}\n  {of_model}", numerical_error(rows));
    text
}

/// What stands beside a measure: by what the thread freezes, and what is known to be wrong.
fn beside(measure: &SpinlineMeasure, solution: &Solution) -> String {
    let cause = match solution.freezing.by {
        FreezingCause::Temperature => "it freezes by its temperature",
        FreezingCause::Crystallisation => "it freezes by crystallisation",
    };
    let cause = (measure.name == "freezing.temperature_c").then_some(cause);
    cause.or_else(|| doubt(measure, solution)).map_or_else(String::new, |words| format!("  ({words})"))
}
