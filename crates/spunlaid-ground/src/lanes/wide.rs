//! [`Lanes`] in registers, with operators.

use super::simd::{Register, Simd};
use super::{Lanes, WIDTH};
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// Eight numbers in registers, or several times eight.
#[derive(Clone, Copy)]
pub struct Wide<S: Simd>(pub S);

impl<S: Simd> Wide<S> {
    /// The same number everywhere.
    #[inline(always)]
    pub fn splat(value: f64) -> Self {
        Self(S::splat(value))
    }

    /// Zero everywhere.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::splat(0.0)
    }

    /// From memory.
    #[inline(always)]
    pub fn load(lanes: &Lanes) -> Self {
        Self(S::load(lanes))
    }

    /// `self · factor + addend`, rounded once.
    #[inline(always)]
    pub fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self(self.0.mul_add(factor.0, addend.0))
    }

    /// `addend − self · factor`, rounded once.
    #[inline(always)]
    pub fn neg_mul_add(self, factor: Self, addend: Self) -> Self {
        Self(self.0.neg_mul_add(factor.0, addend.0))
    }

    /// `self / divisor`.
    #[inline(always)]
    pub fn over(self, divisor: Self) -> Self {
        Self(self.0.div(divisor.0))
    }

    /// The square root.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    /// The largest whole number that is not above, for numbers within ±2⁵¹. The sign of a zero is left open.
    #[inline(always)]
    pub fn floor(self) -> Self {
        Self(self.0.floor())
    }

    /// Without its sign.
    #[inline(always)]
    pub fn abs(self) -> Self {
        Self(self.0.and_bits(!SIGN))
    }

    /// The larger of the two; `other` if one of them is NaN.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }

    /// The smaller of the two; `other` if one of them is NaN.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        Self::select_less(self, other, self, other)
    }

    /// `a < b ? yes : no`.
    #[inline(always)]
    pub fn select_less(a: Self, b: Self, yes: Self, no: Self) -> Self {
        Self(S::select_less(a.0, b.0, yes.0, no.0))
    }

    /// Whether any number is above a bound.
    #[inline(always)]
    pub fn any_above(self, bound: f64) -> bool {
        self.0.any_above(S::splat(bound))
    }
}

impl<S: Register> Wide<S> {
    /// Into memory.
    #[inline(always)]
    pub fn store(self) -> Lanes {
        self.0.store()
    }

    /// Writes the bits of the lanes in which `a < b` to the start of `into`, and returns their number.
    #[inline(always)]
    pub fn store_less(self, a: Self, b: Self, into: &mut [u64; WIDTH]) -> usize {
        self.0.store_less(a.0, b.0, into)
    }
}

const SIGN: u64 = 1 << 63;

impl<S: Simd> Add for Wide<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0.add(other.0))
    }
}

impl<S: Simd> Sub for Wide<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0.sub(other.0))
    }
}

impl<S: Simd> Mul for Wide<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(self.0.mul(other.0))
    }
}

impl<S: Simd> Neg for Wide<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.xor(S::splat(-0.0)))
    }
}

impl<S: Simd> AddAssign for Wide<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Simd> SubAssign for Wide<S> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
