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
use super::work::{Supports, WorkDone, WorkRegisters};
use super::{Chain, Constants, Node};
use crate::air::AirAtElements;
use crate::lanes::{Lanes, Register, WIDTH, Wide};
use crate::nodes::Nodes;
use crate::vec3::Vec3;

/// What the scheme stores besides positions and velocities.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tensions {
    /// Of each element: tension `λ` [N].
    pub(crate) tension: Nodes<Lanes>,
    /// For each element: its direction at the start of the step, and its predicted direction at the end.
    tangent: Vec<Vec3<Lanes>>,
    direction: Vec<Vec3<Lanes>>,
    /// For each node: force with the tensions of the last step, and the drag in it [N].
    force: Vec<Vec3<Lanes>>,
    drag: Vec<Vec3<Lanes>>,
    /// For each node: acceleration [m/s²] minus `slope` times that of the next node; later the predicted velocity.
    acceleration: Vec<Vec3<Lanes>>,
    slope: Vec<Lanes>,
    /// For each node on the belt, if there is friction: the belt's force on it [N].
    pub(crate) belt_force: Vec<Vec3<Lanes>>,
    rubs: bool,
    /// For each element: correction of the tension [N] minus `.1` times that of the element above.
    correction: Vec<(Lanes, Lanes)>,
}

impl Tensions {
    pub(crate) fn new(elements: usize) -> Self {
        let mut tensions = Self { tension: vec![Lanes::ZERO; elements].into(), ..Self::default() };
        if elements > 0 {
            tensions.make_room(elements + 1);
        }
        tensions
    }

    /// Keeps the belt's force on each node.
    pub(crate) fn rub(&mut self) {
        self.rubs = true;
        self.belt_force = vec![Vec3::ZERO; self.force.len()];
    }

    /// Makes room for a number of nodes.
    fn make_room(&mut self, room: usize) {
        if self.force.len() < room {
            if self.rubs {
                self.belt_force.resize(room, Vec3::ZERO);
            }
            self.tangent.resize(room, Vec3::ZERO);
            self.direction.resize(room, Vec3::ZERO);
            self.force.resize(room, Vec3::ZERO);
            self.drag.resize(room, Vec3::ZERO);
            self.acceleration.resize(room, Vec3::ZERO);
            self.slope.resize(room, Lanes::ZERO);
            self.correction.resize(room, Default::default());
        }
    }

    /// Adds an element at the root, unless the scheme does without tensions.
    pub(crate) fn push_root(&mut self, tension: Lanes) {
        if !self.tension.is_empty() {
            self.tension.push_root(tension);
            let nodes = self.tension.len() + 1;
            if self.force.len() < nodes {
                // For some more, because the next element is born soon.
                self.make_room(nodes + nodes / 4);
            }
        }
    }

    /// Keeps so many elements from the root on.
    pub(crate) fn truncate(&mut self, elements: usize) {
        if !self.tension.is_empty() {
            self.tension.truncate(elements);
        }
    }
}

/// Advances eight chains by one step of `h` [s]. The arguments are those of the explicit step.
#[inline(always)]
pub(crate) fn step<S: Register, const FED: bool>(
    chain: &mut Chain,
    wind: impl AirAtElements<S>,
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
        h,
        rate: Wide::splat(h * h) * Wide::load(&c.node.inverse_mass),
        t: &mut chain.tensions,
        string: (Wide::zero(), Wide::zero()),
        above: (Vec3::zero(), Wide::zero()),
        dissipation: Wide::zero(),
    };
    force_pass(&mut predictor, c, wind, chain.position.len() - 1, block);
    work.dissipate(predictor.dissipation, c, h);
    predict_and_eliminate::<S, FED>(chain, h);
    if FED {
        chain.hold_landing();
    }
    let mut sums = (WorkRegisters::of(work, split), Supports::of(work));
    correct_and_move::<S, FED>(chain, h, damped, &mut sums);
    sums.0.put(work);
    sums.1.put(work);
}

