//! Designs: how the values of the factors are combined into points.

use super::{RandomUse, stream};
use rand_chacha::rand_core::Rng;
use spunlaid_fibre::case::keys::VariedKey;
use spunlaid_ground::random::uniform;

/// A key that varies.
#[derive(Clone, Debug, PartialEq)]
pub struct Factor {
    /// The key.
    pub key: VariedKey,
    /// The values it takes.
    pub levels: Levels,
}

/// The values a factor takes, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub enum Levels {
    /// A list of values.
    List(Vec<f64>),
    /// A range between two ends.
    Range {
        /// One end.
        from: f64,
        /// The other end.
        to: f64,
        /// Number of values, both ends included; `None` where the design draws the values.
        steps: Option<u64>,
        /// How the values are spaced.
        spacing: Spacing,
    },
}

named! {
    /// How values are spaced over a range.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Spacing {
        /// With equal differences.
        Linear = "linear",
        /// With equal ratios.
        Logarithmic = "log",
    }
}

/// How the values of the factors are combined into points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Design {
    /// Every combination of values.
    Grid,
    /// The base case, and points in which one factor differs from it.
    OneAtATime,
    /// The first value of every factor, then the second value of every factor, and so on.
    Paired,
    /// This number of points; the range of each factor is divided into as many slices, and each slice holds one point.
    LatinHypercube(u64),
}

impl Design {
    /// Name in the study file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Grid => "grid",
            Self::OneAtATime => "one-at-a-time",
            Self::Paired => "paired",
            Self::LatinHypercube(_) => "latin-hypercube",
        }
    }

    /// All of them; those that draw have this number of points.
    pub const fn all(points: u64) -> [Self; 4] {
        [Self::Grid, Self::OneAtATime, Self::Paired, Self::LatinHypercube(points)]
    }

    /// Whether it draws values from the ranges instead of using the listed values.
    pub const fn draws(self) -> bool {
        matches!(self, Self::LatinHypercube(_))
    }

    /// Number of points; a floating-point number, because a large grid may exceed the range of an integer.
    ///
    /// * `base` – values of the factors in the base case
    pub fn count(self, factors: &[Factor], base: &[f64]) -> f64 {
        match self {
            Self::Grid => factors.iter().map(|factor| factor.levels.count() as f64).product(),
            Self::OneAtATime => {
                1.0 + factors.iter().zip(base).map(|(f, b)| f.other_values(*b).len() as f64).sum::<f64>()
            }
            Self::Paired => factors.first().map_or(0.0, |factor| factor.levels.count() as f64),
            Self::LatinHypercube(points) => points as f64,
        }
    }

    /// The values of the factors at every point.
    ///
    /// * `base` – values of the factors in the base case
    pub fn rows(self, factors: &[Factor], base: &[f64], seed: u64) -> Vec<Vec<f64>> {
        let values: Vec<Vec<f64>> = factors.iter().map(Factor::values).collect();
        match self {
            Self::Grid => grid(&values),
            Self::OneAtATime => {
                let mut rows = vec![base.to_vec()];
                for (i, factor) in factors.iter().enumerate() {
                    for value in factor.other_values(base[i]) {
                        let mut row = base.to_vec();
                        row[i] = value;
                        rows.push(row);
                    }
                }
                rows
            }
            Self::Paired => {
                let count = values.iter().map(Vec::len).min().unwrap_or(0);
                (0..count).map(|k| values.iter().map(|column| column[k]).collect()).collect()
            }
            Self::LatinHypercube(points) => {
                let shares: Vec<Vec<f64>> =
                    (0..factors.len()).map(|i| latin(points, seed, i as u64)).collect();
                let row = |k: usize| factors.iter().zip(&shares).map(|(f, shares)| f.at(shares[k])).collect();
                (0..points as usize).map(row).collect()
            }
        }
    }
}

/// Every combination of values; the last factor varies fastest.
fn grid(values: &[Vec<f64>]) -> Vec<Vec<f64>> {
    values.iter().fold(vec![Vec::new()], |rows, levels| {
        let longer = |row: &Vec<f64>| {
            let row = row.clone();
            levels.iter().map(move |&value| row.iter().copied().chain([value]).collect())
        };
        rows.iter().flat_map(longer).collect()
    })
}

