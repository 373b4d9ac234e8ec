//! Which factor matters, and how much: main effects with confidence intervals.
//!
//! The main effect of a factor is the change of a result from the least to the greatest value of the factor, on the
//! straight line that fits the points best while the other factors stay constant:
//!
//! ```text
//! y = b₀ + Σ b_j x_j + rest,  x_j = −1 … +1 over the range of factor j (of its logarithm if spaced so)
//! effect_j = 2 b_j
//! ```
//!
//! A factor of words has a term for each of its words but one, and an effect for each of its words but one: the mean of
//! the result with this word minus the mean with the word of reference, which is the first word of the list, or the
//! word of the base case in a one-at-a-time design. No word is chosen for its result, so each interval holds by itself.
//!
//! | design | fit |
//! |---|---|
//! | one-at-a-time | one line for each factor, through its own points and the base case only |
//! | Latin hypercube, Sobol | one fit; with enough points also `x_j² − 1/3` and `x_j x_k`, so that the curvature of one factor does not disturb the effect of another |
//! | others | one fit of straight lines |
//!
//! The interval comes from the replicates. With common phases, replicate r of all points is one experiment, and the
//! effects of these experiments differ as the turbulence does; noise that all points share cancels. With independent
//! phases, the variances of the points add up. In designs with drawn points the fit also misses what its terms do not
//! describe; this part, estimated from the residuals, widens the interval. Without replicates, the residuals are all
//! there is.

use super::journal::Journal;
use super::run::results_of_point;
use super::{Design, PointResults, Study};
use crate::error::Error;
use crate::observe::MEASURES;
use crate::statistics::student_t_95_at;

/// Main effects of a study.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rankings {
    /// One ranking for each measure that applies to all points; empty if the factors cannot be ranked.
    pub of_measures: Vec<Ranking>,
    /// Why the factors cannot be ranked.
    pub refusal: Option<Refusal>,
}

/// Main effects on one result, the largest first.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranking {
    /// Index into the [`MEASURES`].
    pub measure: usize,
    /// Value in the middle of all ranges; NaN for one-at-a-time designs, whose lines have no common middle.
    pub middle: f64,
    /// Fraction of the variation between points that straight lines explain (adjusted R²); NaN if there are too few
    /// points to tell.
    pub explained: f64,
    /// The effects.
    pub effects: Vec<Effect>,
    /// The terms of the fit with their coefficients, without the constant.
    pub terms: Vec<(Term, f64)>,
}

/// The main effect of a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effect {
    /// Index of the factor.
    pub factor: usize,
    /// The value that the change starts from: the least value, or the word of reference.
    pub from: f64,
    /// The value that the change leads to: the greatest value, or another word. There is an effect for each of them.
    pub to: f64,
    /// Change of the result.
    pub change: f64,
    /// Half the width of its 95 % confidence interval; `None` if neither replicates nor residuals tell it.
    pub half_width: Option<f64>,
}

impl Effect {
    /// Whether it is the effect of the same change of the same factor, on another result.
    pub fn is_like(&self, other: &Self) -> bool {
        (self.factor, self.from, self.to) == (other.factor, other.from, other.to)
    }
}

/// Why the factors of a study are not ranked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// The fit would pass through all points.
    #[error(
        "{points} points cannot rank {keys} keys: the fit would pass through every point, whatever the results; fly at \
         least {needed} points"
    )]
    TooFewPoints {
        /// Number of points.
        points: usize,
        /// Number of factors.
        keys: usize,
        /// Smallest number of points that can be ranked.
        needed: usize,
    },
    /// A factor has only one value.
    #[error("{key} has the same value at all points; give it at least two values")]
    OneValue {
        /// Its key.
        key: &'static str,
    },
    /// Two factors vary together.
    #[error(
        "{first} and {second} vary together (correlation {correlation:.2}), so their effects cannot be told apart; vary \
         them independently, for example with design = \"grid\""
    )]
    Together {
        /// Key of the one.
        first: &'static str,
        /// Key of the other.
        second: &'static str,
        /// Correlation of their values.
        correlation: f64,
    },
    /// Several factors depend on each other.
    #[error("{key} follows from the other keys at all points, so its effect cannot be told from theirs")]
    Dependent {
        /// Key of one of them.
        key: &'static str,
    },
    /// A point has no result.
    #[error("point {point} has no fibre that was completed")]
    NoResult {
        /// Number of the point, counted from 1.
        point: usize,
    },
}

