//! The CV of a web from two levels: coarse flights over a large area, and fine ones in the air of a part of it.
//!
//! ```text
//! CV²(fine) = CV²(coarse, all) + [CV²(fine) − CV²(coarse)](common part)
//! ```
//!
//! Most of the error of a CV is that the flown sheet holds few clouds, and a coarse flight has nearly the same clouds
//! as a fine one in the same air. So the area is flown coarsely, and the common part gives the error of the coarse
//! mesh: two levels of multilevel Monte Carlo (M. B. Giles, Operations Research 56 (2008) 607), with the coefficient of
//! a control variate.                                                                            theory.md (83m), (83o)

use super::few_filaments::{SMALL, small_patch};
use super::few_findings::{FewFilamentsCv, LayerFew};
use super::uniformity::nearest_to_seen;

/// Results of a layer on sheets that were flown finely, coarsely, or both ways in the same air.
#[derive(Clone, Debug, Default)]
pub(crate) struct Levels {
    /// Sheets that were flown both ways.
    pub(crate) pairs: Vec<Pair>,
    /// Coarse sheets in other airs.
    pub(crate) coarse: Vec<LayerFew>,
}

/// One sheet in one air, flown both ways.
#[derive(Clone, Debug)]
pub(crate) struct Pair {
    /// Flown finely.
    pub(crate) fine: LayerFew,
    /// Flown coarsely.
    pub(crate) coarse: LayerFew,
}

/// Parts of the variance of a CV, as parts of its square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Variances {
    /// Because the area that was flown finely is small.
    pub(crate) by_pairs: f64,
    /// Because the whole area is small.
    pub(crate) by_area: f64,
    /// Because few filaments were flown.
    pub(crate) by_pitch: f64,
}

impl Variances {
    pub(crate) fn whole(&self) -> f64 {
        self.by_pairs + self.by_area + self.by_pitch
    }
}

/// The result of all sheets over patches of one side.
struct OfPatch {
    cv: f64,
    variances: Variances,
    /// How far every second filament is off, as a fraction of the CV.
    of_halves: f64,
}

/// A sheet as one of many.
#[derive(Clone, Copy)]
struct Sheet<'a> {
    few: &'a LayerFew,
    /// Its fraction of the area of all.
    fraction: f64,
}

