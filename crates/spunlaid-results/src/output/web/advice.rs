//! What would make a web more even, in `summary.json`.

use crate::command::web_command;
use serde::Serialize;
use spunlaid::advice::{Advice, Change, ChangedKey, CvChange, Effect};
use std::collections::BTreeMap;

/// Seconds of an hour.
pub(crate) const HOUR: f64 = 3600.0;

/// What changed settings of the line do to the CV at the same basis weight.
#[derive(Debug, Serialize)]
pub(super) struct AdviceSummary {
    changes: Vec<ChangeSummary>,
    /// Changes that could not be flown or laid.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    failed: Vec<Failure>,
}

#[derive(Debug, Serialize)]
struct ChangeSummary {
    setting: &'static str,
    /// Number of the layer, from 1; null where several or all layers change.
    layer: Option<usize>,
    /// Numbers of equal layers that change together.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    layers: Vec<usize>,
    keys: Vec<Key>,
    /// Keys and values with which the file is the changed web, and the command that lays it.
    set: BTreeMap<String, String>,
    command: String,
    belt_speed_m_s: f64,
    /// Change as a share of the speed.
    belt_speed_change: f64,
    throughput_kg_h_m: f64,
    throughput_change: f64,
    /// Whether it was among the best in one air and the numbers are from another one.
    #[serde(skip_serializing_if = "Option::is_none")]
    flown_again: Option<bool>,
    patches: Vec<Patch>,
}

#[derive(Debug, Serialize)]
pub(super) struct Key {
    key: String,
    from: f64,
    to: f64,
    /// Unit of both; empty for pure numbers.
    unit: &'static str,
    /// The new value as it is written in a file.
    written: String,
}

#[derive(Debug, Serialize)]
struct Patch {
    patch_m: f64,
    /// Change of the CV as a share of it.
    cv_change: f64,
    /// Null for a single fibre.
    standard_error: f64,
    beyond_chance: bool,
    /// The part of the change that filaments in one air make each for itself; the rest is that of their clouds.
    #[serde(skip_serializing_if = "Option::is_none")]
    of_own_part: Option<f64>,
    /// Correlation of the clouds of the two webs in the same air.
    #[serde(skip_serializing_if = "Option::is_none")]
    clouds_in_common: Option<f64>,
    /// The change in the first air, of one that was flown again.
    #[serde(skip_serializing_if = "Option::is_none")]
    cv_change_in_first_air: Option<f64>,
}

#[derive(Debug, Serialize)]
pub(super) struct Failure {
    setting: &'static str,
    layer: Option<usize>,
    keys: Vec<Key>,
    why: String,
}

pub(super) fn keys(change: &Change) -> Vec<Key> {
    let key = |changed: &ChangedKey| Key {
        key: changed.key.clone(),
        from: changed.from,
        to: changed.to,
        unit: changed.dimension.si_unit(),
        written: if changed.whole {
            format!("{:.0}", changed.to)
        } else {
            changed.dimension.exact(changed.to)
        },
    };
    change.keys.iter().map(key).collect()
}

/// A change that could not be tried.
pub(super) fn failure((change, why): &(Change, String)) -> Failure {
    Failure { setting: change.setting.name(), layer: alone(change), keys: keys(change), why: why.clone() }
}

/// The layer that changes, if it is the only one.
fn alone(change: &Change) -> Option<usize> {
    if let [layer] = change.layers[..] { Some(layer) } else { None }
}

impl AdviceSummary {
    pub(super) fn new(advice: &Advice) -> Self {
        let in_first_air = |effect: &Effect, patch: f64| {
            effect.in_first_air.iter().find(|cv| cv.patch == patch).map(|cv| cv.change)
        };
        let patch = |effect: &Effect, cv: &CvChange| Patch {
            patch_m: cv.patch,
            cv_change: cv.change,
            standard_error: cv.standard_error,
            beyond_chance: cv.is_beyond_chance(),
            of_own_part: cv.own,
            clouds_in_common: cv.in_common,
            cv_change_in_first_air: in_first_air(effect, cv.patch),
        };
        let change = |effect: &Effect| ChangeSummary {
            setting: effect.change.setting.name(),
            layer: alone(&effect.change),
            layers: if alone(&effect.change).is_none() { effect.change.layers.clone() } else { Vec::new() },
            keys: keys(&effect.change),
            set: effect.change.set.iter().cloned().collect(),
            command: web_command(&effect.change),
            belt_speed_m_s: effect.belt_speed[1],
            belt_speed_change: effect.belt_speed[1] / effect.belt_speed[0] - 1.0,
            throughput_kg_h_m: HOUR * effect.mass_flow[1],
            throughput_change: effect.mass_flow[1] / effect.mass_flow[0] - 1.0,
            flown_again: advice.is_confirmed.then_some(!effect.in_first_air.is_empty()),
            patches: effect.cvs.iter().map(|cv| patch(effect, cv)).collect(),
        };
        Self {
            changes: advice.effects.iter().map(change).collect(),
            failed: advice.failed.iter().map(failure).collect(),
        }
    }
}
