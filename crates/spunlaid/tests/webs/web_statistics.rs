//! PatchCv and clouds of maps whose statistics are known.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use spunlaid_web::map::autocorrelation;
use spunlaid_web::map::uniformity::patch_cv;
use spunlaid_web::{Clouds, Map};
use std::f64::consts::TAU;

const MEAN: f64 = 1e6;

fn map(columns: usize, rows: usize, closed: bool, value: impl Fn(usize, usize) -> f64) -> Map {
    let cells = (0..rows * columns).map(|i| (MEAN * (1.0 + value(i / columns, i % columns))).round() as u32);
    Map { columns, rows, cell: 1e-3, quantum: 1e-12, closed: [closed; 2], cells: cells.collect() }
}

/// Independent numbers of variance one in each cell, averaged over squares of some cells on the ring.
fn noise(seed: u64, [columns, rows]: [usize; 2], side: usize) -> Vec<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut uniform = || (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    // The sum of twelve is near enough to a normal number.
    let white: Vec<f64> =
        (0..columns * rows).map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0).collect();
    let mut smooth = vec![0.0; columns * rows];
    for row in 0..rows {
        for column in 0..columns {
            let square = (0..side * side)
                .map(|i| white[(row + i / side) % rows * columns + (column + i % side) % columns]);
            smooth[row * columns + column] = square.sum::<f64>() / (side * side) as f64;
        }
    }
    smooth
}

/// Variance of white noise averaged over squares of two sides, one after the other: the product of both directions.
fn variance(a: usize, b: usize) -> f64 {
    let triangle = |side: usize, lag: i64| (side as i64 - lag.abs()).max(0) as f64;
    let reach = a.max(b) as i64;
    let one = (-reach..=reach).map(|lag| triangle(a, lag) * triangle(b, lag)).sum::<f64>();
    (one / (a * a * b * b) as f64).powi(2)
}

#[test]
#[ignore = "slow: two hundred fields"]
fn intervals_of_the_unevenness_hold() {
    const FIELDS: u64 = 200;
    const SIDE: usize = 6;
    const STRENGTH: f64 = 0.5;
    const SIZE: [usize; 2] = [240, 300];
    // Closed on itself, and cut out of a larger sheet.
    const SHEETS: [(bool, [usize; 2]); 2] = [(true, SIZE), (false, [200, 250])];
    const PATCHES: [usize; 3] = [1, 4, 10];
    let truth = PATCHES.map(|patch| STRENGTH * variance(patch, SIDE).sqrt());
    // Number of intervals that hold, and the mean of the values.
    let mut found = [[(0, 0.0); PATCHES.len()]; SHEETS.len()];
    for seed in 0..FIELDS {
        let field = noise(seed, SIZE, SIDE);
        for ((closed, [columns, rows]), found) in SHEETS.into_iter().zip(&mut found) {
            let map = map(columns, rows, closed, |row, column| STRENGTH * field[row * SIZE[0] + column]);
            for ((patch, truth), (held, mean)) in PATCHES.into_iter().zip(truth).zip(found) {
                let one = patch_cv(&map, patch).expect("an patch_cv");
                let error = one.standard_error.expect("an error");
                *held += u64::from((one.cv - truth).abs() < 1.96 * error);
                *mean += one.cv / FIELDS as f64;
            }
        }
    }
    for ((closed, _), found) in SHEETS.into_iter().zip(found) {
        for ((patch, truth), (held, mean)) in PATCHES.into_iter().zip(truth).zip(found) {
            let share = held as f64 / FIELDS as f64;
            assert!(
                (0.90..=0.995).contains(&share),
                "{share} of the intervals hold at {patch}, closed {closed}"
            );
            assert!((mean / truth - 1.0).abs() < 0.01, "{mean} where {truth} is wanted");
        }
    }
}

