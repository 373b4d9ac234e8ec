//! Eight numbers side by side: the number type of the kernel.
//!
//! The same arithmetic advances eight independent fibres at once. Every operation acts on each lane alone and is
//! one that IEEE 754 rounds exactly (add, subtract, multiply, divide, square root, fused multiply-add). The result
//! of a lane therefore depends neither on its neighbours nor on the width of the registers: a fibre has the same
//! bits alone and with seven others, on any instruction set.
//!
//! [`Lanes`] is their form in memory, `Wide` their form in registers.

mod abreast;
mod functions;
mod isa;
mod simd;
mod wide;

pub(crate) use functions::{bend_ratio, cos_sin_turn, exp2, log2, power};
pub use isa::Isa;
pub(crate) use isa::Task;
pub(crate) use simd::{Plain, Register, Simd};
pub(crate) use wide::Wide;

use std::array::from_fn;
use std::ops::{Add, Mul, Sub};

/// Number of fibres in a [`Lanes`].
pub const WIDTH: usize = 8;

/// Eight `f64` side by side, one for each fibre of a flight.
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
    pub const fn splat(value: f64) -> Self {
        Self([value; WIDTH])
    }

    /// A value for each lane from its index `0..8`.
    pub fn from_fn(value: impl FnMut(usize) -> f64) -> Self {
        Self(from_fn(value))
    }
}

macro_rules! lane_operator {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for Lanes {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self(from_fn(|i| self.0[i] $op other.0[i]))
            }
        }
    };
}
lane_operator!(Add, add, +);
lane_operator!(Sub, sub, -);
lane_operator!(Mul, mul, *);
