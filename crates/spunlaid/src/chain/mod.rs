//! The fibre as a chain of beads: state, forces, time integration.

pub(crate) mod explicit;
pub(crate) mod force_pass;
pub(crate) mod forces;
pub(crate) mod implicit;
pub(crate) mod laying;
pub mod schemes;
pub mod work;

use self::laying::{Friction, Laying};
use self::schemes::Scheme;
use crate::company::{PerLane, shared};
use crate::drag::{Curve, DragLanes, ElementDrag};
use crate::fibre::{Fibre, Root};
use crate::lanes::{Lanes, WIDTH};
use crate::line::Line;
use crate::nodes::Nodes;
use crate::vec3::Vec3;

/// One fibre and what acts on it, without the wind: the content of a lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strand {
    /// The fibre.
    pub fibre: Fibre,
    /// Drag of one of its elements.
    pub drag: ElementDrag,
    /// Acceleration of gravity along x [m/s²].
    pub gravity: f64,
    /// Mass-proportional damping [1/s].
    pub damping: f64,
}

shared! {
    /// What the chains of one flight have in common.
    pub(crate) struct Common {
        elements: usize = "the number of elements (fibre.length, fibre.element_length)",
        drag_curves: [Option<Curve>; 2] = "the kind of drag.along or drag.across",
        damped: bool = "whether there is run.damping",
        /// Of a fed fibre.
        steps_per_element: Option<u64> = "how an element is fed (feed.speed, fibre.element_length)",
    }
}

impl Common {
    pub(crate) fn of(strand: &Strand, line: Option<&Line>) -> Self {
        Self {
            elements: strand.fibre.elements,
            drag_curves: strand.drag.curves(),
            damped: strand.damping != 0.0,
            steps_per_element: line.map(|line| line.steps_per_element),
        }
    }
}

/// Eight fibres with equal numbers of elements, advanced side by side.
///
/// Shapes: `N+1` nodes, `N` elements.
#[derive(Clone, Debug)]
pub struct Chain {
    /// Positions of the nodes [m].
    pub position: Nodes<Vec3<Lanes>>,
    /// Velocities of the nodes [m/s]. Semi-implicit Euler has them at the time of the positions, the other
    /// schemes half a step earlier.
    pub velocity: Nodes<Vec3<Lanes>>,
    /// The velocities one step before [`Chain::velocity`]; the staggered schemes extrapolate from both.
    pub(crate) earlier: Nodes<Vec3<Lanes>>,
    /// Constants of the eight fibres.
    pub(crate) constants: Constants,
    /// What only the scheme with implicit tension needs.
    pub(crate) tensions: implicit::Tensions,
    /// How it is fed and laid down; none for a fibre of fixed length.
    pub(crate) laying: Option<Laying>,
}

/// The constants of eight fibres that a step needs.
#[derive(Clone, Debug)]
pub(crate) struct Constants {
    /// The root. It does not move if it is held.
    pub(crate) root: Node,
    /// A node between two elements.
    pub(crate) node: Node,
    /// The nodes that differ from the others, from the end upwards: the free end, and those on the belt.
    pub(crate) tail: Vec<Node>,
    pub(crate) rest_length: Lanes,
    pub(crate) axial_stiffness: Lanes,
    pub(crate) bending_stiffness: Lanes,
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
    /// Half an element's drag, which is the share of each of its two nodes.
    pub(crate) half_drag: DragLanes,
}

/// The constants of a node that a step needs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) mass: Lanes,
    /// 0 if the node is held.
    pub(crate) inverse_mass: Lanes,
    /// Likewise along x; 0 also if the node slides on the belt.
    pub(crate) inverse_mass_x: Lanes,
    pub(crate) weight: Lanes,
}

impl Constants {
    /// The constants of up to eight fibres.
    fn of(common: &Common, strands: &PerLane<Strand>) -> Self {
        let lanes = |value: &dyn Fn(&Strand) -> f64| strands.lanes(value);
        let direction = Vec3::new(
            lanes(&|s| s.fibre.direction.x),
            lanes(&|s| s.fibre.direction.y),
            lanes(&|s| s.fibre.direction.z),
        );
        let node = |i: usize, held: &dyn Fn(&Strand) -> bool| {
            let inverse_mass = lanes(&|s| if held(s) { 0.0 } else { 1.0 / s.fibre.node_mass(i) });
            Node {
                mass: lanes(&|s| s.fibre.node_mass(i)),
                inverse_mass,
                inverse_mass_x: inverse_mass,
                weight: lanes(&|s| s.fibre.node_mass(i) * s.gravity),
            }
        };
        Self {
            root: node(0, &|s| s.fibre.root != Root::Free),
            // A chain of one element has no such node and does not use this.
            node: node(1, &|_| false),
            tail: vec![node(common.elements, &|_| false)],
            rest_length: lanes(&|s| s.fibre.rest_length()),
            axial_stiffness: lanes(&|s| s.fibre.axial_stiffness()),
            bending_stiffness: lanes(&|s| s.fibre.rotational_stiffness()),
            root_stiffness: lanes(&|s| s.fibre.root_stiffness()),
            second_stiffness: lanes(&|s| s.fibre.rotational_stiffness()),
            root_direction: direction,
            viscosity: strands
                .any(|s| s.fibre.bending_viscosity_time != 0.0)
                .then(|| lanes(&|s| s.fibre.bending_viscosity_time)),
            damping: lanes(&|s| s.damping),
            friction: None,
            frame: Lanes::ZERO,
            half_drag: DragLanes::pack(common.drag_curves, &strands.each(|s| s.drag.half())),
        }
    }

