//! Computes 95 % confidence intervals, by the block jackknife or from the number of independent values.

use spunlaid_ground::statistics::student_t_95;
use spunlaid_ground::{Interval, NORMAL_95};

/// Half width of an interval from which that of the logarithm has no meaning: a factor of ten.
const LARGEST_LOGARITHM: f64 = std::f64::consts::LN_10;

/// The interval of a positive quantity, given the standard error of its logarithm.
pub(super) fn logarithmic(value: f64, error: f64, quantile: f64) -> Interval {
    let factor = libm::exp(quantile * error);
    Interval { value, low: value / factor, high: value * factor }
}

/// The interval of a mean of independent squares about `value`; `error` is the standard error of its logarithm.
///
/// The mean is distributed like a chi-square of `2/error²` degrees of freedom; `value` is the median estimate.
pub(super) fn from_squares(mean: f64, value: f64, error: f64) -> Interval {
    let share = |z: f64| chi_square(2.0 / (error * error), z);
    Interval { value, low: mean / share(NORMAL_95), high: mean / share(-NORMAL_95) }
}

/// The block jackknife: `left_out` are the estimates with each block left out in turn.
///
/// The standard error `s` follows from `s² = (B−1)/B Σ(θ_b − θ̄)²` (Künsch, Annals of Statistics 17, 1989);
/// the interval is Student's with `B−1` degrees of freedom, of the logarithm if `positive`. Where an estimate is
/// not positive, or the logarithms scatter too much to have a meaning, a positive quantity has as much room above
/// as by its own scatter, and as large a factor below.
pub(super) fn jackknife(value: f64, left_out: &[f64], positive: bool) -> Interval {
    let quantile = student_t_95((left_out.len() as u64).saturating_sub(1));
    let half = quantile * error(left_out);
    if !(positive && value > 0.0) {
        return Interval { value, low: value - half, high: value + half };
    }
    let logarithms: Vec<f64> = left_out.iter().map(|x| libm::log(x.max(0.0))).collect();
    let of_logarithm = error(&logarithms);
    if quantile * of_logarithm < LARGEST_LOGARITHM {
        return logarithmic(value, of_logarithm, quantile);
    }
    let high = value + half;
    Interval { value, low: value * (value / high), high }
}

/// The chi-square distribution over its degrees of freedom, `z` standard deviations of a normal variable from its
/// median.
///
/// Source: Wilson & Hilferty, Proceedings of the National Academy of Sciences 17, 1931.
pub(super) fn chi_square(degrees: f64, z: f64) -> f64 {
    let variance = 2.0 / (9.0 * degrees);
    let root = (1.0 - variance + z * variance.sqrt()).max(0.1);
    root * root * root
}

/// Standard error by the estimates with each block left out.
pub(super) fn error(left_out: &[f64]) -> f64 {
    let blocks = left_out.len() as f64;
    let mean = left_out.iter().sum::<f64>() / blocks;
    let squares: f64 = left_out.iter().map(|x| (x - mean) * (x - mean)).sum();
    ((blocks - 1.0) / blocks * squares).sqrt()
}

/// Change of a quantity over the record, by a straight line through its values in the blocks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trend {
    /// From the start of the record to its end, with its 95 % interval [m/s].
    pub change: Interval,
    /// Whether the change is more than 3.5 standard errors.
    pub significant: bool,
}

impl Trend {
    /// The trend of a quantity, given its value in each block.
    pub(super) fn new(values: &[f64]) -> Self {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let place = |i: usize| (i as f64 + 0.5) / count - 0.5;
        let spread: f64 = (0..values.len()).map(|i| place(i) * place(i)).sum();
        let change = values.iter().enumerate().map(|(i, y)| place(i) * y).sum::<f64>() / spread;
        let residual = |(i, y): (usize, &f64)| y - mean - change * place(i);
        let squares: f64 = values.iter().enumerate().map(|pair| residual(pair).powi(2)).sum();
        let error = (squares / (count - 2.0) / spread).sqrt();
        let half = student_t_95((values.len() as u64).saturating_sub(2)) * error;
        Self {
            change: Interval { value: change, low: change - half, high: change + half },
            significant: change.abs() > 3.5 * error,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_quantiles_of_chi_square() {
        // Abramowitz & Stegun, table 26.8: 20 degrees of freedom.
        for (z, quantile) in [(-NORMAL_95, 9.59083), (0.0, 19.3374), (NORMAL_95, 34.1696)] {
            assert!((20.0 * chi_square(20.0, z) / quantile - 1.0).abs() < 2e-3, "{z}");
        }
    }

    #[test]
    fn analytic_jackknife_of_a_mean_is_its_standard_error() {
        let values = [3.0, 1.0, 4.0, 1.0, 5.0, 9.0, 2.0, 6.0];
        let (n, sum) = (8.0, values.iter().sum::<f64>());
        let left_out: Vec<f64> = values.iter().map(|x| (sum - x) / (n - 1.0)).collect();
        let variance = values.iter().map(|x| (x - sum / n).powi(2)).sum::<f64>() / (n - 1.0);
        assert!((error(&left_out) - (variance / n).sqrt()).abs() < 1e-12);
        let interval = jackknife(sum / n, &left_out, false);
        assert!(interval.holds(sum / n) && !interval.holds(7.0));
    }

    #[test]
    fn invariant_intervals_of_positive_quantities_are_positive() {
        for left_out in
            [[3.0, -1.0, 2.0, 0.5], [1e-9, 1.0, 2.0, 1.5], [0.0, 1.0, 2.0, 1.5], [1.0, 1.1, 0.9, 1.0]]
        {
            let Interval { value, low, high } = jackknife(1.2, &left_out, true);
            assert!(
                0.0 < low && low <= value && value <= high && high < 20.0,
                "{left_out:?}: {low} to {high}"
            );
        }
    }
}

#[cfg(test)]
mod trend_tests {
    use super::*;

    #[test]
    fn analytic_trend_of_a_straight_line() {
        let values: Vec<f64> = (0..10).map(|i| 3.0 + 0.2 * f64::from(i)).collect();
        let trend = Trend::new(&values);
        assert!((trend.change.value - 2.0).abs() < 1e-12 && trend.significant);
        assert!(!Trend::new(&[1.0, 2.0, 1.0, 2.0, 1.0, 2.0, 1.0, 2.0]).significant);
    }
}
