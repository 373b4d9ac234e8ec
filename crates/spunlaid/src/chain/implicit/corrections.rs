//! The system of the corrections of the tensions, and the step of the nodes.

use crate::chain::Chain;
use crate::chain::work::{Supports, WorkRegisters};
use crate::lanes::{Register, Wide};
use crate::vec3::Vec3;

/// From the free end to the root: replaces the accelerations by the predicted velocities, and eliminates the
/// rows `(λ+δ)/k_a = ℓ_{k+1} − l`.
///
/// Let `d` be the predicted edge, `d̂` its direction and `w = h²k_a/m` of a node, with the `k_a` of the row. The correction acts
/// along `d̂`, so row `j` is
/// `−w_j d̂_j·d̂_{j−1} δ_{j−1} + (1 + w_j + w_{j+1}) δ_j − w_{j+1} d̂_j·d̂_{j+1} δ_{j+1} = k_a (|d| − l) − λ`. Divided by `k_a`,
/// the matrix is symmetric and positive definite.
#[inline(always)]
pub(super) fn predict_and_eliminate<S: Register, const FED: bool>(chain: &mut Chain, h: f64) {
    let Chain { position, velocity, constants: c, tensions: t, laying, .. } = chain;
    let (position, velocity, c) = (&**position, &**velocity, &*c);
    let nodes = position.len();
    let elements = nodes - 1;
    let step = h;
    let h = Wide::<S>::splat(h);
    let h_squared = h * h;
    let one = Wide::splat(1.0);
    let mut acceleration = Vec3::zero();
    // The node below: where it is predicted, and its mobility. Then the element below: the weights of its nodes, its direction,
    // and what it lacks.
    let mut lower = (Vec3::zero(), Vec3::zero());
    let none = Weight { x: Wide::zero(), across: Wide::zero() };
    let (mut mobility_below, mut weights) = (none, (none, none));
    let (mut below, mut here, mut wanted) = (Vec3::zero(), Vec3::zero(), Wide::zero());
    let (mut value, mut slope) = (Wide::zero(), Wide::zero());
    for i in (0..nodes).rev() {
        let link = &mut t.links[i];
        acceleration = acceleration.mul_add(Wide::load(&link.slope), Vec3::load(&link.acceleration));
        let mut predicted = acceleration.mul_add(h, Vec3::load(&velocity[i]));
        let node = c.node(i, nodes);
        let free = Wide::load(&node.inverse_mass);
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
            // The tension may still move it along the belt, or two nodes that land together would strain their element.
            free_x = free_x * others;
            predicted = Vec3::load(&landing);
        }
        link.acceleration = predicted.store();
        let mobility = Weight { x: free_x, across: free };
        if i < elements {
            let element = c.elements.at(i);
            let stiffness = Wide::load(&element.axial_stiffness);
            let edge = (lower.1 - predicted).mul_add(h, lower.0 - at);
            let length = edge.dot(edge).sqrt();
            let direction = edge * one.over(length);
            link.direction = direction.store();
            // Row `i+1`, between the directions above and below it.
            if i + 1 < elements {
                let above = -weights.0.between::<FED>(here, direction);
                let row = Row { weights, here, below, wanted };
                (value, slope) = row.eliminate::<FED>(above, (value, slope));
                t.links[i + 1].correction = (value.store(), slope.store());
            }
            (below, here) = (here, direction);
            wanted = stiffness * (length - Wide::load(&element.rest_length)) - Wide::load(&t.tension[i]);
            let scale = h_squared * stiffness;
            weights = (mobility.times(scale), mobility_below.times(scale));
        }
        mobility_below = mobility;
        lower = (at, predicted);
    }
    let row = Row { weights, here, below, wanted };
    (value, slope) = row.eliminate::<FED>(Wide::zero(), (value, slope));
    t.links[0].correction = (value.store(), slope.store());
}

/// `h²k_a/m` of a node, or its mobility `1/m`: along x, where the belt may hold it, and across.
#[derive(Clone, Copy)]
struct Weight<S: Register> {
    x: Wide<S>,
    across: Wide<S>,
}

