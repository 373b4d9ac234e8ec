//! 95 % confidence intervals: by leaving out blocks, and from a known number of independent values.

use crate::statistics::student_t_95;

/// A value with its 95 % confidence interval.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Interval {
    /// The estimate.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// A value that is known.
    pub const fn exactly(value: f64) -> Self {
        Self { value, low: value, high: value }
    }

    /// Whether a value lies in it.
    pub fn holds(&self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// Half its width as a share of the value.
    pub fn relative(&self) -> f64 {
        0.5 * (self.high - self.low) / self.value.abs()
    }

    /// Of a positive quantity whose logarithm is normal with a standard error.
    pub(super) fn logarithmic(value: f64, error: f64, quantile: f64) -> Self {
        let factor = libm::exp(quantile * error);
        Self { value, low: value / factor, high: value * factor }
    }

    /// The block jackknife: `left_out` are the estimates with each block left out in turn.
    ///
    /// The standard error `s` follows from `s² = (B−1)/B Σ(θ_b − θ̄)²` (Künsch, Annals of Statistics 17, 1989);
    /// the interval is Student's with `B−1` degrees of freedom, of the logarithm where all are positive and
    /// `positive` is said.
    pub(super) fn jackknife(value: f64, left_out: &[f64], positive: bool) -> Self {
        let quantile = student_t_95((left_out.len() as u64).saturating_sub(1));
        let in_logarithm = positive && value > 0.0 && left_out.iter().all(|x| *x > 0.0);
        if in_logarithm {
            let logarithms: Vec<f64> = left_out.iter().map(|x| libm::log(*x)).collect();
            return Self::logarithmic(value, error(&logarithms), quantile);
        }
        let half = quantile * error(left_out);
        Self { value, low: value - half, high: value + half }
    }
}

/// Standard error from estimates with each block left out.
pub(super) fn error(left_out: &[f64]) -> f64 {
    let blocks = left_out.len() as f64;
    let mean = left_out.iter().sum::<f64>() / blocks;
    let squares: f64 = left_out.iter().map(|x| (x - mean) * (x - mean)).sum();
    ((blocks - 1.0) / blocks * squares).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_jackknife_of_a_mean_is_its_standard_error() {
        let values = [3.0, 1.0, 4.0, 1.0, 5.0, 9.0, 2.0, 6.0];
        let (n, sum) = (8.0, values.iter().sum::<f64>());
        let left_out: Vec<f64> = values.iter().map(|x| (sum - x) / (n - 1.0)).collect();
        let variance = values.iter().map(|x| (x - sum / n).powi(2)).sum::<f64>() / (n - 1.0);
        assert!((error(&left_out) - (variance / n).sqrt()).abs() < 1e-12);
        let interval = Interval::jackknife(sum / n, &left_out, false);
        assert!(interval.holds(sum / n) && !interval.holds(7.0));
    }
}
