//! Computes the autocorrelation of the fluctuation and its integral.

use spunlaid_ground::{Dimension, Fault};
use std::ops::Range;

/// Rule for the largest lag of the integral of the autocorrelation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum IntegralRule {
    /// The first zero: the usual choice, and the most robust one for a record of finite length.
    #[default]
    FirstZero,
    /// The lag at which it has fallen to 1/e: less scatter, but the tail is left out (37 % of an exponential).
    EFold,
    /// A given lag [s].
    Fixed(f64),
}

impl IntegralRule {
    /// Reads `first-zero`, `e-fold` or `fixed=50 ms`; `None` for any other text.
    pub fn parse(text: &str) -> Option<Result<Self, Fault>> {
        match text.split_once('=') {
            None if text == "first-zero" => Some(Ok(Self::FirstZero)),
            None if text == "e-fold" => Some(Ok(Self::EFold)),
            Some(("fixed", time)) => Some(Dimension::Time.parse(time).map(Self::Fixed)),
            _ => None,
        }
    }

    /// The rule in words: `to its first zero`.
    pub fn words(self) -> String {
        match self {
            Self::FirstZero => "to its first zero".to_owned(),
            Self::EFold => "to where it has fallen to 1/e".to_owned(),
            Self::Fixed(lag) => format!("to a lag of {}", Dimension::Time.pretty(lag)),
        }
    }

    /// The limit of the integral in samples; `None` if it is beyond the last lag.
    fn limit(self, coefficients: &[f64], interval: f64) -> Option<f64> {
        let falls_to = |level: f64| {
            let at = coefficients.iter().position(|c| *c <= level)?;
            let above = coefficients.get(at.checked_sub(1)?)?;
            let below = coefficients.get(at)?;
            Some((at - 1) as f64 + (above - level) / (above - below))
        };
        let limit = match self {
            Self::FirstZero => falls_to(0.0),
            Self::EFold => falls_to(libm::exp(-1.0)),
            Self::Fixed(lag) => Some(lag / interval),
        };
        limit.filter(|limit| *limit <= coefficients.len() as f64 - 1.0)
    }
}

/// Autocorrelation coefficient of the fluctuation, `ρ(τ) = ⟨u'(t) u'(t+τ)⟩/u²`.
///
/// The unbiased estimate: products at a lag are divided by the number of pairs there are.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Autocorrelation {
    /// Step of the lag [s].
    pub interval: f64,
    /// Coefficients from lag zero.
    pub coefficients: Vec<f64>,
    /// Limit of the integral [s].
    pub limit: f64,
    /// Whether the rule's limit was found within a quarter of the record.
    pub limit_found: bool,
}

impl Autocorrelation {
    /// Finds the limit of the integral by a rule.
    pub(super) fn new(coefficients: Vec<f64>, interval: f64, rule: IntegralRule) -> Self {
        let limit = rule.limit(&coefficients, interval);
        let end = coefficients.len().saturating_sub(1) as f64;
        Self { interval, coefficients, limit: limit.unwrap_or(end) * interval, limit_found: limit.is_some() }
    }

    /// Integral time `T_I = ∫ρ dτ` from zero to the limit, by the trapezoidal rule [s].
    pub(crate) fn integral_time(&self) -> f64 {
        let limit = self.limit / self.interval;
        let whole = limit.floor() as usize;
        let at = |k: usize| self.coefficients.get(k).copied().unwrap_or(0.0);
        let trapezia: f64 = (0..whole).map(|k| 0.5 * (at(k) + at(k + 1))).sum();
        let part = limit - whole as f64;
        let end = at(whole) + part * (at(whole + 1) - at(whole));
        (trapezia + part * 0.5 * (at(whole) + end)) * self.interval
    }
}

/// Number of pairs at a lag whose first sample is in a block; `samples` is the length of the record.
pub(super) fn pairs(block: &Range<usize>, lag: usize, samples: usize) -> f64 {
    block.end.min(samples.saturating_sub(lag)).saturating_sub(block.start) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use spunlaid_ground::fft::lagged_products;

    #[test]
    fn analytic_autocorrelation_of_four_samples() {
        // 1, 2, 4, 5 about 3: products 10, 3, −4, −4 over 4, 3, 2, 1 pairs.
        let whole = 0..4;
        let sums = lagged_products(&[1.0, 2.0, 4.0, 5.0], 3.0, std::slice::from_ref(&whole), 4);
        let coefficients: Vec<f64> =
            (0..4).map(|k| sums[0][k] / pairs(&(0..4), k, 4) / (sums[0][0] / 4.0)).collect();
        for (found, wanted) in coefficients.iter().zip([1.0, 0.4, -0.8, -1.6]) {
            assert!((found - wanted).abs() < 1e-14, "{coefficients:?}");
        }
        // Zero at 1 + 0.4/1.2; the integral 0.7 + ½ · 0.4 · ⅓.
        let found = Autocorrelation::new(coefficients.clone(), 0.5, IntegralRule::FirstZero);
        assert!((found.limit - 0.5 * 4.0 / 3.0).abs() < 1e-14 && found.limit_found);
        assert!((found.integral_time() - 0.5 * (0.7 + 0.2 / 3.0)).abs() < 1e-14);
        // To a lag of one and a half samples: 0.7 + ½ (0.4 − 0.2)/2.
        let found = Autocorrelation::new(coefficients, 0.5, IntegralRule::Fixed(0.75));
        assert!((found.integral_time() - 0.5 * 0.75).abs() < 1e-14);
    }

    #[test]
    fn analytic_lagged_products_by_blocks() {
        let values: Vec<f64> = (0..1000).map(|i| f64::from(i * i % 101)).collect();
        let blocks = [0..7, 7..480, 480..1000];
        let lags = 60;
        let found = lagged_products(&values, 50.0, &blocks, lags);
        for (block, sums) in blocks.iter().zip(&found) {
            for (k, sum) in sums.iter().enumerate() {
                let pair = |i: usize| values.get(i + k).map(|y| (values[i] - 50.0) * (y - 50.0));
                let wanted: f64 = block.clone().filter_map(pair).sum();
                assert!((sum - wanted).abs() < 1e-6, "{block:?} at {k}: {sum}, {wanted}");
                assert_eq!(block.clone().filter_map(pair).count() as f64, pairs(block, k, 1000));
            }
        }
    }

    #[test]
    fn rules_are_read() {
        assert_eq!(IntegralRule::parse("first-zero"), Some(Ok(IntegralRule::FirstZero)));
        assert_eq!(IntegralRule::parse("fixed=50 ms"), Some(Ok(IntegralRule::Fixed(0.05))));
        assert!(matches!(IntegralRule::parse("fixed=50"), Some(Err(_))));
        assert_eq!(IntegralRule::parse("second-zero"), None);
    }
}
