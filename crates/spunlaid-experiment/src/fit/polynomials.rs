//! The numbers around a place as polynomials of the coordinates.

use super::search::SearchState;
use super::webs::Webs;
use super::weights::Matrix;
use spunlaid_ground::statistics::{dot, inverse};

/// The numbers around a place as polynomials of second order through the means of all trials there.
pub(super) struct Polynomials {
    /// Powers of the coordinates in each term, by the coordinates that are multiplied: none, one or two.
    terms: Vec<Vec<usize>>,
    /// Of each number, the factor of each term.
    factors: Matrix,
}

impl Polynomials {
    /// * `reach` – how far from the place trials count, by coordinate
    ///
    /// If too few trials lie there, they are the straight lines of the place.
    pub(super) fn new(webs: &Webs<'_>, place: &SearchState, reach: &[f64]) -> Self {
        let keys = reach.len();
        let linear = || std::iter::once(Vec::new()).chain((0..keys).map(|i| vec![i]));
        let squares = || (0..keys).map(|i| vec![i, i]);
        let products = (0..keys).flat_map(|i| (i + 1..keys).map(move |j| vec![i, j]));
        let all = [
            linear().chain(squares()).chain(products).collect(),
            linear().chain(squares()).collect(),
            linear().collect::<Vec<Vec<usize>>>(),
        ];
        let found = all.into_iter().find_map(|terms| Self::from_terms(webs, place, reach, terms));
        found.unwrap_or_else(|| {
            let mean = &webs.trials[place.trial].mean;
            let of_number =
                |i: usize| std::iter::once(mean[i]).chain(place.slopes.iter().map(move |slope| slope[i]));
            Self {
                terms: linear().collect(),
                factors: (0..mean.len()).map(|i| of_number(i).collect()).collect(),
            }
        })
    }

    fn from_terms(
        webs: &Webs<'_>,
        place: &SearchState,
        reach: &[f64],
        terms: Vec<Vec<usize>>,
    ) -> Option<Self> {
        let here = &webs.trials[place.trial].coordinates;
        // In parts of the reach, so that all terms are of like size.
        let step = |at: &[f64]| -> Vec<f64> {
            at.iter().zip(here).zip(reach).map(|((at, here), reach)| (at - here) / reach).collect()
        };
        let around = webs.trials.iter().map(|trial| (step(&trial.coordinates), &trial.mean));
        let around = around.filter(|(step, _)| step.iter().all(|step| step.abs() <= 1.0));
        let rows: Vec<(Vec<f64>, &Vec<f64>)> = around
            .map(|(step, mean)| (terms.iter().map(|term| value(term, &step)).collect(), mean))
            .collect();
        // A trial more than there are terms, so that chance does not decide.
        if rows.len() <= terms.len() {
            return None;
        }
        let sum = |term: &dyn Fn(&[f64], &[f64]) -> f64| {
            rows.iter().map(|(row, mean)| term(row, mean)).sum::<f64>()
        };
        let size = terms.len();
        let normal = (0..size).map(|i| (0..size).map(|j| sum(&|row, _| row[i] * row[j])).collect()).collect();
        let inverse = inverse(normal).ok()?;
        let scales: Vec<f64> =
            terms.iter().map(|term| term.iter().map(|key| reach[*key]).product::<f64>()).collect();
        let of_number = |number: usize| -> Vec<f64> {
            let moments: Vec<f64> = (0..size).map(|i| sum(&|row, mean| row[i] * mean[number])).collect();
            inverse.iter().zip(&scales).map(|(row, scale)| dot(row, &moments) / scale).collect()
        };
        let factors = (0..webs.target.logarithms.len()).map(of_number).collect();
        Some(Self { terms, factors })
    }

    /// The numbers a step away from the place, and their slopes there.
    pub(super) fn at(&self, step: &[f64]) -> (Vec<f64>, Matrix) {
        let values: Vec<f64> = self.terms.iter().map(|term| value(term, step)).collect();
        let slope = |key: usize| {
            let of_term = |term: &Vec<usize>| {
                let without = |i: usize| {
                    term.iter().enumerate().filter(move |(j, _)| *j != i).map(|(_, key)| step[*key])
                };
                let own = (0..term.len()).filter(|i| term[*i] == key);
                own.map(|i| without(i).product::<f64>()).sum::<f64>()
            };
            let slopes: Vec<f64> = self.terms.iter().map(of_term).collect();
            self.factors.iter().map(|factors| dot(factors, &slopes)).collect()
        };
        (
            self.factors.iter().map(|factors| dot(factors, &values)).collect(),
            (0..step.len()).map(slope).collect(),
        )
    }
}

/// The product of the coordinates of a term.
fn value(term: &[usize], step: &[f64]) -> f64 {
    term.iter().map(|key| step[*key]).product()
}
