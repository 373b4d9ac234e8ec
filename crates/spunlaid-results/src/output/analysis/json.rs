//! Writes `analysis.json` with every result of an analysis.

use crate::output::measured::{joined, values};
use crate::output::versioned_json;
use serde_json::{Value as Json, json};
use spunlaid::observe::{OF_COMPONENTS, OF_RECORDS};
use spunlaid::record::{Analysis, Component, Record};

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
    versioned_json(1, joined([about, values(OF_RECORDS, analysis), rest]))
}

fn component(component: &Component) -> Json {
    joined([json!({"name": component.name}), values(OF_COMPONENTS, component)])
}
