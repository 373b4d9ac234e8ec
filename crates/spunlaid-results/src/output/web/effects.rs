//! What changes do to the CV of a web, in `summary.json`: those of the line at the same basis weight, and
//! other values of guesses.

use crate::command::web_command;
use serde::Serialize;
use spunlaid::advice::{Advice, Change, ChangedWeb, Tried};
use spunlaid::effects::{ChangedKey, Effect};
use spunlaid::web::Findings;
use std::collections::BTreeMap;

/// Seconds of an hour.
pub(crate) const HOUR: f64 = 3600.0;

/// What changes do, the same for those of the line (`changes`) and for guesses (`values`).
#[derive(Debug, Serialize)]
pub(super) struct EffectsSummary<'a> {
    /// Side of the patches by which they are judged.
    judged_by_patch_m: Option<f64>,
    /// The CVs of all webs with other values of guesses, and of the web as it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    ranges: Option<Vec<Range>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    changes: Option<Vec<ChangedWebSummary<'a>>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    values: Option<Vec<ChangedWebSummary<'a>>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    failed: Vec<Failure<'a>>,
}

/// A changed web.
#[derive(Debug, Serialize)]
struct ChangedWebSummary<'a> {
    /// The key of a guess.
    #[serde(flatten)]
    guess: Option<Key>,
    setting: &'static str,
    /// Number of the layer, from 1; null where several or all layers change.
    layer: Option<usize>,
    /// Numbers of equal layers that change together.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    layers: &'a [usize],
    keys: Vec<Key>,
    /// Keys and values with which the file is the changed web, and the command that lays it.
    set: BTreeMap<&'a str, &'a str>,
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
struct Key {
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
    /// The CV of the changed web, and the standard error of the difference to the CV of the web.
    cv: f64,
    cv_difference_standard_error: f64,
    /// Change of the CV as a share of it, and its standard error, null for a single fibre.
    cv_change: f64,
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

/// The least and the greatest CV over patches of a size.
#[derive(Debug, Serialize)]
struct Range {
    patch_m: f64,
    cv_from: f64,
    cv_to: f64,
}

/// A change that could not be flown or laid.
#[derive(Debug, Serialize)]
struct Failure<'a> {
    setting: &'static str,
    layer: Option<usize>,
    keys: Vec<Key>,
    why: &'a str,
}

fn keys(change: &Change) -> Vec<Key> {
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

/// The layer that changes, if it is the only one.
fn alone(change: &Change) -> Option<usize> {
    if let [layer] = change.layers[..] { Some(layer) } else { None }
}

impl<'a> EffectsSummary<'a> {
    /// Changes of the line.
    ///
    /// * `beside` – the folder of the web
    pub(super) fn of_line(advice: &'a Advice, findings: &Findings, beside: &str) -> Self {
        let changes = Some(changed_webs(advice, (findings, beside), false));
        let judged_by_patch_m = advice.judged_by;
        Self { judged_by_patch_m, ranges: None, changes, values: None, failed: failures(advice) }
    }

    /// Other values of guesses.
    pub(super) fn of_guesses(guesses: &'a Advice, findings: &Findings, beside: &str) -> Self {
        let range = |effect: &Effect<f64>| {
            let cv = cv_over(findings, effect.of);
            let [cv_from, cv_to] = guesses.range(effect.of).map(|ratio| ratio * cv);
            Range { patch_m: effect.of, cv_from, cv_to }
        };
        let first = guesses.tried.first();
        let ranges = first.map_or_else(Vec::new, |first| first.effects.iter().map(range).collect());
        let values = Some(changed_webs(guesses, (findings, beside), true));
        let failed = failures(guesses);
        Self { judged_by_patch_m: guesses.judged_by, ranges: Some(ranges), changes: None, values, failed }
    }
}

/// The CV of the web as it is.
fn cv_over(findings: &Findings, patch: f64) -> f64 {
    let found = findings.patches.iter().find(|found| found.map.patch == patch);
    found.and_then(|found| found.told()).map_or(f64::NAN, |told| told.cv)
}

fn failures(advice: &Advice) -> Vec<Failure<'_>> {
    let mut failed = Vec::new();
    for (change, why) in &advice.failed {
        failed.push(Failure { setting: change.setting.name, layer: alone(change), keys: keys(change), why });
    }
    failed
}

fn changed_webs<'a>(
    advice: &'a Advice,
    (findings, beside): (&Findings, &str),
    are_guesses: bool,
) -> Vec<ChangedWebSummary<'a>> {
    let patch = |tried: &Tried, effect: &Effect<f64>| {
        let (cv, difference) = (cv_over(findings, effect.of), &effect.difference);
        let at_first = tried.at_first.iter().find(|first| first.of == effect.of);
        Patch {
            patch_m: effect.of,
            cv: cv * (1.0 + difference.value),
            cv_difference_standard_error: cv * difference.standard_error,
            cv_change: difference.value,
            standard_error: difference.standard_error,
            beyond_chance: difference.is_beyond_chance(),
            of_own_part: effect.own,
            clouds_in_common: effect.in_common,
            cv_change_in_first_air: at_first.map(|first| first.difference.value),
        }
    };
    let changed_web = |tried: &'a Tried| {
        let Tried { change, effects, at_first } = tried;
        let ChangedWeb { set, belt_speed, mass_flow, .. } = &change.experiment;
        ChangedWebSummary {
            guess: keys(change).into_iter().next().filter(|_| are_guesses),
            setting: change.setting.name,
            layer: alone(change),
            layers: if alone(change).is_none() { &change.layers } else { &[] },
            keys: keys(change),
            set: set.iter().map(|(key, value)| (&**key, &**value)).collect(),
            command: web_command(change, beside),
            belt_speed_m_s: belt_speed[1],
            belt_speed_change: belt_speed[1] / belt_speed[0] - 1.0,
            throughput_kg_h_m: HOUR * mass_flow[1],
            throughput_change: mass_flow[1] / mass_flow[0] - 1.0,
            flown_again: advice.is_confirmed.then_some(!at_first.is_empty()),
            patches: effects.iter().map(|effect| patch(tried, effect)).collect(),
        }
    };
    advice.tried.iter().map(changed_web).collect()
}
