//! What half the time step changes, in words. Terminal and report say the same.

use crate::numbers::{plus_minus, significant};
use spunlaid::ensemble::{Results, StepCheck};
use spunlaid::statistics::Estimate;

/// The check in words.
pub struct StepCheckWords {
    /// What is compared, and how far apart the two are: `Path of the free end`, `0.0301 ± 0.0017 % of its amplitude`.
    pub path: (&'static str, String),
    /// What of its size is compared, and by how much it differs.
    pub amplitude: (&'static str, String),
    /// How much was compared, and what that cost.
    pub extent: String,
    /// What to do.
    pub advice: String,
}

impl StepCheckWords {
    /// What half the time step changes, as it is written.
    pub fn of(check: &StepCheck, results: &Results) -> Self {
        let percent = |of: &Estimate| {
            format!("{} %", plus_minus(100.0 * of.mean, of.standard_error.map(|error| 100.0 * error)))
        };
        let replicates = check.path.values.len();
        let fed = results.number("sigma_md").is_some();
        let [path, amplitude, of] = if fed {
            ["Place of the laid fibre", "Spread", "its spread"]
        } else {
            ["Path of the free end", "Amplitude", "its amplitude"]
        };
        Self {
            path: (path, format!("{} of {of}", percent(&check.path))),
            amplitude: (amplitude, percent(&check.amplitude)),
            extent: format!(
                "{replicates} replicate{} over the first {} s; it took {} % of the run's computing time",
                if replicates == 1 { "" } else { "s" },
                significant(check.duration, 2),
                significant(100.0 * check.share_of_run, 2)
            ),
            advice: advice(&amplitude.to_lowercase(), &check.amplitude, scatter(results)),
        }
    }
}

/// Compares the error of the step with the standard error of the amplitude or the spread, as a share of it.
fn advice(of: &str, change: &Estimate, scatter: Option<f64>) -> String {
    // The error of the step is at most this many times the change; the test of the check in the library has the measurement.
    let error = 2.5 * (change.mean.abs() + change.standard_error.unwrap_or(0.0));
    let Some(scatter) = scatter else {
        return "If that matters to you, halve run.time_step; with more replicates the scatter would be known too"
            .to_owned();
    };
    let known = format!("standard error over the replicates is {} %", significant(100.0 * scatter, 2));
    if error < 0.5 * scatter {
        format!("A shorter step would gain nothing: the {of}'s {known}")
    } else {
        format!("Halve run.time_step and see whether the results move: the {of}'s {known}, no more than that")
    }
}

/// The smaller relative standard error of the two amplitudes, or of the two spreads; `None` for a single replicate.
fn scatter(results: &Results) -> Option<f64> {
    let relative = |name| {
        let of = results.estimate(name);
        of.standard_error.map(|error| error / of.mean).filter(|share| share.is_finite())
    };
    ["amplitude_y", "amplitude_z", "sigma_md", "sigma_cd"].into_iter().filter_map(relative).reduce(f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advice_compares_the_step_with_the_scatter() {
        let change = |mean: f64| Estimate { mean, standard_error: Some(1e-4), values: Vec::new() };
        assert!(
            advice("amplitude", &change(-1e-4), Some(0.046)).starts_with("A shorter step would gain nothing")
        );
        assert!(advice("amplitude", &change(-1e-4), Some(0.046)).ends_with("4.6 %"));
        for large in [0.02, -0.02] {
            assert!(
                advice("amplitude", &change(large), Some(0.046)).starts_with("Halve run.time_step"),
                "{large}"
            );
        }
        assert!(advice("amplitude", &change(1e-4), None).starts_with("If that matters to you"));
    }
}
