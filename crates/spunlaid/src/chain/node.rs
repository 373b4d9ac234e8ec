//! The constants of a node of eight fibres.

use crate::lanes::Lanes;

/// The constants of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Node {
    pub(crate) mass: Lanes,
    /// 0 if the node is held.
    pub(crate) inverse_mass: Lanes,
    /// Likewise along x; 0 also if the node slides on the belt.
    pub(crate) inverse_mass_x: Lanes,
    pub(crate) weight: Lanes,
}
