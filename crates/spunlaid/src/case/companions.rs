//! Fibres beside each replicate, in the same air.

use super::Case;
use crate::error::Fault;
use crate::fibre::Place;
use crate::lanes::WIDTH;

/// The distances of companions that fly with each replicate in the same air.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Companions {
    /// Distances in cross direction, rising [m].
    pub cd: Vec<f64>,
    /// Distances in machine direction, rising [m].
    pub md: Vec<f64>,
}

impl Companions {
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.cd.is_empty() && self.md.is_empty()
    }

    /// Where the companions' roots are: those in cross direction, then those in machine direction.
    pub fn places(&self) -> impl Iterator<Item = Place> {
        let cd = self.cd.iter().map(|z| Place { y: 0.0, z: *z });
        cd.chain(self.md.iter().map(|y| Place { y: *y, z: 0.0 }))
    }
}

impl Case {
    /// Number of fibres that fly in a run: the replicates, and their companions. Where the companions of a
    /// replicate take several flights, it flies in each.
    pub fn fibres(&self) -> u64 {
        let companions = self.companions.places().count();
        self.run.replicates * (companions + companions.div_ceil(WIDTH - 1).max(1)) as u64
    }

    /// Number of replicates that share a flight at most.
    pub(super) fn replicates_of_a_flight(&self) -> u64 {
        if self.companions.is_empty() { self.run.replicates.min(WIDTH as u64) } else { 1 }
    }

    /// Number of flights of a run.
    pub fn flights(&self) -> u64 {
        match self.companions.places().count().div_ceil(WIDTH - 1) as u64 {
            0 => self.run.replicates.div_ceil(WIDTH as u64),
            each => self.run.replicates * each,
        }
    }
}

/// The fault of companions in air that they would not share.
pub(super) fn without_shared_air() -> Fault {
    let remedy = "each fibre has turbulence of its own then, so that neighbours have nothing in common; \
        leave it out, or let the turbulence differ across the flow";
    Fault::needs("air.lateral = \"von-karman\"", remedy)
}
