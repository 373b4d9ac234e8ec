//! The CV of a web from two levels: coarse flights over a large area, and fine ones in the air of a part of it.
//!
//! ```text
//! CV²(fine) = CV²(coarse, all) + [CV²(fine) − CV²(coarse)](common part)
//! ```
//!
//! Most of the error of a CV is that the simulated sheet holds few clouds, and a coarse flight has nearly the same
//! clouds as a fine one in the same air. So the area is simulated coarsely, and the common part gives the error of
//! the coarse mesh: two levels of multilevel Monte Carlo (M. B. Giles, Operations Research 56 (2008) 607), with the
//! coefficient of a control variate.                                                                           
//! theory.md (83m), (83o)

use super::few_filaments::{SMALL, small_patch};
use super::few_findings::{SubsampleCv, SubsampleEstimate};
use super::uniformity::nearest_to_seen;

/// Results of a layer on sheets that were simulated finely, coarsely, or both ways in the same air.
#[derive(Clone, Debug, Default)]
pub struct Levels {
    /// Sheets that were simulated both ways.
    pub pairs: Vec<Pair>,
    /// Coarse sheets in other airs.
    pub coarse: Vec<SubsampleEstimate>,
}

/// One sheet in one air, simulated both ways.
#[derive(Clone, Debug)]
pub struct Pair {
    /// Flown finely.
    pub fine: SubsampleEstimate,
    /// Flown coarsely.
    pub coarse: SubsampleEstimate,
}

/// Part of what area and pairs may have that may come from the pairs before another pair is simulated.
const BY_PAIRS: f64 = 0.5;

/// Parts of the variance of a CV, as parts of its square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variances {
    /// Because the area that was simulated finely is small.
    pub by_pairs: f64,
    /// Because the whole area is small.
    pub by_area: f64,
    /// Because a sample of filaments was simulated: what their positions do, which is different on each sheet.
    pub by_places: f64,
    /// What their distance does, which is alike on all sheets.
    pub by_distance: f64,
}

impl Variances {
    /// Their sum.
    pub fn whole(&self) -> f64 {
        self.by_pairs + self.by_area + self.by_places + self.by_distance
    }

    /// Returns the sheets that are needed next; None if the error is small enough, if only the distance of the
    /// filaments limits it, or if it is not known.
    ///
    /// * `wanted` – standard error of the CV, as a part of it
    /// * `sheets`, `pairs` – numbers of those that have been simulated
    pub fn next_sheets(&self, wanted: f64, sheets: u64, pairs: u64) -> Option<NextSheets> {
        // The distance does the same on all sheets, so the others get the rest of what is wanted. Less than half of its
        // variance would cost more than it is worth.
        let rest = (wanted * wanted - self.by_distance).max(0.5 * self.by_distance);
        let open = self.by_area + self.by_places;
        let is_too_large = open + self.by_pairs > rest;
        if !is_too_large {
            return None;
        }
        let has_pair = self.by_pairs > BY_PAIRS * rest;
        // The sheets that a pair spares are not simulated.
        let left_of_pairs = if has_pair { pairs as f64 / (pairs + 1) as f64 } else { 1.0 };
        let left = (rest - left_of_pairs * self.by_pairs).max((1.0 - BY_PAIRS) * rest);
        // No more than as many again, because the variance is not known well yet.
        let needed = sheets as f64 * (open / left - 1.0);
        Some(NextSheets { coarse: (needed.ceil() as u64).min(sheets).max(1), has_pair })
    }
}

/// The sheets that are simulated next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NextSheets {
    /// Number of coarse ones.
    pub coarse: u64,
    /// Whether another pair is among them.
    pub has_pair: bool,
}

/// The result of all sheets over patches of one side.
struct OfPatch {
    cv: f64,
    variances: Variances,
    /// How far every second filament is off, as a fraction of the CV.
    of_halves: f64,
}

/// What the sample of filaments does to a CV.
struct OfSample {
    /// How far every second filament is off, as a fraction of the CV.
    of_halves: f64,
    /// See [`Variances`].
    by_places: f64,
    by_distance: f64,
}

/// A sheet as one of many.
#[derive(Clone, Copy)]
struct Sheet<'a> {
    few: &'a SubsampleEstimate,
    /// Its fraction of the area of all.
    fraction: f64,
}

