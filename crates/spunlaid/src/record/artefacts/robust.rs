//! Centre, spread and resolution of samples, of which some are no velocities.

use crate::statistics::quantile;

/// Largest number of samples that are ranked.
const MOST_RANKED: usize = 1 << 16;
/// Quantiles of the distance from the median of a Gaussian, in standard deviations: of half and of four fifths.
const HALF: f64 = 0.6745;
const FOUR_FIFTHS: f64 = 1.2816;

/// Centre, spread and resolution that a fifth of spoilt samples does not change much.
#[derive(Clone, Copy, Debug)]
pub(super) struct Robust {
    pub(super) median: f64,
    /// Standard deviation, by the distances from the median that a half and four fifths of the samples keep.
    pub(super) deviation: f64,
    /// Smallest step between neighbouring samples that differ.
    pub(super) resolution: f64,
}

impl Robust {
    /// None if most samples are equal.
    pub(super) fn new(values: &[f64]) -> Option<Self> {
        let some = thinned(values);
        let median = quantile(&some, 0.5);
        let distances: Vec<f64> = some.iter().map(|x| (x - median).abs()).collect();
        let deviation = (quantile(&distances, 0.5) / HALF).max(quantile(&distances, 0.8) / FOUR_FIFTHS);
        // Decimal numbers differ by their rounding too.
        let least = 1e-9 * deviation.max(median.abs());
        let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|step| *step > least);
        let resolution = steps.fold(f64::INFINITY, f64::min);
        (deviation > least).then_some(Self { median, deviation, resolution })
    }

    /// Standard deviations from the median.
    pub(super) fn distance(&self, value: f64) -> f64 {
        (value - self.median).abs() / self.deviation
    }
}

/// Samples at even distances, few enough to be ranked.
pub(super) fn thinned(values: &[f64]) -> Vec<f64> {
    values.iter().copied().step_by(values.len().div_ceil(MOST_RANKED).max(1)).collect()
}
