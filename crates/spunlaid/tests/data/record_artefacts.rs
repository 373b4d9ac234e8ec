//! What is no velocity in a record is named, and what is velocity is not blamed.

use crate::normal::normal;
use spunlaid_air::record::{analyse, parse_csv};
use spunlaid_air::{Analysis, Layout, Record, Samples, Settings};
use spunlaid_ground::Dimension;

/// Words of the warnings about samples that are no velocities.
const WORDS: [&str; 6] =
    ["spike", "dropouts", "clip", "frozen", "each value occurs", "equal to the one before"];

/// The mean velocity of all records here [m/s].
const MEAN: f64 = 10.0;

fn record(values: &[f64], rate: f64) -> Record {
    let components = vec![Samples { name: "u".to_owned(), values: values.to_vec() }];
    Record { file: "made".to_owned(), interval: 1.0 / rate, components, ..Record::default() }
}

fn analysed(values: &[f64], rate: f64) -> Analysis {
    analyse(&record(values, rate), &Settings::default()).unwrap()
}

/// Rms 1 and an exponential correlation over so many samples.
fn rough(seed: u64, samples: usize, correlated: f64) -> Vec<f64> {
    let mut next = normal(seed);
    let keep = if correlated > 0.0 { (-1.0 / correlated).exp() } else { 0.0 };
    let kick = (1.0 - keep * keep).sqrt();
    let mut u = next();
    let mut step = || {
        u = keep * u + kick * next();
        u
    };
    (0..samples).map(|_| step()).collect()
}

/// The same behind four low passes of so many samples, with rms 1.
fn smooth(seed: u64, samples: usize, correlated: f64, pass: f64) -> Vec<f64> {
    let mut values = rough(seed, samples, correlated);
    for _ in 0..4 {
        let mut level = values[0];
        for value in &mut values {
            level += (*value - level) / pass;
            *value = level;
        }
    }
    let rms = (values.iter().map(|u| u * u).sum::<f64>() / samples as f64).sqrt();
    values.iter().map(|u| u / rms).collect()
}

/// In steps of a resolution [m/s] about the mean velocity.
fn written(fluctuation: &[f64], rms: f64, resolution: f64) -> Vec<f64> {
    fluctuation.iter().map(|u| ((MEAN + rms * u) / resolution).round() * resolution).collect()
}

/// The warnings about samples that are no velocities.
fn artefacts(analysis: &Analysis) -> Vec<String> {
    let all = analysis.warnings.iter().map(ToString::to_string);
    all.filter(|warning| WORDS.iter().any(|word| warning.contains(word))).collect()
}

/// A named record without what was done to it: intensity and length scale that a warning reports are those of the air.
fn holds_the_air(analysis: &Analysis, whole: &Analysis, words: &str, within: f64) {
    let all: Vec<String> = analysis.warnings.iter().map(ToString::to_string).collect();
    let named = artefacts(analysis);
    assert!(named.len() == 1 && named[0].contains(words), "{words}: {all:?}");
    assert!(!all.iter().any(|warning| warning.contains("aliased")), "{words}: {all:?}");
    let reported =
        all.iter().find(|warning| warning.starts_with("without ")).unwrap_or_else(|| panic!("{all:?}"));
    let between = |from: &str, to: &str| reported.split_once(from).unwrap().1.split_once(to).unwrap().0;
    let intensity = 0.01 * between("intensity of ", " %").parse::<f64>().unwrap();
    let time = Dimension::Time.parse(between("integral time of ", " and a")).unwrap();
    for (reported, right) in
        [(intensity, whole.turbulence_intensity.value), (time, whole.integral_time.value)]
    {
        assert!((reported / right - 1.0).abs() < within, "{words}: {reported} for {right}: {all:?}");
    }
}

/// Rate [Hz], rms [m/s], samples per integral time and resolution [m/s] of records of the air.
const AIRS: [(f64, f64, f64, f64); 4] = [
    (1000.0, 1.0, 5.0, 0.001),
    (20_000.0, 0.3, 12.0, 0.0005),
    (500.0, 2.0, 3.0, 0.01),
    (4000.0, 0.1, 25.0, 0.002),
];

