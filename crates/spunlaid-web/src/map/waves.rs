//! Waves: the powers of a field on a rectangle, and how much of its variance is chance.

use spunlaid_ground::threads::par_map;
use spunlaid_ground::{Complex, InverseTransform, Lanes, WIDTH};
use std::array::from_fn;

/// What is known of the places at which the filaments of a sheet come down.
///
/// A filament that stays at its place leaves a streak along the whole sheet. Are the streaks of another web
/// of this kind others, or the same?
#[derive(Clone, Debug, PartialEq)]
pub enum Places {
    /// Nothing is known, as of a scan: streaks are chance, and the map itself says of how much. On a sheet
    /// that is closed in cross direction the mean is the same for all; otherwise the variance of the mean is
    /// found from the longest waves.
    Unknown,
    /// They are those of holes, or at random over the width: so much of the streaks is chance.
    Known(Streaks),
}

/// Streaks that are chance, of filaments at random places and of holes that have a defect at random, over the square
/// of the mean basis weight.
#[derive(Clone, Debug, PartialEq)]
pub struct Streaks {
    /// Variance of the mean basis weight of sheets like this one, by the number of filaments at random places.
    pub variance_of_mean: f64,
    /// Mean power of the wave with so many periods across the sheet and none along it, from one period on.
    /// All waves have twice that, since each counts in both senses.
    pub powers: Vec<f64>,
    /// Whether holes in rows, too, make streaks, which are the same in all webs: their strength is what the map has
    /// more than random ones.
    pub has_rows: bool,
}

impl Streaks {
    fn power(&self, across: i64) -> f64 {
        (across.unsigned_abs() as usize)
            .checked_sub(1)
            .and_then(|i| self.powers.get(i))
            .copied()
            .unwrap_or(0.0)
    }

    /// Those of means over a part of the sheet.
    pub(super) fn over(&self, share: f64) -> Self {
        let mean = |(number, power): (f64, &f64)| {
            let angle = std::f64::consts::PI * number * share;
            power * (libm::sin(angle) / angle).powi(2)
        };
        let powers = (1..).map(f64::from).zip(&self.powers).map(mean).collect();
        Self { powers, ..*self }
    }
}

/// Powers `|F|²/N²` of the waves of N numbers on a rectangle: they add up to the mean square.
#[derive(Clone, Debug)]
pub(super) struct Powers {
    columns: usize,
    rows: usize,
    /// Of eight wave numbers across side by side: row by row of those along, for the first eight, the next and so on,
    /// up to half the columns. The others are those of waves that run the other way.
    values: Vec<Lanes>,
}

/// Mean fourth power of a Hann window over the square of its mean square.
const HANN: f64 = 35.0 / 18.0;
/// Fewest numbers either way.
pub const FEWEST: usize = WIDTH;

impl Powers {
    /// * `columns`, `rows` – powers of two, at least [`FEWEST`]
    /// * `value` – of a row and a column
    pub(super) fn new(
        columns: usize,
        rows: usize,
        threads: usize,
        value: impl Fn(usize, usize) -> f64 + Sync,
    ) -> Self {
        let transform = InverseTransform::new(columns);
        // So many groups of eight columns hold the first half of the waves, and the one in the middle.
        let groups = columns / 2 / WIDTH + 1;
        // Sixteen rows at a time, eight as real and eight as imaginary part.
        let pairs: Vec<Vec<Complex>> = par_map(threads, rows.div_ceil(2 * WIDTH), |pair| {
            let first = pair * 2 * WIDTH;
            let numbers = |first: usize, column: usize| {
                Lanes::from_fn(|lane| if first + lane < rows { value(first + lane, column) } else { 0.0 })
            };
            let both = |column| Complex { re: numbers(first, column), im: numbers(first + WIDTH, column) };
            let mut data: Vec<Complex> = (0..columns).map(both).collect();
            transform.run(&mut data);
            let mut rows = Vec::with_capacity(groups * 2 * WIDTH);
            for group in 0..groups {
                let parts: [[Complex; 2]; WIDTH] = from_fn(|i| {
                    let column = group * WIDTH + i;
                    data[column].of_both_parts(data[(columns - column) % columns])
                });
                for part in [0, 1] {
                    rows.extend((0..WIDTH).map(|row| Complex {
                        re: Lanes::from_fn(|column| parts[column][part].re.0[row]),
                        im: Lanes::from_fn(|column| parts[column][part].im.0[row]),
                    }));
                }
            }
            rows
        });
        let transform = InverseTransform::new(rows);
        let scale = Lanes::splat(((columns * rows) as f64).powi(-2));
        let powers = par_map(threads, groups, |group| {
            let at_once = rows.min(2 * WIDTH);
            let rows = pairs.iter().flat_map(|pair| &pair[group * 2 * WIDTH..][..at_once]);
            let mut data: Vec<Complex> = rows.copied().collect();
            transform.run(&mut data);
            data.iter().map(|z| (z.re * z.re + z.im * z.im) * scale).collect::<Vec<Lanes>>()
        });
        Self { columns, rows, values: powers.concat() }
    }

