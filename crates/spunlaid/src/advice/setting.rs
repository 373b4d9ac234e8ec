//! Settings of the machine that change how even a web is, and webs in which one of them is changed.

use crate::layers::WebSpec;
use crate::units::Dimension;

/// A setting of the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setting {
    /// Mass that each hole gives per time. Of known filaments the titre stays, and those of a spinline become coarser with it.
    Throughput,
    /// Number of holes.
    Holes,
    /// Mass per length of the filaments. The throughput of a hole stays, so the filaments come slower if they are coarser.
    Titre,
    /// Way from the inlet to the belt.
    Distance,
    /// Speed of the air between inlet and belt.
    AirSpeed,
    /// How strongly this air fluctuates.
    Turbulence,
    /// Speed of the air that draws the filaments of a spinline.
    DrawingAir,
    /// Temperature of the die.
    DieTemperature,
    /// Size of the slot in machine direction.
    Depth,
    /// Places of the rows in machine direction.
    RowPlaces,
    /// None of the machine: a number that is a guess, and may be another one than is written.
    Guess,
}

impl Setting {
    /// Name in results: `air_speed`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Throughput => "throughput",
            Self::Holes => "holes",
            Self::Titre => "titre",
            Self::Distance => "distance",
            Self::AirSpeed => "air_speed",
            Self::Turbulence => "turbulence",
            Self::DrawingAir => "drawing_air",
            Self::DieTemperature => "die_temperature",
            Self::Depth => "depth",
            Self::RowPlaces => "row_places",
            Self::Guess => "guess",
        }
    }

    /// In words that stand behind “less” or “more”: `throughput of a hole`.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Throughput => "throughput of a hole",
            Self::Holes => "holes",
            Self::Titre => "titre",
            Self::Distance => "distance to the belt",
            Self::AirSpeed => "air speed",
            Self::Turbulence => "turbulence",
            Self::DrawingAir => "speed of the drawing air",
            Self::DieTemperature => "die temperature",
            Self::Depth => "depth of the slot",
            Self::RowPlaces => "distance of the rows",
            Self::Guess => "guessed number",
        }
    }
}

/// A key with its value before and after a change [SI].
#[derive(Clone, Debug, PartialEq)]
pub struct ChangedKey {
    /// Its name, as it is set: `layer.2.line.throughput`.
    pub key: String,
    /// Physical dimension of its values.
    pub dimension: Dimension,
    /// Whether its values are whole numbers.
    pub whole: bool,
    /// The value before.
    pub from: f64,
    /// The value after.
    pub to: f64,
}

impl ChangedKey {
    /// A value for people, with its unit.
    pub fn pretty(&self, value: f64) -> String {
        if self.whole { format!("{value:.0}") } else { self.dimension.pretty(value) }
    }
}

/// A web with one changed setting, of the same basis weight.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// What is changed.
    pub setting: Setting,
    /// Numbers of the layers in which it is changed, from 1: of one, or of equal ones together; none where it is changed in all.
    pub layers: Vec<usize>,
    /// The keys that differ.
    pub keys: Vec<ChangedKey>,
    /// The file of the web.
    pub file: String,
    /// Keys and values with which that file is the changed web. What was set before is among them.
    pub set: Vec<(String, String)>,
    /// The changed web; where it cannot be laid, the web as it is.
    pub spec: WebSpec,
    /// Why it cannot be laid.
    pub refusal: Option<String>,
}
