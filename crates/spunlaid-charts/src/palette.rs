//! Colours and signs, the same in every figure: y is a blue circle, z a vermilion triangle.
//!
//! Okabe and Ito's palette, which the colour-blind tell apart.

/// Text and axes.
pub const INK: &str = "#1a1a1a";
/// What the figures are drawn on.
pub const PAPER: &str = "#ffffff";
/// Grid lines.
pub const GRID: &str = "#e6e6e6";
/// What is beside the point: reference lines, notes.
pub const GREY: &str = "#6e6e6e";
/// y.
pub const BLUE: &str = "#0072b2";
/// z.
pub const VERMILION: &str = "#d55e00";
/// A third quantity.
pub const GREEN: &str = "#009e73";
/// A fourth.
pub const ORANGE: &str = "#e69f00";
/// A fifth.
pub const PURPLE: &str = "#9c4f80";

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
