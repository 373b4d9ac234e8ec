//! Clouds of maps whose waves follow by hand.

#![allow(clippy::unwrap_used)]

use super::*;
use spunlaid_ground::random::{stream, uniform};

/// Another map whose deviations are two tenths larger has 44 % more variance in each octave, which is in the
/// error of every band.
#[test]
fn analytic_what_a_filling_does_is_in_the_error_of_the_clouds() {
    const CELLS: usize = 64;
    let map = |size: f64| {
        let pattern = |i: usize| libm::sin(1.7 * (i * i) as f64) + libm::sin(0.31 * i as f64);
        let all = CELLS * CELLS;
        let mean = (0..all).map(pattern).sum::<f64>() / all as f64;
        let cells = (0..all).map(|i| (1e8 * (1.0 + size * (pattern(i) - mean))) as u32).collect();
        Map { columns: CELLS, rows: CELLS, cell: 1e-3, quantum: 1e-12, closed: [true, false], cells }
    };
    let [own, other] = [0.1, 0.12].map(|size| Clouds::measure(&map(size)).unwrap());
    let apart = own.apart(&other);
    assert!(apart.len() > 2 && apart.iter().all(|(_, off)| (off - 0.44).abs() < 1e-5), "{apart:?}");
    let [before, after] = [own.clone(), own.with_filling(apart)].map(|clouds| clouds.variance(3e-3, 12e-3));
    let expected = before.standard_error.unwrap().hypot(0.44 * before.mean);
    // Masses are whole quanta.
    assert!((after.standard_error.unwrap() / expected - 1.0).abs() < 1e-5, "{before:?} {after:?}");
}

/// Streaks run through all tiles of a column, some with more of them than others: the error is that of four
/// columns, and not that of all tiles.
#[test]
fn stat_the_error_of_the_texture_holds_with_streaks() {
    const COLUMNS: usize = 64;
    const ROWS: usize = 640;
    let texture = |seed: u64| {
        let mut random = stream([seed, 0, 0, 0]);
        let streaks: Vec<f64> = (0..COLUMNS).map(|_| uniform(&mut random)).collect();
        let strength: Vec<f64> = (0..4).map(|_| 3.0 * uniform(&mut random)).collect();
        let mut cell = |i: usize| {
            let column = i % COLUMNS;
            (1e6 * (10.0 + strength[column / 16] * streaks[column] + uniform(&mut random))) as u32
        };
        let cells = (0..COLUMNS * ROWS).map(&mut cell).collect();
        let map = Map { columns: COLUMNS, rows: ROWS, cell: 1e-3, quantum: 1e-12, closed: [true; 2], cells };
        Clouds::measure(&map).unwrap().texture_md()
    };
    let all: Vec<Estimate> = (0..60).map(texture).collect();
    let reported = all.iter().map(|one| one.standard_error.unwrap().powi(2)).sum::<f64>() / 60.0;
    let scatter = Estimate::new(all.iter().map(|one| one.mean).collect()).standard_error.unwrap();
    let ratio = scatter * 60_f64.sqrt() / reported.sqrt();
    assert!((0.6..1.6).contains(&ratio), "{ratio}");
}

/// One plus this at each column and row.
fn waved([columns, rows]: [usize; 2], closed: [bool; 2], wave: impl Fn(usize, usize) -> f64) -> Map {
    let cell = |i: usize| (1e8 * (1.0 + wave(i % columns, i / columns))).round() as u32;
    let cells = (0..columns * rows).map(cell).collect();
    Map { columns, rows, cell: 1e-3, quantum: 1e-12, closed, cells }
}

fn turns(turns: f64) -> f64 {
    libm::cos(2.0 * PI * turns)
}

