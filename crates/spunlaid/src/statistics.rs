//! Statistics over replicates and over time.

use crate::fft::{Complex, InverseTransform};
use crate::lanes::{Lanes, WIDTH};
use std::f64::consts::PI;

/// A result over the replicates of an ensemble.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Estimate {
    /// Mean over the replicates.
    pub mean: f64,
    /// Standard error of the mean; none from a single replicate.
    pub standard_error: Option<f64>,
    /// The replicates' own values, in their order.
    pub values: Vec<f64>,
}

impl Estimate {
    /// Mean and standard error `s/√n`, summed in the order given.             theory.md (39)
    pub fn of(values: Vec<f64>) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
        let standard_error = (values.len() > 1).then(|| (squares / (n - 1.0) / n).sqrt());
        Self { mean, standard_error, values }
    }
}

/// Student's t for a two-sided confidence interval of 95 %, with so many degrees of freedom, one or more.
pub fn student_t_95(degrees: u64) -> f64 {
    #[rustfmt::skip]
    const TABLE: [f64; 30] = [
        12.7062, 4.30265, 3.18245, 2.77645, 2.57058, 2.44691, 2.36462, 2.306, 2.26216, 2.22814,
        2.20099, 2.17881, 2.16037, 2.14479, 2.13145, 2.11991, 2.10982, 2.10092, 2.09302, 2.08596,
        2.07961, 2.07387, 2.06866, 2.0639, 2.05954, 2.05553, 2.05183, 2.04841, 2.04523, 2.04227,
    ];
    let tabled = degrees.checked_sub(1).and_then(|i| TABLE.get(usize::try_from(i).ok()?));
    tabled.copied().unwrap_or_else(|| {
        // Cornish and Fisher's expansion about the normal distribution; good to 1e-4 from here on.
        let (z, n) = (1.959_963_984_540_054_f64, degrees as f64);
        let (z3, z5) = (z.powi(3), z.powi(5));
        z + (z3 + z) / (4.0 * n) + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * n * n)
    })
}

/// The value below which a share of the finite values lies, linear between neighbours; NaN of none.
pub fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
    if sorted.is_empty() {
        return f64::NAN;
    }
    sorted.sort_by(f64::total_cmp);
    let place = share.clamp(0.0, 1.0) * (sorted.len() - 1) as f64;
    let below = place.floor() as usize;
    let above = (below + 1).min(sorted.len() - 1);
    sorted[below] + (place - below as f64) * (sorted[above] - sorted[below])
}

/// The middle value of the finite ones.
pub fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}

/// One-sided power spectral density per frequency, averaged over records and overlapping segments.
///
/// Welch's method: Hann window, half overlap, each segment's mean removed. `∫ P df` is the variance of
/// what the segments resolve.                                                 theory.md (40)
#[derive(Clone, Debug)]
pub struct PowerSpectrum {
    interval: f64,
    window: Vec<f64>,
    transform: InverseTransform,
    sum: Vec<f64>,
    segments: u64,
    waiting: Vec<Vec<f64>>,
}

impl PowerSpectrum {
    /// For records of samples `interval` [s] apart, cut into segments of `length` (a power of two).
    pub fn new(interval: f64, length: usize) -> Self {
        let window = (0..length).map(|i| libm::sin(PI * (i as f64 + 0.5) / length as f64).powi(2)).collect();
        Self {
            interval,
            window,
            transform: InverseTransform::new(length),
            sum: vec![0.0; length / 2],
            segments: 0,
            waiting: Vec::new(),
        }
    }

    /// The longest power of two that gives a record of `samples` about eight half-overlapping segments.
    pub fn segment_length(samples: usize) -> usize {
        (samples / 4).max(2).next_power_of_two()
    }

    /// Takes in a record; what is left over at its end is not used.
    pub fn add(&mut self, record: &[f64]) {
        let length = self.window.len();
        let mut start = 0;
        while start + length <= record.len() {
            let segment = &record[start..start + length];
            let mean = segment.iter().sum::<f64>() / length as f64;
            self.waiting.push(segment.iter().zip(&self.window).map(|(x, w)| (x - mean) * w).collect());
            if self.waiting.len() == WIDTH {
                self.flush();
            }
            start += length / 2;
        }
    }

    fn flush(&mut self) {
        let length = self.window.len();
        let segments = std::mem::take(&mut self.waiting);
        let at = |i: usize, t: usize| segments.get(i).map_or(0.0, |s| s[t]);
        let mut data: Vec<Complex> =
            (0..length).map(|t| Complex { re: Lanes::from_fn(|i| at(i, t)), im: Lanes::ZERO }).collect();
        self.transform.run(&mut data);
        for (sum, y) in self.sum.iter_mut().zip(&data) {
            let power = y.re * y.re + y.im * y.im;
            for p in &power.0[..segments.len()] {
                *sum += p;
            }
        }
        self.segments += segments.len() as u64;
    }

    /// Frequencies above zero [Hz] and the density there [(unit)²/Hz]; empty without a whole segment.
    pub fn density(mut self) -> Vec<(f64, f64)> {
        if !self.waiting.is_empty() {
            self.flush();
        }
        if self.segments == 0 {
            return Vec::new();
        }
        let length = self.window.len() as f64;
        let energy: f64 = self.window.iter().map(|w| w * w).sum();
        let scale = 2.0 * self.interval / (energy * self.segments as f64);
        let step = 1.0 / (length * self.interval);
        self.sum.iter().enumerate().skip(1).map(|(k, p)| (k as f64 * step, p * scale)).collect()
    }
}
