//! What the patches of filaments have in common with those of their neighbours.

use super::NEIGHBOURS;
use crate::map::Map;

/// Products of one filament with itself, its [`NEIGHBOURS`], the even and the odd ones, and with as much fibre
/// everywhere.
pub(super) type Known = [Option<f64>; NEIGHBOURS.len() + 3];

/// What the patches of one side of filaments have in common, over the squared mean patch of a filament.
#[derive(Clone, Debug, Default)]
pub(super) struct Products {
    /// Mean product of a filament and each of its [`NEIGHBOURS`].
    pub(super) means: [f64; NEIGHBOURS.len()],
    /// Of each of some pairs of neighbours, for both: the product with itself, with the next one, with the
    /// next but one, with those of its half, and with those of the other half; and its mass.
    pub(super) pairs: Vec<[[f64; 6]; 2]>,
}

impl Products {
    /// The variance of what they give of CV², because each filament hangs at a depth of its own: the sum of
    /// squares of what a filament at another depth would change, reported by neighbours.      theory.md (83e)
    ///
    /// What two filaments have in common by chance is in what either of them changes, so it would count twice. It
    /// is what the even and the odd ones do not give alike.
    ///
    /// A filament that comes down farther from the sheet on average has less fibre on it, and so has the mean of all.
    ///
    /// * `square` – CV² of all
    /// * `count`, `of_all` – number of the simulated filaments, and of those for which they stand
    pub(super) fn variance(&self, square: f64, count: f64, of_all: f64) -> f64 {
        let alone = |[itself, next, second, _, _, mass]: [f64; 6]| {
            let own = itself - 2.0 * (4.0 * next - second) / 3.0;
            (itself - (1.0 - count / of_all) * own) / (count * count) - 2.0 * (1.0 + square) * mass / count
        };
        let by_halves = |pair: &[[f64; 6]; 2]| {
            let [[itself, next, _, own, other, _], [its_self, _, _, its_own, its_other, _]] = *pair;
            let alone = 0.5 * (alone(pair[0]) - alone(pair[1]));
            let half = |one: f64, neighbour: f64| alone + 2.0 * (one - neighbour) / (count * count);
            [half(own - itself, its_other - next), half(other - next, its_own - its_self)]
        };
        let sums = self.pairs.iter().map(by_halves).fold([0.0; 2], |[whole, alike], [even, odd]| {
            [whole + (even + odd).powi(2), alike + 4.0 * even * odd]
        });
        let [whole, alike] = sums.map(|sum| 0.5 * count * sum / self.pairs.len() as f64);
        0.5 * (whole + alike.max(0.0))
    }
}

/// Sums of a map over all cells before a corner.
pub(super) struct CornerSums {
    pub(super) columns: usize,
    rows: usize,
    sums: Vec<u64>,
}

impl CornerSums {
    pub(super) fn over(map: &Map) -> Self {
        Self::around(map, 0, map.columns)
    }

    /// Over some columns of a map that goes on at its edges across, from a first one on.
    pub(super) fn around(map: &Map, first: i64, columns: usize) -> Self {
        let width = columns + 1;
        let first = first.rem_euclid(map.columns as i64) as usize;
        let mut sums = vec![0; width * (map.rows + 1)];
        for row in 0..map.rows {
            let mut of_row = 0;
            let cells = map.row(row)[first..].iter().chain(map.row(row).iter().cycle()).take(columns);
            let (above, below) = sums[row * width..][..2 * width].split_at_mut(width);
            for ((above, below), cell) in above[1..].iter().zip(&mut below[1..]).zip(cells) {
                of_row += u64::from(*cell);
                *below = above + of_row;
            }
        }
        Self { columns, rows: map.rows, sums }
    }

    /// One in each cell.
    pub(super) fn even(columns: usize, rows: usize) -> Self {
        let corner = |i: usize| (i / (columns + 1) * (i % (columns + 1))) as u64;
        Self { columns, rows, sums: (0..(columns + 1) * (rows + 1)).map(corner).collect() }
    }

    /// The sum over a patch.
    ///
    /// * `corner` – the index of its first corner
    fn patch(&self, corner: usize, side: usize) -> u64 {
        let below = corner + side * (self.columns + 1);
        self.sums[below + side] + self.sums[corner] - self.sums[below] - self.sums[corner + side]
    }
}

/// A patch of a map on which there is fibre.
struct Patch {
    /// The index of its first corner.
    corner: usize,
    mass: f64,
}

/// The patches of one side on a map on which there is fibre: a single filament leaves most of them empty.
pub(super) struct Patches {
    side: usize,
    all: Vec<Patch>,
}

/// How far the patches that are looked at are apart [cells].
fn step(side: usize) -> usize {
    (side / 2).max(1)
}

impl Patches {
    /// * `side` – of the patches [cells]
    pub(super) fn of(map: &CornerSums, side: usize) -> Self {
        let mut all = Vec::new();
        for row in (0..=map.rows - side).step_by(step(side)) {
            for column in (0..=map.columns - side).step_by(step(side)) {
                let corner = row * (map.columns + 1) + column;
                let mass = map.patch(corner, side);
                if mass > 0 {
                    all.push(Patch { corner, mass: mass as f64 });
                }
            }
        }
        Self { side, all }
    }

    /// Sum over all patches of their products with those of another map of the same size.
    pub(super) fn product(&self, other: &CornerSums) -> f64 {
        let mut sum = 0.0;
        for patch in &self.all {
            sum += patch.mass * other.patch(patch.corner, self.side) as f64;
        }
        let [all, step] = [other.rows - self.side + 1, step(self.side)];
        let taken = (other.rows - self.side) / step + 1;
        sum * step as f64 * all as f64 / taken as f64
    }
}
