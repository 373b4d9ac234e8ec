//! A curtain of filaments that hang in shared turbulence, of which a few were simulated and all others follow from
//! these.
//!
//! ```text
//! simulated curves → covariance over the distance of inlets → filling: the curve of any place → drawing on a canvas
//!                                                             └ library on a lattice → tiles: a sheet of any size ┘
//! ```
//!
//! Neighbours in one air come down almost alike, so the curve between them is known. Curves are deviations
//! from the straight trace of a filament that comes down at one place, at equal fed lengths.

mod covariance;
pub mod drawing;
mod filling;
mod flown_curves;
mod library;
#[cfg(test)]
mod synthetic;
mod tiles;

pub use drawing::lay_with;
pub use drawing::{Belt, lay};
pub use filling::Covariances;
pub use filling::Filling;
pub use flown_curves::FlownCurves;
pub use library::Library;

use spunlaid_ground::place::Inlet;

/// All filaments of a curtain, whose curves are given block by block.
pub trait Curtain: Sync {
    /// Where the filaments are fed.
    fn places(&self) -> &[Inlet];

    /// Number of points of each curve.
    fn points(&self) -> usize;

    /// Length of fibre from point to point [m].
    fn spacing(&self) -> f64;

    /// Speed of the belt over speed of the feed.
    fn belt_ratio(&self) -> f64;

    /// Gives deviations from the straight trace [m], as many as there is room for.
    ///
    /// * `first` – number of the first point, so that all of them are on the curve
    /// * `md`, `cd` – in machine and in cross direction, of equal length
    fn curve(&self, filament: usize, first: usize, into: [&mut [f32]; 2]);

    /// The smallest and the largest deviation in machine direction, each counted from the middle of the slot [m].
    fn reach(&self) -> [f64; 2];

    /// No deviation in machine direction is larger than this [m].
    fn farthest(&self) -> f64;
}
