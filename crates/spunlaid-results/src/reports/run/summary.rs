//! `summary.json`: all results of a run.

use super::doubt::{self, FromFinest};
use crate::files::measured::{joined, known};
use crate::files::origin::Performance;
use crate::files::versioned_json;
use crate::reports::load;
use crate::reports::spinline::files as spinline;
use serde_json::{Value as Json, json};
use spunlaid_fibre::Case;
use spunlaid_fibre::case::keys;
use spunlaid_fibre::case::keys::{Content, Value};
use spunlaid_ground::{Aggregate, Dimension, Estimate};
use spunlaid_simulation::{FinerCheck, FinerChecks, LostFibre, Number, Results};
use std::path::Path;

/// The text of the file.
pub fn summary(
    case: &Case,
    results: &Results,
    checks: &FinerChecks,
    performance: Performance,
    notes: &[String],
) -> String {
    let about = json!({
        "case": resolved(case),
        // By what it depends on: runs that agree in all of it flew in the same eddies.
        "turbulence": turbulence(case),
        // Of a case that is fed from a spinline, and what the filaments do to their air where it has a curtain.
        "spinline": spinline::part_of_case(case),
        "curtain": load::load_of_spinline(case, &results.way()).as_ref().map(load::summary),
        "elements": case.fibre.elements,
        "steps": case.run.steps,
        "replicates": case.run.replicates,
        // They have no place in a mean, and a null among the values.
        "lost": results.lost.len(),
        "lost_fibres": lost_fibres(&results.lost),
    });
    // The measures by group; the name of a group within another one has a point: `laydown.surrogate`.
    let mut measures = json!({});
    for number in &results.numbers {
        let group = number.measure.group.name.split('.').fold(&mut measures, |outer, name| &mut outer[name]);
        group[number.measure.column] = summary_of(number, checks);
    }
    let rest = json!({
        // Null if the run is too short for it, or if the fibres do not move across the flow.
        "step_check": checks.step.as_ref().ok().map(check),
        "mesh_check": checks.mesh.as_ref().ok().map(check),
        "performance": performance,
        "notes": notes,
    });
    versioned_json(4, joined([known(about), measures, rest]))
}

/// The identity of the turbulence, by its parts.
fn turbulence(case: &Case) -> Json {
    let parts = case.turbulence().into_iter().map(|(what, sum)| (what.to_owned(), sum.into()));
    Json::Object(parts.collect())
}

/// Fibres that were lost, counted from 1.
pub fn lost_fibres(lost: &[LostFibre]) -> Json {
    let entry = |LostFibre { replicate, time, reason, .. }: &LostFibre| {
        let number = replicate + 1;
        json!({"replicate": number, "time_s": time, "reason": reason})
    };
    lost.iter().map(entry).collect()
}

/// Change of the free end's motion, or of the laid fibre, from a finer discretisation to that of the run, in the same
/// turbulence: `path_difference`, the rms distance between two paths, divided by the amplitude; and the relative
/// changes of statistics.
fn check(check: &FinerCheck) -> Json {
    let mut object = json!({
        "duration_s": check.duration,
        // Computing time, counted in steps of elements.
        "share_of_run": check.share_of_run,
        "finer_scheme": check.scheme.name(),
        "finer_time_step_s": check.time_step,
        "finer_element_length_m": check.element_length,
    });
    for (name, difference, error_over_difference) in check.differences() {
        let factor = json!({"error_over_difference": error_over_difference});
        object[name] = joined([with_values(difference), factor]);
    }
    object
}

/// A result over the replicates. Some have a median or a largest value, which then represents all replicates; a mean,
/// also that of the largest values, has its whole error, as headline and tables have it, or what says that it has not
/// converged.
fn summary_of(number: &Number, checks: &FinerChecks) -> Json {
    let estimate = with_values(&number.estimate);
    let name = number.measure.name;
    let error = || {
        let whole = doubt::with_error_of_checks(number.estimate.clone(), name, checks);
        json!({"error": whole.standard_error})
    };
    let open = || match doubt::not_converged(name, checks) {
        Some(FromFinest { length, difference, size }) => {
            let share = json!({"element_length_m": length, "difference": difference});
            let size = size.map_or(json!({}), |size| json!({"root_mean_square": size}));
            json!({"not_converged": joined([share, size])})
        }
        None => match doubt::why_unknown(name, checks) {
            Some(why) => json!({"why_no_error": why}),
            None => json!({}),
        },
    };
    match number.measure.aggregate {
        Aggregate::Median => joined([json!({"median": number.value()}), estimate]),
        Aggregate::Largest => joined([json!({"largest": number.value()}), error(), estimate, open()]),
        Aggregate::Mean => joined([error(), estimate, open()]),
    }
}

/// A mean, its error by chance alone, and the values of the replicates.
fn with_values(estimate: &Estimate) -> Json {
    let Estimate { mean, standard_error, values } = estimate;
    json!({"mean": mean, "standard_error": standard_error, "values": values})
}

/// The resolved case: every key, with its SI unit in the name. A key without a meaning for the case is null. If the
/// flow is not uniform, the numbers are averages along the fibre.
pub fn resolved(case: &Case) -> Json {
    let mut all = json!({});
    for table in keys::TABLES {
        // A table within another one has a point.
        let into = table.split('.').fold(&mut all, |outer, name| &mut outer[name]);
        for key in keys::keys_of_table(table) {
            let unit = key.dimension().map(Dimension::suffix).unwrap_or_default();
            into[format!("{}{unit}", key.short())] = key.get(case).map_or(Json::Null, value_of);
        }
    }
    all["air"]["flow"] = case.air.flow.name().into();
    all["air"]["records"] = case.air.records.len().into();
    all
}

/// A value as JSON. Files are given by their names without folders.
fn value_of(value: Value) -> Json {
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
