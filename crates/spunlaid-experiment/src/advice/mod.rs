//! What changes of a web do to its CV: settings of the machine at the same basis weight, and numbers that are
//! assumed values.
//!
//! ```text
//! settings of the line → webs with one of them changed, on the belt that lays the same weight
//!   → simulated again in the same eddies → expected CV, compared with that of the web by fibre, or by block
//!   → in shared turbulence the best ones are simulated once more in other turbulence → Advice
//! ```

mod kept;
mod pinned;
pub mod setting;
mod web_of_few;

pub use pinned::{CvSoFar, LOOKS, LaidStretch, Look, PinnedWeb, Seen};
pub use setting::{ChangedWeb, judged_by};

use self::kept::{numbers_of, outcomes_of};
use self::web_of_few::{OF_OTHER_MESH, WebOfFew};
use spunlaid_fibre::Case;
use spunlaid_ground::threads::try_par_map;
use spunlaid_ground::{
    Dimension, Effect, Error, Fault, Log, Outcome, RACING, RunContext, Sensitivity, effects,
};
use spunlaid_simulation::layers::kept_under;
use spunlaid_simulation::shared_turbulence::{fits_memory, steps_in_same_air};
use spunlaid_simulation::{Compared, FewOfWeb, Flights, Flyer, WebSpec};
use spunlaid_web::map::{Findings, PatchFindings, expected_cv, nearest_to_seen};
use spunlaid_web::{ExpectedCv, Web};
use std::sync::atomic::{AtomicU64, Ordering};

/// A change of a web.
pub type Change = effects::Change<ChangedWeb>;
/// A change of a web with what it does to the CV over patches of each size, as a share of it: negative for a
/// more even web.
pub type SensitivityRun = effects::SensitivityRun<ChangedWeb, f64>;
/// What changes of settings do to the CV of a web.
pub type Advice = Sensitivity<ChangedWeb, f64>;

/// What is simulated of webs in shared turbulence: where assumed values are tried, which may be far from what the
/// file says; where all changes are; and where those are compared once more that may be the best.
const ASSUMED: Compared = Compared { area: 0.045, pitches: 2.0 };
const CHANGES: Compared = Compared { area: 0.06, pitches: 2.0 };
const RACE: Compared = Compared { area: 0.09, pitches: 2.0 };
/// How many times as long or as short eddies have no clouds in common with others.
const OTHER_EDDIES: f64 = 1.5;
/// Bits of a seed that are others in another air.
const ANOTHER_AIR: u64 = 0x9e37_79b9_7f4a_7c15;

/// Steps of all fibres of the flights that it takes to try some changes of a web; of webs in shared turbulence, about.
pub fn steps(spec: &WebSpec, changes: &[Change]) -> u64 {
    if spec.flies() {
        let all = compared(changes);
        let of_one = |change: &Change| match has_own_clouds(spec, change) {
            true => steps_in_same_air(
                &[&change.experiment.spec],
                with_as_many_clouds(all, longer_eddies(spec, change)),
            ),
            false => 0,
        };
        let alone: u64 = changes.iter().map(of_one).sum();
        let racing = changes.iter().filter(|change| !is_assumed(change)).count().min(RACING) as u64;
        let again = if racing == 0 { 0 } else { (1 + racing) * steps_in_same_air(&[spec], RACE) };
        return steps_in_same_air(&all_webs(spec, changes), all) + alone + again;
    }
    0
}

/// What is simulated of some changes of a web in shared turbulence.
fn compared(changes: &[Change]) -> Compared {
    if changes.iter().any(is_assumed) { ASSUMED } else { CHANGES }
}

/// A web and the changed ones that are simulated beside it.
fn all_webs<'a>(spec: &'a WebSpec, changes: &'a [Change]) -> Vec<&'a WebSpec> {
    let beside = changes.iter().filter(|change| !has_own_clouds(spec, change));
    std::iter::once(spec).chain(beside.map(|change| &change.experiment.spec)).collect()
}

