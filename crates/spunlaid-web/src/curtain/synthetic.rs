//! Synthetic curves for tests: a normal field with a known covariance.

use super::{Curtain, FlownCurves};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use spunlaid_ground::place::Inlet;
use std::f64::consts::TAU;

/// A normal field that repeats itself across, of normal covariance across and along the machine direction,
/// `σ² exp(−Δz²/2ℓ² − Δy²/2m²)`. Along the fibre it is a Markov process of the correlation `memory` from
/// point to point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Field {
    pub(super) turn: f64,
    pub(super) sigma: f64,
    /// ℓ and m [m]; m is infinite without depth.
    pub(super) scales: [f64; 2],
    pub(super) memory: f64,
    pub(super) points: usize,
    pub(super) seed: u64,
}

impl Default for Field {
    fn default() -> Self {
        Self { turn: 0.128, sigma: 0.02, scales: [8e-3, f64::INFINITY], memory: 0.0, points: 4000, seed: 1 }
    }
}

pub(super) const SPACING: f64 = 4e-3;
pub(super) const BELT_RATIO: f64 = 0.08;

/// A number of the normal distribution (Box and Muller).
fn normal(random: &mut ChaCha8Rng) -> f64 {
    let mut uniform = || ((random.next_u64() >> 11) as f64 + 0.5) / 9_007_199_254_740_992.0;
    let (radius, angle) = ((-2.0 * uniform().ln()).sqrt(), TAU * uniform());
    radius * angle.cos()
}

impl Field {
    /// Deviations at some places, in both directions [m].
    pub(super) fn curves(&self, places: &[Inlet]) -> Vec<Vec<[f64; 2]>> {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        let [z, y] = self.scales;
        // Waves across, and along the machine direction on a period of six scales beyond all places.
        let wave = TAU / self.turn;
        let most = (4.0 / z / (TAU / self.turn)).ceil() as i32;
        let depth = places.iter().map(|place| place.y.abs()).fold(0.0, f64::max);
        let (wave_y, most_y) = match y.is_finite() {
            true => {
                (TAU / (2.0 * depth + 6.0 * y), (4.0 / y / (TAU / (2.0 * depth + 6.0 * y))).ceil() as i32)
            }
            false => (0.0, 0),
        };
        let mut waves = Vec::new();
        for i in 0..=most {
            for j in -most_y..=most_y {
                let [a, b] = [f64::from(i) * wave, f64::from(j) * wave_y];
                let share = if i == 0 { 1.0 } else { 2.0 };
                let along = if y.is_finite() { b * y } else { 0.0 };
                waves.push(([a, b], share * (-0.5 * (a * z).powi(2) - 0.5 * along.powi(2)).exp()));
            }
        }
        let whole: f64 = waves.iter().map(|(_, power)| power).sum();
        let mut curves = vec![Vec::with_capacity(self.points); places.len()];
        let mut amplitudes = vec![[[0.0; 2]; 2]; waves.len()];
        for point in 0..self.points {
            let fresh = if point == 0 { 1.0 } else { (1.0 - self.memory * self.memory).sqrt() };
            for amplitude in amplitudes.as_flattened_mut().as_flattened_mut() {
                *amplitude = self.memory * *amplitude + fresh * normal(&mut random);
            }
            for (curve, place) in curves.iter_mut().zip(places) {
                let mut sum = [0.0; 2];
                for (([a, b], power), amplitudes) in waves.iter().zip(&amplitudes) {
                    let (sin, cos) = (a * place.z + b * place.y).sin_cos();
                    let size = self.sigma * (power / whole).sqrt();
                    (0..2).for_each(|d| sum[d] += size * (cos * amplitudes[d][0] + sin * amplitudes[d][1]));
                }
                curve.push(sum);
            }
        }
        curves
    }

    pub(super) fn simulated(&self, places: Vec<Inlet>) -> FlownCurves {
        let curves = self.curves(&places);
        self.flown_of(places, &curves)
    }

    /// Adds what each filament has for itself, a part of the variance.
    pub(super) fn with_noise(&self, simulated: &FlownCurves, part: f64) -> FlownCurves {
        let mut random = ChaCha8Rng::seed_from_u64(!self.seed);
        let mut noisy = |value: f32| f64::from(value) + self.sigma * part.sqrt() * normal(&mut random);
        let curve = |filament: usize| {
            let [md, cd] = [0, 1].map(|d| simulated.deviations(filament, d));
            md.iter().zip(cd).map(|(md, cd)| [noisy(*md), noisy(*cd)]).collect()
        };
        let curves: Vec<Vec<[f64; 2]>> = (0..simulated.places().len()).map(curve).collect();
        self.flown_of(simulated.places().to_vec(), &curves)
    }

    pub(super) fn flown_of(&self, places: Vec<Inlet>, curves: &[Vec<[f64; 2]>]) -> FlownCurves {
        FlownCurves::new(places, Some(self.turn), SPACING, BELT_RATIO, curves).unwrap()
    }
}

/// Filaments at an even pitch.
pub(super) fn row(turn: f64, count: usize) -> Vec<Inlet> {
    (0..count).map(|i| Inlet { y: 0.0, z: (i as f64 + 0.5) * turn / count as f64 }).collect()
}

/// Filaments at an even pitch across, at random places of a slot.
pub(super) fn slot(turn: f64, count: usize, depth: f64) -> Vec<Inlet> {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut uniform = || (random.next_u64() >> 11) as f64 / 9_007_199_254_740_992.0;
    row(turn, count).into_iter().map(|place| Inlet { y: depth * (uniform() - 0.5), ..place }).collect()
}
