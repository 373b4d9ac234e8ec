//! Time integration: one sweep along the chain per step.

use super::forces::{Element, bending};
use super::{Chain, Constants};
use crate::energy::Work;
use crate::lanes::{Lanes, one_at_a_time};
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
///
/// One pass from the root: element `j` yields its tension and drag, and with the element above the
/// bending of the node between them; that completes the force on node `j−1`, which moves on at once.
#[inline(always)]
pub(crate) fn step<const LEAPFROG: bool, const DAMPED: bool>(
    chain: &mut Chain,
    wind: &[Vec3<Lanes>],
    eddy: &[u32],
    kick: Lanes,
    drift: Lanes,
    work: &mut Work,
) {
    let c = chain.constants;
    let half = Lanes::splat(0.5);
    let elements = chain.elements();
    // A copy, so that its sums stay in registers.
    let mut sums = *work;
    let mut mover = Mover::<LEAPFROG, DAMPED> { chain, c: &c, kick, drift, work: &mut sums };

    let mut above = Element { tangent: c.root_direction, inverse_length: Lanes::ZERO, length: Lanes::ZERO };
    let mut stiffness = c.root_stiffness;
    let mut upper = (mover.chain.position[0], mover.drag_velocity(0));
    // Forces so far on nodes j−1 and j: internal, and of the air.
    let (mut force, mut force_above) = (Vec3::ZERO, Vec3::ZERO);
    let (mut drag, mut drag_above) = (Vec3::ZERO, Vec3::ZERO);
    // The node above the element: the root first, then one of those between.
    let (mut mass_above, mut inverse_mass_above) = (c.mass * half, c.root_inverse_mass);
    for j in 0..elements {
        one_at_a_time();
        let lower = (mover.chain.position[j + 1], mover.drag_velocity(j + 1));
        let element = Element::between(upper.0, lower.0);
        let pull = element.tangent * element.tension(c.axial_stiffness, c.rest_length);
        let (a, b) = bending(&above, &element, stiffness);
        let relative = (upper.1 + lower.1).mul_add(-half, wind[eddy[j] as usize]);
        let drag_half = c.drag.force(relative, element.tangent) * half;

        if j > 0 {
            mover.advance(j - 1, force_above - a, drag_above, mass_above, inverse_mass_above);
            (mass_above, inverse_mass_above) = if j == 1 { (c.mass, c.inverse_mass) } else { (mass_above, inverse_mass_above) };
        }
        (force_above, force) = (force + a + b + pull, -(b + pull));
        (drag_above, drag) = (drag + drag_half, drag_half);
        above = element;
        stiffness = c.bending_stiffness;
        upper = lower;
    }
    mover.advance(elements - 1, force_above, drag_above, mass_above, inverse_mass_above);
    mover.advance(elements, force, drag, c.mass * half, c.inverse_mass * 2.0);
    *work = sums;
}

/// Moves nodes on and keeps the ledger.
struct Mover<'a, const LEAPFROG: bool, const DAMPED: bool> {
    chain: &'a mut Chain,
    c: &'a Constants,
    kick: Lanes,
    drift: Lanes,
    work: &'a mut Work,
}

impl<const LEAPFROG: bool, const DAMPED: bool> Mover<'_, LEAPFROG, DAMPED> {
    /// Velocity of node `i` that drag and damping see.
    #[inline(always)]
    fn drag_velocity(&self, i: usize) -> Vec3<Lanes> {
        let v = self.chain.velocity[i];
        if LEAPFROG {
            // From half steps k−3/2 and k−1/2 to the full step k.
            (v - self.chain.earlier[i]).mul_add(Lanes::splat(0.5), v)
        } else {
            v
        }
    }

    #[inline(always)]
    fn advance(&mut self, i: usize, internal: Vec3<Lanes>, drag: Vec3<Lanes>, mass: Lanes, inverse_mass: Lanes) {
        let before = self.chain.velocity[i];
        let mut force = internal + drag;
        force.x = mass.mul_add(self.c.gravity, force.x);
        let damping = if DAMPED { self.drag_velocity(i) * -(mass * self.c.damping) } else { Vec3::ZERO };
        if DAMPED {
            force += damping;
        }
        let after = force.mul_add(self.kick * inverse_mass, before);
        self.work.total.add(force, before, after);
        self.work.drag.add(drag, before, after);
        if DAMPED {
            self.work.damping.add(damping, before, after);
        }
        if LEAPFROG {
            self.chain.earlier[i] = before;
        }
        self.chain.velocity[i] = after;
        self.chain.position[i] = after.mul_add(self.drift, self.chain.position[i]);
    }
}
