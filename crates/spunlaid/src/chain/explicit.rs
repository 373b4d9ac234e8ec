//! The explicit time-integration schemes: semi-implicit Euler and leapfrog.

use super::Chain;
use super::constants::{Constants, Node};
use super::force_pass::{ElementBlock, Integrator, force_pass};
use super::forces::Element;
use super::laying::Laying;
use super::work::{Supports, WorkDone, WorkRegisters};
use crate::air::Atmosphere;
use crate::lanes::{Lanes, Register, Wide};
use crate::vec3::Vec3;

/// Advances eight chains by one step. The velocities change by `kick` [s] times the acceleration, then the
/// positions change by `drift` [s] times the velocity.
///
/// * `air` – at the time of the positions
/// * `work` – sums of the work to which the step adds
/// * `damped` – whether there is any damping
/// * `split` – whether to store separately the work that belongs to the velocities before the kick
#[inline(always)]
pub(crate) fn step<S: Register, const LEAPFROG: bool, const FED: bool>(
    chain: &mut Chain,
    air: &Atmosphere,
    (kick, drift): (f64, f64),
    (damped, split): (bool, bool),
    work: &mut WorkDone,
    block: &mut ElementBlock<S>,
) {
    let elements = chain.elements();
    let Chain { position, velocity, earlier, constants: c, laying, .. } = chain;
    let mut integrator = ExplicitIntegrator::<S, LEAPFROG, FED> {
        damped,
        laying: if FED { laying.as_mut() } else { None },
        step: drift,
        supports: Supports::of(work),
        position: &mut position[..=elements],
        velocity: &mut velocity[..=elements],
        earlier: &mut earlier[..=elements],
        c,
        kick: Wide::splat(kick),
        drift: Wide::splat(drift),
        work: WorkRegisters::of(work, split),
        dissipation: Wide::zero(),
    };
    force_pass(&mut integrator, c, air, elements, block);
    let (supports, dissipation) = (integrator.supports, integrator.dissipation);
    integrator.work.put(work);
    supports.put(work);
    work.dissipate(dissipation, c, drift);
}

/// Moves each node as soon as its force is complete, and adds up the work.
struct ExplicitIntegrator<'a, S: Register, const LEAPFROG: bool, const FED: bool> {
    damped: bool,
    laying: Option<&'a mut Laying>,
    /// The length of the drift [s].
    step: f64,
    supports: Supports,
    position: &'a mut [Vec3<Lanes>],
    velocity: &'a mut [Vec3<Lanes>],
    earlier: &'a mut [Vec3<Lanes>],
    c: &'a Constants,
    kick: Wide<S>,
    drift: Wide<S>,
    work: WorkRegisters<S>,
    /// Power that the bending viscosity dissipates [W].
    dissipation: Wide<S>,
}

impl<S: Register, const LEAPFROG: bool, const FED: bool> Integrator<S>
    for ExplicitIntegrator<'_, S, LEAPFROG, FED>
{
    #[inline(always)]
    fn position(&self, i: usize) -> Vec3<Wide<S>> {
        Vec3::load(&self.position[i])
    }

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
    fn tension(&mut self, j: usize, element: &Element<S>) -> Wide<S> {
        let c = self.c.elements.at(j);
        element.tension(Wide::load(&c.axial_stiffness), Wide::load(&c.rest_length))
    }

    #[inline(always)]
    fn dissipated(&mut self, power: Wide<S>) {
        self.dissipation = power;
    }

    #[inline(always)]
    fn node(&mut self, i: usize, force: Vec3<Wide<S>>, drag: Vec3<Wide<S>>) {
        let node = self.c.node(i, self.position.len());
        let before = Vec3::load(&self.velocity[i]);
        let mut force = force;
        force.x += Wide::load(&node.weight);
        let mut damping = None;
        if self.damped {
            let slowed = self.drag_velocity(i) * -(Wide::load(&node.mass) * Wide::load(&self.c.damping));
            force += slowed;
            damping = Some(slowed);
        }
        let mut after = force.mul_add(self.kick * Wide::load(&node.inverse_mass), before);
        if FED {
            after = self.supported(i, node, &mut force, before, after);
            let frame = Wide::load(&self.c.frame);
            self.work.add([force, drag], damping, before.less_y(frame), after.less_y(frame));
        } else {
            self.work.add([force, drag], damping, before, after);
        }
        if LEAPFROG {
            self.earlier[i] = before.store();
        }
        self.velocity[i] = after.store();
        let position = Vec3::load(&self.position[i]);
        self.position[i] = after.mul_add(self.drift, position).store();
    }
}

impl<S: Register, const LEAPFROG: bool, const FED: bool> ExplicitIntegrator<'_, S, LEAPFROG, FED> {
    /// Lets a node land if it reaches the belt, and adds what holds it to the force on it. Returns its velocity.
    #[inline(always)]
    fn supported(
        &mut self,
        i: usize,
        node: &Node,
        force: &mut Vec3<Wide<S>>,
        before: Vec3<Wide<S>>,
        mut after: Vec3<Wide<S>>,
    ) -> Vec3<Wide<S>> {
        let mut free = Wide::load(&node.inverse_mass);
        let mut held = self.c.may_be_held(i, self.position.len());
        if let Some(laying) = &mut self.laying
            && laying.reached(Wide::load(&self.position[i].x), after.x, self.drift)
        {
            let mut landing = after.store();
            let others = laying.land(i, &self.position[i], &mut landing, self.step);
            (after, free) = (Vec3::load(&landing), free * Wide::load(&others));
            held = true;
        }
        if held {
            let rate = Wide::load(&node.mass).over(self.kick);
            let support =
                self.supports.add(i, free, (after - before) * rate - *force, [before, after], self.c);
            *force += support;
        }
        after
    }
}