impl Levels {
    /// Combines the sheets: the first fine sheet with the CV of all. None without a pair.
    pub fn combine(&self) -> Option<SubsampleEstimate> {
        let first = &self.pairs.first()?.fine;
        let mut combined = first.clone();
        for (number, cv) in combined.cvs.iter_mut().enumerate() {
            let Some(OfPatch { cv: of_all, variances, of_halves }) = self.combine_over(number) else {
                continue;
            };
            let error = |variance: f64| of_all * variance.sqrt();
            *cv = SubsampleCv {
                by_chance: Some(error(variances.by_pairs + variances.by_area)),
                by_pitch: error(variances.by_places + variances.by_distance),
                of_halves,
                beyond_sheet: of_all * of_all - cv.cv * cv.cv,
                ..cv.with_square(of_all * of_all)
            };
        }
        combined.area = self.coarse().map(|sheet| area(sheet.few)).sum();
        combined.fine_area = self.pairs.iter().map(|pair| area(&pair.fine)).sum();
        let fine = self.pairs.iter().skip(1).map(|pair| &pair.fine);
        for sheet in fine.chain(self.coarse().map(|sheet| sheet.few)) {
            combined.on_other_sheets += sheet.filaments;
            combined.lost_on_other_sheets += sheet.lost;
        }
        Some(combined)
    }

    /// The parts of the error of the CV over the patches that the eye judges first.
    pub fn variances(&self) -> Option<Variances> {
        let first = &self.pairs.first()?.fine;
        let number = nearest_to_seen(first.cvs.iter().map(|cv| cv.patch))?;
        Some(self.combine_over(number)?.variances)
    }

    /// All coarse sheets.
    fn coarse(&self) -> impl Iterator<Item = Sheet<'_>> {
        let all = || self.pairs.iter().map(|pair| &pair.coarse).chain(&self.coarse);
        let whole: f64 = all().map(area).sum();
        all().map(move |few| Sheet { few, fraction: area(few) / whole })
    }

    /// The CV over patches of one side, and its error.
    ///
    /// * `number` – of the patches of the first fine sheet
    fn combine_over(&self, number: usize) -> Option<OfPatch> {
        let patch = self.pairs.first()?.fine.cvs[number].patch;
        let at =
            |few: &SubsampleEstimate| few.cvs.iter().position(|cv| (cv.patch / patch - 1.0).abs() < 1e-6);
        let square = |few: &SubsampleEstimate| Some(few.cvs[at(few)?].cv.powi(2));
        let blocks = |few: &SubsampleEstimate| Some(few.blocks[at(few)?].clone());
        let whole: f64 = self.pairs.iter().map(|pair| area(&pair.fine)).sum();
        let (mut fine, mut common) = (0.0, 0.0);
        let (mut fine_blocks, mut common_blocks) = (Vec::new(), Vec::new());
        for pair in &self.pairs {
            let fraction = area(&pair.fine) / whole;
            fine += fraction * square(&pair.fine)?;
            common += fraction * square(&pair.coarse)?;
            fine_blocks.extend(blocks(&pair.fine)?);
            common_blocks.extend(blocks(&pair.coarse)?);
        }
        let (mut all, mut sheets) = (0.0, Vec::new());
        for Sheet { few, fraction } in self.coarse() {
            all += fraction * square(few)?;
            sheets.push((few.blocks_across, blocks(few)?));
        }
        let coarse = CoarseBlocks::of(sheets)?;
        let regression = Regression::of(fine_blocks, common_blocks, coarse.reach)?;
        let coefficient = regression.coefficient;
        let square = fine + coefficient * (all - common);
        // The coefficient itself is known only as well as the common part is large.
        let of_common = coarse.variance * regression.of_coefficient;
        let of_coefficient = if of_common > 0.0 { (all - common).powi(2) / of_common } else { 0.0 };
        let OfSample { of_halves, by_places, by_distance } = self.of_sample(patch, at)?;
        let variance = |of_square: f64| of_square / (4.0 * square * square);
        let variances = Variances {
            by_pairs: variance(regression.left * (1.0 + of_coefficient)),
            by_area: variance(coefficient * coefficient * coarse.of_mean()),
            by_places,
            by_distance,
        };
        (square > 0.0).then(|| OfPatch { cv: square.sqrt(), variances, of_halves })
    }

    /// What the sample of filaments does. What depends on their places averages out over the sheets, and what depends
    /// on their distance does not.
    fn of_sample(&self, patch: f64, at: impl Fn(&SubsampleEstimate) -> Option<usize>) -> Option<OfSample> {
        let mut squares = 0.0;
        let mut off = 0.0;
        let mut fractions = 0.0;
        for Sheet { few, fraction } in self.coarse() {
            let of_halves = few.cvs[at(few)?].of_halves;
            squares += fraction * of_halves * of_halves;
            off += fraction * of_halves;
            fractions += fraction * fraction;
        }
        let first = &self.pairs.first()?.fine;
        let small = if patch < small_patch(first.pitch) { SMALL } else { 0.0 };
        let beyond = first.cvs[at(first)?].beyond_halves(off);
        // Of the mean of values that scatter, from their own scatter; one sheet shows none.
        let scatter = (squares - off * off).max(0.0) * fractions / (1.0 - fractions);
        Some(OfSample {
            of_halves: off,
            by_places: if fractions < 0.999 { scatter } else { off * off },
            by_distance: 0.25 * off * off + small * small + beyond * beyond,
        })
    }
}

