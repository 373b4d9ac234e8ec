//! Forces inside the chain: tension of the elements, bending at the nodes.

use crate::lanes::{Register, Simd, Wide, bend_ratio};
use crate::vec3::Vec3;

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

/// Bending at the node between two elements: the forces `(a, b)` [N] with which the upper neighbour gets
/// `−a`, the node `a + b`, the lower neighbour `−b`.                          theory.md (13)
///
/// It is exactly `−∇ ½ k_θ θ²`. With unit tangents `t₀`, `t₁`, `δ = t₁ − t₀` and `x = sin²(θ/2) = δ²/4`:
/// `a = (k_θ θ/sin θ)/ℓ₀ · (δ + 2x t₀)`, `b = (k_θ θ/sin θ)/ℓ₁ · (δ − 2x t₁)`: no division by a vanishing
/// angle, no cancellation near straight.
#[inline(always)]
pub(crate) fn bending<S: Register>(
    upper: &Element<S>,
    lower: &Element<S>,
    stiffness: Wide<S>,
) -> (Vec3<Wide<S>>, Vec3<Wide<S>>) {
    let turn = lower.tangent - upper.tangent;
    let twice_x = turn.dot(turn) * Wide::splat(0.5);
    let moment = stiffness * bend_ratio(twice_x * Wide::splat(0.5));
    let a = upper.tangent.mul_add(twice_x, turn) * (moment * upper.inverse_length);
    let b = lower.tangent.neg_mul_add(twice_x, turn) * (moment * lower.inverse_length);
    (a, b)
}