    /// Node `i` of `nodes`.
    #[inline(always)]
    pub(crate) fn node(&self, i: usize, nodes: usize) -> &Node {
        if i == 0 {
            &self.root
        } else if i + self.tail.len() < nodes {
            &self.node
        } else {
            &self.tail[nodes - 1 - i]
        }
    }

    /// Whether node `i` of `nodes` is one that the feed or the belt may hold.
    #[inline(always)]
    pub(crate) fn may_be_held(&self, i: usize, nodes: usize) -> bool {
        i == 0 || i + self.tail.len() >= nodes
    }
}

impl Chain {
    /// Packs up to eight fibres, straight and at rest, with their roots at the origin.
    pub(crate) fn straight(common: &Common, strands: &PerLane<Strand>, scheme: Scheme) -> Self {
        let elements = common.elements;
        let constants = Constants::of(common, strands);
        let (direction, rest_length) = (constants.root_direction, constants.rest_length);
        let position = (0..=elements).map(|i| direction * (rest_length * Lanes::splat(i as f64))).collect();
        Self {
            position,
            velocity: vec![Vec3::ZERO; elements + 1].into(),
            earlier: vec![Vec3::ZERO; elements + 1].into(),
            tensions: implicit::Tensions::new(if scheme == Scheme::ImplicitTension { elements } else { 0 }),
            laying: None,
            constants,
        }
    }

    /// Replaces the fibres by others with the same number of elements. Positions and velocities stay; tensions
    /// change in proportion to the axial stiffness.
    pub(crate) fn become_of(&mut self, common: &Common, strands: &PerLane<Strand>) {
        let former = std::mem::replace(&mut self.constants, Constants::of(common, strands));
        self.keep_held(&former);
        let (before, after) = (former.axial_stiffness, self.constants.axial_stiffness);
        for tension in self.tensions.tension.iter_mut() {
            *tension = Lanes::from_fn(|i| tension.0[i] * (after.0[i] / before.0[i]));
        }
    }

    /// Sets the tension of the implicit scheme from the stretch of each element.
    pub(crate) fn settle_tensions(&mut self) {
        let stretched: Vec<Lanes> = self.tension_of_stretch().collect();
        for (tension, stretched) in self.tensions.tension.iter_mut().zip(stretched) {
            *tension = stretched;
        }
    }

    /// Tension of each element [N], negative in compression. Implicit tension gives the tension that the scheme
    /// has solved for, the explicit schemes give the tension of the stretch.
    pub fn tension(&self) -> Vec<Lanes> {
        let solved = &self.tensions.tension;
        if solved.is_empty() { self.tension_of_stretch().collect() } else { solved.to_vec() }
    }

    fn tension_of_stretch(&self) -> impl Iterator<Item = Lanes> {
        let c = &self.constants;
        self.position.windows(2).map(|pair| {
            Lanes::from_fn(|i| {
                let length = (pair[1].lane(i) - pair[0].lane(i)).norm();
                c.axial_stiffness.0[i] * (length - c.rest_length.0[i])
            })
        })
    }

    /// Number of elements that have been fed so far.
    pub(crate) fn fed(&self) -> u64 {
        self.laying.as_ref().map_or(0, Laying::fed)
    }

    /// Number of nodes of the fibre in each lane. Nodes after them have been laid down.
    pub(crate) fn nodes(&self) -> [usize; WIDTH] {
        let all = self.position.len();
        std::array::from_fn(|lane| self.laying.as_ref().map_or(all, |laying| laying.nodes(lane).min(all)))
    }

    /// Number of nodes between the root and the newest touch-down in each lane; all nodes without a belt.
    pub(crate) fn in_air(&self) -> [usize; WIDTH] {
        let all = self.position.len();
        std::array::from_fn(|lane| {
            self.laying.as_ref().map_or(all, |laying| (laying.in_air(lane) as usize).min(all))
        })
    }

    /// Whether a node is held in a lane.
    pub(crate) fn is_held(&self, node: usize, lane: usize) -> bool {
        self.constants.node(node, self.position.len()).inverse_mass.0[lane] == 0.0
    }

    /// Where the nodes began [m]: at the start, or where they were fed.
    pub(crate) fn origin<'a>(&'a self, start: &'a [Vec3<Lanes>]) -> &'a [Vec3<Lanes>] {
        self.laying.as_ref().map_or(start, |laying| &laying.origin)
    }

    /// Number of elements `N`.
    pub fn elements(&self) -> usize {
        self.position.len() - 1
    }
}
