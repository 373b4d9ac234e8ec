//! Thin and thick places: how often a patch of the web is much lighter or heavier than the mean.

use super::{Deviations, MapUncertainty};
use crate::map::Map;
use crate::map::lattice::Lattice;
use crate::map::uniformity::{boxes, places_of_patches};
use spunlaid_ground::Known;
use spunlaid_ground::statistics::dot;

/// Patches are counted that are lighter than these shares of the mean, and heavier than this one.
pub(crate) const LIGHTER: [f64; 3] = [0.5, 0.7, 0.8];
/// See [`LIGHTER`].
pub(crate) const HEAVIER: f64 = 1.3;
/// Shares of the patches that are lighter than a quantile.
pub(crate) const QUANTILES: [f64; 5] = [0.01, 0.05, 0.5, 0.95, 0.99];

/// Classes of the weight of a patch over the mean, and their number; heavier ones fall into the last one.
const CLASSES_PER_MEAN: f64 = 100.0;
const CLASSES: usize = 600;
/// Classes to either side over which the density at a quantile is found.
const NEAR: f64 = 2.0;
/// Most blocks of the sheet each way, and the shortest block in patches.
const MOST_BLOCKS: usize = 24;
const BLOCK: usize = 2;
/// So many powers of the correlation of a normal field, from the second on, make the error of a share.
const POWERS: usize = 12;
/// Upper 95 % bound of the mean of a Poisson number that has come out zero.
pub const NONE_FOUND: f64 = 3.0;

/// The weights of the patches of one size.
#[derive(Clone, Debug, PartialEq)]
pub struct ThinPlaces {
    /// Side of the square patches [m].
    pub patch: f64,
    /// Patches per area that are lighter than the shares `LIGHTER` of the mean [1/m²].
    pub lighter: [Known; LIGHTER.len()],
    /// Patches per area that are heavier than `HEAVIER` of the mean [1/m²].
    pub heavier: Known,
    /// The weights, over the mean, of which the shares `QUANTILES` of the patches are lighter.
    pub quantiles: [Known; QUANTILES.len()],
}

/// The weights of all patches of one side, at every place of the patch on the lattice of cells.
///                                                                                            theory.md (103)
///
/// * `side` – of a patch [cells]; None unless two fit on the map each way, and without any fibre
/// * `of` – what is known of the map
pub fn thin_places(map: &Map, side: usize, of: MapUncertainty) -> Option<ThinPlaces> {
    let (places, mean) = places_of_patches(map, side).filter(|_| 2 * side <= map.columns.min(map.rows))?;
    let blocks = places.map(|places| (places / (BLOCK * side)).clamp(1, MOST_BLOCKS));
    let mut classes = vec![vec![0u32; CLASSES]; blocks[0] * blocks[1]];
    let per_mean = CLASSES_PER_MEAN / mean;
    boxes(map, side, places, |row, boxes| {
        let row = row * blocks[1] / places[1];
        for (column, classes) in classes[row * blocks[0]..][..blocks[0]].iter_mut().enumerate() {
            let [from, to] = [column, column + 1].map(|column| column * places[0] / blocks[0]);
            for weight in &boxes[from..to] {
                classes[((*weight as f64 * per_mean) as usize).min(CLASSES - 1)] += 1;
            }
        }
    });
    let weights = Weights::new(classes, Lattice { sides: blocks, chance: of.chance }, of.deviations);
    let patch = side as f64 * map.cell;
    let area = patch * patch;
    let whole = (map.columns * map.rows) as f64 * map.cell * map.cell;
    let per_area = |share: Known| match share {
        // Where the map may be too even, there are as many as if it were not.
        Known::Value(0.0, error) if of.deviations.is_some() => {
            Known::AtMost(NONE_FOUND / whole + error.unwrap_or(0.0) / area)
        }
        // Less than one on the sheet is chance, as large as that of so small a count.
        Known::Value(share, error) if share * whole < area => {
            let least = (share * area / whole).sqrt();
            Known::Value(share, error.map(|error| error.max(least))).times(1.0 / area)
        }
        share => share.times(1.0 / area),
    };
    Some(ThinPlaces {
        patch,
        lighter: LIGHTER.map(|share| per_area(weights.share(share * CLASSES_PER_MEAN, false))),
        heavier: per_area(weights.share(HEAVIER * CLASSES_PER_MEAN, true)),
        quantiles: QUANTILES.map(|share| weights.quantile(share)),
    })
}

