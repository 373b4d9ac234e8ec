//! The explicit time-integration schemes: semi-implicit Euler and leapfrog.
//!
//! ```text
//! forces   along the chain, from the air and from the elements
//! kick     v ← v + h F/m                                  as soon as the force on a node is complete, it goes through
//! hold     the inlet drives the root; what lands is held  the rest of the step, with its numbers still in registers
//! enter    the work of the forces, into the ledgers
//! drift    r ← r + h v
//! ```

use super::constants::{Constants, ElementConstants};
use super::forces::{Element, ElementBlock, Integrator, force_pass};
use super::laying::LayingState;
use super::work::{Charged, Kick, Supports, WorkDone, WorkRegisters};
use super::{Chain, Stride};
use spunlaid_air::Velocities;
use spunlaid_ground::{Lanes, Register, Vec3, Wide};

/// Advances eight chains by one step.
///
/// * `air` – the velocities at the time of the positions
/// * `work` – sums of the work to which the step adds
#[inline(always)]
pub(crate) fn step<S: Register, const LEAPFROG: bool, const FED: bool>(
    chain: &mut Chain,
    air: &Velocities<'_, S>,
    Stride { kick, drift, damped, split }: Stride,
    work: &mut WorkDone,
    block: &mut ElementBlock<S>,
) {
    let elements = chain.elements();
    let Chain { position, velocity, earlier, constants: c, laying, charged, .. } = chain;
    let mut integrator = ExplicitIntegrator::<S, LEAPFROG, FED> {
        damped,
        charged: charged.as_ref(),
        laying: if FED { laying.as_mut() } else { None },
        step: drift,
        supports: Supports::start(work),
        position: &mut position[..=elements],
        velocity: &mut velocity[..=elements],
        earlier: &mut earlier[..=elements],
        c,
        kick: Wide::splat(kick),
        drift: Wide::splat(drift),
        work: WorkRegisters::new(work, split),
        dissipation: Wide::zero(),
    };
    force_pass(&mut integrator, c, air, elements, block);
    let (supports, dissipation) = (integrator.supports, integrator.dissipation);
    integrator.work.put(work);
    supports.put(work);
    work.dissipate(dissipation, c, drift);
}

/// The nodes on their way through the step.
struct ExplicitIntegrator<'a, S: Register, const LEAPFROG: bool, const FED: bool> {
    damped: bool,
    charged: Option<&'a Charged>,
    laying: Option<&'a mut LayingState>,
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
    fn tension(&mut self, _: usize, c: &ElementConstants, element: &Element<S>) -> Wide<S> {
        element.tension(Wide::load(&c.axial_stiffness), Wide::load(&c.rest_length))
    }

    #[inline(always)]
    fn dissipated(&mut self, power: Wide<S>) {
        self.dissipation = power;
    }

    #[inline(always)]
    fn node(&mut self, i: usize, force: Vec3<Wide<S>>, drag: Vec3<Wide<S>>) {
        let mut kick = self.kick(i, force, drag);
        if FED {
            self.hold(i, &mut kick);
        }
        self.enter(&kick);
        self.drift(i, &kick);
    }
}

impl<S: Register, const LEAPFROG: bool, const FED: bool> ExplicitIntegrator<'_, S, LEAPFROG, FED> {
    /// The kick of a node by the forces of the chain and the air, its weight and the damping.
    #[inline(always)]
    fn kick(&self, i: usize, force: Vec3<Wide<S>>, drag: Vec3<Wide<S>>) -> Kick<S> {
        let node = self.c.node(i, self.position.len());
        let before = Vec3::load(&self.velocity[i]);
        let mut force = force;
        force.x += Wide::load(&node.weight);
        if let Some(charged) = self.charged {
            charged.push(i, &mut force);
        }
        let mut damping = None;
        if self.damped {
            let slowing = self.drag_velocity(i) * -(Wide::load(&node.mass) * Wide::load(&self.c.damping));
            force += slowing;
            damping = Some(slowing);
        }
        let after = force.mul_add(self.kick * Wide::load(&node.inverse_mass), before);
        Kick { force, drag, damping, before, after }
    }

    /// Lets a node land if it reaches the belt, and adds what holds it to the forces on it.
    #[inline(always)]
    fn hold(&mut self, i: usize, kick: &mut Kick<S>) {
        let node = self.c.node(i, self.position.len());
        let mut free = Wide::load(&node.inverse_mass);
        let mut held = self.c.may_be_held(i, self.position.len());
        if let Some(laying) = &mut self.laying
            && laying.reached(Wide::load(&self.position[i].x), kick.after.x, self.drift)
        {
            let mut landing = kick.after.store();
            let others = laying.land(i, &self.position[i], &mut landing, self.step);
            (kick.after, free) = (Vec3::load(&landing), free * Wide::load(&others));
            held = true;
        }
        if held {
            let rate = Wide::load(&node.mass).over(self.kick);
            let missing = (kick.after - kick.before) * rate - kick.force;
            kick.force += self.supports.add(i, free, missing, kick.velocities(), self.c);
        }
    }

    /// Enters the work of the forces.
    #[inline(always)]
    fn enter(&mut self, kick: &Kick<S>) {
        if FED {
            self.work.enter(&kick.seen_from(&self.c.frame));
        } else {
            self.work.enter(kick);
        }
    }

    /// Moves the node on.
    #[inline(always)]
    fn drift(&mut self, i: usize, kick: &Kick<S>) {
        if LEAPFROG {
            self.earlier[i] = kick.before.store();
        }
        self.velocity[i] = kick.after.store();
        let position = Vec3::load(&self.position[i]);
        self.position[i] = kick.after.mul_add(self.drift, position).store();
    }
}
