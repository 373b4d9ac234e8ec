//! Forces inside the chain: tension of the elements, bending at the nodes.

use crate::lanes::{Lanes, bend_ratio};
use crate::vec3::Vec3;

/// Geometry of an element.
#[derive(Clone, Copy, Debug)]
pub struct Element {
    /// Unit vector from the upper node to the lower.
    pub tangent: Vec3<Lanes>,
    /// `1/ℓ`, the inverse of the current length [1/m].
    pub inverse_length: Lanes,
    /// Current length `ℓ` [m].
    pub length: Lanes,
}

impl Element {
    /// The element between two nodes.
    #[inline(always)]
    pub fn between(upper: Vec3<Lanes>, lower: Vec3<Lanes>) -> Self {
        let edge = lower - upper;
        let length = edge.dot(edge).sqrt();
        let inverse_length = Lanes::splat(1.0) / length;
        Self { tangent: edge * inverse_length, inverse_length, length }
    }

    /// Tension `T = k_a (ℓ − l)` [N], negative in compression.               theory.md (10)
    #[inline(always)]
    pub fn tension(&self, axial_stiffness: Lanes, rest_length: Lanes) -> Lanes {
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
pub fn bending(upper: &Element, lower: &Element, stiffness: Lanes) -> (Vec3<Lanes>, Vec3<Lanes>) {
    let turn = lower.tangent - upper.tangent;
    let twice_x = turn.dot(turn) * 0.5;
    let moment = stiffness * bend_ratio(twice_x * 0.5);
    let a = upper.tangent.mul_add(twice_x, turn) * (moment * upper.inverse_length);
    let b = lower.tangent.mul_add(-twice_x, turn) * (moment * lower.inverse_length);
    (a, b)
}
