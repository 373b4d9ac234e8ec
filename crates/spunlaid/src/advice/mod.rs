//! What would make a web more even at the same basis weight, in settings of the machine.
//!
//! ```text
//! settings of the line → webs with one of them changed, on the belt that lays the same weight
//!   → flown anew in the same gusts → expected CV, compared with that of the web itself fibre by fibre, or block by block
//!   → in one air the best ones flown once more in another air → Advice
//! ```

mod few;
mod guesses;
mod setting;

pub use guesses::are_tried;
pub use setting::{Change, ChangedKey, Setting};

use self::few::WebOfFew;
use crate::error::Error;
use crate::layers::{Flights, Flyer, LaydownSource, LayerSpec, Method, WebSpec, steps_in_same_air};
use crate::sort::sort_by_key;
use crate::statistics::Difference;
use crate::threads::try_each;
use crate::web::uniformity::Unevenness;
use crate::web::{ExpectedCv, Findings, LayControl, PatchFindings, Web, expected_cv, nearest_to_seen};
use std::sync::atomic::{AtomicU64, Ordering};

/// What changes of settings do to the CV of a web.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Advice {
    /// The changes, each with what it does.
    pub effects: Vec<Effect>,
    /// Whether the best changes were flown once more, in another air. Only these are [`Advice::improvements`] then.
    pub is_confirmed: bool,
    /// Changes that cannot be flown or laid, and why.
    pub failed: Vec<(Change, String)>,
}

/// What a change does.
#[derive(Clone, Debug, PartialEq)]
pub struct Effect {
    /// The change.
    pub change: Change,
    /// Speed of the belt before and after [m/s].
    pub belt_speed: [f64; 2],
    /// Mass that is laid per time and width before and after [kg/(m s)].
    pub mass_flow: [f64; 2],
    /// What becomes of the CV over patches of each size.
    pub cvs: Vec<CvChange>,
    /// What became of it in the first air, if that chose the change and `cvs` are from another air; none of any other change.
    pub in_first_air: Vec<CvChange>,
}

/// What a change does to the CV over patches of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CvChange {
    /// Side of the patches [m].
    pub patch: f64,
    /// Change of the CV as a share of it: negative for a more even web.
    pub change: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Degrees of freedom of the error.
    pub degrees: f64,
    /// The part of the change that filaments make each for itself, to first order; the rest is that of the clouds which they make together. None where it
    /// is not known.
    pub own: Option<f64>,
    /// Correlation of the unevenness of the blocks of the two webs, if they hang in the same air: one where they have the same clouds, zero where they
    /// have other ones and the error is that of two webs by themselves.
    pub in_common: Option<f64>,
}

impl CvChange {
    /// Whether the change is one of the clouds, and not of what each filament does for itself; None where that is not known.
    pub fn is_of_clouds(&self) -> Option<bool> {
        self.own.map(|own| (self.change - own).abs() >= own.abs())
    }

    /// Whether the 95 % confidence interval leaves out zero.
    pub fn is_beyond_chance(&self) -> bool {
        let Self { change: value, standard_error, degrees, .. } = *self;
        Difference { value, standard_error, degrees }.is_beyond_chance()
    }
}

impl Effect {
    /// What it does over patches of this side [m].
    pub fn over(&self, patch: f64) -> Option<&CvChange> {
        self.cvs.iter().find(|cv| cv.patch == patch)
    }
}

/// Least change of a CV that is advice, as a share of it.
const LEAST: f64 = 0.01;
/// Largest number of settings that are named. In one air their changes are flown once more.
pub const NAMED: usize = 2;
/// Bits of a seed that are others in another air.
const ANOTHER_AIR: u64 = 0x9e37_79b9_7f4a_7c15;

impl Advice {
    /// The changes that lower the CV over patches of this side by at least one per cent of it and beyond chance: the best of each setting, and of these the best first.
    pub fn improvements(&self, patch: f64) -> Vec<(&Effect, &CvChange)> {
        let lowers = |effect| {
            let cv: &CvChange = Effect::over(effect, patch)?;
            (cv.change <= -LEAST && cv.is_beyond_chance()).then_some((effect, cv))
        };
        let told =
            self.effects.iter().filter(|effect| !(self.is_confirmed && effect.in_first_air.is_empty()));
        let mut improvements: Vec<(&Effect, &CvChange)> = told.filter_map(lowers).collect();
        sort_by_key(&mut improvements, |(_, cv)| cv.change);
        let setting = |effect: &Effect| (effect.change.setting, effect.change.layers.clone());
        let mut settings = Vec::new();
        improvements.retain(|(effect, _)| {
            let is_new = !settings.contains(&setting(effect));
            settings.push(setting(effect));
            is_new
        });
        improvements
    }
}