/// The lightest patches of one side at any place of the lattice of cells, with at least half a side between
/// them, the lightest first: their first column and row, and their weight over the mean.
///
/// * `side` – of a patch [cells], within the map
pub(super) fn lightest(map: &Map, side: usize, most: usize) -> Vec<([usize; 2], f64)> {
    let mean = map.total() as f64 / map.cells.len() as f64 * (side * side) as f64;
    let places = [map.columns, map.rows].map(|cells| cells - side + 1);
    let mut found: Vec<([usize; 2], u64)> = Vec::new();
    while found.len() < most {
        let mut next: Option<([usize; 2], u64)> = None;
        boxes(map, side, places, |row, boxes| {
            for (column, weight) in boxes.iter().enumerate() {
                let is_far = |(at, _): &([usize; 2], u64)| {
                    2 * at[0].abs_diff(column).max(at[1].abs_diff(row)) > 3 * side
                };
                if next.is_none_or(|(_, least)| *weight < least) && found.iter().all(is_far) {
                    next = Some(([column, row], *weight));
                }
            }
        });
        let Some(next) = next.filter(|_| mean > 0.0) else { break };
        found.push(next);
    }
    found.into_iter().map(|(at, weight)| (at, weight as f64 / mean)).collect()
}

/// Patches side by side whose side is about this, the nearest whole number of cells: how many there are across and
/// along, and their weights over the mean.
pub(super) fn weights(map: &Map, patch: f64) -> ([usize; 2], Vec<f64>) {
    let side = ((patch / map.cell).round().max(1.0) as usize).min(map.columns.min(map.rows));
    let (sides, sums) = map.squares(side);
    let mean = sums.iter().sum::<u64>() as f64 / sums.len() as f64;
    (sides, sums.into_iter().map(|sum| sum as f64 / mean).collect())
}

/// Sums of the classes of each block up to the edge before a class, as shares of the patches of the block,
/// and those of all patches.
struct Weights {
    blocks: Vec<Vec<f64>>,
    all: Vec<f64>,
    /// Deviation of the mean weight of each block from that of all, over it.
    means: Vec<f64>,
    lattice: Lattice,
    /// Sampling error of the CV, as a fraction of it, and what the map is off.
    by_chance: f64,
    deviations: Option<Deviations>,
    /// Of the correlation.
    powers: [f64; POWERS],
}

impl Weights {
    fn new(classes: Vec<Vec<u32>>, lattice: Lattice, deviations: Option<Deviations>) -> Self {
        let sums = |classes: &[u64]| {
            let whole = classes.iter().sum::<u64>().max(1) as f64;
            let mut sum = 0;
            let mut below = vec![0.0];
            below.extend(classes.iter().map(|count| {
                sum += count;
                sum as f64 / whole
            }));
            below
        };
        let wide = |classes: &Vec<u32>| classes.iter().map(|count| u64::from(*count)).collect::<Vec<_>>();
        let all: Vec<u64> =
            (0..CLASSES).map(|i| classes.iter().map(|block| u64::from(block[i])).sum()).collect();
        let (blocks, all): (Vec<Vec<f64>>, _) =
            (classes.iter().map(|block| sums(&wide(block))).collect(), sums(&all));
        // The mean of a distribution is the sum of what lies above.
        let mean = |below: &Vec<f64>| below.iter().map(|below| 1.0 - below).sum::<f64>();
        let means = blocks.iter().map(|block| mean(block) / mean(&all) - 1.0).collect();
        let by_chance = deviations.map_or(0.0, |of| of.by_chance);
        let deviations = deviations.map(|of| Deviations { by_chance: 0.0, ..of });
        let powers = [0.0; POWERS];
        let mut weights = Self { blocks, all, means, lattice, by_chance, deviations, powers };
        weights.find_powers();
        weights
    }

    /// The share below an edge of the classes, which may lie between two.
    fn at(below: &[f64], edge: f64) -> f64 {
        // Edges at whole numbers are met exactly, whatever rounding does to them.
        let near = edge.round();
        let edge = if (edge - near).abs() < 1e-6 { near } else { edge }.clamp(0.0, CLASSES as f64);
        let number = (edge as usize).min(CLASSES - 1);
        below[number] + (edge - number as f64) * (below[number + 1] - below[number])
    }

