//! How far the CV of one piece of web may be from that of the web.

use crate::map::Map;
use crate::map::lattice::{Chance, Lattice, waves};
use spunlaid_ground::{Estimate, NORMAL_95};

/// A piece of a web, of which nothing else is known.
pub(crate) const PIECE: Chance = Chance { closed: [false; 2], streaks: true };

/// The variance of the basis weight over patches of one size, relative to the squared mean, and how well a
/// piece of web contains it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scatter {
    /// About the mean of the web, of which this is a piece.
    pub(super) variance: f64,
    /// Squared standard error of the variance.
    error: f64,
    /// Ends of the 95 % interval of the variance.
    ends: [f64; 2],
}

/// Most blocks either way. Waves longer than two of them are looked at one by one.
const BLOCKS: usize = 48;
/// Fewest blocks either way that say something about chance.
const FEWEST: usize = 4;
/// Longest waves that give how the mean of the piece scatters.
const LONGEST: usize = 3;
/// So many neighbours either way give the expected strength of a wave.
const NEAR: usize = 2;
/// A sum of waves of unequal strength, which is known from the waves of one piece only, is known as well as
/// from this share of its degrees: found on simulated webs, docs/validation.md.
const UNEQUAL: f64 = 0.7;
/// A patch counts if at least this share of its cells is web.
const WEB: f64 = 0.9;

/// The scatter over the patches of one side, at every place on the lattice of cells.          theory.md (76), (77)
///
/// The variance is a sum over waves. Those across the web, which stand for streaks, are few; so are those
/// along it; all others are many. Each kind is known as well as its number of waves allows, and the interval
/// of the sum is made of theirs.
///
/// * `masked` – cells that are not web; empty if all are
/// * `side` – of a patch [cells]
///
/// None if the map is too small for such patches, or hardly any of them is web.
///
/// Source: Graybill and Wang, Journal of the American Statistical Association 75 (1980) 869–873, for the
/// interval of a sum of variances.
pub(super) fn scatter(map: &Map, masked: &[bool], side: usize) -> Option<Scatter> {
    let blocks = Blocks::new(map, masked, side)?;
    if blocks.sides.iter().any(|side| *side < FEWEST) {
        let ends = [0.0, f64::INFINITY];
        return (blocks.variance > 0.0).then_some(Scatter {
            variance: blocks.variance,
            error: f64::INFINITY,
            ends,
        });
    }
    let waves = blocks.waves();
    let [across, along] = blocks.sides;
    let mut streaks: Vec<f64> = (1..across).map(|i| waves[i]).collect();
    let mut bars: Vec<f64> = (1..along).map(|j| waves[j * across]).collect();
    // The infinitely long wave is missing: the mean of the piece is not that of the web. It is as strong as
    // the next ones, along that direction in which they are stronger, because streaks reach through the whole
    // piece.
    let mean_beside =
        |wave: &dyn Fn(usize) -> usize| (1..=LONGEST).map(|k| waves[wave(k)]).sum::<f64>() / LONGEST as f64;
    let beside_streaks: Vec<f64> = (1..across).map(|i| mean_beside(&|k| k * across + i)).collect();
    let beside_bars: Vec<f64> = (1..along).map(|j| mean_beside(&|k| j * across + k)).collect();
    let mean_of = |waves: &[f64]| waves[..LONGEST].iter().sum::<f64>() / LONGEST as f64;
    let stronger = if mean_of(&streaks) > mean_of(&bars) { &mut streaks } else { &mut bars };
    stronger[..LONGEST].iter_mut().for_each(|wave| *wave *= 1.0 + 1.0 / LONGEST as f64);
    let rest = || (across..across * along).filter(|at| at % across != 0).map(|at| waves[at]);
    let (apart, fourth) = rest().fold((0.0, 0.0), |(sum, squares), wave| (sum + wave, squares + wave * wave));
    let fine = (blocks.variance - waves[1..].iter().sum::<f64>()).max(0.0);
    // The square of a normal number has the variance 2 and the mean square 3.
    let rest = apart + fine;
    let parts = [
        (streaks.iter().sum(), degrees(&streaks, &beside_streaks)),
        (bars.iter().sum(), degrees(&bars, &beside_bars)),
        (rest, 2.0 * rest * rest / (2.0 / 3.0 * fourth + blocks.error_within)),
    ];
    let variance: f64 = parts.iter().map(|part: &(f64, f64)| part.0).sum();
    if variance.is_nan() || variance <= 0.0 {
        return None;
    }
    let sum = |share: &dyn Fn(f64) -> f64| -> f64 {
        let parts = parts.iter().filter(|part| part.0 > 0.0);
        parts.map(|(variance, degrees)| (variance * share(degrees.max(1.0))).powi(2)).sum()
    };
    let [below, above] =
        [0.975, 0.025].map(|share| sum(&|degrees| degrees / chi_squared(share, degrees) - 1.0).sqrt());
    let ends = [(variance - below).max(0.0), variance + above];
    Some(Scatter { variance, error: sum(&|degrees| (2.0 / degrees).sqrt()), ends })
}

