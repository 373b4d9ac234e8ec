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
mod formation;
mod given;
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
mod words;

pub use air_through::{Filaments, air_permeability, air_speed, davies, jackson_james, solid_fraction};
pub use bare::{bare_area, local_weights};
pub use formation::formation;
pub use given::FabricKeys;
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
pub use words::about;
