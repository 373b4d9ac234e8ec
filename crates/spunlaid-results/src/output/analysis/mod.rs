//! Writes the files of an analysis.

mod air;
mod curves;
mod json;
mod table;

pub use air::air_block;
pub use curves::write_curves;
pub use json::analysis_json;
pub use table::{ResultRow, results};

use spunlaid::record::Interval;

/// Half the width of an interval: the error of the value.
pub fn half_width(interval: &Interval) -> f64 {
    0.5 * (interval.high - interval.low)
}