#[test]
fn a_wave_is_found_at_its_length_and_direction() {
    // 16 cells along the machine direction.
    let waves = map(256, 512, true, |row, _| 0.2 * (TAU * row as f64 / 16.0).sin());
    let clouds = Clouds::measure(&waves).expect("clouds");
    let whole = 0.5 * 0.2 * 0.2;
    let found = clouds.variance(10e-3, 24e-3).mean;
    assert!((found / whole - 1.0).abs() < 1e-3, "{found} where {whole} is wanted");
    let elsewhere = clouds.variance(0.0, 10e-3).mean + clouds.variance(24e-3, 1.0).mean;
    assert!(elsewhere < 1e-4 * whole, "{elsewhere}");
    let peak = clouds.spectrum(1).into_iter().max_by(|a, b| a.1.total_cmp(&b.1)).expect("a peak");
    assert!((peak.0 - 16e-3).abs() < 1e-9, "{peak:?}");
    // The crests lie across the machine; the window spreads a third of a wave to its neighbours, at 1/17 of the square.
    assert!((clouds.texture_md().mean - 1.0 / 51.0).abs() < 0.01, "{:?}", clouds.texture_md());
    let [cd, md] = autocorrelation(&waves, 17, 2);
    assert!(
        (md[8] + 1.0).abs() < 1e-3 && (md[16] - 1.0).abs() < 1e-3 && (cd[8] - 1.0).abs() < 1e-3,
        "{md:?}"
    );
}

/// A tile in which nothing lies has no texture, and does not blur that of the others.
#[test]
fn analytic_the_texture_of_a_sparse_sheet_is_that_of_where_it_lies() {
    let lies = |row: usize, column: usize| row < 64 && column < 64;
    let sparse = map(256, 512, true, |row, column| match lies(row, column) {
        true => 0.2 * (TAU * row as f64 / 8.0).sin(),
        false => -1.0,
    });
    let texture = Clouds::measure(&sparse).expect("clouds").texture_md();
    // As above; a single tile has no error.
    assert!(texture.mean < 0.03 && texture.standard_error.is_none(), "{texture:?}");
}

#[test]
fn the_parts_of_white_noise_are_the_areas_of_their_rings() {
    let field = noise(1, [512, 512], 1);
    let noise = map(512, 512, true, |row, column| 0.1 * field[row * 512 + column]);
    let clouds = Clouds::measure(&noise).expect("clouds");
    for ([from, to], found) in clouds.octaves().into_iter().skip(1) {
        // Wave numbers from 1/to to 1/from of a plane of one square wave number per cell.
        let area = std::f64::consts::PI * ((1e-3 / from).powi(2) - (1e-3 / to).powi(2));
        let (wanted, error) = (0.01 * area, found.standard_error.expect("an error"));
        assert!((found.mean - wanted).abs() < 4.0 * error + 0.06 * wanted, "{from} {found:?} {wanted}");
    }
    let texture = clouds.texture_md();
    assert!((texture.mean - 0.5).abs() < 4.0 * texture.standard_error.expect("an error"), "{texture:?}");
    // Parseval: nothing but the longest waves is left out.
    let whole = clouds.variance(0.0, f64::MAX).mean;
    assert!((whole / 0.01 - 1.0).abs() < 0.02, "{whole}");
}

/// Streaks that are longer than any cloud that is reported of have no part in the clouds, and a wave of the sheet
/// has all of its variance where it belongs, also where cells and the parts of the transform do not agree.
#[test]
fn analytic_long_streaks_do_not_leak_into_the_clouds() {
    for columns in [256, 300] {
        let streak = |column: usize| 0.4 * (TAU * column as f64 / columns as f64).sin();
        // Twelve waves along the web and five across it.
        let turn =
            |row: usize, column: usize| 12.0 * row as f64 / 400.0 + 5.0 * column as f64 / columns as f64;
        let map =
            map(columns, 400, true, |row, column| streak(column) + 0.1 * (TAU * turn(row, column)).cos());
        let clouds = Clouds::measure(&map).expect("clouds");
        let wave = 1e-3 / (12.0f64 / 400.0).hypot(5.0 / columns as f64);
        let found = clouds.variance(0.9 * wave, 1.1 * wave).mean;
        // Parts that cut across cells mix in a wave of the lattice: less than 1 %.
        assert!((found / 0.005 - 1.0).abs() < 0.01, "{found} of 0.005, {columns} columns");
        let rest = clouds.variance(0.0, 0.9 * wave).mean + clouds.variance(1.1 * wave, clouds.longest()).mean;
        assert!(rest < 1e-3 * 0.08, "{rest} of the streaks' 0.08 leaks, {columns} columns");
    }
}
