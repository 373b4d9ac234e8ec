//! Estimates from a record, with the error that leaving out one block after the other shows.

use super::correlation::pairs;
use super::interval::{error, jackknife};
use super::{Autocorrelation, IntegralRule};
use spunlaid_ground::Interval;
use spunlaid_ground::fft::lagged_products;
use spunlaid_ground::statistics::student_t_95;
use std::ops::Range;

/// Limit of the integral for the jackknife over the first zero: for an autocorrelation that crosses zero steeply, as
/// that of the flat spectrum, and for one that approaches it slowly, as an exponential. With these the standard error
/// is the scatter between records.
const BEYOND_ZERO: (f64, f64) = (1.1, 1.3);
/// First zero over integral time of the two.
const ZERO_OVER_TIME: (f64, f64) = (1.8, 2.4);
/// Increase of the intervals of skewness and flatness for a skewness of 1; with it 90 % or more hold the known value
/// for lognormal signals of skewness 0.6 to 2, 100 to 1000 integral times long.
const WIDER_BY_SKEWNESS: f64 = 0.5;

/// Sums over the blocks; any block can be left out of the total.
pub(super) struct Blocks {
    pub(super) reference: f64,
    samples: usize,
    ranges: Vec<Range<usize>>,
    pub(super) powers: Vec<Powers>,
    all_powers: Powers,
    products: Vec<Vec<f64>>,
    all_products: Vec<f64>,
}

impl Blocks {
    /// The whole record as one block.
    pub(super) fn whole(values: &[f64], lags: usize) -> Self {
        Self::new(values, std::slice::from_ref(&(0..values.len())), lags)
    }

    pub(super) fn new(values: &[f64], ranges: &[Range<usize>], lags: usize) -> Self {
        let reference = values.iter().sum::<f64>() / values.len() as f64;
        let powers: Vec<Powers> = ranges.iter().map(|r| Powers::new(&values[r.clone()], reference)).collect();
        let all_powers = powers.iter().fold(Powers::default(), |sum, p| sum.plus(p, 1.0));
        let products = lagged_products(values, reference, ranges, lags);
        let all_products =
            (0..lags).map(|k| products.iter().map(|p| p.get(k).copied().unwrap_or(0.0)).sum()).collect();
        Self {
            reference,
            samples: values.len(),
            ranges: ranges.to_vec(),
            powers,
            all_powers,
            products,
            all_products,
        }
    }

    /// Of all blocks, or of all but one.
    fn moments(&self, without: Option<usize>) -> Moments {
        let left = without.map_or(self.all_powers, |b| self.all_powers.plus(&self.powers[b], -1.0));
        left.moments(self.reference)
    }

    /// Of all blocks, or of all but one.
    pub(super) fn autocorrelation(
        &self,
        without: Option<usize>,
        interval: f64,
        rule: IntegralRule,
    ) -> Autocorrelation {
        let moments = self.moments(without);
        let offset = (moments.mean - self.reference) * (moments.mean - self.reference);
        let all = 0..self.samples;
        let coefficients = (self.all_products.iter().enumerate())
            .map(|(k, sum)| {
                let less = without
                    .map_or((0.0, 0.0), |b| (self.products[b][k], pairs(&self.ranges[b], k, self.samples)));
                ((sum - less.0) / (pairs(&all, k, self.samples) - less.1) - offset)
                    / (moments.rms * moments.rms)
            })
            .collect();
        Autocorrelation::new(coefficients, interval, rule)
    }
}

/// Estimates from the whole record, and with each block left out.
pub(super) struct Estimates {
    pub(super) moments: Moments,
    pub(super) autocorrelation: Autocorrelation,
    pub(super) left_out: Vec<(Moments, f64)>,
}

impl Estimates {
    pub(super) fn new(sums: &Blocks, blocks: usize, interval: f64, rule: IntegralRule) -> Self {
        let autocorrelation = sums.autocorrelation(None, interval, rule);
        // Each estimate to its own zero would jump, and all to the zero of the whole would leave out its scatter.
        let rule = match rule {
            IntegralRule::FirstZero => {
                let ratio = autocorrelation.limit / autocorrelation.integral_time();
                let slow = (ratio - ZERO_OVER_TIME.0) / (ZERO_OVER_TIME.1 - ZERO_OVER_TIME.0);
                let beyond = BEYOND_ZERO.0 + (BEYOND_ZERO.1 - BEYOND_ZERO.0) * slow.clamp(0.0, 1.0);
                IntegralRule::Fixed(beyond * autocorrelation.limit)
            }
            other => other,
        };
        let left_out = (0..blocks)
            .map(|b| (sums.moments(Some(b)), sums.autocorrelation(Some(b), interval, rule).integral_time()));
        Self { moments: sums.moments(None), autocorrelation, left_out: left_out.collect() }
    }

    pub(super) fn moment(&self, moment: fn(&Moments) -> f64, positive: bool) -> Interval {
        let left_out: Vec<f64> = self.left_out.iter().map(|(moments, _)| moment(moments)).collect();
        jackknife(moment(&self.moments), &left_out, positive)
    }

