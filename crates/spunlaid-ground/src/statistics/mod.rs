//! Statistics over replicates and over time.

mod difference;
mod spectrum;

pub use difference::{Difference, difference_of_logarithms, student_t_95_at};
pub use spectrum::{Spectrum, Welch, Window};

/// A result over the replicates of an ensemble.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Mean over the replicates.
    pub mean: f64,
    /// Standard error of the mean; `None` from a single replicate.
    pub standard_error: Option<f64>,
    /// The values of the replicates, in order.
    pub values: Vec<f64>,
}

impl Estimate {
    /// Mean and standard error `s/√n`, summed in the order given.             theory.md (39)
    pub fn new(values: Vec<f64>) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
        let standard_error = (values.len() > 1).then(|| (squares / (n - 1.0) / n).sqrt());
        Self { mean, standard_error, values }
    }
}

/// A value with its 95 % confidence interval.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Interval {
    /// The estimate.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// A value without error.
    pub const fn exactly(value: f64) -> Self {
        Self { value, low: value, high: value }
    }

    /// Whether the interval holds a value.
    pub fn holds(&self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// Half the width over the value.
    pub fn relative(&self) -> f64 {
        0.5 * (self.high - self.low) / self.value.abs()
    }
}

/// The 95 % confidence interval of a standard deviation that has been found with a standard error.
///
/// The square of a deviation with `ν = ½ (deviation/standard error)²` degrees of freedom is distributed as
/// χ²/ν, so the interval reaches further up than down, and it is as wide beside the deviation whether this
/// has come out high or low.
///
/// Source: E. B. Wilson, M. M. Hilferty, PNAS 17 (1931) 684–688, for the quantiles of χ²; F. E.
/// Satterthwaite, Biometrics 2 (1946) 110–114, for the degrees of freedom of a sum.
pub fn interval_of_deviation(deviation: f64, standard_error: f64) -> [f64; 2] {
    interval_of_deviation_by(NORMAL_95, deviation, standard_error)
}

/// [`interval_of_deviation`] with another half width of the central 95 % than the normal one, as that of
/// Student's t where the standard error is itself uncertain.
pub fn interval_of_deviation_by(half: f64, deviation: f64, standard_error: f64) -> [f64; 2] {
    let degrees = 0.5 * (deviation / standard_error).powi(2);
    let part = 2.0 / (9.0 * degrees);
    [half, -half].map(|z| {
        let quantile = (1.0 - part + z * part.sqrt()).max(0.0).powi(3);
        if degrees.is_nan() { deviation } else { deviation / quantile.sqrt() }
    })
}

/// Half the width of the central 95 % of a normal distribution, in standard deviations.
pub const NORMAL_95: f64 = 1.959_963_984_540_054;

/// Student's t for a two-sided confidence interval of 95 %.
///
/// A table up to 30 degrees, then Cornish and Fisher's expansion about the normal distribution, accurate to 1e-7.
///
/// * `degrees` – degrees of freedom, one or more
///
/// Source: Abramowitz & Stegun 26.7.5.
pub fn student_t_95(degrees: u64) -> f64 {
    #[rustfmt::skip]
    const TABLE: [f64; 30] = [
        12.7062, 4.30265, 3.18245, 2.77645, 2.57058, 2.44691, 2.36462, 2.306, 2.26216, 2.22814,
        2.20099, 2.17881, 2.16037, 2.14479, 2.13145, 2.11991, 2.10982, 2.10092, 2.09302, 2.08596,
        2.07961, 2.07387, 2.06866, 2.0639, 2.05954, 2.05553, 2.05183, 2.04841, 2.04523, 2.04227,
    ];
    let tabled = degrees.checked_sub(1).and_then(|i| TABLE.get(usize::try_from(i).ok()?));
    tabled.copied().unwrap_or_else(|| {
        let z = NORMAL_95;
        let power = |n: i32| (0..n).fold(1.0, |p, _| p * z);
        let terms = [
            (power(3) + z) / 4.0,
            (5.0 * power(5) + 16.0 * power(3) + 3.0 * z) / 96.0,
            (3.0 * power(7) + 19.0 * power(5) + 17.0 * power(3) - 15.0 * z) / 384.0,
            (79.0 * power(9) + 776.0 * power(7) + 1482.0 * power(5) - 1920.0 * power(3) - 945.0 * z)
                / 92160.0,
        ];
        terms.iter().rev().fold(0.0, |sum, term| (sum + term) / degrees as f64) + z
    })
}

