//! Chance in the numbers of a map: how far they are from those of all such webs.
//!
//! A number of a map is to first order a mean over its places, of what each of them adds to it, its influence.
//! That is a field with clouds and streaks as the weight is, and the mean is its wave of infinite length. One map
//! does not show how strong this wave is over many webs; it is as strong as the next ones.       theory.md (103a)

use spunlaid_ground::statistics::{dot, student_t_95_at};
use spunlaid_ground::{Known, NORMAL_95};
use std::f64::consts::PI;

/// Longest half waves either way, from which the strength of the wave of infinite length is estimated.
const LONGEST: usize = 4;
/// Fewest degrees of freedom of an error. With less, as of streaks on two strips side by side, it is not known.
const FEWEST: f64 = 2.0;
/// Fewest numbers whose CV has an error.
const FEWEST_NUMBERS: usize = 3;

/// Parts of equal size that lie side by side on a sheet; their numbers stand row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Lattice {
    /// Number of parts in cross and in machine direction.
    pub(crate) sides: [usize; 2],
    /// What is known of the chance.
    pub(crate) chance: Chance,
}

/// What is known of the chance in a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chance {
    /// Directions, cross and machine, in which the sheet is closed to a ring, so that all such sheets have the
    /// same mass.
    pub closed: [bool; 2],
    /// Whether what is the same along the whole web, its streaks, is another in each web of the kind.
    pub streaks: bool,
}

/// Powers of waves of one kind: their sum and number.
#[derive(Clone, Copy)]
struct Line {
    sum: f64,
    count: f64,
}

impl Line {
    fn of(powers: impl Iterator<Item = f64>) -> Self {
        powers.fold(Self { sum: 0.0, count: 0.0 }, |of, power| Self {
            sum: of.sum + power,
            count: of.count + 1.0,
        })
    }

    fn mean(self) -> f64 {
        self.sum / self.count.max(1.0)
    }

    /// Whether it is stronger than others by more than a standard error of the ratio of two variances.
    fn is_beyond(self, others: Self) -> bool {
        self.mean() > others.mean() * (1.0 + (2.0 / self.count + 2.0 / others.count).sqrt())
    }
}

impl Lattice {
    /// Standard error of the mean of numbers; none where the map is too small to say.
    ///
    /// Streaks may be stronger than the other waves, and so may bars, which go across the whole web; both reach to the
    /// wave of infinite length. On a closed sheet the weight has no such wave: what follows the weight
    /// in a line is then taken out. An error that is known from few waves is enlarged by Student's t.
    ///
    /// * `influence` – deviation of each number from the mean
    /// * `weights` – deviation of the weight of each part from the mean; empty where the numbers do not follow it
    pub(crate) fn error_of_mean(&self, influence: &[f64], weights: &[f64]) -> Option<f64> {
        let counts = self.sides.map(|side| side.min(LONGEST + 1));
        let own = waves(influence, self.sides, counts);
        let slope = if weights.is_empty() { 0.0 } else { dot(influence, weights) / dot(weights, weights) };
        let follows: Vec<f64> = match slope.is_normal() {
            true => waves(weights, self.sides, counts).into_iter().map(|wave| slope * wave).collect(),
            false => vec![0.0; own.len()],
        };
        let power = |across: usize, along: usize, is_closed: bool| {
            let at = along * counts[0] + across;
            (own[at] - if is_closed { follows[at] } else { 0.0 }).powi(2)
        };
        let [closed_across, closed_along] = self.chance.closed;
        let streaks = Line::of((1..counts[0]).map(|i| power(i, 0, closed_across)));
        let bars = Line::of((1..counts[1]).map(|j| power(0, j, closed_along)));
        let of_row = |j| (1..counts[0]).map(move |i| (i, j));
        let rest = (1..counts[1]).flat_map(of_row).map(|(i, j)| power(i, j, closed_across || closed_along));
        let rest = Line::of(rest);
        let lines = if self.chance.streaks || rest.count == 0.0 { vec![streaks, bars] } else { vec![bars] };
        let (strong, alike): (Vec<Line>, Vec<Line>) =
            lines.into_iter().partition(|line| line.is_beyond(rest));
        let all =
            alike.iter().fold(rest, |of, line| Line { sum: of.sum + line.sum, count: of.count + line.count });
        let parts = strong.iter().map(|line| ((line.mean() - all.mean()).max(0.0), line.count));
        let (variance, squares) = parts
            .chain([(all.mean(), all.count)])
            .filter(|(_, count)| *count > 0.0)
            .fold((0.0, 0.0), |(sum, squares), (part, count)| (sum + part, squares + part * part / count));
        let degrees = if squares > 0.0 { variance * variance / squares } else { f64::INFINITY };
        let are_known = streaks.count > 0.0 || !self.chance.streaks;
        let t = || student_t_95_at(degrees) / NORMAL_95;
        (are_known && own.len() > 1 && degrees >= FEWEST).then(|| t() * variance.sqrt())
    }

