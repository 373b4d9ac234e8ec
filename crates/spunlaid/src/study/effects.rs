//! Which factor matters, and how much: main effects with confidence intervals.
//!
//! The main effect of a factor is the change of a result from one end of its range to the other, on the straight
//! line that fits all points best, the other factors held:
//!
//! ```text
//! y = b₀ + Σ b_j x_j + rest,  x_j = −1 … +1 over the range of factor j (of its logarithm where spaced so)
//! effect_j = 2 b_j
//! ```
//!
//! Its interval is the wider of two. One comes from the replicates: the fit is made anew with the first replicate
//! of every point, with the second, and so on, and the fits differ as the turbulence does; this holds with common
//! phases too. The other comes from what the line leaves of the points' means, be that noise or curvature.

use super::journal::Journal;
use super::run::results_of_point;
use super::{Point, Study};
use crate::error::Error;
use crate::observe::MEASURES;
use crate::statistics::student_t_95;

/// Main effects on one result, the largest first.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranking {
    /// Which of the [`MEASURES`].
    pub measure: usize,
    /// Value in the middle of all ranges.
    pub middle: f64,
    /// Share of the variation between points that the line explains.
    pub explained: f64,
    /// The effects.
    pub effects: Vec<Effect>,
}

/// The main effect of a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effect {
    /// Index of the factor.
    pub factor: usize,
    /// Change from the least to the greatest value.
    pub change: f64,
    /// Half the width of its 95 % confidence interval; none where nothing tells it.
    pub half_width: Option<f64>,
}

/// The rankings, one per measure; none where the design cannot tell the factors apart.
///
/// # Errors
/// When the journal cannot be read.
pub fn rankings(study: &Study, journal: &mut Journal) -> Result<Vec<Ranking>, Error> {
    let Some(mut fit) = Fit::new(study) else {
        return Ok(Vec::new());
    };
    for index in 0..study.points.len() {
        let results = results_of_point(journal, index)?;
        if results.n == 0 {
            return Ok(Vec::new());
        }
        let row = fit.row(&study.points[index]);
        fit.means.add(&row, &results.mean);
        fit.common = fit.common.min(if results.lost > 0 { 0 } else { results.n as usize });
    }
    // The same replicate of every point is one experiment.
    let mut replicates = vec![Sums::new(fit.size); fit.common];
    if fit.common > 1 {
        for index in 0..study.points.len() {
            let row = fit.row(&study.points[index]);
            let records = journal.records(index, fit.common as u64)?;
            for (sums, record) in replicates.iter_mut().zip(records) {
                if let Some(measured) = record.landing.measured() {
                    sums.add(&row, measured);
                }
            }
        }
    }
    let means: Vec<_> = MEASURES.iter().enumerate().map(|(i, _)| fit.solve(&fit.means, i)).collect();
    let mut squares = [0.0; MEASURES.len()];
    let mut total = [0.0; MEASURES.len()];
    let points = study.points.len() as f64;
    for index in 0..study.points.len() {
        let row = fit.row(&study.points[index]);
        let results = results_of_point(journal, index)?;
        for (i, y) in results.mean.iter().enumerate() {
            let line: f64 = row.iter().zip(&means[i]).map(|(x, b)| x * b).sum();
            squares[i] += (y - line).powi(2);
            total[i] += (y - fit.means.xy[i][0] / points).powi(2);
        }
    }
    Ok((0..MEASURES.len()).map(|i| fit.ranking(i, &means[i], &replicates, squares[i], total[i])).collect())
}

/// `Xᵀy` for every measure, one column for the middle and one for each factor.
#[derive(Clone, Debug)]
struct Sums {
    xy: Vec<Vec<f64>>,
}

impl Sums {
    fn new(size: usize) -> Self {
        Self { xy: vec![vec![0.0; size]; MEASURES.len()] }
    }

