//! How filaments that hang side by side in one air come down together.

use crate::statistics::student_t_95_at;

/// The correlation of the places where two filaments of a layer come down, at equal fed length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeighbourCorrelation {
    /// Index of the layer.
    pub layer: usize,
    /// Distance of their inlets in cross direction [m].
    pub distance: f64,
    /// Of the places in machine direction.
    pub md: Correlation,
    /// Of the places in cross direction.
    pub cd: Correlation,
}

/// A correlation coefficient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correlation {
    /// Its value.
    pub value: f64,
    /// Its standard error; None if too little was laid to know it.
    pub standard_error: Option<f64>,
    /// Degrees of freedom of the error; NaN without one.
    pub degrees: f64,
}

impl Correlation {
    /// The 95 % confidence interval, by Student's t; None if too little was laid to know it.
    pub fn interval(&self) -> Option<[f64; 2]> {
        let half = student_t_95_at(self.degrees) * self.standard_error?;
        Some([self.value - half, self.value + half])
    }
}
