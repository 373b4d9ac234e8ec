//! The fabric in the words of those who buy it: how even it looks, where it is thin, what it lets through.
//!
//! Everything follows from the map of the basis weight, from the directions of the fibres, and from a few
//! given numbers. Bonds and finishes of the fabric are not known here.
//!
//! ```text
//! map ─────────────────→ formation, thin spots, strips, bare area ┐
//! directions ──────────→ ratio of stiffness                        ├→ Fabric
//! map, thickness ──────→ air permeability                          │
//! map, measured opacity → opacity                                  ┘
//! ```

mod air_through;
mod estimate;
mod light;
mod marks;
mod measures;
mod patches;
mod streaks;
mod strips;
#[cfg(test)]
mod tests;
mod usable;

pub use air_through::{Filaments, air_speed};
pub use estimate::{ABOUT, PATCHES, columns_sold};
pub use estimate::{AirThrough, Fabric, FabricPatch, Laid, LaidPatch, Opacity, estimate, of_scan};
pub use light::{bare_area, formation, opacity, scattering};
pub use marks::Marks;
pub use measures::{
    FABRIC_MEASURES, FABRIC_PATCH_MEASURES, STREAK_MEASURES, STRIP_MEASURES, THINNEST_PATCH_MEASURES,
};
pub use patches::NONE_FOUND;
pub use patches::{ThinPlaces, thin_places};
pub use streaks::{Streak, StreakSource, streaks};
pub use strips::{StripPlace, StripSize, Strips, strips};
pub use usable::{Usable, usable};

use crate::map::lattice::Chance;
use spunlaid_ground::Known;

/// What is given of the fabric and of its tests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FabricKeys {
    /// Thickness of the finished fabric [m]; without it no air permeability is reported.
    pub thickness: Option<f64>,
    /// Width in the middle of the web that is sold [m]; all of it between the edges if it is not given.
    pub saleable_width: Option<f64>,
    /// How far the weight may be from that of the middle, as a share, to be sold.
    pub tolerance: f64,
    /// Strips that are pulled, and the sections of which the lightest is looked for.
    pub strip: StripSize,
    /// Pressure that drives air through the fabric [Pa].
    pub pressure: f64,
    /// Opacity that was measured of a fabric of the same filaments, and its basis weight if that was another
    /// one [kg/m²].
    pub measured_opacity: Option<f64>,
    /// See `measured_opacity`.
    pub opacity_weight: Option<f64>,
}

impl FabricKeys {
    /// What is usual: strips as in ISO 9073-3, and the pressure of ISO 9073-15.
    pub const USUAL: Self = Self {
        thickness: None,
        saleable_width: None,
        tolerance: 0.05,
        strip: StripSize { width: 50e-3, length: 200e-3, section: 5e-3 },
        pressure: 200.0,
        measured_opacity: None,
        opacity_weight: None,
    };
}

/// Words that are no keys, and what there is for them.
const WORDS: &[(&[&str], &str)] = &[
    (
        &["formation", "cloudiness", "evenness", "uniformity"],
        "Formation and cloudiness are results, not keys: `spunlaid web` gives the CV over patches, the \
        cloudiness and the formation number, 1 for straight fibres at random (docs/fabric.md).",
    ),
    (
        &["pinhole", "pin hole", "hole", "pore", "bare", "hydrohead", "hydrostatic head"],
        "Holes and hydrohead are not given, because bonds and the calender make them: `spunlaid web` \
        gives the bare area and thin spots (docs/fabric.md).",
    ),
    (
        &["thin spot", "thin place", "thick place", "thick spot"],
        "Thin and thick spots are results, not keys: `spunlaid web` gives the patches per square metre \
        that are lighter than 50, 70 and 80 % or heavier than 130 % of the mean (docs/fabric.md).",
    ),
    (
        &["strength", "tensile", "tenacity", "elongation", "tear"],
        "The strength of the fabric is not computed, because the bonds make it. `spunlaid web` gives the weakest \
        section of strips and the MD/CD ratio of stiffness of the directions alone (docs/fabric.md).",
    ),
    (
        &["permeability", "porosity", "breathability"],
        "The air permeability is a range that needs the thickness of the fabric (fabric.thickness); trust \
        the ratio of two webs, not the number (docs/fabric.md).",
    ),
    (
        &["bond", "bonding", "calender", "calendering", "thermal bonding"],
        "Bonds and calender are not modelled: the web ends on the belt. Strength, softness and holes, \
        which they cause, are not computed.",
    ),
    (
        &["softness", "drape", "handle", "hand feel", "linting", "abrasion", "shrinkage"],
        "This is not computed: in a fabric it depends on bonds, finish and polymer, which are not modelled.",
    ),
];

/// What there is for a word of those who make or buy fabric that is no key; None for any other word.
pub fn about(word: &str) -> Option<&'static str> {
    let word = word.trim().to_lowercase().replace('-', " ");
    let singular = word.strip_suffix('s').unwrap_or(&word);
    let is_named = |words: &&[&str]| words.iter().any(|one| *one == word || *one == singular);
    WORDS.iter().find(|(words, _)| is_named(words)).map(|(_, sentence)| *sentence)
}

/// How far the numbers of a map may be from those of all such webs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapUncertainty {
    /// What is known of the chance in the map.
    pub chance: Chance,
    /// How far its deviations are from those of the web; None if it is not known.
    pub deviations: Option<Deviations>,
}

/// The shares by which the deviations of the weight of a map from its mean may have to be larger.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviations {
    /// The error of the CV.
    pub by_chance: f64,
    /// The reported CV over that of the map, less one.
    pub of_map: f64,
}

impl Deviations {
    /// A number with its sampling error, which is at least that of the deviations, and what the map is off; without an
    /// error where it is not known how far that is.
    ///
    /// * `number` – with the error that it has by itself
    /// * `change` – of the number with deviations that are larger by a share
    pub(super) fn add(of: Option<Self>, number: Known, change: impl Fn(f64) -> f64) -> Known {
        let Known::Value(value, error) = number else { return number };
        let whole = |of: Self| {
            let least = change(of.by_chance).abs();
            let is_known = error.is_some() || least > 0.0;
            is_known.then(|| error.unwrap_or(0.0).max(least).hypot(change(of.of_map)))
        };
        Known::Value(value, of.and_then(whole))
    }
}

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
    pub(crate) fn middle(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.corner[axis] + 0.5 * self.sides[axis])
    }
}
