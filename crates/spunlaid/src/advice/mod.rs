//! What changes of a web do to its CV: settings of the machine at the same basis weight, and numbers that are guesses.
//!
//! ```text
//! settings of the line → webs with one of them changed, on the belt that lays the same weight
//!   → flown anew in the same gusts → expected CV, compared with that of the web itself fibre by fibre, or block by block
//!   → in one air the best ones flown once more in another air → Advice
//! ```

mod aim;
mod few;
mod setting;

pub use aim::{AIMS, Aim, judged_by};
pub use setting::ChangedWeb;

use self::few::WebOfFew;
use crate::effects::{self, NAMED, Outcome, Setting, Trials};
use crate::error::{Error, Fault};
use crate::layers::{Flights, Flyer, WebSpec, fits_memory, steps_in_same_air};
use crate::threads::try_each;
use crate::units::Dimension;
use crate::web::{ExpectedCv, Findings, LayControl, PatchFindings, Web, expected_cv, nearest_to_seen};
use std::sync::atomic::{AtomicU64, Ordering};

/// A change of a web.
pub type Change = effects::Change<ChangedWeb>;
/// A change of a web with what it does to the CV over patches of each size, as a share of it: negative for a
/// more even web.
pub type Tried = effects::Tried<ChangedWeb, f64>;
/// What changes of settings do to the CV of a web.
pub type Advice = Trials<ChangedWeb, f64>;

/// Bits of a seed that are others in another air.
const ANOTHER_AIR: u64 = 0x9e37_79b9_7f4a_7c15;

/// Steps of all fibres of the flights that it takes to try some changes of a web; of webs in one air, about.
pub fn steps(spec: &WebSpec, changes: &[Change]) -> u64 {
    if spec.flies() {
        let again = 1 + NAMED.min(changes.len()) as u64;
        return steps_in_same_air(&all_webs(spec, changes)) + again * steps_in_same_air(&[spec]);
    }
    0
}

/// A web and the changed ones.
fn all_webs<'a>(spec: &'a WebSpec, changes: &'a [Change]) -> Vec<&'a WebSpec> {
    std::iter::once(spec).chain(changes.iter().map(|change| &change.experiment.spec)).collect()
}

/// Most steps of all fibres that are flown for advice or for guesses without being asked: a minute or two of
/// a processor.
pub const MOST_STEPS: u64 = 20_000_000;

/// Whether changes of a web are tried without being asked: there are some, their flights are short, and a few
/// filaments tell the web. Where all filaments in one air are flown, two maps are compared, and only large
/// effects are seen. Guesses must also fit into the memory beside each other.
pub fn are_tried(spec: &WebSpec, findings: &Findings, changes: &[Change]) -> bool {
    let few = findings.laid.shared_air.as_ref().map(|together| together.few.len());
    let seen = nearest_to_seen(findings.patches.iter().map(|patch| patch.map.patch));
    let is_told = seen.is_none_or(|seen| findings.patches[seen].doubt.is_none());
    let says_enough = is_told && few.is_none_or(|layers| layers == spec.layers.len());
    let are_guesses = changes.iter().any(is_guess);
    let fits = || !are_guesses || !spec.flies() || fits_memory(&all_webs(spec, changes));
    says_enough && steps(spec, changes) <= MOST_STEPS && fits()
}

fn is_same(patch: f64, side: f64) -> bool {
    (patch / side - 1.0).abs() < 1e-6
}

fn is_guess(change: &Change) -> bool {
    change.setting == Setting::GUESS
}

