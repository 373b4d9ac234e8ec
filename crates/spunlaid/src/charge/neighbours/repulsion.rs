//! Nodes that drive each other apart, and how far and how much they do.

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
    /// The part of the field of a sheet, at a distance from it along the machine direction, which is in the
    /// forces of its filaments as neighbours, from 0 to 1.                                  theory.md (83o)
    pub(in crate::charge) fn share_of_sheet(reach: f64, distance: f64) -> f64 {
        let half_chord = (reach * reach - distance * distance).max(0.0).sqrt();
        let mean = libm::atan2(half_chord, distance) - half_chord * distance / (reach * reach);
        2.0 / PI * mean
    }
}
