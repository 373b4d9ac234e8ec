//! Finds spikes: one or a few samples that leap away and back.

use super::{Robust, thinned};
use spunlaid_ground::statistics::{median, quantile};

/// Least leap that is a spike, in standard deviations of the record: smaller ones do not change its statistics much.
const LEAST_LEAP: f64 = 2.5;
/// Expected number of samples of the air that leap as far as the first spike.
const FALSE_ALARMS: f64 = 1e-3;
/// Samples on either side that show how much the air changes there, and the leap in deviations of their changes:
/// in a burst everything leaps.
const NEAR: usize = 16;
const LEAST_LOCAL: f64 = 6.0;
/// Leaps of this share of the least one are compared with those that are longer.
const SHORTER: f64 = 0.75;
/// Fewest and most samples of a spike whose ends are looked for.
const LONG: std::ops::RangeInclusive<usize> = 3..=8;
/// Share of spikes from which they are the signal.
const MOST: f64 = 0.1;
/// Searches; each goes on without the spikes of the one before.
const SEARCHES: usize = 4;

/// The indices of the samples that are spikes, in order.
pub(super) fn spikes(values: &[f64], robust: &Robust) -> Vec<usize> {
    let mut rest: Vec<usize> = (0..values.len()).collect();
    let mut found = Vec::new();
    for _ in 0..SEARCHES {
        let left: Vec<f64> = rest.iter().map(|i| values[*i]).collect();
        // Where there are spikes, a twentieth of those that are found beside them may be the air's.
        let alarms = FALSE_ALARMS.max(0.05 * found.len() as f64);
        let here = leaping(&left, robust, alarms, found.is_empty());
        if here.is_empty() {
            break;
        }
        found.extend(here.iter().map(|i| rest[*i]));
        let mut here = here.into_iter().peekable();
        let mut at = 0;
        rest.retain(|_| {
            at += 1;
            here.next_if(|i| *i + 1 == at).is_none()
        });
    }
    let left: Vec<f64> = rest.iter().map(|i| values[*i]).collect();
    found.extend(long(&left, robust).into_iter().map(|i| rest[i]));
    found.sort_unstable();
    if found.len() as f64 > MOST * values.len() as f64 { Vec::new() } else { found }
}

/// The samples that leap further than the air does.
///
/// * `alarms` – expected number of samples of the air among them
/// * `is_first` – whether no spike is known yet
fn leaping(values: &[f64], robust: &Robust, alarms: f64, is_first: bool) -> Vec<usize> {
    if values.len() < 2 * NEAR {
        return Vec::new();
    }
    let changes: Vec<f64> = (0..values.len()).map(|i| change(values, i)).collect();
    let least = least_leap(&changes, robust, alarms);
    let leaps: Vec<f64> = (0..values.len()).map(|i| leap(values, i)).collect();
    let is_spike = |i: &usize| leaps[*i] >= least && leaps[*i] >= LEAST_LOCAL * usual(&changes, *i);
    let found: Vec<usize> = (0..values.len()).filter(is_spike).collect();
    // The leaps of the air are the fewer the farther they go; spikes stand apart from them.
    let shorter = leaps.iter().filter(|leap| **leap < least && **leap >= SHORTER * least).count();
    if !is_first || found.len() >= shorter { found } else { Vec::new() }
}

/// The samples of spikes that last for some samples: they begin and end with a step that the air does not make, stay
/// away in between, and come back to where they left.
fn long(values: &[f64], robust: &Robust) -> Vec<usize> {
    if values.len() < 2 * NEAR {
        return Vec::new();
    }
    let steps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let sizes: Vec<f64> = steps.iter().map(|step| step.abs()).collect();
    let least = least_leap(&sizes, robust, FALSE_ALARMS);
    let is_leap = |at: usize| sizes[at] >= least && sizes[at] >= LEAST_LOCAL * usual(&sizes, at);
    let (mut found, mut at) = (Vec::new(), 0);
    while at < steps.len() {
        let (from, step) = (values[at], steps[at]);
        let is_end = |end: &usize| {
            let is_away = |x: &f64| (x - from) * step.signum() > 0.5 * step.abs();
            steps[*end] * step < 0.0
                && is_leap(*end)
                && (values[end + 1] - from).abs() < 0.5 * step.abs()
                && values[at + 1..=*end].iter().all(is_away)
        };
        let mut ends = LONG.map(|samples| at + samples).filter(|end| *end < steps.len());
        match is_leap(at).then(|| ends.find(is_end)).flatten() {
            Some(end) => {
                found.extend(at + 1..=end);
                at = end + 1;
            }
            None => at += 1,
        }
    }
    found
}

/// The least leap that the air does not make.
fn least_leap(changes: &[f64], robust: &Robust, alarms: f64) -> f64 {
    (LEAST_LEAP * robust.deviation).max(3.0 * robust.resolution).max(threshold(changes, robust, alarms))
}

/// The deviation of the changes about a sample.
fn usual(changes: &[f64], at: usize) -> f64 {
    median(&changes[at.saturating_sub(NEAR)..changes.len().min(at + NEAR + 1)]) / 0.6745
}

/// The leap beyond which this many samples of the air are expected: the distribution of the changes,
/// `exp(−(x/b)^c)`, by two quantiles that spikes hardly change. A Gaussian falls faster than its tail, and the
/// exponential tails of intermittent air have `c = 1`.
fn threshold(changes: &[f64], robust: &Robust, alarms: f64) -> f64 {
    let some = thinned(changes);
    let half = quantile(&some, 0.5).max(0.5 * robust.resolution);
    let ratio = (quantile(&some, 0.8) / half).max(1.9);
    let [at_half, at_four_fifths] = [2.0, 5.0].map(libm::log);
    let power = libm::log(at_four_fifths / at_half) / libm::log(ratio);
    half * libm::pow(libm::log(changes.len() as f64 / alarms) / at_half, 1.0 / power)
}

/// The two samples on either side of one, or the nearest four at an end of the record, in order of size.
fn neighbours(values: &[f64], i: usize) -> [f64; 4] {
    let from = i.saturating_sub(2).min(values.len() - 5);
    let mut four = [0.0; 4];
    for (to, k) in four.iter_mut().zip((from..from + 5).filter(|k| *k != i)) {
        *to = values[k];
    }
    four.sort_unstable_by(f64::total_cmp);
    four
}

/// Distance of a sample from the median of its neighbours.
fn change(values: &[f64], i: usize) -> f64 {
    let [_, low, high, _] = neighbours(values, i);
    (values[i] - 0.5 * (low + high)).abs()
}

/// How far a sample is beyond three of its four neighbours; one of them may leap with it.
fn leap(values: &[f64], i: usize) -> f64 {
    let [_, low, high, _] = neighbours(values, i);
    (values[i] - high).max(low - values[i]).max(0.0)
}
