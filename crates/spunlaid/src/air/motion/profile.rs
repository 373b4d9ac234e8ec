//! Air that changes with the distance from the root, as measured with a hot wire along a diffuser.

use super::spectrum::linear;

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
    pub(crate) fn range(&self) -> (f64, f64) {
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
