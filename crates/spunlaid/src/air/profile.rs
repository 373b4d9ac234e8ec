//! Air that changes with the distance from the root, as a wire measures it down a diffuser.

use super::spectrum::linear;

/// The air as a function of the distance x from the root along the mean flow: straight lines between the
/// points, outside them the air of the nearest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Profile {
    /// Distances, rising [m].
    pub x: Vec<f64>,
    /// Mean velocity along x [m/s].
    pub velocity: Vec<f64>,
    /// Turbulence intensity [-]; empty where the profile does not tell.
    pub turbulence_intensity: Vec<f64>,
    /// Length scale [m]; empty where the profile does not tell.
    pub length_scale: Vec<f64>,
    /// Cut-off frequency [Hz]; empty where the profile does not tell.
    pub cutoff_frequency: Vec<f64>,
}

impl Profile {
    /// From the first to the last point [m].
    pub fn range(&self) -> (f64, f64) {
        (self.x.first().copied().unwrap_or(0.0), self.x.last().copied().unwrap_or(0.0))
    }

    /// The value of a column at `x` [m].
    pub(super) fn at(&self, column: &[f64], x: f64) -> Option<f64> {
        let (first, last) = self.range();
        linear(&self.x, column, x.clamp(first, last))
    }
}