/// Largest variance inflation of an effect by the correlation of factors; 10 is a correlation of 0.95 between two.
const MOST_INFLATION: f64 = 10.0;

/// The rankings of all measures, or the reason why there are none.
///
/// # Errors
/// When the journal cannot be read.
pub fn rankings(study: &Study, journal: &mut Journal) -> Result<Rankings, Error> {
    let refused = |refusal| Ok(Rankings { of_measures: Vec::new(), refusal: Some(refusal) });
    if study.factors.is_empty() {
        return Ok(Rankings::default());
    }
    let fits = match fits(study) {
        Ok(fits) => fits,
        Err(refusal) => return refused(refusal),
    };
    let mut solved = Vec::with_capacity(fits.len());
    for fit in &fits {
        match Solution::new(fit, journal)? {
            Ok(solution) => solved.push(solution),
            Err(refusal) => return refused(refusal),
        }
    }
    let ranking = |measure: usize| {
        let mut effects = Vec::new();
        for solution in &solved {
            effects.extend_from_slice(&solution.effects[measure]);
        }
        effects.sort_by(|a, b| b.change.abs().total_cmp(&a.change.abs()));
        let terms = fits.iter().zip(&solved).flat_map(|(fit, solution)| {
            fit.terms.iter().copied().zip(solution.coefficients[measure].iter().skip(1).copied())
        });
        let middle = match solved.as_slice() {
            [one] if study.design != Design::OneAtATime => one.coefficients[measure][0],
            _ => f64::NAN,
        };
        Ranking {
            measure,
            middle,
            explained: explained(&fits, &solved, measure),
            effects,
            terms: terms.collect(),
        }
    };
    let applies = |measure: &usize| {
        solved.iter().all(|solution| solution.coefficients[*measure].iter().all(|b| b.is_finite()))
    };
    Ok(Rankings { of_measures: (0..MEASURES.len()).filter(applies).map(ranking).collect(), refusal: None })
}

impl Ranking {
    /// A point's mean without the fitted contributions of all factors but one: what is left to plot over this factor.
    ///
    /// * `mean` – mean of the measure at the point
    pub fn adjusted(&self, study: &Study, point: usize, factor: usize, mean: f64) -> f64 {
        let values = &study.points[point].values;
        let place = |factor: usize| study.factors[factor].place(values[factor]);
        let others = self.terms.iter().filter(|(term, _)| !term.is_of(factor));
        mean - others.map(|(term, b)| b * term.at(&place, values)).sum::<f64>()
    }
}

/// A term of a fit; `x_j` is the place of factor j, −1 … +1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Term {
    /// `x_j`.
    Line(usize),
    /// `x_j² − 1/3`, whose mean over the range is zero.
    Square(usize),
    /// `x_j x_k`.
    Product(usize, usize),
    /// 1 where a factor of words has the first word, −1 where it has the second, the word of reference; otherwise 0.
    Word(usize, f64, f64),
}

impl Term {
    fn at(self, place: &dyn Fn(usize) -> f64, values: &[f64]) -> f64 {
        match self {
            Self::Line(j) => place(j),
            Self::Square(j) => place(j) * place(j) - 1.0 / 3.0,
            Self::Product(j, k) => place(j) * place(k),
            Self::Word(j, this, reference) => {
                f64::from(values[j] == this) - f64::from(values[j] == reference)
            }
        }
    }

    /// Whether it belongs to this factor alone.
    fn is_of(self, factor: usize) -> bool {
        matches!(self, Self::Line(j) | Self::Square(j) | Self::Word(j, ..) if j == factor)
    }

    /// Whether it is part of the main effects.
    fn is_main(self) -> bool {
        matches!(self, Self::Line(_) | Self::Word(..))
    }
}

/// A least-squares fit over some points.
struct Fit<'a> {
    study: &'a Study,
    points: Vec<usize>,
    /// Factors whose effects it tells, with their least and greatest values; words are in no order.
    factors: Vec<(usize, (f64, f64))>,
    terms: Vec<Term>,
    /// `(XᵀX)⁻¹`; the first row and column belong to the constant.
    inverse: Vec<Vec<f64>>,
}

