//! The search: steps of Gauss and Newton, damped as by Levenberg and Marquardt, within the ranges of the keys.

use super::webs::{Trial, Webs};
use super::weights::{Matrix, gain, information, misfit, weights};
use spunlaid_ground::statistics::{dot, inverse};
use spunlaid_ground::{Error, Fault};

/// Step of a slope, as a coordinate: at the beginning, and then a standard error between these ends. The mean
/// of the webs jumps a little between trials, because a key may change which random numbers a filament takes;
/// steps must be long beside that.
const STEP: f64 = 0.25;
const STEPS: [f64; 2] = [0.05, 0.5];
/// Longest step of the search, as a coordinate: twice the value, or half of it.
const LONGEST: f64 = 0.7;
/// The search ends with steps that are this share of a standard error.
const ENOUGH: f64 = 0.05;
/// It has settled if a further step would be this share of a standard error.
const LITTLE: f64 = 0.25;
/// Most steps.
const MOST: usize = 25;
/// Damping at the beginning, and factors by which it changes.
const DAMPING: f64 = 0.01;
const LOOSER: f64 = 0.2;
const TIGHTER: f64 = 8.0;
/// Tries of a step with more and more damping.
const TRIES: usize = 6;

/// Where the search has come to.
pub(super) struct SearchState {
    /// Index of the trial.
    pub(super) trial: usize,
    /// Slopes of the numbers by each key.
    pub(super) slopes: Matrix,
    /// Weights of the numbers, by the webs of the trial.
    pub(super) weights: Matrix,
    /// Whether no step of any length is left to do.
    pub(super) settled: bool,
}

/// Searches for the values with the least misfit by given weights.
///
/// * `trial` – the index of that from which it starts
///
/// # Errors
/// As [`Webs::trial`].
pub(super) fn search(webs: &mut Webs<'_>, mut trial: usize, weights: Matrix) -> Result<SearchState, Error> {
    let (mut damping, mut steps) = (DAMPING, vec![STEP; webs.parameters.len()]);
    let mut current_slopes = slopes(webs, trial, &steps, false)?;
    // Whether the slopes were found at this trial, or follow from those of an earlier one.
    let mut are_own = true;
    for _ in 0..MOST {
        let slopes = &current_slopes;
        let residuals = residuals_of(webs, trial);
        let current_misfit = misfit(&weights, &residuals);
        let errors = standard_errors(&weights, slopes, webs.count);
        steps = errors.iter().map(|error| error.clamp(STEPS[0], STEPS[1])).collect();
        let (mut next, mut is_short) = (None, false);
        for _ in 0..if are_own { TRIES } else { 1 } {
            let to = next_coordinates(webs, trial, &weights, slopes, &residuals, damping);
            let far = to.iter().zip(&webs.trials[trial].coordinates).zip(&errors);
            is_short =
                far.into_iter().all(|((to, from), error)| (to - from).abs() <= ENOUGH * error.min(1.0));
            if is_short {
                break;
            }
            if let Some(found) = webs.trial(&to)? {
                let next_misfit = misfit(&weights, &residuals_of(webs, found));
                if next_misfit < current_misfit {
                    next = Some(found);
                    break;
                }
            }
            damping *= TIGHTER;
        }
        match next {
            Some(found) => {
                current_slopes = update_slopes(slopes, &webs.trials[trial], &webs.trials[found]);
                (trial, are_own) = (found, false);
                damping *= LOOSER;
            }
            // The slopes of steps to one side may have met a better place than the search.
            None if are_own => match best(webs, &weights) {
                Some(better) if better != trial && !is_short => {
                    trial = better;
                    current_slopes = self::slopes(webs, trial, &steps, false)?;
                }
                _ => break,
            },
            None => {
                current_slopes = self::slopes(webs, trial, &steps, false)?;
                are_own = true;
            }
        }
    }
    let slopes = slopes(webs, trial, &steps, true)?;
    // The scan stands beside the webs of this trial from here on.
    let weights = weights_at(webs, trial)?;
    // Where misfits differ by less than slopes of finite steps can resolve, no step makes them less.
    let errors = standard_errors(&weights, &slopes, webs.count);
    let to = next_coordinates(webs, trial, &weights, &slopes, &residuals_of(webs, trial), 0.0);
    let far = to.iter().zip(&webs.trials[trial].coordinates).map(|(to, from)| (to - from).abs());
    let settled = far.zip(&errors).all(|(far, error)| far <= LITTLE * error);
    Ok(SearchState { trial, slopes, weights, settled })
}

