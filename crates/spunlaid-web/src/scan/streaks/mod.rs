//! Streaks along the machine: where the basis weight across a scan differs from its surroundings, in the same way along
//! the whole scan, by more than clouds make it.                                             theory.md (115a), (115b)
//!
//! ```text
//! profiles  what is fitted across the web: polynomials, which are no streaks, and normal profiles
//! noise     what sampling error does to these fits, from blocks along the machine
//! periods   waves that repeat across the web
//! ```

mod noise;
mod periods;
mod profiles;
#[cfg(test)]
mod tests;

use crate::map::Map;
use noise::{DRAWS, Noise, ScaleNoise};
use periods::periods;
use profiles::{Profiles, REACH, Scale, WIDER, best_fit};
use spunlaid_ground::Known;

/// Fewest and most bins of the profile across.
const BINS: [usize; 2] = [32, 800];
/// Degree of the polynomial across the whole web that is no streak, be it the lamp or the web; where the lamp is
/// assumed, too.
const DEGREES: [u16; 2] = [4, 6];
/// The share of webs without streaks that may have one; as many may have a period.
const LEVEL: f64 = 0.025;
/// Most streaks.
const MOST: usize = 20;
/// Near a streak, what is smaller by this factor is the rest of its form.
const REST: f64 = 0.5;

/// Width of a normal profile at half of its height, over its standard deviation.
pub const WIDTH: f64 = 2.354_82;

/// The streaks of a scan.
#[derive(Clone, Debug, PartialEq)]
pub struct StreakSearch {
    /// Width of a bin of the profile [m].
    pub bin: f64,
    /// Basis weight of each bin, averaged along the machine, over the mean, less one.
    pub profile: Vec<f64>,
    /// The least amplitude that is significant, for each width that was looked for, the narrowest first.
    pub limits: Vec<StreakLimit>,
    /// The streaks, the most significant first.
    pub streaks: Vec<ScanStreak>,
    /// Periods of the profile, the most significant first.
    pub periods: Vec<ScanPeriod>,
}

/// The least streak of a width that is significant at 95 %, of all places and widths together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreakLimit {
    /// Standard deviation of its normal profile [m].
    pub sigma: f64,
    /// Amplitude over the mean basis weight.
    pub amplitude: f64,
}

/// A streak of a scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScanStreak {
    /// Its middle, from the left edge of the map [m].
    pub place: f64,
    /// Standard deviation of the normal profile that fits best [m].
    pub sigma: f64,
    /// The 95 % interval of that; 0 and infinite ends where it was not narrowed down [m].
    pub sigma_range: [f64; 2],
    /// Height of the profile over the mean basis weight; below zero where the web is lighter.
    pub amplitude: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Probability that clouds alone make a streak as clear anywhere on the scan, at most.
    pub chance: f64,
}

/// A period of the profile across a scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScanPeriod {
    /// Its length [m].
    pub period: f64,
    /// Amplitude of the wave over the mean basis weight: half of the way from its lightest to its heaviest place.
    pub amplitude: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Probability that clouds alone make a wave as strong of any length, at most.
    pub chance: f64,
}

impl ScanStreak {
    pub(super) const fn height(&self) -> Known {
        Known::Value(self.amplitude, Some(self.standard_error))
    }

    /// Widths at half of the amplitude [m].
    pub(super) fn widths(&self) -> Known {
        match self.sigma_range.map(|sigma| WIDTH * sigma) {
            [low, high] if high.is_infinite() => Known::AtLeast(low),
            [0.0, high] => Known::AtMost(high),
            range => Known::Between(range),
        }
    }
}

impl ScanPeriod {
    pub(super) const fn height(&self) -> Known {
        Known::Value(self.amplitude, Some(self.standard_error))
    }
}