impl<S: Register> Weight<S> {
    #[inline(always)]
    fn times(&self, factor: Wide<S>) -> Self {
        Self { x: factor * self.x, across: factor * self.across }
    }

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

/// From the root to the free end: corrects the tensions and moves the nodes. Returns by how much the squared length of an
/// element of a fed fibre is off at most from the one that belongs to its tension, in parts of it.
#[inline(always)]
pub(super) fn correct_and_move<S: Register, const FED: bool>(
    chain: &mut Chain,
    h: f64,
    damped: bool,
    (sums, supports): &mut (WorkRegisters<S>, Supports),
) -> Wide<S> {
    let Chain { position, velocity, earlier, constants: c, tensions: t, laying, .. } = chain;
    let (position, velocity, earlier) = (&mut **position, &mut **velocity, &mut **earlier);
    let nodes = position.len();
    let (rate, h) = (Wide::<S>::splat(1.0 / h), Wide::<S>::splat(h));
    let frame = Wide::load(&c.frame);
    let mut correction = Wide::zero();
    // Forces of the element above: from the correction of its tension, and from its last tension.
    let (mut change_above, mut pull_above) = (Vec3::zero(), Vec3::zero());
    // The node above: where it is now, and whether it moves.
    let (mut above, mut mobility) = (Vec3::zero(), Wide::zero());
    // The length that belongs to the tension of the element above.
    let mut natural = Wide::zero();
    let mut furthest = Wide::zero();
    for i in 0..nodes {
        let link = &t.links[i];
        let (mut change, mut pull) = (Vec3::zero(), Vec3::zero());
        let natural_above = natural;
        if i + 1 < nodes {
            let (value, slope) = &link.correction;
            correction = Wide::load(slope).neg_mul_add(correction, Wide::load(value));
            let tension = Wide::load(&t.tension[i]);
            (change, pull) = (Vec3::load(&link.direction) * correction, Vec3::load(&link.tangent) * tension);
            let corrected = tension + correction;
            t.tension[i] = corrected.store();
            let c = c.elements.at(i);
            natural = Wide::load(&c.compliance).mul_add(corrected, Wide::load(&c.rest_length));
        }
        let node = c.node(i, nodes);
        let before = Vec3::load(&velocity[i]);
        let kick = h * Wide::load(&node.inverse_mass);
        let predicted = Vec3::load(&link.acceleration);
        let mut after = (change - change_above).mul_add(kick, predicted);
        if FED && i > 0 && c.may_be_held(i, nodes) {
            let zero = Wide::zero();
            after.x = Wide::select_less(zero, Wide::load(&node.inverse_mass_x), after.x, predicted.x);
        }
        // The force that moved the node. What the other forces do not explain is the tension.
        let force = (after - before) * (Wide::load(&node.mass) * rate);
        let mut tension = force - Vec3::load(&link.force) + (pull - pull_above);
        let mut damping = None;
        if damped {
            let v = (before - Vec3::load(&earlier[i])).mul_add(Wide::splat(0.5), before);
            damping = Some(v * -(Wide::load(&node.mass) * Wide::load(&c.damping)));
        }
        let mut seen = [before, after];
        if FED {
            if c.may_be_held(i, nodes) {
                let unexplained = force - Vec3::load(&link.force) - (change - change_above);
                let mut free = Wide::load(&node.inverse_mass);
                if let Some(laying) = laying {
                    free = laying.unless_it_lands(i, free);
                }
                let held = supports.add(i, free, unexplained, seen, c);
                tension -= held;
                if i > 0 && c.friction.is_some() {
                    supports.rub(Vec3::load(&t.belt_force[i]), seen, c);
                    t.belt_force[i] = (Vec3::load(&t.belt_force[i]) + held).store();
                }
            }
            seen = [before.less_y(frame), after.less_y(frame)];
        }
        let [seen_before, seen_after] = seen;
        sums.add([force, Vec3::load(&link.drag)], damping, seen_before, seen_after);
        sums.add_tension(tension, seen_before, seen_after);
        earlier[i] = before.store();
        velocity[i] = after.store();
        let here = after.mul_add(h, Vec3::load(&position[i]));
        position[i] = here.store();
        if FED {
            let edge = here - above;
            let off = edge.dot(edge) - natural_above * natural_above;
            let off = off.abs().max(furthest);
            if i > 0 {
                // What lies on the belt can no longer be corrected.
                furthest = Wide::select_less(Wide::zero(), kick + mobility, off, furthest);
            }
            (above, mobility) = (here, kick);
        }
        (change_above, pull_above) = (change, pull);
    }
    // What is fed is fed in equal lengths.
    let rest_length = Wide::load(&c.elements.at(0).rest_length);
    furthest.over(rest_length * rest_length)
}
