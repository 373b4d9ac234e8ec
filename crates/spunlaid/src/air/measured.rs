//! A measured fluctuation that fibres fly in.

use std::sync::Arc;

/// The velocity fluctuation of a record, evenly sampled, with a mean of zero and a rms of one over all
/// components.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Time between samples [s].
    pub interval: f64,
    /// One to three components, that along the mean flow first.
    pub components: Vec<Arc<[f64]>>,
    /// Integral time of the component along the flow [s].
    pub integral_time: f64,
    /// The sampling rate, where it was given with the record instead of being in it [Hz].
    pub rate: Option<f64>,
    /// What the record says of the air.
    pub says: Said,
}

/// What a record says of the air; where its mean was taken off, only what does not rest on that.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Said {
    /// Mean velocity [m/s].
    pub velocity: Option<f64>,
    /// Turbulence intensity [-].
    pub turbulence_intensity: Option<f64>,
    /// Length scale [m].
    pub length_scale: Option<f64>,
    /// Cut-off frequency [Hz].
    pub cutoff_frequency: f64,
}

/// How many integral times apart two stretches of a record count as uncorrelated: what is exponentially
/// correlated has fallen to 0.7 %.
pub const APART: f64 = 5.0;

impl Measured {
    /// From the components [m/s]; their means are taken off.
    pub fn new(interval: f64, components: &[&[f64]], integral_time: f64, says: Said) -> Self {
        let fluctuations: Vec<Vec<f64>> = components.iter().map(|values| without_mean(values)).collect();
        let variance = |values: &Vec<f64>| values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64;
        let rms = (fluctuations.iter().map(variance).sum::<f64>() / components.len() as f64).sqrt();
        let scale = if rms > 0.0 { 1.0 / rms } else { 0.0 };
        let components = fluctuations.iter().map(|values| values.iter().map(|v| v * scale).collect());
        Self { interval, components: components.collect(), integral_time, rate: None, says }
    }

    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.components.first().map_or(0, |component| component.len())
    }

    /// Stretches that one eddy takes at a time, and for each of the three directions which of them and which
    /// component: what was measured together stays together, what was not comes from elsewhere in the record.
    pub(super) fn directions(&self) -> (usize, [(usize, usize); 3]) {
        match self.components.len() {
            1 => (3, [(0, 0), (1, 0), (2, 0)]),
            2 => (2, [(0, 0), (0, 1), (1, 1)]),
            _ => (1, [(0, 0), (0, 1), (0, 2)]),
        }
    }

    /// Stretches that one eddy takes at a time.
    pub fn stretches_each(&self) -> usize {
        self.directions().0
    }

    /// Samples that a stretch of `duration` [s] takes, those before and after it included that its
    /// interpolation rests on.
    pub fn stretch(&self, duration: f64) -> f64 {
        (duration / self.interval).ceil() + 4.0
    }

    /// How many stretches of `duration` [s] can begin at instants that are far enough apart for them to be
    /// uncorrelated at any one time.
    pub fn stretches(&self, duration: f64) -> f64 {
        let room = self.samples() as f64 - self.stretch(duration);
        (room * self.interval / (APART * self.integral_time)).floor().max(if room >= 0.0 { 1.0 } else { 0.0 })
    }

    /// How long the record must be [s] for so many of them.
    pub fn duration_for(&self, stretches: f64, duration: f64) -> f64 {
        stretches * APART * self.integral_time + self.stretch(duration) * self.interval
    }
}

fn without_mean(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|v| v - mean).collect()
}
