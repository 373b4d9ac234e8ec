//! The solution of a fit: coefficients, and effects with their intervals.

use super::fit::{EffectsFit, WeightedContrast};
use super::{Contrast, Refusal};
use crate::study::PointResults;
use crate::study::journal::Journal;
use crate::study::measures::Record;
use crate::study::rounds::results_of_point;
use spunlaid_ground::statistics::{add, dot};
use spunlaid_ground::{Difference, Effect, Error};

/// The solution of a fit for all measures.
pub(super) struct Solution {
    /// By measure: the coefficients, the constant first.
    pub(super) coefficients: Vec<Vec<f64>>,
    /// By measure: the main effects.
    pub(super) effects: Vec<Vec<Effect<Contrast>>>,
    /// By measure: sum of squares about the straight lines, and about the mean.
    pub(super) squares: Vec<(f64, f64)>,
}

impl Solution {
    /// Reads the points of the fit twice, so that a large study takes no more memory than a small one.
    pub(super) fn new(fit: &EffectsFit<'_>, journal: &mut Journal) -> Result<Result<Self, Refusal>, Error> {
        let fitted = match FittedCoefficients::read(fit, journal)? {
            Ok(fitted) => fitted,
            Err(refusal) => return Ok(Err(refusal)),
        };
        let contrasts = fit.contrasts();
        let rest = Rest::read(fit, journal, &fitted, &contrasts)?;
        let effects = (0..fit.study.quantities.len()).map(|m| {
            let of_contrasts = contrasts.iter().zip(&rest[m].contrasts);
            of_contrasts.map(|(contrast, noise)| fitted.effect(fit, m, &rest[m], contrast, *noise)).collect()
        });
        let points = fit.points.len() as f64;
        let squares =
            rest.iter().map(|rest| (rest.about_lines.squares(points), rest.about_mean.squares(points)));
        Ok(Ok(Self {
            effects: effects.collect(),
            squares: squares.collect(),
            coefficients: fitted.coefficients,
        }))
    }
}

/// One number for each measure.
type PerMeasure = Vec<f64>;

/// Deviations of a point's replicates from their mean, scaled so that the sum of their squares is the variance of the
/// mean; by replicate.
fn deviations(results: &PointResults, records: &[Record]) -> Vec<(usize, PerMeasure)> {
    let n = results.n as f64;
    let scale = if n > 1.0 { 1.0 / (n * (n - 1.0)).sqrt() } else { 0.0 };
    let numbers = |record: &Record| {
        let measured = record.outcome.measured()?;
        let deviation =
            (measured.iter().enumerate()).map(|(i, one)| (one - results.mean(i)) * scale).collect();
        Some((record.replicate as usize, deviation))
    };
    records.iter().filter_map(numbers).collect()
}

/// The fit's coefficients, and what each replicate contributes to them.
struct FittedCoefficients {
    /// By measure.
    coefficients: Vec<Vec<f64>>,
    /// By measure: mean over the points.
    mean: Vec<f64>,
    /// By replicate and measure: coefficients of the deviations; with common phases only.
    of_replicates: Vec<Vec<Vec<f64>>>,
    /// Degrees of freedom of the replicates.
    degrees: f64,
    /// Whether every point has more than one replicate.
    replicated: bool,
}

