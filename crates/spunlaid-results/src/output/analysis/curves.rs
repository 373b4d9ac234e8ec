//! Writes the spectra and the autocorrelations of a record.

use crate::Failure;
use crate::output::folder::Staging;
use crate::output::table::{Value, number};
use spunlaid::record::{Analysis, Component};

/// Writes the spectral density of each component over frequency, and its autocorrelation coefficient over the lag.
pub fn write_curves(staging: &Staging<'_>, analysis: &Analysis) -> Result<(), Failure> {
    let frequency = |i: usize| analysis.components.first().map_or(0.0, |c| c.spectrum.frequency(i));
    let lag = |i: usize| i as f64 * analysis.interval;
    write(staging, analysis, ["spectrum", "frequency_hz", "_m2_s2_per_hz"], frequency, |c| {
        &c.spectrum.density
    })?;
    write(staging, analysis, ["autocorrelation", "lag_s", "_coefficient"], lag, |c| {
        &c.autocorrelation.coefficients
    })
}

/// A column of x and one for each component, down to the end of the shortest curve.
fn write(
    staging: &Staging<'_>,
    analysis: &Analysis,
    [name, head, unit]: [&str; 3],
    x: impl Fn(usize) -> f64,
    curve: for<'c> fn(&'c Component) -> &'c Vec<f64>,
) -> Result<(), Failure> {
    let plain = |component: &Component| component.name.replace([',', ';', '"', '\n', ' '], "_");
    let columns = analysis.components.iter().map(|component| number(plain(component) + unit));
    let columns: Vec<_> = std::iter::once(number(head)).chain(columns).collect();
    let mut table = staging.table(name, &["csv"], &columns)?;
    for i in 0..analysis.components.iter().map(|c| curve(c).len()).min().unwrap_or(0) {
        let values = analysis.components.iter().map(|component| curve(component)[i]);
        let row: Vec<Value> = std::iter::once(x(i)).chain(values).map(Value::Number).collect();
        table.add(&row)?;
    }
    table.finish()
}
