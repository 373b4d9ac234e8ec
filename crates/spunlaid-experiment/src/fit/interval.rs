//! The ends of the intervals: values of which a scan like this one would be found that far away by chance,
//! once in forty times.

use super::polynomials::Polynomials;
use super::search::{SearchState, residuals_of, weights_at};
use super::surface::Surface;
use super::values::{Values, least_misfit};
use super::webs::Webs;
use super::weights::{Matrix, gain};
use spunlaid_ground::Error;
use spunlaid_ground::statistics::{dot, student_t_95};

/// Most trials that seek an end.
const MOST: usize = 4;
/// An end is found when it moves by less than this [standard errors].
const ENOUGH: f64 = 0.1;
/// The least share of a step that its errors may leave of it.
const SLOWEST: f64 = 0.3;
/// Steps of the other keys on the polynomials.
const STEPS: usize = 10;

/// What is known of an end of an interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IntervalEnd {
    /// Webs were laid there, and a scan may just be one of them.
    Tried,
    /// The range of the key ends there, and values beyond it may be possible.
    OfRange,
    /// No webs could be laid there, or the end was not found in few trials: it follows from straight lines.
    Straight,
}

/// The ends of the interval of a key.
pub(super) struct Ends {
    /// Coordinates.
    pub(super) coordinates: [f64; 2],
    pub(super) kinds: [IntervalEnd; 2],
    /// Values of the key that were tried [SI], and the least misfit there.
    pub(super) profile: Vec<(f64, f64)>,
}

/// The ends of the interval of each key that changes something.
///
/// A value belongs to the interval if the scan may well be one of its webs: these are laid, each takes the
/// place of the scan, and the value found for the scan is no further away than t standard errors of theirs.
///
/// # Errors
/// As [`Webs::trial`].
pub(super) fn ends(
    webs: &mut Webs<'_>,
    place: &SearchState,
    values: &Values,
    other_errors: &Matrix,
) -> Result<Vec<Ends>, Error> {
    let t = student_t_95(webs.count - 1);
    let mut reach = vec![1.0; webs.parameters.len()];
    for (index, key) in values.surface.keys.iter().enumerate() {
        let from_place = (values.coordinates[*key] - webs.trials[place.trial].coordinates[*key]).abs();
        reach[*key] = from_place + 1.2 * t * values.surface.errors.standard_error(index);
    }
    let mut all = Vec::new();
    for index in 0..values.surface.keys.len() {
        let mut search =
            Search { place, values, other_errors, index, t, reach: &mut reach, profile: Vec::new() };
        let [low, high] = [search.end(webs, -1.0)?, search.end(webs, 1.0)?];
        all.push(Ends { coordinates: [low.0, high.0], kinds: [low.1, high.1], profile: search.profile });
    }
    Ok(all)
}

/// Seeks the ends of a key's interval.
struct Search<'a> {
    place: &'a SearchState,
    values: &'a Values,
    other_errors: &'a Matrix,
    /// Index of the key among those that change something.
    index: usize,
    t: f64,
    /// How far from the place trials count, by key.
    reach: &'a mut [f64],
    profile: Vec<(f64, f64)>,
}

