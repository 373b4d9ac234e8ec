//! Closed loops with numbers that are drawn, not measured of laid webs: so many that it shows how often the intervals hold the truth.

use super::find;
use super::parameter::Parameter;
use super::simulator::Simulator;
use super::target::Target;
use super::webs::{MOST_TRIALS, Webs};
use super::weights::Matrix;
use crate::error::Error;
use crate::study::Journal;
use crate::units::Dimension;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Sides of the patches, side of the web, and the length over which a filament of noise 1 evens out [mm].
const SIDES: [f64; 5] = [2.0, 5.0, 10.0, 20.0, 50.0];
const WEB: f64 = 200.0;
const LENGTH: f64 = 190.0;
/// Correlation of neighbouring patches falls to 1/e over so many octaves of their sides.
const OCTAVES: f64 = 1.4;
/// Share of the variance that a trial does not have in common with the others, because a key may change which random numbers a filament takes.
const FRESH: f64 = 0.1;

/// Webs of two keys that make up for each other in part: more noise and more filaments both make the web even. Logarithms are normal, and scatter as
/// those of so many patches as the web has.
struct Drawn {
    values: Vec<f64>,
    seed: u64,
}

impl Drawn {
    fn length(&self) -> f64 {
        LENGTH / self.values[0]
    }

    fn mean(&self) -> impl Iterator<Item = f64> {
        let (length, filaments) = (self.length(), self.values[1]);
        SIDES.into_iter().map(move |side| 0.5 * (length / (side + length) / filaments).ln())
    }

    /// Normal numbers whose correlation falls with the ratio of the sides.
    fn correlated(random: &mut ChaCha8Rng) -> Vec<f64> {
        let mut uniform = || (f64::from(random.next_u32()) + 0.5) / 2f64.powi(32);
        let mut normal = || (-2.0 * uniform().ln()).sqrt() * (std::f64::consts::TAU * uniform()).cos();
        let mut all: Vec<f64> = Vec::new();
        for (i, side) in SIDES.iter().enumerate() {
            let own = normal();
            all.push(match i.checked_sub(1) {
                Some(before) => {
                    let kept = (-(side / SIDES[before]).log2() / OCTAVES).exp();
                    kept * all[before] + (1.0 - kept * kept).sqrt() * own
                }
                None => own,
            });
        }
        all
    }
}

impl Simulator for Drawn {
    fn set(&mut self, values: &[f64]) -> Result<(), Error> {
        values.clone_into(&mut self.values);
        Ok(())
    }

    fn web(&mut self, replicate: u64) -> Result<Vec<f64>, Error> {
        let seed = self.seed * 1000 + replicate;
        let common = Self::correlated(&mut ChaCha8Rng::seed_from_u64(seed));
        let bits = self.values.iter().fold(seed, |sum, value| sum.rotate_left(7) ^ value.to_bits());
        let fresh = Self::correlated(&mut ChaCha8Rng::seed_from_u64(bits));
        let length = self.length();
        let scatter = |(i, mean): (usize, f64)| {
            let patches = (WEB / (SIDES[i] + length)).powi(2);
            let normal = (1.0 - FRESH).sqrt() * common[i] + FRESH.sqrt() * fresh[i];
            mean + normal / (2.0 * patches).sqrt()
        };
        Ok(self.mean().enumerate().map(scatter).collect())
    }

    fn errors_of_model(&mut self) -> Result<Matrix, Error> {
        Ok(Vec::new())
    }
}

fn parameter(key: &str, start: f64, range: [f64; 2]) -> Parameter {
    Parameter { key: key.to_owned(), dimension: Dimension::Ratio, whole: false, start, range }
}

/// How many intervals of so many loops lie below the truth, hold it, lie above it; by key.
fn coverage(parameters: &[Parameter], truth: &[f64], (loops, webs): (u64, u64)) -> Vec<[usize; 3]> {
    let mut counts = vec![[0; 3]; parameters.len()];
    for seed in 1..=loops {
        let scan = Drawn { values: truth.to_vec(), seed: seed + loops }.web(0).unwrap();
        let target = Target::of_patches(&SIDES.map(|side| 1e-3 * side), scan);
        let mut simulator = Drawn { values: truth.to_vec(), seed };
        let mut journal = Journal::in_memory(MOST_TRIALS);
        let found =
            find(&mut Webs::new((parameters, &target), (&mut simulator, webs), &mut journal, &|_| {}))
                .unwrap();
        for ((key, truth), counts) in found.keys.iter().zip(truth).zip(&mut counts) {
            let [low, high] = key.interval.clone().unwrap();
            counts[usize::from(*truth <= high) + usize::from(*truth < low)] += 1;
        }
    }
    counts
}

#[test]
fn stat_intervals_hold_the_truth_as_often_as_they_say() {
    let parameters = [parameter("noise", 12.0, [2.4, 60.0]), parameter("filaments", 250.0, [50.0, 1250.0])];
    let counts = coverage(&parameters, &[16.0, 350.0], (1000, 20));
    println!("{counts:?}");
    for [below, within, above] in counts {
        // Of 95 %, 0.7 % are a standard error; of 2.5 % to each side, 0.5 %.
        assert!((930..=975).contains(&within), "{within} of 1000");
        assert!(below.max(above) <= 40 && below.min(above) >= 8, "{below} below, {above} above");
    }
}
