//! What leaves the analysis of a record: `analysis.json`, the rows of its tables, its curves and the air of a case.

pub mod air;

use crate::Failure;
use crate::files::folder::Staging;
use crate::files::measured::{joined, values};
use crate::files::table::number;
use crate::files::{table, versioned_json};
use crate::numbers::{decimals, rounded, to_decimals};
use serde_json::{Value as Json, json};
use spunlaid_air::{Analysis, COMPONENT_MEASURES, Component, RECORD_MEASURES, Record};
use spunlaid_ground::{Interval, Measured, Value};

/// Half the width of an interval: the error of the value.
pub fn half_width(interval: &Interval) -> f64 {
    0.5 * (interval.high - interval.low)
}

/// The file.
pub fn analysis_json(record: &Record, analysis: &Analysis) -> String {
    let spectrum = analysis.components.first().map(|c| &c.spectrum);
    let reading = &record.reading;
    let about = json!({
        "record": {
            "file": record.file,
            "samples": analysis.samples,
            "rate_hz": 1.0 / analysis.interval,
            "duration_s": analysis.duration,
            "components": analysis.components.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(),
            "filled_samples": reading.filled,
            "skipped_rows": reading.skipped,
            "cut_off_rows": reading.cut_off,
            "largest_jitter": reading.jitter,
            "timed": reading.timed,
            "unused_columns": reading.unused,
        },
        "method": {
            "confidence": 0.95,
            "blocks": analysis.blocks,
            "integral": analysis.integral.words(),
            "autocorrelation": "unbiased",
            "window": spectrum.map_or("", |s| s.window.name()),
            "overlap": spectrum.map_or(0.0, |s| s.overlap),
            "segment_samples": spectrum.map_or(0, |s| s.segment),
            "segments": spectrum.map_or(0, |s| s.segments),
        },
    });
    let rest = json!({
        "components": analysis.components.iter().map(component).collect::<Json>(),
        // For intervals of ± 5 %.
        "duration_for_5_percent_s": {
            "turbulence_intensity": analysis.duration_for(&analysis.turbulence_intensity, 0.05),
            "integral_time": analysis.duration_for(&analysis.integral_time, 0.05),
            "cutoff_frequency": analysis.duration_for(&analysis.cutoff_frequency, 0.05),
        },
        "warnings": analysis.warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
    });
    versioned_json(1, joined([about, values(RECORD_MEASURES, analysis), rest]))
}

fn component(component: &Component) -> Json {
    joined([json!({"name": component.name}), values(COMPONENT_MEASURES, component)])
}

/// The value of a measure and the ends of its 95 % interval, as they are shown.
pub fn with_interval<T>(row: &Measured<T>, found: &T) -> [String; 3] {
    let interval = match row.value {
        Some(Value::Interval(interval)) => interval,
        _ => Interval::exactly(row.measure.number(found)),
    };
    let per_si = row.measure.unit.per_si;
    let half = half_width(&interval) * per_si;
    // A value that was given has no interval.
    let end = |end: f64| {
        decimals(half).map_or_else(|| "–".to_owned(), |decimals| to_decimals(end * per_si, decimals))
    };
    [rounded(interval.value * per_si, Some(half)).0, end(interval.low), end(interval.high)]
}

/// Writes the spectral density of each component over frequency, and its autocorrelation coefficient over the lag.
pub fn write_curves(staging: &Staging<'_>, analysis: &Analysis) -> Result<(), Failure> {
    let frequency = |i: usize| analysis.components.first().map_or(0.0, |c| c.spectrum.frequency(i));
    let lag = |i: usize| i as f64 * analysis.interval;
    write_curve(staging, analysis, ["spectrum", "frequency_hz", "_m2_s2_per_hz"], frequency, |c| {
        &c.spectrum.density
    })?;
    write_curve(staging, analysis, ["autocorrelation", "lag_s", "_coefficient"], lag, |c| {
        &c.autocorrelation.coefficients
    })
}

/// A column of x and one for each component, down to the end of the shortest curve.
fn write_curve(
    staging: &Staging<'_>,
    analysis: &Analysis,
    [name, head, unit]: [&str; 3],
    x: impl Fn(usize) -> f64,
    curve: for<'c> fn(&'c Component) -> &'c Vec<f64>,
) -> Result<(), Failure> {
    let plain = |component: &Component| component.name.replace([',', ';', '"', '\n', ' '], "_");
    let columns = analysis.components.iter().map(|component| number(plain(component) + unit));
    let columns: Vec<_> = std::iter::once(number(head)).chain(columns).collect();
    let mut curves = staging.table(name, &["csv"], &columns)?;
    for i in 0..analysis.components.iter().map(|c| curve(c).len()).min().unwrap_or(0) {
        let values = analysis.components.iter().map(|component| curve(component)[i]);
        let row: Vec<_> = std::iter::once(x(i)).chain(values).map(table::Value::Number).collect();
        curves.add(&row)?;
    }
    curves.finish()
}