/// Stores the forces with the tensions of the last step, and eliminates `(M + K') a = F` from the root to the
/// free end. `K'` is the share of the string's stiffness that the averaging adds to the mass.
struct Predictor<'a, S: Register> {
    damped: bool,
    position: &'a [Vec3<Lanes>],
    velocity: &'a [Vec3<Lanes>],
    earlier: &'a [Vec3<Lanes>],
    c: &'a Constants,
    /// The time step [s].
    h: f64,
    /// `h²/m` of a node between elements.
    rate: Wide<S>,
    t: &'a mut Tensions,
    /// `½ m s²/(1+s)` of the elements above and below the next node; zero in compression.
    string: (Wide<S>, Wide<S>),
    /// The row of the node above: its acceleration minus `.1` times that of the next node.
    above: (Vec3<Wide<S>>, Wide<S>),
    /// Power that the bending viscosity dissipates [W].
    dissipation: Wide<S>,
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
        // Without the compression, the prediction does not fold elements that the correction has to unfold.
        let tension = Wide::load(&self.t.tension[j]).max(Wide::zero());
        self.t.tension[j] = tension.store();
        self.t.tangent[j] = element.tangent.store();
        let s = self.rate * tension * element.inverse_length;
        let share = (s * s).over(s + Wide::splat(1.0)) * Wide::splat(0.5);
        self.string.1 = share * Wide::load(&self.c.node.mass);
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
        if self.damped {
            let damping = Wide::load(&node.mass) * Wide::load(&self.c.damping);
            force = self.drag_velocity(i).neg_mul_add(damping, force);
        }
        if i > 0 && self.c.friction.is_some() && self.c.may_be_held(i, nodes) {
            force += self.friction(i, node, force.x);
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

impl<S: Register> Predictor<'_, S> {
    /// The friction on a node that slides on the belt; zero in the lanes where it does not. It slows the node down, at most
    /// to the belt's velocity within the step.
    ///
    /// * `pull` – force of the chain and of gravity on to the belt [N]
    #[cold]
    #[inline(never)]
    fn friction(&mut self, i: usize, node: &Node, pull: Wide<S>) -> Vec3<Wide<S>> {
        let Some(friction) = &self.c.friction else { return Vec3::zero() };
        let (pull, v) = (pull.store(), self.velocity[i]);
        let (mut force, mut rubbing) = (Vec3::ZERO, Vec3::ZERO);
        for lane in 0..WIDTH {
            if node.inverse_mass.0[lane] > 0.0 && node.inverse_mass_x.0[lane] == 0.0 {
                let slip = [v.y.0[lane] - self.c.frame.0[lane], v.z.0[lane]];
                let speed = slip[0].hypot(slip[1]);
                let normal = (pull.0[lane] + friction.press.0[lane]).max(0.0);
                let stopping = node.mass.0[lane] / self.h;
                let drag = (friction.coefficient.0[lane] * normal / speed).min(stopping);
                let drag = if speed > 0.0 { drag } else { 0.0 };
                let [y, z] = slip.map(|slip| -drag * slip);
                force.set_lane(lane, Vec3::new(-pull.0[lane], y, z));
                rubbing.set_lane(lane, Vec3::new(0.0, y, z));
            }
        }
        self.t.belt_force[i] = force;
        Vec3::load(&rubbing)
    }
}

