//! What guesses matter, in `summary.json`.

use super::advice::{Failure, Key, failure, keys};
use crate::command::web_command;
use serde::Serialize;
use spunlaid::advice::{Advice, CvChange, Effect};
use spunlaid::web::Findings;
use std::collections::BTreeMap;

/// The CV of the web with other values of the numbers that are guesses.
#[derive(Debug, Serialize)]
pub(super) struct GuessesSummary {
    /// Over patches of each size the least and the greatest CV of all these webs and of the web as it is.
    ranges: Vec<Range>,
    values: Vec<ValueSummary>,
    /// Values that could not be flown.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    failed: Vec<Failure>,
}

#[derive(Debug, Serialize)]
struct Range {
    patch_m: f64,
    cv_from: f64,
    cv_to: f64,
}

/// Another value of a guess.
#[derive(Debug, Serialize)]
struct ValueSummary {
    #[serde(flatten)]
    key: Option<Key>,
    /// Keys and values with which the file is the web with this value, and the command that lays it.
    set: BTreeMap<String, String>,
    command: String,
    patches: Vec<Patch>,
}

#[derive(Debug, Serialize)]
struct Patch {
    patch_m: f64,
    /// The CV with this value, and the standard error of the difference to the CV of the web.
    cv: f64,
    cv_difference_standard_error: f64,
    beyond_chance: bool,
}

impl GuessesSummary {
    pub(super) fn new(guesses: &Advice, findings: &Findings) -> Self {
        let cv_over = |patch: f64| {
            let found = findings.patches.iter().find(|found| found.map.patch == patch);
            found.map_or(f64::NAN, |found| found.map.cv)
        };
        let patch = |change: &CvChange| {
            let cv = cv_over(change.patch);
            Patch {
                patch_m: change.patch,
                cv: cv * (1.0 + change.change),
                cv_difference_standard_error: cv * change.standard_error,
                beyond_chance: change.is_beyond_chance(),
            }
        };
        let value = |effect: &Effect| ValueSummary {
            key: keys(&effect.change).into_iter().next(),
            set: effect.change.set.iter().cloned().collect(),
            command: web_command(&effect.change),
            patches: effect.cvs.iter().map(patch).collect(),
        };
        let range = |change: &CvChange| {
            let [cv_from, cv_to] = guesses.range(change.patch).map(|ratio| ratio * cv_over(change.patch));
            Range { patch_m: change.patch, cv_from, cv_to }
        };
        Self {
            ranges: guesses
                .effects
                .first()
                .map_or_else(Vec::new, |first| first.cvs.iter().map(range).collect()),
            values: guesses.effects.iter().map(value).collect(),
            failed: guesses.failed.iter().map(failure).collect(),
        }
    }
}
