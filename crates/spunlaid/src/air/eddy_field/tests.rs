//! The field against the closed formulas of its spectra, correlations and coherence, and against itself.

use super::{EddyField, Extent};
use crate::air::{Air, EddyModel, SpectrumShape, StreamKey};
use crate::lanes::{Isa, Plain, Register, Task, WIDTH};
use crate::vec3::Vec3;
use std::f64::consts::TAU;

const SPEED: f64 = 25.0;
const LENGTH: f64 = 16e-3;
const CUTOFF: f64 = SPEED / 4.0 / LENGTH;
const EXTENT: Extent = Extent { y: 10.0 * LENGTH, z: 12.0 * LENGTH };
const LATERAL: f64 = 15.4;
const KEY: StreamKey = StreamKey { seed: 1, replicate: 0 };

fn air(decay_time: f64, spectrum: SpectrumShape, cutoff_frequency: f64) -> Air {
    let eddies = EddyModel::Convected { decay_time };
    Air { eddies, spectrum, ..Air::uniform(SPEED, 0.1, LENGTH, cutoff_frequency) }
}

fn frozen(spectrum: SpectrumShape, cutoff_frequency: f64) -> EddyField {
    EddyField::new(&air(f64::INFINITY, spectrum, cutoff_frequency), 0.5, EXTENT, LATERAL, KEY)
}

fn at(field: &EddyField, time: f64, place: [f64; 3]) -> [f64; 3] {
    look::<Plain>(field, time, place)
}

#[inline(always)]
fn look<S: Register>(field: &EddyField, time: f64, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let Vec3 { x, y, z } =
        EddyField::fluctuations::<S>([field; WIDTH], time, &Vec3::splat(Vec3::new(x, y, z)));
    [x.0[5], y.0[5], z.0[5]]
}

/// Places and times that fill a block evenly: number `i` of them.
fn spread(i: usize, from: f64, block: f64, distance: f64) -> (f64, [f64; 3]) {
    let turn = |ratio: f64| (i as f64 * ratio).fract();
    let place = [distance * turn(0.754_877_67), EXTENT.y * turn(0.569_840_29), EXTENT.z * turn(0.414_213_56)];
    (from + block * turn(0.618_033_99), place)
}

/// Correlations of each component between places that lie apart by `apart` [m] and `later` [s].
fn correlations(
    field: &mut EddyField,
    distance: f64,
    blocks: usize,
    apart: &[(f64, [f64; 3])],
) -> Vec<[f64; 3]> {
    const PLACES: usize = 20_000;
    let block = field.plan.repeat_time;
    let mut sums = vec![[[0.0; 2]; 3]; apart.len()];
    for number in 0..blocks {
        let from = number as f64 * block;
        let last = apart.iter().map(|(later, _)| *later).fold(0.0, f64::max);
        field.make(from..from + block + last, 2);
        for i in 0..PLACES {
            let (time, place) = spread(i, from, block, distance);
            let here = at(field, time, place);
            for (sums, (later, apart)) in sums.iter_mut().zip(apart) {
                let there = at(field, time + later, [0, 1, 2].map(|k| place[k] + apart[k]));
                for k in 0..3 {
                    sums[k][0] += here[k] * there[k];
                    sums[k][1] += 0.5 * (here[k] * here[k] + there[k] * there[k]);
                }
            }
        }
    }
    sums.iter().map(|of| of.map(|[both, own]| both / own)).collect()
}

/// `K_ν(x) = ∫₀^∞ e^(−x cosh t) cosh νt dt`, by the trapezoidal rule, which is exact to rounding here.
fn bessel_k(order: f64, x: f64) -> f64 {
    let step = 0.01;
    let value = |t: f64| (-x * t.cosh()).exp() * (order * t).cosh();
    step * (0.5 * value(0.0) + (1..1200).map(|i| value(step * f64::from(i))).sum::<f64>())
}

