//! Closed loops with numbers that are drawn, not measured of laid webs: so many that it shows how often the
//! intervals hold the truth.

use super::parameter::Parameter;
use super::simulator::Simulator;
use super::target::Target;
use super::webs::Webs;
use super::weights::Matrix;
use super::{Fit, IntervalEnd, KeyWarning, find};
use crate::study::Journal;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use spunlaid_fibre::case::keys::{Kind, Sign, VariedKey};
use spunlaid_ground::{Dimension, Error};

/// Sides of the patches, side of the web, and the length over which a filament of noise 1 evens out [mm].
const SIDES: [f64; 5] = [2.0, 5.0, 10.0, 20.0, 50.0];
const WEB: f64 = 200.0;
const LENGTH: f64 = 190.0;
/// Correlation of neighbouring patches falls to 1/e over so many octaves of their sides.
const OCTAVES: f64 = 1.4;
/// Share of the variance that a trial does not have in common with the others, because a key may change which
/// random numbers a filament takes.
const FRESH: f64 = 0.1;

/// Webs of two keys that make up for each other in part: more noise and more filaments both make the web
/// even. Logarithms are normal, and scatter as those of so many patches as the web has.
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
    let kind = Kind::Quantity(Dimension::Ratio, Sign::Any);
    Parameter { key: VariedKey::new(key, kind), start, range }
}

fn whole(of: Parameter) -> Parameter {
    Parameter { key: VariedKey::new(&of.key.name, Kind::Whole(0, u64::MAX)), ..of }
}

/// How many intervals of so many loops lie below the truth, hold it, lie above it; by key.
fn coverage(parameters: &[Parameter], truth: &[f64], loops: u64, webs: u64) -> Vec<[usize; 3]> {
    let mut counts = vec![[0; 3]; parameters.len()];
    for seed in 1..=loops {
        let scan = Drawn { values: truth.to_vec(), seed: seed + loops }.web(0).unwrap();
        let target = Target::from_patches(&SIDES.map(|side| 1e-3 * side), scan);
        let mut simulator = Drawn { values: truth.to_vec(), seed };
        let mut journal = Journal::in_memory();
        let found =
            find(&mut Webs::new(parameters, &target, &mut simulator, webs, &mut journal, &|_| {})).unwrap();
        for ((key, truth), counts) in found.keys.iter().zip(truth).zip(&mut counts) {
            let [low, high] = key.interval.clone().unwrap();
            counts[usize::from(*truth <= high) + usize::from(*truth < low)] += 1;
        }
    }
    counts
}

#[test]
fn stat_intervals_of_normal_numbers_hold_the_truth_as_often_as_they_say() {
    let parameters = [parameter("noise", 12.0, [2.4, 60.0]), parameter("filaments", 250.0, [50.0, 1250.0])];
    let counts = coverage(&parameters, &[16.0, 350.0], 1000, 20);
    println!("{counts:?}");
    for [below, within, above] in counts {
        // Of 95 %, 0.7 % are a standard error; of 2.5 % to each side, 0.5 %.
        assert!((930..=975).contains(&within), "{within} of 1000");
        assert!(below.max(above) <= 40 && below.min(above) >= 8, "{below} below, {above} above");
    }
}

/// What a fit of drawn numbers finds.
fn fitted(parameters: &[Parameter], truth: &[f64], simulator: &mut dyn Simulator) -> Result<Fit, Error> {
    let scan = Drawn { values: truth.to_vec(), seed: 77 }.web(0).unwrap();
    let target = Target::from_patches(&SIDES.map(|side| 1e-3 * side), scan);
    let mut journal = Journal::in_memory();
    find(&mut Webs::new(parameters, &target, simulator, 20, &mut journal, &|_| {}))
}

fn drawn() -> Drawn {
    Drawn { values: Vec::new(), seed: 5 }
}

