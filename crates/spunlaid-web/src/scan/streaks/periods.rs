//! Periods across a web: waves of the profile that are stronger than sampling error makes them.

use super::noise::Noise;
use super::profiles::{Profiles, product};
use super::{LEVEL, ScanPeriod};
use spunlaid_ground::statistics::quantile;
use std::f64::consts::{LN_2, TAU};

/// Most periods.
const MOST_PERIODS: usize = 6;
/// Fewest periods on the width, and fewest bins of a period.
const FEWEST_PERIODS: usize = 5;
const BINS_OF_PERIOD: usize = 4;
/// Waves to both sides from which the strength of the noise is found, and those between which a period stands out.
const SMOOTHED: usize = 3;
const BESIDE: [usize; 2] = [3, 8];
/// A period is in each of so many parts of the width by at least a share; a single streak is not.
const PARTS: usize = 3;
const LEAST_PART: f64 = 1.0 / 3.0;

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
pub(super) fn periods(noise: &Noise, profiles: &Profiles, profile: &mut [f64]) -> Vec<ScanPeriod> {
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
        let scale = profiles.scales.partition_point(|scale| scale.sigma < sigma).min(noise.scales.len() - 1);
        noise.scales[scale].raised * mean(wave, SMOOTHED).max(mean(wave, 1))
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
            period: bins as f64 * profiles.bin / exact,
            amplitude: cosine.hypot(sine),
            standard_error: (0.5 * expected(wave)).sqrt(),
            chance,
        });
    }
    found
}
