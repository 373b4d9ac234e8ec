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

use super::force_pass::{ElementBlock, Integrator, force_pass};
use super::forces::Element;
use super::work::{WorkDone, WorkRegisters};
use super::{Chain, Constants};
use crate::air::AirAtElements;
use crate::lanes::{Lanes, Register, Wide};
use crate::vec3::Vec3;

/// What the scheme stores besides positions and velocities.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tensions {
    /// For each element: tension `λ` [N], and its tangent at the start of the step. There is one more entry
    /// than elements; the last tangent is zero and ends the chain.
    pub(crate) tension: Vec<Lanes>,
    tangent: Vec<Vec3<Lanes>>,
    /// For each node: force with the tensions of the last step, and the drag in it [N].
    force: Vec<Vec3<Lanes>>,
    drag: Vec<Vec3<Lanes>>,
    /// For each node: acceleration [m/s²] minus `slope` times that of the next node; later the predicted velocity.
    acceleration: Vec<Vec3<Lanes>>,
    slope: Vec<Lanes>,
    /// For each element: correction of the tension [N] minus `.1` times that of the element above.
    correction: Vec<(Lanes, Lanes)>,
}

impl Tensions {
    pub(crate) fn new(elements: usize) -> Self {
        let nodes = elements + 1;
        Self {
            tension: vec![Lanes::ZERO; nodes],
            tangent: vec![Vec3::ZERO; nodes],
            force: vec![Vec3::ZERO; nodes],
            drag: vec![Vec3::ZERO; nodes],
            acceleration: vec![Vec3::ZERO; nodes],
            slope: vec![Lanes::ZERO; nodes],
            correction: vec![Default::default(); elements],
        }
    }
}

/// Advances eight chains by one step of `h` [s]. The arguments are those of the explicit step.
#[inline(always)]
pub(crate) fn step<S: Register>(
    chain: &mut Chain,
    wind: impl AirAtElements<S>,
    eddy: &[u32],
    h: f64,
    (damped, split): (bool, bool),
    work: &mut WorkDone,
    block: &mut ElementBlock<S>,
) {
    let c = &chain.constants;
    let mut predictor = Predictor::<S> {
        damped,
        position: &chain.position,
        velocity: &chain.velocity,
        earlier: &chain.earlier,
        c,
        rate: Wide::splat(h * h) * Wide::load(&c.node.inverse_mass),
        t: &mut chain.tensions,
        string: (Wide::zero(), Wide::zero()),
        above: (Vec3::zero(), Wide::zero()),
    };
    force_pass(&mut predictor, c, wind, eddy, block);
    predict_and_eliminate::<S>(&chain.position, &chain.velocity, c, h, &mut chain.tensions);
    let mut sums = WorkRegisters::of(work, split);
    correct_and_move::<S>(chain, h, damped, &mut sums);
    sums.put(work);
}

/// Stores the forces with the tensions of the last step, and eliminates `(M + K') a = F` from the root to the
/// free end. `K'` is the share of the string's stiffness that the averaging adds to the mass.
struct Predictor<'a, S: Register> {
    damped: bool,
    position: &'a [Vec3<Lanes>],
    velocity: &'a [Vec3<Lanes>],
    earlier: &'a [Vec3<Lanes>],
    c: &'a Constants,
    /// `h²/m` of a node between elements.
    rate: Wide<S>,
    t: &'a mut Tensions,
    /// `½ m s²/(1+s)` of the elements above and below the next node; zero in compression.
    string: (Wide<S>, Wide<S>),
    /// The row of the node above: its acceleration minus `.1` times that of the next node.
    above: (Vec3<Wide<S>>, Wide<S>),
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
    fn tension(&mut self, j: usize, element: &Element<S>) -> Wide<S> {
        let tension = Wide::load(&self.t.tension[j]);
        self.t.tangent[j] = element.tangent.store();
        let s = self.rate * tension.max(Wide::zero()) * element.inverse_length;
        let share = (s * s).over(s + Wide::splat(1.0)) * Wide::splat(0.5);
        self.string.1 = share * Wide::load(&self.c.node.mass);
        tension
    }

    #[inline(always)]
    fn node(&mut self, i: usize, force: Vec3<Wide<S>>, drag: Vec3<Wide<S>>) {
        let nodes = self.position.len();
        let node = self.c.node(i, nodes);
        let mut force = force;
        force.x += Wide::load(&node.weight);
        if self.damped {
            let damping = Wide::load(&node.mass) * Wide::load(&self.c.damping);
            force = self.drag_velocity(i).neg_mul_add(damping, force);
        }
        self.t.force[i] = force.store();
        self.t.drag[i] = drag.store();

        if i + 1 == nodes {
            self.string.1 = Wide::zero();
        }
        let inverse_mass = Wide::load(&node.inverse_mass);
        let above = inverse_mass * self.string.0;
        let below = inverse_mass * self.string.1;
        let here = Wide::splat(1.0) + above + below;
        let pivot = Wide::splat(1.0).over(above.neg_mul_add(self.above.1, here));
        let acceleration = self.above.0.mul_add(above, force * inverse_mass) * pivot;
        let slope = below * pivot;
        self.t.acceleration[i] = acceleration.store();
        self.t.slope[i] = slope.store();
        self.above = (acceleration, slope);
        self.string.0 = self.string.1;
    }
}

