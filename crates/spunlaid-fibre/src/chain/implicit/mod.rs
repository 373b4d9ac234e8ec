//! Leapfrog with implicit tension: the time step is not limited by axial waves nor by the waves of a taut string.
//!
//! The scheme uses the tension `λ = k_a (ℓ_{k+1} − l)` that an element will have at the end of the step. The
//! tension acts along the element's direction at the start of the step. The change of that direction during
//! the step is averaged as in Newmark's rule, which adds a share of `h²` times the string's stiffness to the
//! mass. The share is `½ s/(1+s)` with `s = h²λ/(ℓm)`: the square of the ratio of the step to the time that a
//! wave of the string needs to pass the element. The share is close to zero for short steps, where plain
//! leapfrog is better, and large enough for long steps. Each step solves two scalar tridiagonal systems along
//! the chain.                                                             theory.md (51) to (54)
//!
//! 1. A force pass from the root computes the forces with the tensions of the last step, and eliminates the
//!    system of the accelerations.
//! 2. A pass from the free end to the root computes the accelerations, the predicted velocities and edges,
//!    and eliminates the system of the corrections `δ` of the tensions (Newton's method, one iteration).
//! 3. A pass from the root to the free end corrects the tensions and moves the nodes.

mod accelerations;
mod corrections;
mod iterations;
mod motion;
#[cfg(test)]
mod tests;

use super::forces::{ElementBlock, force_pass};
use super::work::{Supports, WorkDone, WorkRegisters};
use super::{Chain, Stride};
use accelerations::{Predictor, most_kept};
use corrections::predict_and_eliminate;
use motion::correct_and_move;
use spunlaid_air::Velocities;
use spunlaid_ground::{Lanes, Nodes, Register, Vec3, WIDTH, Wide};

/// Advances eight chains by one step. The arguments are those of the explicit step, with equal times of kick and drift.
#[inline(always)]
pub(crate) fn step<S: Register, const FED: bool>(
    chain: &mut Chain,
    air: &Velocities<'_, S>,
    Stride { drift: h, damped, split, .. }: Stride,
    work: &mut WorkDone,
    block: &mut ElementBlock<S>,
) {
    let c = &chain.constants;
    let mut predictor = Predictor::<S> {
        damped,
        charged: chain.charged.as_ref(),
        position: &chain.position,
        velocity: &chain.velocity,
        earlier: &chain.earlier,
        c,
        h,
        h_squared: Wide::splat(h * h),
        most_kept: most_kept::<S, FED>(h),
        t: &mut chain.tensions,
        string: (Wide::zero(), Wide::zero()),
        next_string: Wide::zero(),
        above: (Vec3::zero(), Wide::zero()),
        dissipation: Wide::zero(),
    };
    force_pass(&mut predictor, c, air, chain.position.len() - 1, block);
    work.dissipate(predictor.dissipation, c, h);
    predict_and_eliminate::<S, FED>(chain, h);
    if FED {
        chain.hold_landing();
    }
    let mut registers = WorkRegisters::new(work, split);
    let mut supports = Supports::start(work);
    let change = correct_and_move::<S, FED>(chain, h, damped, &mut registers, &mut supports);
    registers.put(work);
    supports.put(work);
    if FED {
        chain.iterate(&change.store(), h, split, work);
    }
}

/// What the scheme stores besides positions and velocities.
#[derive(Clone, Debug, Default)]
pub struct Tensions {
    /// Of each element: tension `λ` [N].
    pub(crate) tension: Nodes<Lanes>,
    /// For each node: the data of a step about it and of the element below.
    links: Vec<Link>,
    /// For each node on the belt, if there is friction: the belt's force on it [N].
    pub(crate) belt_force: Vec<Vec3<Lanes>>,
    rubs: bool,
    /// The largest error of an element's length after all iterations of a step, in parts of its rest length
    /// [-], and the element; so far, of each lane.
    pub(crate) worst: [(f64, usize); WIDTH],
}

/// The data of a step about a node and of the element below it. It lies together, because each pass along the
/// chain needs most of it.
#[derive(Clone, Copy, Debug)]
struct Link {
    /// The element's direction at the start of the step, and its predicted direction at the end.
    tangent: Vec3<Lanes>,
    direction: Vec3<Lanes>,
    /// Force with the tensions of the last step, and the drag in it [N].
    force: Vec3<Lanes>,
    drag: Vec3<Lanes>,
    /// Acceleration [m/s²] minus `slope` times that of the next node; later the predicted velocity.
    acceleration: Vec3<Lanes>,
    slope: Lanes,
    /// Correction of the element's tension [N] minus `.1` times that of the element above.
    correction: (Lanes, Lanes),
}

impl Link {
    const NONE: Self = Self {
        tangent: Vec3::ZERO,
        direction: Vec3::ZERO,
        force: Vec3::ZERO,
        drag: Vec3::ZERO,
        acceleration: Vec3::ZERO,
        slope: Lanes::ZERO,
        correction: (Lanes::ZERO, Lanes::ZERO),
    };
}

impl Tensions {
    pub(crate) fn new(elements: usize) -> Self {
        let mut tensions = Self { tension: vec![Lanes::ZERO; elements].into(), ..Self::default() };
        if elements > 0 {
            tensions.make_room(elements + 1);
        }
        tensions
    }

    /// Drag on a node at the start of the last step [N], by the number that the node had then.
    pub fn drag(&self, node: usize) -> Vec3<Lanes> {
        self.links[node].drag
    }

    /// Keeps the belt's force on each node.
    pub(crate) fn rub(&mut self) {
        self.rubs = true;
        self.belt_force = vec![Vec3::ZERO; self.links.len()];
    }

    /// Makes room for a number of nodes.
    fn make_room(&mut self, room: usize) {
        if self.links.len() < room {
            if self.rubs {
                self.belt_force.resize(room, Vec3::ZERO);
            }
            self.links.resize(room, Link::NONE);
        }
    }

    /// Adds an element at the root, unless the scheme does without tensions.
    pub(crate) fn push_root(&mut self, tension: Lanes) {
        if !self.tension.is_empty() {
            self.tension.push_root(tension);
            let nodes = self.tension.len() + 1;
            if self.links.len() < nodes {
                // For some more, because the next element is born soon.
                self.make_room(nodes + nodes / 4);
            }
        }
    }

    /// Keeps so many elements from the root on.
    pub(crate) fn truncate(&mut self, elements: usize) {
        if !self.tension.is_empty() {
            self.tension.truncate(elements);
        }
    }
}
