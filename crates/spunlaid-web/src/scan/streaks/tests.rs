//! Streaks of clouds that are drawn, with and without streaks and periods.

use super::{Map, search};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;
use spunlaid_ground::random::uniform;
use std::f64::consts::TAU;

/// Clouds that are about as large as the moving means of so many cells across and along, of which two are taken each
/// way.
#[derive(Clone, Copy)]
struct Clouds {
    size: [usize; 2],
    cv: f64,
    /// Of the pixels, over their mean.
    noise: f64,
}

/// Fine clouds with a little noise.
const FINE: Clouds = Clouds { size: [3, 3], cv: 0.2, noise: 0.1 };

/// A map of such clouds, of cells across and along, times a profile across.
fn map([columns, rows]: [usize; 2], clouds: Clouds, profile: impl Fn(f64) -> f64, seed: u64) -> Map {
    let Clouds { size, cv, noise } = clouds;
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut flat = |count: usize| -> Vec<f64> {
        (0..count).map(|_| (uniform(&mut random) - 0.5) * 12f64.sqrt()).collect()
    };
    let [across, along] = size;
    let (wide, long) = (columns + 2 * across, rows + 2 * along);
    let mut field = flat(wide * long);
    let mean = |values: &mut Vec<f64>, line: usize, step: usize, count: usize, by: usize| {
        let part: Vec<f64> = (0..count).map(|i| values[line + i * step]).collect();
        for i in 0..count - by {
            values[line + i * step] = part[i..i + by].iter().sum::<f64>() / by as f64;
        }
    };
    for _ in 0..2 {
        (0..long).for_each(|row| mean(&mut field, row * wide, 1, wide, across));
        (0..wide).for_each(|column| mean(&mut field, column, wide, long, along));
    }
    let inner: Vec<f64> =
        (0..rows).flat_map(|row| field[row * wide..row * wide + columns].to_vec()).collect();
    let rms = (inner.iter().map(|x| x * x).sum::<f64>() / inner.len() as f64).sqrt();
    let pixels = flat(columns * rows);
    let cell = |(i, (cloud, pixel)): (usize, (&f64, &f64))| {
        let weight = profile(((i % columns) as f64 + 0.5) / columns as f64);
        (1e6 * weight * (1.0 + cv * cloud / rms + noise * pixel)).max(0.0) as u32
    };
    let cells = inner.iter().zip(&pixels).enumerate().map(cell).collect();
    Map { columns, rows, cell: 1e-3, closed: [false; 2], quantum: 1e-11, cells }
}

/// Webs of clouds without any streak, fine and coarse, with and without noise of pixels: one in twenty may have a
/// streak or a period. Two standard errors of 160 such webs are allowed.
#[test]
fn stat_clouds_alone_make_a_streak_in_at_most_one_web_of_twenty() {
    let textures = [
        FINE,
        Clouds { size: [8, 5], cv: 0.2, noise: 0.0 },
        Clouds { size: [2, 7], cv: 0.15, noise: 0.05 },
        Clouds { size: [4, 4], cv: 0.3, noise: 0.3 },
    ];
    let (mut found, mut all) = (0, 0);
    for seed in 0..160 {
        let map = map([110, 160], textures[seed as usize % 4], |_| 1.0, seed);
        let Some(search) = search(&map, false) else { continue };
        all += 1;
        found += usize::from(!search.streaks.is_empty() || !search.periods.is_empty());
    }
    let most = 0.05 * f64::from(all) + 2.0 * (0.05 * 0.95 * f64::from(all)).sqrt();
    assert!(all > 120 && (found as f64) < most, "{found} of {all}");
}

/// The errors of a known streak are those of its fits, and a streak that is twice as large as the limit is found.
#[test]
fn stat_a_known_streak_is_found_at_its_place_with_its_amplitude_and_width() {
    let (middle, sigma) = (0.3, 6e-3);
    let (mut squares, mut inside) = (0.0, 0);
    for seed in 0..24 {
        let streak = |x: f64| 1.0 - 0.12 * libm::exp(-0.5 * ((x - middle) * 0.15 / sigma).powi(2));
        let search = search(&map([150, 400], FINE, streak, 900 + seed), false).unwrap();
        let found = search.streaks[0];
        assert!((found.place - middle * 0.15).abs() < 4e-3, "{found:?}");
        // The mean is lower by the streak.
        squares += ((found.amplitude + 0.123) / found.standard_error).powi(2) / 24.0;
        let [low, high] = found.sigma_range;
        inside += usize::from((low..high).contains(&sigma));
    }
    // χ²/24 of 24 values exceeds 2.13 in one of a thousand; fewer than 20 of 24 intervals of 95 % hold as rarely.
    assert!((0.4..2.13).contains(&squares) && inside >= 20, "{squares} {inside}");
}

#[test]
fn stat_a_wave_across_is_found_with_its_period_and_is_no_streak() {
    for seed in 0..6 {
        let wave = |x: f64| 1.0 + 0.05 * libm::cos(TAU * x * 0.15 / 8.7e-3 + seed as f64);
        let search = search(&map([150, 400], FINE, wave, 400 + seed), false).unwrap();
        let [found] = search.periods[..] else { panic!("{:?}", search.periods) };
        assert!((found.period / 8.7e-3 - 1.0).abs() < 0.01, "{found:?}");
        assert!((found.amplitude - 0.05).abs() < 4.0 * found.standard_error, "{found:?}");
        assert!(search.streaks.is_empty(), "{:?}", search.streaks);
    }
}

/// A scan that holds few clouds, and one that is all the same, say nothing of streaks.
#[test]
fn a_scan_that_is_too_short_for_its_clouds_has_no_streaks() {
    assert_eq!(
        search(&map([110, 60], Clouds { size: [40, 40], cv: 0.2, noise: 0.0 }, |_| 1.0, 1), false),
        None
    );
    assert_eq!(
        search(&map([110, 160], Clouds { size: [3, 3], cv: 0.0, noise: 0.0 }, |_| 1.0, 1), false),
        None
    );
}