/// From the free end to the root: replaces the accelerations by the predicted velocities, and eliminates the
/// rows `(λ+δ)/k_a = ℓ_{k+1} − l`.
///
/// Let `d` be the predicted edge, `d̂` its direction and `w = h²k_a/m` of a node. Row `j` is
/// `−w_j d̂·t_{j−1} δ_{j−1} + (1 + (w_j + w_{j+1}) d̂·t_j) δ_j − w_{j+1} d̂·t_{j+1} δ_{j+1} =
/// k_a (|d| − l) − λ`.
#[inline(always)]
fn predict_and_eliminate<S: Register>(
    position: &[Vec3<Lanes>],
    velocity: &[Vec3<Lanes>],
    c: &Constants,
    h: f64,
    t: &mut Tensions,
) {
    let elements = position.len() - 1;
    let h = Wide::<S>::splat(h);
    let (stiffness, rest_length) = (Wide::load(&c.axial_stiffness), Wide::load(&c.rest_length));
    let scale = h * h * stiffness;
    let one = Wide::splat(1.0);
    let mut acceleration = Vec3::load(&t.acceleration[elements]);
    let predicted = acceleration.mul_add(h, Vec3::load(&velocity[elements]));
    t.acceleration[elements] = predicted.store();
    let mut lower = (Vec3::load(&position[elements]), predicted);
    let mut weight_below = scale * Wide::load(&c.end.inverse_mass);
    let (mut tangent_below, mut tangent) = (Vec3::zero(), Vec3::load(&t.tangent[elements - 1]));
    let (mut value, mut slope) = (Wide::zero(), Wide::zero());
    for j in (0..elements).rev() {
        acceleration = acceleration.mul_add(Wide::load(&t.slope[j]), Vec3::load(&t.acceleration[j]));
        let predicted = acceleration.mul_add(h, Vec3::load(&velocity[j]));
        t.acceleration[j] = predicted.store();
        let upper = (Vec3::load(&position[j]), predicted);
        let weight_above = scale * Wide::load(&c.node(j, elements + 1).inverse_mass);
        let tangent_above = if j > 0 { Vec3::load(&t.tangent[j - 1]) } else { Vec3::zero() };

        let edge = (lower.1 - upper.1).mul_add(h, lower.0 - upper.0);
        let length = edge.dot(edge).sqrt();
        let direction = edge * one.over(length);
        let above = -(weight_above * direction.dot(tangent_above));
        let here = (weight_above + weight_below).mul_add(direction.dot(tangent), one);
        let below = -(weight_below * direction.dot(tangent_below));
        let wanted = stiffness * (length - rest_length) - Wide::load(&t.tension[j]);
        let pivot = one.over(below.neg_mul_add(slope, here));
        value = below.neg_mul_add(value, wanted) * pivot;
        slope = above * pivot;
        t.correction[j] = (value.store(), slope.store());
        (lower, weight_below) = (upper, weight_above);
        (tangent_below, tangent) = (tangent, tangent_above);
    }
}

/// From the root to the free end: corrects the tensions and moves the nodes.
#[inline(always)]
fn correct_and_move<S: Register>(chain: &mut Chain, h: f64, damped: bool, sums: &mut WorkRegisters<S>) {
    let elements = chain.elements();
    let Chain { position, velocity, earlier, constants: c, tensions: t } = chain;
    let (rate, h) = (Wide::<S>::splat(1.0 / h), Wide::<S>::splat(h));
    let mut correction = Wide::zero();
    // Forces of the element above: from the correction of its tension, and from its last tension.
    let (mut change_above, mut pull_above) = (Vec3::zero(), Vec3::zero());
    for i in 0..=elements {
        let (mut change, mut pull) = (Vec3::zero(), Vec3::zero());
        if i < elements {
            let (value, slope) = &t.correction[i];
            correction = Wide::load(slope).neg_mul_add(correction, Wide::load(value));
            let tension = Wide::load(&t.tension[i]);
            let tangent = Vec3::load(&t.tangent[i]);
            (change, pull) = (tangent * correction, tangent * tension);
            t.tension[i] = (tension + correction).store();
        }
        let node = c.node(i, elements + 1);
        let before = Vec3::load(&velocity[i]);
        let kick = h * Wide::load(&node.inverse_mass);
        let after = (change - change_above).mul_add(kick, Vec3::load(&t.acceleration[i]));
        // The force that moved the node. What the other forces do not explain is the tension.
        let force = (after - before) * (Wide::load(&node.mass) * rate);
        let tension = force - Vec3::load(&t.force[i]) + (pull - pull_above);
        let mut damping = None;
        if damped {
            let v = (before - Vec3::load(&earlier[i])).mul_add(Wide::splat(0.5), before);
            damping = Some(v * -(Wide::load(&node.mass) * Wide::load(&c.damping)));
        }
        sums.add([force, Vec3::load(&t.drag[i])], damping, before, after);
        sums.add_tension(tension, before, after);
        earlier[i] = before.store();
        velocity[i] = after.store();
        position[i] = after.mul_add(h, Vec3::load(&position[i])).store();
        (change_above, pull_above) = (change, pull);
    }
}
