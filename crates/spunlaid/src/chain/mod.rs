//! The fibre as a chain of beads: state, forces, time integration.

pub mod forces;
pub mod schemes;

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
    /// earlier for leapfrog.
    pub velocity: Vec<Vec3<Lanes>>,
    /// Leapfrog: velocities one step before [`Chain::velocity`], from which the drag extrapolates.
    pub(crate) earlier: Vec<Vec3<Lanes>>,
    /// Constants of the eight fibres.
    pub(crate) constants: Constants,
}

/// What a step needs to know of eight fibres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Constants {
    pub(crate) mass: Lanes,
    pub(crate) inverse_mass: Lanes,
    pub(crate) rest_length: Lanes,
    pub(crate) axial_stiffness: Lanes,
    pub(crate) bending_stiffness: Lanes,
    /// Inverse mass of the root node: 0 where it is held.
    pub(crate) root_inverse_mass: Lanes,
    pub(crate) root_stiffness: Lanes,
    pub(crate) root_direction: Vec3<Lanes>,
    pub(crate) gravity: Lanes,
    pub(crate) damping: Lanes,
    pub(crate) drag: DragLanes,
}

impl Chain {
    /// Packs up to eight fibres, straight and at rest, their roots at the origin.
    ///
    /// Lanes left over repeat the first fibre. All must have the same number of elements as the first.
    pub fn straight(strands: &[Strand]) -> Self {
        let pick = |i: usize| strands[if i < strands.len() { i } else { 0 }];
        let lanes = |value: &dyn Fn(&Strand) -> f64| Lanes::from_fn(|i| value(&pick(i)));
        let elements = strands[0].fibre.elements;
        let direction = Vec3::new(
            lanes(&|s| s.fibre.direction.x),
            lanes(&|s| s.fibre.direction.y),
            lanes(&|s| s.fibre.direction.z),
        );
        let rest_length = lanes(&|s| s.fibre.rest_length());
        let position = (0..=elements).map(|i| direction * (rest_length * i as f64)).collect();
        let mass = lanes(&|s| s.fibre.element_mass());
        Self {
            position,
            velocity: vec![Vec3::ZERO; elements + 1],
            earlier: vec![Vec3::ZERO; elements + 1],
            constants: Constants {
                mass,
                inverse_mass: Lanes::splat(1.0) / mass,
                rest_length,
                axial_stiffness: lanes(&|s| s.fibre.axial_stiffness()),
                bending_stiffness: lanes(&|s| s.fibre.rotational_stiffness()),
                root_inverse_mass: lanes(&|s| match s.fibre.root {
                    Root::Free => 1.0 / s.fibre.node_mass(0),
                    Root::Pinned | Root::Clamped => 0.0,
                }),
                root_stiffness: lanes(&|s| s.fibre.root_stiffness()),
                root_direction: direction,
                gravity: lanes(&|s| s.gravity),
                damping: lanes(&|s| s.damping),
                drag: DragLanes::pack(&std::array::from_fn::<_, WIDTH, _>(|i| pick(i).drag)),
            },
        }
    }

    /// Number of elements `N`.
    pub fn elements(&self) -> usize {
        self.position.len() - 1
    }
}
