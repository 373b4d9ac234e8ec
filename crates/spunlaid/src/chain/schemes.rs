//! Time integration: one sweep along the chain per step.

use super::forces::{Element, bending};
use super::{Chain, Constants, Node};
use crate::air::Gust;
use crate::drag::{DragLanes, Split};
use crate::energy::{Power, Work};
use crate::lanes::{Lanes, Register, Wide};
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
/// * `wind` – the air at the time of the positions
/// * `eddy` – index into `wind` for each of the `N` elements
/// * `work` – ledger the step adds to
/// * `SPLIT` – whether the ledger also keeps apart what the velocities before the kick gave
///
/// From the root down in blocks of elements: first their geometry, then their drag, then the bending of the
/// nodes above them, then the motion of those nodes. Short loops keep the machine's pipelines fuller than
/// one long one, and a block stays in the nearest cache. The force on a node is complete, and it moves on,
/// when the element below it is done.
#[inline(always)]
pub(crate) fn step<S: Register, const LEAPFROG: bool, const DAMPED: bool, const SPLIT: bool>(
    chain: &mut Chain,
    wind: Gust<'_, S>,
    eddy: &[u32],
    (kick, drift): (f64, f64),
    work: &mut Work,
    block: &mut Block<S>,
) {
    let elements = chain.elements();
    let Chain { position, velocity, earlier, constants: c } = chain;
    let mut mover = Mover::<S, LEAPFROG, DAMPED, SPLIT> {
        position: &mut position[..=elements],
        velocity: &mut velocity[..=elements],
        earlier: &mut earlier[..=elements],
        c,
        kick: Wide::splat(kick),
        drift: Wide::splat(drift),
        work: Sums::of(work),
    };
    let mut above = Element {
        tangent: Vec3::load(&c.root_direction),
        inverse_length: Wide::zero(),
        length: Wide::zero(),
    };
    // Forces so far on nodes j−1 and j: internal, and of the air.
    let (mut force, mut force_above) = (Vec3::zero(), Vec3::zero());
    let (mut drag, mut drag_above) = (Vec3::zero(), Vec3::zero());
    for (start, eddy) in (0..).step_by(BLOCK).zip(eddy.chunks(BLOCK)) {
        let links = &mut block.0[..eddy.len()];
        mover.geometry(start, links);
        mover.drag(start, links, wind, eddy);
        mover.bending(start, above, links);
        for (j, link) in (start..).zip(&*links) {
            let (a, b) = link.bending;
            if j > 0 {
                let node = if j == 1 { &c.root } else { &c.node };
                mover.advance(j - 1, force_above - a, drag_above, node);
            }
            let tension = link.element.tension(Wide::load(&c.axial_stiffness), Wide::load(&c.rest_length));
            let pull = link.element.tangent.mul_add(tension, b);
            (force_above, force) = (force + a + pull, -pull);
            let air = c.half_drag.force(&link.split, link.element.tangent);
            (drag_above, drag) = (drag + air, air);
        }
        above = links[eddy.len() - 1].element;
    }
    let node = if elements == 1 { &c.root } else { &c.node };
    mover.advance(elements - 1, force_above, drag_above, node);
    mover.advance(elements, force, drag, &c.end);
    mover.work.put(work);
}

/// Elements in a block.
const BLOCK: usize = 8;

/// An element and the node above it, within a step.
#[derive(Clone, Copy)]
struct Link<S: Register> {
    element: Element<S>,
    /// On the way to half the element's drag.
    split: Split<S>,
    /// Bending of the node: see [`bending`].
    bending: (Vec3<Wide<S>>, Vec3<Wide<S>>),
}

/// Room for the elements of a block.
pub(crate) struct Block<S: Register>([Link<S>; BLOCK]);

impl<S: Register> Block<S> {
    #[inline(always)]
    pub(crate) fn new() -> Self {
        let (vector, number) = (Vec3::zero(), Wide::zero());
        let element = Element { tangent: vector, inverse_length: number, length: number };
        Self([Link { element, split: Split::none(), bending: (vector, vector) }; BLOCK])
    }
}

/// Moves nodes on and keeps the ledger.
struct Mover<'a, S: Register, const LEAPFROG: bool, const DAMPED: bool, const SPLIT: bool> {
    position: &'a mut [Vec3<Lanes>],
    velocity: &'a mut [Vec3<Lanes>],
    earlier: &'a mut [Vec3<Lanes>],
    c: &'a Constants,
    kick: Wide<S>,
    drift: Wide<S>,
    work: Sums<S>,
}

impl<S: Register, const LEAPFROG: bool, const DAMPED: bool, const SPLIT: bool>
    Mover<'_, S, LEAPFROG, DAMPED, SPLIT>
{
    /// The elements of a block from `start` on.
    #[inline(always)]
    fn geometry(&self, start: usize, block: &mut [Link<S>]) {
        let nodes = &self.position[start..][..block.len() + 1];
        for (pair, link) in nodes.windows(2).zip(block) {
            link.element = Element::between(Vec3::load(&pair[0]), Vec3::load(&pair[1]));
        }
    }

    /// Half the drag of each element of a block from `start` on.
    #[inline(always)]
    fn drag(&self, start: usize, block: &mut [Link<S>], wind: Gust<'_, S>, eddy: &[u32]) {
        let mut upper = self.drag_velocity(start);
        let (mut here, mut air) = (eddy[0], wind.velocity(eddy[0]));
        for (j, (link, &eddy)) in (start + 1..).zip(block.iter_mut().zip(eddy)) {
            let lower = self.drag_velocity(j);
            if eddy != here {
                (here, air) = (eddy, wind.velocity(eddy));
            }
            let relative = (upper + lower).neg_mul_add(Wide::splat(0.5), air);
            link.split = DragLanes::split(relative, link.element.tangent);
            upper = lower;
        }
        for link in &mut *block {
            self.c.half_drag.raise(&mut link.split);
        }
    }

    /// Bending of the nodes of a block, the first of them below the element `above`.
    #[inline(always)]
    fn bending(&self, start: usize, mut above: Element<S>, block: &mut [Link<S>]) {
        for (j, link) in (start..).zip(block) {
            let stiffness = if j == 0 { &self.c.root_stiffness } else { &self.c.bending_stiffness };
            link.bending = bending(&above, &link.element, Wide::load(stiffness));
            above = link.element;
        }
    }

    /// Velocity of node `i` that drag and damping see.
    #[inline(always)]
    fn drag_velocity(&self, i: usize) -> Vec3<Wide<S>> {
        let v = Vec3::load(&self.velocity[i]);
        if LEAPFROG {
            // From half steps k−3/2 and k−1/2 to the full step k.
            (v - Vec3::load(&self.earlier[i])).mul_add(Wide::splat(0.5), v)
        } else {
            v
        }
    }

    #[inline(always)]
    fn advance(&mut self, i: usize, internal: Vec3<Wide<S>>, drag: Vec3<Wide<S>>, node: &Node) {
        let before = Vec3::load(&self.velocity[i]);
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
            self.earlier[i] = before.store();
        }
        self.velocity[i] = after.store();
        let position = Vec3::load(&self.position[i]);
        self.position[i] = after.mul_add(self.drift, position).store();
    }
}

/// A [`Work`] in registers.
struct Sums<S: Register> {
    both: [Wide<S>; 3],
    before: [Wide<S>; 3],
}

impl<S: Register> Sums<S> {
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