/// The fits of a study: one of all points, or one for each factor of a one-at-a-time design.
fn fits(study: &Study) -> Result<Vec<Fit<'_>>, Refusal> {
    let count = study.factors.len();
    if study.design == Design::OneAtATime {
        let base = &study.points[0].values;
        return (0..count)
            .map(|factor| {
                let is_alone = |point: &usize| {
                    let values = &study.points[*point].values;
                    (0..count).all(|other| other == factor || values[other] == base[other])
                };
                let points: Vec<usize> = (0..study.points.len()).filter(is_alone).collect();
                Fit::new(study, points, &[factor])
            })
            .collect();
    }
    let (all, factors): (Vec<usize>, Vec<usize>) = ((0..study.points.len()).collect(), (0..count).collect());
    let fit = Fit::new(study, all, &factors)?;
    let (points, keys) = (fit.points.len(), count);
    let needed = fit.terms.len() + 2;
    if points < needed {
        return Err(Refusal::TooFewPoints { points, keys, needed });
    }
    fit.check_inflation()?;
    Ok(vec![if study.design.draws() { fit.with_curvature() } else { fit }])
}

impl<'a> Fit<'a> {
    fn new(study: &'a Study, points: Vec<usize>, factors: &[usize]) -> Result<Self, Refusal> {
        let (mut terms, mut of) = (Vec::new(), Vec::new());
        for &factor in factors {
            let mut levels: Vec<f64> =
                points.iter().map(|point| study.points[*point].values[factor]).collect();
            levels.sort_by(f64::total_cmp);
            levels.dedup();
            let (Some(&least), Some(&last)) = (levels.first(), levels.last()) else {
                continue;
            };
            if least == last {
                return Err(Refusal::OneValue { key: study.factors[factor].key });
            }
            let alone = study.design == Design::OneAtATime;
            if study.factors[factor].words.is_empty() {
                terms.push(Term::Line(factor));
                of.push((factor, if alone { (least, last) } else { study.factors[factor].ends() }));
            } else {
                // The order of the list. A word of the base case that the list does not name comes first.
                let mut words = study.factors[factor].levels();
                if alone {
                    let base = study.points[0].values[factor];
                    words.retain(|word| *word != base);
                    words.insert(0, base);
                }
                words.retain(|word| levels.contains(word));
                terms.extend(words[1..].iter().map(|&word| Term::Word(factor, word, words[0])));
                of.push((factor, (least, last)));
            }
        }
        let mut fit = Self { study, points, factors: of, terms, inverse: Vec::new() };
        if fit.points.len() <= fit.terms.len() {
            let (points, keys, needed) = (fit.points.len(), factors.len(), fit.terms.len() + 2);
            return Err(Refusal::TooFewPoints { points, keys, needed });
        }
        fit.inverse = match inverse(fit.gram()) {
            Ok(inverse) => inverse,
            Err(column) => return Err(fit.dependent(column)),
        };
        Ok(fit)
    }

    /// The same fit with squares and products, as far as there are enough points: two for each unknown.
    fn with_curvature(self) -> Self {
        let lines: Vec<usize> = self
            .terms
            .iter()
            .filter_map(|term| if let Term::Line(j) = term { Some(*j) } else { None })
            .collect();
        let squares = lines.iter().map(|&j| Term::Square(j));
        let products = lines.iter().enumerate().flat_map(|(i, &j)| {
            lines.iter().skip(i + 1).map(move |&k| Term::Product(j, k)).collect::<Vec<_>>()
        });
        let squared: Vec<Term> = self.terms.iter().copied().chain(squares).collect();
        let full: Vec<Term> = squared.iter().copied().chain(products).collect();
        for terms in [full, squared] {
            if self.points.len() >= 2 * (terms.len() + 1) {
                let (points, factors) = (self.points.clone(), self.factors.clone());
                let mut fit = Self { study: self.study, points, factors, terms, inverse: Vec::new() };
                if let Ok(inverse) = inverse(fit.gram()) {
                    fit.inverse = inverse;
                    return fit;
                }
            }
        }
        self
    }

    fn size(&self) -> usize {
        self.terms.len() + 1
    }

