//! Forces on a chain: one pass along eight chains computes all of them on every node.

use super::constants::{Constants, ElementConstants};
use crate::drag::{DragLanes, Split};
use spunlaid_air::{LastEddy, Velocities, VelocityAt, VelocityTask};
use spunlaid_ground::lanes::bend_ratio;
use spunlaid_ground::{Register, Simd, Vec3, Wide};

/// What a time-integration scheme gives to a force pass, and what it does with the forces.
pub(crate) trait Integrator<S: Register> {
    /// Position of node `i` [m].
    fn position(&self, i: usize) -> Vec3<Wide<S>>;

    /// Velocity of node `i` from which drag and damping are computed [m/s].
    fn drag_velocity(&self, i: usize) -> Vec3<Wide<S>>;

    /// Tension of element `j` [N], negative in compression.
    fn tension(&mut self, j: usize, c: &ElementConstants, element: &Element<S>) -> Wide<S>;

    /// Takes the power that the bending viscosity dissipates [W].
    fn dissipated(&mut self, power: Wide<S>);

    /// Takes the force on node `i` without gravity and damping, and the part of it that is drag [N].
    /// The pass does not need the node any more.
    fn node(&mut self, i: usize, force: Vec3<Wide<S>>, drag: Vec3<Wide<S>>);
}

/// Computes the forces on eight chains.
///
/// * `count` – number `N` of elements
///
/// The pass goes from the root to the free end in blocks of elements. For each block it computes first the
/// geometry and the relative velocities, then the powers of the drag law, then all forces and their sums on
/// the nodes. Three short loops are faster than one long loop, because the processor then works on several
/// elements at once instead of waiting for one result after the other. A block fits in the first-level
/// cache. The force on a node is complete when the element below it is done.
#[inline(always)]
pub(crate) fn force_pass<S: Register>(
    integrator: &mut impl Integrator<S>,
    c: &Constants,
    air: &Velocities<'_, S>,
    count: usize,
    block: &mut ElementBlock<S>,
) {
    let mut above = Element {
        tangent: Vec3::load(&c.root_direction),
        inverse_length: Wide::zero(),
        length: Wide::zero(),
    };
    let viscosity = c.viscosity.as_ref();
    // The fibres of a flight have the kinds of the laws in common.
    let own = &c.element;
    let powers = own.half_drag.is_powers();
    let mut spin_above = Vec3::zero();
    let mut dissipated = Wide::zero();
    // Sums so far on nodes j−1 and j: of all forces, and of the drag alone.
    let (mut force, mut force_above) = (Vec3::zero(), Vec3::zero());
    let (mut drag, mut drag_above) = (Vec3::zero(), Vec3::zero());
    for start in (0..count).step_by(BLOCK) {
        let elements = &mut block.0[..BLOCK.min(count - start)];
        air.run(Kinematics {
            integrator: &*integrator,
            start,
            block: elements,
            viscous: viscosity.is_some(),
        });
        if powers {
            // Without a closure, which would not be compiled for the instruction set.
            for item in &mut *elements {
                own.half_drag.raise(&mut item.split);
            }
        } else {
            for (j, item) in (start..).zip(&mut *elements) {
                own.half_drag.look_up(j, &mut item.split);
            }
        }
        for (j, item) in (start..).zip(&*elements) {
            let stiffness = Wide::load(c.bending_stiffness(j));
            let tension = integrator.tension(j, own, &item.element);
            let (mut a, mut pull) = internal(&above, &item.element, stiffness, tension);
            if let Some(time) = viscosity {
                let turning = item.spin - spin_above;
                let moment = turning * (stiffness * Wide::load(time));
                let pair = couple(&above, &item.element, moment);
                (a, pull) = (a + pair.0, pull + pair.1);
                dissipated = moment.dot_add(turning, dissipated);
                spin_above = item.spin;
            }
            if j > 0 {
                integrator.node(j - 1, force_above - a, drag_above);
            }
            let blow = own.half_drag.force(&item.split, item.element.tangent);
            (force_above, force) = (force + (a + pull + blow), blow - pull);
            (drag_above, drag) = (drag + blow, blow);
            above = item.element;
        }
    }
    integrator.node(count - 1, force_above, drag_above);
    integrator.node(count, force, drag);
    if viscosity.is_some() {
        integrator.dissipated(dissipated);
    }
}

/// Number of elements in a block.
const BLOCK: usize = 8;

/// An element during a force pass.
#[derive(Clone, Copy)]
struct BlockElement<S: Register> {
    element: Element<S>,
    /// Angular velocity `t × dt/dt` [1/s]; only with bending viscosity.
    spin: Vec3<Wide<S>>,
    /// Intermediate values for half the element's drag.
    split: Split<S>,
}

/// Memory for the elements of a block.
pub(crate) struct ElementBlock<S: Register>([BlockElement<S>; BLOCK]);

