//! The forces with the tensions of the last step, and the system of the accelerations.

use super::Tensions;
use crate::chain::constants::{Constants, ElementConstants, Node};
use crate::chain::forces::{Element, Integrator};
use crate::chain::work::Charged;
use spunlaid_ground::{Lanes, Register, Vec3, Wide};

/// Largest `s = h²λ/(ℓm)` of a tension `λ` that the predictor takes from the last step [-]: of fibres of
/// fixed length the one that belongs to the limit of (55), of fed fibres, which fold, less. Pulling along the
/// direction of the last step, more than this would throw nodes about where a fibre folds and whips. What is
/// left out is found again by the correction, which pulls along the predicted directions.       theory.md (51)
const MOST_KEPT: f64 = 2.25;
const MOST_KEPT_FED: f64 = 0.5;

/// The largest tension that the predictor takes from the last step, for a mass and a length of one [N].
#[inline(always)]
pub(super) fn most_kept<S: Register, const FED: bool>(h: f64) -> Wide<S> {
    let most = if FED { MOST_KEPT_FED } else { MOST_KEPT };
    Wide::splat(most / (h * h))
}

/// Stores the forces with the tensions of the last step, and eliminates `(M + K') a = F` from the root to the
/// free end. `K'` is the share of the string's stiffness that the averaging adds to the mass.
pub(super) struct Predictor<'a, S: Register> {
    pub(super) damped: bool,
    pub(super) charged: Option<&'a Charged>,
    pub(super) position: &'a [Vec3<Lanes>],
    pub(super) velocity: &'a [Vec3<Lanes>],
    pub(super) earlier: &'a [Vec3<Lanes>],
    pub(super) c: &'a Constants,
    /// The time step [s].
    pub(super) h: f64,
    /// `h²` [s²].
    pub(super) h_squared: Wide<S>,
    /// Largest tension that is taken from the last step, for a mass and a length of one [N].
    pub(super) most_kept: Wide<S>,
    pub(super) t: &'a mut Tensions,
    /// `½ m s²/(1+s)` of the elements above and below the next node; zero in compression.
    pub(super) string: (Wide<S>, Wide<S>),
    /// That of the element after them: its tension is found before the forces on the node are whole.
    pub(super) next_string: Wide<S>,
    /// The row of the node above: its acceleration minus `.1` times that of the next node.
    pub(super) above: (Vec3<Wide<S>>, Wide<S>),
    /// Power that the bending viscosity dissipates [W].
    pub(super) dissipation: Wide<S>,
}

impl<S: Register> Integrator<S> for Predictor<'_, S> {
    #[inline(always)]
    fn position(&self, i: usize) -> Vec3<Wide<S>> {
        Vec3::load(&self.position[i])
    }

    #[inline(always)]
    fn drag_velocity(&self, i: usize) -> Vec3<Wide<S>> {
        let v = Vec3::load(&self.velocity[i]);
        (v - Vec3::load(&self.earlier[i])).mul_add(Wide::splat(0.5), v)
    }

    #[inline(always)]
    fn tension(&mut self, j: usize, c: &ElementConstants, element: &Element<S>) -> Wide<S> {
        let mass = Wide::load(&c.mass);
        // Without the compression, the prediction does not fold elements that the correction has to unfold.
        let tension = Wide::load(&self.t.tension[j]).max(Wide::zero());
        let most_kept = Wide::load(&c.rest_length) * mass * self.most_kept;
        let tension = Wide::select_less(most_kept, tension, most_kept, tension);
        self.t.tension[j] = tension.store();
        self.t.links[j].tangent = element.tangent.store();
        let s = self.h_squared * Wide::load(&c.inverse_mass) * tension * element.inverse_length;
        let share = (s * s).over(s + Wide::splat(1.0)) * Wide::splat(0.5);
        self.string.1 = self.next_string;
        self.next_string = share * mass;
        tension
    }

    #[inline(always)]
    fn dissipated(&mut self, power: Wide<S>) {
        self.dissipation = power;
    }

    #[inline(always)]
    fn node(&mut self, i: usize, force: Vec3<Wide<S>>, drag: Vec3<Wide<S>>) {
        let nodes = self.position.len();
        let node = self.c.node(i, nodes);
        let mut force = force;
        force.x += Wide::load(&node.weight);
        if let Some(charged) = self.charged {
            charged.push(i, &mut force);
        }
        if self.damped {
            let damping = Wide::load(&node.mass) * Wide::load(&self.c.damping);
            force = self.drag_velocity(i).neg_mul_add(damping, force);
        }
        if i > 0 && self.c.friction.is_some() && self.c.may_be_held(i, nodes) {
            self.friction(i, node, &force.x.store());
            force += Vec3 { x: Wide::zero(), ..Vec3::load(&self.t.belt_force[i]) };
        }
        // No element is visited after the node above the free end, and the free end has none below it.
        if i + 2 >= nodes {
            self.string.1 = self.next_string;
            self.next_string = Wide::zero();
        }
        let inverse_mass = Wide::load(&node.inverse_mass);
        let above = inverse_mass * self.string.0;
        let below = inverse_mass * self.string.1;
        let here = Wide::splat(1.0) + above + below;
        let pivot = Wide::splat(1.0).over(above.neg_mul_add(self.above.1, here));
        let acceleration = self.above.0.mul_add(above, force * inverse_mass) * pivot;
        let slope = below * pivot;
        let link = &mut self.t.links[i];
        (link.force, link.drag) = (force.store(), drag.store());
        (link.acceleration, link.slope) = (acceleration.store(), slope.store());
        self.above = (acceleration, slope);
        self.string.0 = self.string.1;
    }
}

impl<S: Register> Predictor<'_, S> {
    /// Finds the friction on a node that slides on the belt. Its numbers are in memory: a function of its own is not
    /// compiled for the instruction set.
    ///
    /// * `pull` – force of the chain and of gravity on to the belt [N]
    #[cold]
    #[inline(never)]
    fn friction(&mut self, i: usize, node: &Node, pull: &Lanes) {
        if let Some(friction) = &self.c.friction {
            self.t.belt_force[i] = friction.on(node, &self.velocity[i], &self.c.frame, pull, self.h);
        }
    }
}
