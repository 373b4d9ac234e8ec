//! Thin and thick places: how often a patch of the web is much lighter or heavier than the mean.

use crate::ground::Known;
use crate::web::map::Map;
use crate::web::map::uniformity::{boxes, places_of_patches};

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
/// Most blocks of the sheet each way, whose scatter gives the errors, the fewest that give one, and the
/// shortest block in patches.
const MOST_BLOCKS: usize = 8;
const FEWEST_BLOCKS: usize = 9;
const BLOCK: usize = 2;
/// Upper 95 % bound of the mean of a Poisson number that has come out zero.
pub(crate) const NONE_FOUND: f64 = 3.0;

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
pub fn thin_places(map: &Map, side: usize) -> Option<ThinPlaces> {
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
    let weights = Weights::new(classes);
    let patch = side as f64 * map.cell;
    let (area, whole) = (patch * patch, (map.columns * map.rows) as f64 * map.cell * map.cell);
    let per_area = |share: Known| match share {
        Known::Value(0.0, _) => Known::AtMost(NONE_FOUND / whole),
        // Less than one on the sheet is chance, as large as that of so small a count.
        Known::Value(share, error) if share * whole < area => {
            let least = (share * area / whole).sqrt();
            Known::Value(share, error.map(|error| error.max(least))).times(1.0 / area)
        }
        share => share.times(1.0 / area),
    };
    Some(ThinPlaces {
        patch,
        lighter: LIGHTER.map(|share| per_area(weights.below(share * CLASSES_PER_MEAN))),
        heavier: per_area(weights.above(HEAVIER * CLASSES_PER_MEAN)),
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

/// Weights over their mean of patches side by side, whose side is about this: the nearest whole number of cells.
pub(super) fn weights(map: &Map, patch: f64) -> Vec<f64> {
    let side = ((patch / map.cell).round().max(1.0) as usize).min(map.columns.min(map.rows));
    let (_, sums) = map.squares(side);
    let mean = sums.iter().sum::<u64>() as f64 / sums.len() as f64;
    sums.into_iter().map(|sum| sum as f64 / mean).collect()
}

/// Sums of the classes of each block up to the edge before a class, as shares of the patches of the block,
/// and those of all patches.
struct Weights {
    blocks: Vec<Vec<f64>>,
    all: Vec<f64>,
}

impl Weights {
    fn new(classes: Vec<Vec<u32>>) -> Self {
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
        Self { blocks: classes.iter().map(|block| sums(&wide(block))).collect(), all: sums(&all) }
    }

    /// The share below an edge of the classes, which may lie between two.
    fn at(below: &[f64], edge: f64) -> f64 {
        // Edges at whole numbers are met exactly, whatever rounding does to them.
        let near = edge.round();
        let edge = if (edge - near).abs() < 1e-6 { near } else { edge }.clamp(0.0, CLASSES as f64);
        let number = (edge as usize).min(CLASSES - 1);
        below[number] + (edge - number as f64) * (below[number + 1] - below[number])
    }

    /// Standard error of the share below an edge, from the scatter of the blocks.
    fn error(&self, edge: f64) -> Option<f64> {
        let count = self.blocks.len() as f64;
        let mean = Self::at(&self.all, edge);
        let squares: f64 = self.blocks.iter().map(|block| (Self::at(block, edge) - mean).powi(2)).sum();
        (self.blocks.len() >= FEWEST_BLOCKS).then(|| (squares / (count - 1.0) / count).sqrt())
    }

    fn below(&self, edge: f64) -> Known {
        Known::Value(Self::at(&self.all, edge), self.error(edge))
    }

    fn above(&self, edge: f64) -> Known {
        Known::Value(1.0 - Self::at(&self.all, edge), self.error(edge))
    }

    /// The weight over the mean of which a share is lighter. Its error is that of the share over the density
    /// of the weights there.
    fn quantile(&self, share: f64) -> Known {
        let number = self.all.partition_point(|below| *below < share).clamp(1, CLASSES) - 1;
        let [low, high] = [self.all[number], self.all[number + 1]];
        let edge = number as f64 + if high > low { (share - low) / (high - low) } else { 0.0 };
        let density = (Self::at(&self.all, edge + NEAR) - Self::at(&self.all, edge - NEAR)) / (2.0 * NEAR);
        let error = self.error(edge).filter(|_| density > 0.0).map(|error| error / density);
        Known::Value(edge, error).times(1.0 / CLASSES_PER_MEAN)
    }
}