/// Most steps of all fibres that are simulated for advice or for assumed values without being asked: a minute or two of
/// a processor.
pub const MOST_STEPS: u64 = 20_000_000;

/// Whether changes of a web are tried without being asked: there are some, their flights are short, and a few
/// filaments give the web. Where all filaments in shared turbulence are simulated, two maps are compared, and only
/// large effects are seen. Assumed values must also fit into the memory beside each other.
pub fn are_tried(spec: &WebSpec, findings: &Findings, changes: &[Change]) -> bool {
    let is_reported = findings.seen().is_none_or(|seen| seen.warning.is_none());
    let says_enough = is_reported && findings.laid.simulated.iter().all(|layer| layer.few.is_some());
    says_enough && are_short(spec, changes)
}

/// Whether changes are tried without being asked if a few filaments give the web.
pub fn are_short(spec: &WebSpec, changes: &[Change]) -> bool {
    let are_assumed = changes.iter().any(is_assumed);
    let alone_fits = |change: &Change| {
        let of_it = with_as_many_clouds(ASSUMED, longer_eddies(spec, change));
        !has_own_clouds(spec, change) || fits_memory(&[&change.experiment.spec], of_it)
    };
    let fits = || fits_memory(&all_webs(spec, changes), ASSUMED) && changes.iter().all(alone_fits);
    steps(spec, changes) <= MOST_STEPS && (!are_assumed || !spec.flies() || fits())
}

fn is_same(patch: f64, side: f64) -> bool {
    (patch / side - 1.0).abs() < 1e-6
}

fn is_assumed(change: &Change) -> bool {
    change.setting == setting::ASSUMED
}

/// Tries changes of a web.
///
/// * `web`, `findings` – the web as it is, and what was found of it
/// * `judged_by` – side of the patches by whose CV changes are judged [m], see [`judged_by`]; if None, that
///   of the patches which the eye judges first
/// * `kept` – where what flights in one air say is kept, so that a command which was interrupted goes on
/// * `by` – its counter grows by the [`steps`] of the changes that are done
///
/// # Errors
/// If it is stopped, if nothing is expected of the web as it is, or if no CV is known by which to judge.
pub fn advise(
    spec: &WebSpec,
    web: &Web,
    findings: &Findings,
    changes: Vec<Change>,
    judged_by: Option<f64>,
    kept: Option<&Log>,
    by: RunContext<'_>,
) -> Result<Advice, Error> {
    let few_of = |spec: &WebSpec, changes: &[Change], of_each: Compared| {
        few_of_changes(spec, findings, changes, of_each, kept, by)
    };
    let has_few = findings.laid.few().next().is_some();
    let mut is_in_same_air = false;
    let mut advice = Sensitivity::new(changes, |changes| {
        let in_same_air = if has_few { few_of(spec, changes, compared(changes))? } else { None };
        is_in_same_air = in_same_air.is_some();
        in_same_air.map_or_else(|| try_alone(spec, web, findings, changes, by), Ok)
    })?;
    let patches = || advice.tried.iter().flat_map(|tried| &tried.effects).map(|effect| effect.of);
    advice.judged_by = match judged_by {
        None => nearest_to_seen(patches()).and_then(|number| patches().nth(number)),
        Some(side) => patches().find(|patch| is_same(*patch, side)),
    };
    if let (Some(side), None, false) = (judged_by, advice.judged_by, advice.tried.is_empty()) {
        let side = Dimension::Length.pretty_to(side, 3);
        let what = format!("the CV over patches of {side} is not known for the compared webs");
        return Err(Fault::new(what, "take smaller patches, or a larger sheet").into());
    }
    // Nobody chooses the best one of some assumed values.
    if is_in_same_air && advice.tried.iter().any(|tried| !is_assumed(&tried.change)) {
        advice.confirm(|changes| {
            let in_another_air = |spec: &WebSpec| WebSpec { seed: spec.seed ^ ANOTHER_AIR, ..spec.clone() };
            let mut changes = changes.to_vec();
            changes.iter_mut().for_each(|Change { experiment, .. }| {
                experiment.spec = in_another_air(&experiment.spec);
            });
            Ok(few_of(&in_another_air(spec), &changes, RACE)?.unwrap_or_default())
        })?;
    }
    Ok(advice)
}

