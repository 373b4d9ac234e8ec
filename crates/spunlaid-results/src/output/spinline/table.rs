//! The table of a spinline for the terminal.

use super::words::{influence, model_error, numerical_error};
use crate::numbers::number_to;
use crate::output::measured::text as value;
use spunlaid::input::Influence;
use spunlaid::observe::{Measured, OF_SPINLINES, measured};
use spunlaid::spinline::Solution;
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
    let told = || measured(OF_SPINLINES, first).filter(|row| !row.measure.terse().is_empty());
    let widest = told().map(|row| row.measure.terse().chars().count()).max().unwrap_or(0);
    for row in told() {
        let Measured { measure, remark, .. } = &row;
        let value = value(&row).unwrap_or_default();
        let cells = format!("  {:<widest$}  {value:>8} {}", measure.terse(), measure.unit.shown);
        let remark = remark.as_ref().map_or_else(String::new, |remark| format!("  ({remark})"));
        let _ = writeln!(text, "{}{remark}", cells.trim_end());
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
