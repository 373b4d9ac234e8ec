//! How uneven a web is: the coefficient of variation of its basis weight over square patches.

use super::map::Map;
use crate::statistics::Estimate;

/// The unevenness over patches of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unevenness {
    /// Side of the square patches [m].
    pub patch: f64,
    /// Standard deviation of the basis weight of patches over its mean.
    pub cv: f64,
    /// Standard error of `cv`; none if the sheet is too small to say.
    pub standard_error: Option<f64>,
}

/// Parts of the sheet that are compared for the standard error, about so many.
const PARTS: f64 = 100.0;
/// Fewest parts that say something.
const FEWEST: usize = 8;
/// Fewest rows or columns of parts whose scatter counts.
const FEWEST_ROWS: usize = 4;
/// Shortest side of a part [sides of a patch].
const SHORTEST: usize = 2;

/// The coefficient of variation over patches of one side, at every place of the patch on the lattice of cells.
///
/// The standard error comes from the scatter of some hundred parts of the sheet, about as long as wide, each at least two
/// patches wide. They are nearly independent if they are larger than the clouds. If whole columns or rows of parts differ by
/// more than their parts would let expect, that scatter counts: filaments that come down at fixed places leave streaks. On a sheet that is not closed, the mean is known from the sheet only; the variance is
/// larger by that of the mean.
///
/// * `side` – of a patch [cells], at least one and within the sheet; None otherwise, and without any fibre
pub fn unevenness(map: &Map, side: usize) -> Option<Unevenness> {
    let sizes = [map.columns, map.rows];
    let mean = map.total() as f64 / map.cells.len() as f64 * (side * side) as f64;
    if side == 0 || sizes.iter().any(|size| side > *size) || mean <= 0.0 {
        return None;
    }
    let places = [0, 1].map(|of| if map.closed[of] { sizes[of] } else { sizes[of] - side + 1 });
    let parts = parts(places, side);
    let mut sums = Sums::new(parts);
    boxes(map, side, places, |row, boxes| {
        let row = row * parts[1] / places[1];
        for part in 0..parts[0] {
            let [from, to] = [part, part + 1].map(|part| (part * places[0]).div_ceil(parts[0]));
            sums.add(row * parts[0] + part, &boxes[from..to], mean);
        }
    });
    Some(sums.finish(map, side))
}

/// Number of parts in cross and machine direction.
fn parts(places: [usize; 2], side: usize) -> [usize; 2] {
    let part = (places[0] as f64 * places[1] as f64 / PARTS).sqrt().max((SHORTEST * side) as f64);
    places.map(|places| ((places as f64 / part).floor() as usize).max(1))
}

/// Passes on the quanta in all patches, row by row of their places.
pub(super) fn boxes(map: &Map, side: usize, places: [usize; 2], mut take: impl FnMut(usize, &[u64])) {
    let mut columns = vec![0u64; map.columns];
    for row in 0..side - 1 {
        add(&mut columns, map.row(row % map.rows));
    }
    let mut boxes = vec![0u64; places[0]];
    // On a closed sheet, the last patches reach beyond its edge.
    let within = (map.columns + 1 - side).min(places[0]);
    for row in 0..places[1] {
        add(&mut columns, map.row((row + side - 1) % map.rows));
        let mut sum: u64 = columns[..side - 1].iter().sum();
        let mut slide = |boxes: &mut [u64], first: &[u64], last: &[u64]| {
            for ((of, first), last) in boxes.iter_mut().zip(first).zip(last) {
                sum += last;
                *of = sum;
                sum -= first;
            }
        };
        let (inner, beyond) = boxes.split_at_mut(within);
        slide(inner, &columns, &columns[side - 1..]);
        slide(beyond, &columns[within..], &columns);
        take(row, &boxes);
        for (sum, cell) in columns.iter_mut().zip(map.row(row)) {
            *sum -= u64::from(*cell);
        }
    }
}

fn add(sums: &mut [u64], row: &[u32]) {
    for (sum, cell) in sums.iter_mut().zip(row) {
        *sum += u64::from(*cell);
    }
}

/// Sums over the parts of a sheet.
struct Sums {
    parts: [usize; 2],
    /// Of each part: number, sum of the relative deviations, of their squares.
    sums: Vec<(u64, f64, f64)>,
}

impl Sums {
    fn new(parts: [usize; 2]) -> Self {
        Self { parts, sums: vec![(0, 0.0, 0.0); parts[0] * parts[1]] }
    }

    fn add(&mut self, part: usize, boxes: &[u64], mean: f64) {
        let (mut sum, mut squares) = (0.0, 0.0);
        for weight in boxes {
            let deviation = *weight as f64 / mean - 1.0;
            sum += deviation;
            squares += deviation * deviation;
        }
        let of = &mut self.sums[part];
        *of = (of.0 + boxes.len() as u64, of.1 + sum, of.2 + squares);
    }

    /// Squared standard error of a mean over the sheet from its values over the parts: over all of them, and over their
    /// means along and across the sheet, because streaks reach through many parts. The largest counts.
    fn error_of_mean(&self, value: impl Fn(&(u64, f64, f64)) -> f64) -> f64 {
        let [across, along] = self.parts;
        let mean_of = |parts: &mut dyn Iterator<Item = usize>| {
            let (count, sum) = parts.fold((0.0, 0.0), |(n, sum), i| (n + 1.0, sum + value(&self.sums[i])));
            sum / count
        };
        let columns = (0..across).map(|i| mean_of(&mut (0..along).map(|j| j * across + i))).collect();
        let rows = (0..along).map(|j| mean_of(&mut (0..across).map(|i| j * across + i))).collect();
        let all = self.sums.iter().map(value).collect();
        let large_enough =
            [all, columns, rows].into_iter().filter(|values: &Vec<f64>| values.len() >= FEWEST_ROWS);
        let squares = large_enough.map(|values| Estimate::of(values).standard_error.unwrap_or(0.0).powi(2));
        squares.fold(0.0, f64::max)
    }

    fn finish(&self, map: &Map, side: usize) -> Unevenness {
        let count: u64 = self.sums.iter().map(|of| of.0).sum();
        let squares: f64 = self.sums.iter().map(|of| of.2).sum();
        let parts = self.parts[0] * self.parts[1];
        let known = parts >= FEWEST;
        let of_mean =
            if known && map.closed != [true; 2] { self.error_of_mean(|of| of.1 / of.0 as f64) } else { 0.0 };
        let cv = (squares / count as f64 + of_mean).sqrt();
        let standard_error =
            (known && cv > 0.0).then(|| self.error_of_mean(|of| of.2 / of.0 as f64).sqrt() / (2.0 * cv));
        Unevenness { patch: side as f64 * map.cell, cv, standard_error }
    }
}
