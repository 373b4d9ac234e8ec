//! The fibre as a chain of beads: state, forces, time integration.

pub(crate) mod constants;
pub(crate) mod explicit;
pub mod forces;
pub(crate) mod implicit;
pub(crate) mod laying;
#[cfg(test)]
pub(crate) mod tests;
pub mod work;

use self::constants::Constants;
use self::laying::LayingState;
use self::work::Charged;
use crate::body::Fibre;
use crate::drag::{Curve, ElementDrag};
use crate::line::Line;
use spunlaid_ground::{Lanes, Nodes, PerLane, Vec3, WIDTH};

/// One fibre and what acts on it, without the wind: the content of a lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FibreParameters {
    /// The fibre.
    pub fibre: Fibre,
    /// Drag of one of its elements.
    pub drag: ElementDrag,
    /// Acceleration of gravity along x [m/s²].
    pub gravity: f64,
    /// Mass-proportional damping [1/s].
    pub damping: f64,
}

/// How a step is made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stride {
    /// The velocities change by this time times the acceleration [s].
    pub(crate) kick: f64,
    /// The positions change by this time times the velocity [s].
    pub(crate) drift: f64,
    /// Whether there is any damping.
    pub(crate) damped: bool,
    /// Whether to store separately the work that belongs to the velocities before the kick.
    pub(crate) split: bool,
}

shared! {
    /// What the chains of one flight have in common.
    pub(crate) struct ChainInvariants {
        elements: usize = "the number of elements (fibre.length, fibre.element_length)",
        drag_curves: [Option<Curve>; 2] = "the kind of drag.along or drag.across",
        damped: bool = "whether there is run.damping",
        /// Of a fed fibre.
        steps_per_element: Option<u64> = "how an element is fed (feed.speed, fibre.element_length)",
    }
}

impl ChainInvariants {
    pub(crate) fn new(strand: &FibreParameters, line: Option<&Line>) -> Self {
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
    pub tensions: implicit::Tensions,
    /// How it is fed and laid down; none for a fibre of fixed length.
    pub(crate) laying: Option<LayingState>,
    /// Their charge, and the field around them; none of fibres without charge.
    pub(crate) charged: Option<Charged>,
}

impl Chain {
    /// Packs up to eight fibres, straight and at rest, with their roots at the origin.
    pub(crate) fn straight(
        common: &ChainInvariants,
        strands: &PerLane<FibreParameters>,
        scheme: Scheme,
    ) -> Self {
        let (elements, constants) = (common.elements, Constants::new(common, strands));
        let position = (0..=elements).map(|i| constants.root_direction * constants.distance(i)).collect();
        Self {
            position,
            velocity: vec![Vec3::ZERO; elements + 1].into(),
            earlier: vec![Vec3::ZERO; elements + 1].into(),
            tensions: implicit::Tensions::new(if scheme == Scheme::ImplicitTension { elements } else { 0 }),
            laying: None,
            charged: None,
            constants,
        }
    }

    /// Replaces the fibres by others with the same number of elements. Positions and velocities stay; tensions
    /// change in proportion to the axial stiffness.
    pub(crate) fn become_of(&mut self, common: &ChainInvariants, strands: &PerLane<FibreParameters>) {
        let former = std::mem::replace(&mut self.constants, Constants::new(common, strands));
        self.keep_held(&former);
        let [before, after] = [&former, &self.constants].map(|c| c.element.axial_stiffness);
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
    pub(crate) fn tension(&self) -> Vec<Lanes> {
        let solved = &self.tensions.tension;
        if solved.is_empty() { self.tension_of_stretch().collect() } else { solved.to_vec() }
    }

    fn tension_of_stretch(&self) -> impl Iterator<Item = Lanes> {
        self.position.windows(2).map(|pair| {
            let element = &self.constants.element;
            Lanes::from_fn(|i| {
                let length = (pair[1].lane(i) - pair[0].lane(i)).norm();
                element.axial_stiffness.0[i] * (length - element.rest_length.0[i])
            })
        })
    }

    /// Number of elements that have been fed so far.
    pub fn fed(&self) -> u64 {
        self.laying.as_ref().map_or(0, LayingState::fed)
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

named! {
    /// How the equations of motion are advanced in time.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Scheme {
        /// `v ← v + h a(r, v)`, then `r ← r + h v`. First order; the paper uses it. theory.md (27)
        SemiImplicitEuler = "semi-implicit-euler",
        /// Velocities at half steps, drag from the velocity extrapolated to the full step. Second order.
        /// theory.md (28)
        Leapfrog = "leapfrog",
        /// Leapfrog with the tension that the elements will have at the end of the step. Axial waves do not limit
        /// the step; the scheme damps them.                                  theory.md (51) to (54)
        ImplicitTension = "implicit-tension",
    }
}

impl Scheme {
    /// Whether the velocities are those at half steps.
    pub(crate) const fn is_staggered(self) -> bool {
        !matches!(self, Self::SemiImplicitEuler)
    }
}
