//! What the camera does to a picture: noise from pixel to pixel, and blur.

use super::findings::SHARP;
use crate::map::Map;
use std::f64::consts::TAU;

/// The largest standard deviation that noise from pixel to pixel can have, relative to the mean: that of what
/// neighbouring pixels do not share. The finest structure of the web is in it, so the noise may be less.
///
/// Source: Immerkær, Fast noise variance estimation, Computer Vision and Image Understanding 64 (1996), with
/// the mean square.
pub(super) fn noise_at_most(map: &Map) -> f64 {
    let mean = map.total() as f64 / map.cells.len() as f64;
    let (mut squares, mut count) = (0.0, 0u64);
    for row in 1..map.rows - 1 {
        let [above, middle, below] = [row - 1, row, row + 1].map(|row| map.row(row));
        // The second difference down the picture, then that across.
        let down = |i: usize| f64::from(above[i]) - 2.0 * f64::from(middle[i]) + f64::from(below[i]);
        for column in 1..map.columns - 1 {
            squares += (down(column - 1) - 2.0 * down(column) + down(column + 1)).powi(2);
        }
        count += map.columns as u64 - 2;
    }
    // The squares of the weights of both differences add up to 36.
    (squares / (36.0 * count as f64)).sqrt() / mean
}

/// The map behind a blur of one more pixel: twice the binomial ¼, ½, ¼ in both directions, whose standard
/// deviation is one pixel.
pub(super) fn blurred(map: &Map) -> Map {
    let mut cells = map.cells.clone();
    for _ in 0..2 {
        for row in cells.chunks_exact_mut(map.columns) {
            let mut before = row[0];
            for column in 0..row.len() {
                let cell = row[column];
                let after = row.get(column + 1).copied().unwrap_or(cell);
                row[column] = binomial(before, cell, after);
                before = cell;
            }
        }
        let mut before = cells[..map.columns].to_vec();
        for row in 0..map.rows {
            for (column, before) in before.iter_mut().enumerate() {
                let at = row * map.columns + column;
                let cell = cells[at];
                let after = cells.get(at + map.columns).copied().unwrap_or(cell);
                cells[at] = binomial(*before, cell, after);
                *before = cell;
            }
        }
    }
    Map { cells, ..map.clone() }
}

fn binomial(before: u32, middle: u32, after: u32) -> u32 {
    let sum = u64::from(before) + 2 * u64::from(middle) + u64::from(after);
    // A mean of numbers is no larger than they are.
    ((sum + 2) / 4) as u32
}

/// The shortest wave that a picture shows sharply [m]: one more pixel of blur lowers its amplitude by one per
/// cent, as it does for the smallest patches that have an interval. A Gaussian blur of σ takes
/// `exp(−(2πσ/λ)²/2)` of a wave.
///
/// * `pixel` – side of a pixel [m]
pub fn shortest_sharp_wave(pixel: f64) -> f64 {
    TAU * pixel / (2.0 * SHARP).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_blur_of_one_pixel_keeps_the_mass_and_has_the_spread() {
        let side = 21;
        let mut cells = vec![0; side * side];
        cells[10 * side + 10] = 256_000;
        let point = Map { columns: side, rows: side, cell: 1.0, quantum: 1.0, closed: [false; 2], cells };
        let blurred = blurred(&point);
        assert_eq!(blurred.total(), point.total());
        let spread = |place: fn(usize) -> usize| {
            let squares = blurred.cells.iter().enumerate();
            let squares = squares.map(|(i, mass)| (place(i) as f64 - 10.0).powi(2) * f64::from(*mass));
            squares.sum::<f64>() / point.total() as f64
        };
        assert_eq!([spread(|i| i % 21), spread(|i| i / 21)], [1.0, 1.0]);
    }
    #[test]
    fn the_shortest_sharp_wave_loses_one_per_cent_by_a_pixel_of_blur() {
        let pixel = 0.1;
        let wave = shortest_sharp_wave(pixel);
        let side = 500;
        let value = |column: usize| 1e6 * (2.0 + (TAU * (column as f64 * pixel) / wave).cos());
        let cells = (0..3 * side).map(|at| value(at % side) as u32).collect();
        let map = Map { columns: side, rows: 3, cell: pixel, quantum: 1.0, closed: [false; 2], cells };
        let amplitude = |map: &Map| {
            let inner = &map.row(1)[50..450];
            f64::from(inner.iter().max().unwrap() - inner.iter().min().unwrap())
        };
        let lost = 1.0 - amplitude(&blurred(&map)) / amplitude(&map);
        assert!((lost / SHARP - 1.0).abs() < 0.02, "{lost}");
    }
}