/// The quantile of the finite values at a fraction `share`, with linear interpolation; NaN without any value.
pub fn quantile(values: &[f64], share: f64) -> f64 {
    let mut finite: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
    if finite.is_empty() {
        return f64::NAN;
    }
    let place = share.clamp(0.0, 1.0) * (finite.len() - 1) as f64;
    // Selected, not sorted: this is done for every fibre.
    let (_, &mut below, above) = finite.select_nth_unstable_by(place.floor() as usize, f64::total_cmp);
    let above = above.iter().copied().min_by(f64::total_cmp).unwrap_or(below);
    below + place.fract() * (above - below)
}

/// The median of the finite values; NaN without any value.
pub fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}

/// Adds a multiple of a row to the sums.
#[inline]
pub fn add(sums: &mut [f64], factor: f64, row: &[f64]) {
    sums.iter_mut().zip(row).for_each(|(sum, x)| *sum += factor * x);
}

/// Scalar product.
#[inline]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The inverse of a symmetric positive definite matrix, by Gauss and Jordan.
///
/// # Errors
/// The column of a singular matrix that follows from the columns before it, up to rounding.
pub fn inverse(mut matrix: Vec<Vec<f64>>) -> Result<Vec<Vec<f64>>, usize> {
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
        let from_matrix = matrix[pivot].clone();
        let from_inverse = inverse[pivot].clone();
        for other in (0..size).filter(|other| *other != pivot) {
            let factor = matrix[other][pivot];
            for (row, from) in [(&mut matrix[other], &from_matrix), (&mut inverse[other], &from_inverse)] {
                row.iter_mut().zip(from).for_each(|(x, y)| *x -= factor * y);
            }
        }
    }
    Ok(inverse)
}

/// The solution of equations with a symmetric positive definite matrix, by Cholesky; None if it is not
/// definite. Only the diagonal and what lies below it is looked at.
pub fn solve_positive(mut matrix: Vec<Vec<f64>>, mut sides: Vec<f64>) -> Option<Vec<f64>> {
    let size = sides.len();
    for i in 0..size {
        for j in 0..=i {
            let rest = matrix[i][j] - dot(&matrix[i][..j], &matrix[j][..j]);
            matrix[i][j] = if i == j { rest.sqrt() } else { rest / matrix[j][j] };
        }
        if matrix[i][i].is_nan() || matrix[i][i] <= 0.0 {
            return None;
        }
        sides[i] = (sides[i] - dot(&matrix[i][..i], &sides[..i])) / matrix[i][i];
    }
    for i in (0..size).rev() {
        let later: f64 = (i + 1..size).map(|j| matrix[j][i] * sides[j]).sum();
        sides[i] = (sides[i] - later) / matrix[i][i];
    }
    Some(sides)
}

/// Evenly spaced values of a series that is not kept: every value, until they are too many; then every
/// second, every fourth and so on. Quantiles of a long series are found in them.
#[derive(Clone, Debug, PartialEq)]
pub struct EvenSample<T> {
    values: Vec<T>,
    every: u64,
    count: u64,
}

impl<T> Default for EvenSample<T> {
    fn default() -> Self {
        Self { values: Vec::new(), every: 1, count: 0 }
    }
}

impl<T> EvenSample<T> {
    /// Most values that are kept. A series that is not longer is kept whole; of a longer one, half as many at
    /// least are kept.
    pub(crate) const MOST: usize = 1 << 14;

    /// Takes the next value of the series.
    pub fn push(&mut self, value: T) {
        if self.count.is_multiple_of(self.every) {
            if self.values.len() == Self::MOST {
                let mut index = 0_usize;
                self.values.retain(|_| {
                    index += 1;
                    !index.is_multiple_of(2)
                });
                // The length was even, so this value is one of those that stay.
                self.every *= 2;
            }
            self.values.push(value);
        }
        self.count += 1;
    }

