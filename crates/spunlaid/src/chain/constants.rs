//! The constants of eight fibres that a step needs.
//!
//! What belongs to an element or to a node is held along the chain, so that mass, length, diameter and
//! stiffness may vary along a fibre. Fibres whose elements are all alike hold it once.

use super::friction::Friction;
use super::node::Node;
use super::{Common, Strand};
use crate::company::PerLane;
use crate::drag::{DragLanes, ElementDrag};
use crate::fibre::Root;
use crate::lanes::Lanes;
use crate::nodes::ChainValues;
use crate::vec3::Vec3;

/// Properties of one element of a fibre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ElementProperties {
    /// Rest length [m].
    pub(crate) rest_length: f64,
    /// Mass [kg], half of which belongs to each of its nodes.
    pub(crate) mass: f64,
    /// Axial stiffness `EA/l` [N/m].
    pub(crate) axial_stiffness: f64,
    /// Rotational stiffness `EI/l` [N·m].
    pub(crate) rotational_stiffness: f64,
    /// Drag of the air.
    pub(crate) drag: ElementDrag,
}

/// The constants of eight fibres that a step needs.
#[derive(Clone, Debug)]
pub(crate) struct Constants {
    /// Of each element.
    pub(crate) elements: ChainValues<ElementConstants>,
    /// The root. It does not move if it is held.
    pub(crate) root: Node,
    /// Of each node as one between two elements.
    pub(crate) nodes: ChainValues<Node>,
    /// The nodes that differ from the others, from the end upwards: the free end, and those on the belt.
    pub(crate) tail: Vec<Node>,
    /// Of each node as one between two elements, theory.md (12).
    pub(crate) bending_stiffness: ChainValues<Lanes>,
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
    /// The constants of up to eight fibres with so many elements.
    pub(crate) fn new(common: &Common, strands: &PerLane<Strand>, elements: usize) -> Self {
        Self::varying(common, strands, elements, Strand::element)
    }

    /// The constants of fibres whose element `j` has the properties `element(strand, j)`.
    pub(crate) fn varying(
        common: &Common,
        strands: &PerLane<Strand>,
        elements: usize,
        element: impl Fn(&Strand, usize) -> ElementProperties,
    ) -> Self {
        let last = elements - 1;
        // The elements above and below a node.
        let around = |s: &Strand, i: usize| (element(s, i.max(1) - 1), element(s, i.min(last)));
        let between = |s: &Strand, i: usize| {
            let (above, below) = around(s, i);
            0.5 * above.mass + 0.5 * below.mass
        };
        let node = |mass: &dyn Fn(&Strand) -> f64, held: &dyn Fn(&Strand) -> bool| {
            let inverse_mass = strands.lanes(|s| if held(s) { 0.0 } else { 1.0 / mass(s) });
            Node {
                mass: strands.lanes(mass),
                inverse_mass,
                inverse_mass_x: inverse_mass,
                weight: strands.lanes(|s| mass(s) * s.gravity),
            }
        };
        // Two half elements, each with the turning of its own stiffness, in series.
        let bending = |s: &Strand, i: usize| {
            let (above, below) = around(s, i);
            let ratio = above.rotational_stiffness / below.rotational_stiffness;
            above.rotational_stiffness / (0.5 * (1.0 + ratio))
        };
        let root_stiffness = |s: &Strand| match s.fibre.root {
            Root::Pinned | Root::Free => 0.0,
            Root::Clamped => 2.0 * element(s, 0).rotational_stiffness,
        };
        let constants = |j: usize| ElementConstants {
            rest_length: strands.lanes(|s| element(s, j).rest_length),
            mass: strands.lanes(|s| element(s, j).mass),
            inverse_mass: strands.lanes(|s| 1.0 / element(s, j).mass),
            axial_stiffness: strands.lanes(|s| element(s, j).axial_stiffness),
            compliance: strands.lanes(|s| 1.0 / element(s, j).axial_stiffness),
            half_drag: DragLanes::pack(common.drag_curves, &strands.each(|s| element(s, j).drag.half())),
        };
        let direction =
            |component: &dyn Fn(Vec3<f64>) -> f64| strands.lanes(|s| component(s.fibre.direction));
        Self {
            elements: ChainValues::new(elements, constants),
            root: node(&|s| 0.5 * element(s, 0).mass, &|s| s.fibre.root != Root::Free),
            nodes: ChainValues::new(elements + 1, |i| node(&|s| between(s, i), &|_| false)),
            tail: vec![node(&|s| 0.5 * element(s, last).mass, &|_| false)],
            bending_stiffness: ChainValues::new(elements + 1, |i| strands.lanes(|s| bending(s, i))),
            root_stiffness: strands.lanes(root_stiffness),
            second_stiffness: strands.lanes(|s| bending(s, 1)),
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
            self.nodes.at(i)
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
            _ => self.bending_stiffness.at(i),
        }
    }

    /// Whether node `i` of `nodes` is one that the feed or the belt may hold.
    #[inline(always)]
    pub(crate) fn may_be_held(&self, i: usize, nodes: usize) -> bool {
        i == 0 || i + self.tail.len() >= nodes
    }

    /// Distance of node `i` from the root along the fibre at rest [m].
    pub(crate) fn distance(&self, i: usize) -> Lanes {
        if self.elements.is_uniform() {
            return self.elements.at(0).rest_length * Lanes::splat(i as f64);
        }
        (0..i).fold(Lanes::ZERO, |sum, j| sum + self.elements.at(j).rest_length)
    }

    /// An element is born at the root, like the one below it.
    pub(crate) fn push_root(&mut self) {
        self.elements.push_root();
        self.nodes.push_root();
        self.bending_stiffness.push_root();
    }

    /// Keeps so many nodes from the root on. `former` is their number so far.
    pub(crate) fn truncate(&mut self, nodes: usize, former: usize) {
        self.tail.drain(..former - nodes);
        self.elements.truncate(nodes - 1);
        self.nodes.truncate(nodes);
        self.bending_stiffness.truncate(nodes);
    }
}
