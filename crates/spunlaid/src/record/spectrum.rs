//! One-sided spectrum by Welch's method, with the window and the overlap of choice.

use crate::fft::{Complex, InverseTransform};
use crate::lanes::{Lanes, WIDTH};
use std::f64::consts::PI;

/// What each segment is multiplied with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Window {
    /// `sin²`: little leakage from far off.
    #[default]
    Hann,
    /// A raised `sin²`: a narrower line, more leakage from far off.
    Hamming,
    /// Nothing: the narrowest line, the most leakage.
    Rectangular,
}

impl Window {
    /// Every window.
    pub const ALL: [Self; 3] = [Self::Hann, Self::Hamming, Self::Rectangular];

    /// As it is written: `hann`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hann => "hann",
            Self::Hamming => "hamming",
            Self::Rectangular => "rectangular",
        }
    }

    fn at(self, place: f64) -> f64 {
        let hann = libm::sin(PI * place) * libm::sin(PI * place);
        match self {
            Self::Hann => hann,
            Self::Hamming => 0.08 + 0.92 * hann,
            Self::Rectangular => 1.0,
        }
    }
}

/// How a spectrum is to be taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectrumSettings {
    /// Window.
    pub window: Window,
    /// Share of a segment that the next one has in common with it, 0 to 0.9.
    pub overlap: f64,
    /// Samples in a segment, a power of two; chosen by the integral time where it is left open.
    pub segment: Option<usize>,
}

impl Default for SpectrumSettings {
    fn default() -> Self {
        Self { window: Window::Hann, overlap: 0.5, segment: None }
    }
}

/// One-sided power spectral density of the fluctuation about the record's mean.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// Between the frequencies [Hz].
    pub step: f64,
    /// Density at one step, two steps … up to half the sampling rate [(m/s)²/Hz]. `Σ P Δf` is the variance of
    /// what the segments resolve.
    pub density: Vec<f64>,
    /// Number of segments.
    pub segments: usize,
    /// Samples in a segment.
    pub segment: usize,
    /// Window.
    pub window: Window,
    /// Share of a segment that the next one has in common with it.
    pub overlap: f64,
    /// Time of record that the average is worth, without what windows leave unused [s].
    pub effective_duration: f64,
}

impl Spectrum {
    /// Of values about a mean, `interval` [s] apart; `segment` is a power of two no longer than the record.
    pub(super) fn of(
        values: &[f64],
        mean: f64,
        interval: f64,
        segment: usize,
        settings: &SpectrumSettings,
    ) -> Self {
        let window: Vec<f64> =
            (0..segment).map(|i| settings.window.at((i as f64 + 0.5) / segment as f64)).collect();
        let hop = ((segment as f64 * (1.0 - settings.overlap)).round() as usize).clamp(1, segment);
        let starts: Vec<usize> = (0..=values.len().saturating_sub(segment)).step_by(hop).collect();
        let transform = InverseTransform::new(segment);
        let mut sums = vec![0.0; segment / 2];
        // Two segments in a lane, one as the real and one as the imaginary part.
        for sixteen in starts.chunks(2 * WIDTH) {
            let at = |i: usize, t: usize| {
                sixteen.get(i).and_then(|start| values.get(start + t)).map_or(0.0, |x| (x - mean) * window[t])
            };
            let mut data: Vec<Complex> = (0..segment)
                .map(|t| Complex {
                    re: Lanes::from_fn(|i| at(2 * i, t)),
                    im: Lanes::from_fn(|i| at(2 * i + 1, t)),
                })
                .collect();
            transform.run(&mut data);
            for (k, sum) in (1..).zip(&mut sums) {
                // The powers of both parts add up to half of what is at k and at −k.
                let (a, b) = (&data[k], &data[segment - k]);
                let both = a.re * a.re + a.im * a.im + b.re * b.re + b.im * b.im;
                *sum += 0.5 * both.0.iter().sum::<f64>();
            }
        }
        let energy: f64 = window.iter().map(|w| w * w).sum();
        let scale = 2.0 * interval / (energy * starts.len() as f64);
        let mut density: Vec<f64> = sums.iter().map(|sum| sum * scale).collect();
        // At half the sampling rate both sides are one.
        if let Some(last) = density.last_mut() {
            *last *= 0.5;
        }
        Self {
            step: 1.0 / (segment as f64 * interval),
            density,
            segments: starts.len(),
            segment,
            window: settings.window,
            overlap: settings.overlap,
            effective_duration: effective_samples(&window, &starts) * interval,
        }
    }

    /// Frequency of an entry of the density [Hz].
    pub fn frequency(&self, entry: usize) -> f64 {
        (entry + 1) as f64 * self.step
    }

    /// Half the sampling rate [Hz].
    pub fn highest(&self) -> f64 {
        self.density.len() as f64 * self.step
    }
}

/// `(Σw̄)²/Σw̄²`, `w̄` the sum of the squared windows at a sample: how many samples carry the average.
fn effective_samples(window: &[f64], starts: &[usize]) -> f64 {
    let length = starts.last().map_or(0, |last| last + window.len());
    let mut weight = vec![0.0; length];
    for start in starts {
        for (weight, w) in weight[*start..].iter_mut().zip(window) {
            *weight += w * w;
        }
    }
    let (sum, squares) = weight.iter().fold((0.0, 0.0), |(a, b), w| (a + w, b + w * w));
    sum * sum / squares
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spectrum(values: &[f64], segment: usize, window: Window, overlap: f64) -> Spectrum {
        let settings = SpectrumSettings { window, overlap, segment: None };
        Spectrum::of(values, 0.0, 0.25, segment, &settings)
    }

    #[test]
    fn analytic_spectrum_of_four_samples() {
        // 1, 2, 4, 5 about 3 at 4 Hz: X₁ = −3 + 3i, X₂ = −2; P₁ = 2 · 18 · ¼/4, P₂ = 4 · ¼/4.
        let of = spectrum(&[-2.0, -1.0, 1.0, 2.0], 4, Window::Rectangular, 0.0);
        assert_eq!((of.step, of.segments), (1.0, 1));
        for (found, wanted) in of.density.iter().zip([2.25, 0.25]) {
            assert!((found - wanted).abs() < 1e-14, "{:?}", of.density);
        }
        // Parseval: the variance.
        assert!((of.density.iter().sum::<f64>() * of.step - 2.5).abs() < 1e-14);
    }

    #[test]
    fn analytic_line_of_a_sine_holds_its_variance() {
        for window in Window::ALL {
            let values: Vec<f64> = (0..4096).map(|i| (2.0 * PI * f64::from(i) / 16.0).sin()).collect();
            let of = spectrum(&values, 256, window, 0.5);
            assert_eq!(of.segments, 31);
            let variance = of.density.iter().sum::<f64>() * of.step;
            assert!((variance - 0.5).abs() < 1e-12, "{window:?}: {variance}");
            let peak = (0..of.density.len()).max_by(|a, b| of.density[*a].total_cmp(&of.density[*b]));
            assert_eq!(peak.map(|p| of.frequency(p)), Some(0.25));
        }
    }

    #[test]
    fn analytic_half_overlapping_hann_windows_carry_nearly_all() {
        // Away from the ends w̄ = sin⁴ + cos⁴: mean ¾, mean square 19/32; ¾²/(19/32) = 18/19.
        let settings = SpectrumSettings::default();
        let of = Spectrum::of(&vec![0.0; 1 << 16], 0.0, 1.0, 64, &settings);
        assert!((of.effective_duration / 65536.0 - 18.0 / 19.0).abs() < 2e-3);
    }
}