    /// The values that are kept, in their order.
    pub fn values(&self) -> &[T] {
        &self.values
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// The expansion has four terms, so that a fifth is left. Quantiles to 16 digits from the incomplete beta function.
    #[test]
    fn order_the_expansion_of_students_t_leaves_a_fifth_order() {
        for (degrees, exact) in
            [(31, 2.039_513_446_396_408), (60, 2.000_297_822_014_26), (120, 1.979_930_405_082_424)]
        {
            let left = (student_t_95(degrees) - exact) * (degrees as f64).powi(5);
            assert!((left + 0.745).abs() < 0.02, "{degrees}: {left}");
        }
    }

    /// A deviation with ν degrees of freedom lies between those that 2.5 % and 97.5 % quantiles of χ² give.
    #[test]
    fn published_intervals_of_a_deviation() {
        // Abramowitz & Stegun, table 26.8. The cube root of χ² is normal within 0.5 % at ten degrees, less at more.
        for (degrees, low, high) in
            [(10.0, 3.24697, 20.4831), (30.0, 16.7908, 46.9792), (100.0, 74.2219, 129.561)]
        {
            let deviation = 2.0;
            let found = interval_of_deviation(deviation, deviation / f64::sqrt(2.0 * degrees));
            for (found, quantile) in found.into_iter().zip([high, low]) {
                let wanted = deviation * f64::sqrt(degrees / quantile);
                assert!((found / wanted - 1.0).abs() < 0.05 / degrees, "{degrees}: {found} {wanted}");
            }
        }
        // No deviation has no error.
        assert_eq!(interval_of_deviation(0.0, 0.0), [0.0; 2]);
    }

    #[test]
    fn an_interval_holds_its_ends_and_is_relative_to_the_size_of_its_value() {
        let interval = Interval { value: -4.0, low: -5.0, high: -2.0 };
        assert_eq!(
            [-5.1, -5.0, -3.0, -2.0, -1.9].map(|x| interval.holds(x)),
            [false, true, true, true, false]
        );
        assert_eq!(interval.relative(), 0.375);
    }

    #[test]
    fn quantiles_lie_on_straight_lines_between_the_sorted_finite_values() {
        let values = [5.0, f64::NAN, 1.0, 40.0, 2.0, f64::INFINITY, 3.0];
        for (fraction, wanted) in [
            (-1.0, 1.0),
            (0.0, 1.0),
            (0.1, 1.4),
            (0.25, 2.0),
            (0.625, 4.0),
            (0.9, 26.0),
            (1.0, 40.0),
            (2.0, 40.0),
        ] {
            let found = quantile(&values, fraction);
            assert!((found - wanted).abs() < 1e-12, "{fraction}: {found}");
        }
        assert_eq!([median(&values), median(&[7.0, 1.0])], [3.0, 4.0]);
        assert!(median(&[f64::NAN]).is_nan());
    }

    /// A symmetric positive definite matrix.
    fn definite(scale: f64) -> Vec<Vec<f64>> {
        [[4.0, 2.0, 0.6], [2.0, 3.0, 0.4], [0.6, 0.4, 2.0]]
            .map(|row| row.map(|x| scale * x).to_vec())
            .to_vec()
    }

    #[test]
    fn analytic_a_matrix_times_its_inverse_is_one() {
        for scale in [1.0, 1e-12, 1e12] {
            let (matrix, inverse) = (definite(scale), inverse(definite(scale)).unwrap());
            for (i, row) in matrix.iter().enumerate() {
                let mut product = vec![0.0; row.len()];
                row.iter().zip(&inverse).for_each(|(factor, of)| add(&mut product, *factor, of));
                for (j, found) in product.iter().enumerate() {
                    assert!((found - f64::from(u8::from(i == j))).abs() < 1e-14, "{scale}: {i} {j} {found}");
                }
            }
        }
    }

    #[test]
    fn analytic_what_is_solved_fulfils_its_equations() {
        let (solution, matrix) = ([0.5, -2.0, 3.0], definite(1.0));
        let sides: Vec<f64> = matrix.iter().map(|row| dot(row, &solution)).collect();
        let found = solve_positive(matrix, sides).unwrap();
        assert!(
            found.iter().zip(solution).all(|(found, wanted)| (found - wanted).abs() < 1e-14),
            "{found:?}"
        );
    }

    #[test]
    fn rejects_matrices_that_are_not_positive_definite() {
        // The last column is the sum of the others.
        let singular = [[2.0, 1.0, 3.0], [1.0, 5.0, 6.0], [3.0, 6.0, 9.0]].map(|row| row.to_vec()).to_vec();
        assert_eq!(inverse(singular), Err(2));
        assert_eq!(inverse(vec![vec![f64::NAN]]), Err(0));
        for matrix in [vec![vec![1.0, 2.0], vec![2.0, 1.0]], vec![vec![0.0; 2]; 2]] {
            assert_eq!(solve_positive(matrix, vec![1.0; 2]), None);
        }
    }

    #[test]
    fn a_long_series_is_kept_evenly_and_a_short_one_whole() {
        let most = EvenSample::<u64>::MOST as u64;
        for (length, every) in
            [(5, 1), (most, 1), (most + 1, 2), (2 * most, 2), (2 * most + 1, 4), (1_000_000, 64)]
        {
            let mut thinned = EvenSample::default();
            (0..length).for_each(|value| thinned.push(value));
            let wanted: Vec<u64> = (0..length).step_by(every).collect();
            assert!(thinned.values() == wanted && wanted.len() as u64 <= most, "{length}");
        }
    }
}