/// What [`Levels`] take of a sheet that is not the first one, as numbers from which [`sheet_of`] makes it again.
pub fn numbers_of(few: &SubsampleEstimate) -> Vec<f64> {
    let [width, length] = few.sheet;
    let counts = [few.filaments, few.lost, few.blocks_across as u64, few.cvs.len() as u64];
    let mut numbers = vec![width, length];
    numbers.extend(counts.map(|count| count as f64));
    for (cv, blocks) in few.cvs.iter().zip(&few.blocks) {
        numbers.extend([cv.patch, cv.cv, cv.of_halves, blocks.len() as f64]);
        numbers.extend(blocks);
    }
    numbers
}

/// Takes a sheet from the beginning of some numbers; None if they are of another kind.
pub fn sheet_of(numbers: &mut &[f64]) -> Option<SubsampleEstimate> {
    let [width, length, filaments, lost, across, patches] = *taken(numbers, 6)?.first_chunk()?;
    let mut few =
        SubsampleEstimate { sheet: [width, length], area: width * length, ..SubsampleEstimate::default() };
    (few.filaments, few.lost, few.blocks_across) = (filaments as u64, lost as u64, across as usize);
    for _ in 0..patches as u64 {
        let [patch, cv, of_halves, blocks] = *taken(numbers, 4)?.first_chunk()?;
        few.cvs.push(SubsampleCv { patch, cv, of_halves, ..SubsampleCv::UNKNOWN });
        few.blocks.push(taken(numbers, blocks as usize)?.to_vec());
    }
    Some(few)
}

fn taken<'a>(numbers: &mut &'a [f64], count: usize) -> Option<&'a [f64]> {
    let (first, rest) = numbers.split_at_checked(count)?;
    *numbers = rest;
    Some(first)
}

/// Largest coefficient: a level that scatters so much less than the other one says little about it.
const MOST: f64 = 2.0;

fn area(few: &SubsampleEstimate) -> f64 {
    few.sheet[0] * few.sheet[1]
}