/// Tiles of 32 cells with five waves across: a Hann window leaves two thirds of the power in its wave number, and
/// a sixth in each of those next to it, across and along.
#[test]
fn analytic_the_waves_of_a_tile_under_its_window() {
    const POWER: f64 = 0.5 * 0.2 * 0.2;
    let parts = [(-1.0, 1.0 / 6.0), (0.0, 2.0 / 3.0), (1.0, 1.0 / 6.0)];
    for direction in [0, 1] {
        let wave = |at: [usize; 2]| 0.2 * turns(5.0 * at[direction] as f64 / 32.0);
        let map = waved([128, 128], [true; 2], |column, row| wave([column, row]));
        let clouds = Clouds::measure(&map).unwrap();
        let close = |found: f64, expected: f64| {
            assert!((found / expected - 1.0).abs() < 1e-6, "{direction}: {found} {expected}");
        };
        close(clouds.longest(), 32e-3);
        close(clouds.shortest(), 2e-3);
        let own = clouds.spectrum(direction);
        let other = clouds.spectrum(1 - direction);
        for (k, part) in [(4, 1.0 / 6.0), (5, 2.0 / 3.0), (6, 1.0 / 6.0)] {
            close(own[k - 1].0, 32e-3 / k as f64);
            close(own[k - 1].1, POWER * part * 32e-3);
        }
        // Along the crests, the waves of the window: half of it on either side.
        close(other[0].1, POWER / 3.0 * 32e-3);
        assert!(own.len() == 16 && other[1].1 < 1e-9 * POWER && own[6].1 < 1e-9 * POWER);
        // The long waves begin at 32/5 mm. Shorter ones are those of the tiles, by the middle of their ring.
        for (band, part) in [
            ([2e-3, 6.4e-3], 5.0 / 6.0),
            ([5.5e-3, 6e-3], 2.0 / 3.0),
            ([4.7e-3, 5.5e-3], 1.0 / 6.0),
            ([6.39e-3, 6.5e-3], 1.0),
        ] {
            let found = clouds.variance(band[0], band[1]);
            close(found.mean, POWER * part);
            assert!(found.standard_error.is_none_or(|error| error < 1e-6 * POWER) || band[0] > 6e-3);
        }
        let along = |(across, one): (f64, f64), (md, other): (f64, f64)| {
            one * other * (5.0 + across).powi(2) / ((5.0 + across).powi(2) + md * md)
        };
        let across: f64 = parts.iter().flat_map(|a| parts.map(|b| along(*a, b))).sum();
        let texture = clouds.texture_md();
        close(texture.mean, if direction == 0 { across } else { 1.0 - across });
        assert!(texture.standard_error.unwrap() < 1e-6, "{texture:?}");
        // One per cent of weight is one per cent of a variance, and half of that of its root.
        let (index, error) = clouds.clone().with_error_of_weight(Some(0.01)).cloudiness(2e-3, 6.4e-3);
        close(index, (POWER * 5.0 / 6.0).sqrt());
        close(error.unwrap(), 0.005 * index);
        let octaves = clouds.octaves();
        let bounds: Vec<f64> = octaves.iter().flat_map(|(band, _)| band.map(|m| m * 1e3)).collect();
        assert!(
            bounds.iter().zip([2.0, 4.0, 4.0, 8.0, 8.0, 16.0, 16.0, 32.0]).all(|(a, b)| (a - b).abs() < 1e-9)
        );
        assert_eq!(octaves.len(), 4);
    }
}

/// A long wave has half the square of its size, whatever the numbers of cells and parts, on a ring and under a
/// window; the bands next to it have nothing.
#[test]
fn analytic_a_long_wave_has_its_power() {
    const POWER: f64 = 0.5 * 0.2 * 0.2;
    for (size, closed, within) in [
        ([256, 128], [true; 2], 1e-6),
        ([200, 120], [true; 2], 1e-3),
        ([90, 300], [true; 2], 1e-3),
        ([256, 128], [false, true], 0.01),
        ([128, 256], [true, false], 0.01),
        ([256, 256], [false; 2], 0.01),
    ] {
        for (across, along) in [(9, 5), (3, 8), (8, 0), (0, 9), (5, -6)] {
            let [columns, rows] = size.map(|cells| cells as f64);
            let wave = |column: usize, row: usize| {
                let at = [(column as f64 + 0.5) / columns, (row as f64 + 0.5) / rows];
                0.2 * turns(f64::from(across) * at[0] + f64::from(along) * at[1])
            };
            let clouds = Clouds::measure(&waved(size, closed, wave)).unwrap();
            let length = 1e-3 / (f64::from(across) / columns).hypot(f64::from(along) / rows);
            let variance = clouds.variance(0.6 * length, 1.8 * length);
            // One wave says nothing of others.
            assert!(variance.standard_error.is_none() || closed != [true; 2], "{variance:?}");
            let found = variance.mean / POWER;
            assert!((found - 1.0).abs() < within, "{size:?} {closed:?} {across} {along}: {found}");
            let next = clouds.variance(1.8 * length, 4.0 * length).mean / POWER;
            assert!(next < within, "{size:?} {closed:?} {across} {along}: {next}");
        }
    }
}

#[test]
fn a_sheet_without_fibre_or_of_few_cells_has_no_clouds() {
    let flat = waved([16, 40], [true; 2], |_, _| 0.0);
    // Of four tiles the two without a wave, which are lighter than the mean, have no direction.
    let half =
        waved([32, 32], [true; 2], |column, _| if column < 16 { -0.1 } else { turns(column as f64 / 4.0) });
    assert!(Clouds::measure(&half).is_some_and(|clouds| clouds.texture_md().values.len() == 2));
    assert!(Clouds::measure(&flat).is_some_and(|clouds| clouds.texture_md().mean.is_nan()));
    assert!(Clouds::measure(&waved([15, 40], [true; 2], |_, _| 0.0)).is_none());
    assert!(Clouds::measure(&waved([16, 40], [true; 2], |_, _| -1.0)).is_none());
}
