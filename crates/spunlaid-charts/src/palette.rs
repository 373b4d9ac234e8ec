//! Colours and signs, the same in every figure: y is a blue circle, z a vermilion triangle.
//!
//! Okabe and Ito's palette, which the colour-blind can distinguish.

use std::fmt;

/// Red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour(pub [u8; 3]);

/// As SVG has it.
impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [red, green, blue] = self.0;
        write!(f, "#{red:02x}{green:02x}{blue:02x}")
    }
}

/// Text and axes.
pub const INK: Colour = Colour([0x1a, 0x1a, 0x1a]);
/// What the figures are drawn on.
pub const PAPER: Colour = Colour([0xff, 0xff, 0xff]);
/// Grid lines.
pub const GRID: Colour = Colour([0xe6, 0xe6, 0xe6]);
/// What is beside the point: reference lines, notes.
pub const GREY: Colour = Colour([0x6e, 0x6e, 0x6e]);
/// y.
pub const BLUE: Colour = Colour([0x00, 0x72, 0xb2]);
/// z.
pub const VERMILION: Colour = Colour([0xd5, 0x5e, 0x00]);
/// A third quantity.
pub const GREEN: Colour = Colour([0x00, 0x9e, 0x73]);
/// A fourth.
pub const ORANGE: Colour = Colour([0xe6, 0x9f, 0x00]);
/// A fifth.
pub const PURPLE: Colour = Colour([0x9c, 0x4f, 0x80]);

/// The sign a point is drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// y.
    Circle,
    /// z.
    Triangle,
    /// Neither: a filled spot.
    Spot,
    /// One of several of a kind.
    Square,
    /// Another one.
    Diamond,
}