    fn row(&self, point: usize) -> Vec<f64> {
        let values = &self.study.points[point].values;
        let place = |factor: usize| {
            let ends = self.factors.iter().find(|(j, _)| *j == factor).map_or((0.0, 0.0), |(_, ends)| *ends);
            self.study.factors[factor].place_between(values[factor], ends)
        };
        std::iter::once(1.0).chain(self.terms.iter().map(|term| term.at(&place, values))).collect()
    }

    /// `XᵀX`.
    fn gram(&self) -> Vec<Vec<f64>> {
        let size = self.size();
        let mut gram = vec![vec![0.0; size]; size];
        for &point in &self.points {
            let row = self.row(point);
            for (sums, x) in gram.iter_mut().zip(&row) {
                add(sums, *x, &row);
            }
        }
        gram
    }

    /// Refuses factors that almost follow from others.
    fn check_inflation(&self) -> Result<(), Refusal> {
        let (gram, n) = (self.gram(), self.points.len() as f64);
        let inflated = (1..self.size()).find(|&j| {
            let spread = gram[j][j] - gram[0][j] * gram[0][j] / n;
            matches!(self.terms[j - 1], Term::Line(_)) && spread * self.inverse[j][j] > MOST_INFLATION
        });
        inflated.map_or(Ok(()), |column| Err(self.dependent(column)))
    }

    /// The refusal of a column that follows from the others: names the other factor if there is a single one.
    fn dependent(&self, column: usize) -> Refusal {
        let (gram, n) = (self.gram(), self.points.len() as f64);
        let cross = |j: usize, k: usize| gram[j][k] - gram[0][j] * gram[0][k] / n;
        let correlation = |k: usize| cross(column, k) / (cross(column, column) * cross(k, k)).sqrt();
        let others = (1..self.size()).filter(|k| *k != column);
        let nearest = others.max_by(|a, b| correlation(*a).abs().total_cmp(&correlation(*b).abs()));
        let key = |column: usize| match self.terms[column.max(1) - 1] {
            Term::Line(j) | Term::Square(j) | Term::Product(j, _) | Term::Word(j, ..) => {
                self.study.factors[j].key
            }
        };
        match nearest.filter(|k| correlation(*k).abs() > 0.9) {
            Some(other) => {
                let (first, second) = (key(other.min(column)), key(other.max(column)));
                Refusal::Together { first, second, correlation: correlation(other) }
            }
            None => Refusal::Dependent { key: key(column) },
        }
    }

    fn solve(&self, xy: &[f64]) -> Vec<f64> {
        self.inverse.iter().map(|row| dot(row, xy)).collect()
    }

    /// Contrasts of the coefficients that are the main effects.
    fn contrasts(&self) -> Vec<Contrast> {
        let contrast = |(column, term): (usize, &Term)| {
            let mut weights = vec![0.0; self.size()];
            weights[column] = 2.0;
            match *term {
                Term::Line(j) => {
                    let (least, greatest) = self.factors.iter().find(|of| of.0 == j)?.1;
                    Some((j, least, greatest, weights))
                }
                Term::Word(j, this, reference) => {
                    // The result with the word of reference is the mean over the words minus all their coefficients.
                    let same = |other: &Term| matches!(other, Term::Word(k, ..) if *k == j);
                    let others = (1..).zip(&self.terms).filter(|(at, other)| *at != column && same(other));
                    others.for_each(|(at, _)| weights[at] = 1.0);
                    Some((j, reference, this, weights))
                }
                Term::Square(_) | Term::Product(..) => None,
            }
        };
        (1..).zip(&self.terms).filter_map(contrast).collect()
    }
}

/// The solution of a fit for all measures.
struct Solution {
    coefficients: Vec<Vec<f64>>,
    /// By measure: contrasts and the variance of each with its degrees of freedom.
    effects: Vec<Vec<Effect>>,
    /// By measure: squares about the straight lines, and about the mean.
    squares: Vec<(f64, f64)>,
}

/// One number for each measure.
type Each = [f64; MEASURES.len()];
/// A factor, two of its values, and the weights of the fit that give the change of a result from one to the other.
type Contrast = (usize, f64, f64, Vec<f64>);

