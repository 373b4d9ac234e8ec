//! Writes the files of an analysis.

mod air;
mod curves;
mod json;
mod table;

pub(crate) use air::air_block;
pub(crate) use curves::{autocorrelation_csv, spectrum_csv};
pub(crate) use json::analysis_json;
pub(crate) use table::{ResultRow, result_table, results};

use spunlaid::record::Interval;

/// Half the width of an interval: the error of the value.
pub(crate) fn half_width(of: &Interval) -> f64 {
    0.5 * (of.high - of.low)
}