impl FittedCoefficients {
    fn read(fit: &EffectsFit<'_>, journal: &mut Journal) -> Result<Result<Self, Refusal>, Error> {
        let zeros = || vec![vec![0.0; fit.size()]; fit.study.quantities.len()];
        let mut xy = zeros();
        let mut of_replicates = Vec::new();
        let mut weights = Vec::new();
        let mut replicated = true;
        for &point in &fit.points {
            let results = results_of_point(fit.study, journal, point)?;
            if results.n == 0 {
                return Ok(Err(Refusal::NoResult { point: point + 1 }));
            }
            replicated &= results.n > 1;
            let row = fit.row(point);
            for (m, sums) in xy.iter_mut().enumerate() {
                add(sums, results.mean(m), &row);
            }
            if fit.study.common_phases {
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
        let solve = |xy: &Vec<Vec<f64>>| xy.iter().map(|xy| fit.solve(xy)).collect();
        let of_weights = |power: i32| weights.iter().map(|w: &f64| w.powi(power)).sum::<f64>();
        Ok(Ok(Self {
            coefficients: solve(&xy),
            mean: xy.iter().map(|xy| xy[0] / fit.points.len() as f64).collect(),
            of_replicates: of_replicates.iter().map(solve).collect(),
            degrees: of_weights(1).powi(2) / of_weights(2) - 1.0,
            replicated,
        }))
    }

    /// The effect of a contrast on a measure.
    ///
    /// * `independent` – variance of the contrast from the replicates of independent phases
    fn effect(
        &self,
        fit: &EffectsFit<'_>,
        m: usize,
        rest: &Rest,
        of: &WeightedContrast,
        independent: Variance,
    ) -> Effect<Contrast> {
        let weights = &of.weights;
        let free = (fit.points.len() - fit.size()) as f64;
        let noise = match (self.replicated, fit.study.common_phases) {
            (false, _) => Variance { value: 0.0, degrees: f64::INFINITY },
            (true, true) => {
                let of_replicates =
                    self.of_replicates.iter().map(|replicate| dot(weights, &replicate[m]).powi(2));
                Variance { value: of_replicates.sum(), degrees: self.degrees }
            }
            (true, false) => independent,
        };
        // What the terms do not describe, beyond the noise of the means.
        let unfitted = match (self.replicated, fit.study.design.draws()) {
            (true, false) => 0.0,
            (true, true) => (rest.squares - rest.noise).max(0.0) / free,
            (false, _) => rest.squares / free,
        };
        let unfitted = if unfitted == 0.0 { 0.0 } else { unfitted * dot(weights, &fit.solve(weights)) };
        let all = noise.and(Variance { value: unfitted, degrees: free });
        let standard_error = if self.replicated || free > 0.0 { all.value.sqrt() } else { f64::NAN };
        let value = dot(weights, &self.coefficients[m]);
        Effect::new(of.contrast, Difference { value, standard_error, degrees: all.degrees })
    }
}

/// What a fit leaves of a measure.
#[derive(Clone, Default)]
struct Rest {
    /// Squares of the residuals.
    squares: f64,
    /// The part of them that the noise of the means explains.
    noise: f64,
    about_lines: SquareSums,
    about_mean: SquareSums,
    /// Variance of each contrast from the replicates; with independent phases only.
    contrasts: Vec<Variance>,
}

impl Rest {
    /// Of each measure.
    fn read(
        fit: &EffectsFit<'_>,
        journal: &mut Journal,
        fitted: &FittedCoefficients,
        contrasts: &[WeightedContrast],
    ) -> Result<Vec<Self>, Error> {
        let none = Self { contrasts: vec![Variance::default(); contrasts.len()], ..Self::default() };
        let mut rest = vec![none; fit.study.quantities.len()];
        for &point in &fit.points {
            let row = fit.row(point);
            let results = results_of_point(fit.study, journal, point)?;
            let solved = fit.solve(&row);
            let leverage = dot(&row, &solved);
            for (m, rest) in rest.iter_mut().enumerate() {
                let (y, b) = (results.mean(m), &fitted.coefficients[m]);
                let lines = (1..).zip(&fit.terms).filter(|(_, term)| term.is_main());
                rest.squares += (y - dot(&row, b)).powi(2);
                rest.about_mean.add(y - fitted.mean[m]);
                rest.about_lines
                    .add(y - b[0] - lines.map(|(column, _)| b[column] * row[column]).sum::<f64>());
                if !fit.study.common_phases {
                    let value = results.standard_error(m).map_or(0.0, |error| error * error);
                    rest.noise += value * (1.0 - leverage);
                    for (of, sum) in contrasts.iter().zip(&mut rest.contrasts) {
                        let value = dot(&of.weights, &solved).powi(2) * value;
                        *sum = sum.and(Variance { value, degrees: (results.n as f64 - 1.0).max(1.0) });
                    }
                }
            }
            if fit.study.common_phases {
                for (replicate, deviation) in deviations(&results, &journal.records(point, u64::MAX)?) {
                    for (m, rest) in rest.iter_mut().enumerate() {
                        let of_fit = dot(&row, &fitted.of_replicates[replicate][m]);
                        rest.noise += (deviation[m] - of_fit).powi(2);
                    }
                }
            }
        }
        Ok(rest)
    }
}

/// Sums of numbers and of their squares.
#[derive(Clone, Copy, Default)]
struct SquareSums {
    first: f64,
    second: f64,
}

impl SquareSums {
    fn add(&mut self, x: f64) {
        self.first += x;
        self.second += x * x;
    }

    /// Squares about the mean of so many numbers.
    fn squares(self, count: f64) -> f64 {
        self.second - self.first * self.first / count
    }
}

/// A variance that is estimated, with its degrees of freedom.
#[derive(Clone, Copy, Default)]
struct Variance {
    value: f64,
    degrees: f64,
}

impl Variance {
    /// The sum of two, with its effective degrees of freedom (Welch and Satterthwaite).
    fn and(self, other: Self) -> Self {
        let part = |variance: Self| {
            if variance.value == 0.0 { 0.0 } else { variance.value * variance.value / variance.degrees }
        };
        let value = self.value + other.value;
        Self { value, degrees: value * value / (part(self) + part(other)) }
    }
}
