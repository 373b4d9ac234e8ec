//! A part of the sheet with its weight.

/// A rectangle of the sheet with its weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marked {
    /// Its corner in cross and in machine direction [m].
    pub corner: [f64; 2],
    /// Its sides [m].
    pub sides: [f64; 2],
    /// Its weight over the mean.
    pub weight: f64,
}

impl Marked {
    /// Its middle in cross and in machine direction [m].
    pub fn middle(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.corner[axis] + 0.5 * self.sides[axis])
    }
}
