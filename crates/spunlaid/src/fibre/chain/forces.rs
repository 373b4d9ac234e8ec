//! Forces inside the chain: tension of the elements, bending at the nodes.

use crate::ground::lanes::bend_ratio;
use crate::ground::{Register, Simd, Vec3, Wide};

/// Geometry of an element.
#[derive(Clone, Copy)]
pub(crate) struct Element<S: Simd> {
    /// Unit vector from the upper node to the lower.
    pub(crate) tangent: Vec3<Wide<S>>,
    /// `1/ℓ`, the inverse of the current length [1/m].
    pub(crate) inverse_length: Wide<S>,
    /// Current length `ℓ` [m].
    pub(crate) length: Wide<S>,
}

impl<S: Simd> Element<S> {
    /// The element between two nodes.
    #[inline(always)]
    pub(crate) fn between(upper: Vec3<Wide<S>>, lower: Vec3<Wide<S>>) -> Self {
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
