//! The step of the nodes with the corrected tensions.

use super::Tensions;
use crate::chain::Chain;
use crate::chain::constants::Constants;
use crate::chain::laying::LayingState;
use crate::chain::work::{Kick, Supports, WorkRegisters};
use spunlaid_ground::{Lanes, Register, Vec3, Wide};

/// From the root to the free end: corrects the tensions and moves the nodes. Returns by how much the squared
/// length of an element of a fed fibre is off at most from the one that belongs to its tension, in parts of
/// it.
#[inline(always)]
pub(super) fn correct_and_move<S: Register, const FED: bool>(
    chain: &mut Chain,
    h: f64,
    damped: bool,
    work: &mut WorkRegisters<S>,
    supports: &mut Supports,
) -> Wide<S> {
    let Chain { position, velocity, earlier, constants: c, tensions: t, laying, .. } = chain;
    let nodes = position.len();
    let mut motion = Motion::<S, FED> {
        damped,
        position: &mut position[..nodes],
        velocity: &mut velocity[..nodes],
        earlier: &mut earlier[..nodes],
        c,
        t,
        laying: if FED { laying.as_ref() } else { None },
        work,
        supports,
        h: Wide::splat(h),
        rate: Wide::splat(1.0 / h),
        correction: Wide::zero(),
        natural: Wide::zero(),
        above: (Vec3::zero(), Wide::zero()),
        furthest: Wide::zero(),
    };
    let mut above = Pull { change: Vec3::zero(), last: Vec3::zero() };
    for i in 0..nodes {
        let natural_above = motion.natural;
        let below = motion.correct(i);
        let pull = Pull { change: below.change - above.change, last: below.last - above.last };
        let (kick, mut tension) = motion.kick(i, &pull);
        if FED && motion.c.may_be_held(i, nodes) {
            tension -= motion.hold(i, &pull, &kick);
        }
        motion.enter(&kick, tension);
        let here = motion.drift(i, &kick);
        if FED {
            motion.measure(i, here, natural_above);
        }
        above = below;
    }
    motion.length_error()
}

/// The pull of an element, or the sum of those on a node [N].
#[derive(Clone, Copy)]
struct Pull<S: Register> {
    /// From the correction of the tension.
    change: Vec3<Wide<S>>,
    /// From the tension of the last step.
    last: Vec3<Wide<S>>,
}

/// The nodes on their way through the step.
struct Motion<'a, S: Register, const FED: bool> {
    damped: bool,
    position: &'a mut [Vec3<Lanes>],
    velocity: &'a mut [Vec3<Lanes>],
    earlier: &'a mut [Vec3<Lanes>],
    c: &'a Constants,
    t: &'a mut Tensions,
    laying: Option<&'a LayingState>,
    work: &'a mut WorkRegisters<S>,
    supports: &'a mut Supports,
    /// The time step [s], and its inverse.
    h: Wide<S>,
    rate: Wide<S>,
    /// Correction of the tension of the element above the next node [N], and the length that belongs to the
    /// tension [m].
    correction: Wide<S>,
    natural: Wide<S>,
    /// The node above: where it is now, and whether it moves.
    above: (Vec3<Wide<S>>, Wide<S>),
    /// By how much a squared length is off at most so far [m²].
    furthest: Wide<S>,
}

