//! `summary.json`: all results of a run.

use super::doubt;
use super::in_order::OrderedObject;
use super::load::LoadSummary;
use super::spinline::SpinSummary;
use serde::Serialize;
use serde_json::Value as Json;
use spunlaid::case::Case;
use spunlaid::case::keys::{self, Content, Key, Value};
use spunlaid::ensemble::{FinerCheck, FinerChecks, LostFibre, Number, Results};
use spunlaid::observe::Aggregate;
use spunlaid::statistics::Estimate;
use spunlaid::units::Dimension;
use std::collections::BTreeMap;
use std::path::Path;

/// The content of `summary.json` of a run.
#[derive(Debug, Serialize)]
pub struct Summary<'a> {
    case: OrderedObject<OrderedObject<Json>>,
    /// Of a case that is fed from a spinline.
    #[serde(skip_serializing_if = "Option::is_none")]
    spinline: Option<SpinSummary>,
    /// What the filaments do to their air, where the spinline has a curtain of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    curtain: Option<LoadSummary>,
    elements: usize,
    steps: u64,
    replicates: u64,
    /// Number of fibres that were lost. They have no place in a mean, and a null among the values.
    lost: usize,
    lost_fibres: Vec<LostSummary<'a>>,
    /// `end_node`, `fibre`, `energy`, `laydown`: the measures by group.
    #[serde(flatten)]
    measures: GroupSummary<'a>,
    /// Null if the run is too short for it, or if the fibres do not move across the flow.
    step_check: Option<FinerSummary<'a>>,
    /// The same of the elements.
    mesh_check: Option<FinerSummary<'a>>,
    performance: Performance,
    notes: Vec<String>,
}

/// A fibre that was lost.
#[derive(Debug, Serialize)]
pub struct LostSummary<'a> {
    /// Counted from 1.
    replicate: u64,
    time_s: f64,
    reason: &'a str,
}

/// Change of the free end's motion, or of the laid fibre, from a finer discretisation to that of the run, in the same
/// turbulence.
#[derive(Debug, Serialize)]
struct FinerSummary<'a> {
    /// Time from the start over which both are compared.
    duration_s: f64,
    /// Computing time as a share of the run, counted in steps of elements.
    share_of_run: f64,
    /// The finer discretisation.
    finer_scheme: &'static str,
    finer_time_step_s: f64,
    finer_element_length_m: f64,
    /// `path_difference`, the rms distance between two paths, divided by the amplitude; and the relative changes of
    /// statistics: `amplitude_difference`.
    #[serde(flatten)]
    differences: BTreeMap<String, DifferenceSummary<'a>>,
}

#[derive(Debug, Serialize)]
struct DifferenceSummary<'a> {
    #[serde(flatten)]
    difference: NumberSummary<'a>,
    /// Factor from the difference to the error of the run; null where it is not known.
    error_over_difference: Option<f64>,
}

impl<'a> DifferenceSummary<'a> {
    fn named(
        (name, difference, error_over_difference): (String, &'a Estimate, Option<f64>),
    ) -> (String, Self) {
        (name, Self { difference: summarise_mean(difference), error_over_difference })
    }
}

impl<'a> FinerSummary<'a> {
    fn new(check: &'a FinerCheck) -> Self {
        Self {
            duration_s: check.duration,
            share_of_run: check.share_of_run,
            finer_scheme: check.scheme.name(),
            finer_time_step_s: check.time_step,
            finer_element_length_m: check.element_length,
            differences: check.differences().map(DifferenceSummary::named).collect(),
        }
    }
}

/// A result over the replicates: mean, standard error and the values of the replicates. Some results also have a
/// median or a largest value, which then represents all replicates.
#[derive(Debug, Serialize)]
struct NumberSummary<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    median: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    largest: Option<f64>,
    mean: f64,
    /// By chance alone.
    standard_error: Option<f64>,
    /// By chance and by what the checks found beyond their limit, as headline and tables have it; of means alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<Option<f64>>,
    values: &'a [f64],
}

/// The measures of a group by the names of their columns, and the groups within it by theirs.
type GroupSummary<'a> = BTreeMap<&'static str, Member<'a>>;

/// What a group consists of.
#[derive(Debug, Serialize)]
#[serde(untagged)]
enum Member<'a> {
    Number(NumberSummary<'a>),
    Group(GroupSummary<'a>),
}

/// The speed of the run. This is the only part that differs when a run is repeated.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Performance {
    /// Wall-clock time of the flights [s].
    pub wall_s: f64,
    /// Number of threads.
    pub threads: usize,
    /// Number of steps of single elements.
    pub element_steps: u64,
    /// Time that one thread needs for one element and one step of one fibre.
    pub ns_per_element_step: f64,
    /// Name of the instruction set.
    pub instruction_set: &'static str,
}