    /// The mean of numbers with its error.
    ///
    /// * `weights` – as in [`Lattice::error_of_mean`]
    pub(crate) fn mean(&self, numbers: &[f64], weights: &[f64]) -> Known {
        let mean = mean(numbers);
        let influence: Vec<f64> = numbers.iter().map(|number| number - mean).collect();
        Known::Value(mean, self.error_of_mean(&influence, weights))
    }

    /// The standard deviation of numbers over their mean, with its error.
    ///
    /// * `weights` – as in [`Lattice::error_of_mean`]
    pub(crate) fn cv(&self, numbers: &[f64], weights: &[f64]) -> Known {
        let (mean, count) = (mean(numbers), numbers.len() as f64);
        let variance = numbers.iter().map(|number| (number - mean).powi(2)).sum::<f64>() / (count - 1.0);
        let deviation = variance.sqrt();
        // The deviation is that of all, of which the mean comes from the same numbers.
        let of = |number: &f64| {
            let off = number - mean;
            if deviation > 0.0 {
                0.5 * (off * off - variance) / deviation - deviation / mean * off
            } else {
                0.0
            }
        };
        let influence: Vec<f64> = numbers.iter().map(of).collect();
        let of_columns = self.variance_of_columns(numbers, mean) / variance;
        // Few columns do not show how different columns are from each other.
        let few = 0.5 * deviation * of_columns * (2.0 / (self.sides[0] as f64 - 1.0)).sqrt();
        // A few numbers do not show how their own CV scatters: at least as that of so many independent ones.
        let least = deviation / (2.0 * (count - 1.0)).sqrt();
        let least = if self.chance.streaks && few.is_finite() { least.max(few) } else { least };
        let error = match self.error_of_mean(&influence, weights) {
            None => (numbers.len() >= FEWEST_NUMBERS).then_some(least),
            Some(error) => Some(error.max(least)),
        };
        Known::Value(deviation, error).times(1.0 / mean)
    }

    /// Variance between the means of the columns.
    fn variance_of_columns(&self, numbers: &[f64], mean: f64) -> f64 {
        let [columns, rows] = self.sides.map(|side| side as f64);
        let of_column = |column| numbers.iter().skip(column).step_by(self.sides[0]).sum::<f64>() / rows;
        (0..self.sides[0]).map(|column| (of_column(column) - mean).powi(2)).sum::<f64>() / (columns - 1.0)
    }
}

fn mean(numbers: &[f64]) -> f64 {
    numbers.iter().sum::<f64>() / numbers.len() as f64
}

