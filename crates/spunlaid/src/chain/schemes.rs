//! Time integration: one sweep along the chain per step.

use super::forces::{Element, bending};
use super::{Chain, Constants, Node};
use crate::energy::{Power, Work};
use crate::lanes::{Lanes, Simd, Wide};
use crate::vec3::Vec3;

/// How the equations of motion are advanced in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheme {
    /// `v ← v + h a(r, v)`, then `r ← r + h v`: first order, the paper's.    theory.md (27)
    SemiImplicitEuler,
    /// Velocities at half steps, drag at the velocity extrapolated to the full step: second order.
    /// theory.md (28)
    Leapfrog,
}

impl Scheme {
    /// Name in the case file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::SemiImplicitEuler => "semi-implicit-euler",
            Self::Leapfrog => "leapfrog",
        }
    }
}

/// Advances eight chains by one step in the given wind: velocities by `kick` [s] of acceleration, then
/// positions by `drift` [s] of velocity.
///
/// * `wind` – velocity of the air in each eddy at the time of the positions [m/s]
/// * `eddy` – index into `wind` for each of the `N` elements
/// * `work` – ledger the step adds to
/// * `SPLIT` – whether the ledger also keeps apart what the velocities before the kick gave
///
/// From the root down in blocks of elements. Within a block first the elements' geometry, then their drag,
/// then node by node bending and motion: three short loops keep the machine's pipelines fuller than one
/// long one, and a block stays in the nearest cache. The force on a node is complete, and it moves on,
/// when the element below it is done.
#[inline(always)]
pub(crate) fn step<S: Simd, const LEAPFROG: bool, const DAMPED: bool, const SPLIT: bool>(
    chain: &mut Chain,
    wind: &[Vec3<Lanes>],
    eddy: &[u32],
    (kick, drift): (f64, f64),
    work: &mut Work,
) {
    let c = chain.constants;
    let elements = chain.elements();
    let mut mover = Mover::<S, LEAPFROG, DAMPED, SPLIT> {
        chain,
        c: &c,
        kick: Wide::splat(kick),
        drift: Wide::splat(drift),
        work: Sums::of(work),
    };
    let mut above = Element {
        tangent: Vec3::load(&c.root_direction),
        inverse_length: Wide::zero(),
        length: Wide::zero(),
    };
    let mut stiffness = &c.root_stiffness;
    // Forces so far on nodes j−1 and j: internal, and of the air.
    let (mut force, mut force_above) = (Vec3::zero(), Vec3::zero());
    let (mut drag, mut drag_above) = (Vec3::zero(), Vec3::zero());
    // The node above the element: the root first, then one of those between.
    let mut node_above = &c.root;
    let mut block = [(above, Vec3::zero()); BLOCK];
    for (start, eddy) in (0..).step_by(BLOCK).zip(eddy.chunks(BLOCK)) {
        mover.geometry(start, &mut block[..eddy.len()]);
        mover.drag(start, &mut block[..eddy.len()], wind, eddy);
        for (j, &(element, drag_half)) in (start..).zip(&block[..eddy.len()]) {
            let tension = element.tension(Wide::load(&c.axial_stiffness), Wide::load(&c.rest_length));
            let (a, b) = bending(&above, &element, Wide::load(stiffness));
            if j > 0 {
                mover.advance(j - 1, force_above - a, drag_above, node_above);
                if j == 1 {
                    node_above = &c.node;
                }
            }
            let pull = element.tangent.mul_add(tension, b);
            (force_above, force) = (force + a + pull, -pull);
            (drag_above, drag) = (drag + drag_half, drag_half);
            above = element;
            stiffness = &c.bending_stiffness;
        }
    }
    mover.advance(elements - 1, force_above, drag_above, node_above);
    mover.advance(elements, force, drag, &c.end);
    mover.work.put(work);
}

/// Elements in a block.
const BLOCK: usize = 8;

/// Moves nodes on and keeps the ledger.
struct Mover<'a, S: Simd, const LEAPFROG: bool, const DAMPED: bool, const SPLIT: bool> {
    chain: &'a mut Chain,
    c: &'a Constants,
    kick: Wide<S>,
    drift: Wide<S>,
    work: Sums<S>,
}

