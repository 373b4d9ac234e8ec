//! The ledgers of the work done on the nodes.

use super::Chain;
use super::constants::Constants;
use crate::charge::SheetField;
use spunlaid_ground::{Lanes, Register, Vec3, Wide};
use std::sync::Arc;

/// Running sums of `F·v` over nodes and steps, with the velocities before and after each kick.
///
/// Since `r_{k+1} − r_k = h v_after`, the trapezoidal rule of theory.md (33) up to time `t_K` is
/// `½h (Σ_{k<K} F_k·(v_before + v_after) + F_K·v_before)`, without the very first term `F₀·v_before`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct WorkSum {
    /// `Σ F·(v_before + v_after)` over all steps.
    pub(crate) both: Lanes,
    /// `Σ F·v_before` of the last step, if that step stored it separately.
    pub(crate) before: Lanes,
}

impl WorkSum {
    /// Work [J] up to the start of the last step; `earlier` holds the sums before that step.
    pub(crate) fn work(&self, earlier: &Self, h: f64) -> Lanes {
        (earlier.both + self.before) * Lanes::splat(0.5 * h)
    }
}

/// Work done on the nodes by all forces together, and by the forces that have no potential.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct WorkDone {
    /// All forces (theory.md (33), Eq 35 of the paper).
    pub total: WorkSum,
    /// The drag of the air.
    pub drag: WorkSum,
    /// The mass-proportional damping.
    pub damping: WorkSum,
    /// The electric field of charged fibres.
    pub field: WorkSum,
    /// The tension; used by implicit tension only.
    pub tension: WorkSum,
    /// Energy that the bending viscosity has dissipated [J].
    pub viscous: Lanes,
    /// What drives the root of a fed fibre.
    pub feed: WorkSum,
    /// The belt, at the touch-down.
    pub belt: WorkSum,
}

/// Sums of the work of the forces that hold nodes of a fed fibre: what drives its root, and the belt.
#[derive(Clone, Copy)]
pub(crate) struct Supports {
    feed: WorkSum,
    belt: WorkSum,
}

impl Supports {
    #[inline(always)]
    pub(crate) fn start(work: &WorkDone) -> Self {
        let restarted = |sum: WorkSum| WorkSum { before: Lanes::ZERO, ..sum };
        Self { feed: restarted(work.feed), belt: restarted(work.belt) }
    }

    /// Adds the work of the force that holds node `i` and returns it, zero in the lanes where the node is free.
    ///
    /// * `free` – above zero where it is free
    /// * `force` – what holds it where it is not
    /// * `velocities` – before and after the kick
    #[inline(always)]
    pub(crate) fn add<S: Register>(
        &mut self,
        i: usize,
        free: Wide<S>,
        force: Vec3<Wide<S>>,
        [before, after]: [Vec3<Wide<S>>; 2],
        c: &Constants,
    ) -> Vec3<Wide<S>> {
        let zero = Wide::zero();
        let held = |force: Wide<S>| Wide::select_less(zero, free, zero, force);
        let force = Vec3::new(held(force.x), held(force.y), held(force.z));
        let frame = Wide::load(&c.frame);
        let (before, after) = (before.less_y(frame), after.less_y(frame));
        let sum = if i == 0 { &mut self.feed } else { &mut self.belt };
        sum.both = force.dot_add(before + after, Wide::load(&sum.both)).store();
        // The belt's force is a blow at the touch-down, which counts from the end of its step on.
        if i == 0 {
            sum.before = force.dot(before).store();
        }
        force
    }

    /// Adds the work of the friction on a node that slides on the belt.
    #[inline(always)]
    pub(crate) fn rub<S: Register>(
        &mut self,
        friction: Vec3<Wide<S>>,
        [before, after]: [Vec3<Wide<S>>; 2],
        c: &Constants,
    ) {
        let frame = Wide::load(&c.frame);
        let sum = before.less_y(frame) + after.less_y(frame);
        self.belt.both = friction.dot_add(sum, Wide::load(&self.belt.both)).store();
    }

    #[inline(always)]
    pub(crate) fn put(self, work: &mut WorkDone) {
        (work.feed, work.belt) = (self.feed, self.belt);
    }
}

impl WorkDone {
    /// Adds the dissipation of the bending viscosity, if there is any, over a step of `h` [s].
    #[inline(always)]
    pub(crate) fn dissipate<S: Register>(&mut self, power: Wide<S>, c: &Constants, h: f64) {
        if c.viscosity.is_some() {
            self.viscous = power.mul_add(Wide::splat(h), Wide::load(&self.viscous)).store();
        }
    }

    /// Removes what the first step added for the time before the start. Called once, after that step.
    pub(crate) fn begin(&mut self) {
        for power in [
            &mut self.total,
            &mut self.drag,
            &mut self.damping,
            &mut self.field,
            &mut self.tension,
            &mut self.feed,
            &mut self.belt,
        ] {
            power.both = power.both - power.before;
            power.before = Lanes::ZERO;
        }
    }
}

/// A kick of a node: the forces on it [N], and its velocities before and after [m/s].
#[derive(Clone, Copy)]
pub(crate) struct Kick<S: Register> {
    /// All forces.
    pub(crate) force: Vec3<Wide<S>>,
    /// The drag among them.
    pub(crate) drag: Vec3<Wide<S>>,
    /// The damping among them, if there is any.
    pub(crate) damping: Option<Vec3<Wide<S>>>,
    pub(crate) before: Vec3<Wide<S>>,
    pub(crate) after: Vec3<Wide<S>>,
}