    /// Power by wave number in cross and in machine direction, of either sign.
    pub(super) fn at(&self, across: i64, along: i64) -> f64 {
        let turned = |number: i64, count: usize| number.rem_euclid(count as i64) as usize;
        let (across, along) = (turned(across, self.columns), turned(along, self.rows));
        let (across, along) = if 2 * across > self.columns {
            (self.columns - across, (self.rows - along) % self.rows)
        } else {
            (across, along)
        };
        self.values[across / WIDTH * self.rows + along].0[across % WIDTH]
    }

    /// All wave numbers but the mean's, in cross and in machine direction.
    pub(super) fn numbers(&self) -> impl Iterator<Item = (i64, i64)> {
        let [columns, rows] = [self.columns, self.rows].map(|count| count as i64);
        let each = move |along| (-columns / 2..columns / 2).map(move |across| (across, along));
        (-rows / 2..rows / 2).flat_map(each).filter(|number| *number != (0, 0))
    }

    /// Adds a wave to the parts to which it belongs.
    ///
    /// * `places` – of the filaments
    /// * `reach` – wave numbers along the web to which a window spreads a streak
    /// * `gain` – factor of its power
    pub(super) fn add(
        &self,
        (across, along): (i64, i64),
        places: &Places,
        reach: i64,
        gain: f64,
        to: &mut Parts,
    ) {
        if along.abs() > reach {
            to.other_waves.add(gain * self.at(across, along));
        } else if along == 0 && across != 0 {
            let power = gain * (-reach..=reach).map(|along| self.at(across, along)).sum::<f64>();
            to.streak_power += power;
            match places {
                Places::Unknown => to.streaks.add(power),
                Places::Known(streaks) => {
                    let mean = streaks.power(across);
                    let (mut same, mut chance) = (0.0, mean);
                    if streaks.has_rows {
                        // Other chance has as much of this wave as of the next ones.
                        chance += 0.5 * gain * (self.at(across, reach + 1) + self.at(across, -reach - 1));
                        same = (power - mean).max(0.0);
                    }
                    to.expected += same + mean;
                    to.expected_variance += 2.0 * mean * mean + 4.0 * same * chance;
                }
            }
        }
    }

    /// Variance of the mean of a sheet that is cut out of a larger one: the power of its longest waves, which
    /// the mean continues.
    ///
    /// * `closed` – directions in which the sheet is closed, so that the mean is known
    pub(super) fn variance_of_mean(&self, closed: [bool; 2]) -> f64 {
        let line = |waves: [(i64, i64); 4]| {
            0.25 * waves.map(|(across, along)| self.at(across, along)).iter().sum::<f64>()
        };
        let across = line([(1, 0), (-1, 0), (2, 0), (-2, 0)]);
        let along = line([(0, 1), (0, -1), (0, 2), (0, -2)]);
        match closed {
            [true, true] => 0.0,
            [false, true] => across,
            [true, false] => along,
            [false, false] => across.max(along),
        }
    }
}

/// A variance in parts, from the powers of independent waves.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Parts {
    /// Waves across the web that are the same along all of it: their sum as it has been found.
    streak_power: f64,
    /// These waves where nothing else is known of them.
    streaks: WaveSums,
    /// Where it is known, their mean over webs and the variance of what is found.
    expected: f64,
    expected_variance: f64,
    /// All other waves.
    other_waves: WaveSums,
}