/// Deviations of a point's replicates from their mean, scaled so that the sum of their squares is the variance of the
/// mean; by replicate.
fn deviations(results: &PointResults, records: &[super::Record]) -> Vec<(usize, Each)> {
    let n = results.n as f64;
    let scale = if n > 1.0 { 1.0 / (n * (n - 1.0)).sqrt() } else { 0.0 };
    let of = |record: &super::Record| {
        let measured = record.landing.measured()?;
        let deviation = std::array::from_fn(|m| (measured[m] - results.mean[m]) * scale);
        Some((record.replicate as usize, deviation))
    };
    records.iter().filter_map(of).collect()
}

impl Solution {
    fn new(fit: &Fit<'_>, journal: &mut Journal) -> Result<Result<Self, Refusal>, Error> {
        let (study, size) = (fit.study, fit.size());
        let zeros = || vec![vec![0.0; size]; MEASURES.len()];
        let (mut xy, mut of_replicates, mut weights) = (zeros(), Vec::new(), Vec::new());
        let mut replicated = true;
        for &point in &fit.points {
            let results = results_of_point(journal, point)?;
            if results.n == 0 {
                return Ok(Err(Refusal::NoResult { point: point + 1 }));
            }
            replicated &= results.n > 1;
            let row = fit.row(point);
            for (sums, y) in xy.iter_mut().zip(&results.mean) {
                add(sums, *y, &row);
            }
            if study.common_phases {
                for (replicate, deviation) in deviations(&results, &journal.records(point, u64::MAX)?) {
                    if of_replicates.len() <= replicate {
                        of_replicates.resize_with(replicate + 1, zeros);
                        weights.resize(replicate + 1, 0.0);
                    }
                    weights[replicate] += 1.0 / (results.n as f64).powi(2);
                    for (sums, y) in of_replicates[replicate].iter_mut().zip(&deviation) {
                        add(sums, *y, &row);
                    }
                }
            }
        }
        let coefficients: Vec<Vec<f64>> = xy.iter().map(|xy| fit.solve(xy)).collect();
        let of_replicates: Vec<Vec<Vec<f64>>> =
            of_replicates.iter().map(|sums| sums.iter().map(|xy| fit.solve(xy)).collect()).collect();

        // Variance of each contrast from the replicates, and what goes into its degrees of freedom.
        let contrasts = fit.contrasts();
        let mut variances: Vec<Vec<(f64, f64)>> = vec![vec![(0.0, 0.0); contrasts.len()]; MEASURES.len()];
        let (mut left, mut of_noise) = ([0.0; MEASURES.len()], [0.0; MEASURES.len()]);
        let mut sums = vec![(0.0, 0.0, 0.0, 0.0); MEASURES.len()];
        let points = fit.points.len() as f64;
        for &point in &fit.points {
            let (row, results) = (fit.row(point), results_of_point(journal, point)?);
            let leverage = dot(&row, &fit.solve(&row));
            for m in 0..MEASURES.len() {
                let (y, b) = (results.mean[m], &coefficients[m]);
                left[m] += (y - dot(&row, b)).powi(2);
                let lines = (1..).zip(&fit.terms).filter(|(_, term)| term.is_main());
                let from_mean = y - xy[m][0] / points;
                let from_lines = y - b[0] - lines.map(|(column, _)| b[column] * row[column]).sum::<f64>();
                let sums = &mut sums[m];
                *sums = (
                    sums.0 + from_lines,
                    sums.1 + from_lines * from_lines,
                    sums.2 + from_mean,
                    sums.3 + from_mean * from_mean,
                );
                if !study.common_phases {
                    let variance = results.standard_error[m].map_or(0.0, |error| error * error);
                    of_noise[m] += variance * (1.0 - leverage);
                    for ((.., weights), sum) in contrasts.iter().zip(&mut variances[m]) {
                        let part = dot(weights, &fit.solve(&row)).powi(2) * variance;
                        sum.0 += part;
                        sum.1 += part * part / (results.n as f64 - 1.0).max(1.0);
                    }
                }
            }
            if study.common_phases {
                for (replicate, deviation) in deviations(&results, &journal.records(point, u64::MAX)?) {
                    for m in 0..MEASURES.len() {
                        of_noise[m] += (deviation[m] - dot(&row, &of_replicates[replicate][m])).powi(2);
                    }
                }
            }
        }
        let of_weights = |power: i32| weights.iter().map(|w: &f64| w.powi(power)).sum::<f64>();
        let paired = of_weights(1).powi(2) / of_weights(2) - 1.0;
        let effects = (0..MEASURES.len()).map(|m| {
            let free = points - size as f64;
            // What the terms do not describe, beyond the noise of the means.
            let noise = if replicated { of_noise[m] } else { 0.0 };
            let unfitted =
                if replicated && !study.design.draws() { 0.0 } else { (left[m] - noise).max(0.0) / free };
            let effect = |(contrast, sum): (&Contrast, &(f64, f64))| {
                let (factor, from, to, weights) = contrast;
                let (noise, degrees) = match (replicated, study.common_phases) {
                    (false, _) => (0.0, f64::INFINITY),
                    (true, true) => {
                        let z = of_replicates.iter().map(|of| dot(weights, &of[m]).powi(2));
                        (z.sum(), paired)
                    }
                    (true, false) => (sum.0, sum.0 * sum.0 / sum.1),
                };
                let unfitted =
                    if unfitted == 0.0 { 0.0 } else { unfitted * dot(weights, &fit.solve(weights)) };
                let (change, variance) = (dot(weights, &coefficients[m]), noise + unfitted);
                let over = |part: f64, degrees: f64| if part == 0.0 { 0.0 } else { part * part / degrees };
                let degrees = variance * variance / (over(noise, degrees) + over(unfitted, free));
                let half_width = match (replicated || free > 0.0, variance == 0.0) {
                    (false, _) => None,
                    (true, true) => Some(0.0),
                    (true, false) => Some(student_t_95_at(degrees) * variance.sqrt()),
                };
                Effect { factor: *factor, from: *from, to: *to, change, half_width }
            };
            contrasts.iter().zip(&variances[m]).map(effect).collect()
        });
        let squares = sums.iter().map(|(a, aa, b, bb)| (aa - a * a / points, bb - b * b / points));
        Ok(Ok(Self { effects: effects.collect(), squares: squares.collect(), coefficients }))
    }
}

