//! One-sided power spectra by Welch's method.

use crate::fft::{Complex, InverseTransform};
use crate::lanes::{Lanes, WIDTH};
use std::f64::consts::PI;

named! {
    /// The window function that multiplies each segment.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum Window {
        /// `sin²`: little leakage from distant frequencies.
        #[default]
        Hann = "hann",
        /// `sin²` on a pedestal: a narrower line, but more leakage from distant frequencies.
        Hamming = "hamming",
        /// One everywhere: the narrowest line and the most leakage.
        Rectangular = "rectangular",
    }
}

impl Window {
    fn at(self, place: f64) -> f64 {
        let hann = libm::sin(PI * place) * libm::sin(PI * place);
        match self {
            Self::Hann => hann,
            Self::Hamming => 0.08 + 0.92 * hann,
            Self::Rectangular => 1.0,
        }
    }
}

/// One-sided power spectral density of a fluctuation.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// Distance between neighbouring frequencies [Hz].
    pub step: f64,
    /// Density at one step, two steps … up to half the sampling rate [(unit)²/Hz]; empty without a whole segment.
    /// `Σ P Δf` is the variance that the segments resolve.
    pub density: Vec<f64>,
    /// Number of segments.
    pub segments: usize,
    /// Samples in a segment.
    pub segment: usize,
    /// Window.
    pub window: Window,
    /// Fraction of a segment that overlaps the next one.
    pub overlap: f64,
    /// Effective duration of the record: less than its length, because the windows use some samples less [s].
    pub effective_duration: f64,
}

impl Spectrum {
    /// Frequency of entry `entry` of the density [Hz].
    pub fn frequency(&self, entry: usize) -> f64 {
        (entry + 1) as f64 * self.step
    }

    /// Half the sampling rate [Hz].
    pub fn highest(&self) -> f64 {
        self.density.len() as f64 * self.step
    }

    /// Frequencies [Hz] and the density there [(unit)²/Hz].
    pub fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        self.density.iter().enumerate().map(|(entry, density)| (self.frequency(entry), *density))
    }
}

/// Welch's method: the mean spectrum of overlapping segments of one or more records.           theory.md (40)
///
/// A record is taken value by value, and not kept: sixteen segments wait at most.
#[derive(Clone, Debug)]
pub struct Welch {
    interval: f64,
    window: Window,
    overlap: f64,
    weights: Vec<f64>,
    transform: InverseTransform,
    sums: Vec<f64>,
    segments: usize,
    /// Over all samples: the sum and the sum of squares of `w̄`, which is the sum of the squared windows at a sample.
    carried: (f64, f64),
    /// Values of the present record that are not transformed, and its segments that are.
    waiting: Vec<f64>,
    transformed: usize,
}

/// Segments that are transformed together: each lane holds two, as the real and the imaginary part.
const TOGETHER: usize = 2 * WIDTH;

impl Welch {
    /// An empty average.
    ///
    /// * `interval` – time between samples [s]
    /// * `segment` – samples in a segment, a power of two
    /// * `overlap` – fraction of a segment that overlaps the next one, 0 to 0.9
    pub fn new(interval: f64, segment: usize, window: Window, overlap: f64) -> Self {
        Self {
            interval,
            window,
            overlap,
            weights: (0..segment).map(|i| window.at((i as f64 + 0.5) / segment as f64)).collect(),
            transform: InverseTransform::new(segment),
            sums: vec![0.0; segment / 2],
            segments: 0,
            carried: (0.0, 0.0),
            waiting: Vec::new(),
            transformed: 0,
        }
    }

    /// A power of two that divides a record of `samples` into about eight segments with an overlap of one half.
    pub fn segment_length(samples: usize) -> usize {
        (samples / 4).max(2).next_power_of_two()
    }

    /// Adds a record; an incomplete segment at its end is not used.
    ///
    /// * `mean` – subtracted from the values; `None` subtracts the mean of each segment
    pub fn add(&mut self, values: &[f64], mean: Option<f64>) {
        values.iter().for_each(|value| self.push(*value, mean));
        self.end_record(mean);
    }

    /// Adds the next value of a record, as [`Welch::add`] does.
    pub fn push(&mut self, value: f64, mean: Option<f64>) {
        self.waiting.push(value);
        if self.waiting.len() == (TOGETHER - 1) * self.hop() + self.weights.len() {
            self.transform_waiting(mean);
            self.waiting.drain(..TOGETHER * self.hop());
        }
    }