impl<'a> Summary<'a> {
    /// Gathers everything.
    pub fn new(
        case: &Case,
        results: &'a Results,
        checks: &'a FinerChecks,
        performance: Performance,
        notes: Vec<String>,
    ) -> Self {
        let mut measures = GroupSummary::new();
        for number in &results.numbers {
            let summary = summary_of(number, checks, case);
            insert(&mut measures, number.measure.group.name, (number.measure.column, summary));
        }
        Self {
            case: resolved(case),
            spinline: SpinSummary::from_case(case),
            curtain: LoadSummary::of_spinline(case, &results.way()),
            elements: case.fibre.elements,
            steps: case.run.steps,
            replicates: case.run.replicates,
            lost: results.lost.len(),
            lost_fibres: results.lost.iter().map(LostSummary::from).collect(),
            measures,
            step_check: checks.step.as_ref().ok().map(FinerSummary::new),
            mesh_check: checks.mesh.as_ref().ok().map(FinerSummary::new),
            performance,
            notes,
        }
    }

    /// The text of the file.
    pub fn to_json(&self) -> String {
        super::versioned_json(4, self)
    }
}

/// Puts a number into its group. The name of a group within another one has a point: `laydown.surrogate`.
fn insert<'a>(
    into: &mut GroupSummary<'a>,
    group: &'static str,
    (column, number): (&'static str, NumberSummary<'a>),
) {
    let (outer, inner) = group.split_once('.').map_or((group, None), |(outer, inner)| (outer, Some(inner)));
    let member = into.entry(outer).or_insert_with(|| Member::Group(BTreeMap::new()));
    let Member::Group(members) = member else { return };
    match inner {
        Some(inner) => insert(members, inner, (column, number)),
        None => drop(members.insert(column, Member::Number(number))),
    }
}

fn summary_of<'a>(number: &'a Number, checks: &FinerChecks, case: &Case) -> NumberSummary<'a> {
    let whole = || doubt::with_error_of_checks(number.estimate.clone(), number.measure.name, checks, case);
    let value_if = |aggregate| (number.measure.aggregate == aggregate).then(|| number.value());
    NumberSummary {
        median: value_if(Aggregate::Median),
        largest: value_if(Aggregate::Largest),
        error: (number.measure.aggregate == Aggregate::Mean).then(|| whole().standard_error),
        ..summarise_mean(&number.estimate)
    }
}

impl<'a> From<&'a LostFibre> for LostSummary<'a> {
    fn from(fibre: &'a LostFibre) -> Self {
        Self { replicate: fibre.replicate + 1, time_s: fibre.time, reason: &fibre.reason }
    }
}

fn summarise_mean(estimate: &Estimate) -> NumberSummary<'_> {
    let Estimate { mean, standard_error, values } = estimate;
    let standard_error = *standard_error;
    NumberSummary { median: None, largest: None, mean: *mean, standard_error, error: None, values }
}

/// The resolved case: every key, with its SI unit in the name. A key without a meaning for the case is null. If the
/// flow is not uniform, the numbers are averages along the fibre.
pub fn resolved(case: &Case) -> OrderedObject<OrderedObject<Json>> {
    let table = |name: &'static str| {
        let entry = |key: &Key| {
            let unit = key.dimension().map(Dimension::suffix).unwrap_or_default();
            (format!("{}{unit}", key.short()), key.get(case).map_or(Json::Null, json))
        };
        let mut entries: Vec<(String, Json)> = keys::keys_of_table(name).map(entry).collect();
        if name == "air" {
            entries.push(("flow".to_owned(), case.air.flow.name().into()));
            entries.push(("records".to_owned(), case.air.records.len().into()));
        }
        entries
    };
    let mut tables: Vec<(String, OrderedObject<Json>)> = Vec::new();
    for name in keys::TABLES {
        match (name.split_once('.'), tables.last_mut()) {
            // A table within the one before it.
            (Some((_, short)), Some((_, OrderedObject(entries)))) => {
                let inner = table(name).into_iter().collect();
                entries.push((short.to_owned(), Json::Object(inner)));
            }
            _ => tables.push((name.to_owned(), OrderedObject(table(name)))),
        }
    }
    OrderedObject(tables)
}

/// A value as JSON. Files are given by their names without folders.
fn json(value: Value) -> Json {
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    match value {
        Value::Number(value) => value.into(),
        Value::Whole(value) => value.into(),
        Value::Text(text) => text.into(),
        Value::Vector(v) => vec![v.x, v.y, v.z].into(),
        Value::Numbers(numbers) => numbers.into(),
        Value::Content(Content::Spectrum(_)) => "measured".into(),
        Value::Content(content) => content.paths().into_iter().map(name).collect(),
        _ => Json::Null,
    }
}
