//! `summary.json`: every result of a run.

use serde::{Serialize, Serializer};
use serde_json::Value as Json;
use spunlaid::case::Case;
use spunlaid::case::keys::{self, Content, Key, Value};
use spunlaid::ensemble::{LedgerError, Results};
use spunlaid::statistics::Estimate;
use spunlaid::units::Dimension;
use std::path::Path;

/// Version of the layout; raised when a field is renamed, removed or changes its meaning.
const SCHEMA_VERSION: u32 = 1;

#[derive(Debug, Serialize)]
pub(crate) struct Summary<'a> {
    schema_version: u32,
    spunlaid_version: &'static str,
    case: InOrder<InOrder<Json>>,
    elements: usize,
    steps: u64,
    replicates: u64,
    end_node: EndNode<'a>,
    energy: Energy,
    fibre: FibreSummary,
    performance: Performance,
    notes: Vec<String>,
}

#[derive(Debug, Serialize)]
struct EndNode<'a> {
    amplitude_y_m: EstimateSummary<'a>,
    amplitude_z_m: EstimateSummary<'a>,
    frequency_y_hz: EstimateSummary<'a>,
    frequency_z_hz: EstimateSummary<'a>,
    mean_x_m: EstimateSummary<'a>,
}

#[derive(Debug, Serialize)]
struct EstimateSummary<'a> {
    mean: f64,
    standard_error: Option<f64>,
    values: &'a [f64],
}

#[derive(Debug, Serialize)]
struct Energy {
    work_error_percent: ErrorSummary,
    balance_error_percent: ErrorSummary,
    tension_dissipation_percent: ErrorSummary,
}

#[derive(Debug, Serialize)]
struct ErrorSummary {
    final_mean: f64,
    time_median: f64,
}

#[derive(Debug, Serialize)]
struct FibreSummary {
    max_strain: f64,
    /// Share of the time outside of what the flow knows; null in a uniform flow.
    share_outside_flow: Option<f64>,
}

/// How fast it went; the only part that differs from run to run.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Performance {
    pub(crate) wall_s: f64,
    pub(crate) threads: usize,
    pub(crate) element_steps: u64,
    /// Time of one thread for an element and step of one fibre.
    pub(crate) ns_per_element_step: f64,
    pub(crate) instruction_set: &'static str,
}

/// An object whose entries keep their order.
#[derive(Debug)]
struct InOrder<T>(Vec<(String, T)>);

impl<T: Serialize> Serialize for InOrder<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}

impl<'a> Summary<'a> {
    pub(crate) fn new(
        case: &Case,
        results: &'a Results,
        performance: Performance,
        notes: Vec<String>,
    ) -> Self {
        let end = &results.end_node;
        Self {
            schema_version: SCHEMA_VERSION,
            spunlaid_version: env!("CARGO_PKG_VERSION"),
            case: resolved(case),
            elements: case.fibre.elements,
            steps: case.run.steps,
            replicates: case.run.replicates,
            end_node: EndNode {
                amplitude_y_m: estimate(&end.amplitude_y),
                amplitude_z_m: estimate(&end.amplitude_z),
                frequency_y_hz: estimate(&end.frequency_y),
                frequency_z_hz: estimate(&end.frequency_z),
                mean_x_m: estimate(&end.mean_x),
            },
            energy: Energy {
                work_error_percent: ledger(results.work_error_percent),
                balance_error_percent: ledger(results.balance_error_percent),
                tension_dissipation_percent: ledger(results.tension_dissipation_percent),
            },
            fibre: FibreSummary { max_strain: results.max_strain, share_outside_flow: results.outside },
            performance,
            notes,
        }
    }

    pub(crate) fn to_json(&self) -> String {
        // Serialising plain numbers and strings into memory cannot fail.
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        text
    }
}

fn estimate(of: &Estimate) -> EstimateSummary<'_> {
    EstimateSummary { mean: of.mean, standard_error: of.standard_error, values: &of.values }
}

fn ledger(of: LedgerError) -> ErrorSummary {
    ErrorSummary { final_mean: of.final_mean, time_median: of.time_median }
}

/// The resolved case: every key, its SI unit in the name; null where the key means nothing to the case. Of a flow
/// that is not uniform, the numbers are those along the fibre.
fn resolved(case: &Case) -> InOrder<InOrder<Json>> {
    let table = |name: &'static str| {
        let entry = |key: &Key| {
            let unit = key.dimension().map(Dimension::suffix).unwrap_or_default();
            (format!("{}{unit}", key.short()), key.get(case).map_or(Json::Null, json))
        };
        let mut entries: Vec<(String, Json)> = keys::of_table(name).map(entry).collect();
        if name == "air" {
            entries.push(("flow".to_owned(), case.air.flow.name().into()));
            entries.push(("records".to_owned(), case.air.records.len().into()));
        }
        (name.to_owned(), InOrder(entries))
    };
    InOrder(keys::TABLES.map(table).into())
}

/// Files are called by their names, wherever they lie.
fn json(value: Value) -> Json {
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    match value {
        Value::Number(value) => value.into(),
        Value::Whole(value) => value.into(),
        Value::Text(text) => text.into(),
        Value::Vector(v) => vec![v.x, v.y, v.z].into(),
        Value::Content(Content::Spectrum(_)) => "measured".into(),
        Value::Content(content) => content.paths().into_iter().map(name).collect(),
        _ => Json::Null,
    }
}