/// What changes do, each to the CV over patches of each size [m].
type Outcomes = Vec<Outcome<f64>>;

/// Flies a few filaments of all webs in the same air; None if a few do not give the web as it is.
///
/// * `of_each` – what is simulated of each
fn few_of_changes(
    spec: &WebSpec,
    findings: &Findings,
    changes: &[Change],
    of_each: Compared,
    kept: Option<&Log>,
    by: RunContext<'_>,
) -> Result<Option<Outcomes>, Error> {
    let flyer = Flyer::new(by.threads, by.stop, &unwatched);
    // Flies webs, unless it is known what they say of the changed ones among them, by the numbers of a base.
    let simulate = |webs: &[&WebSpec],
                    of_each: Compared,
                    base: &[f64],
                    effects: &dyn Fn(Vec<FewOfWeb>) -> Result<Outcomes, Error>| {
        let deciding = [&[of_each.area, of_each.pitches, spec.memory_limit], base].concat();
        let key = [kept_under(webs.iter().copied(), &deciding), 0];
        if let Some(found) = kept.and_then(|kept| outcomes_of(&kept.pieces(key).last()?.ok()?)) {
            by.done.fetch_add(steps_in_same_air(webs, of_each), Ordering::Relaxed);
            return Ok(Some(found));
        }
        let Some(estimates) = flyer.few_in_same_air(webs, of_each, by.done)? else { return Ok(None) };
        let found = effects(estimates)?;
        // What cannot be kept is simulated again.
        kept.iter().for_each(|kept| drop(kept.append(key, numbers_of(&found))));
        Ok::<_, Error>(Some(found))
    };
    let webs = all_webs(spec, changes);
    let beside = simulate(&webs, of_each, &[], &|estimates| {
        let mut estimates = webs.iter().zip(estimates).map(|(spec, few)| Ok(WebOfFew::new(spec, few?)));
        let base = estimates.next().unwrap_or_else(|| Err(Error::no_fibre()))?;
        let changes = estimates.map(|few: Result<_, Error>| few.map(|few| base.changes_to(&few)));
        Ok(changes.map(|effects| effects.map_err(|why| why.to_string())).collect())
    })?;
    let Some(beside) = beside else { return Ok(None) };
    let (mut beside, mut tried) = (beside.into_iter(), Vec::new());
    for change in changes {
        if !has_own_clouds(spec, change) {
            tried.extend(beside.next());
            continue;
        }
        // The web as it is has been simulated.
        let changed = &change.experiment.spec;
        // Both without what places, defects and common clouds of layers do to the sheet of the web as it is.
        let mut base = WebOfFew::new(spec, findings.laid.few().cloned().collect()).cvs(0.0);
        let of_web = of_maps(&findings.patches);
        base.retain(|cv| of_web.iter().any(|of_web| of_web.patch == cv.patch));
        let numbers: Vec<f64> = base
            .iter()
            .flat_map(|base| [base.patch, base.cv, base.standard_error.unwrap_or(f64::NAN)])
            .collect();
        let of_it = with_as_many_clouds(of_each, longer_eddies(spec, change));
        let alone = simulate(&[changed], of_it, &numbers, &|estimates| {
            let effects =
                |few: FewOfWeb| Ok(effects_between(&base, &WebOfFew::new(changed, few?).cvs(OF_OTHER_MESH)));
            Ok(estimates.into_iter().map(|few| effects(few).map_err(|why: Error| why.to_string())).collect())
        })?;
        let all_are_flown = || Err("it has so few filaments that all of them are simulated".to_owned());
        tried.push(alone.into_iter().flatten().next().unwrap_or_else(all_are_flown));
    }
    Ok(Some(tried))
}

