//! Finds the flat low-frequency part of a spectrum and the cut-off that keeps the energy.

use super::interval::{chi_square, from_squares, logarithmic};
use spunlaid_ground::{Interval, NORMAL_95, Spectrum};
use std::f64::consts::PI;

/// By default the flat part ends at the cut-off over this. At this frequency the spectrum of an exponential correlation
/// has fallen by 3.7 %, von Kármán's by 5.3 %; their means up to it are 1.3 % and 1.8 % below the plateau.
const REACH: f64 = 8.0;
/// Least number of frequencies to average over.
const LEAST: usize = 3;
/// In a short record the flat part ends higher, so that it holds this many independent frequencies,
const ENOUGH: f64 = 10.0;
/// but not above the cut-off over this, up to which the mean of an exponential spectrum is 8 % below the plateau, of
/// von Kármán's 12 %.
const LEAST_REACH: f64 = 3.0;
/// The mean up to the cut-off over `R` is corrected by `1 + SAG/R²`, half of what these spectra lack; a flat one lacks
/// nothing.
const SAG: f64 = 0.5;

/// The flat low-frequency part of a spectrum.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlatPart {
    /// Plateau: its density per hertz, `Ē` [(m/s)²/Hz].
    pub density: Interval,
    /// First frequency averaged [Hz]; that of the whole record if the record is short.
    pub from: f64,
    /// End of the part averaged [Hz].
    pub until: f64,
    /// Cut-off of the flat spectrum with the same variance and the same plateau, `f_c = u²/Ē` [Hz].
    pub cutoff: Interval,
    /// Number of independent values averaged.
    pub independent: f64,
    /// Whether the spectrum is too coarse to show where it is flat.
    pub coarse: bool,
}

impl FlatPart {
    /// Averages a spectrum.
    ///
    /// * `variance` – [(m/s)²] and the standard error of its logarithm
    /// * `until` – end of the flat part [Hz]; by default an eighth of the cut-off that follows
    /// * `duration` – of the record [s]
    pub(super) fn new(
        spectrum: &Spectrum,
        variance: (f64, f64),
        until: Option<f64>,
        integral_time: f64,
        duration: f64,
    ) -> Self {
        let (variance, variance_error) = variance;
        let bins = |frequency: f64| {
            ((frequency / spectrum.step) as usize)
                .clamp(LEAST.min(spectrum.density.len()), spectrum.density.len())
        };
        let mean = |count: usize| spectrum.density[..count].iter().sum::<f64>() / count as f64;
        // The cut-off follows from the plateau and the plateau's end from the cut-off.
        let mut count = bins(until.unwrap_or(0.25 / integral_time / REACH));
        if until.is_none() {
            for _ in 0..30 {
                let next = bins(variance / mean(count) / REACH);
                if next == count {
                    break;
                }
                // Two counts may lead to each other; this ends at the smaller one.
                count = if next > count { count + (next - count).div_ceil(2) } else { next };
            }
        }
        let density = mean(count);
        let cutoff = variance / density;
        let until = (count as f64 + 0.5) * spectrum.step;
        let independent = count as f64 * spectrum.step * spectrum.effective_duration;
        // A plateau of n independent values scatters by 1/√n; the variance shares some of its scatter.
        let scatter = 1.0 / independent;
        let shared = 1.0 / (cutoff * duration);
        let error = (scatter + variance_error * variance_error - 2.0 * shared).max(0.25 * scatter).sqrt();
        Self {
            density: logarithmic(density, scatter.sqrt(), NORMAL_95),
            from: spectrum.step,
            until,
            cutoff: logarithmic(cutoff, error, NORMAL_95),
            independent,
            coarse: until > 0.5 * cutoff,
        }
    }

    /// Averages the Fourier components of a whole record that is too short to be cut into segments.
    ///
    /// The mean of `n` squares is distributed like a chi-square of `2n` degrees of freedom, which gives the interval
    /// and the median estimate.
    ///
    /// * `mean` – [m/s]
    /// * `variance` – [(m/s)²] and the standard error of its logarithm
    /// * `until` – end of the flat part [Hz]; by default it follows from the integral time [s]
    pub(super) fn from_short_record(
        values: &[f64],
        interval: f64,
        mean: f64,
        variance: (f64, f64),
        until: Option<f64>,
        integral_time: f64,
    ) -> Self {
        let (variance, variance_error) = variance;
        let duration = values.len() as f64 * interval;
        // The cut-off by the integral time: unlike that by the plateau it does not depend on the choice made here.
        let rough = 0.25 / integral_time;
        let end = until.unwrap_or((rough / REACH).max((rough / LEAST_REACH).min(ENOUGH / duration)));
        let count = ((end * duration).round() as usize).clamp(2, (values.len() / 2).max(3) - 1);
        let end = (count as f64 + 0.5) / duration;
        let sag = if until.is_none() { SAG * (end / rough) * (end / rough) } else { 0.0 };
        let sum: f64 = (1..=count).map(|k| power(values, mean, k)).sum();
        let density = 2.0 * interval * sum / (values.len() * count) as f64 * (1.0 + sag);
        let scatter = 1.0 / count as f64;
        let median = density / chi_square(2.0 * count as f64, 0.0);
        // The variance shares some of the scatter of the plateau.
        let shared = 1.0 / (rough * duration);
        let error = (scatter + variance_error * variance_error - shared).max(0.25 * scatter).sqrt();
        let inverse = from_squares(density / variance, median / variance, error);
        Self {
            density: from_squares(density, median, scatter.sqrt()),
            from: 1.0 / duration,
            until: end,
            cutoff: Interval { value: 1.0 / inverse.value, low: 1.0 / inverse.high, high: 1.0 / inverse.low },
            independent: count as f64,
            coarse: end > 0.5 * rough,
        }
    }

    /// Integral time of the whole autocorrelation, `Ē/(4u²) = 1/(4f_c)` [s].
    pub fn integral_time(&self) -> f64 {
        0.25 / self.cutoff.value
    }
}

/// Squared magnitude of the `k`-th Fourier component of a record about its mean.
fn power(values: &[f64], mean: f64, k: usize) -> f64 {
    let angle = 2.0 * PI * k as f64 / values.len() as f64;
    let (cos, sin) = (libm::cos(angle), libm::sin(angle));
    let (mut re, mut im) = (1.0, 0.0);
    let (mut a, mut b) = (0.0, 0.0);
    for value in values {
        a += (value - mean) * re;
        b += (value - mean) * im;
        (re, im) = (re * cos - im * sin, re * sin + im * cos);
    }
    a * a + b * b
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_power_of_a_sine() {
        let at = |i: u32| 3.0 + 2.0 * (2.0 * PI * 3.0 * f64::from(i) / 64.0).sin();
        let values: Vec<f64> = (0..64).map(at).collect();
        // The amplitude times half the number of samples, squared.
        assert!((power(&values, 3.0, 3) - 64.0 * 64.0).abs() < 1e-9);
        assert!(power(&values, 3.0, 2) < 1e-20);
    }
}