    /// Ends a record whose values were pushed.
    pub fn end_record(&mut self, mean: Option<f64>) {
        self.transform_waiting(mean);
        self.waiting.clear();
        let segments = std::mem::take(&mut self.transformed);
        self.segments += segments;
        let (hop, segment) = (self.hop(), self.weights.len());
        let samples = if segments == 0 { 0 } else { (segments - 1) * hop + segment };
        self.carried = (0..samples).fold(self.carried, |(sum, squares), t| {
            let first = (t + 1).saturating_sub(segment).div_ceil(hop);
            let segments_here = first..=(t / hop).min(segments - 1);
            let weight = segments_here.map(|i| self.weights[t - i * hop]).fold(0.0, |all, w| all + w * w);
            (sum + weight, squares + weight * weight)
        });
    }

    /// Samples from the start of a segment to that of the next.
    fn hop(&self) -> usize {
        let segment = self.weights.len();
        ((segment as f64 * (1.0 - self.overlap)).round() as usize).clamp(1, segment)
    }

    /// Adds the segments of the values that wait, at most [`TOGETHER`].
    fn transform_waiting(&mut self, mean: Option<f64>) {
        let segment = self.weights.len();
        let segments: Vec<&[f64]> = self.waiting.windows(segment).step_by(self.hop()).collect();
        if segments.is_empty() {
            return;
        }
        let own_mean = |values: &&[f64]| values.iter().sum::<f64>() / segment as f64;
        let means: Vec<f64> =
            segments.iter().map(|values| mean.unwrap_or_else(|| own_mean(values))).collect();
        let at = |i: usize, t: usize| {
            segments.get(i).map_or(0.0, |values| (values[t] - means[i]) * self.weights[t])
        };
        let mut data: Vec<Complex> = (0..segment)
            .map(|t| Complex {
                re: Lanes::from_fn(|i| at(2 * i, t)),
                im: Lanes::from_fn(|i| at(2 * i + 1, t)),
            })
            .collect();
        self.transformed += segments.len();
        self.transform.run(&mut data);
        for (k, sum) in (1..).zip(&mut self.sums) {
            // The powers of both segments are half the sum of the powers at k and at −k.
            let (a, b) = (&data[k], &data[segment - k]);
            let both = a.re * a.re + a.im * a.im + b.re * b.re + b.im * b.im;
            *sum += 0.5 * both.0.iter().sum::<f64>();
        }
    }