impl<S: Register, const FED: bool> Motion<'_, S, FED> {
    /// Corrects the tension of the element below a node; returns its pull.
    #[inline(always)]
    fn correct(&mut self, i: usize) -> Pull<S> {
        if i + 1 == self.position.len() {
            return Pull { change: Vec3::zero(), last: Vec3::zero() };
        }
        let link = &self.t.links[i];
        let (value, slope) = &link.correction;
        self.correction = Wide::load(slope).neg_mul_add(self.correction, Wide::load(value));
        let tension = Wide::load(&self.t.tension[i]);
        let change = Vec3::load(&link.direction) * self.correction;
        let last = Vec3::load(&link.tangent) * tension;
        let corrected = tension + self.correction;
        self.t.tension[i] = corrected.store();
        let element = &self.c.element;
        self.natural = Wide::load(&element.compliance).mul_add(corrected, Wide::load(&element.rest_length));
        Pull { change, last }
    }

    /// The kick of a node, and the tension in it: what the other forces do not explain [N].
    #[inline(always)]
    fn kick(&self, i: usize, pull: &Pull<S>) -> (Kick<S>, Vec3<Wide<S>>) {
        let nodes = self.position.len();
        let (node, link) = (self.c.node(i, nodes), &self.t.links[i]);
        let before = Vec3::load(&self.velocity[i]);
        let predicted = Vec3::load(&link.acceleration);
        let mut after = pull.change.mul_add(self.h * Wide::load(&node.inverse_mass), predicted);
        if FED && i > 0 && self.c.may_be_held(i, nodes) {
            let zero = Wide::zero();
            after.x = Wide::select_less(zero, Wide::load(&node.inverse_mass_x), after.x, predicted.x);
        }
        let force = (after - before) * (Wide::load(&node.mass) * self.rate);
        let tension = force - Vec3::load(&link.force) + pull.last;
        let mut damping = None;
        if self.damped {
            let v = (before - Vec3::load(&self.earlier[i])).mul_add(Wide::splat(0.5), before);
            damping = Some(v * -(Wide::load(&node.mass) * Wide::load(&self.c.damping)));
        }
        (Kick { force, drag: Vec3::load(&link.drag), damping, before, after }, tension)
    }

    /// What holds a node that the inlet or the belt may hold [N].
    #[inline(always)]
    fn hold(&mut self, i: usize, pull: &Pull<S>, kick: &Kick<S>) -> Vec3<Wide<S>> {
        let nodes = self.position.len();
        let unexplained = kick.force - Vec3::load(&self.t.links[i].force) - pull.change;
        let mut free = Wide::load(&self.c.node(i, nodes).inverse_mass);
        if let Some(laying) = self.laying {
            free = laying.inverse_mass_unless_landing(i, free);
        }
        let held = self.supports.add(i, free, unexplained, kick.velocities(), self.c);
        if i > 0 && self.c.friction.is_some() {
            let force = Vec3::load(&self.t.belt_force[i]);
            self.supports.rub(force, kick.velocities(), self.c);
            self.t.belt_force[i] = (force + held).store();
        }
        held
    }

    /// Enters the work of the forces.
    #[inline(always)]
    fn enter(&mut self, kick: &Kick<S>, tension: Vec3<Wide<S>>) {
        let kick = if FED { &kick.seen_from(&self.c.frame) } else { kick };
        self.work.enter(kick);
        self.work.enter_tension(tension, kick);
    }

    /// Moves the node on; returns its position.
    #[inline(always)]
    fn drift(&mut self, i: usize, kick: &Kick<S>) -> Vec3<Wide<S>> {
        self.earlier[i] = kick.before.store();
        self.velocity[i] = kick.after.store();
        let here = kick.after.mul_add(self.h, Vec3::load(&self.position[i]));
        self.position[i] = here.store();
        here
    }

    /// Compares the element above a node with the length that belongs to its tension, unless it lies on the
    /// belt, where nothing can correct it.
    #[inline(always)]
    fn measure(&mut self, i: usize, here: Vec3<Wide<S>>, natural: Wide<S>) {
        let moves = Wide::load(&self.c.node(i, self.position.len()).inverse_mass);
        let edge = here - self.above.0;
        let off = edge.dot(edge) - natural * natural;
        let off = off.abs().max(self.furthest);
        if i > 0 {
            self.furthest = Wide::select_less(Wide::zero(), moves + self.above.1, off, self.furthest);
        }
        self.above = (here, moves);
    }

    /// By how much a squared length is off at most, in parts of that of an element of a fed fibre, all of
    /// which are equal.
    #[inline(always)]
    fn length_error(&self) -> Wide<S> {
        let rest_length = Wide::load(&self.c.element.rest_length);
        self.furthest.over(rest_length * rest_length)
    }
}