/// Adjusted R² of the straight lines.
fn explained(fits: &[Fit<'_>], solved: &[Solution], measure: usize) -> f64 {
    let (mut from_lines, mut from_mean, mut free, mut all) = (0.0, 0.0, 0.0, 0.0);
    for (fit, solution) in fits.iter().zip(solved) {
        let lines = fit.terms.iter().filter(|term| term.is_main()).count() as f64;
        let points = fit.points.len() as f64;
        from_lines += solution.squares[measure].0;
        from_mean += solution.squares[measure].1;
        free += points - lines - 1.0;
        all += points - 1.0;
    }
    let explained = 1.0 - (from_lines / free) / (from_mean / all);
    if free > 0.0 && from_mean > 0.0 { explained.max(0.0) } else { f64::NAN }
}

fn add(sums: &mut [f64], factor: f64, row: &[f64]) {
    sums.iter_mut().zip(row).for_each(|(sum, x)| *sum += factor * x);
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The inverse of a symmetric positive definite matrix, by Gauss and Jordan.
///
/// # Errors
/// The column of a singular matrix that follows from the columns before it, up to rounding.
fn inverse(mut matrix: Vec<Vec<f64>>) -> Result<Vec<Vec<f64>>, usize> {
    let size = matrix.len();
    let scale: Vec<f64> = (0..size).map(|i| matrix[i][i]).collect();
    let mut inverse: Vec<Vec<f64>> =
        (0..size).map(|i| (0..size).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    for pivot in 0..size {
        // The remaining diagonal is the part of this column that no earlier one explains.
        let value = matrix[pivot][pivot];
        if value.is_nan() || value <= 1e-9 * scale[pivot] {
            return Err(pivot);
        }
        for row in [&mut matrix[pivot], &mut inverse[pivot]] {
            row.iter_mut().for_each(|x| *x /= value);
        }
        let (from_matrix, from_inverse) = (matrix[pivot].clone(), inverse[pivot].clone());
        for other in (0..size).filter(|other| *other != pivot) {
            let factor = matrix[other][pivot];
            for (row, from) in [(&mut matrix[other], &from_matrix), (&mut inverse[other], &from_inverse)] {
                row.iter_mut().zip(from).for_each(|(x, y)| *x -= factor * y);
            }
        }
    }
    Ok(inverse)
}
