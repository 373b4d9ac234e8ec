//! Files of the analysis of a record.

mod air;
mod curves;
mod json;
mod table;

pub(crate) use air::air_block;
pub(crate) use curves::{autocorrelation_csv, spectrum_csv};
pub(crate) use json::analysis_json;
pub(crate) use table::{ResultRow, result_table, results};

use spunlaid::record::Interval;

/// Decimals that show an interval to two digits of half its width, and 0 to 9 of them.
pub(crate) fn decimals(interval: &Interval, factor: f64) -> usize {
    let half = 0.5 * (interval.high - interval.low).abs() * factor;
    let size = if half > 0.0 && half.is_finite() { half } else { 1e-3 * (interval.value * factor).abs() };
    if size > 0.0 && size.is_finite() { (1.0 - size.log10().floor()).clamp(0.0, 9.0) as usize } else { 3 }
}
