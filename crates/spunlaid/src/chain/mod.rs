//! The fibre as a chain of beads: state, forces, time integration.

pub(crate) mod explicit;
pub(crate) mod force_pass;
pub(crate) mod forces;
pub(crate) mod implicit;
pub mod ledger;
pub mod schemes;

use self::schemes::Scheme;
use crate::drag::{DragLanes, ElementDrag};
use crate::fibre::{Fibre, Root};
use crate::lanes::{Lanes, WIDTH};
use crate::vec3::Vec3;

/// One fibre and what acts on it, apart from the wind: what a lane is filled with.
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

/// Eight fibres of as many elements each, advanced side by side.
///
/// Shapes: `N+1` nodes, `N` elements.
#[derive(Clone, Debug)]
pub struct Chain {
    /// Positions of the nodes [m].
    pub position: Vec<Vec3<Lanes>>,
    /// Velocities of the nodes [m/s]: at the time of the positions for semi-implicit Euler, half a step
    /// earlier for the others.
    pub velocity: Vec<Vec3<Lanes>>,
    /// Where velocities are staggered: those one step before [`Chain::velocity`], for the drag to extrapolate.
    pub(crate) earlier: Vec<Vec3<Lanes>>,
    /// Constants of the eight fibres.
    pub(crate) constants: Constants,
    /// Implicit tension: what that scheme keeps besides.
    pub(crate) tensions: implicit::Tensions,
}

/// What a step needs to know of eight fibres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Constants {
    /// The root, which does not move where it is held.
    pub(crate) root: Node,
    /// A node between two elements.
    pub(crate) node: Node,
    /// The free end.
    pub(crate) end: Node,
    pub(crate) rest_length: Lanes,
    pub(crate) axial_stiffness: Lanes,
    pub(crate) bending_stiffness: Lanes,
    pub(crate) root_stiffness: Lanes,
    pub(crate) root_direction: Vec3<Lanes>,
    pub(crate) damping: Lanes,
    /// Half an element's drag: the share of each of its nodes.
    pub(crate) half_drag: DragLanes,
}

/// What a step needs to know of a node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) mass: Lanes,
    /// 0 where the node is held.
    pub(crate) inverse_mass: Lanes,
    pub(crate) weight: Lanes,
}

impl Constants {
    /// Of up to eight fibres; lanes left over repeat the first.
    fn of(strands: &[Strand]) -> Self {
        let pick = |i: usize| strands[if i < strands.len() { i } else { 0 }];
        let lanes = |value: &dyn Fn(&Strand) -> f64| Lanes::from_fn(|i| value(&pick(i)));
        let elements = strands[0].fibre.elements;
        let direction = Vec3::new(
            lanes(&|s| s.fibre.direction.x),
            lanes(&|s| s.fibre.direction.y),
            lanes(&|s| s.fibre.direction.z),
        );
        let node = |i: usize, held: &dyn Fn(&Strand) -> bool| Node {
            mass: lanes(&|s| s.fibre.node_mass(i)),
            inverse_mass: lanes(&|s| if held(s) { 0.0 } else { 1.0 / s.fibre.node_mass(i) }),
            weight: lanes(&|s| s.fibre.node_mass(i) * s.gravity),
        };
        Self {
            root: node(0, &|s| s.fibre.root != Root::Free),
            // A chain of one element has no such node; then this is not used.
            node: node(1, &|_| false),
            end: node(elements, &|_| false),
            rest_length: lanes(&|s| s.fibre.rest_length()),
            axial_stiffness: lanes(&|s| s.fibre.axial_stiffness()),
            bending_stiffness: lanes(&|s| s.fibre.rotational_stiffness()),
            root_stiffness: lanes(&|s| s.fibre.root_stiffness()),
            root_direction: direction,
            damping: lanes(&|s| s.damping),
            half_drag: DragLanes::pack(&std::array::from_fn::<_, WIDTH, _>(|i| pick(i).drag.half())),
        }
    }

    /// Node `i` of `nodes`.
    #[inline(always)]
    pub(crate) fn node(&self, i: usize, nodes: usize) -> &Node {
        if i == 0 {
            &self.root
        } else if i + 1 == nodes {
            &self.end
        } else {
            &self.node
        }
    }
}

impl Chain {
    /// Packs up to eight fibres, straight and at rest, their roots at the origin.
    ///
    /// Lanes left over repeat the first fibre. All must have the same number of elements as the first.
    pub(crate) fn straight(strands: &[Strand], scheme: Scheme) -> Self {
        let elements = strands[0].fibre.elements;
        let constants = Constants::of(strands);
        let (direction, rest_length) = (constants.root_direction, constants.rest_length);
        let position = (0..=elements).map(|i| direction * (rest_length * Lanes::splat(i as f64))).collect();
        Self {
            position,
            velocity: vec![Vec3::ZERO; elements + 1],
            earlier: vec![Vec3::ZERO; elements + 1],
            tensions: implicit::Tensions::new(if scheme == Scheme::ImplicitTension { elements } else { 0 }),
            constants,
        }
    }

    /// Makes other fibres of as many elements of the chains, which stay where they are and go as fast as they go.
    /// Tensions follow the stiffness.
    pub(crate) fn become_of(&mut self, strands: &[Strand]) {
        let before = self.constants.axial_stiffness;
        self.constants = Constants::of(strands);
        let after = self.constants.axial_stiffness;
        for tension in &mut self.tensions.tension {
            *tension = Lanes::from_fn(|i| tension.0[i] * (after.0[i] / before.0[i]));
        }
    }

    /// Gives each element the implicit scheme's tension that its stretch stands for.
    pub(crate) fn settle_tensions(&mut self) {
        let stretched: Vec<Lanes> = self.tension_of_stretch().collect();
        for (tension, stretched) in self.tensions.tension.iter_mut().zip(stretched) {
            *tension = stretched;
        }
    }

    /// Tension of each element [N], negative in compression: of its stretch, or with implicit tension that which
    /// the scheme has solved for.
    pub fn tension(&self) -> Vec<Lanes> {
        // There is one more than there are elements, or none.
        match self.tensions.tension.split_last() {
            Some((_, solved)) if solved.len() == self.elements() => solved.to_vec(),
            _ => self.tension_of_stretch().collect(),
        }
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

    /// Number of elements `N`.
    pub fn elements(&self) -> usize {
        self.position.len() - 1
    }
}