/// Few whole numbers lie within a standard error, and a step of a slope must reach the next one.
#[test]
fn a_whole_number_is_found_among_few() {
    let filaments = |start: f64| whole(parameter("filaments", start, [2.0, 40.0]));
    let parameters = [parameter("noise", 16.0, [15.0, 17.0]), filaments(3.0)];
    let fit = fitted(&parameters, &[16.0, 12.0], &mut drawn()).unwrap();
    let key = &fit.keys[1];
    let [low, high] = key.interval.clone().unwrap();
    assert!(low <= 12.0 && 12.0 <= high && high - low < 12.0, "{key:?}");
    assert!(
        key.warning.is_none() && [key.value, low, high].iter().all(|value| value.fract() == 0.0),
        "{key:?}"
    );
    assert!(fit.trials.iter().all(|trial| trial.values[1].fract() == 0.0), "{fit:?}");
}

/// An interval that only ends with the range says nothing against a value within it.
#[test]
fn a_value_within_its_range_is_not_at_its_end() {
    let parameters = [parameter("filaments", 250.0, [50.0, 360.0])];
    let fit = fitted(&parameters, &[16.0, 300.0], &mut OneKey(drawn())).unwrap();
    let key = &fit.keys[0];
    assert!(key.value < 350.0, "{key:?}");
    assert_eq!((key.ends[1], key.warning), (IntervalEnd::OfRange, None), "{key:?}");
    let parameters = [parameter("filaments", 150.0, [50.0, 200.0])];
    let fit = fitted(&parameters, &[16.0, 300.0], &mut OneKey(drawn())).unwrap();
    assert_eq!(fit.keys[0].warning, Some(KeyWarning::AtEnd), "{fit:?}");
}

#[test]
fn three_keys_are_found_together() {
    let parameters = [
        parameter("noise", 14.0, [2.4, 60.0]),
        parameter("filaments", 250.0, [50.0, 1250.0]),
        parameter("share", 0.9, [0.5, 2.0]),
    ];
    let fit = fitted(&parameters, &[16.0, 350.0], &mut ThreeKeys(drawn(), 1.0)).unwrap();
    for (key, truth) in fit.keys.iter().zip([16.0, 350.0, 1.0]) {
        let [low, high] = key.interval.clone().unwrap();
        assert!(low < truth && truth < high, "{key:?}");
    }
    assert_eq!(fit.keys[2].warning, None, "{fit:?}");
}

/// Both keys, and a share of the CV over the largest patches.
struct ThreeKeys(Drawn, f64);

impl Simulator for ThreeKeys {
    fn set(&mut self, values: &[f64]) -> Result<(), Error> {
        self.1 = values[2];
        self.0.set(&values[..2])
    }
    fn web(&mut self, replicate: u64) -> Result<Vec<f64>, Error> {
        let mut numbers = self.0.web(replicate)?;
        if let Some(last) = numbers.last_mut() {
            *last += self.1.ln();
        }
        Ok(numbers)
    }
    fn errors_of_model(&mut self) -> Result<Matrix, Error> {
        self.0.errors_of_model()
    }
}

/// A range that is narrower than a step of the search is searched from end to end.
#[test]
fn a_narrow_range_is_searched_and_its_ends_are_reported() {
    let parameters = [parameter("filaments", 350.0, [348.0, 352.0])];
    let mut simulator = OneKey(drawn());
    let fit = fitted(&parameters, &[16.0, 350.0], &mut simulator).unwrap();
    assert_eq!(fit.keys[0].ends, [IntervalEnd::OfRange; 2], "{fit:?}");
    assert_eq!(fit.keys[0].warning, Some(KeyWarning::Unknown));
    let parameters = [whole(parameter("filaments", 3.0, [2.8, 3.2]))];
    let error = fitted(&parameters, &[16.0, 3.0], &mut OneKey(drawn())).unwrap_err().to_string();
    assert!(error.contains("filaments has no second value in its range"), "{error}");
}

/// The number of filaments alone.
struct OneKey(Drawn);