/// `2^(1−a)/Γ(a) · s^a K_a(s)`
fn matern(order: f64, s: f64) -> f64 {
    if s == 0.0 {
        1.0
    } else {
        2_f64.powf(1.0 - order) / libm::tgamma(order) * s.powf(order) * bessel_k(order, s)
    }
}

/// Coherence at a frequency [Hz] and a lateral distance [m]: of x, of the component along the distance, and of the other.
fn coherence(frequency: f64, r: f64) -> [f64; 3] {
    let (k1, ke) = (TAU * frequency / SPEED, 0.746_834 / LENGTH);
    let square = k1 * k1 + ke * ke;
    let s = square.sqrt() * r;
    let (five, eleven) = (matern(5.0 / 6.0, s), matern(11.0 / 6.0, s));
    let m = 2_f64.powf(1.0 / 6.0) / libm::tgamma(5.0 / 6.0) * s.powf(11.0 / 6.0) * bessel_k(1.0 / 6.0, s);
    let whole = k1 * k1 + 0.6 * square;
    [
        11.0 / 6.0 * five - 5.0 / 6.0 * eleven,
        (k1 * k1 * eleven + 0.6 * square * five) / whole,
        (k1 * k1 * eleven + 0.6 * square * (five - m)) / whole,
    ]
}

/// With a flat spectrum each frequency counts as much. The cut-off across makes the correlations higher by what is given here.
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
    let found = correlations(&mut field, 0.5, 24, &apart);
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
                    (found[k] - expected[k]).abs() < 0.03,
                    "{r} L, component {k}: {found:?} for {expected:?}"
                );
            }
        }
    }
}

/// Von Kármán's `f` and `g` of isotropic turbulence; the cut-offs leave the shortest waves out.
#[test]
fn analytic_with_von_karmans_spectra_the_field_is_isotropic_turbulence() {
    let mut field = frozen(SpectrumShape::VonKarman, 3.0 * SPEED / LENGTH);
    let distances = [0.5, 1.0, 2.0];
    let apart: Vec<_> = distances.iter().map(|r| (0.0, [0.0, 0.0, r * LENGTH])).collect();
    let found = correlations(&mut field, 0.5, 24, &apart);
    // Of x or y, and of z, up to a frequency in U/L.
    let expected = |r: f64, highest: f64| {
        let (mut sums, count) = ([[0.0; 2]; 2], 400);
        for i in 0..count {
            // Ever longer steps.
            let [start, end] = [i, i + 1].map(|i| highest * (f64::from(i) / f64::from(count)).powi(3));
            let square = (0.5 * (start + end)).powi(2);
            let parts = coherence(0.5 * (start + end) * SPEED / LENGTH, r * LENGTH);
            let along = (end - start) * (1.0 + 70.8 * square).powf(-5.0 / 6.0);
            let across =
                (end - start) * 0.5 * (1.0 + 188.8 * square) * (1.0 + 70.8 * square).powf(-11.0 / 6.0);
            for (sum, (power, part)) in sums.iter_mut().zip([(along, parts[0]), (across, parts[1])]) {
                *sum = [sum[0] + power * part, sum[1] + power];
            }
        }
        sums.map(|[both, own]| both / own)
    };
    for (r, found) in distances.into_iter().zip(found) {
        let q = 0.746_834 * r;
        let factor = 2_f64.powf(2.0 / 3.0) / libm::tgamma(1.0 / 3.0) * q.powf(1.0 / 3.0);
        let f = factor * bessel_k(1.0 / 3.0, q);
        let g = factor * (bessel_k(1.0 / 3.0, q) - 0.5 * q * bessel_k(2.0 / 3.0, q));
        let whole = expected(r, 1000.0);
        assert!(
            (whole[0] - g).abs() < 0.005 && (whole[1] - f).abs() < 0.005,
            "{r} L: {whole:?} for {g}, {f}"
        );
        let [along, across] = expected(r, 3.0);
        for k in [0, 2] {
            let expected = if k == 0 { along } else { across };
            assert!((found[k] - expected).abs() < 0.04, "{r} L: {found:?} for {along}, {across}");
        }
    }
}

