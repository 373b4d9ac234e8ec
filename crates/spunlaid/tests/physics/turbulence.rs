//! The synthesised turbulence, compared with the sum of cosines that it represents and with the statistics that it must
//! have.

use crate::common::*;
use spunlaid_air::{Air, Stream, StreamKey, Wind};
use spunlaid_ground::{Isa, WIDTH, Welch, Window};
use std::f64::consts::PI;
use std::ops::Range;

const EDDIES: usize = 6;

fn streams(air: &Air, seed: u64) -> Vec<(Air, StreamKey)> {
    (0..WIDTH as u64).map(|replicate| (air.clone(), StreamKey { seed, replicate })).collect()
}

/// Fluctuations `[lane][eddy][component][sample]` of the sum of cosines, sampled every `interval` over
/// `duration`.
fn records(air: &Air, seed: u64, interval: f64, duration: f64) -> Vec<Vec<f64>> {
    let wind = Wind::repeating(Isa::detect(), Stream::uniform(&streams(air, seed), EDDIES), duration);
    records_of(wind.expect("fibres that agree"), air, interval, 0.0..duration)
}

/// Fluctuations `[lane][eddy][component][sample]`, sampled every `interval` over some times.
fn records_of(mut wind: Wind, air: &Air, interval: f64, times: Range<f64>) -> Vec<Vec<f64>> {
    let mut records = vec![Vec::new(); WIDTH * EDDIES * 3];
    for k in 0..((times.end - times.start) / interval) as usize {
        let velocities = wind.at(times.start + k as f64 * interval);
        for (lane_record, record) in records.iter_mut().enumerate() {
            let lane = lane_record / (EDDIES * 3);
            let eddy = lane_record / 3 % EDDIES;
            let component = lane_record % 3;
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
    let mut wind = Wind::repeating(Isa::detect(), Stream::uniform(&streams(&air, 7), EDDIES), period)
        .expect("fibres that agree");
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
        let mut wind =
            Wind::uniform(Isa::detect(), &streams(&air, seed), EDDIES, 0.5).expect("fibres that agree");
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

/// A mean over half-overlapping Hann segments is one, but for its scatter: each scatters by as much as its mean, and
/// neighbours correlate by 1/6 (Welch 1967), so the variance of the mean of K is (1 + 2/36)/K.
fn assert_flat(ratio: f64, segments: usize, frequency: f64) {
    let error = 4.0 * (1.056 / segments as f64).sqrt();
    assert!((ratio - 1.0).abs() < error, "{frequency} Hz: {ratio} of what is wanted, ± {error}");
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
            assert_flat(density / wanted, segments, f);
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
            let mut wind = Wind::uniform(isa, lanes, EDDIES, 0.2).expect("fibres that agree");
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
    let turbulence =
        Wind::uniform(Isa::detect(), &streams(&table1_air(), 1), EDDIES, 0.2).expect("fibres that agree");
    let times: Vec<f64> = (0..200).map(|i| 0.1 + 0.09 * scatter(i)).collect();
    let mut hopping = turbulence.clone();
    for &t in &times {
        let mut fresh = turbulence.clone();
        assert_eq!(hopping.at(t)[3], fresh.at(t)[3], "at {t} s");
    }
}

/// A wind of windows: 16 harmonics of 100 Hz repeat after 0.16 s, so that windows follow one another every 0.12 s and
/// fade over 0.04 s.
fn short_windows() -> Air {
    Air { harmonics: 16, ..table1_air() }
}

#[test]
fn identical_to_one_sum_of_cosines_until_the_first_window_fades() {
    let air = short_windows();
    let hop = 0.75 * air.repeat_time();
    let lanes = streams(&air, 4);
    let mut windows = Wind::uniform(Isa::detect(), &lanes, EDDIES, 1.0).expect("fibres that agree");
    let mut sum =
        Wind::repeating(Isa::detect(), Stream::uniform(&lanes, EDDIES), 1.0).expect("fibres that agree");
    // The interpolation looks four samples ahead, of which there are 64 in a repeat time.
    let first = hop - 4.0 * air.repeat_time() / 64.0;
    for i in 0..200 {
        let t = first * f64::from(i) / 200.0;
        assert_eq!(windows.at(t), sum.at(t), "at {t} s");
    }
    assert_ne!(windows.at(hop + 0.02), sum.at(hop + 0.02));
}

#[test]
fn identical_wind_however_far_it_was_made_ahead_and_in_any_order() {
    let air = short_windows();
    let lanes = streams(&air, 4);
    let wind = |horizon| Wind::uniform(Isa::detect(), &lanes, EDDIES, horizon).expect("fibres that agree");
    let (mut in_order, mut hopping) = (wind(0.0), wind(3.0));
    for i in 0..300 {
        let t = f64::from(i) * 3.3e-3;
        // Forwards and backwards over several windows.
        hopping.at((t * 7.0) % 1.1);
        assert_eq!(in_order.at(t), hopping.at(t), "at {t} s");
        assert_eq!(in_order.at(t), wind(t).at(t), "at {t} s");
    }
}

#[test]
fn stat_variance_is_the_same_at_every_instant_of_the_windows() {
    let air = short_windows();
    let hop = 0.75 * air.repeat_time();
    // From the middle of one window over the fade into the next and on: 12 instants, 30 seeds of 144 signals.
    let mut sums = [[0.0; 4]; 12];
    for seed in 0..30 {
        let mut wind =
            Wind::uniform(Isa::detect(), &streams(&air, seed), EDDIES, 0.0).expect("fibres that agree");
        for (k, sums) in sums.iter_mut().enumerate() {
            for v in wind.at(5.0 * hop + (k as f64 - 4.0) / 24.0 * air.repeat_time()) {
                for lane in 0..WIDTH {
                    let v = v.lane(lane);
                    for u in [v.x - air.velocity, v.y, v.z] {
                        let u = u / air.rms();
                        (sums[0], sums[1], sums[2], sums[3]) =
                            (sums[0] + 1.0, sums[1] + u, sums[2] + u * u, sums[3] + u.powi(4));
                    }
                }
            }
        }
    }
    for (k, [n, first, second, fourth]) in sums.into_iter().enumerate() {
        // Two sums of 16 cosines with the weights cos and sin of the fade (theory.md (50)) have a fourth moment of
        // 3 − 1.5 (cos⁴ + sin⁴)/16; four standard errors of each.
        let into = ((k as f64 - 4.0) / 24.0).clamp(0.0, 0.25) / 0.25;
        let (sin, cos) = (0.5 * PI * into).sin_cos();
        let expected = 3.0 - 1.5 * (cos.powi(4) + sin.powi(4)) / 16.0;
        assert!((first / n).abs() < 4.0 / n.sqrt(), "instant {k}: mean {}", first / n);
        assert!((second / n - 1.0).abs() < 4.0 * (2.0 / n).sqrt(), "instant {k}: variance {}", second / n);
        assert!(
            (fourth / n - expected).abs() < 4.0 * (96.0 / n).sqrt(),
            "instant {k}: {}, not {expected}",
            fourth / n
        );
    }
}

#[test]
fn stat_autocorrelation_holds_across_the_joints_of_windows() {
    let air = short_windows();
    let repeat = air.repeat_time();
    let fade = 0.25 * air.repeat_time();
    let hop = 0.75 * air.repeat_time();
    // The weight of window k, theory.md (50).
    let weight = |k: usize, t: f64| {
        let since = t - k as f64 * hop;
        let part = |since: f64| 0.5 * PI * (since / fade).clamp(0.0, 1.0);
        if (0.0..repeat).contains(&since) { part(since).sin() * part(since - hop).cos() } else { 0.0 }
    };
    // Correlation of a sum of 16 cosines.
    let within = |lag: f64| {
        let turned = |n: usize| 2.0 * PI * (n as f64 + 0.5) / repeat * lag;
        (0..16).map(|n| turned(n).cos()).sum::<f64>() / 16.0
    };
    let lags = [1.3e-3, 5e-3, 9e-3, 20e-3, 0.75 * repeat, repeat, 2.0 * hop, 2.0 * repeat];
    let places = [0.2, 0.5, 0.8];
    for lag in lags {
        // Pairs of instants with the joint between them, before it and after it.
        let pairs = places.map(|place| {
            let start = 3.0 * hop + fade * place - 0.5 * lag.min(0.1 * repeat);
            (start, start + lag)
        });
        let (mut n, mut sum) = (0.0, 0.0);
        for seed in 0..60 {
            let mut wind =
                Wind::uniform(Isa::detect(), &streams(&air, seed), EDDIES, 0.0).expect("fibres that agree");
            for (start, end) in pairs {
                let [first, then] = [start, end].map(|t| wind.at(t));
                for (a, b) in first.iter().zip(&then) {
                    for lane in 0..WIDTH {
                        let (a, b) = (a.lane(lane), b.lane(lane));
                        sum += (a.y * b.y + a.z * b.z) / (2.0 * air.rms().powi(2));
                        n += 1.0;
                    }
                }
            }
        }
        let of_pair = |(start, end): (f64, f64)| {
            (0..12).map(|k| weight(k, start) * weight(k, end)).sum::<f64>() * within(lag)
        };
        let found = sum / n;
        let expected = pairs.map(of_pair).iter().sum::<f64>() / places.len() as f64;
        // Products of two normal variables scatter by one, or √2 where they are the same; three places of one
        // signal count as one, and y and z as two.
        let bound = 4.0 * (3.0_f64 / n).sqrt() * ((1.0 + expected * expected) / 2.0).sqrt();
        assert!((found - expected).abs() < bound, "lag {lag} s: {found}, expected {expected} within {bound}");
    }
}

#[test]
fn stat_spectrum_of_many_windows_is_flat_to_the_cutoff_and_nothing_above() {
    // 128 harmonics repeat after 1.28 s; a segment of the analysis of 0.64 s is as often in a fade as not.
    let air = Air { harmonics: 128, ..table1_air() };
    let (interval, segment) = (1.0 / 800.0, 512);
    let wind = Wind::uniform(Isa::detect(), &streams(&air, 11), EDDIES, 0.0).expect("fibres that agree");
    let mut spectrum = Welch::new(interval, segment, Window::Hann, 0.5);
    let mut segments = 0;
    for record in records_of(wind, &air, interval, 100.0..110.0) {
        spectrum.add(&record, None);
        segments += record.len() / (segment / 2) - 1;
    }
    let wanted = air.rms().powi(2) / air.cutoff_frequency;
    for (f, density) in spectrum.finish().points() {
        if f > 4.0 && f < 96.0 {
            assert_flat(density / wanted, segments, f);
        } else if f > 110.0 {
            // A window has two corners where the fade begins or ends with the slope s = π/2F, so its transform is at
            // most 2s/ω². All lines up to the cut-off at a distance of Δ or more add up to ∫ 4s²/(hop ω⁴) df from Δ
            // on. The Hann window of the analysis reaches two steps; sampling mirrors what lies above its half.
            let (fade, hop) = (0.25 * air.repeat_time(), 0.75 * air.repeat_time());
            let step = 1.0 / (segment as f64 * interval);
            let corners = |off: f64| 1.0 / (48.0 * PI * PI * fade * fade * hop * (off - 2.0 * step).powi(3));
            let off = f - air.cutoff_frequency;
            let image = 1.0 / interval - f - air.cutoff_frequency;
            let hann = 2.0 / (15.0 * PI * PI * (off / step - 1.0).powi(5));
            let leak = corners(off) + corners(image) + hann + 1e-12;
            assert!(
                density < leak * wanted,
                "{f} Hz: {:e} of {wanted:e}, at most {leak:e}",
                density / wanted
            );
        }
    }
}

#[test]
fn frozen_memory_of_a_wind_that_blows_for_hours() {
    let air = table1_air();
    let mut wind = Wind::uniform(Isa::detect(), &streams(&air, 1), EDDIES, 0.0).expect("fibres that agree");
    let mut seen = Vec::new();
    for hour in 0..4 {
        let now = wind.at(3600.0 * f64::from(hour) + 0.01)[2].lane(5);
        assert!(seen.iter().all(|earlier| *earlier != now), "the wind repeats");
        seen.push(now);
    }
    // At most one repeat time at any time.
    assert_eq!(Wind::memory(&air, EDDIES, 10.0), Wind::memory(&air, EDDIES, 1e6));
}