/// Strengths of orthogonal cosines of so many half waves over a lattice, row by row: the sum of the squares of all
/// is the mean square of the numbers.
///
/// * `sides` – of the lattice, across and along
/// * `counts` – of half waves across and along, from none on
pub(crate) fn waves(numbers: &[f64], sides: [usize; 2], counts: [usize; 2]) -> Vec<f64> {
    let cosines = |axis: usize| -> Vec<f64> {
        let side = sides[axis];
        let wave = |k: usize, i: usize| {
            let norm = if k == 0 { 1.0 } else { 2f64.sqrt() };
            norm * libm::cos(PI * k as f64 * (i as f64 + 0.5) / side as f64) / side as f64
        };
        (0..counts[axis] * side).map(|at| wave(at / side, at % side)).collect()
    };
    let [across, along] = [cosines(0), cosines(1)];
    let of_row = |row: &[f64]| across.chunks_exact(sides[0]).map(|wave| dot(wave, row)).collect::<Vec<_>>();
    let rows: Vec<Vec<f64>> = numbers.chunks_exact(sides[0]).map(of_row).collect();
    let of =
        |wave: &[f64], i: usize| -> f64 { wave.iter().zip(&rows).map(|(cosine, row)| cosine * row[i]).sum() };
    along.chunks_exact(sides[1]).flat_map(|wave| (0..counts[0]).map(move |i| of(wave, i))).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    const SIDES: [usize; 2] = [8, 7];

    /// Numbers of which the waves have these strengths, by half waves across and along.
    fn numbers(sides: [usize; 2], strength: impl Fn(usize, usize) -> f64) -> Vec<f64> {
        let wave = |k: usize, i: usize, side: usize| {
            let norm = if k == 0 { 1.0 } else { 2f64.sqrt() };
            norm * libm::cos(PI * k as f64 * (i as f64 + 0.5) / side as f64)
        };
        let at = |x: usize, y: usize| {
            let of = |k: usize, l: usize| strength(k, l) * wave(k, x, sides[0]) * wave(l, y, sides[1]);
            (0..sides[0]).flat_map(|k| (0..sides[1]).map(move |l| (k, l))).map(|(k, l)| of(k, l)).sum::<f64>()
        };
        (0..sides[0] * sides[1]).map(|i| at(i % sides[0], i / sides[0])).collect()
    }

    fn lattice(sides: [usize; 2], closed: [bool; 2], streaks: bool) -> Lattice {
        Lattice { sides, chance: Chance { closed, streaks } }
    }

    #[test]
    fn analytic_strengths_of_cosines_make_up_the_numbers() {
        let strength = |k: usize, l: usize| (1 + k + 10 * l) as f64;
        let numbers = numbers(SIDES, strength);
        let found = waves(&numbers, SIDES, [3, 2]);
        for (at, found) in found.iter().enumerate() {
            assert!((found - strength(at % 3, at / 3)).abs() < 1e-11, "{at}: {found}");
        }
        let all: f64 = waves(&numbers, SIDES, SIDES).iter().map(|wave| wave * wave).sum();
        let squares: f64 = numbers.iter().map(|number| number * number).sum();
        assert!((all / (squares / 56.0) - 1.0).abs() < 1e-12 && found.len() == 6);
    }

    /// Of waves of strength c, up to four half waves either way, the one of infinite length has the same strength,
    /// with as many degrees of freedom as there are waves.
    #[test]
    fn analytic_the_error_of_a_mean_is_the_strength_of_the_longest_waves() {
        let c = 0.3;
        let enlarged = |degrees: f64| student_t_95_at(degrees) / NORMAL_95;
        let even = |k: usize, l: usize| if (k, l) == (0, 0) { 0.0 } else { c };
        let streaky = |k: usize, l: usize| if l == 0 { 3.0 * even(k, l) } else { even(k, l) };
        let barred = |k: usize, l: usize| streaky(l, k);
        // Waves shorter than four half waves do not count.
        let short = |k: usize, l: usize| if k > 4 || l > 4 { 9.0 } else { even(k, l) };
        // Of nine times the power in four waves and that of the other twenty.
        let strong = 81.0 / (64.0 / 4.0 + 1.0 / 20.0);
        let strong_bars = 81.0 / (64.0 / 4.0 + 1.0 / 16.0);
        for (strength, streaks, wanted) in [
            (&even as &dyn Fn(usize, usize) -> f64, true, c * enlarged(24.0)),
            (&short, true, c * enlarged(24.0)),
            (&even, false, c * enlarged(20.0)),
            (&streaky, true, 3.0 * c * enlarged(strong)),
            (&streaky, false, c * enlarged(20.0)),
            (&barred, true, 3.0 * c * enlarged(strong)),
            (&barred, false, 3.0 * c * enlarged(strong_bars)),
        ] {
            let numbers = numbers(SIDES, strength);
            let found = lattice(SIDES, [false; 2], streaks).error_of_mean(&numbers, &[]).unwrap();
            assert!((found / wanted - 1.0).abs() < 1e-9, "{streaks}: {found} {wanted}");
            let shifted: Vec<f64> = numbers.iter().map(|number| number + 5.0).collect();
            let Known::Value(mean, Some(error)) = lattice(SIDES, [false; 2], streaks).mean(&shifted, &[])
            else {
                panic!("no error")
            };
            assert!((mean - 5.0).abs() < 1e-12 && (error / wanted - 1.0).abs() < 1e-9, "{mean} {error}");
        }
        // Streaks are stronger where the ratio to the sixteen others is above 1 + √(2/4 + 2/16) = 1.79.
        for (ratio, wanted) in [
            (1.75_f64, (27.0_f64 / 24.0).sqrt() * enlarged(24.0)),
            (1.83, 1.83_f64.sqrt() * enlarged(1.83 * 1.83 / (0.83 * 0.83 / 4.0 + 1.0 / 20.0))),
        ] {
            let numbers = numbers(SIDES, |k, l| if l == 0 { ratio.sqrt() * even(k, l) } else { even(k, l) });
            let found = lattice(SIDES, [false; 2], true).error_of_mean(&numbers, &[]).unwrap();
            assert!((found / (c * wanted) - 1.0).abs() < 1e-9, "{ratio}: {found}");
        }
        // The CV of these numbers about 5 changes by the deviation of each and by its square.
        let shifted = numbers(SIDES, |k, l| {
            if (k, l) == (0, 0) {
                5.0
            } else if k + l > 4 {
                0.0
            } else {
                0.1 * c
            }
        });
        let square = shifted.iter().map(|number| (number - 5.0).powi(2)).sum::<f64>() / 55.0;
        let change = |number: &f64| {
            let off = number - 5.0;
            0.5 * (off * off - square) / (5.0 * square.sqrt()) - square.sqrt() / 25.0 * off
        };
        let of = lattice(SIDES, [false; 2], false);
        let wanted = of.error_of_mean(&shifted.iter().map(change).collect::<Vec<_>>(), &[]).unwrap();
        let Known::Value(cv, Some(error)) = of.cv(&shifted, &[]) else { panic!("no error") };
        assert!((cv / (square.sqrt() / 5.0) - 1.0).abs() < 1e-12 && (error / wanted - 1.0).abs() < 1e-9);
        assert!(wanted > cv / 110f64.sqrt());
        // On a closed sheet what follows the weight has no wave of infinite length.
        let influence = numbers(SIDES, even);
        let weights = numbers(SIDES, |k, l| 2.0 * even(k, l));
        let of =
            |closed: [bool; 2]| lattice(SIDES, closed, true).error_of_mean(&influence, &weights).unwrap();
        for (closed, wanted) in [
            ([false, false], c * enlarged(24.0)),
            ([true, false], c * enlarged(4.0)),
            ([false, true], c * enlarged(4.0)),
            ([true, true], 0.0),
        ] {
            assert!((of(closed) - wanted).abs() < 1e-9, "{closed:?}: {}", of(closed));
        }
    }

    #[test]
    fn a_map_of_few_parts_has_no_error() {
        let even = |k: usize, l: usize| if (k, l) == (0, 0) { 0.0 } else { 1.0 };
        for (sides, streaks, is_known) in [
            ([1, 1], false, false),
            ([1, 7], true, false),
            ([1, 7], false, true),
            ([2, 1], true, false),
            ([3, 1], true, true),
            ([2, 2], true, true),
        ] {
            let error = lattice(sides, [false; 2], streaks).error_of_mean(&numbers(sides, even), &[]);
            assert_eq!(error.is_some(), is_known, "{sides:?} {streaks}: {error:?}");
        }
    }

    /// The standard deviation of n − 1, and at least the error of so many independent numbers.
    #[test]
    fn analytic_the_cv_of_numbers_of_two_kinds() {
        let two: Vec<f64> = (0..56).map(|i| if i % 2 == 0 { 9.0 } else { 11.0 }).collect();
        let deviation = (56.0_f64 / 55.0).sqrt();
        let Known::Value(cv, Some(error)) = lattice(SIDES, [false; 2], false).cv(&two, &[]) else {
            panic!("no error")
        };
        assert!((cv - 0.1 * deviation).abs() < 1e-12, "{cv}");
        let least = 0.1 * deviation / f64::sqrt(110.0);
        assert!((least - 1e-12..1.5 * least).contains(&error), "{error} {least}");
        // Few columns differ.
        let Known::Value(_, Some(of_columns)) = lattice(SIDES, [false; 2], true).cv(&two, &[]) else {
            panic!("no error")
        };
        // Between columns the variance is 8/7 of one: of its half, over the deviation, the root of 2/7.
        let few = 0.1 * 0.5 / deviation * (8.0 / 7.0) * f64::sqrt(2.0 / 7.0);
        assert!((of_columns / few - 1.0).abs() < 1e-9, "{of_columns} {few}");
        assert_eq!(
            lattice([1, 2], [false; 2], true).cv(&[1.0, 3.0], &[]),
            Known::Value(0.5 * 2f64.sqrt(), None)
        );
    }
}