/// Sums over waves and those that run the other way, which are the same.
#[derive(Clone, Copy, Debug, Default)]
struct WaveSums {
    powers: f64,
    squares: f64,
}

impl WaveSums {
    fn add(&mut self, power: f64) {
        self.powers += power;
        self.squares += power * power;
    }

    /// Variance of the sum of the powers. For a normal field each has the standard deviation of its mean, and
    /// waves of opposite sign are one, so it is twice the sum of squared means, or the sum of squares. That
    /// of few waves is too small beside the square of their sum: for equal waves by just the denominator.
    fn variance(self) -> f64 {
        if self.powers > 0.0 {
            let share = self.squares / (self.powers * self.powers);
            self.squares / (1.0 - share).max(f64::MIN_POSITIVE)
        } else {
            0.0
        }
    }
}

impl Parts {
    /// The variance of the field in these waves.
    pub(super) fn sum(&self) -> f64 {
        self.streak_power + self.other_waves.powers
    }

    /// The variance of that variance over webs of the kind, over its square. Where it is known how strong
    /// streaks are on average, it does not depend on how strong they have come out.
    ///
    /// * `open` – directions, cross and machine, in which a Hann window makes one wave of two
    pub(super) fn share(&self, open: [bool; 2]) -> f64 {
        let [across, along] = open.map(|open| if open { HANN } else { 1.0 });
        let mean = self.streaks.powers + self.expected + self.other_waves.powers;
        let variance =
            across * (self.streaks.variance() + along * self.other_waves.variance() + self.expected_variance);
        if mean > 0.0 { variance / (mean * mean) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the sums of the definition, on the smallest rectangle and on others.
    #[test]
    fn analytic_powers_are_those_of_the_sums() {
        for (columns, rows) in [(8, 8), (16, 8), (8, 32), (32, 16)] {
            let value = |row: usize, column: usize| (7.3 * row as f64 + 1.9 * (column * column) as f64).sin();
            let powers = Powers::new(columns, rows, 2, value);
            let numbers = (columns * rows) as f64;
            for (across, along) in powers.numbers().chain([(0, 0)]) {
                let (mut re, mut im) = (0.0, 0.0);
                for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
                    let turns = across as f64 * column as f64 / columns as f64
                        + along as f64 * row as f64 / rows as f64;
                    let (sin, cos) = (2.0 * std::f64::consts::PI * turns).sin_cos();
                    (re, im) = (re + cos * value(row, column), im + sin * value(row, column));
                }
                let expected = (re * re + im * im) / (numbers * numbers);
                let found = powers.at(across, along);
                assert!((found - expected).abs() < 1e-14, "{across} {along}: {found} {expected}");
            }
        }
    }

    /// Waves of amplitude 1 with these numbers across and along, on 16 x 32.
    fn waves(numbers: &[(i64, i64)]) -> Powers {
        Powers::new(16, 32, 1, |row, column| {
            let turns = |(across, along): &(i64, i64)| {
                *across as f64 * column as f64 / 16.0 + *along as f64 * row as f64 / 32.0
            };
            numbers.iter().map(|wave| (2.0 * std::f64::consts::PI * turns(wave)).cos()).sum::<f64>()
        })
    }

    /// Either sense of a wave of amplitude 1 has the power ¼.
    #[test]
    fn analytic_the_mean_continues_the_longest_waves() {
        let of = |numbers: &[(i64, i64)]| {
            [[true, true], [false, true], [true, false], [false, false]]
                .map(|closed| waves(numbers).variance_of_mean(closed))
        };
        let is_near = |found: [f64; 4], wanted: [f64; 4]| {
            found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-14)
        };
        assert!(is_near(of(&[(1, 0), (2, 0), (3, 0)]), [0.0, 0.25, 0.0, 0.25]));
        assert!(is_near(of(&[(0, 1), (0, 3)]), [0.0, 0.0, 0.125, 0.125]));
        assert!(is_near(of(&[(1, 0), (0, 1), (0, 2)]), [0.0, 0.125, 0.25, 0.25]));
    }

