//! Writes `spectrum.csv` and `autocorrelation.csv`.

use spunlaid::record::{Analysis, Component};
use std::fmt::Write;

/// Spectral density of each component over frequency.
pub fn spectrum_csv(analysis: &Analysis) -> String {
    let frequency = |i: usize| analysis.components.first().map_or(0.0, |c| c.spectrum.frequency(i));
    curves("frequency_hz", "_m2_s2_per_hz", analysis, frequency, |c| &c.spectrum.density)
}

/// Autocorrelation coefficient of each component over the lag.
pub fn autocorrelation_csv(analysis: &Analysis) -> String {
    curves(
        "lag_s",
        "_coefficient",
        analysis,
        |i| i as f64 * analysis.interval,
        |c| &c.autocorrelation.coefficients,
    )
}

/// A column of x and one for each component, down to the end of the shortest curve.
fn curves(
    head: &str,
    unit: &str,
    analysis: &Analysis,
    x: impl Fn(usize) -> f64,
    curve: impl Fn(&Component) -> &Vec<f64>,
) -> String {
    let mut text = head.to_owned();
    for component in &analysis.components {
        let name = component.name.replace([',', ';', '"', '\n', ' '], "_");
        let _ = write!(text, ",{name}{unit}");
    }
    text.push('\n');
    let length = analysis.components.iter().map(|c| curve(c).len()).min().unwrap_or(0);
    for i in 0..length {
        let _ = write!(text, "{}", x(i));
        for component in &analysis.components {
            let _ = write!(text, ",{:e}", curve(component)[i]);
        }
        text.push('\n');
    }
    text
}
