//! The synthesised turbulence: what it is made of, against the sum of cosines it stands for, and against
//! the statistics asked of it.

mod common;

use common::*;
use spunlaid::air::{Air, StreamKey, Turbulence, Wind};
use spunlaid::lanes::{Isa, WIDTH};
use spunlaid::statistics::{Welch, Window};
use std::f64::consts::PI;

const EDDIES: usize = 6;

fn streams(air: &Air, seed: u64) -> Vec<(Air, StreamKey)> {
    (0..WIDTH as u64).map(|replicate| (air.clone(), StreamKey { seed, replicate })).collect()
}

/// Fluctuations `[lane][eddy][component][sample]`, sampled every `interval` over `duration`.
fn records(air: &Air, seed: u64, interval: f64, duration: f64) -> Vec<Vec<f64>> {
    let turbulence = Turbulence::synthesise(Isa::detect(), &streams(air, seed), EDDIES, duration);
    let mut wind = Wind::new(&turbulence);
    let mut records = vec![Vec::new(); WIDTH * EDDIES * 3];
    for k in 0..(duration / interval) as usize {
        let velocities = wind.at(k as f64 * interval);
        for (lane_record, record) in records.iter_mut().enumerate() {
            let (lane, eddy, component) =
                (lane_record / (EDDIES * 3), lane_record / 3 % EDDIES, lane_record % 3);
            let v = velocities[eddy].lane(lane);
            record.push([v.x - air.velocity, v.y, v.z][component]);
        }
    }
    records
}

/// `u(t) = √2 Σ A cos(ω_n t + φ_n)` with unknown phases: the least-squares amplitudes of a record say
/// whether it is one. Fits the `N_h` cosines and sines and returns the amplitudes and the largest residual.
fn fitted_harmonics(air: &Air, record: &[f64], interval: f64) -> (Vec<f64>, f64) {
    let n = air.harmonics;
    let step = 2.0 * PI * air.cutoff_frequency / n as f64;
    // Over one repeat time doubled (anti-periodic half), harmonics are orthogonal: plain projections.
    let samples = record.len();
    let mut rest = record.to_vec();
    let mut amplitudes = Vec::new();
    for k in 0..n {
        let w = (k as f64 + 0.5) * step;
        let (mut c, mut s) = (0.0, 0.0);
        for (i, u) in record.iter().enumerate() {
            let t = i as f64 * interval;
            c += u * (w * t).cos() * 2.0 / samples as f64;
            s += u * (w * t).sin() * 2.0 / samples as f64;
        }
        for (i, r) in rest.iter_mut().enumerate() {
            let t = i as f64 * interval;
            *r -= c * (w * t).cos() + s * (w * t).sin();
        }
        amplitudes.push(c.hypot(s));
    }
    (amplitudes, rest.iter().fold(0.0, |m, r| m.max(r.abs())))
}

#[test]
fn analytic_signal_is_the_sum_of_cosines_to_1e_7() {
    // 16 harmonics over twice their repeat time (the signal's full period), samples off the grid.
    let air = Air { harmonics: 16, ..table1_air() };
    let period = 2.0 * air.repeat_time();
    let samples = 3 * 17 * 16;
    let interval = period / samples as f64;
    let turbulence = Turbulence::synthesise(Isa::detect(), &streams(&air, 7), EDDIES, period);
    let mut wind = Wind::new(&turbulence);
    let record: Vec<f64> = (0..samples).map(|i| wind.at(i as f64 * interval)[2].lane(5).y).collect();
    let (amplitudes, residual) = fitted_harmonics(&air, &record, interval);
    // Interpolation from samples and by cubics, 1e-7 of the rms each, in the worst of the phases twice that.
    let bound = 4e-7 * air.rms();
    assert!(residual < bound, "left over {residual:e} m/s");
    let expected = (2.0 / air.harmonics as f64).sqrt() * air.rms();
    for (n, a) in amplitudes.iter().enumerate() {
        assert!((a - expected).abs() < bound, "harmonic {n}: {a}, expected {expected} m/s");
    }
}

#[test]
fn stat_mean_variance_and_independence() {
    let air = table1_air();
    // Over the full period a component's mean is 0 and its variance u² exactly, whatever the phases.
    let period = 2.0 * air.repeat_time();
    let all = records(&air, 3, period / 4096.0, period);
    let u2 = air.rms() * air.rms();
    for (i, record) in all.iter().enumerate() {
        let n = record.len() as f64;
        let mean = record.iter().sum::<f64>() / n;
        let variance = record.iter().map(|u| u * u).sum::<f64>() / n;
        assert!(mean.abs() < 1e-6 * air.rms(), "record {i}: mean {mean:e}");
        assert!((variance / u2 - 1.0).abs() < 1e-6, "record {i}: variance {variance}");
    }
    // Correlations of pairs: each is Σ over N_h harmonics of cos(φ−φ')/N_h, of deviation 1/√(2N_h).
    let deviation = 1.0 / (2.0 * air.harmonics as f64).sqrt();
    let correlation =
        |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / (a.len() as f64 * u2);
    let (mut sum, mut pairs) = (0.0, 0);
    for i in 0..all.len() {
        for j in 0..i {
            let c = correlation(&all[i], &all[j]) / deviation;
            // 10,296 pairs: five deviations and a half are exceeded once in 2,500 seeds.
            assert!(c.abs() < 5.5, "records {i} and {j} correlate: {c} deviations");
            sum += c * c;
            pairs += 1;
        }
    }
    // The mean square of the standardised correlations is 1 ± √(2/pairs), four deviations.
    let bound = 4.0 * (2.0 / f64::from(pairs)).sqrt();
    assert!((sum / f64::from(pairs) - 1.0).abs() < bound, "{}", sum / f64::from(pairs));
}

