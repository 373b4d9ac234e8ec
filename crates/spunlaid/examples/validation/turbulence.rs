//! The synthesised turbulence.

use crate::common::*;
use crate::title;
use spunlaid::air::{Air, Stream, StreamKey, Wind};
use spunlaid::ground::{Isa, WIDTH, Welch, Window};
use std::f64::consts::PI;

const EDDIES: usize = 6;

/// Fluctuations of 144 independent components, one sum of cosines each, sampled every `interval` over `duration`.
fn records(air: &Air, seed: u64, interval: f64, duration: f64) -> Vec<Vec<f64>> {
    let streams: Vec<(Air, StreamKey)> =
        (0..WIDTH as u64).map(|replicate| (air.clone(), StreamKey { seed, replicate })).collect();
    let streams = Stream::uniform(&streams, EDDIES);
    let mut wind = Wind::repeating(Isa::detect(), streams, duration).expect("fibres that agree");
    let mut records = vec![Vec::new(); WIDTH * EDDIES * 3];
    for k in 0..(duration / interval).round() as usize {
        let velocities = wind.at(k as f64 * interval);
        for (i, record) in records.iter_mut().enumerate() {
            let v = velocities[i / 3 % EDDIES].lane(i / (EDDIES * 3));
            record.push([v.x - air.velocity, v.y, v.z][i % 3]);
        }
    }
    records
}

pub fn sum_of_cosines() {
    title("signal less its 16 fitted cosines, sampled off the grid");
    let air = Air { harmonics: 16, ..table1_air() };
    let period = 2.0 * air.repeat_time();
    let samples = 3 * 17 * 16;
    let interval = period / samples as f64;
    let expected = (2.0 / air.harmonics as f64).sqrt() * air.rms();
    let (mut residual, mut amplitude): (f64, f64) = (0.0, 0.0);
    for record in records(&air, 7, interval, period) {
        let mut rest = record.clone();
        for k in 0..air.harmonics {
            let w = (k as f64 + 0.5) * 2.0 * PI * air.cutoff_frequency / air.harmonics as f64;
            let project = |f: fn(f64) -> f64| {
                let sum: f64 = record.iter().enumerate().map(|(i, u)| u * f(w * i as f64 * interval)).sum();
                sum * 2.0 / samples as f64
            };
            let (c, s) = (project(f64::cos), project(f64::sin));
            for (i, r) in rest.iter_mut().enumerate() {
                let t = w * i as f64 * interval;
                *r -= c * t.cos() + s * t.sin();
            }
            amplitude = amplitude.max((c.hypot(s) / expected - 1.0).abs());
        }
        residual = rest.iter().fold(residual, |m, r| m.max(r.abs()));
    }
    println!("  at most {:.1e} of the rms; amplitudes to {amplitude:.1e}", residual / air.rms());
}

pub fn statistics() {
    title("statistics of 144 components over a full period");
    let air = table1_air();
    let period = 2.0 * air.repeat_time();
    let samples = 8192;
    let interval = period / samples as f64;
    let all = records(&air, 3, interval, period);
    let u2 = air.rms().powi(2);
    let n = samples as f64;
    let worst = |f: &dyn Fn(&Vec<f64>) -> f64| all.iter().map(|r| f(r).abs()).fold(0.0, f64::max);
    println!("  mean at most {:.1e} u", worst(&|r| r.iter().sum::<f64>() / n) / air.rms());
    println!("  variance u² to {:.1e}", worst(&|r| r.iter().map(|u| u * u).sum::<f64>() / n / u2 - 1.0));
    for lag in [7usize, 33, 64, 150] {
        let tau = lag as f64 * interval;
        let x = 2.0 * PI * air.cutoff_frequency * tau;
        let off = worst(&|r| {
            let c: f64 = (0..samples).map(|i| r[i] * r[(i + lag) % samples]).sum::<f64>() / n;
            c / u2 - x.sin() / x
        });
        println!("  autocorrelation after {:.2} ms: sin x/x = {:.4}, to {off:.1e}", tau * 1e3, x.sin() / x);
    }
    let deviation = 1.0 / (2.0 * air.harmonics as f64).sqrt();
    let mut squares = 0.0;
    let mut pairs = 0u32;
    let mut largest = 0.0f64;
    for i in 0..all.len() {
        for j in 0..i {
            let c: f64 = all[i].iter().zip(&all[j]).map(|(a, b)| a * b).sum::<f64>() / (n * u2) / deviation;
            squares += c * c;
            pairs += 1;
            largest = largest.max(c.abs());
        }
    }
    println!(
        "  correlations of {pairs} pairs: mean square {:.4} of what chance gives, largest {largest:.2} deviations",
        squares / f64::from(pairs)
    );
}

pub fn spectrum() {
    title("Welch spectrum by the wanted level, 4320 segments");
    let air = Air { harmonics: 1024, ..table1_air() };
    let interval = 1.0 / 800.0;
    let mut spectrum = Welch::new(interval, 512, Window::Hann, 0.5);
    for record in records(&air, 11, interval, 10.0) {
        spectrum.add(&record, None);
    }
    let wanted = air.rms().powi(2) / air.cutoff_frequency;
    let (mut low, mut high) = (9.0_f64, 0.0_f64);
    let (mut sum, mut count) = (0.0, 0_u32);
    let mut above = 0.0_f64;
    for (f, density) in spectrum.finish().points() {
        let ratio = density / wanted;
        if f > 4.0 && f < 96.0 {
            (low, high) = (low.min(ratio), high.max(ratio));
            sum += ratio;
            count += 1;
        } else if f > 110.0 {
            above = above.max(ratio);
        }
    }
    println!("  4 to 96 Hz: mean {:.4}, from {low:.3} to {high:.3}", sum / f64::from(count));
    println!("  above 110 Hz: at most {above:.1e}");
}
