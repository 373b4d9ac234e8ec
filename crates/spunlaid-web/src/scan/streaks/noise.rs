//! What sampling error does to the profile across a web: from the scatter of blocks along the machine.

use super::profiles::{Profiles, Scale, best_fit, product};
use crate::map::Map;
use spunlaid_ground::random::{stream, uniform};
use spunlaid_ground::statistics::quantile;
use std::f64::consts::TAU;

/// Numbers of blocks along the machine, the finest first, and the correlation of neighbouring blocks up to which one
/// serves, and the last one at all.
const BLOCKS: [usize; 4] = [32, 16, 8, 4];
const CORRELATED: [f64; 2] = [0.2, 0.4];
/// Fewest independent values, of all blocks and positions, from which a variance is known.
const FEWEST: f64 = 24.0;
/// A smaller variance is rounding.
const EVEN: f64 = 1e-20;
/// Correlation of heights from which on those further apart across the web are independent.
const APART: f64 = 0.1;
/// Scales to both sides from which the correlation of blocks is found, and so many of its errors are added to it.
const NEAR: usize = 2;
const ERRORS: f64 = 0.5;
/// Profiles without streaks that are drawn.
pub(super) const DRAWS: usize = 399;

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

/// What sampling error does to the mean of the profiles of some blocks along the machine.
pub(super) struct Noise {
    pub(super) mean: Vec<f64>,
    /// Of each block, from the mean.
    pub(super) blocks: Vec<Vec<f64>>,
    /// For each normal profile.
    pub(super) scales: Vec<ScaleNoise>,
    /// Largest correlation of neighbouring blocks over the normal profiles.
    correlation: f64,
}

/// The same of the heights of a normal profile.
pub(super) struct ScaleNoise {
    /// In each block, at each position.
    heights: Vec<Vec<f64>>,
    /// Their variance.
    variance: f64,
    /// How many independent heights there are across the web.
    independent: f64,
    /// Correlation of neighbouring blocks.
    correlation: f64,
    /// By how much the correlation of the blocks raises the variance of the mean.
    pub(super) raised: f64,
    /// Standard error of a height of the mean.
    pub(super) error: f64,
}

impl ScaleNoise {
    /// * `heights` – in each block
    ///
    /// Nothing is known yet of what the correlation does to the mean.
    fn new(heights: Vec<Vec<f64>>) -> Self {
        let number = heights.len() as f64;
        let degrees = (number - 1.0) * heights[0].len() as f64;
        let variance = heights.iter().map(|block| product(block, block)).sum::<f64>() / degrees;
        let next = heights.windows(2).map(|two| product(&two[0], &two[1])).sum::<f64>() / degrees;
        // The mean of the blocks, which is taken off, makes them alike by −1/number.
        let correlation = (next / variance + 1.0 / number) / (1.0 - 2.0 / number);
        let independent = independent(&heights);
        Self { heights, variance, independent, correlation, raised: f64::NAN, error: f64::NAN }
    }
}

/// The profile of each block along the machine over its mean, less one.
///
/// * `count` – number of blocks
/// * `each` – columns of a bin
fn block_profiles(map: &Map, count: usize, each: usize) -> Vec<Vec<f64>> {
    let (rows, bins) = (map.rows / count, map.columns / each);
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
    (0..count).map(block).collect()
}

impl Noise {
    /// Of the largest number of blocks that are independent; none if a few are not.
    ///
    /// * `each` – columns of a bin
    pub(super) fn new(map: &Map, each: usize, profiles: &Profiles) -> Option<Self> {
        let fit = BLOCKS.into_iter().filter(|count| 2 * count <= map.rows);
        let mut last = None;
        for count in fit {
            let noise = Self::of_blocks(block_profiles(map, count, each), profiles);
            let least = noise.scales.iter().map(|scale| scale.independent).fold(f64::INFINITY, f64::min);
            let is_even = noise.scales.iter().any(|scale| scale.variance < EVEN);
            if is_even || (count as f64 - 1.0) * least < FEWEST {
                break;
            }
            if noise.correlation < CORRELATED[0] {
                return Some(noise);
            }
            last = (noise.correlation < CORRELATED[1]).then_some(noise);
        }
        last
    }

