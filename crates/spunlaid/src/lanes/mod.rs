//! Eight numbers side by side: the number type of the kernel.
//!
//! The same arithmetic advances eight independent fibres at once. Every operation acts lane by lane and
//! is one of those IEEE 754 rounds exactly (add, subtract, multiply, divide, square root, fused
//! multiply-add), so a lane never learns what its neighbours hold nor how wide the machine's registers
//! are: the bits of a fibre are the same alone or packed with seven others, on any instruction set.

mod functions;
pub mod isa;

pub use functions::{bend_ratio, cos_sin_turn, exp2, log2, power};
pub use isa::Isa;

use std::array::from_fn;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// How many fibres a [`Lanes`] holds side by side.
pub const WIDTH: usize = 8;

/// Eight `f64` side by side, one for each fibre of a bundle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Lanes(pub [f64; WIDTH]);

impl Default for Lanes {
    fn default() -> Self {
        Self::ZERO
    }
}

impl Lanes {
    /// Zero in every lane.
    pub const ZERO: Self = Self([0.0; WIDTH]);

    /// The same value in every lane.
    #[inline(always)]
    pub const fn splat(value: f64) -> Self {
        Self([value; WIDTH])
    }

    /// A value for each lane from its index `0..8`.
    #[inline(always)]
    pub fn from_fn(value: impl FnMut(usize) -> f64) -> Self {
        Self(from_fn(value))
    }

    /// `self · factor + addend`, rounded once.
    #[inline(always)]
    pub fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self(from_fn(|i| self.0[i].mul_add(factor.0[i], addend.0[i])))
    }

    /// Square root.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }

    /// Absolute value.
    #[inline(always)]
    pub fn abs(self) -> Self {
        Self(self.0.map(f64::abs))
    }

    /// The larger of the two, `other` where they cannot be compared.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        Self::select_less(other, self, self, other)
    }

    /// `a < b ? yes : no`, lane by lane.
    #[inline(always)]
    pub fn select_less(a: Self, b: Self, yes: Self, no: Self) -> Self {
        Self(from_fn(|i| if a.0[i] < b.0[i] { yes.0[i] } else { no.0[i] }))
    }

    /// Whether any lane exceeds `bound`.
    #[inline(always)]
    pub fn any_above(self, bound: f64) -> bool {
        self.0.iter().fold(false, |any, &x| any | (x > bound))
    }
}

/// Marks the body of a loop over nodes, eddies or samples, so that the compiler fills registers with the
/// lanes of one iteration and not with one lane of several, which gathers and scatters. Costs nothing.
#[inline(always)]
pub fn one_at_a_time() {
    // SAFETY: no instructions, and none of the options promises anything an empty block breaks.
    unsafe { std::arch::asm!("", options(nomem, nostack, preserves_flags)) }
}

macro_rules! lane_operator {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for Lanes {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(from_fn(|i| self.0[i] $op other.0[i]))
            }
        }
    };
}
lane_operator!(Add, add, +);
lane_operator!(Sub, sub, -);
lane_operator!(Mul, mul, *);
lane_operator!(Div, div, /);

impl Mul<f64> for Lanes {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        self * Self::splat(factor)
    }
}

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Lanes {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