impl Levels {
    /// Combines the sheets: the first fine sheet with the CV of all. None without a pair.
    pub(crate) fn combine(&self) -> Option<LayerFew> {
        let first = &self.pairs.first()?.fine;
        let mut combined = first.clone();
        for (number, cv) in combined.cvs.iter_mut().enumerate() {
            let Some(OfPatch { cv: of_all, variances, of_halves }) = self.combine_over(number) else {
                continue;
            };
            let error = |variance: f64| of_all * variance.sqrt();
            *cv = FewFilamentsCv {
                by_chance: Some(error(variances.by_pairs + variances.by_area)),
                by_pitch: error(variances.by_pitch),
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
    pub(crate) fn variances(&self) -> Option<Variances> {
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
        let at = |few: &LayerFew| few.cvs.iter().position(|cv| (cv.patch / patch - 1.0).abs() < 1e-6);
        let blocks = |few: &LayerFew| deviations(&few.blocks[at(few)?]);
        let square = |few: &LayerFew| Some(few.cvs[at(few)?].cv.powi(2));
        let whole: f64 = self.pairs.iter().map(|pair| area(&pair.fine)).sum();
        // Of the common part: CV² either way, and the variances and the covariance of these means.
        let (mut fine, mut common) = (0.0, 0.0);
        let (mut of_fine, mut of_coarse, mut of_both) = (0.0, 0.0, 0.0);
        let mut degrees = 0.0;
        for pair in &self.pairs {
            let fraction = area(&pair.fine) / whole;
            let (a, b) = (blocks(&pair.fine)?, blocks(&pair.coarse)?);
            if a.len() != b.len() {
                return None;
            }
            let means = Covariance::of_means(&a, &b, pair.fine.blocks_across);
            fine += fraction * square(&pair.fine)?;
            common += fraction * square(&pair.coarse)?;
            of_fine += fraction * fraction * means.variances[0];
            of_coarse += fraction * fraction * means.variances[1];
            of_both += fraction * fraction * means.covariance;
            degrees += means.degrees;
        }
        let (mut all, mut of_all) = (0.0, 0.0);
        for Sheet { few, fraction } in self.coarse() {
            let blocks = blocks(few)?;
            all += fraction * square(few)?;
            of_all +=
                fraction * fraction * Covariance::of_means(&blocks, &blocks, few.blocks_across).variances[0];
        }
        let coefficient = if of_coarse > 0.0 { (of_both / of_coarse).clamp(0.0, MOST) } else { 0.0 };
        let left = (of_fine - 2.0 * coefficient * of_both + coefficient * coefficient * of_coarse).max(0.0);
        // The coefficient itself is known only as well as the common part is large.
        let of_coefficient = if of_coarse > 0.0 { left / of_coarse / (degrees - 1.0).max(1.0) } else { 0.0 };
        let square = fine + coefficient * (all - common);
        let (of_halves, by_pitch) = self.by_pitch(patch, at)?;
        let variance = |of_square: f64| of_square / (4.0 * square * square);
        let variances = Variances {
            by_pairs: variance(left + of_coefficient * (all - common).powi(2)),
            by_area: variance(coefficient * coefficient * of_all),
            by_pitch,
        };
        (square > 0.0).then(|| OfPatch { cv: square.sqrt(), variances, of_halves })
    }

    /// The relative difference of the CV from every second filament, and the variance that few filaments leave open.
    ///
    /// The part that depends on the places of the few averages out over the sheets. The part that depends on their
    /// distance is the same on all of them.
    fn by_pitch(&self, patch: f64, at: impl Fn(&LayerFew) -> Option<usize>) -> Option<(f64, f64)> {
        let (mut squares, mut off, mut fractions) = (0.0, 0.0, 0.0);
        for Sheet { few, fraction } in self.coarse() {
            let of_halves = few.cvs[at(few)?].of_halves;
            squares += fraction * of_halves * of_halves;
            off += fraction * of_halves;
            fractions += fraction * fraction;
        }
        let first = &self.pairs.first()?.fine;
        let small = if patch < small_patch(first.pitch) { SMALL } else { 0.0 };
        // The error falls faster than the pitch.
        Some((off, (0.25 * off * off).max(squares * fractions) + small * small))
    }
}

/// Largest coefficient: a level that scatters so much less than the other one says little about it.
const MOST: f64 = 2.0;

fn area(few: &LayerFew) -> f64 {
    few.sheet[0] * few.sheet[1]
}

/// The deviations of blocks from their mean.
fn deviations(blocks: &[f64]) -> Option<Vec<f64>> {
    let mean = blocks.iter().sum::<f64>() / blocks.len() as f64;
    (blocks.len() > 1).then(|| blocks.iter().map(|block| block - mean).collect())
}

/// Blocks along and across the belt, as far as one still knows of another.
const ALONG: usize = 3;
const ACROSS: usize = 2;

/// Variances and covariance of the means of two numbers over the same blocks.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Covariance {
    pub(crate) variances: [f64; 2],
    pub(crate) covariance: f64,
    /// Degrees of freedom.
    pub(crate) degrees: f64,
}

impl Covariance {
    /// A cloud may reach into the blocks beside its own, so what these have in common counts too.
    ///
    /// * `a`, `b` – deviations from their means, block after block across
    /// * `across` – number of blocks across; the web goes on at its edges
    pub(crate) fn of_means(a: &[f64], b: &[f64], across: usize) -> Self {
        let (count, across) = (a.len() as f64, across.max(1));
        let along = a.len() / across;
        // Weights fall with the distance as those of moving sums of blocks do, so that no variance is negative.
        let weight = |steps: usize, reach: usize| 1.0 - steps as f64 / reach as f64;
        let (mut sums, mut covariance, mut weights, mut squares) = ([0.0; 2], 0.0, 0.0, 0.0);
        for number in 0..a.len() {
            let [row, column] = [number / across, number % across];
            for other_row in row.saturating_sub(ALONG - 1)..along.min(row + ALONG) {
                for other_column in 0..across {
                    let steps = other_column.abs_diff(column);
                    let steps = [other_row.abs_diff(row), steps.min(across - steps)];
                    if steps[0] >= ALONG.min(along) || steps[1] >= ACROSS.min(across) {
                        continue;
                    }
                    let (other, weight) = (
                        other_row * across + other_column,
                        weight(steps[0], ALONG) * weight(steps[1], ACROSS),
                    );
                    sums[0] += weight * a[number] * a[other];
                    sums[1] += weight * b[number] * b[other];
                    covariance += weight * a[number] * b[other];
                    weights += weight / count;
                    squares += weight * weight / count;
                }
            }
        }
        // The mean of all takes a part of the variance away.
        let left = (1.0 - weights / count).max(0.0);
        let of_mean = |sum: f64| sum / (count * count) / left;
        Self {
            variances: sums.map(of_mean),
            covariance: of_mean(covariance),
            degrees: left * count / squares,
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use rand_xoshiro::SplitMix64;
    use rand_xoshiro::rand_core::{Rng, SeedableRng};

    const ACROSS: usize = 4;
    /// CV² of a fine sheet, and of a coarse one.
    const SQUARES: [f64; 2] = [0.0225, 0.0256];

    /// Nearly normal numbers of variance one.
    struct Normal(SplitMix64);

    impl Normal {
        fn next(&mut self) -> f64 {
            (0..12).map(|_| self.0.next_u64() as f64 / u64::MAX as f64).sum::<f64>() - 6.0
        }
    }

    /// A sheet of such blocks, whose few filaments leave nothing open.
    fn sheet(blocks: Vec<f64>) -> LayerFew {
        let mean = blocks.iter().sum::<f64>() / blocks.len() as f64;
        let cv = FewFilamentsCv {
            patch: 0.01,
            cv: mean.sqrt(),
            by_chance: None,
            by_pitch: 0.0,
            of_halves: 0.0,
            own: 0.0,
            few: mean.sqrt(),
            beyond_filling: 0.0,
            beyond_sheet: 0.0,
        };
        let sheet = [0.2, 0.05 * (blocks.len() / ACROSS) as f64];
        LayerFew {
            sheet,
            area: sheet[0] * sheet[1],
            cvs: vec![cv],
            blocks: vec![blocks],
            blocks_across: ACROSS,
            ..LayerFew::default()
        }
    }

    /// Sheets of which the pair has a part of its clouds in common.
    fn levels(random: &mut Normal, in_common: f64) -> Levels {
        let mut both = |blocks: usize| -> [Vec<f64>; 2] {
            let pairs: Vec<[f64; 2]> = (0..blocks)
                .map(|_| {
                    let [a, b] = [random.next(), random.next()];
                    let other = in_common * a + (1.0 - in_common * in_common).sqrt() * b;
                    [SQUARES[0] * (1.0 + 0.5 * a), SQUARES[1] * (1.0 + 0.5 * other)]
                })
                .collect();
            [0, 1].map(|level| pairs.iter().map(|pair| pair[level]).collect())
        };
        let [fine, coarse] = both(10 * ACROSS).map(sheet);
        let others = (0..4).map(|_| sheet(both(20 * ACROSS)[1].clone())).collect();
        Levels { pairs: vec![Pair { fine, coarse }], coarse: others }
    }

    /// The bias of the coarse mesh cancels, and the error that is reported is that of many trials, whether the two
    /// levels have their clouds in common or nothing.
    #[test]
    fn stat_two_levels_are_unbiased_and_know_their_error() {
        const TRIALS: usize = 1500;
        let mut random = Normal(SplitMix64::seed_from_u64(3));
        let mut alone_variance = 0.0;
        for in_common in [0.98, 0.7, 0.0] {
            let (mut sum, mut squares, mut reported, mut alone) = (0.0, 0.0, 0.0, 0.0);
            for _ in 0..TRIALS {
                let levels = levels(&mut random, in_common);
                let square = |few: &LayerFew| few.cvs[0].cv.powi(2) / SQUARES[0] - 1.0;
                let combined = levels.combine().unwrap();
                sum += square(&combined);
                squares += square(&combined).powi(2);
                alone += square(&levels.pairs[0].fine).powi(2);
                reported += 4.0 * levels.variances().unwrap().whole();
            }
            let trials = TRIALS as f64;
            let [mean, variance, reported, alone] = [sum, squares, reported, alone].map(|sum| sum / trials);
            println!("{in_common}: {mean} {variance} {reported} {alone}");
            assert!(mean.abs() < 4.0 * (variance / trials).sqrt() + 2e-3, "{in_common}: {mean}");
            assert!((reported / variance - 1.0).abs() < 0.2, "{in_common}: {reported} {variance}");
            // An eighth of the area leaves eight times the variance, and only what is in common falls.
            assert!(variance < alone * (1.05 - 0.8 * in_common * in_common), "{variance} {alone}");
            alone_variance = alone;
        }
        assert!(alone_variance > 0.0);
    }

    /// Blocks that know nothing of each other, and blocks of which each has a half of its clouds in common
    /// with the next one along.
    #[test]
    fn stat_the_variance_of_the_mean_of_blocks_counts_what_they_have_in_common() {
        let mut random = Normal(SplitMix64::seed_from_u64(1));
        let mut normal = || random.next();
        for in_common in [false, true] {
            let (mut told, mut found, trials) = (0.0, 0.0, 2000.0);
            for _ in 0..trials as usize {
                let clouds: Vec<f64> = (0..16 * ACROSS + ACROSS).map(|_| normal()).collect();
                let next = |i: usize| if in_common { clouds[i + ACROSS] } else { 0.0 };
                let mut blocks: Vec<f64> = (0..16 * ACROSS).map(|i| clouds[i] + next(i)).collect();
                let mean = blocks.iter().sum::<f64>() / blocks.len() as f64;
                blocks.iter_mut().for_each(|block| *block -= mean);
                let means = Covariance::of_means(&blocks, &blocks, ACROSS);
                let (variance, degrees) = (means.variances[0], means.degrees);
                assert!((15.0..21.0).contains(&degrees), "{degrees}");
                told += variance / trials;
                found += mean * mean / trials;
            }
            println!("{told} {found}");
            // Two thirds of what a block has in common with the next one count, of five sixths of the whole.
            let expected = if in_common { 10.0 / 12.0 } else { 1.0 };
            assert!((told / found / expected - 1.0).abs() < 0.1, "{told} {found}");
        }
    }
}
