//! What is found out about a record, and how it is analysed.

use super::flat::FlatPart;
use super::{Autocorrelation, IntegralRule, Trend};
use spunlaid_ground::{Fault, Interval, Spectrum, Window};

/// Fewest and most blocks of a record.
pub(super) const BLOCKS: (usize, usize) = (8, 64);
/// Length of a block in integral times.
pub(super) const BLOCK_TIMES: f64 = 40.0;

/// How to analyse a record.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Settings {
    /// Rule for the largest lag of the integral of the autocorrelation.
    pub integral: IntegralRule,
    /// How to compute the spectrum.
    pub spectrum: SpectrumSettings,
    /// End of the flat part of the spectrum [Hz]; an eighth of the cut-off by default.
    pub flat_until: Option<f64>,
    /// Mean velocity along the flow [m/s]; it replaces the mean of the record.
    pub mean_velocity: Option<f64>,
}

/// How to compute a spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectrumSettings {
    /// Window of a segment.
    pub window: Window,
    /// Share of a segment that the next one has in common with it, 0 to 0.9.
    pub overlap: f64,
    /// Number of samples in a segment, a power of two; by default it follows from the integral time.
    pub segment: Option<usize>,
}

impl Default for SpectrumSettings {
    fn default() -> Self {
        Self { window: Window::Hann, overlap: 0.5, segment: None }
    }
}

/// The results of an analysis; intervals have a confidence of 95 %.
#[derive(Clone, Debug, PartialEq)]
pub struct Analysis {
    /// Number of samples of a component.
    pub samples: usize,
    /// Time between samples [s].
    pub interval: f64,
    /// Duration of the record [s].
    pub duration: f64,
    /// Mean of the component along the flow, `Ū` [m/s].
    pub mean_velocity: Interval,
    /// `Tu = u/|Ū|` [-], `u²` the mean of the components' variances.
    pub turbulence_intensity: Interval,
    /// Integral time `T_I` of the component along the flow [s].
    pub integral_time: Interval,
    /// Length scale by Taylor's hypothesis, `L = T_I |Ū|` [m].
    pub length_scale: Interval,
    /// Cut-off frequency of the flat spectrum with the variance and plateau of the component along the flow [Hz].
    pub cutoff_frequency: Interval,
    /// Results of each component; the first is along the mean flow.
    pub components: Vec<Component>,
    /// Rule of the integral time.
    pub integral: IntegralRule,
    /// Number of blocks of the jackknife.
    pub blocks: usize,
    /// Warnings about the record and the results.
    pub warnings: Vec<Fault>,
}

/// The results of one component.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// Its name in the file.
    pub name: String,
    /// [m/s]
    pub mean: Interval,
    /// [m/s]
    pub rms: Interval,
    /// [-]
    pub skewness: Interval,
    /// [-]
    pub flatness: Interval,
    /// [s]
    pub integral_time: Interval,
    /// Its rule.
    pub integral: IntegralRule,
    /// Autocorrelation up to a few times the limit of the integral.
    pub autocorrelation: Autocorrelation,
    /// Spectrum.
    pub spectrum: Spectrum,
    /// Flat part of the spectrum, and cut-off.
    pub flat: FlatPart,
    /// Trend of the mean.
    pub mean_trend: Trend,
    /// Trend of the rms.
    pub rms_trend: Trend,
    /// Smallest and largest sample [m/s].
    pub range: (f64, f64),
}

impl Component {
    /// Length of a block for which blocks are independent [s].
    pub(super) fn block_time(&self) -> f64 {
        block_time(self.integral_time.value, &self.autocorrelation)
    }
}

impl Analysis {
    /// Whether the mean velocity differs from zero by more than its error.
    pub fn has_mean(&self) -> bool {
        !self.mean_velocity.holds(0.0)
    }

    /// Duration for which the 95 % interval of a result would be ± `share` of its value [s].
    pub fn duration_for(&self, result: &Interval, share: f64) -> f64 {
        self.duration * (result.relative() / share) * (result.relative() / share)
    }
}

/// Length of a block for which blocks are independent [s].
pub(super) fn block_time(integral_time: f64, autocorrelation: &Autocorrelation) -> f64 {
    (BLOCK_TIMES * integral_time).max(8.0 * autocorrelation.limit)
}
