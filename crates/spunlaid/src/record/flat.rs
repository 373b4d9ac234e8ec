//! The flat low-frequency part of a spectrum, and the cut-off that keeps the energy.

use super::Interval;
use crate::statistics::{NORMAL_95, Spectrum};

/// The flat part reaches up to the cut-off over this, unless told otherwise: there a spectrum of an
/// exponential correlation has fallen by 3.7 %, one of von Kármán's by 5.3 %, and the mean up to there is
/// 1.3 % and 1.8 % low.
const REACH: f64 = 8.0;
/// Least number of frequencies to average over.
const LEAST: usize = 3;

/// The flat low-frequency part of a spectrum.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlatPart {
    /// Its density per hertz, `Ē` [(m/s)²/Hz].
    pub density: Interval,
    /// Where it is taken to end [Hz].
    pub until: f64,
    /// Cut-off of the flat spectrum with the same variance and the same plateau, `f_c = u²/Ē` [Hz].
    pub cutoff: Interval,
    /// Number of independent values that were averaged.
    pub independent: f64,
    /// Whether the spectrum is too coarse to tell where it is flat.
    pub coarse: bool,
}

impl FlatPart {
    /// Of a spectrum.
    ///
    /// * `variance` – [(m/s)²] and the standard error of its logarithm
    /// * `until` – where the flat part is to end [Hz]; by default at an eighth of the cut-off that follows
    /// * `duration` – of the record [s]
    pub(super) fn of(
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
                // Between two counts that lead to each other, the smaller.
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
            density: Interval::logarithmic(density, scatter.sqrt(), NORMAL_95),
            until,
            cutoff: Interval::logarithmic(cutoff, error, NORMAL_95),
            independent,
            coarse: until > 0.5 * cutoff,
        }
    }

    /// Integral time of the whole autocorrelation, `Ē/(4u²) = 1/(4f_c)` [s].
    pub fn integral_time(&self) -> f64 {
        0.25 / self.cutoff.value
    }
}
