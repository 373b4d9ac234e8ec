//! The constants of eight fibres that a step needs. The elements of a fibre are all alike.

use super::{ChainInvariants, FibreParameters};
use crate::body::Root;
use crate::drag::DragLanes;
use crate::line::Contact;
use spunlaid_ground::{Lanes, PerLane, Vec3, WIDTH};

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
    pub(crate) fn new(common: &ChainInvariants, strands: &PerLane<FibreParameters>) -> Self {
        let node = |share: f64, held: &dyn Fn(&FibreParameters) -> bool| {
            let mass = |s: &FibreParameters| share * s.fibre.element_mass();
            let inverse_mass = strands.lanes(|s| if held(s) { 0.0 } else { 1.0 / mass(s) });
            Node {
                mass: strands.lanes(mass),
                inverse_mass,
                inverse_mass_x: inverse_mass,
                weight: strands.lanes(|s| mass(s) * s.gravity),
            }
        };
        let root_stiffness = |s: &FibreParameters| match s.fibre.root {
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

/// Friction of eight fibres on their belts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Friction {
    /// Coefficient of friction `μ` [-]. What sticks would have to be pulled with an infinite force.
    coefficient: Lanes,
    /// Force with which the suction presses a node on to the belt [N].
    press: Lanes,
}

impl Friction {
    /// Friction of eight fibres; none if all of them stick.
    ///
    /// * `contact` – of each fibre with its belt
    /// * `diameter`, `rest_length` – of each fibre, and of its elements [m]
    pub(super) fn new(contact: [Contact; WIDTH], diameter: &Lanes, rest_length: &Lanes) -> Option<Self> {
        let numbers = |i: usize| match contact[i] {
            Contact::Stick => (f64::INFINITY, 0.0),
            Contact::Friction { coefficient, suction } => {
                (coefficient, suction * diameter.0[i] * rest_length.0[i])
            }
        };
        let slides = contact.iter().any(|contact| *contact != Contact::Stick);
        slides.then(|| Self {
            coefficient: Lanes::from_fn(|i| numbers(i).0),
            press: Lanes::from_fn(|i| numbers(i).1),
        })
    }

    /// The largest friction on a node [N].
    ///
    /// * `pull` – force of the chain and of gravity on to the belt [N]
    pub(super) fn most(&self, lane: usize, pull: f64) -> f64 {
        self.coefficient.0[lane] * (self.press.0[lane] + pull).max(0.0)
    }

    /// The belt's force on a node that slides [N]; zero in the lanes where it does not. Friction slows the
    /// node down, at most to the belt's velocity within the step.
    ///
    /// * `v`, `belt_speed` – velocities of the node and of the belt [m/s]
    /// * `pull` – force of the chain and of gravity on to the belt [N]
    /// * `h` – the time step [s]
    pub(crate) fn on(
        &self,
        node: &Node,
        v: &Vec3<Lanes>,
        belt_speed: &Lanes,
        pull: &Lanes,
        h: f64,
    ) -> Vec3<Lanes> {
        let mut force = Vec3::ZERO;
        for lane in 0..WIDTH {
            if node.inverse_mass.0[lane] > 0.0 && node.inverse_mass_x.0[lane] == 0.0 {
                let slip = [v.y.0[lane] - belt_speed.0[lane], v.z.0[lane]];
                let speed = libm::hypot(slip[0], slip[1]);
                let stopping = node.mass.0[lane] / h;
                let drag = (self.most(lane, pull.0[lane]) / speed).min(stopping);
                let drag = if speed > 0.0 { drag } else { 0.0 };
                let [y, z] = slip.map(|slip| -drag * slip);
                force.set_lane(lane, Vec3::new(-pull.0[lane], y, z));
            }
        }
        force
    }
}
