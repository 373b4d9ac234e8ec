//! What was measured: a velocity fluctuation, and air that changes with the distance from the root, as with a hot wire
//! along a diffuser.

use super::spectrum::linear;
use std::sync::Arc;

/// The velocity fluctuation of a record, evenly sampled, with a mean of zero and a rms of one over all
/// components.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Time between samples [s].
    pub interval: f64,
    /// One to three components; the first is along the mean flow.
    pub components: Vec<Arc<[f64]>>,
    /// Integral time of the component along the flow [s].
    pub integral_time: f64,
    /// What the case says of the file because the record does not.
    pub layout: RecordLayout,
    /// What the record says about the air.
    pub says: RecordNumbers,
}

/// What a case says of the file of a record because the file itself does not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordLayout {
    /// Sampling rate [Hz].
    pub rate: Option<f64>,
    /// Number of lines to skip at the start.
    pub skip: Option<u64>,
    /// Columns of velocity by name or number, with commas between them; the first is along the mean flow.
    pub columns: Option<String>,
    /// Column of time by name or number.
    pub time: Option<String>,
    /// Unit of the velocities: `m/s`.
    pub velocity_unit: Option<String>,
    /// Largest number of missing samples in a row that are interpolated.
    pub max_gap: Option<u64>,
}

/// What a record says about the air. A record without its mean gives only the numbers that do not need it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RecordNumbers {
    /// Mean velocity [m/s].
    pub velocity: Option<f64>,
    /// Turbulence intensity [-].
    pub turbulence_intensity: Option<f64>,
    /// Length scale [m].
    pub length_scale: Option<f64>,
    /// Cut-off frequency [Hz].
    pub cutoff_frequency: f64,
}

/// Two stretches of a record count as uncorrelated if they are this many integral times apart. An exponential
/// correlation has then fallen to 0.7 %.
pub const APART: f64 = 5.0;

impl Measured {
    /// Makes a fluctuation of the components [m/s] by subtracting their means.
    pub fn new(interval: f64, components: &[&[f64]], integral_time: f64, says: RecordNumbers) -> Self {
        let fluctuations: Vec<Vec<f64>> = components.iter().map(|values| without_mean(values)).collect();
        let variance = |values: &Vec<f64>| values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64;
        let rms = (fluctuations.iter().map(variance).sum::<f64>() / components.len() as f64).sqrt();
        let scale = if rms > 0.0 { 1.0 / rms } else { 0.0 };
        let components = fluctuations.iter().map(|values| values.iter().map(|v| v * scale).collect());
        Self {
            interval,
            components: components.collect(),
            integral_time,
            layout: RecordLayout::default(),
            says,
        }
    }

    /// Number of samples.
    pub(crate) fn samples(&self) -> usize {
        self.components.first().map_or(0, |component| component.len())
    }

    /// How many stretches one eddy needs at a time, and for each of the three directions the index of its stretch
    /// and of its component. Components measured together stay together; missing ones come from another stretch.
    pub(super) fn directions(&self) -> (usize, [(usize, usize); 3]) {
        match self.components.len() {
            1 => (3, [(0, 0), (1, 0), (2, 0)]),
            2 => (2, [(0, 0), (0, 1), (1, 1)]),
            _ => (1, [(0, 0), (0, 1), (0, 2)]),
        }
    }

    /// How many stretches one eddy needs at a time.
    pub fn stretches_each(&self) -> usize {
        self.directions().0
    }

    /// Number of samples of a stretch of `duration` [s], with those before and after it that the interpolation
    /// needs.
    pub fn stretch(&self, duration: f64) -> f64 {
        (duration / self.interval).ceil() + 4.0
    }

    /// How many stretches of `duration` [s] the record holds whose starts are far enough apart for them to be
    /// uncorrelated.
    pub fn stretches(&self, duration: f64) -> f64 {
        let room = self.samples() as f64 - self.stretch(duration);
        (room * self.interval / (APART * self.integral_time)).floor().max(if room >= 0.0 { 1.0 } else { 0.0 })
    }

    /// How long the record must be [s] for that many stretches.
    pub fn duration_for(&self, stretches: f64, duration: f64) -> f64 {
        stretches * APART * self.integral_time + self.stretch(duration) * self.interval
    }
}

fn without_mean(values: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|v| v - mean).collect()
}

/// A place that lies less than this share of the extent outside of the rows is on the first or the last of them: it was
/// computed as a sum of steps.
const ROUNDING: f64 = 1e-9;

/// The air as a function of the distance x from the root along the mean flow. It is linear between the points;
/// outside them it is the air of the nearest point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Profile {
    /// Distances, rising [m].
    pub x: Vec<f64>,
    /// Mean velocity along x [m/s].
    pub velocity: Vec<f64>,
    /// Turbulence intensity [-]; empty if the profile lacks it.
    pub turbulence_intensity: Vec<f64>,
    /// Length scale [m]; empty if the profile lacks it.
    pub length_scale: Vec<f64>,
    /// Cut-off frequency [Hz]; empty if the profile lacks it.
    pub cutoff_frequency: Vec<f64>,
}

impl Profile {
    /// From the first to the last point [m].
    pub fn range(&self) -> (f64, f64) {
        (self.x.first().copied().unwrap_or(0.0), self.x.last().copied().unwrap_or(0.0))
    }

    /// The smallest distance between two rows [m].
    pub(super) fn closest_rows(&self) -> f64 {
        self.x.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min)
    }

    /// The velocity at the root [m/s]; None of an empty table.
    pub fn velocity_at_root(&self) -> Option<f64> {
        self.at(&self.velocity, 0.0)
    }

    /// The value of a column at `x` [m].
    pub(super) fn at(&self, column: &[f64], x: f64) -> Option<f64> {
        let (first, last) = self.range();
        linear(&self.x, column, x.clamp(first, last))
    }

    /// Whether `x` [m] lies between the first and the last row, or on one of them apart from rounding.
    pub(super) fn contains(&self, x: f64) -> bool {
        let (first, last) = self.range();
        let rounding = ROUNDING * (last - first);
        (first - rounding..=last + rounding).contains(&x)
    }

    /// How fast the velocity rises at `x` [m], `dU/dx` [1/s]: at a row, from there to the next one, and at
    /// the last row from the one before. Outside of the rows it is zero, as the velocity is constant there.
    pub(super) fn velocity_gradient(&self, x: f64) -> f64 {
        if self.x.len() < 2 || !self.contains(x) {
            return 0.0;
        }
        let above = self.x.partition_point(|row| *row <= x).clamp(1, self.x.len() - 1);
        (self.velocity[above] - self.velocity[above - 1]) / (self.x[above] - self.x[above - 1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// −10 1/s between the first rows, −20 1/s between the last ones; steps of a seventh do not add up to 0.7 exactly.
    #[test]
    fn analytic_the_gradient_at_the_first_and_the_last_row_is_that_between_the_rows_there() {
        let profile =
            Profile { x: vec![0.1, 0.3, 0.7], velocity: vec![20.0, 18.0, 10.0], ..Profile::default() };
        let places = [(0.1, -10.0), (0.1 - 1e-16, -10.0), (0.2, -10.0), (0.3, -20.0), (0.7, -20.0)];
        for (x, gradient) in places.into_iter().chain([(0.7 + 1e-15, -20.0), (0.0, 0.0), (0.8, 0.0)]) {
            assert!((profile.velocity_gradient(x) - gradient).abs() < 1e-12, "{x}");
            assert_eq!(profile.contains(x), gradient != 0.0, "{x}");
        }
    }
}
