//! Feed and belt: how a chain grows at its root and is laid down at its end.
//!
//! ```text
//! inlet   ● root, driven at the feed speed; every few steps it is let go and a new one is born above it
//!         ●
//!         ●   nodes in the air, all alike
//!         ●
//! belt ●●●●   a node that reaches the belt moves with it; well behind the newest touch-down it leaves the chain
//! ```
//!
//! Landing and leaving depend on the fibre's own lane alone, so a fibre has the same bits whatever flies beside it.
//!                                                                         theory.md (59) to (62)

mod carried;
mod feed;
mod landing;

use super::Chain;
use super::constants::{Constants, Node};
use crate::fibre::{Fibre, Root};
use crate::lanes::{Lanes, WIDTH};
use crate::line::Line;
use crate::nodes::Nodes;
use crate::vec3::Vec3;
pub(crate) use carried::CarriedEnergy;

/// A point of a fibre that has been laid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LaidPoint {
    /// Length of fibre fed before it [m].
    pub fed: f64,
    /// Time of the touch-down [s].
    pub time: f64,
    /// Place on the belt in machine direction, `y − v_b t` [m].
    pub md: f64,
    /// Place on the belt in cross direction, `z` [m].
    pub cd: f64,
}

/// How a fibre is fed and laid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Feed {
    /// Feed and belt.
    pub(crate) line: Line,
    /// The fibre.
    pub(crate) fibre: Fibre,
    /// Direction around the axis in which the first end is a little off it [turns].
    pub(crate) turn: f64,
}

/// Feed and belt of eight fibres, and what has been fed and laid so far.
#[derive(Clone, Debug)]
pub(crate) struct LayingState {
    clamped: [bool; WIDTH],
    feed_speed: Lanes,
    height: Lanes,
    belt_speed: Lanes,
    steps_per_element: u64,
    /// Rest length of an element [m].
    element_length: Lanes,
    /// Nodes behind the newest touch-down that stay in the chain.
    kept: [u64; WIDTH],
    /// Number of the root in the order of feed. The first end of the fibre has the number 0.
    root_number: u64,
    /// Number of the node that touched down last in the order of feed, plus one; 0 before the first.
    touched: [u64; WIDTH],
    /// Nodes with lower numbers have left the chain.
    left: [u64; WIDTH],
    /// Times of the touch-downs of the nodes in the tail [s].
    landed_at: Vec<Lanes>,
    /// Nodes that land in this step, with the share of the step that they still fly; NaN in lanes where they
    /// do not land.
    landing: Vec<(usize, Lanes)>,
    /// Where the nodes were born [m].
    pub(crate) origin: Nodes<Vec3<Lanes>>,
    /// Points that have left the chain and have not been taken yet.
    pub(crate) laid: [Vec<LaidPoint>; WIDTH],
    /// Energy that came with fed fibre minus the energy that left with laid fibre [J], in parts.
    pub(crate) carried: CarriedEnergy,
}

impl LayingState {
    /// * `lanes` – of up to eight fibres
    /// * `steps_per_element` – of all of them
    /// * `rest_length` – of an element [m]
    fn new(lanes: &[Feed], steps_per_element: u64, rest_length: Lanes, elements: usize) -> Self {
        let pick = |i: usize| &lanes[if i < lanes.len() { i } else { 0 }];
        let kept = |i: usize| (pick(i).line.kept_length / rest_length.0[i]).ceil().clamp(1.0, 1e9) as u64;
        Self {
            clamped: std::array::from_fn(|i| pick(i).fibre.root == Root::Clamped),
            feed_speed: Lanes::from_fn(|i| pick(i).line.feed_speed),
            height: Lanes::from_fn(|i| pick(i).line.distance),
            belt_speed: Lanes::from_fn(|i| pick(i).line.belt_speed),
            steps_per_element,
            element_length: rest_length,
            kept: std::array::from_fn(kept),
            root_number: elements as u64,
            touched: [0; WIDTH],
            left: [0; WIDTH],
            landed_at: vec![Lanes::splat(f64::NAN)],
            landing: Vec::new(),
            origin: Nodes::default(),
            laid: Default::default(),
            carried: CarriedEnergy::default(),
        }
    }

    /// Number of nodes between the root and the newest touch-down, for a lane.
    pub(crate) fn in_air(&self, lane: usize) -> u64 {
        self.root_number + 1 - self.touched[lane].min(self.root_number + 1)
    }

    /// Nodes from the root on that have not left the chain, for a lane.
    pub(crate) fn nodes(&self, lane: usize) -> usize {
        (self.root_number + 1 - self.left[lane]) as usize
    }

    /// Number of elements that are born after a step.
    ///
    /// * `step` – number of steps done
    pub(crate) fn born(&self, step: u64) -> usize {
        usize::from(step.is_multiple_of(self.steps_per_element))
    }

    /// Number of elements fed so far.
    pub(crate) fn fed(&self) -> u64 {
        self.root_number
    }
}

impl Node {
    /// Holds the node in a lane.
    fn hold(&mut self, lane: usize) {
        (self.inverse_mass.0[lane], self.inverse_mass_x.0[lane]) = (0.0, 0.0);
    }
}

impl Chain {
    /// After a step: nodes that have landed move with the belt, nodes far behind leave, and a new root is born if it is
    /// due.
    ///
    /// * `step` – number of steps done
    /// * `h` – the time step [s]
    #[inline(always)]
    pub(crate) fn feed_and_lay(&mut self, step: u64, h: f64) {
        let Some(laying) = &self.laying else { return };
        if !laying.landing.is_empty() {
            self.touch_down(step, h);
        }
        let per_element = self.laying.as_ref().map_or(1, |laying| laying.steps_per_element);
        if step.is_multiple_of(per_element) {
            self.give_birth(h * per_element as f64);
        }
        self.clamp(step % per_element);
    }

    /// Carries over to new constants what is fed, and what is held by the belt.
    pub(super) fn keep_held(&mut self, former: &Constants) {
        if self.laying.is_none() {
            return;
        }
        let c = &mut self.constants;
        (c.frame, c.friction) = (former.frame, former.friction);
        (c.root.mass, c.root.weight) = (c.between.mass, c.between.weight);
        let scale = |stiffness: Lanes| {
            Lanes::from_fn(|lane| stiffness.0[lane] / former.stiffness.0[lane] * c.stiffness.0[lane])
        };
        let (root, second) = (scale(former.root_stiffness), scale(former.second_stiffness));
        let kept = |new: Lanes, old: Lanes| Lanes::from_fn(|i| if old.0[i] == 0.0 { 0.0 } else { new.0[i] });
        let tail = former.tail.iter().map(|old| {
            let node = c.between;
            Node {
                mass: kept(node.mass, old.mass),
                inverse_mass: kept(node.inverse_mass, old.inverse_mass),
                inverse_mass_x: kept(node.inverse_mass_x, old.inverse_mass_x),
                weight: kept(node.weight, old.weight),
            }
        });
        let tail = tail.collect();
        (c.root_stiffness, c.second_stiffness, c.tail) = (root, second, tail);
    }
}
