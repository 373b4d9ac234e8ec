//! What the patches of filaments have in common with those of their neighbours.

use super::NEIGHBOURS;

/// Products of one filament with itself, its [`NEIGHBOURS`] and all, and with as much fibre everywhere.
pub(super) type Known = [Option<f64>; NEIGHBOURS.len() + 2];

/// What the patches of one side of filaments have in common, over the squared mean patch of a filament.
#[derive(Clone, Debug, Default)]
pub(super) struct Products {
    /// Mean product of a filament and each of its [`NEIGHBOURS`].
    pub(super) means: [f64; NEIGHBOURS.len()],
    /// Of each of some pairs of neighbours, for both: the product with itself, with the next one, with the
    /// next but one, and with all; and its mass.
    pub(super) pairs: Vec<[[f64; 5]; 2]>,
}

impl Products {
    /// The variance of what they tell of CV², because each filament hangs at a depth of its own: the sum of
    /// squares of what a filament at another depth would change, told by neighbours.      theory.md (83e)
    ///
    /// A filament that comes down farther from the sheet in the mean has less fibre on it, and so has the mean of all.
    ///
    /// * `square` – CV² of all
    /// * `count`, `of_all` – number of the flown filaments, and of those for which they stand
    pub(super) fn variance(&self, square: f64, count: f64, of_all: f64) -> f64 {
        let weight = |[itself, next, second, all, mass]: [f64; 5]| {
            let own = itself - 2.0 * (4.0 * next - second) / 3.0;
            let products = (2.0 * all - itself - (1.0 - count / of_all) * own) / (count * count);
            products - 2.0 * (1.0 + square) * mass / count
        };
        let squares = self.pairs.iter().map(|pair| 0.5 * (weight(pair[0]) - weight(pair[1])).powi(2));
        count * squares.sum::<f64>() / self.pairs.len() as f64
    }
}
