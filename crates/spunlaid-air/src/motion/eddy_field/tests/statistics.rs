//! Spectra, coherence and correlations of the field against their formulas.

use super::formulas::{between_generations, coherence, cross_spectra, over_spectra, von_karman};
use super::{CUTOFF, EXTENT, KEY, LENGTH, SPEED, air, at, correlations, frozen, spread};
use crate::motion::SpectrumShape;
use crate::motion::eddy_field::EddyField;
use std::f64::consts::TAU;

/// With a flat spectrum each frequency counts as much. The cut-off across makes the correlations higher by
/// what is given here.
#[test]
fn analytic_the_correlation_across_is_von_karmans_frequency_by_frequency() {
    let distances = [
        (0.25, [0.022, 0.013, 0.013]),
        (0.5, [0.014, 0.011, 0.009]),
        (1.0, [0.006, 0.008, 0.005]),
        (2.0, [0.0, 0.004, 0.001]),
    ];
    let along =
        |axis: usize, r: f64| (0.0, std::array::from_fn(|k| if k == axis { r * LENGTH } else { 0.0 }));
    let apart: Vec<_> = distances.iter().flat_map(|(r, _)| [along(1, *r), along(2, *r)]).collect();
    let mut field = frozen(SpectrumShape::Flat, CUTOFF);
    let found = correlations(&mut field, 0.5, 24, 20_000, &apart);
    for ((r, error), found) in distances.iter().zip(found.chunks_exact(2)) {
        let mut mean = [0.0; 3];
        for i in 0..200 {
            let parts = coherence(CUTOFF * (f64::from(i) + 0.5) / 200.0, r * LENGTH);
            (0..3).for_each(|k| mean[k] += parts[k] / 200.0);
        }
        let [x, parallel, across] = [0, 1, 2].map(|k| mean[k] + error[k]);
        for (found, expected) in [(found[0], [x, parallel, across]), (found[1], [x, across, parallel])] {
            for k in 0..3 {
                assert!(
                    (found[k][k] - expected[k]).abs() < 0.015,
                    "{r} L, component {k}: {found:?} for {expected:?}"
                );
            }
        }
    }
}

/// Without cut-offs the model is von Kármán's isotropic turbulence: one component with another at a distance **r** is
/// `(f − g) r_i r_j/r²`, and `g` more with itself.
#[test]
fn analytic_the_coherence_of_all_frequencies_is_von_karmans_correlation() {
    for r in [0.5, 1.0, 2.0].map(|lengths| lengths * LENGTH) {
        let across = |frequency: f64| {
            let [x, parallel, across] = coherence(frequency, r);
            [[x, 0.0, 0.0], [0.0, across, 0.0], [0.0, 0.0, parallel]]
        };
        let found = over_spectra(1000.0 * SPEED / LENGTH, 400, across);
        let [g, f] = von_karman(r);
        assert!((found[0][0] - g).abs() < 0.005 && (found[2][2] - f).abs() < 0.005, "{r}: {found:?} {g} {f}");
    }
}

/// All components with all others: beside each other, one behind the other, and askew. The cut-offs leave the
/// shortest waves out; the sum over what is left is near to von Kármán's.
#[test]
fn analytic_with_von_karmans_spectra_the_field_is_isotropic_turbulence() {
    const HIGHEST: f64 = 3.0 * SPEED / LENGTH;
    let mut field = frozen(SpectrumShape::VonKarman, HIGHEST);
    let directions = [[0.0, 0.0, 1.0], [0.0, 0.6, 0.8], [0.8, 0.0, 0.6], [-0.6, 0.8, 0.0]];
    let distances = [0.5 * LENGTH, LENGTH];
    let places = distances.iter().flat_map(|r| directions.map(|unit| (*r, unit)));
    let apart: Vec<_> = places.clone().map(|(r, unit)| (0.0, unit.map(|part| r * part))).collect();
    let found = correlations(&mut field, 0.5, 100, 2000, &apart);
    for (((r, unit), (_, apart)), found) in places.zip(apart).zip(found) {
        let expected = over_spectra(HIGHEST, 60, |frequency| cross_spectra(frequency, apart));
        let [g, f] = von_karman(r);
        for i in 0..3 {
            for j in 0..3 {
                let whole = (f - g) * unit[i] * unit[j] + if i == j { g } else { 0.0 };
                let (found, expected) = (found[i][j], expected[i][j]);
                let cut = if i == j { 0.09 } else { 0.02 };
                let what = format!("components {i} and {j} at {r} in {unit:?}");
                assert!((whole - expected).abs() < cut, "{what}: {expected} for {whole}");
                assert!((found - expected).abs() < 0.02, "{what}: {found} for {expected}");
            }
        }
    }
}

