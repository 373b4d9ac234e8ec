//! The constants of eight fibres that a step needs. The elements of a fibre are all alike.

use super::friction::Friction;
use super::{Common, Strand};
use crate::company::PerLane;
use crate::drag::DragLanes;
use crate::fibre::Root;
use crate::lanes::Lanes;
use crate::vec3::Vec3;

/// The constants of eight fibres that a step needs.
#[derive(Clone, Debug)]
pub(crate) struct Constants {
    /// Of each element.
    pub(crate) element: ElementConstants,
    /// The root. It does not move if it is held.
    pub(crate) root: Node,
    /// Of a node between two elements.
    pub(crate) between: Node,
    /// The nodes that differ from the others, from the end upwards: the free end, and those on the belt.
    pub(crate) tail: Vec<Node>,
    /// Of a node between two elements, theory.md (12).
    pub(crate) stiffness: Lanes,
    /// Of the root, and of the node below it.
    pub(crate) root_stiffness: Lanes,
    pub(crate) second_stiffness: Lanes,
    pub(crate) root_direction: Vec3<Lanes>,
    /// Time constant of the bending viscosity [s]; none if it is zero in all lanes.
    pub(crate) viscosity: Option<Lanes>,
    pub(crate) damping: Lanes,
    /// Friction on the belt; none if the fibres stick to it.
    pub(crate) friction: Option<Friction>,
    /// Speed of the belt along y, from which energies are seen [m/s]; zero without a belt.
    pub(crate) frame: Lanes,
}

/// The constants of an element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ElementConstants {
    pub(crate) rest_length: Lanes,
    pub(crate) mass: Lanes,
    pub(crate) inverse_mass: Lanes,
    pub(crate) axial_stiffness: Lanes,
    /// The inverse of the axial stiffness.
    pub(crate) compliance: Lanes,
    /// Half of its drag, which is the share of each of its two nodes.
    pub(crate) half_drag: DragLanes,
}

impl Constants {
    /// The constants of up to eight fibres.
    pub(crate) fn new(common: &Common, strands: &PerLane<Strand>) -> Self {
        let node = |share: f64, held: &dyn Fn(&Strand) -> bool| {
            let mass = |s: &Strand| share * s.fibre.element_mass();
            let inverse_mass = strands.lanes(|s| if held(s) { 0.0 } else { 1.0 / mass(s) });
            Node {
                mass: strands.lanes(mass),
                inverse_mass,
                inverse_mass_x: inverse_mass,
                weight: strands.lanes(|s| mass(s) * s.gravity),
            }
        };
        let root_stiffness = |s: &Strand| match s.fibre.root {
            Root::Pinned | Root::Free => 0.0,
            Root::Clamped => 2.0 * s.fibre.rotational_stiffness(),
        };
        let element = ElementConstants {
            rest_length: strands.lanes(|s| s.fibre.rest_length()),
            mass: strands.lanes(|s| s.fibre.element_mass()),
            inverse_mass: strands.lanes(|s| 1.0 / s.fibre.element_mass()),
            axial_stiffness: strands.lanes(|s| s.fibre.axial_stiffness()),
            compliance: strands.lanes(|s| 1.0 / s.fibre.axial_stiffness()),
            half_drag: DragLanes::pack(common.drag_curves, &strands.each(|s| s.drag.half())),
        };
        let direction =
            |component: &dyn Fn(Vec3<f64>) -> f64| strands.lanes(|s| component(s.fibre.direction));
        let stiffness = strands.lanes(|s| s.fibre.rotational_stiffness());
        Self {
            element,
            root: node(0.5, &|s| s.fibre.root != Root::Free),
            between: node(1.0, &|_| false),
            tail: vec![node(0.5, &|_| false)],
            stiffness,
            root_stiffness: strands.lanes(root_stiffness),
            second_stiffness: stiffness,
            root_direction: Vec3::new(direction(&|v| v.x), direction(&|v| v.y), direction(&|v| v.z)),
            viscosity: strands
                .any(|s| s.fibre.bending_viscosity_time != 0.0)
                .then(|| strands.lanes(|s| s.fibre.bending_viscosity_time)),
            damping: strands.lanes(|s| s.damping),
            friction: None,
            frame: Lanes::ZERO,
        }
    }

    /// Node `i` of `nodes`.
    #[inline(always)]
    pub(crate) fn node(&self, i: usize, nodes: usize) -> &Node {
        if i == 0 {
            &self.root
        } else if i + self.tail.len() < nodes {
            &self.between
        } else {
            &self.tail[nodes - 1 - i]
        }
    }

    /// Bending stiffness at node `i` [N·m].
    #[inline(always)]
    pub(crate) fn bending_stiffness(&self, i: usize) -> &Lanes {
        match i {
            0 => &self.root_stiffness,
            1 => &self.second_stiffness,
            _ => &self.stiffness,
        }
    }

    /// Whether node `i` of `nodes` is one that the feed or the belt may hold.
    #[inline(always)]
    pub(crate) fn may_be_held(&self, i: usize, nodes: usize) -> bool {
        i == 0 || i + self.tail.len() >= nodes
    }

    /// Distance of node `i` from the root along the fibre at rest [m].
    pub(crate) fn distance(&self, i: usize) -> Lanes {
        self.element.rest_length * Lanes::splat(i as f64)
    }
}

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
