//! The table of results on the terminal.

use crate::numbers::{number, rounded};
use spunlaid::case::Case;
use spunlaid::chain::schemes::Scheme;
use spunlaid::ensemble::Results;
use spunlaid::statistics::Estimate;
use std::fmt::Write;

/// The results of a run as a table of mean ± standard error.
pub(crate) fn results(case: &Case, results: &Results) -> String {
    let end = &results.end_node;
    let mut text = format!(
        "free end of the fibre, mean ± standard error over {} replicate{}\n",
        case.run.replicates,
        if case.run.replicates == 1 { "" } else { "s" }
    );
    for (name, estimate, scale, unit) in [
        ("amplitude y", &end.amplitude_y, 1e3, "mm"),
        ("amplitude z", &end.amplitude_z, 1e3, "mm"),
        ("frequency y", &end.frequency_y, 1.0, "Hz"),
        ("frequency z", &end.frequency_z, 1.0, "Hz"),
        ("mean x", &end.mean_x, 1e3, "mm"),
    ] {
        let _ = writeln!(text, "  {name:<16}{} {unit}", mean_and_error(estimate, scale));
    }
    text.push_str("energy errors, at the end and median over time\n");
    let dissipates = case.run.scheme == Scheme::ImplicitTension;
    let of_tension = dissipates.then_some(("taken by scheme", results.tension_dissipation_percent));
    for (name, error) in
        [("work check", results.work_error_percent), ("full balance", results.balance_error_percent)]
            .into_iter()
            .chain(of_tension)
    {
        let _ = writeln!(
            text,
            "  {name:<16}{:>12} %  {:>12} %",
            number(error.final_mean),
            number(error.time_median)
        );
    }
    let _ = writeln!(text, "largest strain    {:>12} %", number(results.max_strain * 100.0));
    text
}

/// The mean and its error, the signs ± of all rows below each other.
fn mean_and_error(estimate: &Estimate, scale: f64) -> String {
    let (mean, error) = rounded(estimate.mean * scale, estimate.standard_error.map(|e| e * scale));
    error.map_or_else(|| format!("{mean:>12}"), |error| format!("{mean:>12} ± {error}"))
}
