//! How deviations of filaments vary together, over the distance of their inlets.

use super::{Curtain, FlownCurves};
use spunlaid_ground::statistics::{dot, solve_positive};
use spunlaid_ground::threads::par_map;
use std::collections::BTreeMap;

/// Points of a curve at which products are taken, at most: points near each other give the same.
const POINTS: usize = 512;
/// Smallest correlation of nearest neighbours that is distinguished from none.
const LEAST: f64 = 0.01;
/// From scale to scale across, and along the machine direction.
const RATIOS: [f64; 2] = [1.5, 2.0];
/// Longest scales, in the width and in the depth of the curtain; beyond them there is only an infinite one.
const LONGEST: [f64; 2] = [0.5, 2.0];
/// From class to class of distances.
const CLASS: f64 = 1.25;
/// Shortest distance along the machine direction that is distinguished from zero, in parts of the depth.
const NEAREST: f64 = 1.0 / 32.0;
/// Accuracy that is asked for of a covariance, in parts of the variance, beside the same part of what is
/// missing to the variance: this is what the error of a filling rests on.
const ACCURACY: f64 = 0.02;
/// Fits, each weighted by the one before.
const FITS: usize = 3;
/// Terms with smaller parts of the variance are left out.
const SMALLEST: f64 = 1e-6;
/// Scales above this part of the turn are felt all the way round.
const ROUND: f64 = 1.0 / 12.0;

/// Covariance of the deviations in a direction: a sum of normal curves with parts that are not negative, and
/// so a covariance whatever the parts are.                                                    theory.md (83g)
#[derive(Clone, Debug)]
pub struct Covariance {
    /// [m²]
    variance: f64,
    terms: Vec<Term>,
}

/// A term, as a part of the variance.
#[derive(Clone, Debug)]
struct Term {
    part: f64,
    across: Across,
    /// Along the machine direction.
    along: Scale,
}

/// A scale [m], as `1/2ℓ²`; zero of one that is infinite.
#[derive(Clone, Copy, Debug)]
struct Scale(f64);

impl Scale {
    fn new(length: f64) -> Self {
        Self(if length.is_finite() { 0.5 / (length * length) } else { 0.0 })
    }

    fn at(self, distance: f64) -> f64 {
        let exponent = self.0 * distance * distance;
        // Beyond this nothing is left in single precision.
        if exponent < 40.0 { libm::exp(-exponent) } else { 0.0 }
    }
}

/// A scale across, and the turns of a curtain that repeats itself.
#[derive(Clone, Copy, Debug)]
struct Across {
    scale: Scale,
    turn: f64,
    turns: i32,
    /// Of all turns at no distance.
    whole: f64,
}

impl Across {
    fn new(length: f64, turn: Option<f64>) -> Self {
        let turn = turn.unwrap_or(f64::INFINITY);
        let far = length.is_finite() && length > ROUND * turn;
        let turns = if far { (6.0 * length / turn).ceil() as i32 } else { 0 };
        let across = Self { scale: Scale::new(length), turn, turns, whole: 1.0 };
        Self { whole: across.at(0.0), ..across }
    }

    fn at(&self, distance: f64) -> f64 {
        if self.turns == 0 {
            return self.scale.at(distance);
        }
        let all = -self.turns..=self.turns;
        all.map(|turn| self.scale.at(distance + f64::from(turn) * self.turn)).sum::<f64>() / self.whole
    }
}

/// Sums over the pairs whose distances are about equal.
#[derive(Clone, Debug, Default)]
struct Class {
    pairs: f64,
    /// Of the mean squares of differences, in machine and in cross direction [m²].
    squares: [f64; 2],
    /// Of each curve that may be a term.
    curves: Vec<f64>,
}