/// Steps of all fibres of the flights that it takes to try some changes of a web; of webs in one air, about.
pub fn steps(spec: &WebSpec, changes: &[Change]) -> u64 {
    if spec.method == Method::SharedAir {
        let again = 1 + NAMED.min(changes.len()) as u64;
        return steps_in_same_air(&all_webs(spec, changes)) + again * steps_in_same_air(&[spec]);
    }
    changes.iter().map(|change| steps_of_web(&change.spec)).sum()
}

/// A web and the changed ones.
fn all_webs<'a>(spec: &'a WebSpec, changes: &'a [Change]) -> Vec<&'a WebSpec> {
    std::iter::once(spec).chain(changes.iter().map(|change| &change.spec)).collect()
}

/// Steps of all fibres of a web of independent ones.
fn steps_of_web(spec: &WebSpec) -> u64 {
    let mut cases: Vec<_> = (spec.layers.iter())
        .filter_map(|layer| match &layer.source {
            LaydownSource::Case { path, case } => Some((path, case)),
            _ => None,
        })
        .collect();
    cases.dedup();
    cases.iter().map(|(_, case)| case.run.steps * case.run.replicates).sum()
}

/// Tries changes of a web.
///
/// * `web`, `findings` – the web as it is, and what was found of it
/// * `by` – its counter grows by the [`steps`] of the changes that are done
///
/// # Errors
/// If it is stopped, or if nothing is expected of the web as it is.
pub fn advise(
    spec: &WebSpec,
    (web, findings): (&Web, &Findings),
    changes: Vec<Change>,
    by: LayControl<'_>,
) -> Result<Advice, Error> {
    let (refused, changes): (Vec<Change>, Vec<Change>) =
        changes.into_iter().partition(|change| change.refusal.is_some());
    let refused = refused.into_iter().filter_map(|change| Some((change.clone(), change.refusal?)));
    let mut advice = Advice { failed: refused.collect(), ..Advice::default() };
    if changes.is_empty() {
        return Ok(advice);
    }
    let has_few = findings.laid.shared_air.as_ref().is_some_and(|together| !together.few.is_empty());
    let in_same_air = if has_few { few_of_changes(spec, &changes, by)? } else { None };
    let is_in_same_air = in_same_air.is_some();
    let tried = match in_same_air {
        Some(tried) => tried,
        None => try_alone(spec, (web, findings), &changes, by)?,
    };
    let belt_speed = |spec: &WebSpec| spec.layers.first().map_or(f64::NAN, |layer| layer.belt_speed);
    for (change, tried) in changes.into_iter().zip(tried) {
        match tried {
            Ok(cvs) => advice.effects.push(Effect {
                belt_speed: [spec, &change.spec].map(belt_speed),
                mass_flow: [spec, &change.spec].map(WebSpec::mass_flow),
                change,
                cvs,
                in_first_air: Vec::new(),
            }),
            Err(why) => advice.failed.push((change, why)),
        }
    }
    // Nobody chooses the best one of some guesses.
    let is_choice = advice.effects.iter().any(|effect| effect.change.setting != Setting::Guess);
    if is_in_same_air && is_choice {
        confirm(spec, &mut advice, by)?;
    }
    Ok(advice)
}

/// Flies the best changes once more in another air, and takes what they do there. They were chosen for what they did in the first air, in which chance was
/// kinder to them than to the others.                                                            theory.md, "Two webs in the same air"
fn confirm(spec: &WebSpec, advice: &mut Advice, by: LayControl<'_>) -> Result<(), Error> {
    let patches = || advice.effects.iter().flat_map(|effect| &effect.cvs).map(|cv| cv.patch);
    let seen = nearest_to_seen(patches()).and_then(|number| patches().nth(number));
    let improvements = seen.map_or_else(Vec::new, |patch| advice.improvements(patch));
    let is_best =
        |effect: &&Effect| improvements.iter().take(NAMED).any(|(best, _)| std::ptr::eq(*best, *effect));
    let best: Vec<usize> = (0..advice.effects.len()).filter(|i| is_best(&&advice.effects[*i])).collect();
    let changes: Vec<Change> = best.iter().map(|i| advice.effects[*i].change.clone()).collect();
    advice.is_confirmed = true;
    if changes.is_empty() {
        return Ok(());
    }
    let in_another_air = |spec: &WebSpec| WebSpec { seed: spec.seed ^ ANOTHER_AIR, ..spec.clone() };
    let changed = changes.into_iter().map(|change| Change { spec: in_another_air(&change.spec), ..change });
    let found = few_of_changes(&in_another_air(spec), &changed.collect::<Vec<_>>(), by)?;
    for (i, found) in best.into_iter().zip(found.into_iter().flatten()) {
        if let Ok(cvs) = found {
            let effect = &mut advice.effects[i];
            effect.in_first_air = std::mem::replace(&mut effect.cvs, cvs);
        }
    }
    Ok(())
}

/// What each of some changes does to the CV, or why it cannot be flown or laid.
type Tried = Vec<Result<Vec<CvChange>, String>>;