/// Degrees of freedom of the sum of waves that stand in a line: `(Σλ)²/Σλ²` of their expected strengths, each
/// the mean of its neighbours above the floor that all waves share. Shares of few waves are unequal by
/// chance, which counts two degrees too many.
///
/// * `floor` – strength of the waves beside each, which are not of this line
fn degrees(waves: &[f64], floor: &[f64]) -> f64 {
    let above: Vec<f64> = waves.iter().zip(floor).map(|(wave, floor)| wave - floor).collect();
    let expected = |i: usize| {
        let near = &above[i.saturating_sub(NEAR)..(i + NEAR + 1).min(above.len())];
        (near.iter().sum::<f64>() / near.len() as f64).max(0.0)
    };
    let (sum, squares) = (0..above.len())
        .map(expected)
        .fold((0.0, 0.0), |(sum, squares), power| (sum + power, squares + power * power));
    // The mean square of the mean of n squares of normal numbers is 1 + 2/n.
    let equal = (1.0 + 2.0 / (2 * NEAR + 1) as f64) * sum * sum / squares - 2.0;
    // Without anything above the floor, the line is as even as can be.
    let equal = if equal.is_nan() { waves.len() as f64 } else { equal };
    (UNEQUAL * equal).max(2.0)
}

impl Scatter {
    /// The scatter without that of independent noise of a known CV; None if nothing is left.
    pub(super) fn subtract_noise(self, noise: f64) -> Option<Self> {
        let less = |variance: f64| (variance - noise * noise).max(0.0);
        let rest = Self { variance: less(self.variance), ends: self.ends.map(less), ..self };
        (rest.variance > 0.0).then_some(rest)
    }

    pub(super) fn cv(&self) -> f64 {
        self.variance.sqrt()
    }

    /// Standard error of the CV.
    pub(super) fn standard_error(&self) -> f64 {
        self.error.sqrt() / (2.0 * self.cv())
    }

    /// The 95 % confidence interval of the CV.
    pub(super) fn interval(&self) -> [f64; 2] {
        self.ends.map(f64::sqrt)
    }
}

/// Deviations of the patches from their mean, block by block.
struct Blocks {
    /// Number of blocks in cross and in machine direction.
    sides: [usize; 2],
    /// Mean deviation in each block.
    means: Vec<f64>,
    /// Variance of all patches.
    variance: f64,
    /// Squared error of the mean of the variances within the blocks.
    error_within: f64,
}

impl Blocks {
    fn new(map: &Map, masked: &[bool], side: usize) -> Option<Self> {
        let sizes = [map.columns, map.rows];
        if side == 0 || sizes.iter().any(|size| side > *size) {
            return None;
        }
        let places = sizes.map(|size| size - side + 1);
        let sides = places.map(|places| places.min(BLOCKS));
        // Of each block: number, sum and sum of the squares of the deviations from the mean of all cells.
        let mut sums = vec![(0u64, 0.0, 0.0); sides[0] * sides[1]];
        let mean = map.total() as f64 / map.cells.len() as f64;
        let block = |axis: usize, at: usize| at * sides[axis] / places[axis];
        patches(map, masked, side, |row, column, weight| {
            let deviation = weight / mean - 1.0;
            let entry = &mut sums[block(1, row) * sides[0] + block(0, column)];
            *entry = (entry.0 + 1, entry.1 + deviation, entry.2 + deviation * deviation);
        });
        let (count, sum, squares) =
            sums.iter().fold((0, 0.0, 0.0), |all, block| (all.0 + block.0, all.1 + block.1, all.2 + block.2));
        if (count as f64) < 0.5 * (places[0] * places[1]) as f64 {
            return None;
        }
        let of_all = sum / count as f64;
        let scale = (1.0 + of_all).recip();
        let mean_of = |block: &(u64, f64, f64)| {
            if block.0 == 0 { 0.0 } else { (block.1 / block.0 as f64 - of_all) * scale }
        };
        let variance_within = |block: &(u64, f64, f64)| {
            (block.0 > 0).then(|| {
                (block.2 / block.0 as f64 - (block.1 / block.0 as f64).powi(2)).max(0.0) * scale * scale
            })
        };
        let within: Vec<Option<f64>> = sums.iter().map(variance_within).collect();
        let mean_within = Estimate::new(within.iter().copied().flatten().collect()).mean;
        let off: Vec<f64> =
            within.iter().map(|variance| variance.map_or(0.0, |found| found - mean_within)).collect();
        let lattice = Lattice { sides, chance: PIECE };
        Some(Self {
            sides,
            means: sums.iter().map(mean_of).collect(),
            variance: (squares / count as f64 - of_all * of_all).max(0.0) * scale * scale,
            error_within: lattice.error_of_mean(&off, &[]).unwrap_or(0.0).powi(2),
        })
    }

