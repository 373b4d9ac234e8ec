//! The figures of a run.

pub(crate) mod air;
mod laid;
pub(crate) mod measured;
mod motion;
mod spectra;

use crate::figures::drag_laws;
use spunlaid_charts::Figure;
use spunlaid_fibre::Case;
use spunlaid_simulation::{Results, SpectrumPoint};

/// Millimetres per metre.
const MM: f64 = 1e3;

/// The figures of a run, in the order a reader wants them; the turbulence is left out where there is none.
pub fn run_figures(case: &Case, results: &Results, turbulence: &[SpectrumPoint]) -> Vec<Figure> {
    let mut figures = match case.line {
        Some(_) => laid::figures(case, results),
        None => vec![motion::end_node_history(case, results), motion::end_node_path(case, results)],
    };
    figures.extend(measured::figures(results));
    if !case.air.is_uniform() {
        figures.push(air::along_fibre(case));
        figures.extend(air::field_figure(case, Some(results)));
    }
    if !turbulence.is_empty() {
        figures.push(spectra::turbulence(case, turbulence));
    }
    if case.air.density > 0.0 {
        figures.extend(drag_laws::of_files(&case.drag, case.fibre.diameter));
    }
    figures
}

/// The time of this number of swings [s]; `None` if the free end does not swing.
fn swings(results: &Results, count: f64) -> Option<f64> {
    swing_frequency(results).map(|frequency| count / frequency)
}

/// The higher of the two crossing frequencies [Hz]; `None` if the free end does not swing.
pub fn swing_frequency(results: &Results) -> Option<f64> {
    let [y, z] = ["frequency_y", "frequency_z"].map(|name| results.estimate(name).mean);
    let fastest = y.max(z);
    (fastest.is_finite() && fastest > 0.0).then_some(fastest)
}
