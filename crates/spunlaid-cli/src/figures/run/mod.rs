//! The figures of a run.

mod air;
mod energy;
mod motion;
mod spectra;

use spunlaid::case::Case;
use spunlaid::ensemble::{Results, SpectrumPoint};
use spunlaid_charts::Figure;

/// Millimetres per metre.
const MM: f64 = 1e3;

/// The figures of a run, in the order a reader wants them; the turbulence is left out where there is none.
pub(crate) fn run_figures(case: &Case, results: &Results, turbulence: &[SpectrumPoint]) -> Vec<Figure> {
    let mut figures = vec![
        motion::end_node_history(case, results),
        motion::end_node_path(case, results),
        motion::amplitude_along_fibre(case, &results.nodes),
        spectra::motion(results),
    ];
    if !case.air.is_uniform() {
        figures.push(air::along_fibre(case));
        figures.extend(air::slices(case, results));
    }
    if !turbulence.is_empty() {
        figures.push(spectra::turbulence(case, turbulence));
    }
    figures.push(energy::errors(case, &results.errors));
    figures
}

/// Time of so many swings of the free end [s], where it swings at all.
fn swings(results: &Results, count: f64) -> Option<f64> {
    let end = &results.end_node;
    let fastest = end.frequency_y.mean.max(end.frequency_z.mean);
    (fastest.is_finite() && fastest > 0.0).then(|| count / fastest)
}