/// Tries changes of a web.
///
/// * `web`, `findings` – the web as it is, and what was found of it
/// * `judged_by` – side of the patches by whose CV changes are judged [m], see [`judged_by`]; if None, that
///   of the patches which the eye judges first
/// * `by` – its counter grows by the [`steps`] of the changes that are done
///
/// # Errors
/// If it is stopped, if nothing is expected of the web as it is, or if no CV is known by which to judge.
pub fn advise(
    spec: &WebSpec,
    (web, findings): (&Web, &Findings),
    changes: Vec<Change>,
    judged_by: Option<f64>,
    by: LayControl<'_>,
) -> Result<Advice, Error> {
    let has_few = findings.laid.shared_air.as_ref().is_some_and(|together| !together.few.is_empty());
    let mut is_in_same_air = false;
    let mut advice = Trials::new(changes, |changes| {
        let in_same_air = if has_few { few_of_changes(spec, changes, by)? } else { None };
        is_in_same_air = in_same_air.is_some();
        in_same_air.map_or_else(|| try_alone(spec, (web, findings), changes, by), Ok)
    })?;
    let patches = || advice.tried.iter().flat_map(|tried| &tried.effects).map(|effect| effect.of);
    advice.judged_by = match judged_by {
        None => nearest_to_seen(patches()).and_then(|number| patches().nth(number)),
        Some(side) => patches().find(|patch| is_same(*patch, side)),
    };
    if let (Some(side), None, false) = (judged_by, advice.judged_by, advice.tried.is_empty()) {
        let side = Dimension::Length.pretty_to(side, 3);
        let what = format!("the CV over patches of {side} is not known of the compared webs");
        return Err(Fault::new(what, "take smaller patches, or a larger sheet").into());
    }
    // Nobody chooses the best one of some guesses.
    if is_in_same_air && advice.tried.iter().any(|tried| !is_guess(&tried.change)) {
        advice.confirm(|changes| {
            let in_another_air = |spec: &WebSpec| WebSpec { seed: spec.seed ^ ANOTHER_AIR, ..spec.clone() };
            let mut changes = changes.to_vec();
            changes.iter_mut().for_each(|Change { experiment, .. }| {
                experiment.spec = in_another_air(&experiment.spec);
            });
            Ok(few_of_changes(&in_another_air(spec), &changes, by)?.unwrap_or_default())
        })?;
    }
    Ok(advice)
}

/// What changes do, each to the CV over patches of each size [m].
type Outcomes = Vec<Outcome<f64>>;

/// Flies a few filaments of all webs in the same air; None if a few do not tell the web as it is.
fn few_of_changes(spec: &WebSpec, changes: &[Change], by: LayControl<'_>) -> Result<Option<Outcomes>, Error> {
    let flyer = Flyer::new(by.threads, by.stop, &unwatched);
    let webs = all_webs(spec, changes);
    let Some(told) = flyer.few_in_same_air(&webs, by.laid)? else { return Ok(None) };
    let mut told = webs.into_iter().zip(told).map(|(spec, few)| few.map(|few| WebOfFew::new(spec, few)));
    let Some(base) = told.next().transpose()? else { return Ok(None) };
    let change = |of_few: Result<WebOfFew, Error>| {
        of_few.map(|of_few| base.changes_to(&of_few)).map_err(|why| why.to_string())
    };
    let mut tried: Outcomes = told.map(change).collect();
    // Where eddies are far longer or shorter than those of others, too little of a web may be laid while the
    // same air passes for all.
    for number in 0..changes.len() {
        if changes.len() > 1 && is_guess(&changes[number]) && tried[number].is_err() {
            let alone = few_of_changes(spec, &changes[number..=number], by)?;
            tried[number] = alone.into_iter().flatten().next().unwrap_or_else(|| tried[number].clone());
        }
    }
    Ok(Some(tried))
}

/// Flies and lays each changed web by itself.
fn try_alone(
    spec: &WebSpec,
    (web, findings): (&Web, &Findings),
    changes: &[Change],
    by: LayControl<'_>,
) -> Result<Outcomes, Error> {
    let is_shared = spec.flies();
    let aside = AtomicU64::new(0);
    let base = match is_shared {
        true => of_maps(&findings.patches),
        false => expected_cv(web, LayControl { laid: &aside, ..by })?,
    };
    // A flight of eight fibres takes one thread, and many changes are tried side by side. All filaments in
    // one air take all threads.
    let (abreast, threads) = if is_shared { (1, by.threads) } else { (by.threads, 1) };
    try_each(abreast, changes.len(), |i| {
        let changed = &changes[i..=i];
        let found = cvs(&changed[0].experiment.spec, LayControl { threads, laid: &aside, ..by });
        by.laid.fetch_add(steps(spec, changed), Ordering::Relaxed);
        match found {
            Ok(found) => Ok(Ok(base.iter().filter_map(|before| before.effect_to(&found)).collect())),
            Err(Error::Interrupted) => Err(Error::Interrupted),
            Err(error) => Ok(Err(error.to_string())),
        }
    })
}

fn unwatched(_: Flights<'_>, work: &mut (dyn FnMut() + Send)) {
    work();
}

/// How uneven the map of filaments in one air is, all of which were flown.
fn of_maps(patches: &[PatchFindings]) -> Vec<ExpectedCv> {
    patches.iter().map(|found| ExpectedCv::of_map(&found.map)).collect()
}

/// How uneven a web is over patches of each size: on the map of filaments in one air, or as it is expected of
/// independent ones.
fn cvs(spec: &WebSpec, by: LayControl<'_>) -> Result<Vec<ExpectedCv>, Error> {
    let mut flown = Flyer::new(by.threads, by.stop, &unwatched).web(spec)?;
    if spec.flies() { Ok(of_maps(&flown.find(by)?.patches)) } else { expected_cv(&flown.web, by) }
}
