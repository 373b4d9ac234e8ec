//! Writes `analysis.json` with every result of an analysis.

use crate::output::json_text;
use serde::Serialize;
use spunlaid::record::{Analysis, Component, Interval, Record};

/// Version of the layout; raised when a field is renamed, removed or changes its meaning.
const SCHEMA_VERSION: u32 = 1;

#[derive(Serialize)]
struct Json<'a> {
    schema_version: u32,
    spunlaid_version: &'static str,
    record: RecordJson<'a>,
    method: Method,
    mean_velocity_m_s: Interval,
    turbulence_intensity: Interval,
    integral_time_s: Interval,
    length_scale_m: Interval,
    cutoff_frequency_hz: Interval,
    components: Vec<ComponentJson<'a>>,
    /// Durations for intervals of ± 5 %.
    duration_for_5_percent_s: Durations,
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct RecordJson<'a> {
    file: &'a str,
    samples: usize,
    rate_hz: f64,
    duration_s: f64,
    components: Vec<&'a str>,
    filled_samples: usize,
    skipped_rows: usize,
    cut_off_rows: usize,
    largest_jitter: f64,
    timed: bool,
    unused_columns: &'a [String],
}

#[derive(Serialize)]
struct Method {
    confidence: f64,
    blocks: usize,
    integral: String,
    autocorrelation: &'static str,
    window: &'static str,
    overlap: f64,
    segment_samples: usize,
    segments: usize,
}

#[derive(Serialize)]
struct ComponentJson<'a> {
    name: &'a str,
    mean_m_s: Interval,
    rms_m_s: Interval,
    skewness: Interval,
    flatness: Interval,
    minimum_m_s: f64,
    maximum_m_s: f64,
    integral_time_s: Interval,
    integral_limit_s: f64,
    integral_time_of_plateau_s: f64,
    plateau_m2_s2_per_hz: Interval,
    plateau_until_hz: f64,
    cutoff_frequency_hz: Interval,
    drift_of_mean_m_s: Interval,
    drift_of_rms_m_s: Interval,
}

#[derive(Serialize)]
struct Durations {
    turbulence_intensity: f64,
    integral_time: f64,
    cutoff_frequency: f64,
}

/// The file.
pub fn analysis_json(record: &Record, analysis: &Analysis) -> String {
    let spectrum = analysis.components.first().map(|c| &c.spectrum);
    let json = Json {
        schema_version: SCHEMA_VERSION,
        spunlaid_version: env!("CARGO_PKG_VERSION"),
        record: RecordJson {
            file: &record.file,
            samples: analysis.samples,
            rate_hz: 1.0 / analysis.interval,
            duration_s: analysis.duration,
            components: analysis.components.iter().map(|c| c.name.as_str()).collect(),
            filled_samples: record.reading.filled,
            skipped_rows: record.reading.skipped,
            cut_off_rows: record.reading.cut_off,
            largest_jitter: record.reading.jitter,
            timed: record.reading.timed,
            unused_columns: &record.reading.unused,
        },
        method: Method {
            confidence: 0.95,
            blocks: analysis.blocks,
            integral: analysis.integral.words(),
            autocorrelation: "unbiased",
            window: spectrum.map_or("", |s| s.window.name()),
            overlap: spectrum.map_or(0.0, |s| s.overlap),
            segment_samples: spectrum.map_or(0, |s| s.segment),
            segments: spectrum.map_or(0, |s| s.segments),
        },
        mean_velocity_m_s: analysis.mean_velocity,
        turbulence_intensity: analysis.turbulence_intensity,
        integral_time_s: analysis.integral_time,
        length_scale_m: analysis.length_scale,
        cutoff_frequency_hz: analysis.cutoff_frequency,
        components: analysis.components.iter().map(component).collect(),
        duration_for_5_percent_s: Durations {
            turbulence_intensity: analysis.duration_for(&analysis.turbulence_intensity, 0.05),
            integral_time: analysis.duration_for(&analysis.integral_time, 0.05),
            cutoff_frequency: analysis.duration_for(&analysis.cutoff_frequency, 0.05),
        },
        warnings: analysis.warnings.iter().map(ToString::to_string).collect(),
    };
    json_text(&json)
}

fn component(component: &Component) -> ComponentJson<'_> {
    ComponentJson {
        name: &component.name,
        mean_m_s: component.mean,
        rms_m_s: component.rms,
        skewness: component.skewness,
        flatness: component.flatness,
        minimum_m_s: component.range.0,
        maximum_m_s: component.range.1,
        integral_time_s: component.integral_time,
        integral_limit_s: component.autocorrelation.limit,
        integral_time_of_plateau_s: component.flat.integral_time(),
        plateau_m2_s2_per_hz: component.flat.density,
        plateau_until_hz: component.flat.until,
        cutoff_frequency_hz: component.flat.cutoff,
        drift_of_mean_m_s: component.mean_trend.change,
        drift_of_rms_m_s: component.rms_trend.change,
    }
}