/// Whether a changed web hangs in eddies of other lengths, so that it has no clouds in common with the web as it
/// is. Beside each other they would take the room of the longest eddies and the time of the shortest.
fn has_own_clouds(spec: &WebSpec, change: &Change) -> bool {
    !(1.0 / OTHER_EDDIES..=OTHER_EDDIES).contains(&longer_eddies(spec, change))
}

/// How many times as long the eddies of a changed web are.
fn longer_eddies(spec: &WebSpec, change: &Change) -> f64 {
    let length = |spec: &WebSpec| {
        let cases = spec.layers.iter().filter_map(|layer| layer.source.case());
        cases.map(Case::smallest_length_scale).fold(f64::INFINITY, f64::min)
    };
    length(&change.experiment.spec) / length(spec)
}

/// What is simulated of a web with longer eddies: an area with as many clouds, because a few of them can give a CV and
/// an error of it that are both too small.
///
/// * `longer` – how many times as long the eddies are
fn with_as_many_clouds(of_each: Compared, longer: f64) -> Compared {
    let longer = longer.max(1.0);
    Compared { area: longer * longer * of_each.area, ..of_each }
}

/// What becomes of the CV over patches of each size, from webs that have nothing in common.
fn effects_between(base: &[ExpectedCv], other: &[ExpectedCv]) -> Vec<Effect<f64>> {
    base.iter().filter_map(|before| before.effect_to(other)).collect()
}

/// Flies and lays each changed web by itself.
fn try_alone(
    spec: &WebSpec,
    web: &Web,
    findings: &Findings,
    changes: &[Change],
    by: RunContext<'_>,
) -> Result<Outcomes, Error> {
    let is_shared = spec.flies();
    let aside = AtomicU64::new(0);
    let base = match is_shared {
        true => of_maps(&findings.patches),
        false => expected_cv(web, RunContext { done: &aside, ..by })?,
    };
    // A flight of eight fibres takes one thread, and many changes are tried side by side. All filaments in
    // one air take all threads.
    let (concurrent, threads) = if is_shared { (1, by.threads) } else { (by.threads, 1) };
    try_par_map(concurrent, changes.len(), |i| {
        let changed = &changes[i..=i];
        let found = cvs(&changed[0].experiment.spec, RunContext { threads, done: &aside, ..by });
        by.done.fetch_add(steps(spec, changed), Ordering::Relaxed);
        match found {
            Ok(found) => Ok(Ok(effects_between(&base, &found))),
            Err(Error::Interrupted) => Err(Error::Interrupted),
            Err(error) => Ok(Err(error.to_string())),
        }
    })
}

fn unwatched(_: Flights<'_>, work: &mut (dyn FnMut() + Send)) {
    work();
}

/// How uneven a web of filaments in shared turbulence is.
fn of_maps(patches: &[PatchFindings]) -> Vec<ExpectedCv> {
    let of_map = |found: &PatchFindings| {
        let (reported, error) = (found.reported()?, found.total_error().whole());
        Some(ExpectedCv::alone(reported.patch, reported.cv, error))
    };
    patches.iter().filter_map(of_map).collect()
}

/// How uneven a web is over patches of each size: on the map of filaments in shared turbulence, or as it is expected of
/// independent ones.
fn cvs(spec: &WebSpec, by: RunContext<'_>) -> Result<Vec<ExpectedCv>, Error> {
    let mut simulated = Flyer::new(by.threads, by.stop, &unwatched).web(spec)?;
    if spec.flies() { Ok(of_maps(&simulated.find(by)?.patches)) } else { expected_cv(&simulated.web, by) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn longer_eddies_are_simulated_on_an_area_with_as_many_clouds() {
        for (longer, area) in [(2.0, 0.18), (1.0, 0.045), (0.5, 0.045)] {
            let found = with_as_many_clouds(ASSUMED, longer);
            assert!((found.area - area).abs() < 1e-12 && found.pitches == ASSUMED.pitches, "{found:?}");
        }
    }
}
