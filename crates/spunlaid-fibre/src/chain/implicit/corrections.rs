//! The system of the corrections of the tensions.

use crate::chain::Chain;
use spunlaid_ground::{Register, Vec3, Wide};

/// From the free end to the root: replaces the accelerations by the predicted velocities, and eliminates the
/// rows `(λ+δ)/k_a = ℓ_{k+1} − l`.
///
/// Let `d` be the predicted edge, `d̂` its direction and `w = h²k_a/m` of a node, with the `k_a` of the row.
/// The correction acts along `d̂`, so row `j` is
/// `−w_j d̂_j·d̂_{j−1} δ_{j−1} + (1 + w_j + w_{j+1}) δ_j − w_{j+1} d̂_j·d̂_{j+1} δ_{j+1} = k_a (|d| − l) − λ`.
/// Divided by `k_a`, the matrix is symmetric and positive definite.
#[inline(always)]
pub(super) fn predict_and_eliminate<S: Register, const FED: bool>(chain: &mut Chain, h: f64) {
    let Chain { position, velocity, constants: c, tensions: t, laying, .. } = chain;
    let position = &**position;
    let velocity = &**velocity;
    let c = &*c;
    let nodes = position.len();
    let elements = nodes - 1;
    let step = h;
    let h = Wide::<S>::splat(h);
    let h_squared = h * h;
    let element = &c.element;
    let one = Wide::splat(1.0);
    let mut acceleration = Vec3::zero();
    // The node below: where it is predicted, and its mobility. Then the element below: the weights of its
    // nodes, its direction, and what it lacks.
    let mut lower = (Vec3::zero(), Vec3::zero());
    let none = Weight { x: Wide::zero(), across: Wide::zero() };
    let (mut mobility_below, mut weights) = (none, (none, none));
    let mut below = Vec3::zero();
    let mut here = Vec3::zero();
    let mut residual = Wide::zero();
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
            let stiffness = Wide::load(&element.axial_stiffness);
            let edge = (lower.1 - predicted).mul_add(h, lower.0 - at);
            let length = edge.dot(edge).sqrt();
            let direction = edge * one.over(length);
            link.direction = direction.store();
            // Row `i+1`, between the directions above and below it.
            if i + 1 < elements {
                let above = -weights.0.between::<FED>(here, direction);
                let row = Row { weights, here, below, residual };
                (value, slope) = row.eliminate::<FED>(above, (value, slope));
                t.links[i + 1].correction = (value.store(), slope.store());
            }
            (below, here) = (here, direction);
            residual = stiffness * (length - Wide::load(&element.rest_length)) - Wide::load(&t.tension[i]);
            let scale = h_squared * stiffness;
            weights = (mobility.times(scale), mobility_below.times(scale));
        }
        mobility_below = mobility;
        lower = (at, predicted);
    }
    let row = Row { weights, here, below, residual };
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
    residual: Wide<S>,
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
        (below.neg_mul_add(next.0, self.residual) * pivot, above * pivot)
    }
}
