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
//! | Latin hypercube | one fit; with enough points also `x_j² − 1/3` and `x_j x_k`, for the curvature |
//! | others | one fit of straight lines |
//!
//! The interval comes from the replicates. With common phases, replicate r of all points is one experiment, and the
//! effects of these experiments differ as the turbulence does; noise that all points share cancels. With independent
//! phases, the variances of the points add up. In designs with drawn points the fit also misses what its terms do not
//! describe; this part, estimated from the residuals, widens the interval. Without replicates, the residuals are all
//! there is.

mod fit;
mod solution;

use super::journal::Journal;
use super::{Design, Study};
use fit::{EffectsFit, fits};
use solution::Solution;
use spunlaid_ground::{Effect, Error};

pub use fit::Term;

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
    /// Index into [`Study::quantities`].
    pub measure: usize,
    /// Value in the middle of all ranges; None for one-at-a-time designs, whose lines have no common middle.
    pub middle: Option<f64>,
    /// Fraction of the variation between points that straight lines explain (adjusted R²); None if there are too few
    /// points to know it.
    pub explained: Option<f64>,
    /// The effects. The error of one is not a number if neither replicates nor residuals tell it.
    pub effects: Vec<Effect<Contrast>>,
    /// The terms of the fit with their coefficients, without the constant.
    pub terms: Vec<(Term, f64)>,
}

/// A change of a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contrast {
    /// Index of the factor.
    pub factor: usize,
    /// The value that the change starts from: the least value, or the word of reference.
    pub from: f64,
    /// The value that the change leads to: the greatest value, or another word. There is a contrast for each of them.
    pub to: f64,
}

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
        let mut effects: Vec<Effect<Contrast>> =
            solved.iter().flat_map(|solution| &solution.effects[measure]).copied().collect();
        effects.sort_by(|one, other| other.difference.value.abs().total_cmp(&one.difference.value.abs()));
        let terms = fits.iter().zip(&solved).flat_map(|(fit, solution)| {
            fit.terms.iter().copied().zip(solution.coefficients[measure].iter().skip(1).copied())
        });
        let middle = match solved.as_slice() {
            [one] if study.design != Design::OneAtATime => Some(one.coefficients[measure][0]),
            _ => None,
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
    Ok(Rankings {
        of_measures: (0..study.quantities.len()).filter(applies).map(ranking).collect(),
        refusal: None,
    })
}

impl Ranking {
    /// The effect of a change of a factor.
    pub fn of(&self, contrast: Contrast) -> Option<&Effect<Contrast>> {
        self.effects.iter().find(|effect| effect.of == contrast)
    }

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

/// Adjusted R² of the straight lines; None if there are too few points to know it.
fn explained(fits: &[EffectsFit<'_>], solved: &[Solution], measure: usize) -> Option<f64> {
    let mut from_lines = 0.0;
    let mut from_mean = 0.0;
    let mut free = 0.0;
    let mut all = 0.0;
    for (fit, solution) in fits.iter().zip(solved) {
        let lines = fit.terms.iter().filter(|term| term.is_main()).count() as f64;
        let points = fit.points.len() as f64;
        from_lines += solution.squares[measure].0;
        from_mean += solution.squares[measure].1;
        free += points - lines - 1.0;
        all += points - 1.0;
    }
    let explained = 1.0 - (from_lines / free) / (from_mean / all);
    (free > 0.0 && from_mean > 0.0).then(|| explained.max(0.0))
}

/// Why the factors of a study are not ranked.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// The fit would pass through all points.
    #[error(
        "{points} points cannot rank {keys} keys: the fit would pass through every point, whatever the \
         results; simulate at least {needed} points"
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
        key: String,
    },
    /// Two factors vary together.
    #[error(
        "{first} and {second} vary together (correlation {correlation:.2}), so their effects cannot be \
        separated; vary them independently, for example with design = \"grid\""
    )]
    Together {
        /// Key of the one.
        first: String,
        /// Key of the other.
        second: String,
        /// Correlation of their values.
        correlation: f64,
    },
    /// Several factors depend on each other.
    #[error("{key} follows from the other keys at all points, so its effect cannot be separated from theirs")]
    Dependent {
        /// Key of one of them.
        key: String,
    },
    /// A point has no result.
    #[error("point {point} has no fibre that was completed")]
    NoResult {
        /// Number of the point, counted from 1.
        point: usize,
    },
}
