//! Finds dropouts: samples of one value that lies apart from all others.

use super::Robust;
use spunlaid_ground::units::{rounded, shortest};

/// Distance from the median where the tail of a distribution begins, in standard deviations.
const TAIL: f64 = 3.0;
/// Mean excess over that of a Gaussian, in standard deviations; the tails of intermittent air are longer.
const GAUSSIAN_EXCESS: f64 = 0.3;
/// Gaps of the air in its tail are distributed exponentially; this many times the mean has a probability of 5e-5.
const WIDE: f64 = 10.0;
/// Least gap in standard deviations, and in steps of the resolution.
const LEAST_GAP: (f64, f64) = (0.5, 2.5);
/// Fewest samples of a dropout; fewer are spikes.
const FEWEST: usize = 3;
/// Numbers that instruments and programs write for a missing value, and their least distance.
const SENTINELS: [&str; 12] = [
    "99.99", "999", "999.9", "999.99", "9999", "9999.9", "9999.99", "99999", "999999", "32767", "32768",
    "65535",
];
const HUGE: f64 = 9e19;
const FAR: f64 = 12.0;
/// Fewest samples that are clipped, and runs of them that show it by themselves.
const FEWEST_CLIPPED: usize = 5;
const MANY_RUNS: usize = 8;
/// Most different values that lie apart.
const MOST_VALUES: usize = 8;

/// Samples that lie apart from all others.
#[derive(Clone, Debug)]
pub(super) struct Apart {
    /// The indices, in order.
    pub(super) samples: Vec<usize>,
    /// Smallest and largest of the values.
    pub(super) values: (f64, f64),
    /// The number as the file has it, if it stands for a missing value.
    pub(super) sentinel: Option<String>,
}

/// The values that lie apart, the farthest first.
///
/// * `factor` – from the unit of the file to that of the values
pub(super) fn apart(values: &[f64], robust: &Robust, factor: f64) -> Vec<Apart> {
    let mut found = Vec::new();
    for sign in [1.0, -1.0] {
        // Distances of the tail, in order of size, and the largest outside the tail.
        let height = |i: usize| sign * (values[i] - robust.median) / robust.deviation;
        let mut tail: Vec<usize> = (0..values.len()).filter(|i| height(*i) > TAIL).collect();
        let below = (0..values.len()).map(height).filter(|x| *x <= TAIL).fold(0.0, f64::max);
        tail.sort_by(|a, b| height(*a).total_cmp(&height(*b)).then(a.cmp(b)));
        if tail.len() as f64 > 0.25 * values.len() as f64 {
            continue;
        }
        let heights: Vec<f64> = tail.iter().map(|i| height(*i)).collect();
        let mut end = tail.len();
        let resolution = robust.resolution / robust.deviation;
        while let Some(from) = (0..end).rev().find(|from| {
            let group = Group { tail: &tail[..end], heights: &heights[..end], from: *from, below };
            group.is_apart(resolution, |i| sentinel(values[i] / factor).is_some())
        }) {
            let mut samples = tail[from..end].to_vec();
            let (first, last) = (values[tail[from]], values[tail[end - 1]]);
            let ends = (first.min(last), first.max(last));
            samples.sort_unstable();
            let sentinel = sentinel(first / factor).filter(|_| first == last && heights[from] > FAR);
            found.push(Apart { samples, values: ends, sentinel });
            end = from;
            if found.len() >= MOST_VALUES {
                break;
            }
        }
    }
    found.sort_by(|a, b| robust.distance(b.values.0).total_cmp(&robust.distance(a.values.0)));
    found
}

/// The end of a tail from one sample on.
struct Group<'a> {
    tail: &'a [usize],
    heights: &'a [f64],
    from: usize,
    /// Largest height outside the tail.
    below: f64,
}