/// Searches the streaks of a map; none if it is too small, or too short for its clouds.
///
/// * `is_assumed` – whether the shading of the lamp is assumed
pub(super) fn search(map: &Map, is_assumed: bool) -> Option<StreakSearch> {
    let each = map.columns.div_ceil(BINS[1]);
    let bins = map.columns / each;
    if bins < BINS[0] {
        return None;
    }
    let bin = each as f64 * map.cell;
    let profiles = Profiles::new(bins, bin, DEGREES[usize::from(is_assumed)]);
    let noise = Noise::new(map, each, &profiles)?;
    let mut rest = noise.mean.clone();
    let periods = periods(&noise, &profiles, &mut rest);
    profiles.smooth.take_out(&mut rest);
    let drawn = noise.draws();
    let threshold = drawn[((1 + DRAWS) as f64 * (1.0 - LEVEL)).round() as usize - 1];
    let limit = |(scale, own): (&Scale, &ScaleNoise)| StreakLimit {
        sigma: scale.sigma * bin,
        amplitude: threshold * own.error / scale.norms[scale.norms.len() / 2].sqrt(),
    };
    let limits = profiles.scales.iter().zip(&noise.scales).map(limit).collect();
    let mut streaks: Vec<ScanStreak> = Vec::new();
    while streaks.len() < MOST {
        let Some(found) = clearest(&rest, &profiles, &noise, &streaks) else { break };
        let times = found.amplitude.abs() / found.standard_error;
        let above = drawn.len() - drawn.partition_point(|most| *most < times);
        let chance = (1 + above) as f64 / (1 + DRAWS) as f64;
        if chance > LEVEL {
            break;
        }
        for (i, value) in rest.iter_mut().enumerate() {
            let far = ((i as f64 + 0.5) * bin - found.place) / found.sigma;
            *value -= found.amplitude * libm::exp(-0.5 * far * far);
        }
        profiles.smooth.take_out(&mut rest);
        streaks.push(ScanStreak { chance, ..found });
    }
    Some(StreakSearch { bin, profile: noise.mean, limits, streaks, periods })
}

/// The streak with the largest amplitude over its standard error, apart from the rests of those that are known.
fn clearest(profile: &[f64], profiles: &Profiles, noise: &Noise, known: &[ScanStreak]) -> Option<ScanStreak> {
    let is_rest = |place: f64, sigma: f64, amplitude: f64| {
        known.iter().any(|known| {
            (place - known.place).abs() < REACH * known.sigma + sigma
                && amplitude.abs() < REST * known.amplitude.abs()
        })
    };
    let Profiles { bin, scales, .. } = profiles;
    let all: Vec<Vec<f64>> = scales.iter().map(|scale| scale.heights(profile)).collect();
    let mut best: Option<(f64, ScanStreak)> = None;
    for ((scale, own), heights) in scales.iter().zip(&noise.scales).zip(&all) {
        let sigma = scale.sigma * bin;
        for (number, (height, norm)) in heights.iter().zip(&scale.norms).enumerate() {
            let (place, amplitude) = (scale.place(number) * bin, height / norm.sqrt());
            let times = height.abs() / own.error;
            let is_better = best.as_ref().is_none_or(|(most, _)| times > *most);
            if is_better && !is_rest(place, sigma, amplitude) {
                let sigma_range = [sigma; 2];
                let standard_error = own.error / norm.sqrt();
                let found = ScanStreak { place, sigma, sigma_range, amplitude, standard_error, chance: 1.0 };
                best = Some((times, found));
            }
        }
    }
    let (_, streak) = best?;
    let own: Vec<f64> =
        scales.iter().zip(&all).map(|(scale, heights)| heights[scale.nearest(streak.place / bin)]).collect();
    let (at, height) = best_fit(&own);
    let near = |values: &dyn Fn(usize) -> f64| {
        let first = (at as usize).min(scales.len() - 1);
        let part = at - first as f64;
        libm::pow(values(first), 1.0 - part) * libm::pow(values((first + 1).min(scales.len() - 1)), part)
    };
    let norm = near(&|i| scales[i].norms[scales[i].nearest(streak.place / bin)]);
    let sigma = |at: f64| bin * libm::pow(WIDER, at);
    let amplitude = height / norm.sqrt();
    let range = noise.range_of_fits(profiles, &own);
    Some(ScanStreak {
        sigma: sigma(at),
        sigma_range: [
            if range[0] <= 0.0 { 0.0 } else { sigma(range[0]) },
            if range[1] >= (scales.len() - 1) as f64 { f64::INFINITY } else { sigma(range[1]) },
        ],
        amplitude,
        standard_error: near(&|i| noise.scales[i].error) / norm.sqrt(),
        ..streak
    })
}