impl Search<'_> {
    /// The end of the interval to one side, as a coordinate.
    fn end(&mut self, webs: &mut Webs<'_>, side: f64) -> Result<(f64, IntervalEnd), Error> {
        let Self { place, values, index, t, .. } = *self;
        let key = values.surface.keys[index];
        let start = webs.trials[place.trial].coordinates.clone();
        let [low, high] = webs.parameters[key].ends();
        let error = values.surface.errors.standard_error(index);
        // Where the end would be, and where it is if the range ends before.
        let mut wanted = values.coordinates[key] + side * t * error;
        let mut kind = IntervalEnd::Straight;
        // The trials nearest to the end on either side: where they are, and how much further away the scan's
        // value is found than it may be.
        let mut beside: [Option<(f64, f64)>; 2] = [None; 2];
        for _ in 0..MOST {
            let end = wanted.clamp(low, high);
            if (end - values.coordinates[key]) * side < 1e-9 {
                break;
            }
            let to = self.with_others(webs, end - start[key]);
            let at: Vec<f64> = start.iter().zip(&to).map(|(start, to)| start + to).collect();
            let Some(trial) = webs.trial(&at)? else { break };
            let at = webs.trials[trial].coordinates.clone();
            let to: Vec<f64> = at.iter().zip(&start).map(|(at, start)| at - start).collect();
            let distance = (at[key] - values.coordinates[key]) * side;
            if distance < 1e-9 {
                // The next whole number lies further away.
                kind = IntervalEnd::Tried;
                break;
            }
            self.reach.iter_mut().zip(&to).for_each(|(reach, to)| *reach = reach.max(1.05 * to.abs()));
            let (_, slopes) = Polynomials::new(webs, place, self.reach).at(&to);
            let end_place = SearchState {
                trial,
                weights: weights_at(webs, trial)?,
                slopes: slopes.clone(),
                settled: true,
            };
            let mean = webs.trials[trial].mean.clone();
            let keys = values.surface.keys.clone();
            let surface = Surface::new(webs, &end_place, keys, mean, &slopes, self.other_errors);
            let Some(index_there) = surface.keys.iter().position(|one| *one == key) else { break };
            self.profile.push((
                webs.parameters[key].value(at[key]),
                least_misfit(webs, place, &values.surface, index, trial),
            ));
            // How far from here the scan's value is found, and how far it would be at the end.
            let away = -side * dot(&surface.gain[index_there], &residuals_of(webs, trial));
            let wide = surface.errors.standard_error(index_there);
            let growth = (wide - error) / distance;
            let excess = away - t * wide;
            beside[usize::from(excess > 0.0)] = Some((at[key], excess));
            let step = match beside {
                // Values between which webs are the same, as with few filaments, have an end between them too.
                [Some((inside, less)), Some((outside, more))] => {
                    kind = IntervalEnd::Tried;
                    ((outside - inside) * less / (less - more) + inside - at[key]) * side
                }
                _ => (-excess / (1.0 - t * growth).max(SLOWEST)).clamp(-t * error, t * error),
            };
            wanted = at[key] + side * step;
            let is_beyond = !(low..=high).contains(&wanted) && (at[key] <= low || at[key] >= high);
            if is_beyond || step.abs() < ENOUGH * error {
                kind = IntervalEnd::Tried;
                break;
            }
        }
        let is_within = (low..=high).contains(&wanted);
        Ok((wanted.clamp(low, high), if is_within { kind } else { IntervalEnd::OfRange }))
    }

    /// A step of the key from the place, and those of the others that are best then, on the polynomials.
    fn with_others(&self, webs: &Webs<'_>, step: f64) -> Vec<f64> {
        let Self { place, values, index, .. } = *self;
        let keys = &values.surface.keys;
        let polynomials = Polynomials::new(webs, place, self.reach);
        let start = &webs.trials[place.trial].coordinates;
        let mut to: Vec<f64> = values.coordinates.iter().zip(start).map(|(at, start)| at - start).collect();
        to[keys[index]] = step;
        let others: Vec<usize> = keys.iter().copied().filter(|key| *key != keys[index]).collect();
        for _ in 0..STEPS {
            let (numbers, slopes) = polynomials.at(&to);
            let slopes: Matrix = others.iter().map(|key| slopes[*key].clone()).collect();
            let Ok(gain) = gain(&place.weights, &slopes) else { break };
            let left: Vec<f64> =
                webs.target.logarithms.iter().zip(&numbers).map(|(scan, number)| scan - number).collect();
            for (key, row) in others.iter().zip(&gain) {
                let [low, high] = webs.parameters[*key].ends();
                let further = (to[*key] + 0.7 * dot(row, &left)).clamp(-self.reach[*key], self.reach[*key]);
                to[*key] = (start[*key] + further).clamp(low, high) - start[*key];
            }
        }
        to
    }
}