#[test]
fn stat_spikes_are_named_and_the_air_without_them_is_reported() {
    for (seed, (rate, rms, correlated, resolution)) in (0..).zip(AIRS) {
        let air = written(&rough(seed, 10_000, correlated), rms, resolution);
        let whole = analysed(&air, rate);
        for (every, least, most, long) in [
            (500, 8.0, 12.0, 1),
            (50, 5.0, 8.0, 1),
            (70, 5.0, 9.0, 2),
            (33, 4.5, 8.0, 1),
            (250, 7.0, 11.0, 3),
            (400, 7.0, 11.0, 7),
        ] {
            let mut values = air.clone();
            let mut next = normal(seed + 100);
            for at in (every / 2..values.len() - long).step_by(every) {
                let share = next().abs().min(1.0);
                let leap = (least + share * (most - least)) * rms * next().signum();
                (at..at + long).for_each(|i| values[i] += leap);
            }
            // What an interpolated sample lacks of its variance, and spikes that the air hides: a thirtieth spoilt.
            holds_the_air(&analysed(&values, rate), &whole, "spikes (", 0.05);
        }
    }
}

#[test]
fn frozen_stretches_are_named_with_place_and_length() {
    for (seed, (rate, rms, correlated, resolution)) in (10..).zip(AIRS) {
        let air = written(&rough(seed, 10_000, correlated), rms, resolution);
        let whole = analysed(&air, rate);
        // One long stretch, ten, and many as short as two integral times.
        for (every, length) in [(10_000, 600), (1000, 200), (400, (2.0 * correlated) as usize)] {
            let mut values = air.clone();
            for start in (every / 2..values.len()).step_by(every) {
                let frozen = values[start];
                values[start..start + length].fill(frozen);
            }
            let analysis = analysed(&values, rate);
            let named = artefacts(&analysis);
            let (row, count) = (every / 2 + 1, 10_000 / every);
            let many = if count == 1 { "one stretch".to_owned() } else { format!("{count} stretches") };
            for words in [&format!("frozen in {many} "), &format!(" samples from data row {row} (at ")] {
                assert!(named.len() == 1 && named[0].contains(words), "{words}: {named:?}");
            }
            // Each joint takes about an integral time off; where that is much of the rest, nothing is reported of it.
            if count as f64 * correlated < 0.02 * (10_000 - count * length) as f64 {
                // What is left is another record of the same air, known as well as its interval says.
                let within = (whole.integral_time.high / whole.integral_time.low).ln() / 2.0;
                holds_the_air(&analysis, &whole, "frozen", within);
            }
        }
    }
}

#[test]
fn dropouts_are_not_called_clipping_and_clipping_is() {
    for (seed, (rate, rms, correlated, resolution)) in (20..).zip(AIRS) {
        let air = written(&rough(seed, 10_000, correlated), rms, resolution);
        let whole = analysed(&air, rate);
        for (value, every, long) in
            [(0.0, 100, 1), (MEAN - 6.5 * rms, 100, 1), (MEAN + 9.0 * rms, 330, 1), (0.0, 900, 7)]
        {
            let mut values = air.clone();
            (50..9900).step_by(every).for_each(|at| values[at..at + long].fill(value));
            let analysis = analysed(&values, rate);
            holds_the_air(&analysis, &whole, "dropouts", 0.06);
            assert!(artefacts(&analysis)[0].contains("make the rms too large"));
        }
        for (low, high) in [(-9.0, 1.5), (-1.2, 9.0), (-9.0, 2.5)] {
            let limits = [low, high].map(|z| MEAN + z * rms);
            let values: Vec<f64> = air.iter().map(|u| u.clamp(limits[0], limits[1])).collect();
            let named = artefacts(&analysed(&values, rate));
            assert!(named.len() == 1 && named[0].contains("seems to clip at this value"), "{named:?}");
        }
    }
}

#[test]
fn held_values_are_reported_with_their_rate() {
    for (seed, (rate, rms, correlated, resolution)) in (30..).zip(AIRS) {
        let air = written(&rough(seed, 20_000, correlated), rms, resolution);
        let whole =
            |hold: f64| -> Vec<f64> { (0..10_000).map(|i| air[(f64::from(i) / hold) as usize]).collect() };
        for (hold, words) in
            [(10.0, "occurs 10 times in a row,"), (2.0, "occurs 2 times in a row,"), (1.5, "on average")]
        {
            let named = artefacts(&analysed(&whole(hold), rate));
            assert!(named.len() == 1 && named[0].contains(words), "{hold}: {named:?}");
        }
        // Held until the next one comes, at random.
        let mut next = normal(seed);
        let mut at = 0;
        let arriving: Vec<f64> = (0..10_000)
            .map(|_| {
                at += usize::from(next() > 0.8);
                air[at]
            })
            .collect();
        let named = artefacts(&analysed(&arriving, rate));
        assert!(named.len() == 1 && named[0].contains("are equal to the one before"), "{named:?}");
    }
}