impl Simulator for OneKey {
    fn set(&mut self, values: &[f64]) -> Result<(), Error> {
        self.0.set(&[16.0, values[0]])
    }
    fn web(&mut self, replicate: u64) -> Result<Vec<f64>, Error> {
        self.0.web(replicate)
    }
    fn errors_of_model(&mut self) -> Result<Matrix, Error> {
        self.0.errors_of_model()
    }
}

/// Beyond so many filaments, a web of a trial cannot be laid: that of this replicate.
struct Fragile(OneKey, f64, u64);

impl Simulator for Fragile {
    fn set(&mut self, values: &[f64]) -> Result<(), Error> {
        self.0.set(values)
    }
    fn web(&mut self, replicate: u64) -> Result<Vec<f64>, Error> {
        if replicate == self.2 && self.0.0.values[1] > self.1 {
            return Err(Error::flight("cannot be laid", "try less"));
        }
        self.0.web(replicate)
    }
    fn errors_of_model(&mut self) -> Result<Matrix, Error> {
        self.0.errors_of_model()
    }
}

/// Webs of a trial that was given up halfway do not stand for those of another one: what is found in the
/// journal is what is found without it.
#[test]
fn identical_after_trials_that_were_refused() {
    let parameters = [parameter("filaments", 250.0, [50.0, 1250.0])];
    let scan = Drawn { values: vec![16.0, 350.0], seed: 77 }.web(0).unwrap();
    let target = Target::from_patches(&SIDES.map(|side| 1e-3 * side), scan);
    let mut journal = Journal::in_memory();
    let mut fit = || {
        let mut simulator = Fragile(OneKey(drawn()), 380.0, 4);
        find(&mut Webs::new(&parameters, &target, &mut simulator, 20, &mut journal, &|_| {})).unwrap()
    };
    let first = fit();
    assert!(!first.refused.is_empty(), "{first:?}");
    assert_eq!(format!("{:?}", first.keys), format!("{:?}", fit().keys));
    // The same if such trials are refused before any of their webs is laid.
    let mut simulator = Fragile(OneKey(drawn()), 380.0, 0);
    let mut journal = Journal::in_memory();
    let at_once =
        find(&mut Webs::new(&parameters, &target, &mut simulator, 20, &mut journal, &|_| {})).unwrap();
    assert_eq!(format!("{:?}", first.keys), format!("{:?}", at_once.keys));
    // The end of the interval to which no webs can be laid is reported as such, or lies before.
    let [_, high] = first.keys[0].interval.clone().unwrap();
    assert!(high <= 380.0 || first.keys[0].ends[1] == IntervalEnd::Straight, "{:?}", first.keys[0]);
}

/// Beyond so many filaments there is no web.
struct Bounded(OneKey, f64);

impl Simulator for Bounded {
    fn set(&mut self, values: &[f64]) -> Result<(), Error> {
        if values[0] > self.1 {
            return Err(Error::flight("is no web", "try less"));
        }
        self.0.set(values)
    }
    fn web(&mut self, replicate: u64) -> Result<Vec<f64>, Error> {
        self.0.web(replicate)
    }
    fn errors_of_model(&mut self) -> Result<Matrix, Error> {
        self.0.errors_of_model()
    }
}

/// The results have the web of the values that were found, so there must be one.
#[test]
fn a_web_can_be_made_of_what_is_found() {
    let parameters = [parameter("filaments", 250.0, [50.0, 1250.0])];
    let scan = Drawn { values: vec![16.0, 350.0], seed: 77 }.web(0).unwrap();
    let target = Target::from_patches(&SIDES.map(|side| 1e-3 * side), scan);
    let mut simulator = Bounded(OneKey(drawn()), 252.0);
    let mut journal = Journal::in_memory();
    let found =
        find(&mut Webs::new(&parameters, &target, &mut simulator, 20, &mut journal, &|_| {})).unwrap();
    assert!(!found.refused.is_empty() && found.keys[0].value <= 252.0, "{found:?}");
}
