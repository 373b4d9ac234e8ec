//! How often the 95 % intervals of short records hold the known value.

use crate::normal::normal;
use spunlaid_air::record::analyse;
use spunlaid_air::{Analysis, Record, Samples, Settings};

/// Records of each kind and length: the share of them that holds a value scatters by 0.6 to 0.9 %.
const SEEDS: u64 = 800;
/// Integral time [s].
const TAU: f64 = 5e-3;
/// Samples in an integral time.
const PER_TIME: f64 = 8.0;
/// Lengths of the records in integral times.
const LENGTHS: [f64; 4] = [100.0, 150.0, 250.0, 400.0];

/// Variance 1 and correlation `e^{−t/T_I}`: a first-order autoregression.
fn exponential(seed: u64, samples: usize) -> Vec<f64> {
    let mut next = normal(seed);
    let keep = (-1.0 / PER_TIME).exp();
    let kick = (1.0 - keep * keep).sqrt();
    let mut u = next();
    let mut step = || {
        u = keep * u + kick * next();
        u
    };
    (0..samples).map(|_| step()).collect()
}

/// Weights of white noise whose moving sum has von Kármán's spectrum `∝ |1 − a e^{−iω}|^{−5/3}`, the variance 1
/// and the integral time: their sum squared is `2 T_I/Δ`.
fn von_karman_weights() -> Vec<f64> {
    let sample = |a: f64| -> Vec<f64> {
        let mut weight = 1.0;
        let mut next = |k: usize| {
            if k > 0 {
                weight *= a * (k as f64 - 1.0 / 6.0) / k as f64;
            }
            weight
        };
        let weights: Vec<f64> = (0..(16.0 / (1.0 - a)) as usize).map(&mut next).collect();
        let rms = weights.iter().map(|w| w * w).sum::<f64>().sqrt();
        weights.iter().map(|w| w / rms).collect()
    };
    let (mut low, mut high) = (0.5, 0.99);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        let sum: f64 = sample(middle).iter().sum();
        if sum * sum < 2.0 * PER_TIME { low = middle } else { high = middle }
    }
    sample(low)
}

fn von_karman(weights: &[f64], seed: u64, samples: usize) -> Vec<f64> {
    let mut next = normal(seed);
    let noise: Vec<f64> = (0..samples + weights.len()).map(|_| next()).collect();
    let sum = |noise: &[f64]| noise.iter().rev().zip(weights).map(|(e, w)| e * w).sum();
    noise.windows(weights.len()).take(samples).map(sum).collect()
}

/// The analysis of a fluctuation on a mean of 10 m/s.
fn analysed(components: Vec<Vec<f64>>) -> Analysis {
    let components = (["u", "v", "w"].iter().zip(components).enumerate())
        .map(|(i, (name, values))| {
            let mean = if i == 0 { 10.0 } else { 0.0 };
            Samples { name: (*name).to_owned(), values: values.iter().map(|u| mean + u).collect() }
        })
        .collect();
    let record =
        Record { file: "made".to_owned(), interval: TAU / PER_TIME, components, ..Record::default() };
    analyse(&record, &Settings::default()).unwrap()
}

/// Share of the records whose interval holds the value [%], and the median of the estimates over the value.
fn coverage(
    records: &[Analysis],
    result: impl Fn(&Analysis) -> spunlaid_ground::Interval,
    known: f64,
) -> (f64, f64) {
    let held = records.iter().filter(|record| result(record).holds(known)).count();
    let mut values: Vec<f64> = records.iter().map(|record| result(record).value / known).collect();
    values.sort_by(f64::total_cmp);
    (100.0 * held as f64 / records.len() as f64, values[values.len() / 2])
}

/// Records of a kind: components by seed and number of samples.
type Signals<'a> = &'a dyn Fn(u64, usize) -> Vec<Vec<f64>>;

#[test]
#[ignore = "slow: eight hundred records of each kind and length"]
fn stat_short_records_hold_the_known_values() {
    let weights = von_karman_weights();
    let kinds: [(&str, Signals<'_>); 3] = [
        ("exponential", &|seed, samples| vec![exponential(seed, samples)]),
        ("von Kármán", &|seed, samples| vec![von_karman(&weights, seed, samples)]),
        ("three components", &|seed, samples| (0..3).map(|c| exponential(3 * seed + c, samples)).collect()),
    ];
    let mut wrong = Vec::new();
    for (kind, made) in kinds {
        for times in LENGTHS {
            let samples = (times * PER_TIME) as usize;
            let records: Vec<Analysis> =
                (0..SEEDS).map(|seed| analysed(made(1000 + seed, samples))).collect();
            for (name, (held, median)) in [
                ("turbulence intensity", coverage(&records, |analysis| analysis.turbulence_intensity, 0.1)),
                ("integral time", coverage(&records, |analysis| analysis.integral_time, TAU)),
                ("cut-off", coverage(&records, |analysis| analysis.cutoff_frequency, 0.25 / TAU)),
                ("plateau", coverage(&records, |analysis| analysis.components[0].flat.density, 4.0 * TAU)),
            ] {
                println!("{kind}, {times} integral times, {name}: {held:.1} % hold it, median {median:.3}");
                if !(90.0..=98.0).contains(&held) {
                    wrong.push(format!("{kind}, {times} integral times, {name}: {held:.1} %"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
#[ignore = "slow: eight hundred records of each length"]
fn stat_moments_of_a_skewed_record() {
    // exp(σ g) of a normal g: skewness (w + 2) √(w − 1) = 1.3 with w = e^{σ²}, flatness w⁴ + 2 w³ + 3 w² − 3.
    let w: f64 = 1.16835;
    let sigma = w.ln().sqrt();
    let skewness = (w + 2.0) * (w - 1.0).sqrt();
    let flatness = w.powi(4) + 2.0 * w.powi(3) + 3.0 * w * w - 3.0;
    for times in [100.0, 250.0, 400.0, 1000.0] {
        let samples = (times * PER_TIME) as usize;
        let made = |seed| exponential(seed, samples).iter().map(|g| (sigma * g).exp()).collect();
        let records: Vec<Analysis> = (0..SEEDS).map(|seed| analysed(vec![made(seed)])).collect();
        for (name, (held, median)) in [
            ("skewness", coverage(&records, |analysis| analysis.components[0].skewness, skewness)),
            ("flatness", coverage(&records, |analysis| analysis.components[0].flatness, flatness)),
        ] {
            println!("lognormal, {times} integral times, {name}: {held:.1} % hold it, median {median:.3}");
            assert!((90.0..=98.0).contains(&held), "{times} integral times, {name}: {held:.1} %");
        }
    }
}
