//! What changes do to the CV of a web, in `summary.json`: those of the line at the same basis weight, and
//! other values of assumed values.

use crate::command::web_command;
use crate::files::measured::{joined, known};
use serde_json::{Value as Json, json};
use spunlaid_experiment::{Advice, Change, ChangedWeb, SensitivityRun};
use spunlaid_ground::{ChangedKey, Effect};
use spunlaid_simulation::LayerSpec;
use spunlaid_web::map::Findings;

/// Seconds of an hour.
pub(crate) const HOUR: f64 = 3600.0;

/// What was tried with a web.
#[derive(Clone, Copy, Debug)]
pub struct Advised<'a> {
    /// What would make it more uniform; None if it was not tried.
    pub advice: Option<&'a Advice>,
    /// What assumed values matter for it; None if these were not tried.
    pub assumed_values: Option<&'a Advice>,
    /// Whether what was not tried is tried next.
    pub awaited: bool,
    /// The folder of the web, next to which the folders of changed webs are.
    pub beside: &'a str,
}

/// Changes of the line.
///
/// * `beside` – the folder of the web
pub(super) fn of_line(advice: &Advice, findings: &Findings, beside: &str) -> Json {
    let changes = changed_webs(advice, findings, beside, false);
    with_failed(json!({"judged_by_patch_m": advice.judged_by, "changes": changes}), advice)
}

/// Other values of assumed values, and the CVs of all webs with these and of the web as it is.
pub(super) fn of_assumed_values(assumed_values: &Advice, findings: &Findings, beside: &str) -> Json {
    let range = |effect: &Effect<f64>| {
        let cv = cv_over(findings, effect.of);
        let [cv_from, cv_to] = assumed_values.range(effect.of).map(|ratio| ratio * cv);
        json!({"patch_m": effect.of, "cv_from": cv_from, "cv_to": cv_to})
    };
    let ranges = assumed_values.tried.iter().take(1).flat_map(|first| first.effects.iter().map(range));
    let ranges: Json = ranges.collect();
    let values = changed_webs(assumed_values, findings, beside, true);
    with_failed(
        json!({"judged_by_patch_m": assumed_values.judged_by, "ranges": ranges, "values": values}),
        assumed_values,
    )
}

fn keys(change: &Change) -> Vec<Json> {
    let key = |changed: &ChangedKey| {
        let written =
            if changed.whole { format!("{:.0}", changed.to) } else { changed.dimension.exact(changed.to) };
        let unit = changed.dimension.si_unit();
        json!({"key": changed.key, "from": changed.from, "to": changed.to, "unit": unit, "written": written})
    };
    change.keys.iter().map(key).collect()
}

/// The layer that changes, if it is the only one.
fn alone(change: &Change) -> Option<usize> {
    if let [layer] = change.layers[..] { Some(layer) } else { None }
}

/// The CV of the web as it is.
fn cv_over(findings: &Findings, patch: f64) -> f64 {
    let found = findings.patches.iter().find(|found| found.map.patch == patch);
    found.and_then(|found| found.reported()).map_or(f64::NAN, |reported| reported.cv)
}

/// Adds the changes that could not be simulated or laid, if there are any.
fn with_failed(mut object: Json, advice: &Advice) -> Json {
    let failed = |(change, why): &(Change, String)| {
        let (setting, layer) = (change.setting.name, alone(change));
        json!({"setting": setting, "layer": layer, "keys": keys(change), "why": why})
    };
    if !advice.failed.is_empty() {
        object["failed"] = advice.failed.iter().map(failed).collect();
    }
    object
}

fn changed_webs(advice: &Advice, findings: &Findings, beside: &str, are_assumed: bool) -> Json {
    let patch = |tried: &SensitivityRun, effect: &Effect<f64>| {
        let (cv, difference) = (cv_over(findings, effect.of), &effect.difference);
        let at_first = tried.at_first.iter().find(|first| first.of == effect.of);
        let object = json!({
            "patch_m": effect.of,
            "cv": cv * (1.0 + difference.value),
            "cv_difference_standard_error": cv * difference.standard_error,
            // As a share of the CV; its standard error is null for a single fibre.
            "cv_change": difference.value,
            "standard_error": difference.standard_error,
            "significant": difference.is_significant(),
        });
        // The part of the change that filaments in shared turbulence make each for itself; the rest is that of their
        // clouds. Of a change that was simulated again, that in the first air.
        let more = json!({
            "of_own_part": effect.own,
            "clouds_in_common": effect.in_common,
            "first_cv_change": at_first.map(|first| first.difference.value),
        });
        joined([object, known(more)])
    };
    let changed_web = |tried: &SensitivityRun| {
        let SensitivityRun { change, effects, at_first } = tried;
        let ChangedWeb { set, spec, belt_speed, mass_flow, .. } = &change.experiment;
        let assumed = keys(change).into_iter().next().filter(|_| are_assumed).unwrap_or_default();
        let layer = alone(change);
        let titre = |layer: &LayerSpec| layer.fed_filament().linear_density();
        let mut object = json!({
            "setting": change.setting.name,
            "turned": change.setting.turned.name(),
            // Counted from 1; null where several or all layers change.
            "layer": layer,
            "keys": keys(change),
            // With these values the file is the changed web.
            "set": set.iter().map(|(key, value)| (key.as_str(), value.as_str())).collect::<Json>(),
            "command": web_command(change, beside),
            "belt_speed_m_s": belt_speed[1],
            "belt_speed_change": belt_speed[1] / belt_speed[0] - 1.0,
            "throughput_kg_h_m": HOUR * mass_flow[1],
            // Of a filament of each layer.
            "linear_density_kg_m": spec.layers.iter().map(titre).collect::<Json>(),
            "throughput_change": mass_flow[1] / mass_flow[0] - 1.0,
        });
        if layer.is_none() && !change.layers.is_empty() {
            object["layers"] = change.layers.as_slice().into();
        }
        if advice.is_confirmed {
            object["simulated_again"] = (!at_first.is_empty()).into();
        }
        object["patches"] = effects.iter().map(|effect| patch(tried, effect)).collect();
        joined([assumed, object])
    };
    advice.tried.iter().map(changed_web).collect()
}