    /// The density of the weights at an edge, in the share of a class.
    fn density(&self, edge: f64) -> f64 {
        (Self::at(&self.all, edge + NEAR) - Self::at(&self.all, edge - NEAR)) / (2.0 * NEAR)
    }

    /// Sampling error of the fraction below an edge: by the blocks, and as of a normal field, which is the
    /// larger one in the tails, of which a map holds few clouds.
    fn error(&self, edge: f64) -> Option<f64> {
        let share = Self::at(&self.all, edge);
        // Of a rare share it is no more than the share: rare patches of one map say little of the density there.
        let of_normal = (self.of_normal(edge) * self.density(edge)).min(share.min(1.0 - share));
        Some(self.by_blocks(edge)?.max(of_normal))
    }

    /// The first of these errors. Where all is heavier, so are the edges, which follow the mean.
    fn by_blocks(&self, edge: f64) -> Option<f64> {
        let share = Self::at(&self.all, edge);
        let per_mean = edge * self.density(edge);
        let off = |(block, mean): (&Vec<f64>, &f64)| Self::at(block, edge) - share + per_mean * mean;
        let influence: Vec<f64> = self.blocks.iter().zip(&self.means).map(off).collect();
        self.lattice.error_of_mean(&influence, &self.means)
    }

    /// Standard error of the weight below which a normal field has a fixed share [classes]. The share is a sum over
    /// Hermite polynomials of the field, and the variance of the n-th one is the mean of the n-th power of the
    /// correlation. The first one is the mean, the second one that of the CV, whose error is known. (103c)
    fn of_normal(&self, edge: f64) -> f64 {
        let deviation = self.deviation();
        let z = (edge - CLASSES_PER_MEAN) / deviation;
        let mut before = 1.0;
        let mut hermite = z;
        let mut factorial = 1.0;
        let mut sum = 0.0;
        for (n, power) in (2..).map(f64::from).zip(&self.powers) {
            factorial *= n;
            sum += hermite * hermite / factorial * power;
            (before, hermite) = (hermite, z * hermite - (n - 1.0) * before);
        }
        let of_cv = self.powers[0];
        if of_cv > 0.0 { deviation * self.by_chance * (2.0 * sum.max(0.0) / of_cv).sqrt() } else { 0.0 }
    }

    /// Means of the second, third and further powers of the correlation of the blocks over all their distances.
    fn find_powers(&mut self) {
        let [columns, rows] = self.lattice.sides;
        let variance = (self.deviation() / CLASSES_PER_MEAN).powi(2);
        let at = |row: usize| &self.means[row % rows * columns..][..columns];
        let mut powers = [0.0; POWERS];
        for (along, across) in (0..rows).flat_map(|along| (0..columns).map(move |across| (along, across))) {
            let product: f64 = (0..rows)
                .map(|row| {
                    let one = at(row);
                    let [end, begin] = [&at(row + along)[..across], &at(row + along)[across..]];
                    dot(&one[..columns - across], begin) + dot(&one[columns - across..], end)
                })
                .sum();
            let correlation = product / (columns * rows) as f64 / variance;
            let mut power = correlation;
            for sum in &mut powers {
                power *= correlation;
                *sum += power / (columns * rows) as f64;
            }
        }
        self.powers = powers;
    }

    /// Standard deviation of the weights [classes].
    fn deviation(&self) -> f64 {
        let shares = self.all.windows(2).enumerate();
        let squares =
            shares.map(|(class, of)| (of[1] - of[0]) * (class as f64 + 0.5 - CLASSES_PER_MEAN).powi(2));
        squares.sum::<f64>().sqrt().max(0.5)
    }

    /// The share below or above an edge.
    fn share(&self, edge: f64, is_above: bool) -> Known {
        let share = |edge: f64| match Self::at(&self.all, edge) {
            below if is_above => 1.0 - below,
            below => below,
        };
        let change = |by: f64| share(CLASSES_PER_MEAN + (edge - CLASSES_PER_MEAN) / (1.0 + by)) - share(edge);
        // None found has its own bound of chance.
        let by_chance = if share(edge) > 0.0 { self.error(edge) } else { Some(0.0) };
        Deviations::add(self.deviations, Known::Value(share(edge), by_chance), change)
    }

