//! The rows of the results table.

use super::words::estimate_text;
use crate::numbers::{number, signed};
use spunlaid::case::Case;
use spunlaid::chain::schemes::Scheme;
use spunlaid::ensemble::Results;
use spunlaid::statistics::Estimate;

/// A result with its unit.
pub(super) struct Row {
    pub(super) name: &'static str,
    pub(super) value: String,
    pub(super) unit: &'static str,
    /// Number of replicates it is taken over.
    pub(super) n: usize,
    pub(super) meaning: &'static str,
}

/// The results of one replicate.
pub(super) struct ReplicateRow {
    pub(super) number: usize,
    pub(super) values: Vec<String>,
}

/// Results that each replicate has: name, unit, factor from SI, meaning.
type Result<'a> = (&'static str, &'static str, f64, &'a Estimate, &'static str);

fn per_replicate(results: &Results) -> [Result<'_>; 5] {
    let end = &results.end_node;
    let amplitude = "standard deviation over time of the free end’s position";
    let frequency = "half the number of sign changes per second";
    [
        ("Amplitude in y", "mm", 1e3, &end.amplitude_y, amplitude),
        ("Amplitude in z", "mm", 1e3, &end.amplitude_z, amplitude),
        ("Frequency in y", "Hz", 1.0, &end.frequency_y, frequency),
        ("Frequency in z", "Hz", 1.0, &end.frequency_z, frequency),
        (
            "Mean position along the flow",
            "mm",
            1e3,
            &end.mean_x,
            "mean over time of the free end’s x; the less of the fibre’s length, the more it is bent",
        ),
    ]
}

/// One row per result.
pub(super) fn rows(case: &Case, results: &Results) -> Vec<Row> {
    let of = |(name, unit, factor, estimate, meaning): Result<'_>| Row {
        name,
        value: estimate_text(estimate, factor),
        unit,
        n: estimate.values.len(),
        meaning,
    };
    let n = results.end_node.amplitude_y.values.len();
    let (work, balance) = (&results.work_error_percent, &results.balance_error_percent);
    let dissipated = results.tension_dissipation_percent.final_mean;
    let single = |name, value: f64, meaning| Row { name, value: number(value), unit: "%", n, meaning };
    per_replicate(results)
        .into_iter()
        .map(of)
        .chain([
            single("Largest strain", results.max_strain * 100.0, "of any element at any recorded instant"),
            single("Work check, at the end", work.final_mean, "mean over the replicates"),
            single("Work check, typical", work.time_median, "median over time and replicates"),
            single("Energy balance, at the end", balance.final_mean, "mean over the replicates"),
            single("Energy balance, typical", balance.time_median, "median over time and replicates"),
        ])
        .chain((case.run.scheme == Scheme::ImplicitTension).then(|| {
            let meaning =
                "of the air’s work, taken out by the scheme with the waves of tension that it damps";
            single("Dissipated by the scheme, at the end", dissipated, meaning)
        }))
        .collect()
}

/// Heads of the columns of [`replicate_rows`].
pub(super) fn replicate_heads(results: &Results) -> Vec<String> {
    per_replicate(results).iter().map(|(name, unit, ..)| format!("{name} ({unit})")).collect()
}

/// One row per replicate, up to `most`.
pub(super) fn replicate_rows(results: &Results, most: usize) -> Vec<ReplicateRow> {
    let n = results.end_node.amplitude_y.values.len().min(most);
    let columns: Vec<Vec<String>> = per_replicate(results)
        .iter()
        .map(|(_, _, factor, e, _)| column(&e.values[..n.min(e.values.len())], *factor))
        .collect();
    let values = |i: usize| columns.iter().filter_map(|c| c.get(i).cloned()).collect();
    (0..n).map(|i| ReplicateRow { number: i + 1, values: values(i) }).collect()
}

/// Values with as many decimals as give the largest four digits; far from one each with its power of ten.
fn column(values: &[f64], factor: f64) -> Vec<String> {
    let scaled: Vec<f64> = values.iter().map(|v| v * factor).collect();
    let largest = scaled.iter().map(|v| v.abs()).fold(0.0, f64::max);
    let decimals = if largest > 0.0 { 3 - largest.log10().floor() as i32 } else { 0 };
    let plain = (0..=6).contains(&decimals) && scaled.iter().all(|v| v.is_finite());
    scaled.iter().map(|&v| if plain { signed(v, decimals as usize) } else { number(v) }).collect()
}