impl<S: Register> ElementBlock<S> {
    #[inline(always)]
    pub(crate) fn new() -> Self {
        let (vector, number) = (Vec3::zero(), Wide::zero());
        let element = Element { tangent: vector, inverse_length: number, length: number };
        let none = BlockElement { element, spin: vector, split: Split::none() };
        Self([none; BLOCK])
    }
}

/// Computes the geometry of the elements of a block, and their relative velocities.
struct Kinematics<'a, S: Register, I> {
    integrator: &'a I,
    /// Number of the first element.
    start: usize,
    block: &'a mut [BlockElement<S>],
    viscous: bool,
}

impl<S: Register, I: Integrator<S>> VelocityTask<S> for Kinematics<'_, S, I> {
    #[inline(always)]
    fn call(self, air: &impl VelocityAt<S>) {
        let Self { integrator, start, block, viscous } = self;
        let mut upper = (integrator.position(start), integrator.drag_velocity(start));
        let mut last = LastEddy::none();
        for (j, item) in (start + 1..).zip(block.iter_mut()) {
            let lower = (integrator.position(j), integrator.drag_velocity(j));
            item.element = Element::between(upper.0, lower.0);
            if viscous {
                item.spin =
                    item.element.tangent.cross_wide((lower.1 - upper.1) * item.element.inverse_length);
            }
            // Element `j−1` is above node `j`.
            let air = air.at(j - 1, &mut last);
            let relative = (upper.1 + lower.1).neg_mul_add(Wide::splat(0.5), air);
            item.split = DragLanes::split(relative, item.element.tangent);
            upper = lower;
        }
    }
}

/// Geometry of an element.
#[derive(Clone, Copy)]
pub struct Element<S: Simd> {
    /// Unit vector from the upper node to the lower.
    pub tangent: Vec3<Wide<S>>,
    /// `1/ℓ`, the inverse of the current length [1/m].
    pub(crate) inverse_length: Wide<S>,
    /// Current length `ℓ` [m].
    pub(crate) length: Wide<S>,
}

impl<S: Simd> Element<S> {
    /// The element between two nodes.
    #[inline(always)]
    pub fn between(upper: Vec3<Wide<S>>, lower: Vec3<Wide<S>>) -> Self {
        let edge = lower - upper;
        let length = edge.dot(edge).sqrt();
        let inverse_length = Wide::splat(1.0).over(length);
        Self { tangent: edge * inverse_length, inverse_length, length }
    }

    /// Tension `T = k_a (ℓ − l)` [N], negative in compression.               theory.md (10)
    #[inline(always)]
    pub(crate) fn tension(&self, axial_stiffness: Wide<S>, rest_length: Wide<S>) -> Wide<S> {
        axial_stiffness * (self.length - rest_length)
    }
}

/// The internal forces `(a, b)` [N] of an element: its own `tension`, and the bending at its upper node.
///
/// The element's upper node gets `a + b`, its lower node gets `−b`, and the next node towards the root gets
/// `−a`.                                                                       theory.md (10), (13)
///
/// Bending is exactly `−∇ ½ k_θ θ²`. With unit tangents `t₀`, `t₁`, `δ = t₁ − t₀`, `2x = 2 sin²(θ/2) = δ²/2`:
/// `a = (k_θ θ/sin θ)/ℓ₀ · (δ + 2x t₀)`, `b = (k_θ θ/sin θ)/ℓ₁ · (δ − 2x t₁) + T t₁`. This form does not divide
/// by an angle that may be zero, and it loses no digits in a chain that is almost straight.
#[inline(always)]
pub(crate) fn internal<S: Register>(
    upper: &Element<S>,
    lower: &Element<S>,
    stiffness: Wide<S>,
    tension: Wide<S>,
) -> (Vec3<Wide<S>>, Vec3<Wide<S>>) {
    let turn = lower.tangent - upper.tangent;
    let turn_squared = turn.dot(turn);
    let twice_x = turn_squared * Wide::splat(0.5);
    let moment = stiffness * bend_ratio(turn_squared);
    let a = upper.tangent.mul_add(twice_x, turn) * (moment * upper.inverse_length);
    let push = moment * lower.inverse_length;
    let b = turn.mul_add(push, lower.tangent * push.neg_mul_add(twice_x, tension));
    (a, b)
}

/// The forces `(a, b)` [N] of a moment [N·m] between two elements, as of [`internal`]: `a = M × t₀/ℓ₀`,
/// `b = M × t₁/ℓ₁`.                                                             theory.md (62)
#[inline(always)]
pub(crate) fn couple<S: Register>(
    upper: &Element<S>,
    lower: &Element<S>,
    moment: Vec3<Wide<S>>,
) -> (Vec3<Wide<S>>, Vec3<Wide<S>>) {
    let above = moment.cross_wide(upper.tangent) * upper.inverse_length;
    (above, moment.cross_wide(lower.tangent) * lower.inverse_length)
}