    /// * `blocks` – their profiles
    fn of_blocks(mut blocks: Vec<Vec<f64>>, profiles: &Profiles) -> Self {
        let (number, bins) = (blocks.len() as f64, blocks[0].len());
        let mean: Vec<f64> =
            (0..bins).map(|bin| blocks.iter().map(|block| block[bin]).sum::<f64>() / number).collect();
        for block in &mut blocks {
            block.iter_mut().zip(&mean).for_each(|(value, mean)| *value -= mean);
        }
        let mut rough = blocks.clone();
        rough.iter_mut().for_each(|block| profiles.smooth.take_out(block));
        let of_scale =
            |scale: &Scale| ScaleNoise::new(rough.iter().map(|block| scale.heights(block)).collect());
        let mut scales: Vec<ScaleNoise> = profiles.scales.iter().map(of_scale).collect();
        let mut largest = f64::NEG_INFINITY;
        for at in 0..scales.len() {
            let near = &scales[at.saturating_sub(NEAR)..(at + NEAR + 1).min(scales.len())];
            let weight: f64 = near.iter().map(|scale| scale.independent).sum();
            let sum: f64 = near.iter().map(|scale| scale.independent * scale.correlation).sum();
            largest = largest.max(sum / weight);
            let own = &mut scales[at];
            let error = 1.0 / ((number - 1.0) * own.independent).sqrt();
            let correlation = sum / weight + ERRORS * error;
            own.raised = 1.0 + 2.0 * (1.0 - 1.0 / number) * correlation.max(0.0);
            own.error = (own.variance * own.raised / number).sqrt();
        }
        Self { mean, blocks, scales, correlation: largest }
    }

    /// The scales at which 95 % of the fits lie if the chance of some place and block is added to a streak.
    ///
    /// * `heights` – of the streak at each scale
    pub(super) fn range_of_fits(&self, profiles: &Profiles, heights: &[f64]) -> [f64; 2] {
        let (bins, mut fits) = (self.mean.len(), Vec::new());
        for block in 0..self.blocks.len() {
            for place in (0..bins).step_by((bins / 40).max(1)) {
                let noisy = |i: usize| {
                    let own = &self.scales[i];
                    let at = profiles.scales[i].nearest(place as f64);
                    heights[i] + own.error / own.variance.sqrt() * own.heights[block][at]
                };
                let noisy: Vec<f64> = (0..self.scales.len()).map(noisy).collect();
                fits.push(best_fit(&noisy).0);
            }
        }
        [0.025, 0.975].map(|share| quantile(&fits, share))
    }

    /// Largest heights over their standard error of profiles without streaks, in ascending order: the blocks are
    /// shifted against each other across the web and turned round at random.
    pub(super) fn draws(&self) -> Vec<f64> {
        let number = self.blocks.len();
        let draw = |draw: u64| {
            let mut random = stream([draw, 0, 0, 0]);
            let moves: Vec<(f64, f64)> = (0..number)
                .map(|_| (uniform(&mut random), if uniform(&mut random) < 0.5 { 1.0 } else { -1.0 }))
                .collect();
            let mut most: f64 = 0.0;
            for scale in &self.scales {
                let places = scale.heights[0].len();
                let mut sums = vec![0.0; places];
                for (block, (shift, sign)) in scale.heights.iter().zip(&moves) {
                    let (before, behind) = block.split_at((shift * places as f64) as usize);
                    let shifted = behind.iter().chain(before);
                    sums.iter_mut().zip(shifted).for_each(|(sum, value)| *sum += sign * value);
                }
                let largest = sums.into_iter().fold(0.0, |most: f64, sum| most.max(sum.abs()));
                // The variance itself is known from a few places and blocks: by Wilson and Hilferty, as in `chance`.
                let degrees = (number as f64 - 1.0) * scale.independent;
                let [length, angle] = [(); 2].map(|()| uniform(&mut random));
                let normal = (-2.0 * libm::log(1.0 - length)).sqrt() * libm::cos(TAU * angle);
                let spread = 2.0 / (9.0 * degrees);
                let known = (1.0 - spread + normal * spread.sqrt()).max(0.1).powi(3);
                most = most.max(largest / ((number as f64 - 1.0) * scale.variance * known).sqrt());
            }
            most
        };
        let mut all: Vec<f64> = (0..DRAWS as u64).map(draw).collect();
        all.sort_by(f64::total_cmp);
        all
    }
}
