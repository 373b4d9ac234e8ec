//! Finds samples that repeat the one before: stretches in which the value is frozen, and values that are held.

use super::Robust;
use spunlaid_ground::statistics::median;
use std::ops::Range;

/// Expected number of stretches as long in samples of the air.
const FALSE_ALARMS: f64 = 0.01;
/// Shortest stretch of equal samples that can be frozen.
const SHORTEST: usize = 3;
/// Steps to the next value, and steps that leap, in steps of the resolution.
const NEXT: f64 = 1.5;
const LEAP: f64 = 3.5;
/// Steps above this many times the resolution are resolved by it.
const RESOLVED: f64 = 2.5;
/// Share of the record that is worth a word.
const LEAST_SHARE: f64 = 0.002;
/// Fewest stretches of equal samples that show a rule.
const FEWEST: usize = 20;
/// Scatter of the lengths over that of independent ones below which each value is held equally long.
const EVEN: f64 = 0.7;
/// Least mean number of equal samples.
const LEAST_HELD: f64 = 1.4;

/// What equal neighbours in a record mean.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Equal {
    /// As many as the resolution explains.
    Usual,
    /// Stretches in which the value is frozen.
    Frozen(Vec<Range<usize>>),
    /// Each value stands this often.
    Held(f64),
    /// Share of the samples that are equal to the one before, and share that the resolution explains.
    Irregular(f64, f64),
}

/// What the equal neighbours are.
///
/// * `is_known` – whether a value is an extreme one that is clipped, or a dropout
pub(super) fn equal(values: &[f64], robust: &Robust, is_known: impl Fn(f64) -> bool) -> Equal {
    let runs = runs(values);
    let step = |at: usize| (values[at] - values[at - 1]).abs() / robust.resolution;
    let (mut next, mut resolved) = (0, 0);
    for run in runs.iter().skip(1) {
        let step = step(run.start);
        next += usize::from(step < NEXT);
        resolved += usize::from(step > RESOLVED);
    }
    let equal = values.len() - runs.len();
    // Of equally likely small steps, as many are zero as are one up or one down.
    let explained = (0.5 * next as f64 + 1.0) / values.len() as f64;
    let is_resolved = 2 * resolved > runs.len();
    if is_resolved && let Some(held) = held(&runs) {
        return held;
    }
    let of_length = |length: usize| runs.iter().filter(|run| run.len() == length).count() as f64;
    let again = ((of_length(2) + 1.0) / (of_length(1) + 1.0)).max(explained).min(0.999);
    let least: f64 = 1.0 + libm::log(FALSE_ALARMS / values.len() as f64) / libm::log(again);
    let is_long =
        |run: &&Range<usize>| run.len() as f64 >= least.max(SHORTEST as f64) && !is_known(values[run.start]);
    // The air comes to rest and goes on by single steps of the resolution, a frozen value leaps.
    let leaps = |run: &Range<usize>| {
        let ends = [run.start, run.end].into_iter().filter(|at| *at > 0 && *at < values.len()).map(step);
        let (low, high) = ends.fold((f64::INFINITY, 0.0f64), |(low, high), x| (low.min(x), high.max(x)));
        low > NEXT && high > LEAP || high > NEXT && run.len() as f64 > 3.0 * least
    };
    let (frozen, resting): (Vec<_>, Vec<_>) = runs.iter().filter(is_long).cloned().partition(leaps);
    // The air rests at one velocity, a value is frozen at any.
    let of_one_value = frozen
        .iter()
        .filter(|run| (values[run.start] - values[frozen[0].start]).abs() < 1.5 * robust.resolution);
    let is_rest = frozen.len() > 1 && 2 * of_one_value.count() > frozen.len();
    let samples = values.len() as f64;
    let all = frozen.iter().map(ExactSizeIterator::len).sum::<usize>() as f64 / samples;
    let known: usize = runs.iter().filter(|run| is_known(values[run.start])).map(|run| run.len() - 1).sum();
    let share = (equal - known) as f64 / samples;
    // Beside frozen stretches there are no more equal neighbours than the resolution makes.
    if is_resolved && resting.is_empty() && share - all > (8.0 * explained).max(0.1) {
        return Equal::Irregular(share, explained);
    }
    if frozen.len() > resting.len() && !is_rest && all > LEAST_SHARE {
        return Equal::Frozen(frozen);
    }
    Equal::Usual
}

/// The stretches of equal samples, those of a single one too.
fn runs(values: &[f64]) -> Vec<Range<usize>> {
    let mut runs = Vec::new();
    let mut from = 0;
    for at in 1..=values.len() {
        if at == values.len() || values[at] != values[from] {
            runs.push(from..at);
            from = at;
        }
    }
    runs
}

/// Whether the lengths scatter less than those of stretches that end at random. The first and the last may be cut off.
fn held(runs: &[Range<usize>]) -> Option<Equal> {
    let whole = runs.get(1..runs.len().saturating_sub(1))?;
    let count = whole.len() as f64;
    let mean = whole.iter().map(|run| run.len() as f64).sum::<f64>() / count;
    let square = whole.iter().map(|run| (run.len() as f64 - mean).powi(2)).sum::<f64>() / count;
    let at_random = mean * (mean - 1.0);
    let is_held = whole.len() >= FEWEST && mean >= LEAST_HELD && square < EVEN * EVEN * at_random;
    // Two values after one another may be equal.
    let usual = median(&whole.iter().map(|run| run.len() as f64).collect::<Vec<_>>());
    let as_usual = whole.iter().filter(|run| run.len() as f64 == usual).count() as f64;
    is_held.then_some(Equal::Held(if as_usual > 0.8 * count { usual } else { mean }))
}
