//! What neighbours do to each other: the force between nodes of different filaments that are near each other,
//! which the sheets, a mean over the width, do not know.
//!
//! ```text
//! nodes and their ways in a block → cells of the height and the plane → pairs of nodes within the reach
//!       → the mean force during the block, equal and opposite for the two nodes of a pair
//! ```
//!
//! A node is a part of a thread that reaches an element up and down. Within the reach the force is `1/r − r/r_c²`;
//! what this is in the mean over the width is taken off the sheets.                theory.md (83m) to (83p)

mod cells;
mod pairs;
#[cfg(test)]
mod tests;

use crate::lanes::Isa;
use crate::threads::each;
use cells::Cells;
use std::f64::consts::PI;

/// A node of a charged filament while a force is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MovingNode {
    /// Number of its filament.
    pub(crate) filament: usize,
    /// Place in the middle of the time [m]: below the inlet, in machine and in cross direction.
    pub(crate) at: [f64; 3],
    /// Half of its way in machine and in cross direction during this time [m].
    pub(crate) half_way: [f64; 2],
}

/// The forces between neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Repulsion {
    /// Charge of a node [C].
    pub(crate) charge: f64,
    /// Distance `r_c` in the horizontal plane beyond which there is no force [m].
    pub(crate) reach: f64,
    /// How far a node reaches up and down as a part of a thread, a whole number of elements [m].
    pub(crate) height: f64,
    /// Distance within which the force grows no more, the diameter of the filaments [m].
    pub(crate) least: f64,
    /// Distance from inlet to belt; there are no forces outside [m].
    pub(crate) distance: f64,
    /// Width after which the filaments repeat themselves, if they do [m].
    pub(crate) width: Option<f64>,
}

impl Repulsion {
    /// The mean forces on all nodes while they go their ways [N], in machine and in cross direction. They do not
    /// depend on the instruction set or the number of threads.
    pub(crate) fn forces(&self, nodes: &[MovingNode], (isa, threads): (Isa, usize)) -> Vec<[f64; 2]> {
        let mut forces = vec![[0.0; 2]; nodes.len()];
        let cells = Cells::new(self, nodes);
        let found = each(threads, cells.heights(), |height| self.forces_at(&cells, height, isa));
        for (number, force) in cells.numbers().iter().zip(found.into_iter().flatten()) {
            forces[*number] = force;
        }
        forces
    }

    /// The part of the field of a sheet, at a distance from it along the machine direction, which is in the
    /// forces of its filaments as neighbours, from 0 to 1.                                  theory.md (83o)
    pub(super) fn share_of_sheet(reach: f64, distance: f64) -> f64 {
        let half_chord = (reach * reach - distance * distance).max(0.0).sqrt();
        let mean = libm::atan2(half_chord, distance) - half_chord * distance / (reach * reach);
        2.0 / PI * mean
    }
}