/// From the free end to the root: replaces the accelerations by the predicted velocities, and eliminates the
/// rows `(λ+δ)/k_a = ℓ_{k+1} − l`.
///
/// Let `d` be the predicted edge, `d̂` its direction and `w = h²k_a/m` of a node. The correction acts along `d̂`, so row
/// `j` is `−w_j d̂_j·d̂_{j−1} δ_{j−1} + (1 + w_j + w_{j+1}) δ_j − w_{j+1} d̂_j·d̂_{j+1} δ_{j+1} = k_a (|d| − l) − λ`. The
/// matrix is symmetric and positive definite.
#[inline(always)]
fn predict_and_eliminate<S: Register, const FED: bool>(chain: &mut Chain, h: f64) {
    let Chain { position, velocity, constants: c, tensions: t, laying, .. } = chain;
    let (position, velocity, c) = (&**position, &**velocity, &*c);
    let nodes = position.len();
    let elements = nodes - 1;
    let step = h;
    let h = Wide::<S>::splat(h);
    let (stiffness, rest_length) = (Wide::load(&c.axial_stiffness), Wide::load(&c.rest_length));
    let scale = h * h * stiffness;
    let one = Wide::splat(1.0);
    let mut acceleration = Vec3::zero();
    // The node below: where it is predicted, and its weight. Then the element below: its direction, and what it lacks.
    let mut lower = (Vec3::zero(), Vec3::zero());
    let none = Weight { x: Wide::zero(), across: Wide::zero() };
    let mut weights = (none, none);
    let (mut below, mut here, mut wanted) = (Vec3::zero(), Vec3::zero(), Wide::zero());
    let (mut value, mut slope) = (Wide::zero(), Wide::zero());
    for i in (0..nodes).rev() {
        acceleration = acceleration.mul_add(Wide::load(&t.slope[i]), Vec3::load(&t.acceleration[i]));
        let mut predicted = acceleration.mul_add(h, Vec3::load(&velocity[i]));
        let node = c.node(i, nodes);
        let mut free = Wide::load(&node.inverse_mass);
        let mut free_x = free;
        let at = Vec3::load(&position[i]);
        if FED && c.may_be_held(i, nodes) {
            // What slides on the belt does not leave it.
            free_x = Wide::load(&node.inverse_mass_x);
            let zero = Wide::zero();
            let slides = Wide::select_less(zero, free, zero, predicted.x);
            let own = Wide::select_less(zero, free_x, predicted.x, slides);
            predicted.x = own;
        }
        if FED
            && let Some(laying) = laying
            && laying.reached(at.x, predicted.x, h)
        {
            let mut landing = predicted.store();
            let others = Wide::load(&laying.land(i, &position[i], &mut landing, step));
            (free, free_x) = (free * others, free_x * others);
            predicted = Vec3::load(&landing);
        }
        t.acceleration[i] = predicted.store();
        let weight = Weight { x: scale * free_x, across: scale * free };
        if i < elements {
            let edge = (lower.1 - predicted).mul_add(h, lower.0 - at);
            let length = edge.dot(edge).sqrt();
            let direction = edge * one.over(length);
            t.direction[i] = direction.store();
            // Row `i+1`, between the directions above and below it.
            if i + 1 < elements {
                let above = -weights.0.between::<FED>(here, direction);
                let row = Row { weights, here, below, wanted };
                (value, slope) = row.eliminate::<FED>(above, (value, slope));
                t.correction[i + 1] = (value.store(), slope.store());
            }
            (below, here) = (here, direction);
            wanted = stiffness * (length - rest_length) - Wide::load(&t.tension[i]);
        }
        weights = (weight, weights.0);
        lower = (at, predicted);
    }
    let row = Row { weights, here, below, wanted };
    (value, slope) = row.eliminate::<FED>(Wide::zero(), (value, slope));
    t.correction[0] = (value.store(), slope.store());
}

/// `h²k_a/m` of a node: along x, where the belt may hold it, and across.
#[derive(Clone, Copy)]
struct Weight<S: Register> {
    x: Wide<S>,
    across: Wide<S>,
}

impl<S: Register> Weight<S> {
    /// The weight between two directions.
    #[inline(always)]
    fn between<const FED: bool>(&self, a: Vec3<Wide<S>>, b: Vec3<Wide<S>>) -> Wide<S> {
        if FED {
            self.x * (a.x * b.x) + self.across * a.y.mul_add(b.y, a.z * b.z)
        } else {
            self.across * a.dot(b)
        }
    }
}

/// An element in the system of the tensions' corrections.
struct Row<S: Register> {
    /// The weights of its upper and its lower node.
    weights: (Weight<S>, Weight<S>),
    /// Its direction, and that of the element below.
    here: Vec3<Wide<S>>,
    below: Vec3<Wide<S>>,
    /// The right-hand side.
    wanted: Wide<S>,
}