    /// The interval is that of `asinh` of the skewness, whose error depends least on its value; without the bias
    /// that the jackknife finds.
    pub(super) fn skewness(&self) -> Interval {
        let value = self.moments.skewness;
        let left_out: Vec<f64> = self.left_out.iter().map(|(m, _)| libm::asinh(m.skewness)).collect();
        let blocks = left_out.len() as f64;
        let mean = left_out.iter().sum::<f64>() / blocks;
        let middle = blocks * libm::asinh(value) - (blocks - 1.0) * mean;
        let half = self.half_width(&left_out);
        let (low, high) = (libm::sinh(middle - half), libm::sinh(middle + half));
        Interval { value, low: low.min(value), high: high.max(value) }
    }

    /// The interval is that of `−1/F²` of the flatness, whose error depends least on its value. It has no upper end
    /// where the tails are long and the record is short; then the square of the value is taken.
    pub(super) fn flatness(&self) -> Interval {
        let value = self.moments.flatness;
        let inverse_square = |f: f64| -1.0 / (f * f);
        let left_out: Vec<f64> = self.left_out.iter().map(|(m, _)| inverse_square(m.flatness)).collect();
        let (middle, half) = (inverse_square(value), self.half_width(&left_out));
        let end = |at: f64| if at < 0.0 { (-1.0 / at).sqrt() } else { f64::INFINITY };
        Interval { value, low: end(middle - half), high: end(middle + half).min((value * value).max(value)) }
    }

    /// Half the interval of a transformed moment. The jackknife finds too small an error in skewed signals, because
    /// few blocks hold their largest values.
    fn half_width(&self, left_out: &[f64]) -> f64 {
        let wider = 1.0 + WIDER_BY_SKEWNESS * self.moments.skewness.abs().min(2.0);
        wider * student_t_95((left_out.len() as u64).saturating_sub(1)) * error(left_out)
    }

    pub(super) fn integral_time(&self) -> Interval {
        let left_out: Vec<f64> = self.left_out.iter().map(|(_, time)| *time).collect();
        jackknife(self.autocorrelation.integral_time(), &left_out, true)
    }
}

/// Sums of powers of the difference from a reference.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Powers {
    count: f64,
    sums: [f64; 4],
}

impl Powers {
    pub(super) fn new(values: &[f64], reference: f64) -> Self {
        let mut sums = [0.0; 4];
        for value in values {
            let d = value - reference;
            let d2 = d * d;
            for (sum, power) in sums.iter_mut().zip([d, d2, d2 * d, d2 * d2]) {
                *sum += power;
            }
        }
        Self { count: values.len() as f64, sums }
    }

    pub(super) fn plus(&self, other: &Self, sign: f64) -> Self {
        let mut sum = *self;
        sum.count += sign * other.count;
        for (a, b) in sum.sums.iter_mut().zip(other.sums) {
            *a += sign * b;
        }
        sum
    }

    /// Moments about the mean. `reference` is what the powers are about.
    pub(super) fn moments(&self, reference: f64) -> Moments {
        let [a, b, c, d] = self.sums.map(|sum| sum / self.count);
        let variance = (b - a * a).max(0.0);
        let third = c - 3.0 * a * b + 2.0 * a * a * a;
        let fourth = d - 4.0 * a * c + 6.0 * a * a * b - 3.0 * a * a * a * a;
        Moments {
            mean: reference + a,
            rms: variance.sqrt(),
            skewness: third / (variance * variance.sqrt()),
            flatness: fourth / (variance * variance),
        }
    }
}

/// Moments of a component.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    /// Mean [m/s].
    pub mean: f64,
    /// Root mean square of the fluctuation `u = √(⟨u'²⟩)`, the sum divided by the number of samples [m/s].
    pub rms: f64,
    /// Skewness `⟨u'³⟩/u³` [-], 0 for a Gaussian.
    pub skewness: f64,
    /// Flatness `⟨u'⁴⟩/u⁴` [-], 3 for a Gaussian.
    pub flatness: f64,
}

impl Moments {
    /// The moments of a list of values.
    pub(crate) fn new(values: &[f64]) -> Self {
        let reference = values.iter().sum::<f64>() / values.len() as f64;
        Powers::new(values, reference).moments(reference)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_moments_of_four_samples() {
        // 1, 2, 4, 5 about 3: −2, −1, 1, 2.
        let moments = Moments::new(&[1.0, 2.0, 4.0, 5.0]);
        assert_eq!((moments.mean, moments.rms, moments.skewness), (3.0, 2.5f64.sqrt(), 0.0));
        assert!((moments.flatness - 8.5 / 6.25).abs() < 1e-15);
        // 0, 0, 0, 4 about 1: −1, −1, −1, 3; variance 3, third 6, fourth 21.
        let moments = Moments::new(&[0.0, 0.0, 0.0, 4.0]);
        assert!(
            (moments.skewness - 6.0 / 27f64.sqrt()).abs() < 1e-15
                && (moments.flatness - 21.0 / 9.0).abs() < 1e-15
        );
    }

    #[test]
    fn leaving_a_block_out_is_having_the_others() {
        let values: Vec<f64> = (0..30).map(|i| f64::from(i * i % 17)).collect();
        let (a, b) = values.split_at(12);
        let rest = Powers::new(&values, 5.0).plus(&Powers::new(a, 5.0), -1.0).moments(5.0);
        let alone = Moments::new(b);
        for (x, y) in [(rest.mean, alone.mean), (rest.rms, alone.rms), (rest.flatness, alone.flatness)] {
            assert!((x - y).abs() < 1e-12, "{x} {y}");
        }
    }
}