#[test]
fn analytic_the_spectrum_and_the_coherence_are_right_in_each_band() {
    const WINDOWS: usize = 100;
    const PLACES: usize = 16;
    const SAMPLES: usize = 256;
    let r = 0.5 * LENGTH;
    let mut field = frozen(SpectrumShape::Flat, CUTOFF);
    let spacing = 1.0 / (4.0 * CUTOFF);
    let waves: Vec<[f64; 2]> = (0..SAMPLES)
        .map(|m| {
            let (sin, cos) = (TAU * m as f64 / SAMPLES as f64).sin_cos();
            [cos, sin]
        })
        .collect();
    let hann: Vec<f64> = waves.iter().map(|[cos, _]| 1.0 - cos).collect();
    // Power, and products of what lies apart along z, at each frequency and component.
    let mut power = vec![[0.0; 3]; SAMPLES / 2];
    let mut both = vec![[0.0; 3]; SAMPLES / 2];
    for window in 0..WINDOWS {
        let from = window as f64 * SAMPLES as f64 * spacing;
        field.make(from..from + SAMPLES as f64 * spacing, 2);
        for place in 0..PLACES {
            let (_, [x, y, z]) = spread(place + PLACES * window, 0.0, 1.0, 0.5);
            let signals = [z, z + r].map(|z| -> Vec<[f64; 3]> {
                let value = |m: usize| at(&field, from + m as f64 * spacing, [x, y, z]);
                (0..SAMPLES).map(|m| value(m).map(|u| hann[m] * u)).collect()
            });
            for n in 0..SAMPLES / 2 {
                for k in 0..3 {
                    let [a, b] = signals.each_ref().map(|signal| {
                        let parts = signal.iter().enumerate().map(|(m, value)| {
                            let [cos, sin] = waves[n * m % SAMPLES];
                            [value[k] * cos, value[k] * sin]
                        });
                        parts.fold([0.0; 2], |sum, part| [sum[0] + part[0], sum[1] + part[1]])
                    });
                    power[n][k] += 0.5 * (a[0] * a[0] + a[1] * a[1] + b[0] * b[0] + b[1] * b[1]);
                    both[n][k] += a[0] * b[0] + a[1] * b[1];
                }
            }
        }
    }
    // The cut-off lies at half of the frequencies that the samples show.
    let band = |sums: &[[f64; 3]], from: f64, to: f64, k: usize| {
        let [from, to] = [from, to].map(|share| (share * SAMPLES as f64 / 4.0).round() as usize);
        sums[from..to].iter().map(|sum| sum[k]).sum::<f64>() / (to - from) as f64
    };
    // Of a variance of one that is spread evenly.
    let flat = 2.0 * (WINDOWS * PLACES) as f64 * hann.iter().map(|factor| factor * factor).sum::<f64>();
    for k in 0..3 {
        for eighth in 0..8 {
            let from = (f64::from(eighth) / 8.0).max(1.0 / 64.0);
            let found = band(&power, from, f64::from(eighth + 1) / 8.0 - 1.0 / 64.0, k) / flat;
            // 1600 signals and seven frequencies: a standard error of about 1 %.
            assert!((found - 1.0).abs() < 0.05, "eighth {eighth}, component {k}: {found}");
        }
        for (from, to) in [(0.05, 0.25), (0.4, 0.6), (0.75, 0.95)] {
            let found = band(&both, from, to, k) / band(&power, from, to, k);
            let over_band = |value: &dyn Fn(f64) -> f64| {
                (0..20)
                    .map(|i| value((from + (to - from) * (f64::from(i) + 0.5) / 20.0) * CUTOFF) / 20.0)
                    .sum::<f64>()
            };
            let whole = over_band(&|frequency| {
                let [x, parallel, across] = coherence(frequency, r);
                [x, across, parallel][k]
            });
            let expected = over_band(&|frequency| cross_spectra(frequency, [0.0, 0.0, r])[k][k]);
            // The cut-off across makes the coherence a little higher.
            assert!(
                (0.0..0.02).contains(&(expected - whole)),
                "{from}, component {k}: {expected} for {whole}"
            );
            assert!((found - expected).abs() < 0.015, "{from}, component {k}: {found} for {expected}");
        }
    }
}

#[test]
fn analytic_a_pattern_that_ages_is_forgotten_exponentially() {
    let decay = 5e-3;
    let mut field = EddyField::new(&air(decay, SpectrumShape::Flat, CUTOFF), 0.5, EXTENT, 8.0, KEY);
    assert_eq!(field.tapes.len(), 25);
    let (walk, ageing) = (field.plan.turn.cos(), 1.0 / 6.0);
    assert!(field.plan.correlations[..24].as_flattened().iter().all(|part| (part - walk).abs() < 1e-6));
    // The steps of the walk make the integral over the age right.
    let shares = || (0..60).map(|i| (f64::from(i) + 0.5) / 60.0);
    let whole =
        |from: f64, to: f64| (-120..=120).map(|m| between_generations(walk, [from, to], m)).sum::<f64>();
    let integral =
        shares().flat_map(|from| shares().map(move |to| whole(from, to) * ageing / 3600.0)).sum::<f64>();
    assert!((0.5 * integral - 1.0).abs() < 0.005, "{integral}");
    // From the middle of the way, so that the later place lies on it.
    let generations = [2, 6, 12];
    let lags = generations.map(|count| f64::from(count) * ageing);
    let apart: Vec<_> = lags.iter().map(|age| (age * decay, [age * decay * SPEED, 0.0, 0.0])).collect();
    let found = correlations(&mut field, 0.2, 12, 10_000, &apart);
    for ((count, age), found) in generations.iter().zip(lags).zip(found) {
        let expected =
            shares().map(|share| between_generations(walk, [share; 2], *count) / 60.0).sum::<f64>();
        assert!((expected - (-age).exp()).abs() < 0.035, "{age}: {expected}");
        for k in 0..3 {
            assert!((found[k][k] - expected).abs() < 0.015, "{age}: {found:?} for {expected}");
        }
    }
}
