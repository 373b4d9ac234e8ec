//! The fabric in the words of those who buy it: how even it looks, where it is thin, where it has holes, what
//! it lets through.
//!
//! Everything follows from the map of the basis weight, from the curves of the fibres in windows of the
//! sheet, and from a few given numbers. Bonds and finishes of the fabric are not known here.
//!
//! ```text
//! map ─────────────→ formation, thin places, strips ┐
//! directions ──────→ ratio of stiffness             │
//! map and windows ─→ bare area, holes, hydrohead    ├→ Fabric
//! thickness ───────→ air permeability               │
//! measured opacity → opacity, place by place        ┘
//! ```

mod air_through;
mod directions;
mod formation;
mod given;
mod holes;
mod known;
mod light;
mod marked;
mod marks;
mod patches;
mod scanned;
mod streaks;
mod strips;
mod tell;
#[cfg(test)]
mod tests;
mod usable;
mod water;
mod words;

pub use air_through::{Filaments, air_permeability, air_speed, davies, jackson_james, solid_fraction};
pub use directions::stiffness_ratio;
pub use formation::formation;
pub use given::FabricKeys;
pub use holes::{
    Disc, FabricHoles, HolesOfRadius, LEAST_RADIUS, LocalLength, Piece, RADII, WindowHoles, carry,
    count_holes, expected_holes,
};
pub use known::Known;
pub use light::{opacity, scattering};
pub use marked::Marked;
pub use marks::Marks;
pub(crate) use patches::NONE_FOUND;
pub use patches::{HEAVIER, LIGHTER, QUANTILES, ThinPlaces, thin_places};
pub use scanned::of_scan;
pub use streaks::{Streak, StreakSource, streaks};
pub use strips::{StripPlace, StripSize, Strips, WEAK, strips};
pub(crate) use tell::{ABOUT, PATCHES};
pub use tell::{AirThrough, Fabric, FabricPatch, Laid, Opacity, tell};
pub use usable::{Usable, usable};
pub use water::hydrohead;
pub use words::about;