    /// The weight over the mean of which a share is lighter. Its error is that of the share over the density of the
    /// weights there, and that of a normal field.
    fn quantile(&self, share: f64) -> Known {
        let number = self.all.partition_point(|below| *below < share).clamp(1, CLASSES) - 1;
        let [low, high] = [self.all[number], self.all[number + 1]];
        let edge = number as f64 + if high > low { (share - low) / (high - low) } else { 0.0 };
        let density = self.density(edge);
        let by_blocks = self.by_blocks(edge).filter(|_| density > 0.0);
        let error = by_blocks.map(|error| (error / density).max(self.of_normal(edge)));
        let change = |by: f64| (edge - CLASSES_PER_MEAN) * by;
        Deviations::add(self.deviations, Known::Value(edge, error), change).times(1.0 / CLASSES_PER_MEAN)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::map::lattice::Chance;

    const OF_CV: f64 = 0.04;

    /// Six blocks, in each of which so many patches lie in classes below and above the mean.
    ///
    /// * `sides` – numbers of blocks across and along
    fn weights(sides: [usize; 2]) -> Weights {
        let counts = [[6, 1, 3], [2, 7, 1], [4, 4, 2], [1, 3, 6], [5, 0, 5], [2, 5, 3]];
        let block = |counts: &[u32; 3]| {
            let mut classes = vec![0; CLASSES];
            for (class, count) in [80, 99, 125].into_iter().zip(counts) {
                classes[class] = *count;
            }
            classes
        };
        let chance = Chance { closed: [true, false], streaks: true };
        let deviations = Some(Deviations { by_chance: OF_CV, of_map: 0.02 });
        Weights::new(counts.iter().map(block).collect(), Lattice { sides, chance }, deviations)
    }

    fn close(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-11 * expected.abs().max(1.0), "{found} {expected}");
    }

    /// Twenty of sixty patches lie in each class: what lies below an edge is a line within it.
    #[test]
    fn analytic_what_patches_of_three_classes_weigh() {
        let weights = weights([3, 2]);
        for (edge, below) in [
            (-3.0, 0.0),
            (80.0, 0.0),
            (80.25, 0.25 / 3.0),
            (81.0, 1.0 / 3.0),
            // Rounding does not miss an edge.
            (81.0 - 1e-7, 1.0 / 3.0),
            (99.0, 1.0 / 3.0),
            (99.6, 1.6 / 3.0),
            (100.0, 2.0 / 3.0),
            (125.5, 2.5 / 3.0),
            (126.0, 1.0),
            (900.0, 1.0),
        ] {
            close(Weights::at(&weights.all, edge), below);
            close(weights.share(edge, false).value(), below);
            close(weights.share(edge, true).value(), 1.0 - below);
        }
        close(weights.density(82.0), 1.0 / 12.0);
        close(weights.density(90.0), 0.0);
        close(weights.density(99.5), 1.0 / 12.0);
        let deviation = ((19.5_f64.powi(2) + 0.5_f64.powi(2) + 25.5_f64.powi(2)) / 3.0).sqrt();
        close(weights.deviation(), deviation);
        for (part, edge) in [(0.1, 80.3), (0.5, 99.5), (2.0 / 3.0, 100.0), (0.9, 125.7), (1.0, 126.0)] {
            close(weights.quantile(part).value(), edge / 100.0);
        }
        // Means of the blocks over that of all, each as if its patches lay at the upper ends of their classes.
        let mean = (81.0 + 100.0 + 126.0) / 3.0;
        close(weights.means[0], (6.0 * 81.0 + 100.0 + 3.0 * 126.0) / 10.0 / mean - 1.0);
        close(weights.means[4], (81.0 + 126.0) / 2.0 / mean - 1.0);
    }

