//! Streaks along the machine: where the basis weight across a scan differs from its surroundings, in the same way along
//! the whole scan, by more than clouds make it.                                             theory.md (115a), (115b)

use crate::ground::Known;
use crate::ground::random::{stream, uniform};
use crate::ground::statistics::quantile;
use crate::web::map::Map;
use std::f64::consts::{LN_2, TAU};

/// Fewest and most bins of the profile across.
const BINS: [usize; 2] = [32, 800];
/// The σ of a streak is at most this part of the width, and the next one that is looked for is wider by a factor.
const WIDEST: f64 = 1.0 / 14.0;
const WIDER: f64 = 1.4;
/// A streak reaches so many σ to both sides.
const REACH: f64 = 3.0;
/// Degree of the polynomial across the whole web that is no streak, be it the lamp or the web; where the lamp is a
/// guess, too.
const DEGREES: [u16; 2] = [4, 6];
/// A streak is looked for where the polynomial leaves at least this share of its squares.
const LEFT: f64 = 0.15;
/// Numbers of blocks along the machine, the finest first, and the correlation of neighbouring blocks up to which one
/// serves, and the last one at all.
const BLOCKS: [usize; 4] = [32, 16, 8, 4];
const CORRELATED: [f64; 2] = [0.2, 0.4];
/// Fewest independent values, of all blocks and places, that tell a variance.
const FEWEST: f64 = 24.0;
/// A smaller variance is rounding.
const EVEN: f64 = 1e-20;
/// Correlation of heights from which on those further apart across the web are independent.
const APART: f64 = 0.1;
/// Scales to both sides that tell the correlation of blocks together, and so many of its errors are added to it.
const NEAR: usize = 2;
const ERRORS: f64 = 0.5;
/// Profiles of chance, and the share of them that may have a streak; as many may have a period.
const DRAWS: usize = 399;
const LEVEL: f64 = 0.025;
/// Most streaks and periods.
const MOST: usize = 20;
const MOST_PERIODS: usize = 6;
/// Near a streak, what is smaller by this factor is the rest of its form.
const REST: f64 = 0.5;
/// Fewest periods on the width, and fewest bins of a period.
const FEWEST_PERIODS: usize = 5;
const BINS_OF_PERIOD: usize = 4;
/// Waves to both sides that tell the strength of chance, and those between which a period stands out.
const SMOOTHED: usize = 3;
const BESIDE: [usize; 2] = [3, 8];
/// A period is in each of so many parts of the width by at least a share; a single streak is not.
const PARTS: usize = 3;
const LEAST_PART: f64 = 1.0 / 3.0;

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
/// * `is_guess` – whether nothing is known of the shading of the lamp
pub(super) fn search(map: &Map, is_guess: bool) -> Option<StreakSearch> {
    let each = map.columns.div_ceil(BINS[1]);
    let bins = map.columns / each;
    if bins < BINS[0] {
        return None;
    }
    let most = WIDEST * bins as f64;
    let sigmas = std::iter::successors(Some(1.0), |sigma| Some(WIDER * sigma));
    let smooth = Smooth::new(bins, DEGREES[usize::from(is_guess)]);
    let scales = sigmas.take_while(|sigma| *sigma <= most).map(|sigma| Scale::new(sigma, &smooth));
    let scales: Vec<Scale> = scales.filter(|scale| !scale.norms.is_empty()).collect();
    let noise = Noise::new(map, each, (&scales, &smooth))?;
    let bin = each as f64 * map.cell;
    let mut rest = noise.mean.clone();
    let periods = periods(&noise, &scales, bin, &mut rest);
    smooth.take_out(&mut rest);
    let by_chance = noise.draws();
    let threshold = by_chance[((1 + DRAWS) as f64 * (1.0 - LEVEL)).round() as usize - 1];
    let limit = |(scale, error): (&Scale, &f64)| StreakLimit {
        sigma: scale.sigma * bin,
        amplitude: threshold * error / scale.norms[scale.norms.len() / 2].sqrt(),
    };
    let limits = scales.iter().zip(&noise.errors).map(limit).collect();
    let mut streaks: Vec<ScanStreak> = Vec::new();
    while streaks.len() < MOST {
        let Some(found) = clearest(&rest, &scales, (&noise, bin), &streaks) else { break };
        let times = found.amplitude.abs() / found.standard_error;
        let above = by_chance.len() - by_chance.partition_point(|most| *most < times);
        let chance = (1 + above) as f64 / (1 + DRAWS) as f64;
        if chance > LEVEL {
            break;
        }
        for (i, value) in rest.iter_mut().enumerate() {
            let far = ((i as f64 + 0.5) * bin - found.place) / found.sigma;
            *value -= found.amplitude * libm::exp(-0.5 * far * far);
        }
        smooth.take_out(&mut rest);
        streaks.push(ScanStreak { chance, ..found });
    }
    Some(StreakSearch { bin, profile: noise.mean, limits, streaks, periods })
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Polynomials across the web, orthogonal and of unit length.
struct Smooth(Vec<Vec<f64>>);

impl Smooth {
    fn new(bins: usize, most: u16) -> Self {
        let mut all = Self(Vec::new());
        for degree in 0..=most {
            let place = |bin: usize| (2.0 * bin as f64 + 1.0) / bins as f64 - 1.0;
            let mut own: Vec<f64> = (0..bins).map(|bin| place(bin).powi(i32::from(degree))).collect();
            // Twice, for rounding.
            (0..2).for_each(|_| all.take_out(&mut own));
            let length = product(&own, &own).sqrt();
            own.iter_mut().for_each(|value| *value /= length);
            all.0.push(own);
        }
        all
    }

    fn take_out(&self, profile: &mut [f64]) {
        for own in &self.0 {
            let part = product(own, profile);
            profile.iter_mut().zip(own).for_each(|(value, own)| *value -= part * own);
        }
    }
}

/// A width of streaks.
#[derive(Debug)]
struct Scale {
    /// In bins.
    sigma: f64,
    /// The normal profile.
    normal: Vec<f64>,
    /// The first place that is looked at, and from one to the next [bins].
    first: usize,
    stride: usize,
    /// For each place the squares of the normal profile without its part in the polynomials.
    norms: Vec<f64>,
}

impl Scale {
    fn new(sigma: f64, smooth: &Smooth) -> Self {
        let half = (REACH * sigma).ceil() as i32;
        let normal = (-half..=half).map(|i| libm::exp(-0.5 * (f64::from(i) / sigma).powi(2))).collect();
        let stride = ((0.25 * sigma) as usize).max(1);
        let mut scale = Self { sigma, normal, first: 0, stride, norms: Vec::new() };
        let whole = product(&scale.normal, &scale.normal);
        let bins = smooth.0[0].len();
        let norm = |place: usize| {
            let own = scale.around(place, bins);
            let squares: f64 = own.1.iter().map(|value| value * value).sum();
            let taken = |other: &Vec<f64>| product(&other[own.0..], own.1).powi(2);
            squares - smooth.0.iter().map(taken).sum::<f64>()
        };
        let all: Vec<(usize, f64)> = (0..bins).step_by(stride).map(|place| (place, norm(place))).collect();
        let middle = |(_, norm): &&(usize, f64)| *norm >= LEFT * whole;
        let left: Vec<(usize, f64)> = all.iter().filter(middle).copied().collect();
        scale.first = left.first().map_or(0, |(place, _)| *place);
        scale.norms = left.into_iter().map(|(_, norm)| norm).collect();
        scale
    }

    /// The part of the normal profile about a bin that lies on the web, and the bin where it begins.
    fn around(&self, place: usize, bins: usize) -> (usize, &[f64]) {
        let half = self.normal.len() / 2;
        let from = place.saturating_sub(half);
        let until = (place + half + 1).min(bins);
        (from, &self.normal[from + half - place..until + half - place])
    }

    /// Amplitudes of the least squares at all places, times the roots of their norms, of a profile without polynomial.
    fn heights(&self, profile: &[f64]) -> Vec<f64> {
        let height = |(number, norm): (usize, &f64)| {
            let (from, normal) = self.around(self.first + number * self.stride, profile.len());
            product(&profile[from..], normal) / norm.sqrt()
        };
        self.norms.iter().enumerate().map(height).collect()
    }

    /// The number of the place that is looked at nearest to one [bins].
    fn nearest(&self, place: f64) -> usize {
        let number = (place - 0.5 - self.first as f64) / self.stride as f64;
        (number.round().max(0.0) as usize).min(self.norms.len() - 1)
    }

    /// A place that is looked at [bins].
    fn place(&self, number: usize) -> f64 {
        (self.first + number * self.stride) as f64 + 0.5
    }
}

/// How many independent heights there are across the web.
///
/// * `heights` – in each block
fn independent(heights: &[Vec<f64>]) -> f64 {
    let places = heights[0].len();
    let lagged = |lag: usize| {
        let sum: f64 = heights.iter().map(|block| product(&block[lag..], block)).sum();
        sum / (places - lag) as f64
    };
    let variance = lagged(0);
    let correlations = (1..places).map(|lag| lagged(lag) / variance).take_while(|r| *r > APART);
    places as f64 / (1.0 + 2.0 * correlations.map(|r| r * r).sum::<f64>())
}

/// What chance does to the mean of the profiles of the blocks.
struct Noise {
    mean: Vec<f64>,
    /// Of each block, from the mean.
    blocks: Vec<Vec<f64>>,
    /// Of each scale: the heights in each block, and their variance.
    heights: Vec<(Vec<Vec<f64>>, f64)>,
    /// Of each scale: how many independent heights there are across the web.
    independent: Vec<f64>,
    /// Of each scale: by how much the correlation of the blocks raises the variance of the mean.
    raised: Vec<f64>,
    /// Standard error of a height of each scale.
    errors: Vec<f64>,
}

impl Noise {
    /// Of the largest number of blocks that are independent; none if a few are not.
    ///
    /// * `each` – columns of a bin
    fn new(map: &Map, each: usize, by: (&[Scale], &Smooth)) -> Option<Self> {
        let fit = BLOCKS.into_iter().filter(|count| 2 * count <= map.rows);
        let mut last = None;
        for count in fit {
            let (noise, correlation) = Self::of_blocks(map, (each, count), by);
            let least = noise.independent.iter().copied().fold(f64::INFINITY, f64::min);
            let is_even = noise.heights.iter().any(|(_, variance)| *variance < EVEN);
            if is_even || (count as f64 - 1.0) * least < FEWEST {
                break;
            }
            if correlation < CORRELATED[0] {
                return Some(noise);
            }
            last = (correlation < CORRELATED[1]).then_some(noise);
        }
        last
    }

    /// With the largest correlation of neighbouring blocks over the scales.
    fn of_blocks(
        map: &Map,
        (each, count): (usize, usize),
        (scales, smooth): (&[Scale], &Smooth),
    ) -> (Self, f64) {
        let (rows, number, bins) = (map.rows / count, count as f64, map.columns / each);
        let block = |block: usize| {
            let mut sums = vec![0.0; bins];
            for row in block * rows..(block + 1) * rows {
                let parts = map.row(row).chunks_exact(each);
                sums.iter_mut()
                    .zip(parts)
                    .for_each(|(sum, part)| *sum += part.iter().map(|x| f64::from(*x)).sum::<f64>());
            }
            let mean = sums.iter().sum::<f64>() / bins as f64;
            sums.into_iter().map(|sum| sum / mean - 1.0).collect()
        };
        let mut blocks: Vec<Vec<f64>> = (0..count).map(block).collect();
        let mean: Vec<f64> =
            (0..bins).map(|bin| blocks.iter().map(|block| block[bin]).sum::<f64>() / number).collect();
        for block in &mut blocks {
            block.iter_mut().zip(&mean).for_each(|(value, mean)| *value -= mean);
        }
        let mut rough = blocks.clone();
        rough.iter_mut().for_each(|block| smooth.take_out(block));
        let mut heights = Vec::new();
        let (mut correlations, mut independents) = (Vec::new(), Vec::new());
        for scale in scales {
            let all: Vec<Vec<f64>> = rough.iter().map(|block| scale.heights(block)).collect();
            let degrees = (number - 1.0) * all[0].len() as f64;
            let variance = all.iter().map(|block| product(block, block)).sum::<f64>() / degrees;
            let next = all.windows(2).map(|two| product(&two[0], &two[1])).sum::<f64>() / degrees;
            // The mean of the blocks, which is taken off, makes them alike by −1/number.
            correlations.push((next / variance + 1.0 / number) / (1.0 - 2.0 / number));
            independents.push(independent(&all));
            heights.push((all, variance));
        }
        let (mut raised, mut largest) = (Vec::new(), f64::NEG_INFINITY);
        for at in 0..scales.len() {
            let near = at.saturating_sub(NEAR)..(at + NEAR + 1).min(scales.len());
            let weight: f64 = independents[near.clone()].iter().sum();
            let sum = product(&independents[near.clone()], &correlations[near]);
            largest = largest.max(sum / weight);
            let error = 1.0 / ((number - 1.0) * independents[at]).sqrt();
            let correlation = sum / weight + ERRORS * error;
            raised.push(1.0 + 2.0 * (1.0 - 1.0 / number) * correlation.max(0.0));
        }
        let error = |((_, variance), raised): (&(_, f64), &f64)| (variance * raised / number).sqrt();
        let errors = heights.iter().zip(&raised).map(error).collect();
        (Self { mean, blocks, heights, independent: independents, raised, errors }, largest)
    }

    /// The scales at which 95 % of the fits lie if the chance of some place and block is added to a streak.
    ///
    /// * `heights` – of the streak at each scale
    fn range_of_fits(&self, scales: &[Scale], heights: &[f64]) -> [f64; 2] {
        let (bins, mut fits) = (self.mean.len(), Vec::new());
        for block in 0..self.blocks.len() {
            for place in (0..bins).step_by((bins / 40).max(1)) {
                let noisy = |i: usize| {
                    let own = &self.heights[i];
                    heights[i] + self.errors[i] / own.1.sqrt() * own.0[block][scales[i].nearest(place as f64)]
                };
                let noisy: Vec<f64> = (0..scales.len()).map(noisy).collect();
                fits.push(best_fit(&noisy).0);
            }
        }
        [0.025, 0.975].map(|share| quantile(&fits, share))
    }

    /// Largest heights over their standard error of profiles without streaks, in ascending order: the blocks are
    /// shifted against each other across the web and turned round at random.
    fn draws(&self) -> Vec<f64> {
        let number = self.blocks.len();
        let draw = |draw: u64| {
            let mut random = stream([draw, 0, 0, 0]);
            let moves: Vec<(f64, f64)> = (0..number)
                .map(|_| (uniform(&mut random), if uniform(&mut random) < 0.5 { 1.0 } else { -1.0 }))
                .collect();
            let mut most: f64 = 0.0;
            for ((blocks, variance), independent) in self.heights.iter().zip(&self.independent) {
                let places = blocks[0].len();
                let mut sums = vec![0.0; places];
                for (block, (shift, sign)) in blocks.iter().zip(&moves) {
                    let (before, behind) = block.split_at((shift * places as f64) as usize);
                    let shifted = behind.iter().chain(before);
                    sums.iter_mut().zip(shifted).for_each(|(sum, value)| *sum += sign * value);
                }
                let largest = sums.into_iter().fold(0.0, |most: f64, sum| most.max(sum.abs()));
                // The variance itself is known from a few places and blocks: by Wilson and Hilferty, as in `chance`.
                let degrees = (number as f64 - 1.0) * independent;
                let [length, angle] = [(); 2].map(|()| uniform(&mut random));
                let normal = (-2.0 * libm::log(1.0 - length)).sqrt() * libm::cos(TAU * angle);
                let spread = 2.0 / (9.0 * degrees);
                let known = (1.0 - spread + normal * spread.sqrt()).max(0.1).powi(3);
                most = most.max(largest / ((number as f64 - 1.0) * variance * known).sqrt());
            }
            most
        };
        let mut all: Vec<f64> = (0..DRAWS as u64).map(draw).collect();
        all.sort_by(f64::total_cmp);
        all
    }
}

/// The streak with the largest amplitude over its standard error, apart from the rests of those that are known.
fn clearest(
    profile: &[f64],
    scales: &[Scale],
    (noise, bin): (&Noise, f64),
    known: &[ScanStreak],
) -> Option<ScanStreak> {
    let is_rest = |place: f64, sigma: f64, amplitude: f64| {
        known.iter().any(|known| {
            (place - known.place).abs() < REACH * known.sigma + sigma
                && amplitude.abs() < REST * known.amplitude.abs()
        })
    };
    let all: Vec<Vec<f64>> = scales.iter().map(|scale| scale.heights(profile)).collect();
    let mut best: Option<(f64, ScanStreak)> = None;
    for ((scale, error), heights) in scales.iter().zip(&noise.errors).zip(&all) {
        let sigma = scale.sigma * bin;
        for (number, (height, norm)) in heights.iter().zip(&scale.norms).enumerate() {
            let (place, amplitude) = (scale.place(number) * bin, height / norm.sqrt());
            let times = height.abs() / error;
            let is_better = best.as_ref().is_none_or(|(most, _)| times > *most);
            if is_better && !is_rest(place, sigma, amplitude) {
                let (sigma_range, standard_error) = ([sigma; 2], error / norm.sqrt());
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
    let range = noise.range_of_fits(scales, &own);
    Some(ScanStreak {
        sigma: sigma(at),
        sigma_range: [
            if range[0] <= 0.0 { 0.0 } else { sigma(range[0]) },
            if range[1] >= (scales.len() - 1) as f64 { f64::INFINITY } else { sigma(range[1]) },
        ],
        amplitude,
        standard_error: near(&|i| noise.errors[i]) / norm.sqrt(),
        ..streak
    })
}

/// The scale at which a normal profile leaves the least squares, between the scales, and its height.
fn best_fit(heights: &[f64]) -> (f64, f64) {
    let size = |i: usize| heights[i].abs();
    let best = (0..heights.len()).max_by(|a, b| size(*a).total_cmp(&size(*b))).unwrap_or(0);
    if best == 0 || best + 1 >= heights.len() {
        return (best as f64, heights[best]);
    }
    let [before, own, behind] = [size(best - 1), size(best), size(best + 1)];
    let (slope, bend) = (0.5 * (behind - before), before - 2.0 * own + behind);
    let by = if bend < 0.0 { (-slope / bend).clamp(-0.5, 0.5) } else { 0.0 };
    (best as f64 + by, heights[best].signum() * (own + slope * by + 0.5 * bend * by * by))
}

/// A wave of a profile below a Hann window: its real and imaginary part, over half of the sum of the window.
///
/// * `wave` – number of periods on the width
fn wave_of(profile: &[f64], wave: f64) -> [f64; 2] {
    let count = profile.len() as f64;
    let turn = |i: usize| TAU * (i as f64 + 0.5) / count;
    let mut sum = [0.0; 2];
    for (i, value) in profile.iter().enumerate() {
        let (sine, cosine) = libm::sincos(wave * turn(i));
        let weighed = (1.0 - libm::cos(turn(i))) * value * 2.0 / count;
        sum = [sum[0] + weighed * cosine, sum[1] + weighed * sine];
    }
    sum
}

/// Squared amplitude of a wave.
fn power(profile: &[f64], wave: f64) -> f64 {
    wave_of(profile, wave).iter().map(|part| part * part).sum()
}

/// The share of a wave that a profile holds in the same phase, both from their means.
fn share_of(wave: &[f64], profile: &[f64]) -> f64 {
    let mean = wave.iter().sum::<f64>() / wave.len() as f64;
    let own: Vec<f64> = wave.iter().map(|value| value - mean).collect();
    product(&own, profile) / product(&own, &own)
}

/// The periods of the profile, which are taken off it.
fn periods(noise: &Noise, scales: &[Scale], bin: f64, profile: &mut [f64]) -> Vec<ScanPeriod> {
    let (bins, number) = (profile.len(), noise.blocks.len() as f64);
    let waves = 1..=bins / BINS_OF_PERIOD + BESIDE[1];
    let of_blocks = |wave: usize| noise.blocks.iter().map(|block| power(block, wave as f64)).sum::<f64>();
    let raw: Vec<f64> = waves.clone().map(|wave| of_blocks(wave) / (number * (number - 1.0))).collect();
    let mean = |wave: usize, by: usize| {
        let near = &raw[(wave - 1).saturating_sub(by)..(wave + by).min(raw.len())];
        near.iter().sum::<f64>() / near.len() as f64
    };
    let expected = |wave: usize| {
        // Of the scale whose streaks are as wide.
        let sigma = bins as f64 / (4.0 * wave as f64);
        let scale = scales.partition_point(|scale| scale.sigma < sigma).min(scales.len() - 1);
        noise.raised[scale] * mean(wave, SMOOTHED).max(mean(wave, 1))
    };
    // Waves side by side below a Hann window have about two thirds of them in common.
    let degrees = (number - 1.0) * (SMOOTHED as f64 + 0.5);
    let looked_at = FEWEST_PERIODS..=bins / BINS_OF_PERIOD;
    let count = looked_at.clone().count() as f64;
    let mut found = Vec::new();
    while found.len() < MOST_PERIODS {
        let powers: Vec<f64> = waves.clone().map(|wave| power(profile, wave as f64)).collect();
        let over = |wave: usize| {
            let is_beside =
                |other: &usize| (BESIDE[0]..=BESIDE[1]).contains(&other.abs_diff(wave)) && *other > 1;
            let beside: Vec<f64> = waves.clone().filter(is_beside).map(|other| powers[other - 1]).collect();
            // The median of an exponential distribution.
            powers[wave - 1] / expected(wave).max(quantile(&beside, 0.5) / LN_2)
        };
        let all = looked_at.clone().map(|wave| (wave, over(wave)));
        let Some((wave, ratio)) = all.max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        let chance = count * libm::pow(1.0 + ratio / degrees, -degrees);
        if chance.is_nan() || chance > LEVEL {
            break;
        }
        let fine = (-20..=20).map(|part| wave as f64 + f64::from(part) / 40.0);
        let exact =
            fine.max_by(|a, b| power(profile, *a).total_cmp(&power(profile, *b))).unwrap_or(wave as f64);
        let [cosine, sine] = wave_of(profile, exact);
        let fitted = |i: usize| {
            let (s, c) = libm::sincos(exact * TAU * (i as f64 + 0.5) / bins as f64);
            cosine * c + sine * s
        };
        let fitted: Vec<f64> = (0..bins).map(fitted).collect();
        let in_part = |part: usize| {
            let part = part * bins / PARTS..(part + 1) * bins / PARTS;
            share_of(&fitted[part.clone()], &profile[part])
        };
        if (0..PARTS).any(|part| in_part(part) < LEAST_PART) {
            break;
        }
        profile.iter_mut().zip(&fitted).for_each(|(value, wave)| *value -= wave);
        found.push(ScanPeriod {
            period: bins as f64 * bin / exact,
            amplitude: cosine.hypot(sine),
            standard_error: (0.5 * expected(wave)).sqrt(),
            chance,
        });
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_xoshiro::Xoshiro256PlusPlus;
    use rand_xoshiro::rand_core::SeedableRng;

    /// A map of clouds that are about as large as the moving means of so many cells, of which two are taken each way,
    /// with noise of the pixels, times a profile across.
    fn clouds(
        (columns, rows): (usize, usize),
        (size, cv, noise): ([usize; 2], f64, f64),
        profile: impl Fn(f64) -> f64,
        seed: u64,
    ) -> Map {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut flat = |count: usize| -> Vec<f64> {
            (0..count).map(|_| (uniform(&mut random) - 0.5) * 12f64.sqrt()).collect()
        };
        let [across, along] = size;
        let (wide, long) = (columns + 2 * across, rows + 2 * along);
        let mut field = flat(wide * long);
        let mean = |values: &mut Vec<f64>, line: usize, step: usize, count: usize, by: usize| {
            let part: Vec<f64> = (0..count).map(|i| values[line + i * step]).collect();
            for i in 0..count - by {
                values[line + i * step] = part[i..i + by].iter().sum::<f64>() / by as f64;
            }
        };
        for _ in 0..2 {
            (0..long).for_each(|row| mean(&mut field, row * wide, 1, wide, across));
            (0..wide).for_each(|column| mean(&mut field, column, wide, long, along));
        }
        let inner: Vec<f64> =
            (0..rows).flat_map(|row| field[row * wide..row * wide + columns].to_vec()).collect();
        let rms = (inner.iter().map(|x| x * x).sum::<f64>() / inner.len() as f64).sqrt();
        let pixels = flat(columns * rows);
        let cell = |(i, (cloud, pixel)): (usize, (&f64, &f64))| {
            let weight = profile(((i % columns) as f64 + 0.5) / columns as f64);
            (1e6 * weight * (1.0 + cv * cloud / rms + noise * pixel)).max(0.0) as u32
        };
        let cells = inner.iter().zip(&pixels).enumerate().map(cell).collect();
        Map { columns, rows, cell: 1e-3, closed: [false; 2], quantum: 1e-11, cells }
    }

    /// Webs of clouds without any streak, fine and coarse, with and without noise of pixels: one in twenty may have a
    /// streak or a period by chance. Two standard errors of 160 such webs are allowed.
    #[test]
    fn stat_clouds_alone_make_a_streak_in_at_most_one_web_of_twenty() {
        let textures = [([3, 3], 0.2, 0.1), ([8, 5], 0.2, 0.0), ([2, 7], 0.15, 0.05), ([4, 4], 0.3, 0.3)];
        let (mut found, mut all) = (0, 0);
        for seed in 0..160 {
            let map = clouds((110, 160), textures[seed as usize % 4], |_| 1.0, seed);
            let Some(search) = search(&map, false) else { continue };
            all += 1;
            found += usize::from(!search.streaks.is_empty() || !search.periods.is_empty());
        }
        let most = 0.05 * f64::from(all) + 2.0 * (0.05 * 0.95 * f64::from(all)).sqrt();
        assert!(all > 120 && (found as f64) < most, "{found} of {all}");
    }

    /// The errors of a known streak are those of its fits, and a streak that is twice as large as the limit is found.
    #[test]
    fn stat_a_known_streak_is_found_at_its_place_with_its_amplitude_and_width() {
        let (middle, sigma) = (0.3, 6e-3);
        let (mut squares, mut inside) = (0.0, 0);
        for seed in 0..24 {
            let streak = |x: f64| 1.0 - 0.12 * libm::exp(-0.5 * ((x - middle) * 0.15 / sigma).powi(2));
            let search = search(&clouds((150, 400), ([3, 3], 0.2, 0.1), streak, 900 + seed), false).unwrap();
            let found = search.streaks[0];
            assert!((found.place - middle * 0.15).abs() < 4e-3, "{found:?}");
            // The mean is lower by the streak.
            squares += ((found.amplitude + 0.123) / found.standard_error).powi(2) / 24.0;
            let [low, high] = found.sigma_range;
            inside += usize::from((low..high).contains(&sigma));
        }
        assert!((0.4..2.2).contains(&squares) && inside >= 20, "{squares} {inside}");
    }

    #[test]
    fn stat_a_wave_across_is_found_with_its_period_and_is_no_streak() {
        for seed in 0..6 {
            let wave = |x: f64| 1.0 + 0.05 * libm::cos(TAU * x * 0.15 / 8.7e-3 + seed as f64);
            let search = search(&clouds((150, 400), ([3, 3], 0.2, 0.1), wave, 400 + seed), false).unwrap();
            let [found] = search.periods[..] else { panic!("{:?}", search.periods) };
            assert!((found.period / 8.7e-3 - 1.0).abs() < 0.01, "{found:?}");
            assert!((found.amplitude - 0.05).abs() < 4.0 * found.standard_error, "{found:?}");
            assert!(search.streaks.is_empty(), "{:?}", search.streaks);
        }
    }

    /// A scan that holds few clouds, and one that is all the same, tell nothing.
    #[test]
    fn a_scan_that_is_too_short_for_its_clouds_has_no_streaks() {
        assert_eq!(search(&clouds((110, 60), ([40, 40], 0.2, 0.0), |_| 1.0, 1), false), None);
        assert_eq!(search(&clouds((110, 160), ([3, 3], 0.0, 0.0), |_| 1.0, 1), false), None);
    }
}