impl Covariance {
    /// In machine and in cross direction, fitted to the differences of all pairs of simulated filaments.
    ///
    /// * `shortest` – scale, in mean distances of filaments, and at most, in the scale that nearest
    ///   neighbours alone would give. Between neighbours the flight does not give the covariance: what
    ///   shorter scales explain passes for what each filament does for itself
    pub(crate) fn fit(simulated: &FlownCurves, shortest: [f64; 2], threads: usize) -> [Self; 2] {
        let places = simulated.places();
        let deviations = samples(simulated);
        let [width, pitch] = simulated.width_and_pitch();
        let depth = simulated.depth();
        let shortest = shortest_scale(simulated, &deviations, shortest);
        let scales = |axis: usize, size: f64| -> Vec<f64> {
            let all = (0..).map(move |n: i32| shortest * RATIOS[axis].powi(n));
            let all = all.take_while(move |scale| *scale > 0.0 && *scale < LONGEST[axis] * size);
            all.chain([f64::INFINITY]).collect()
        };
        let across = scales(0, width).into_iter().map(|scale| Across::new(scale, simulated.turn()));
        let across: Vec<Across> = across.collect();
        let along: Vec<Scale> = scales(1, depth).into_iter().map(Scale::new).collect();
        let class = |[z, y]: [f64; 2]| {
            let number = |distance: f64, nearest: f64| match distance > 0.5 * nearest {
                true => 1 + (libm::log(distance / nearest) / libm::log(CLASS)).round() as i32,
                false => i32::MIN,
            };
            (number(z.abs(), pitch), number(y.abs(), NEAREST * depth))
        };
        let sums = par_map(threads, places.len(), |one| {
            let mut classes: BTreeMap<(i32, i32), Class> = BTreeMap::new();
            for other in one + 1..places.len() {
                let apart = simulated.apart(places[one], places[other]);
                let class = classes.entry(class(apart)).or_default();
                class.curves.resize(across.len() * along.len(), 0.0);
                class.pairs += 1.0;
                for (d, sum) in class.squares.iter_mut().enumerate() {
                    let pairs = deviations[one][d].iter().zip(&deviations[other][d]);
                    let squares = pairs.map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
                    *sum += squares / deviations[one][d].len() as f64;
                }
                let in_depth: Vec<f64> = along.iter().map(|scale| scale.at(apart[1])).collect();
                for (sums, scale) in class.curves.chunks_exact_mut(along.len()).zip(&across) {
                    let across = scale.at(apart[0]);
                    sums.iter_mut().zip(&in_depth).for_each(|(sum, along)| *sum += across * along);
                }
            }
            classes
        });
        let mut classes: BTreeMap<(i32, i32), Class> = BTreeMap::new();
        for (key, of_one) in sums.into_iter().flatten() {
            let class = classes.entry(key).or_default();
            class.curves.resize(of_one.curves.len(), 0.0);
            class.pairs += of_one.pairs;
            (0..2).for_each(|d| class.squares[d] += of_one.squares[d]);
            class.curves.iter_mut().zip(of_one.curves).for_each(|(sum, curve)| *sum += curve);
        }
        let classes: Vec<Class> = classes.into_values().collect();
        let most = places.len() as f64;
        [0, 1].map(|d| {
            let squares = deviations.iter().map(|of| dot(&of[d], &of[d]) / of[d].len() as f64);
            let variance = squares.sum::<f64>() / most;
            if variance.is_nan() || variance <= 0.0 {
                return Self { variance: 0.0, terms: Vec::new() };
            }
            let parts = parts(d, &classes, variance, most);
            let term = |(number, part): (usize, f64)| {
                let across = across[number / along.len()];
                let along = along[number % along.len()];
                (part > SMALLEST).then_some(Term { part, across, along })
            };
            Self { variance, terms: parts.into_iter().enumerate().filter_map(term).collect() }
        })
    }

    /// A normal covariance.
    ///
    /// * `variance` – at one place [m²]
    /// * `scales` – across and along the machine direction; infinite where nothing changes [m]
    /// * `turn` – width after which the curtain repeats itself, of periodic edges [m]
    #[cfg(test)]
    pub(crate) fn normal(variance: f64, scales: [f64; 2], turn: Option<f64>) -> Self {
        let term = Term { part: 1.0, across: Across::new(scales[0], turn), along: Scale::new(scales[1]) };
        Self { variance, terms: vec![term] }
    }

    /// The variance at one place [m²].
    pub(crate) fn variance(&self) -> f64 {
        self.variance
    }

    /// The correlation at a distance across and along the machine direction [m]; across the shorter way round.
    pub fn correlation(&self, [z, y]: [f64; 2]) -> f64 {
        let at = |term: &Term| {
            let along = term.along.at(y);
            if along > 0.0 { term.part * along * term.across.at(z) } else { 0.0 }
        };
        self.terms.iter().map(at).sum()
    }

    /// Distance across at which half the correlation is left, up to a farthest one [m].
    pub(crate) fn half_distance(&self, farthest: f64) -> f64 {
        let mut between = [0.0, farthest];
        if self.correlation([farthest, 0.0]) >= 0.5 {
            return farthest;
        }
        for _ in 0..40 {
            let middle = 0.5 * (between[0] + between[1]);
            between[usize::from(self.correlation([middle, 0.0]) < 0.5)] = middle;
        }
        between[1]
    }
}

/// The parts of all terms in a variance. What is fitted are the differences of filaments, which are reported more
/// surely than their products, with weights by what the fit before says they are.
///
/// * `most` – pairs that count: those of the same filaments give the same
fn parts(direction: usize, classes: &[Class], variance: f64, most: f64) -> Vec<f64> {
    let size = classes.first().map_or(0, |class| class.curves.len());
    let missing = |class: &Class| 0.5 * class.squares[direction] / class.pairs / variance;
    let mut expected: Vec<f64> = classes.iter().map(missing).collect();
    let mut parts = Vec::new();
    for _ in 0..FITS {
        // All parts together are the variance.
        let mut rows = vec![vec![1.0 / ACCURACY * most.sqrt(); size]];
        let mut wanted = vec![1.0 / ACCURACY * most.sqrt()];
        for (class, expected) in classes.iter().zip(&expected) {
            let weight = class.pairs.min(most).sqrt() / (ACCURACY + expected);
            rows.push(class.curves.iter().map(|sum| weight * sum / class.pairs).collect());
            wanted.push(weight * (1.0 - missing(class)));
        }
        parts = not_negative(&rows, &wanted);
        let whole: f64 = parts.iter().sum();
        parts.iter_mut().for_each(|part| *part /= whole);
        let fitted = |class: &Class| 1.0 - dot(&class.curves, &parts) / class.pairs;
        expected = classes.iter().map(|class| fitted(class).max(0.0)).collect();
    }
    parts
}

