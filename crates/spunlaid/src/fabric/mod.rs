//! The fabric in the words of those who buy it: how even it looks, where it is thin, what it lets through.
//!
//! Everything follows from the map of the basis weight, from the directions of the fibres, and from a few
//! given numbers. Bonds and finishes of the fabric are not known here.
//!
//! ```text
//! map ─────────────────→ formation, thin places, strips, bare area ┐
//! directions ──────────→ ratio of stiffness                        ├→ Fabric
//! map, thickness ──────→ air permeability                          │
//! map, measured opacity → opacity                                  ┘
//! ```

mod air_through;
mod bare;
mod known;
mod light;
mod marks;
mod patches;
mod scanned;
mod streaks;
mod strips;
mod tell;
#[cfg(test)]
mod tests;
mod usable;
mod words;

pub use air_through::{Filaments, air_permeability, air_speed, davies, jackson_james, solid_fraction};
pub use bare::{bare_area, formation, local_weights};
pub use known::Known;
pub use light::{opacity, scattering};
pub use marks::{Marked, Marks};
pub(crate) use patches::NONE_FOUND;
pub use patches::{HEAVIER, LIGHTER, QUANTILES, ThinPlaces, thin_places};
pub use scanned::of_scan;
pub use streaks::{Streak, StreakSource, streaks};
pub use strips::{StripPlace, StripSize, Strips, WEAK, strips};
pub(crate) use tell::{ABOUT, PATCHES};
pub use tell::{AirThrough, Fabric, FabricPatch, Laid, Opacity, tell};
pub use usable::{Usable, usable};
pub use words::about;

/// What is given of the fabric and of its tests.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FabricKeys {
    /// Thickness of the finished fabric [m]; without it no air permeability is told.
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
