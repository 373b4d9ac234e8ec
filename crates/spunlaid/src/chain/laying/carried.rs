//! Energies that fed fibre brings and laid fibre takes along.

use crate::chain::Chain;
use crate::lanes::Lanes;

/// `arcsin² x` in `x²`, below [`ALMOST_STRAIGHT`] to 1e-17 of it.
const ARCSINE_SQUARED: [f64; 5] = [1.0, 1.0 / 3.0, 8.0 / 45.0, 4.0 / 35.0, 128.0 / 1575.0];
/// Square of the sine of an angle up to which the series holds.
const ALMOST_STRAIGHT: f64 = 1e-3;

/// Energy carried into the chain by fed fibre, minus what laid fibre carried out of it [J].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CarriedEnergy {
    pub(crate) kinetic: Lanes,
    pub(crate) axial: Lanes,
    pub(crate) bending: Lanes,
    /// Work of gravity on nodes that have left.
    pub(crate) gravity_work: Lanes,
    /// Work of the belt at the touch-downs.
    pub(crate) impacts: Lanes,
}

impl Chain {
    /// Energy of the element below a node, and of the bending at the node [J].
    pub(super) fn element_energy(&self, node: usize, lane: usize) -> (f64, f64) {
        let c = &self.constants;
        let Some(below) = self.position.get(node + 1) else { return (0.0, 0.0) };
        let edge = below.lane(lane) - self.position[node].lane(lane);
        let element = &c.element;
        let stretch = edge.norm() - element.rest_length.0[lane];
        let stiffness = c.stiffness.0[lane];
        let bending = if node == 0 { 0.0 } else { stiffness * self.bend_squared_in(node, lane) };
        (0.5 * element.axial_stiffness.0[lane] * stretch * stretch, 0.5 * bending)
    }

    /// Twice the bending energy at a node with springs of this stiffness [J].
    pub(super) fn bent(&self, node: usize, stiffness: Lanes) -> Lanes {
        let bends = node + 1 < self.position.len();
        let energy = |lane: usize, stiffness: f64| {
            if bends && stiffness != 0.0 { stiffness * self.bend_squared_in(node, lane) } else { 0.0 }
        };
        Lanes::from_fn(|lane| energy(lane, stiffness.0[lane]))
    }

    /// Square of the angle at a node.
    fn bend_squared_in(&self, node: usize, lane: usize) -> f64 {
        let at = |i: usize| self.position[i].lane(lane);
        let above =
            if node == 0 { self.constants.root_direction.lane(lane) } else { at(node) - at(node - 1) };
        let below = at(node + 1) - at(node);
        let (cross, dot) = (above.cross(below), above.dot(below));
        let sine_squared = cross.dot(cross) / (above.dot(above) * below.dot(below));
        if dot > 0.0 && sine_squared < ALMOST_STRAIGHT {
            return ARCSINE_SQUARED.iter().rev().fold(0.0, |sum, c| (sum + c) * sine_squared);
        }
        let angle = libm::atan2(cross.norm(), dot);
        angle * angle
    }
}