/// Takes the mean of numbers away; None if there are fewer than two.
fn deviations(mut blocks: Vec<f64>) -> Option<Vec<f64>> {
    let mean = blocks.iter().sum::<f64>() / blocks.len() as f64;
    blocks.iter_mut().for_each(|block| *block -= mean);
    (blocks.len() > 1).then_some(blocks)
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// How much the blocks of all coarse sheets vary.
struct CoarseBlocks {
    count: f64,
    /// Variance of one block.
    variance: f64,
    /// How many times as large the variance of a mean is as that of blocks which know nothing of each other.
    reach: f64,
}

/// Blocks along the belt, as far as one is still correlated with another.
const ALONG: usize = 3;
/// Smallest reach: the waves of the air have fixed strengths, so blocks beside each other may vary against each other.
const LEAST: f64 = 0.5;

impl CoarseBlocks {
    /// * `sheets` – the number of blocks across, and the blocks
    fn of(sheets: Vec<(usize, Vec<f64>)>) -> Option<Self> {
        let all = deviations(sheets.iter().flat_map(|(_, blocks)| blocks.iter().copied()).collect())?;
        let mut near = 0.0;
        let mut weights = 0.0;
        let mut rest = &all[..];
        for (across, blocks) in &sheets {
            let (own, behind) = rest.split_at(blocks.len());
            rest = behind;
            let rows: Vec<f64> = own.chunks((*across).max(1)).map(|row| row.iter().sum()).collect();
            for steps in 0..ALONG.min(rows.len()) {
                // Weights that fall with the distance would leave out a third of the variance.
                let weight = if steps == 0 { 1.0 } else { 2.0 };
                near += weight * product(&rows, &rows[steps..]);
                weights += weight * ((rows.len() - steps) * across * across) as f64;
            }
        }
        let (count, squares) = (all.len() as f64, product(&all, &all));
        // The mean of all takes a part of both away.
        let near = near / squares / (1.0 - weights / (count * count));
        let reach = near / (1.0 + near / count);
        let reach = if reach.is_finite() { reach.max(LEAST) } else { 1.0 };
        Some(Self { count, variance: squares / (count - reach).max(1.0), reach })
    }

    /// Variance of the mean of all.
    fn of_mean(&self) -> f64 {
        self.reach * self.variance / self.count
    }
}

/// The fine blocks of the common part by its coarse ones.
///
/// What the two levels do not have in common reaches as far as the clouds do, so only the blocks themselves are
/// compared: they are many more than what is independent of them.
struct Regression {
    coefficient: f64,
    /// Variance of the mean that is left.
    left: f64,
    /// Variance of the mean that is left over that of the coefficient, of coarse blocks of variance one.
    of_coefficient: f64,
}

impl Regression {
    fn of(fine: Vec<f64>, coarse: Vec<f64>, reach: f64) -> Option<Self> {
        let (fine, coarse) = (deviations(fine)?, deviations(coarse)?);
        if fine.len() != coarse.len() {
            return None;
        }
        let (of_fine, of_coarse) = (product(&fine, &fine), product(&coarse, &coarse));
        let of_both = product(&fine, &coarse);
        let coefficient = if of_coarse > 0.0 { (of_both / of_coarse).clamp(0.0, MOST) } else { 0.0 };
        let squares = of_fine - 2.0 * coefficient * of_both + coefficient * coefficient * of_coarse;
        let count = fine.len() as f64;
        // The mean is found from the same blocks, and the coefficient from products of two, which reach over half of
        // the area: that of the square of a normal curve.
        let degrees = (count / reach - 1.5).max(1.0);
        let left = squares.max(0.0) / count / degrees;
        Some(Self { coefficient, left, of_coefficient: 2.0 * degrees * reach / count })
    }
}

/// The variance of the mean of few blocks, of which a cloud may reach into the next.
#[derive(Clone, Copy, Debug)]
pub struct OfMean {
    /// The variance, in units of the squared values.
    pub variance: f64,
    /// Degrees of freedom.
    pub degrees: f64,
}

/// Blocks across the belt, as far as one is still correlated with another.
const ACROSS: usize = 2;

impl OfMean {
    /// * `blocks` – deviations from their mean, block after block across
    /// * `across` – number of blocks across; the web goes on at its edges
    pub fn of(blocks: &[f64], across: usize) -> Self {
        let (count, across) = (blocks.len() as f64, across.max(1));
        let along = blocks.len() / across;
        // Weights fall with the distance as those of moving sums of blocks do, so that no variance is negative.
        let falling = |steps: usize, reach: usize| 1.0 - steps as f64 / reach as f64;
        let mut products = 0.0;
        let mut weights = 0.0;
        let mut squares = 0.0;
        for (number, block) in blocks.iter().enumerate() {
            let [row, column] = [number / across, number % across];
            for other_row in row.saturating_sub(ALONG - 1)..along.min(row + ALONG) {
                for other_column in 0..across {
                    let steps = other_column.abs_diff(column);
                    let steps = [other_row.abs_diff(row), steps.min(across - steps)];
                    if steps[1] < ACROSS {
                        let weight = falling(steps[0], ALONG) * falling(steps[1], ACROSS);
                        products += weight * block * blocks[other_row * across + other_column];
                        weights += weight / count;
                        squares += weight * weight / count;
                    }
                }
            }
        }
        // The mean of all takes a part of the variance away.
        let left = (1.0 - weights / count).max(0.0);
        Self { variance: products / (count * count) / left, degrees: left * count / squares }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;