#[test]
fn stat_phases_are_uniform_between_replicates() {
    // u at one instant is a sum of 256 independent cosines: normal to within 1e-3, variance u².
    let air = table1_air();
    let mut values = Vec::new();
    for seed in 0..12 {
        let turbulence = Turbulence::synthesise(Isa::detect(), &streams(&air, seed), EDDIES, 0.5);
        let mut wind = Wind::new(&turbulence);
        let at = wind.at(0.3);
        for (eddy, lane) in (0..EDDIES).flat_map(|e| (0..WIDTH).map(move |l| (e, l))) {
            let v = at[eddy].lane(lane);
            values.extend([v.x - air.velocity, v.y, v.z].map(|u| u / air.rms()));
        }
    }
    let n = values.len() as f64;
    let moment = |k: i32| values.iter().map(|u| u.powi(k)).sum::<f64>() / n;
    // Standard errors of the moments of a normal variable: 1, √2, √15, √96 over √n.
    for (k, expected, error) in
        [(1, 0.0, 1.0), (2, 1.0, 2f64.sqrt()), (3, 0.0, 15f64.sqrt()), (4, 3.0, 96f64.sqrt())]
    {
        let off = (moment(k) - expected).abs() / (error / n.sqrt());
        assert!(off < 4.0, "moment {k}: {} is {off} standard errors off", moment(k));
    }
}

#[test]
fn stat_spectrum_is_flat_to_the_cutoff_and_nothing_above() {
    let air = Air { harmonics: 1024, ..table1_air() };
    let interval = 1.0 / 800.0;
    let mut spectrum = Welch::new(interval, 512, Window::Hann, 0.5);
    let mut segments = 0;
    for record in records(&air, 11, interval, 10.0) {
        spectrum.add(&record, None);
        segments += record.len() / 256 - 1;
    }
    let wanted = air.rms().powi(2) / air.cutoff_frequency;
    for (f, density) in spectrum.finish().points() {
        // The Hann window reaches two of its steps of 1.56 Hz to either side.
        if f > 4.0 && f < 96.0 {
            // Each segment's density scatters by as much as its mean; overlapping ones count for about half.
            let error = 4.0 / (0.5 * segments as f64).sqrt();
            assert!((density / wanted - 1.0).abs() < error, "{f} Hz: {} of {wanted}", density);
        } else if f > 110.0 {
            // What the Hann window lets through from k steps off: ∫ (2/3) sin²/(π²δ²(δ²−1)²) dδ from k on,
            // and the interpolation's images, 1e-7 of the rms.
            let k = (f - air.cutoff_frequency) * 512.0 * interval;
            let leak = 2.0 / (15.0 * PI * PI * (k - 1.0).powi(5)) + 1e-12;
            assert!(density < leak * wanted, "{f} Hz: {density:e} above the cut-off, {k} steps off");
        }
    }
}

#[test]
fn stat_autocorrelation_is_the_cardinal_sine() {
    let air = table1_air();
    let period = 2.0 * air.repeat_time();
    let samples = 8192;
    let interval = period / samples as f64;
    let u2 = air.rms().powi(2);
    let step = 2.0 * PI * air.cutoff_frequency / air.harmonics as f64;
    for record in records(&air, 5, interval, period).iter().take(5) {
        for lag in [1, 7, 16, 33, 64, 150] {
            let c =
                (0..samples).map(|i| record[i] * record[(i + lag) % samples]).sum::<f64>() / samples as f64;
            let tau = lag as f64 * interval;
            let cutoff = 2.0 * PI * air.cutoff_frequency;
            let sinc = (cutoff * tau).sin() / (cutoff * tau);
            // The sum over harmonics is the integral's midpoint rule: off by at most (Δω τ)²/24.
            let bound = (step * tau).powi(2) / 24.0 + 1e-5;
            assert!((c / u2 - sinc).abs() < bound, "lag {tau} s: {}, expected {sinc}", c / u2);
        }
    }
}

#[test]
fn identical_turbulence_alone_or_in_company_and_on_any_instruction_set() {
    let air = table1_air();
    let alone = [(air.clone(), StreamKey { seed: 9, replicate: 5 })];
    let company = streams(&air, 9);
    let mut reference: Option<Vec<u64>> = None;
    for isa in Isa::available() {
        for (lanes, lane) in [(&alone[..], 0), (&company[..], 5)] {
            let turbulence = Turbulence::synthesise(isa, lanes, EDDIES, 0.2);
            let mut wind = Wind::new(&turbulence);
            let bits: Vec<u64> = (0..500)
                .flat_map(|i| {
                    let v = wind.at(i as f64 * 3.7e-4)[4].lane(lane);
                    [v.x.to_bits(), v.y.to_bits(), v.z.to_bits()]
                })
                .collect();
            match &reference {
                None => reference = Some(bits),
                Some(expected) => assert!(*expected == bits, "{} differs", isa.name()),
            }
        }
    }
}

#[test]
fn identical_wind_in_any_order_of_times() {
    let turbulence = Turbulence::synthesise(Isa::detect(), &streams(&table1_air(), 1), EDDIES, 0.2);
    let times: Vec<f64> = (0..200).map(|i| 0.1 + 0.09 * scatter(i)).collect();
    let mut hopping = Wind::new(&turbulence);
    for &t in &times {
        let mut fresh = Wind::new(&turbulence);
        assert_eq!(hopping.at(t)[3], fresh.at(t)[3], "at {t} s");
    }
}