    fn add(&mut self, row: &[f64], y: &[f64; MEASURES.len()]) {
        for (sums, y) in self.xy.iter_mut().zip(y) {
            for (sum, x) in sums.iter_mut().zip(row) {
                *sum += x * y;
            }
        }
    }
}

struct Fit<'a> {
    study: &'a Study,
    size: usize,
    /// `(XᵀX)⁻¹`.
    inverse: Vec<Vec<f64>>,
    means: Sums,
    /// Replicates that every point has.
    common: usize,
}

impl<'a> Fit<'a> {
    fn new(study: &'a Study) -> Option<Self> {
        let size = study.factors.len() + 1;
        if size == 1 || study.points.len() < size {
            return None;
        }
        let means = Sums::new(size);
        let mut fit = Self { study, size, inverse: Vec::new(), means, common: usize::MAX };
        let mut gram = vec![vec![0.0; size]; size];
        for point in &study.points {
            let row = fit.row(point);
            for (sums, x) in gram.iter_mut().zip(&row) {
                for (sum, z) in sums.iter_mut().zip(&row) {
                    *sum += x * z;
                }
            }
        }
        fit.inverse = inverse(gram)?;
        Some(fit)
    }

    fn row(&self, point: &Point) -> Vec<f64> {
        let places = self.study.factors.iter().zip(&point.values).map(|(factor, v)| factor.place(*v));
        std::iter::once(1.0).chain(places).collect()
    }

    fn solve(&self, sums: &Sums, measure: usize) -> Vec<f64> {
        let xy = &sums.xy[measure];
        self.inverse.iter().map(|row| row.iter().zip(xy).map(|(a, b)| a * b).sum()).collect()
    }

    fn ranking(
        &self,
        measure: usize,
        line: &[f64],
        replicates: &[Sums],
        squares: f64,
        total: f64,
    ) -> Ranking {
        let fits: Vec<Vec<f64>> = replicates.iter().map(|sums| self.solve(sums, measure)).collect();
        let between = |j: usize| {
            let n = fits.len() as f64;
            let mean = fits.iter().map(|b| b[j]).sum::<f64>() / n;
            let variance = fits.iter().map(|b| (b[j] - mean).powi(2)).sum::<f64>() / (n - 1.0);
            (fits.len() > 1).then(|| student_t_95(fits.len() as u64 - 1) * (variance / n).sqrt())
        };
        let left = self.study.points.len() - self.size;
        let residual = |j: usize| {
            let variance = squares / left as f64 * self.inverse[j][j];
            (left > 0).then(|| student_t_95(left as u64) * variance.sqrt())
        };
        let mut effects: Vec<Effect> = (1..self.size)
            .map(|j| {
                let half_width = match (between(j), residual(j)) {
                    (Some(a), Some(b)) => Some(a.max(b)),
                    (a, b) => a.or(b),
                };
                Effect { factor: j - 1, change: 2.0 * line[j], half_width: half_width.map(|w| 2.0 * w) }
            })
            .collect();
        effects.sort_by(|a, b| b.change.abs().total_cmp(&a.change.abs()));
        let explained = if total > 0.0 { 1.0 - squares / total } else { f64::NAN };
        Ranking { measure, middle: line[0], explained, effects }
    }
}

/// The inverse of a symmetric positive definite matrix, by Gauss and Jordan; none of one that is singular but
/// for rounding.
fn inverse(mut matrix: Vec<Vec<f64>>) -> Option<Vec<Vec<f64>>> {
    let size = matrix.len();
    let scale: Vec<f64> = (0..size).map(|i| matrix[i][i]).collect();
    let mut inverse: Vec<Vec<f64>> =
        (0..size).map(|i| (0..size).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    for pivot in 0..size {
        // What is left of the diagonal: the part of this factor that no earlier one explains.
        let value = matrix[pivot][pivot];
        if value.is_nan() || value <= 1e-9 * scale[pivot] {
            return None;
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
    Some(inverse)
}