    /// One streak across the web, one wave that is nearly one, and one wave of any other kind.
    #[test]
    fn analytic_a_variance_divides_into_streaks_and_other_waves() {
        let powers = waves(&[(1, 0), (1, 1), (3, 5)]);
        let parts = |places: &Places, reach: i64, gain: f64| {
            let mut parts = Parts::default();
            powers.numbers().for_each(|wave| powers.add(wave, places, reach, gain, &mut parts));
            parts
        };
        let is_near = |found: f64, wanted: f64| (found / wanted - 1.0).abs() < 1e-12;
        let streaks = |has_rows: bool, powers: &[f64]| {
            Places::Known(Streaks { variance_of_mean: 0.0, powers: powers.to_vec(), has_rows })
        };
        for (places, share) in [
            // Two equal waves of each of the two kinds: ¼ of each over ½; four of the others.
            (Places::Unknown, (0.25 + 1.0 / 3.0) / 2.25),
            // The streak has ¼ in each sense, and the waves next to it have half of ¼.
            (streaks(true, &[]), (0.25 + 1.0 / 3.0) / 2.25),
            (streaks(false, &[0.3]), (0.36 + 1.0 / 3.0) / (1.6 * 1.6)),
            // Chance alone makes more than what is there; or less, with 0.05 that is the same in all webs.
            (streaks(true, &[0.3]), (0.36 + 1.0 / 3.0) / (1.6 * 1.6)),
            (streaks(true, &[0.2]), (0.16 + 0.4 * 0.325 + 1.0 / 3.0) / 2.25),
        ] {
            let found = parts(&places, 0, 1.0);
            assert!(is_near(found.sum(), 1.5), "{places:?}: {}", found.sum());
            assert!(is_near(found.share([false; 2]), share), "{places:?}: {}", found.share([false; 2]));
            assert!(is_near(parts(&places, 0, 2.0).sum(), 3.0));
            if [Places::Unknown, streaks(true, &[])].contains(&places) {
                assert!(is_near(parts(&places, 0, 2.0).share([false; 2]), share), "{places:?}");
            }
            // A window that spreads a streak to the next waves along the web takes these to it.
            assert!(is_near(parts(&places, 1, 1.0).sum(), 1.5));
        }
        assert!(is_near(parts(&Places::Unknown, 1, 1.0).streaks.powers, 1.0));
    }

    #[test]
    fn analytic_windows_make_one_wave_of_two() {
        let equal = WaveSums { powers: 8.0, squares: 8.0 };
        // As eight equal waves, of which the mean is known from themselves.
        let others = Parts { other_waves: equal, ..Parts::default() };
        let both = Parts { streaks: equal, ..others };
        for (open, of_others, of_both) in [
            ([false, false], 1.0 / 7.0, 0.5 / 7.0),
            ([true, false], HANN / 7.0, HANN * 0.5 / 7.0),
            ([false, true], HANN / 7.0, 0.25 * (1.0 + HANN) / 7.0),
            ([true, true], HANN * HANN / 7.0, HANN * 0.25 * (1.0 + HANN) / 7.0),
        ] {
            assert!((others.share(open) - of_others).abs() < 1e-14, "{open:?}");
            assert!((both.share(open) - of_both).abs() < 1e-14, "{open:?}");
        }
        let known = Parts { expected: 8.0, expected_variance: 16.0, ..Parts::default() };
        assert_eq!((known.share([false; 2]), Parts::default().share([true; 2])), (0.25, 0.0));
    }

    /// Over half a sheet the wave of one period keeps (2/π)² of its power, and that of two periods nothing.
    #[test]
    fn analytic_streaks_over_a_part_of_the_sheet() {
        let streaks = Streaks { variance_of_mean: 0.7, powers: vec![1.0, 1.0], has_rows: false };
        let half = streaks.over(0.5);
        assert!((half.power(1) - 4.0 / std::f64::consts::PI.powi(2)).abs() < 1e-15 && half.power(2) < 1e-30);
        assert_eq!((half.power(-1), half.variance_of_mean), (half.power(1), 0.7));
        assert_eq!([streaks.power(0), streaks.power(3)], [0.0; 2]);
    }
}