impl<S: Register> Kick<S> {
    /// The velocities before and after the kick.
    #[inline(always)]
    pub(crate) fn velocities(&self) -> [Vec3<Wide<S>>; 2] {
        [self.before, self.after]
    }

    /// The same kick with the velocities relative to a belt that moves along y [m/s].
    #[inline(always)]
    pub(crate) fn seen_from(self, belt: &Lanes) -> Self {
        let belt = Wide::load(belt);
        Self { before: self.before.less_y(belt), after: self.after.less_y(belt), ..self }
    }
}

/// [`WorkDone`] in registers: by all forces, drag, damping and implicit tension.
pub(crate) struct WorkRegisters<S: Register> {
    /// Whether `before` is stored.
    split: bool,
    both: [Wide<S>; 4],
    before: [Wide<S>; 4],
}

impl<S: Register> WorkRegisters<S> {
    #[inline(always)]
    pub(crate) fn new(work: &WorkDone, split: bool) -> Self {
        Self {
            split,
            both: [
                Wide::load(&work.total.both),
                Wide::load(&work.drag.both),
                Wide::load(&work.damping.both),
                Wide::load(&work.tension.both),
            ],
            before: [Wide::zero(); 4],
        }
    }

    /// Adds `F·(v_before + v_after)` of all forces, of the drag, and of the damping if there is any.
    #[inline(always)]
    pub(crate) fn enter(&mut self, kick: &Kick<S>) {
        let velocities = kick.before + kick.after;
        self.add_to(0, kick.force, kick.before, velocities);
        self.add_to(1, kick.drag, kick.before, velocities);
        if let Some(damping) = kick.damping {
            self.add_to(2, damping, kick.before, velocities);
        }
    }

    /// Adds `F·(v_before + v_after)` of the implicit tension.
    #[inline(always)]
    pub(crate) fn enter_tension(&mut self, tension: Vec3<Wide<S>>, kick: &Kick<S>) {
        self.add_to(3, tension, kick.before, kick.before + kick.after);
    }

    #[inline(always)]
    fn add_to(&mut self, i: usize, force: Vec3<Wide<S>>, before: Vec3<Wide<S>>, velocities: Vec3<Wide<S>>) {
        self.both[i] = force.dot_add(velocities, self.both[i]);
        if self.split {
            self.before[i] = force.dot_add(before, self.before[i]);
        }
    }

    #[inline(always)]
    pub(crate) fn put(self, work: &mut WorkDone) {
        work.total = WorkSum { both: self.both[0].store(), before: self.before[0].store() };
        work.drag = WorkSum { both: self.both[1].store(), before: self.before[1].store() };
        work.damping = WorkSum { both: self.both[2].store(), before: self.before[2].store() };
        work.tension = WorkSum { both: self.both[3].store(), before: self.before[3].store() };
    }
}

/// The charge of eight fibres in a field along the machine direction.
#[derive(Clone, Debug)]
pub(crate) struct Charged {
    /// The field.
    pub(crate) field: Arc<SheetField>,
    /// Charge per mass [C/kg].
    pub(crate) per_mass: f64,
    /// Where the inlets of the fibres are in the field, in machine direction [m].
    pub(crate) inlets: Lanes,
    /// Force on each node along the machine direction, in the step that is made [N].
    force: Vec<Lanes>,
}

impl Charged {
    pub(crate) fn new(field: Arc<SheetField>, per_mass: f64, inlets: Lanes) -> Self {
        Self { field, per_mass, inlets, force: Vec::new() }
    }

    /// Adds the force on a node in the step that is made.
    #[inline(always)]
    pub(super) fn push<S: Register>(&self, node: usize, force: &mut Vec3<Wide<S>>) {
        force.y += Wide::load(&self.force[node]);
    }
}

impl Chain {
    /// Finds the force of the field on all nodes where they are now, and enters its work with their velocities
    /// before the step.
    #[inline(never)]
    pub(crate) fn feel_field(&mut self, work: &mut WorkDone) {
        let Self { position, constants: c, charged: Some(charged), .. } = self else { return };
        let nodes = position.len();
        let Charged { field, per_mass, inlets, force } = charged;
        force.clear();
        force.extend(position.iter().enumerate().map(|(i, at)| {
            let mass = &c.node(i, nodes).mass;
            let on_lane = |lane: usize| {
                let strength = field.at(at.x.0[lane], at.y.0[lane] + inlets.0[lane]);
                *per_mass * mass.0[lane] * strength
            };
            Lanes::from_fn(on_lane)
        }));
        work.field.before = self.power_of_field();
        work.field.both = work.field.both + work.field.before;
    }

    /// Enters the work of the field with the velocities after the step.
    #[inline(never)]
    pub(crate) fn enter_field(&self, work: &mut WorkDone) {
        work.field.both = work.field.both + self.power_of_field();
    }

    /// `Σ F·v` of the field, with the velocities as they are, seen from the belt [W].
    fn power_of_field(&self) -> Lanes {
        let Self { velocity, constants: c, charged: Some(Charged { force, .. }), .. } = self else {
            return Lanes::ZERO;
        };
        Lanes::from_fn(|lane| {
            let speed = |v: &Vec3<Lanes>| v.y.0[lane] - c.frame.0[lane];
            force.iter().zip(velocity.iter()).map(|(force, v)| force.0[lane] * speed(v)).sum()
        })
    }
}
