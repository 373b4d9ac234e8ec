//! Air that changes with the distance from the root, as measured with a hot wire along a diffuser.

use super::spectrum::linear;

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

    /// The value of a column at `x` [m].
    pub(super) fn at(&self, column: &[f64], x: f64) -> Option<f64> {
        let (first, last) = self.range();
        linear(&self.x, column, x.clamp(first, last))
    }

    /// How fast the velocity rises at `x` [m], `dU/dx` [1/s]. Outside of the rows it is zero, as the velocity is constant there.
    pub(super) fn velocity_gradient(&self, x: f64) -> f64 {
        let above = self.x.partition_point(|row| *row <= x);
        match above.checked_sub(1) {
            Some(below) if above < self.x.len() => {
                (self.velocity[above] - self.velocity[below]) / (self.x[above] - self.x[below])
            }
            _ => 0.0,
        }
    }
}