impl<S: Simd, const LEAPFROG: bool, const DAMPED: bool, const SPLIT: bool>
    Mover<'_, S, LEAPFROG, DAMPED, SPLIT>
{
    /// The elements of a block from `start` on.
    #[inline(always)]
    fn geometry(&self, start: usize, block: &mut [(Element<S>, Vec3<Wide<S>>)]) {
        let nodes = &self.chain.position[start..][..block.len() + 1];
        for (pair, (element, _)) in nodes.windows(2).zip(block) {
            *element = Element::between(Vec3::load(&pair[0]), Vec3::load(&pair[1]));
        }
    }

    /// Half the drag of each element of a block from `start` on.
    #[inline(always)]
    fn drag(
        &self,
        start: usize,
        block: &mut [(Element<S>, Vec3<Wide<S>>)],
        wind: &[Vec3<Lanes>],
        eddy: &[u32],
    ) {
        let mut upper = self.drag_velocity(start);
        for (j, ((element, drag), &eddy)) in (start..).zip(block.iter_mut().zip(eddy)) {
            let lower = self.drag_velocity(j + 1);
            let air = Vec3::load(&wind[eddy as usize]);
            let relative = (upper + lower).neg_mul_add(Wide::splat(0.5), air);
            *drag = self.c.half_drag.force(relative, element.tangent);
            upper = lower;
        }
    }

    /// Velocity of node `i` that drag and damping see.
    #[inline(always)]
    fn drag_velocity(&self, i: usize) -> Vec3<Wide<S>> {
        let v = Vec3::load(&self.chain.velocity[i]);
        if LEAPFROG {
            // From half steps k−3/2 and k−1/2 to the full step k.
            (v - Vec3::load(&self.chain.earlier[i])).mul_add(Wide::splat(0.5), v)
        } else {
            v
        }
    }

    #[inline(always)]
    fn advance(&mut self, i: usize, internal: Vec3<Wide<S>>, drag: Vec3<Wide<S>>, node: &Node) {
        let before = Vec3::load(&self.chain.velocity[i]);
        let mut force = internal + drag;
        force.x += Wide::load(&node.weight);
        let mut damping = Vec3::zero();
        if DAMPED {
            damping = self.drag_velocity(i) * -(Wide::load(&node.mass) * Wide::load(&self.c.damping));
            force += damping;
        }
        let after = force.mul_add(self.kick * Wide::load(&node.inverse_mass), before);
        self.work.add::<DAMPED, SPLIT>([force, drag, damping], before, after);
        if LEAPFROG {
            self.chain.earlier[i] = before.store();
        }
        self.chain.velocity[i] = after.store();
        let position = Vec3::load(&self.chain.position[i]);
        self.chain.position[i] = after.mul_add(self.drift, position).store();
    }
}

/// A [`Work`] in registers.
struct Sums<S: Simd> {
    both: [Wide<S>; 3],
    before: [Wide<S>; 3],
}

impl<S: Simd> Sums<S> {
    #[inline(always)]
    fn of(work: &Work) -> Self {
        Self {
            both: [
                Wide::load(&work.total.both),
                Wide::load(&work.drag.both),
                Wide::load(&work.damping.both),
            ],
            before: [Wide::zero(); 3],
        }
    }

    /// Adds `F·(v_before + v_after)` of the total, the drag and the damping force.
    #[inline(always)]
    fn add<const DAMPED: bool, const SPLIT: bool>(
        &mut self,
        forces: [Vec3<Wide<S>>; 3],
        before: Vec3<Wide<S>>,
        after: Vec3<Wide<S>>,
    ) {
        let velocities = before + after;
        for i in 0..if DAMPED { 3 } else { 2 } {
            self.both[i] = forces[i].dot_add(velocities, self.both[i]);
            if SPLIT {
                self.before[i] = forces[i].dot_add(before, self.before[i]);
            }
        }
    }

    #[inline(always)]
    fn put(self, work: &mut Work) {
        work.total = Power { both: self.both[0].store(), before: self.before[0].store() };
        work.drag = Power { both: self.both[1].store(), before: self.before[1].store() };
        work.damping = Power { both: self.both[2].store(), before: self.before[2].store() };
    }
}