/// The shortest scale that is looked for [m].
fn shortest_scale(simulated: &FlownCurves, deviations: &[[Vec<f64>; 2]], shortest: [f64; 2]) -> f64 {
    let places = simulated.places();
    let mut distances = 0.0;
    let mut products = [0.0; 2];
    let mut squares = [0.0; 2];
    for (one, place) in places.iter().enumerate() {
        let distance = |other: usize| {
            let [z, y] = simulated.apart(*place, places[other]);
            libm::hypot(z, y)
        };
        let others = (0..places.len()).filter(|other| *other != one).map(|other| (distance(other), other));
        let Some((distance, other)) = others.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
        distances += distance / places.len() as f64;
        for d in 0..2 {
            let [a, b] = [one, other].map(|i| &deviations[i][d]);
            products[d] += dot(a, b);
            squares[d] += 0.5 * (dot(a, a) + dot(b, b));
        }
    }
    let correlation = [0, 1].map(|d| products[d] / squares[d]).into_iter().fold(1.0, f64::min);
    let of_nearest = distances / (-2.0 * libm::log(correlation.max(LEAST))).sqrt();
    (shortest[0] * simulated.mean_distance()).min(shortest[1] * of_nearest)
}

/// Deviations from the mean of each filament, at points evenly spread along the curves.
fn samples(simulated: &FlownCurves) -> Vec<[Vec<f64>; 2]> {
    let count = simulated.points().min(POINTS);
    let of = |(filament, y): (usize, f64)| {
        [0, 1].map(|d| {
            let values = simulated.deviations(filament, d);
            let mean = simulated.mean(d, y);
            (0..count).map(|i| f64::from(values[i * values.len() / count]) - mean).collect()
        })
    };
    simulated.places().iter().map(|place| place.y).enumerate().map(of).collect()
}

/// The numbers x that are not negative with the least `|A x − b|²`, by the way of Lawson and Hanson on the
/// normal equations.
fn not_negative(rows: &[Vec<f64>], wanted: &[f64]) -> Vec<f64> {
    let size = rows.first().map_or(0, Vec::len);
    let product = |i: usize, j: usize| rows.iter().map(|row| row[i] * row[j]).sum::<f64>();
    let matrix: Vec<Vec<f64>> = (0..size).map(|i| (0..size).map(|j| product(i, j)).collect()).collect();
    let sides: Vec<f64> =
        (0..size).map(|i| rows.iter().zip(wanted).map(|(row, b)| row[i] * b).sum()).collect();
    let most = sides.iter().copied().fold(0.0, f64::max);
    let mut numbers = vec![0.0; size];
    let mut free: Vec<usize> = Vec::new();
    for _ in 0..3 * size {
        let slope = |i: usize| sides[i] - dot(&matrix[i], &numbers);
        let next = (0..size).filter(|i| !free.contains(i)).map(|i| (slope(i), i));
        let Some((slope, next)) = next.max_by(|a, b| a.0.total_cmp(&b.0)) else { break };
        if slope <= 1e-9 * most {
            break;
        }
        free.push(next);
        // Numbers that would become negative stop at zero.
        while let Some(found) = solve(&matrix, &sides, &free) {
            let step = free.iter().zip(&found).filter(|(_, new)| **new <= 0.0);
            let step = step.map(|(i, new)| numbers[*i] / (numbers[*i] - new)).fold(1.0, f64::min);
            for (i, new) in free.iter().zip(&found) {
                numbers[*i] += step * (new - numbers[*i]);
            }
            let before = free.len();
            free.retain(|i| numbers[*i] > 1e-12 && numbers[*i].is_finite());
            (0..size).filter(|i| !free.contains(i)).for_each(|i| numbers[i] = 0.0);
            if free.len() == before || free.is_empty() {
                break;
            }
        }
    }
    numbers
}

/// The numbers of some columns alone. Those of nearly equal columns are kept apart by a part of 10⁻¹⁰.
fn solve(matrix: &[Vec<f64>], sides: &[f64], columns: &[usize]) -> Option<Vec<f64>> {
    let entry = |i: usize, j: usize| if i == j { (1.0 + 1e-10) * matrix[i][i] } else { matrix[i][j] };
    let rows = columns.iter().map(|i| columns.iter().map(|j| entry(*i, *j)).collect()).collect();
    solve_positive(rows, columns.iter().map(|i| sides[*i]).collect())
}
