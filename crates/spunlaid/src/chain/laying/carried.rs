//! Energies that fed fibre brings and laid fibre takes along.

use crate::chain::Chain;
use crate::lanes::Lanes;

/// Energy carried into the chain by fed fibre, minus what laid fibre carried out of it [J].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Carried {
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
    pub(super) fn held_by(&self, node: usize, lane: usize) -> (f64, f64) {
        let c = &self.constants;
        let Some(below) = self.position.get(node + 1) else { return (0.0, 0.0) };
        let edge = below.lane(lane) - self.position[node].lane(lane);
        let stretch = edge.norm() - c.rest_length.0[lane];
        let bending =
            if node == 0 { 0.0 } else { c.bending_stiffness.0[lane] * self.bend_squared_in(node, lane) };
        (0.5 * c.axial_stiffness.0[lane] * stretch * stretch, 0.5 * bending)
    }

    /// Square of the angle at a node.
    pub(super) fn bend_squared(&self, node: usize) -> Lanes {
        Lanes::from_fn(|lane| self.bend_squared_in(node, lane))
    }

    pub(super) fn bend_squared_in(&self, node: usize, lane: usize) -> f64 {
        let at = |i: usize| self.position[i].lane(lane);
        let above =
            if node == 0 { self.constants.root_direction.lane(lane) } else { at(node) - at(node - 1) };
        let below = at(node + 1) - at(node);
        let angle = libm::atan2(above.cross(below).norm(), above.dot(below));
        angle * angle
    }
}
