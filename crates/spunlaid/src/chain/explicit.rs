//! The explicit time-integration schemes: semi-implicit Euler and leapfrog.

use super::force_pass::{ElementBlock, Integrator, force_pass};
use super::forces::Element;
use super::work::{WorkDone, WorkRegisters};
use super::{Chain, Constants};
use crate::air::AirAtElements;
use crate::lanes::{Lanes, Register, Wide};
use crate::vec3::Vec3;

/// Advances eight chains by one step. The velocities change by `kick` [s] times the acceleration, then the
/// positions change by `drift` [s] times the velocity.
///
/// * `wind` – the air at the time of the positions
/// * `eddy` – index into the wind for each of the `N` elements
/// * `work` – sums of the work to which the step adds
/// * `damped` – whether there is any damping
/// * `split` – whether to store separately the work that belongs to the velocities before the kick
#[inline(always)]
pub(crate) fn step<S: Register, const LEAPFROG: bool>(
    chain: &mut Chain,
    wind: impl AirAtElements<S>,
    eddy: &[u32],
    (kick, drift): (f64, f64),
    (damped, split): (bool, bool),
    work: &mut WorkDone,
    block: &mut ElementBlock<S>,
) {
    let elements = chain.elements();
    let Chain { position, velocity, earlier, constants: c, .. } = chain;
    let mut integrator = ExplicitIntegrator::<S, LEAPFROG> {
        damped,
        position: &mut position[..=elements],
        velocity: &mut velocity[..=elements],
        earlier: &mut earlier[..=elements],
        c,
        kick: Wide::splat(kick),
        drift: Wide::splat(drift),
        work: WorkRegisters::of(work, split),
    };
    force_pass(&mut integrator, c, wind, eddy, block);
    integrator.work.put(work);
}

/// Moves each node as soon as its force is complete, and adds up the work.
struct ExplicitIntegrator<'a, S: Register, const LEAPFROG: bool> {
    damped: bool,
    position: &'a mut [Vec3<Lanes>],
    velocity: &'a mut [Vec3<Lanes>],
    earlier: &'a mut [Vec3<Lanes>],
    c: &'a Constants,
    kick: Wide<S>,
    drift: Wide<S>,
    work: WorkRegisters<S>,
}

impl<S: Register, const LEAPFROG: bool> Integrator<S> for ExplicitIntegrator<'_, S, LEAPFROG> {
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
    fn tension(&mut self, _: usize, element: &Element<S>) -> Wide<S> {
        element.tension(Wide::load(&self.c.axial_stiffness), Wide::load(&self.c.rest_length))
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
        let after = force.mul_add(self.kick * Wide::load(&node.inverse_mass), before);
        self.work.add([force, drag], damping, before, after);
        if LEAPFROG {
            self.earlier[i] = before.store();
        }
        self.velocity[i] = after.store();
        let position = Vec3::load(&self.position[i]);
        self.position[i] = after.mul_add(self.drift, position).store();
    }
}