    /// The spectrum of all records.
    pub fn finish(self) -> Spectrum {
        let energy: f64 = self.weights.iter().map(|w| w * w).sum();
        let scale = 2.0 * self.interval / (energy * self.segments as f64);
        let mut density: Vec<f64> = self.sums.iter().map(|sum| sum * scale).collect();
        // At half the sampling rate, k and −k are the same frequency.
        if let Some(last) = density.last_mut() {
            *last *= 0.5;
        }
        if self.segments == 0 {
            density.clear();
        }
        let segment = self.weights.len();
        let (sum, squares) = self.carried;
        Spectrum {
            step: 1.0 / (segment as f64 * self.interval),
            density,
            segments: self.segments,
            segment,
            window: self.window,
            overlap: self.overlap,
            effective_duration: if squares > 0.0 { sum * sum / squares * self.interval } else { 0.0 },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spectrum(values: &[f64], segment: usize, window: Window, overlap: f64) -> Spectrum {
        let mut welch = Welch::new(0.25, segment, window, overlap);
        welch.add(values, Some(0.0));
        welch.finish()
    }

    #[test]
    fn analytic_spectrum_of_four_samples() {
        // 1, 2, 4, 5 about 3 at 4 Hz: X₁ = −3 + 3i, X₂ = −2; P₁ = 2 · 18 · ¼/4, P₂ = 4 · ¼/4.
        let spectrum = spectrum(&[-2.0, -1.0, 1.0, 2.0], 4, Window::Rectangular, 0.0);
        assert_eq!((spectrum.step, spectrum.segments), (1.0, 1));
        for (found, wanted) in spectrum.density.iter().zip([2.25, 0.25]) {
            assert!((found - wanted).abs() < 1e-14, "{:?}", spectrum.density);
        }
        // By Parseval's theorem the sum is the variance.
        assert!((spectrum.density.iter().sum::<f64>() * spectrum.step - 2.5).abs() < 1e-14);
        // The mean is that of the segment, or one that is given.
        let of = |values: &[f64], mean: Option<f64>| {
            let mut welch = Welch::new(0.25, 4, Window::Hann, 0.0);
            welch.add(values, mean);
            welch.finish()
        };
        for mean in [None, Some(3.0)] {
            assert_eq!(of(&[1.0, 2.0, 4.0, 5.0], mean), of(&[-2.0, -1.0, 1.0, 2.0], Some(0.0)));
        }
    }

    #[test]
    fn seven_segments_that_overlap_by_half_fill_a_record_of_a_power_of_two() {
        for samples in [8, 64, 4096, 1 << 20] {
            let segment = Welch::segment_length(samples);
            assert_eq!((samples - segment) / (segment / 2) + 1, 7, "{samples}");
        }
        assert_eq!([1, 5000].map(Welch::segment_length), [2, 2048]);
        let none = spectrum(&[1.0; 63], 64, Window::Hann, 0.5);
        assert_eq!((none.density.len(), none.segments, none.effective_duration), (0, 0, 0.0));
    }

    #[test]
    fn analytic_line_of_a_sine_holds_its_variance() {
        for window in Window::ALL {
            let values: Vec<f64> = (0..4096).map(|i| (2.0 * PI * f64::from(i) / 16.0).sin()).collect();
            let found = spectrum(&values, 256, window, 0.5);
            assert_eq!(found.segments, 31);
            let variance = found.density.iter().sum::<f64>() * found.step;
            assert!((variance - 0.5).abs() < 1e-12, "{window:?}: {variance}");
            let peak =
                (0..found.density.len()).max_by(|a, b| found.density[*a].total_cmp(&found.density[*b]));
            assert_eq!(peak.map(|p| found.frequency(p)), Some(0.25));
            assert_eq!(found.highest(), 2.0);
            // The transform of a window a + b cos is a at its line and b/2 next to it.
            let next = match window {
                Window::Hann => 0.5,
                Window::Hamming => 0.23 / 0.54,
                Window::Rectangular => 0.0,
            };
            let ratio = peak.map(|p| found.density[p + 1] / found.density[p]);
            assert!((ratio.unwrap_or(f64::NAN) - next * next).abs() < 1e-12, "{window:?}: {ratio:?}");
        }
    }

    #[test]
    fn identical_a_record_that_comes_in_pieces() {
        // As the whole record was transformed at once, before it could come value by value: sums over sixteen segments.
        let values: Vec<f64> = (0..5000).map(|i| f64::from(i * i % 1009) + 0.01 * f64::from(i)).collect();
        for (segment, overlap) in [(64, 0.5), (64, 0.0), (64, 0.75), (128, 0.9), (4096, 0.5), (8192, 0.5)] {
            let mut welch = Welch::new(0.25, segment, Window::Hann, overlap);
            welch.add(&values, None);
            let hop = welch.hop();
            let all: Vec<&[f64]> = values.windows(segment).step_by(hop).collect();
            let mut weight = vec![0.0; all.len().checked_sub(1).map_or(0, |last| last * hop + segment)];
            for start in (0..all.len()).map(|i| i * hop) {
                weight[start..].iter_mut().zip(&welch.weights).for_each(|(sum, w)| *sum += w * w);
            }
            let carried = weight.iter().fold((0.0, 0.0), |(sum, squares), w| (sum + w, squares + w * w));
            assert_eq!((welch.segments, welch.carried), (all.len(), carried), "{segment} {overlap}");
            // Groups of sixteen as records of their own leave the same sums.
            let mut groups = Welch::new(0.25, segment, Window::Hann, overlap);
            for sixteen in 0..all.len().div_ceil(TOGETHER) {
                let first = sixteen * TOGETHER * hop;
                let last = (first + (TOGETHER - 1) * hop + segment).min(values.len());
                groups.add(&values[first..last], None);
            }
            assert_eq!(groups.sums, welch.sums, "{segment} {overlap}");
            assert!(welch.waiting.capacity() <= 2 * ((TOGETHER - 1) * hop + segment));
        }
    }

    #[test]
    fn analytic_half_overlapping_hann_windows_carry_nearly_all() {
        // Away from the ends w̄ = sin⁴ + cos⁴: mean ¾, mean square 19/32; ¾²/(19/32) = 18/19.
        let found = spectrum(&vec![0.0; 1 << 16], 64, Window::Hann, 0.5);
        assert!((found.effective_duration / (0.25 * 65536.0) - 18.0 / 19.0).abs() < 2e-3);
    }
}