/// Flies a few filaments of all webs in the same air; None if a few do not tell the web as it is.
fn few_of_changes(spec: &WebSpec, changes: &[Change], by: LayControl<'_>) -> Result<Option<Tried>, Error> {
    let flyer = Flyer::new(by.threads, by.stop, &unwatched);
    let webs = all_webs(spec, changes);
    let Some(told) = flyer.few_in_same_air(&webs, by.laid)? else { return Ok(None) };
    let mut told = webs.into_iter().zip(told).map(|(spec, few)| few.map(|few| WebOfFew::new(spec, few)));
    let Some(base) = told.next().transpose()? else { return Ok(None) };
    let change = |of_few: Result<WebOfFew, Error>| {
        of_few.map(|of_few| base.changes_to(&of_few)).map_err(|why| why.to_string())
    };
    let mut tried: Tried = told.map(change).collect();
    // Where eddies are far longer or shorter than those of others, too little of a web may be laid while the same air passes for all.
    let is_odd =
        |(change, tried): (&Change, &Result<_, _>)| change.setting == Setting::Guess && tried.is_err();
    for number in 0..changes.len() {
        if changes.len() > 1 && is_odd((&changes[number], &tried[number])) {
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
) -> Result<Tried, Error> {
    let is_shared = spec.method == Method::SharedAir;
    let aside = AtomicU64::new(0);
    let base = match is_shared {
        true => Unevennesses::OfMaps(findings.patches.clone()),
        false => Unevennesses::Expected(expected_cv(web, LayControl { laid: &aside, ..by })?),
    };
    // A flight of eight fibres takes one thread, and many changes are tried side by side. All filaments in one air take all threads.
    let (abreast, threads) = if is_shared { (1, by.threads) } else { (by.threads, 1) };
    try_each(abreast, changes.len(), |i| {
        let changed = &changes[i..=i];
        let tried = unevennesses(&changed[0].spec, LayControl { threads, laid: &aside, ..by });
        by.laid.fetch_add(steps(spec, changed), Ordering::Relaxed);
        match tried {
            Ok(found) => Ok(Ok(base.changes_to(&found))),
            Err(Error::Interrupted) => Err(Error::Interrupted),
            Err(error) => Ok(Err(error.to_string())),
        }
    })
}

fn unwatched(_: Flights<'_>, work: &mut (dyn FnMut() + Send)) {
    work();
}

/// How uneven a web is over patches of each size.
enum Unevennesses {
    /// As it is expected of independent filaments.
    Expected(Vec<ExpectedCv>),
    /// On the map of filaments in one air, all of which were flown.
    OfMaps(Vec<PatchFindings>),
}

impl Unevennesses {
    /// The changes from these numbers to others, over the patches that both have.
    fn changes_to(&self, other: &Self) -> Vec<CvChange> {
        match (self, other) {
            (Self::Expected(before), Self::Expected(after)) => {
                let to = |before: &ExpectedCv| {
                    let after = after.iter().find(|after| after.patch == before.patch)?;
                    let (change, standard_error) = before.change_to(after);
                    let degrees = before.fibres().min(after.fibres()).max(2) as f64 - 1.0;
                    Some(CvChange {
                        patch: before.patch,
                        change,
                        standard_error,
                        degrees,
                        own: None,
                        in_common: None,
                    })
                };
                before.iter().filter_map(to).collect()
            }
            (Self::OfMaps(before), Self::OfMaps(after)) => {
                let to = |before: &PatchFindings| {
                    let (before, after) =
                        (before.map, after.iter().find(|after| after.map.patch == before.map.patch)?.map);
                    let ratio = after.cv / before.cv;
                    let share = |unevenness: Unevenness| {
                        unevenness.standard_error.map_or(f64::NAN, |error| error / unevenness.cv)
                    };
                    let standard_error = ratio * share(before).hypot(share(after));
                    Some(CvChange {
                        patch: before.patch,
                        change: ratio - 1.0,
                        standard_error,
                        degrees: f64::INFINITY,
                        own: None,
                        in_common: None,
                    })
                };
                before.iter().filter_map(to).collect()
            }
            // Both webs are laid by the same method.
            _ => Vec::new(),
        }
    }
}

fn unevennesses(spec: &WebSpec, by: LayControl<'_>) -> Result<Unevennesses, Error> {
    let is_flown = |layer: &LayerSpec| matches!(layer.source, LaydownSource::Case { .. });
    // The flown curves are compared, whether a surrogate is found in them or not.
    let method = match spec.method {
        Method::Surrogate if spec.layers.iter().all(is_flown) => Method::Dynamics,
        method => method,
    };
    let mut flyer = Flyer::new(by.threads, by.stop, &unwatched);
    let mut flown = flyer.web(&WebSpec { method, ..spec.clone() })?;
    Ok(match spec.method {
        Method::SharedAir => Unevennesses::OfMaps(flown.measure(by)?.patches),
        Method::Surrogate | Method::Dynamics => Unevennesses::Expected(expected_cv(&flown.web, by)?),
    })
}
