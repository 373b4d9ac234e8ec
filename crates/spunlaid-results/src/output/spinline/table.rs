//! The table of a spinline for the terminal.

use super::words::{MODEL_ERROR, influence, numerical_error, shown};
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
        let _ = writeln!(text, "{}{}", row.trim_end(), cause(measure, first));
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
    let _ = writeln!(text, "errors\n  {}\n  {MODEL_ERROR}", numerical_error(rows));
    text
}

/// By what the thread freezes, beside its temperature.
fn cause(measure: &SpinlineMeasure, solution: &Solution) -> &'static str {
    match (measure.name, solution.freezing.by) {
        ("freezing.temperature_c", FreezingCause::Temperature) => "  (it freezes by its temperature)",
        ("freezing.temperature_c", FreezingCause::Crystallisation) => "  (it freezes by crystallisation)",
        _ => "",
    }
}
