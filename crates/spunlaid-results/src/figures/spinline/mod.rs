//! The figures of a spinline.

mod curtain;
mod influences;
#[cfg(test)]
mod tests;
mod thread;

use spunlaid::input::Influence;
use spunlaid::spinline::Solution;
use spunlaid_charts::Figure;

/// Beginning of the names of the figures where there is one spinline.
pub const SPINLINE: &str = "spinline";

/// Millimetres per metre.
const MM: f64 = 1e3;
/// Micrometres per metre.
const MICROMETRES: f64 = 1e6;

/// The figures of a spinline, in the order a reader wants them.
///
/// * `prefix` – the beginning of their names
/// * `rows` – the solution of each row of the curtain, the quenched side first
pub fn spinline_figures(prefix: &str, rows: &[Solution], influences: &[Influence]) -> Vec<Figure> {
    let mut figures = thread::figures(prefix, rows);
    if rows.len() > 1 {
        figures.push(curtain::figure(prefix, rows));
    }
    if !influences.is_empty() {
        figures.push(influences::figure(prefix, influences));
    }
    figures
}