/// One share in each slice of [0, 1), in random order.
fn latin(points: u64, seed: u64, factor: u64) -> Vec<f64> {
    let mut random = stream(seed, RandomUse::LatinHypercube, factor);
    let mut order: Vec<u64> = (0..points).collect();
    // Shuffle of Fisher and Yates. The bias of the remainder is negligible because `last` is far below 2⁶⁴.
    for last in (1..order.len()).rev() {
        let other = random.next_u64() % (last as u64 + 1);
        order.swap(last, other as usize);
    }
    let mut share = || uniform(&mut random);
    order.into_iter().map(|slice| (slice as f64 + share()) / points as f64).collect()
}

impl Factor {
    /// Its values, in the order of the file.
    pub fn values(&self) -> Vec<f64> {
        let values = match &self.levels {
            Levels::List(values) => values.clone(),
            Levels::Range { steps, .. } => {
                let last = steps.unwrap_or(0).saturating_sub(1);
                (0..steps.unwrap_or(0)).map(|i| self.levels.between(i as f64 / last.max(1) as f64)).collect()
            }
        };
        values.into_iter().map(|value| self.rounded(value)).collect()
    }

    /// Its values without the value of the base case.
    fn other_values(&self, base: f64) -> Vec<f64> {
        self.values().into_iter().filter(|value| *value != base).collect()
    }

    /// The value at a fraction in [0, 1) of its range or list.
    fn at(&self, share: f64) -> f64 {
        let value = match &self.levels {
            Levels::List(values) => {
                let index = (share * values.len() as f64) as usize;
                values.get(index.min(values.len().saturating_sub(1))).copied().unwrap_or(f64::NAN)
            }
            Levels::Range { .. } => self.levels.between(share),
        };
        self.rounded(value)
    }

    fn rounded(&self, value: f64) -> f64 {
        if self.key.is_whole() { value.round() } else { value }
    }

    /// Least and greatest value.
    pub fn ends(&self) -> (f64, f64) {
        let ends = |values: &[f64]| {
            values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &v| (a.min(v), b.max(v)))
        };
        match &self.levels {
            Levels::List(values) => ends(values),
            Levels::Range { from, to, .. } => ends(&[*from, *to]),
        }
    }

    /// Its values without repetitions, in the order of the file.
    pub fn levels(&self) -> Vec<f64> {
        let mut levels = Vec::new();
        for value in self.values() {
            if !levels.contains(&value) {
                levels.push(value);
            }
        }
        levels
    }

    /// How its values are spaced.
    pub fn spacing(&self) -> Spacing {
        match &self.levels {
            Levels::Range { spacing, .. } => *spacing,
            Levels::List(_) => Spacing::Linear,
        }
    }

    /// Position of a value in the range: −1 at the least value, +1 at the greatest; logarithmic where so spaced.
    pub fn place(&self, value: f64) -> f64 {
        self.place_between(value, self.ends())
    }

    /// Position of a value between two others: −1 at the first, +1 at the second; logarithmic where so spaced.
    pub(super) fn place_between(&self, value: f64, (least, greatest): (f64, f64)) -> f64 {
        let share = match self.spacing() {
            Spacing::Linear => (value - least) / (greatest - least),
            Spacing::Logarithmic => libm::log(value / least) / libm::log(greatest / least),
        };
        if share.is_finite() { 2.0 * share - 1.0 } else { 0.0 }
    }
}

impl Levels {
    /// Number of values; 0 for a range without steps.
    pub fn count(&self) -> u64 {
        match self {
            Self::List(values) => values.len() as u64,
            Self::Range { steps, .. } => steps.unwrap_or(0),
        }
    }

