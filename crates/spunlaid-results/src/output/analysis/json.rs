//! Writes `analysis.json` with every result of an analysis.

use crate::output::in_order::OrderedObject;
use crate::output::measured::values;
use crate::output::versioned_json;
use serde::Serialize;
use spunlaid::observe::{OF_COMPONENTS, OF_RECORDS, Value};
use spunlaid::record::{Analysis, Component, Record};

#[derive(Serialize)]
struct Json<'a> {
    record: RecordJson<'a>,
    method: Method,
    #[serde(flatten)]
    findings: OrderedObject<Option<Value>>,
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
    #[serde(flatten)]
    findings: OrderedObject<Option<Value>>,
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
        findings: values(OF_RECORDS, analysis),
        components: analysis.components.iter().map(component).collect(),
        duration_for_5_percent_s: Durations {
            turbulence_intensity: analysis.duration_for(&analysis.turbulence_intensity, 0.05),
            integral_time: analysis.duration_for(&analysis.integral_time, 0.05),
            cutoff_frequency: analysis.duration_for(&analysis.cutoff_frequency, 0.05),
        },
        warnings: analysis.warnings.iter().map(ToString::to_string).collect(),
    };
    versioned_json(1, &json)
}

fn component(component: &Component) -> ComponentJson<'_> {
    ComponentJson { name: &component.name, findings: values(OF_COMPONENTS, component) }
}