    /// The share of the variance in each wave, orthogonal cosines of half a wave and more over the piece: `Σ`
    /// over all but the first is the variance of the means of the blocks.
    fn waves(&self) -> Vec<f64> {
        waves(&self.means, self.sides, self.sides).into_iter().map(|wave| wave * wave).collect()
    }
}

/// Passes on the mean cell of each patch that is web, with the row and the column of its first cell.
fn patches(map: &Map, masked: &[bool], side: usize, mut take: impl FnMut(usize, usize, f64)) {
    let is_masked = |row: usize, column: usize| !masked.is_empty() && masked[row * map.columns + column];
    let least = (WEB * (side * side) as f64).ceil() as u64;
    // Quanta and cells of web in the rows of the patches, column by column.
    let mut sums = vec![(0u64, 0u64); map.columns];
    let change = |sums: &mut [(u64, u64)], row: usize, add: bool| {
        for (column, (sum, cell)) in sums.iter_mut().zip(map.row(row)).enumerate() {
            if is_masked(row, column) {
                continue;
            }
            let (mass, count) = (u64::from(*cell), 1);
            *sum = if add { (sum.0 + mass, sum.1 + count) } else { (sum.0 - mass, sum.1 - count) };
        }
    };
    (0..side - 1).for_each(|row| change(&mut sums, row, true));
    for row in 0..=map.rows - side {
        change(&mut sums, row + side - 1, true);
        let (mut mass, mut count) =
            sums[..side - 1].iter().fold((0, 0), |all, column| (all.0 + column.0, all.1 + column.1));
        for column in 0..=map.columns - side {
            let (first, last) = (sums[column], sums[column + side - 1]);
            (mass, count) = (mass + last.0, count + last.1);
            if count >= least.max(1) {
                take(row, column, mass as f64 / count as f64);
            }
            (mass, count) = (mass - first.0, count - first.1);
        }
        change(&mut sums, row, false);
    }
}

/// The quantile of the chi-squared distribution.
///
/// Source: the series of the incomplete gamma function, Abramowitz & Stegun 6.5.29; from 100 degrees on,
/// Wilson and Hilferty, Proceedings of the National Academy of Sciences 17 (1931) 684–688, accurate to 1e-4.
///
/// * `share` – 0.025 or 0.975
/// * `degrees` – one or more; they need not be whole
fn chi_squared(share: f64, degrees: f64) -> f64 {
    if degrees > 100.0 {
        let spread = 2.0 / (9.0 * degrees);
        let z = if share > 0.5 { NORMAL_95 } else { -NORMAL_95 };
        return degrees * (1.0 - spread + z * spread.sqrt()).powi(3);
    }
    let below = |x: f64| {
        let (a, x) = (0.5 * degrees, 0.5 * x);
        let mut term = 1.0;
        let mut sum = 1.0;
        let mut n = a;
        while term > 1e-15 * sum {
            n += 1.0;
            term *= x / n;
            sum += term;
        }
        libm::exp(a * libm::log(x) - x - libm::lgamma(a + 1.0)) * sum
    };
    let (mut low, mut high) = (1e-12, degrees + 10.0 * (2.0 * degrees).sqrt() + 10.0);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if below(middle) < share { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_quantiles_of_chi_squared() {
        // Pearson & Hartley, Biometrika Tables for Statisticians, table 8.
        for (degrees, low, high) in [
            (1.0, 0.000_982, 5.023_89),
            (3.0, 0.215_795, 9.348_40),
            (10.0, 3.246_97, 20.4832),
            (60.0, 40.4817, 83.2977),
            (100.0, 74.2219, 129.561),
        ] {
            let found = [0.025, 0.975].map(|share| chi_squared(share, degrees));
            assert!((found[0] / low - 1.0).abs() < 2e-4 && (found[1] / high - 1.0).abs() < 2e-5, "{found:?}");
        }
        // Both ways meet.
        let [below, above] = [100.0, 100.001].map(|degrees| chi_squared(0.025, degrees));
        assert!((above / below - 1.0).abs() < 2e-4, "{below} {above}");
    }
}