/// Air keeps its volume: `∂u/∂x + ∂v/∂y + ∂w/∂z = 0`. A pattern that is carried has `∂/∂x = −(1/U) ∂/∂t`. With the sign of one
/// wave number wrong, the sum would be larger than its parts.
#[test]
fn invariant_isotropic_turbulence_is_free_of_divergence() {
    let mut field = frozen(SpectrumShape::VonKarman, SPEED / LENGTH);
    let (h, block) = (0.05 * LENGTH, field.plan.repeat_time);
    field.make(0.0..block, 2);
    let (mut divergence, mut gradients) = (0.0, 0.0);
    for i in 0..20_000 {
        let (time, place) = spread(i, 0.1 * block, 0.8 * block, 0.5);
        let slope = |axis: usize| {
            let [below, above] = [-h, h].map(|by| {
                at(&field, time, std::array::from_fn(|k| place[k] + if k == axis { by } else { 0.0 }))[axis]
            });
            (above - below) / (2.0 * h)
        };
        let slopes = [0, 1, 2].map(slope);
        divergence += slopes.iter().sum::<f64>().powi(2);
        gradients += slopes.iter().map(|slope| slope * slope).sum::<f64>();
    }
    assert!(divergence < 0.03 * gradients, "{}", divergence / gradients);
}

#[test]
fn analytic_the_spectrum_and_the_coherence_are_right_in_each_band() {
    const WINDOWS: usize = 60;
    let r = 0.5 * LENGTH;
    let mut field = frozen(SpectrumShape::Flat, CUTOFF);
    let spacing = 1.0 / (4.0 * CUTOFF);
    let samples = 256;
    let hann: Vec<f64> = (0..samples).map(|m| 1.0 - (TAU * m as f64 / samples as f64).cos()).collect();
    // Power, and products of what lies apart along z, at each frequency and component.
    let (mut power, mut both) = (vec![[0.0; 3]; samples / 2], vec![[0.0; 3]; samples / 2]);
    for window in 0..WINDOWS {
        let from = window as f64 * samples as f64 * spacing;
        field.make(from..from + samples as f64 * spacing, 2);
        for place in 0..4 {
            let (_, at_first) = spread(place + 4 * window, 0.0, 1.0, 0.5);
            let signal = |z: f64| -> Vec<[f64; 3]> {
                (0..samples)
                    .map(|m| {
                        at(&field, from + m as f64 * spacing, [at_first[0], at_first[1], at_first[2] + z])
                    })
                    .collect()
            };
            let signals = [signal(0.0), signal(r)];
            for n in 0..samples / 2 {
                for k in 0..3 {
                    let [a, b] = [0, 1].map(|i| {
                        let wave = |m: usize| TAU * (n * m % samples) as f64 / samples as f64;
                        let part = |m: usize| hann[m] * signals[i][m][k];
                        [
                            (0..samples).map(|m| part(m) * wave(m).cos()).sum::<f64>(),
                            (0..samples).map(|m| part(m) * wave(m).sin()).sum(),
                        ]
                    });
                    power[n][k] += 0.5 * (a[0] * a[0] + a[1] * a[1] + b[0] * b[0] + b[1] * b[1]);
                    both[n][k] += a[0] * b[0] + a[1] * b[1];
                }
            }
        }
    }
    // The cut-off lies at half of the frequencies that the samples show.
    let band = |sums: &[[f64; 3]], from: f64, to: f64, k: usize| {
        let [from, to] = [from, to].map(|share| (share * samples as f64 / 4.0).round() as usize);
        sums[from..to].iter().map(|sum| sum[k]).sum::<f64>() / (to - from) as f64
    };
    for k in 0..3 {
        let mean = band(&power, 1.0 / 64.0, 1.0, k);
        for eighth in 0..8 {
            let found = band(
                &power,
                (f64::from(eighth) / 8.0).max(1.0 / 64.0),
                f64::from(eighth + 1) / 8.0 - 1.0 / 64.0,
                k,
            );
            // 240 signals and eight frequencies: a standard error of 3 %.
            assert!((found / mean - 1.0).abs() < 0.1, "eighth {eighth}, component {k}: {}", found / mean);
        }
        for (from, to) in [(0.05, 0.25), (0.4, 0.6), (0.75, 0.95)] {
            let found = band(&both, from, to, k) / band(&power, from, to, k);
            let at_middle = coherence(0.5 * (from + to) * CUTOFF, r);
            let expected = [at_middle[0], at_middle[2], at_middle[1]][k];
            assert!((found - expected).abs() < 0.05, "{from}, component {k}: {found} for {expected}");
        }
    }
}