/// The index of the trial with the least misfit.
pub(super) fn best(webs: &Webs<'_>, weights: &Matrix) -> Option<usize> {
    let misfit_of = |trial: &usize| misfit(weights, &residuals_of(webs, *trial));
    (0..webs.trials.len()).min_by(|a, b| misfit_of(a).total_cmp(&misfit_of(b)))
}

/// What the scan has more than the webs of a trial, in logarithms.
pub(super) fn residuals_of(webs: &Webs<'_>, trial: usize) -> Vec<f64> {
    webs.target.logarithms.iter().zip(&webs.trials[trial].mean).map(|(scan, web)| scan - web).collect()
}

/// Slopes that are right for the step from one trial to the next, and otherwise as they were: C. G. Broyden,
/// Mathematics of Computation 19 (1965) 577–593.
fn update_slopes(slopes: &Matrix, from: &Trial, to: &Trial) -> Matrix {
    let step: Vec<f64> = to.coordinates.iter().zip(&from.coordinates).map(|(to, from)| to - from).collect();
    let squared = dot(&step, &step);
    let missing = |i: usize| {
        let foreseen: f64 = slopes.iter().zip(&step).map(|(slope, step)| slope[i] * step).sum();
        (to.mean[i] - from.mean[i] - foreseen) / squared
    };
    let missing: Vec<f64> = (0..to.mean.len()).map(missing).collect();
    let updated = |(slope, step): (&Vec<f64>, &f64)| {
        slope.iter().zip(&missing).map(|(slope, missing)| slope + missing * step).collect()
    };
    slopes.iter().zip(&step).map(updated).collect()
}

/// Weights by the scatter of the webs of a trial.
///
/// # Errors
/// If they do not differ from each other.
pub(super) fn weights_at(webs: &Webs<'_>, trial: usize) -> Result<Matrix, Error> {
    weights(webs.trials[trial].webs.iter(), &webs.target.camera).ok_or_else(|| {
        Error::Flight(Fault::new(
            "the simulated webs do not differ from each other",
            "lay more of them, or larger sheets, so that a difference can be significant at 95 %",
        ))
    })
}

/// Slopes of the numbers by each coordinate.
///
/// * `both` – whether steps to both sides are taken
fn slopes(webs: &mut Webs<'_>, trial: usize, steps: &[f64], both: bool) -> Result<Matrix, Error> {
    let mut slopes = Vec::new();
    for key in 0..steps.len() {
        let start = webs.trials[trial].coordinates.clone();
        let [low, high] = webs.parameters[key].ends();
        // As far as the range goes, first to the side that has more room.
        let wanted = steps[key].max(webs.parameters[key].shortest_step(start[key]));
        let rooms = [wanted.min(high - start[key]), -wanted.min(start[key] - low)];
        let [first, other] = if rooms[0] >= -rooms[1] { rooms } else { [rooms[1], rooms[0]] };
        let mut ends = Vec::new();
        let mut refusal = None;
        for step in [first, other, 0.4 * first] {
            if step == 0.0 || ends.len() > usize::from(both) {
                continue;
            }
            let mut tried = start.clone();
            tried[key] += step;
            match webs.trial(&tried)? {
                // The value is a whole number, and has not changed.
                Some(end) if end == trial => {}
                Some(end) => ends.push(end),
                None => refusal = Some(tried),
            }
        }
        let (one, other) = match ends[..] {
            [one, other] => (one, other),
            [one] => (one, trial),
            _ => {
                let refusal = refusal.and_then(|tried| webs.refusal(&tried));
                return Err(refusal.unwrap_or_else(|| no_other_value(&webs.parameters[key].key.name)));
            }
        };
        let length = webs.trials[one].coordinates[key] - webs.trials[other].coordinates[key];
        let ends = webs.trials[one].mean.iter().zip(&webs.trials[other].mean);
        slopes.push(ends.map(|(one, other)| (one - other) / length).collect());
    }
    Ok(slopes)
}