    fn between(&self, share: f64) -> f64 {
        match *self {
            Self::List(_) => f64::NAN,
            Self::Range { from, .. } if share == 0.0 => from,
            // The end must be exact; the formulas below would round it.
            Self::Range { to, .. } if share == 1.0 => to,
            Self::Range { from, to, spacing: Spacing::Linear, .. } => from + (to - from) * share,
            Self::Range { from, to, spacing: Spacing::Logarithmic, .. } => from * libm::pow(to / from, share),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spunlaid_fibre::case::keys::{Kind, Sign};
    use spunlaid_ground::Dimension;

    fn factor(levels: Levels) -> Factor {
        let kind = Kind::Quantity(Dimension::Velocity, Sign::Any);
        Factor { key: VariedKey::new("air.velocity", kind), levels }
    }

    fn range(from: f64, to: f64, steps: u64, spacing: Spacing) -> Factor {
        factor(Levels::Range { from, to, steps: Some(steps), spacing })
    }

    #[test]
    fn ranges_end_where_they_say() {
        assert_eq!(range(0.1, 0.7, 4, Spacing::Linear).values()[3], 0.7);
        let log = range(20e-6, 200e-6, 3, Spacing::Logarithmic).values();
        assert_eq!((log[0], log[2]), (20e-6, 200e-6));
        assert!((log[1] / log[0] / (log[2] / log[1]) - 1.0).abs() < 1e-15);
        assert_eq!(range(3.0, 9.0, 1, Spacing::Linear).values(), [3.0]);
        let down = range(9.0, 3.0, 3, Spacing::Linear);
        assert_eq!(down.values(), [9.0, 6.0, 3.0]);
        assert_eq!([9.0, 6.0, 3.0].map(|value| down.place(value)), [1.0, 0.0, -1.0]);
    }

    #[test]
    fn grids_hold_every_combination_once() {
        let factors = [factor(Levels::List(vec![1.0, 2.0])), factor(Levels::List(vec![7.0, 8.0, 9.0]))];
        let rows = Design::Grid.rows(&factors, &[0.0; 2], 1);
        assert_eq!(rows.len() as f64, Design::Grid.count(&factors, &[0.0; 2]));
        assert_eq!(rows[..4], [[1.0, 7.0], [1.0, 8.0], [1.0, 9.0], [2.0, 7.0]]);
    }

    #[test]
    fn one_at_a_time_starts_from_the_base_and_does_not_repeat_it() {
        let factors = [factor(Levels::List(vec![1.0, 2.0, 3.0])), factor(Levels::List(vec![7.0, 8.0]))];
        let rows = Design::OneAtATime.rows(&factors, &[2.0, 9.0], 1);
        assert_eq!(rows, [[2.0, 9.0], [1.0, 9.0], [3.0, 9.0], [2.0, 7.0], [2.0, 8.0]]);
        assert_eq!(Design::OneAtATime.count(&factors, &[2.0, 9.0]), 5.0);
    }

    #[test]
    fn latin_hypercubes_hit_every_slice_of_every_factor_once() {
        let factors = [range(0.0, 1.0, 2, Spacing::Linear), range(1.0, 100.0, 2, Spacing::Logarithmic)];
        let rows = Design::LatinHypercube(97).rows(&factors, &[0.0; 2], 5);
        for (i, factor) in factors.iter().enumerate() {
            let slice = |row: &Vec<f64>| ((factor.place(row[i]) + 1.0) / 2.0 * 97.0).floor() as usize;
            let mut slices: Vec<usize> = rows.iter().map(slice).collect();
            assert_ne!(slices, (0..97).collect::<Vec<_>>(), "not in order");
            slices.sort_unstable();
            assert_eq!(slices, (0..97).collect::<Vec<_>>());
        }
        assert_eq!(rows, Design::LatinHypercube(97).rows(&factors, &[0.0; 2], 5));
        assert_ne!(rows, Design::LatinHypercube(97).rows(&factors, &[0.0; 2], 6));
        assert_ne!(
            rows.iter().map(|row| factors[0].place(row[0])).collect::<Vec<_>>(),
            rows.iter().map(|row| factors[1].place(row[1])).collect::<Vec<_>>()
        );
    }

    #[test]
    fn lists_are_drawn_from_evenly() {
        let factors = [factor(Levels::List(vec![5.0, 6.0, 7.0, 8.0]))];
        let rows = Design::LatinHypercube(8).rows(&factors, &[0.0], 1);
        let mut drawn: Vec<f64> = rows.into_iter().map(|row| row[0]).collect();
        drawn.sort_by(f64::total_cmp);
        assert_eq!(drawn, [5.0, 5.0, 6.0, 6.0, 7.0, 7.0, 8.0, 8.0]);
    }
}