#[test]
fn analytic_a_pattern_that_ages_is_forgotten_exponentially() {
    let decay = 5e-3;
    let mut field = EddyField::new(&air(decay, SpectrumShape::Flat, CUTOFF), 0.5, EXTENT, 8.0, KEY);
    assert_eq!(field.tapes.len(), 25);
    // From the middle of the way, so that the later place lies on it.
    let lags = [2.0 / 6.0, 1.0, 2.0];
    let apart: Vec<_> = lags.iter().map(|age| (age * decay, [age * decay * SPEED, 0.0, 0.0])).collect();
    let found = correlations(&mut field, 0.2, 6, &apart);
    for (age, found) in lags.iter().zip(found) {
        for found in found {
            assert!((found - (-age).exp()).abs() < 0.035, "{age}: {found}");
        }
    }
}

#[test]
fn invariant_the_variance_is_one_at_every_phase_of_the_interpolation() {
    let mut field = EddyField::new(&air(5e-3, SpectrumShape::Flat, CUTOFF), 0.5, EXTENT, LATERAL, KEY);
    let block = field.plan.repeat_time;
    // Between two generations, in the middle between and at the points across, and likewise in time.
    let generation = 0.5 / 24.0;
    let [step_y, step_z] =
        [EXTENT.y / field.plan.lattice.points[0] as f64, EXTENT.z / field.plan.lattice.points[1] as f64];
    let mut sums = [[0.0; 8]; 3];
    for number in 0..4 {
        let from = f64::from(number) * block;
        field.make(from..from + block, 2);
        for i in 0..60_000 {
            let (time, [x, y, z]) = spread(i, from, block, 0.48);
            let phase = i % 8;
            let half = |bit: usize| if phase >> bit & 1 == 1 { 0.5 } else { 0.0 };
            let place = [
                ((x / generation).floor() + half(0)) * generation,
                ((y / step_y).floor() + half(1)) * step_y,
                ((z / step_z).floor() + half(2)) * step_z,
            ];
            let value = at(&field, time, place);
            (0..3).for_each(|k| sums[k][phase] += value[k] * value[k] / 30_000.0);
        }
    }
    for (k, of) in sums.iter().enumerate() {
        let mean = of.iter().sum::<f64>() / 8.0;
        assert!((mean - 1.0).abs() < 0.02, "component {k}: {mean}");
        for variance in of {
            assert!((variance / mean - 1.0).abs() < 0.03, "component {k}: {of:?}");
        }
    }
}

/// The windows of time join without a seam.
#[test]
fn invariant_the_variance_is_the_same_in_the_joints_of_the_windows() {
    let mut field = frozen(SpectrumShape::Flat, CUTOFF);
    let hop = 0.75 * field.plan.repeat_time;
    let mut sums = [0.0; 2];
    for window in 1..80 {
        let from = f64::from(window) * hop;
        field.make(from..from + hop, 2);
        for i in 0..4000 {
            for (sum, start) in sums.iter_mut().zip([0.0, 0.5]) {
                let (time, place) = spread(i, from + start * hop, hop / 3.0, 0.0);
                *sum += at(&field, time, place).iter().map(|u| u * u).sum::<f64>() / (3.0 * 4000.0 * 79.0);
            }
        }
    }
    for variance in sums {
        assert!((variance - 1.0).abs() < 0.015, "{sums:?}");
    }
}