fn no_other_value(key: &str) -> Error {
    Error::flight(format!("{key} has no second value in its range"), "give it a wider range")
}

/// Standard errors of the coordinates, by the scatter of the scan and of the simulated webs; without bound
/// for a key that changes nothing.
fn standard_errors(weights: &Matrix, slopes: &Matrix, count: u64) -> Vec<f64> {
    let scatter = 1.0 + 1.0 / count as f64;
    let mut known: Vec<usize> = (0..slopes.len()).collect();
    let mut errors = vec![f64::INFINITY; slopes.len()];
    while !known.is_empty() {
        let own: Matrix = known.iter().map(|key| slopes[*key].clone()).collect();
        match inverse(information(weights, &own)) {
            Ok(inverse) => {
                known.iter().enumerate().for_each(|(i, key)| errors[*key] = (scatter * inverse[i][i]).sqrt());
                break;
            }
            Err(key) => known.remove(key),
        };
    }
    errors
}

/// The next place: a damped step from a trial, which ends at the ranges of the keys.
fn next_coordinates(
    webs: &Webs<'_>,
    trial: usize,
    weights: &Matrix,
    slopes: &Matrix,
    residuals: &[f64],
    damping: f64,
) -> Vec<f64> {
    let start = &webs.trials[trial].coordinates;
    let mut to = start.clone();
    let mut free: Vec<usize> = (0..slopes.len()).collect();
    let mut residuals = residuals.to_vec();
    while !free.is_empty() {
        let own: Matrix = free.iter().map(|key| slopes[*key].clone()).collect();
        let mut information = information(weights, &own);
        (0..own.len()).for_each(|i| information[i][i] *= 1.0 + damping);
        let pull: Vec<f64> = own
            .iter()
            .map(|slope| weights.iter().zip(&residuals).map(|(row, one)| one * dot(row, slope)).sum())
            .collect();
        let Ok(inverse) = inverse(information) else {
            // A key that changes nothing stays where it is.
            if let Err(key) = gain(weights, &own) {
                free.remove(key);
                continue;
            }
            break;
        };
        let step: Vec<f64> = inverse.iter().map(|row| dot(row, &pull)).collect();
        let length = step.iter().fold(0.0_f64, |most, step| most.max(step.abs()));
        let share = (LONGEST / length).min(1.0);
        let ends = |i: usize| webs.parameters[free[i]].ends();
        let beyond = (0..free.len()).find(|i| {
            let [low, high] = ends(*i);
            !(low..=high).contains(&(start[free[*i]] + share * step[*i]))
        });
        match beyond {
            Some(i) => {
                // It stays at its end, and the others go as is best then.
                let (key, [low, high]) = (free[i], ends(i));
                to[key] = (start[key] + share * step[i]).clamp(low, high);
                let moved = to[key] - start[key];
                residuals
                    .iter_mut()
                    .zip(&slopes[key])
                    .for_each(|(residual, slope)| *residual -= slope * moved);
                free.remove(i);
            }
            None => {
                free.iter().zip(&step).for_each(|(key, step)| to[*key] = start[*key] + share * step);
                break;
            }
        }
    }
    to
}