#[test]
fn rejects_numbers_that_stand_for_missing_values() {
    let air = written(&rough(3, 5000, 5.0), 1.0, 0.001);
    let text = |sentinel: &str, unit: &str, per: f64| {
        let row = |(i, u): (usize, &f64)| {
            let value = if i % 700 == 600 { sentinel.to_owned() } else { format!("{:.3}", u * per) };
            format!("{:.3};{value}\n", i as f64 * 1e-3)
        };
        format!("time_s;u [{unit}]\n{}", air.iter().enumerate().map(row).collect::<String>())
    };
    for (sentinel, shown) in [
        ("-9999", "-9999"),
        ("9999", "9999"),
        ("-999.00", "-999"),
        ("1e30", "1e30"),
        ("9.96921E+36", "9.96921e36"),
        ("-32768", "-32768"),
        ("99999", "99999"),
    ] {
        for (unit, per) in [("m/s", 1.0), ("cm/s", 100.0)] {
            let record =
                parse_csv(text(sentinel, unit, per).as_bytes(), "a.csv", &Layout::default()).unwrap();
            let said = analyse(&record, &Settings::default()).unwrap_err().to_string();
            let wanted = format!(
                "a.csv: column u: 7 samples are {shown}, the first in data row 601 (at 600 ms): this \
                 number means a missing value and is not a velocity; leave these cells empty"
            );
            assert_eq!(said, wanted);
        }
    }
}

/// Few digits, and a clock that is a thousand times too slow, are warned of; as many digits as the rms needs are not.
#[test]
fn rounded_velocities_and_lengths_that_no_air_has_are_warned_of() {
    let fluctuation = rough(5, 1 << 16, 10.0);
    let warned = |resolution: f64, rate: f64, words: &str| {
        let all = analysed(&written(&fluctuation, 0.3, resolution), rate).warnings;
        all.iter().any(|warning| warning.to_string().contains(words))
    };
    for (resolution, is_coarse) in [(1.0, true), (0.25, true), (0.05, false), (0.001, false)] {
        assert_eq!(warned(resolution, 1000.0, "the velocities are rounded to"), is_coarse, "{resolution}");
    }
    for (rate, is_odd) in [(1.0, true), (1000.0, false), (5e8, true)] {
        assert_eq!(warned(0.001, rate, "is outside the usual range, 10 µm to 10 m"), is_odd, "{rate}");
    }
}

#[test]
fn records_of_the_air_are_not_blamed() {
    let mut made = 0;
    for (seed, samples) in (0..6).zip([600, 10_000].into_iter().cycle()) {
        for correlated in [0.0, 2.0, 12.0, 150.0] {
            let rough = rough(seed, samples, correlated);
            let smooth = smooth(seed, samples, correlated, 5.0);
            // Lognormal amplitudes that change slowly make flatnesses of 5 to 6.
            let amplitudes = self::smooth(seed + 50, samples, 4.0 * correlated + 40.0, 5.0);
            let bursts = |of: &[f64]| -> Vec<f64> {
                of.iter().zip(&amplitudes).map(|(u, a)| u * (0.42 * a).exp()).collect()
            };
            let skewed: Vec<f64> = smooth.iter().map(|u| ((0.4 * u).exp() - 1.08) / 0.45).collect();
            let kinds = [rough.clone(), smooth.clone(), bursts(&rough), bursts(&smooth), skewed];
            for (kind, fluctuation) in kinds.iter().enumerate() {
                // Fine steps, and those of a coarse converter: up to a quarter of the rms.
                for (rms, resolution) in [(1.0, 0.001), (0.02, 0.001), (1.0, 0.05), (0.4, 0.1)] {
                    let analysis = analyse(
                        &record(&written(fluctuation, rms, resolution), 1000.0),
                        &Settings::default(),
                    );
                    let named = artefacts(&analysis.unwrap());
                    assert!(
                        named.is_empty(),
                        "seed {seed}, {correlated}, kind {kind}, {rms}, {resolution}: {named:?}"
                    );
                    made += 1;
                }
            }
        }
    }
    assert_eq!(made, 480);
}