#[test]
fn limit_without_waves_across_the_air_is_the_same_everywhere_across() {
    let mut field = EddyField::new(&air(5e-3, SpectrumShape::Flat, CUTOFF), 0.5, EXTENT, 0.0, KEY);
    let block = field.plan.repeat_time;
    field.make(0.0..20.0 * block, 1);
    let mut squares = [0.0; 3];
    for i in 0..50_000 {
        let (time, place) = spread(i, 0.0, 20.0 * block, 0.5);
        let value = at(&field, time, place);
        let beside = at(&field, time, [place[0], 0.0, 0.0]);
        assert!(value.iter().zip(beside).all(|(a, b)| (a - b).abs() < 2e-6), "{value:?} {beside:?}");
        (0..3).for_each(|k| squares[k] += value[k] * value[k] / 50_000.0);
    }
    for variance in squares {
        assert!((variance - 1.0).abs() < 0.03, "{squares:?}");
    }
}

struct Looks<'a>(&'a EddyField);

impl Task for Looks<'_> {
    type Output = Vec<[f64; 3]>;

    #[inline(always)]
    fn call<S: Register>(self) -> Self::Output {
        let block = self.0.block();
        (0..500)
            .map(|i| {
                let (time, place) = spread(i, 3.0 * block, block, 0.5);
                look::<S>(self.0, time, place)
            })
            .collect()
    }
}

#[test]
fn reproducible_a_field_has_the_same_bits_however_it_is_made_and_looked_at() {
    let made = |field: EddyField, threads: usize, steps: &[f64]| {
        let mut field = field;
        for pair in steps.windows(2) {
            let [from, to] = [pair[0], pair[1]].map(|step| step * field.block());
            field.make(from..to, threads);
        }
        field
    };
    let new = |key| EddyField::new(&air(5e-3, SpectrumShape::Flat, CUTOFF), 0.5, EXTENT, 6.0, key);
    let expected = Isa::Baseline.run(Looks(&made(new(KEY), 1, &[0.0, 4.0])));
    for isa in Isa::available() {
        for (threads, steps) in [(2, &[3.0, 4.0][..]), (3, &[0.0, 1.0, 2.5, 4.0])] {
            // The same key again after another one.
            let field = new(StreamKey { seed: 2, replicate: 1 }).with_key(KEY);
            let field = made(field, threads, steps);
            if steps[steps.len() - 2] <= 3.0 {
                assert_eq!(isa.run(Looks(&field)), expected, "{} {threads} {steps:?}", isa.name());
            }
        }
    }
    let other = Isa::Baseline.run(Looks(&made(new(StreamKey { seed: 1, replicate: 1 }), 1, &[0.0, 4.0])));
    assert!(expected.iter().zip(&other).all(|(a, b)| a != b));
}

#[test]
fn invariant_a_field_repeats_itself_after_its_extent() {
    let extent = Extent { y: 0.125, z: 0.25 };
    let mut field = EddyField::new(&air(f64::INFINITY, SpectrumShape::Flat, CUTOFF), 0.5, extent, 6.0, KEY);
    let block = field.block();
    field.make(0.0..block, 1);
    for i in 0..1000 {
        // Binary fractions, so that the sums are exact.
        let [y, z] = [i % 32, i % 57].map(|n| f64::from(n) / 512.0);
        let here = at(&field, 0.5 * block, [0.1, y, z]);
        for (laps_y, laps_z) in [(1.0, 0.0), (0.0, 1.0), (-2.0, 3.0)] {
            assert_eq!(here, at(&field, 0.5 * block, [0.1, y + laps_y * extent.y, z + laps_z * extent.z]));
        }
    }
}