impl<S: Register> Row<S> {
    /// Eliminates the row: returns its value and slope.
    ///
    /// * `above` – the entry left of the diagonal
    /// * `next` – value and slope of the row below
    #[inline(always)]
    fn eliminate<const FED: bool>(&self, above: Wide<S>, next: (Wide<S>, Wide<S>)) -> (Wide<S>, Wide<S>) {
        let one = Wide::splat(1.0);
        let Self { weights: (upper, lower), here, .. } = *self;
        let below = -lower.between::<FED>(here, self.below);
        let own = if FED {
            let x = here.x * here.x;
            (upper.x + lower.x).mul_add(x, (upper.across + lower.across) * (one - x))
        } else {
            upper.across + lower.across
        };
        let pivot = one.over(below.neg_mul_add(next.1, one + own));
        (below.neg_mul_add(next.0, self.wanted) * pivot, above * pivot)
    }
}

/// From the root to the free end: corrects the tensions and moves the nodes.
#[inline(always)]
fn correct_and_move<S: Register, const FED: bool>(
    chain: &mut Chain,
    h: f64,
    damped: bool,
    (sums, supports): &mut (WorkRegisters<S>, Supports),
) {
    let Chain { position, velocity, earlier, constants: c, tensions: t, .. } = chain;
    let (position, velocity, earlier) = (&mut **position, &mut **velocity, &mut **earlier);
    let nodes = position.len();
    let (rate, h) = (Wide::<S>::splat(1.0 / h), Wide::<S>::splat(h));
    let frame = Wide::load(&c.frame);
    let mut correction = Wide::zero();
    // Forces of the element above: from the correction of its tension, and from its last tension.
    let (mut change_above, mut pull_above) = (Vec3::zero(), Vec3::zero());
    for i in 0..nodes {
        let (mut change, mut pull) = (Vec3::zero(), Vec3::zero());
        if i + 1 < nodes {
            let (value, slope) = &t.correction[i];
            correction = Wide::load(slope).neg_mul_add(correction, Wide::load(value));
            let tension = Wide::load(&t.tension[i]);
            (change, pull) = (Vec3::load(&t.direction[i]) * correction, Vec3::load(&t.tangent[i]) * tension);
            t.tension[i] = (tension + correction).store();
        }
        let node = c.node(i, nodes);
        let before = Vec3::load(&velocity[i]);
        let kick = h * Wide::load(&node.inverse_mass);
        let predicted = Vec3::load(&t.acceleration[i]);
        let mut after = (change - change_above).mul_add(kick, predicted);
        if FED && i > 0 && c.may_be_held(i, nodes) {
            let zero = Wide::zero();
            after.x = Wide::select_less(zero, Wide::load(&node.inverse_mass_x), after.x, predicted.x);
        }
        // The force that moved the node. What the other forces do not explain is the tension.
        let force = (after - before) * (Wide::load(&node.mass) * rate);
        let mut tension = force - Vec3::load(&t.force[i]) + (pull - pull_above);
        let mut damping = None;
        if damped {
            let v = (before - Vec3::load(&earlier[i])).mul_add(Wide::splat(0.5), before);
            damping = Some(v * -(Wide::load(&node.mass) * Wide::load(&c.damping)));
        }
        let mut seen = [before, after];
        if FED {
            if c.may_be_held(i, nodes) {
                let unexplained = force - Vec3::load(&t.force[i]) - (change - change_above);
                let held = supports.add(i, Wide::load(&node.inverse_mass), unexplained, seen, c);
                tension -= held;
                if i > 0 && c.friction.is_some() {
                    supports.rub(Vec3::load(&t.belt_force[i]), seen, c);
                    t.belt_force[i] = (Vec3::load(&t.belt_force[i]) + held).store();
                }
            }
            seen = [before.less_y(frame), after.less_y(frame)];
        }
        let [seen_before, seen_after] = seen;
        sums.add([force, Vec3::load(&t.drag[i])], damping, seen_before, seen_after);
        sums.add_tension(tension, seen_before, seen_after);
        earlier[i] = before.store();
        velocity[i] = after.store();
        position[i] = after.mul_add(h, Vec3::load(&position[i])).store();
        (change_above, pull_above) = (change, pull);
    }
}
