//! A window of the sheet, and the parts of fibres in it.

/// A rectangle of the sheet, in cross and in machine direction [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// The corner nearest to the origin.
    pub corner: [f64; 2],
    /// Its sides.
    pub sides: [f64; 2],
}

/// A part of a fibre within a window.
#[derive(Clone, Debug, PartialEq)]
pub struct Strand {
    /// Number of the layer, from 0.
    pub layer: usize,
    /// Number of the filament in its layer, counted across the web from 0.
    pub filament: usize,
    /// Places in cross and in machine direction, from the corner of the window [m]. The first and the last may be one
    /// piece outside.
    pub points: Vec<[f64; 2]>,
}

impl Window {
    pub(crate) fn holds(&self, point: [f64; 2]) -> bool {
        self.nears(point, 0.0)
    }

    /// Whether a point lies in the window, or so far from it either way.
    pub(super) fn nears(&self, point: [f64; 2], distance: f64) -> bool {
        point.iter().zip(self.sides).all(|(at, side)| (-distance..=side + distance).contains(at))
    }

    /// The larger distance of two points either way, over the window's sides.
    pub(super) fn distance(&self, a: [f64; 2], b: [f64; 2]) -> f64 {
        ((a[0] - b[0]) / self.sides[0]).abs().max(((a[1] - b[1]) / self.sides[1]).abs())
    }
}
