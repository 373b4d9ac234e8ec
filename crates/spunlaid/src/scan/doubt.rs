//! Why a number of the web has no interval.

use std::fmt;

/// A sheet that is less than so many patches wide or long tells nothing about the web.
pub const FEWEST: usize = 4;

/// Why the true CV over patches of a size cannot be known from a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Doubt {
    /// The level of the lamp without web is a guess: all CVs may be wrong by the same factor.
    White,
    /// The shading of the lamp is a guess: a polynomial took it out, with what the web varies as smoothly.
    Shading,
    /// The picture of the lamp is clipped.
    ClippedLamp,
    /// The picture of the lamp is darker than that of the web.
    DarkLamp,
    /// What is taken as basis weights may be grey levels.
    GreyLevels,
    /// The blur of the camera has lowered the CV.
    Blur,
    /// The sheet holds too few such patches.
    Few,
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::White => "the level of the lamp is a guess",
            Self::Shading => "the shading of the lamp is a guess",
            Self::ClippedLamp => "the picture of the lamp is clipped",
            Self::DarkLamp => "the picture of the lamp is darker than that of the web",
            Self::GreyLevels => "the numbers may be grey levels and no basis weights",
            Self::Blur => "below the blur of the scan",
            Self::Few => "the sheet holds too few such patches",
        })
    }
}

impl Doubt {
    /// What makes all numbers of a picture doubtful, by its name in files.
    pub const GUESSES: [(&'static str, Self); 5] = [
        ("lamp", Self::White),
        ("shading", Self::Shading),
        ("clipped_lamp", Self::ClippedLamp),
        ("dark_lamp", Self::DarkLamp),
        ("grey_levels", Self::GreyLevels),
    ];
}