impl Group<'_> {
    fn is_apart(&self, resolution: f64, is_sentinel: impl Fn(usize) -> bool) -> bool {
        let (rest, group) = self.heights.split_at(self.from);
        let (Some(first), Some(last)) = (group.first(), group.last()) else { return false };
        let gap = first - rest.last().copied().unwrap_or(self.below);
        let is_one_value = first == last;
        let is_sentinel = is_one_value && *first > FAR && is_sentinel(self.tail[self.from]);
        if gap < LEAST_GAP.0.max(LEAST_GAP.1 * resolution) || group.len() < FEWEST && !is_sentinel {
            return false;
        }
        let runs = self.runs();
        // Scattered samples of several values are spikes.
        let is_cluster = last - first <= 0.5 * gap && group.len() >= 3 * runs;
        if !is_one_value && !is_cluster {
            return false;
        }
        let excess = rest.iter().map(|x| x - TAIL).sum::<f64>() / rest.len().max(1) as f64;
        // Of so many excursions above a limit, one of the air would stand just below it.
        let one_of = if is_one_value { runs as f64 } else { 1.0 };
        gap * one_of > WIDE * excess.max(GAUSSIAN_EXCESS)
    }

    /// How often the samples leave the rest and come back.
    fn runs(&self) -> usize {
        let mut samples = self.tail[self.from..].to_vec();
        samples.sort_unstable();
        1 + samples.windows(2).filter(|pair| pair[1] > pair[0] + 1).count()
    }
}

/// A number as the file has it, if it stands for a missing value.
fn sentinel(written: f64) -> Option<String> {
    let number = shortest(rounded(written, 6));
    let plain = number.trim_start_matches('-');
    (SENTINELS.contains(&plain) || written.abs() > HUGE).then_some(number)
}

/// The indices of the samples at the extreme value, if far more samples have it than the value next to it.
///
/// * `sign` – 1 for the largest value, −1 for the smallest
pub(super) fn clipped(
    values: &[f64],
    robust: &Robust,
    is_left_out: impl Fn(usize) -> bool,
    sign: f64,
) -> Vec<usize> {
    let mut first = (f64::NEG_INFINITY, Vec::new());
    let mut second = (f64::NEG_INFINITY, 0);
    for (i, value) in values.iter().enumerate().filter(|(i, _)| !is_left_out(*i)).map(|(i, x)| (i, sign * x))
    {
        if value > first.0 {
            second = (first.0, first.1.len());
            first = (value, vec![i]);
        } else if value == first.0 {
            first.1.push(i);
        } else if value > second.0 {
            second = (value, 1);
        } else if value == second.0 {
            second.1 += 1;
        }
    }
    let samples = first.1;
    let starts: Vec<usize> = (0..samples.len())
        .filter(|k| *k == 0 || samples[k - 1] + 1 < samples[*k])
        .map(|k| samples[k])
        .collect();
    // A smooth eddy has a flat top too, but goes there by single steps of the resolution.
    let leaps = |i: &usize| *i > 0 && (values[*i] - values[i - 1]).abs() > 1.5 * robust.resolution;
    let is_smooth = starts.len() < 3 && !starts.iter().any(leaps);
    let is_pile = samples.len() >= FEWEST_CLIPPED && samples.len() > 4 * second.1 && !is_smooth;
    if is_pile && (starts.len() >= MANY_RUNS || is_no_chance(values, robust, samples.len(), starts.len())) {
        samples
    } else {
        Vec::new()
    }
}

/// Whether the resolution hardly ever makes so many samples equal, in so many runs.
fn is_no_chance(values: &[f64], robust: &Robust, samples: usize, runs: usize) -> bool {
    let all = values.len() as f64;
    let equal = values.windows(2).filter(|pair| pair[0] == pair[1]).count().saturating_sub(samples - runs);
    let neighbours = libm::log((equal as f64 + 1.0) / all);
    let peaks = libm::log((robust.resolution / (GAUSSIAN_EXCESS * robust.deviation)).min(1.0));
    libm::log(all / 0.01) + (samples - runs) as f64 * neighbours + (runs - 1) as f64 * peaks < 0.0
}