    /// Correlations of the blocks against all pairs of them, around the web and along it, and what they make of the
    /// sampling error of a fraction: He₁ to He₄ by their closed forms.
    #[test]
    fn analytic_the_sampling_error_of_a_fraction_of_a_normal_field() {
        for [columns, rows] in [[3, 2], [2, 3], [6, 1]] {
            let weights = weights([columns, rows]);
            let variance = (weights.deviation() / 100.0).powi(2);
            let correlation = |across: usize, along: usize| {
                let other =
                    |i: usize| (i % columns + across) % columns + columns * ((i / columns + along) % rows);
                let products = (0..6).map(|i| weights.means[i] * weights.means[other(i)]);
                products.sum::<f64>() / 6.0 / variance
            };
            for (power, found) in (2..).zip(weights.powers) {
                let all =
                    (0..6).map(|i| correlation(i % columns, i / columns).powi(power)).sum::<f64>() / 6.0;
                assert!((found / all - 1.0).abs() < 1e-9, "{power}: {found} {all}");
            }
        }
        let mut weights = weights([6, 1]);
        weights.powers = [0.0; POWERS];
        weights.powers[..4].copy_from_slice(&[0.5, 0.3, 0.2, 0.1]);
        let deviation = weights.deviation();
        let of_normal = |edge: f64| {
            let z = (edge - 100.0) / deviation;
            let hermite = [z, z * z - 1.0, z.powi(3) - 3.0 * z, z.powi(4) - 6.0 * z * z + 3.0];
            let parts = hermite.iter().zip([2.0, 6.0, 24.0, 120.0]).zip([0.5, 0.3, 0.2, 0.1]);
            let sum: f64 =
                parts.map(|((hermite, factorial), power)| hermite * hermite / factorial * power).sum();
            deviation * OF_CV * (2.0 * sum / 0.5).sqrt()
        };
        for edge in [50.0, 70.0, 99.5, 100.0, 130.0] {
            close(weights.of_normal(edge), of_normal(edge));
        }
        // At least that of the blocks; of a rare fraction no more than the fraction, and of a common one than the rest.
        for (edge, part) in
            [(80.1, 0.1 / 3.0), (80.9, 0.3), (99.5, 0.5), (125.2, 0.8 / 3.0), (125.9, 0.1 / 3.0)]
        {
            let least = (of_normal(edge) * weights.density(edge)).min(part);
            let expected = weights.by_blocks(edge).map(|error| error.max(least));
            close(weights.error(edge).unwrap_or(-1.0), expected.unwrap_or(-1.0));
        }
        let by_blocks = |edge: f64| weights.by_blocks(edge).unwrap();
        // A quantile moves by the error of the fraction over the density, and with the deviations of the map.
        let Known::Value(_, Some(error)) = weights.quantile(0.5) else { panic!("no error") };
        let own = (by_blocks(99.5) / weights.density(99.5)).max(of_normal(99.5)) / 100.0;
        close(error, own.hypot(0.5 * 0.02 / 100.0));
        // What each block has beyond all, less what its mean weight alone would make of it.
        let of_block = |i: usize, part: f64| part - 0.5 + 99.5 / 12.0 * weights.means[i];
        let influence =
            [0.65, 0.55, 0.6, 0.25, 0.5, 0.45].iter().enumerate().map(|(i, part)| of_block(i, *part));
        let expected = weights.lattice.error_of_mean(&influence.collect::<Vec<_>>(), &weights.means);
        close(by_blocks(99.5), expected.unwrap());
        weights.powers[0] = 0.0;
        assert_eq!(weights.of_normal(70.0), 0.0);
    }

    /// Against sums of all cells of a small map: the lightest position, and the next one that is 1.5 sides away.
    #[test]
    fn analytic_the_lightest_positions_are_apart() {
        let columns = 14;
        let rows = 11;
        let side = 2;
        let cells: Vec<u32> = (0..columns * rows).map(|i| 50 + (i * i * 17 % 101) as u32).collect();
        let map = Map { columns, rows, cell: 1e-3, quantum: 1.0, closed: [true; 2], cells };
        let weight = |[column, row]: [usize; 2]| -> f64 {
            (0..4).map(|i| f64::from(map.row(row + i / 2)[column + i % 2])).sum()
        };
        let mut positions: Vec<[usize; 2]> =
            (0..columns - 1).flat_map(|column| (0..rows - 1).map(move |row| [column, row])).collect();
        let mean = 4.0 * map.total() as f64 / map.cells.len() as f64;
        let found = lightest(&map, side, 6);
        assert_eq!(found.len(), 6);
        for (at, part) in found {
            let least = positions.iter().map(|at| weight(*at)).fold(f64::INFINITY, f64::min);
            close(part, least / mean);
            close(weight(at), least);
            positions.retain(|other| other[0].abs_diff(at[0]).max(other[1].abs_diff(at[1])) > 3);
        }
        assert!(lightest(&Map { cells: vec![0; 154], ..map }, side, 6).is_empty());
    }
}
