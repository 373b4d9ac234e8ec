//! Plain Rust, for any machine.
//!
//! On x86-64 few machines need it, those without AVX2, so its operations are calls there: inlined, they would
//! be a third of the library's compile time and half of the kernel's code. Elsewhere it is the only one and
//! is inlined.

use super::{F32x12, Register, Simd};
use crate::lanes::{Isa, Lanes, WIDTH};
use half::f16;

/// Plain Rust.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub struct Plain([f64; WIDTH]);

impl Plain {
    #[cfg_attr(target_arch = "x86_64", inline(never))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    fn each(self, operation: impl Fn(f64) -> f64) -> Self {
        Self(self.0.map(operation))
    }

    #[cfg_attr(target_arch = "x86_64", inline(never))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    fn pairs(self, other: Self, operation: impl Fn(f64, f64) -> f64) -> Self {
        Self(std::array::from_fn(|i| operation(self.0[i], other.0[i])))
    }

    #[cfg_attr(target_arch = "x86_64", inline(never))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    fn triples(self, b: Self, c: Self, operation: impl Fn(f64, f64, f64) -> f64) -> Self {
        Self(std::array::from_fn(|i| operation(self.0[i], b.0[i], c.0[i])))
    }

    #[inline(always)]
    fn bits(self, operation: impl Fn(u64) -> u64) -> Self {
        self.each(|x| f64::from_bits(operation(x.to_bits())))
    }
}

impl Register for Plain {
    const ISA: Isa = Isa::Baseline;
    type F32x12 = [f32; 12];
    type F32x16 = [f32; 16];

    #[inline(always)]
    fn store(self) -> Lanes {
        Lanes(self.0)
    }
}

impl Simd for Plain {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; WIDTH])
    }
    #[inline(always)]
    fn load(lanes: &Lanes) -> Self {
        Self(lanes.0)
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.pairs(other, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.pairs(other, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.pairs(other, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.pairs(other, |a, b| a / b)
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        self.triples(factor, addend, f64::mul_add)
    }
    #[inline(always)]
    fn neg_mul_add(self, factor: Self, addend: Self) -> Self {
        self.triples(factor, addend, |a, b, c| (-a).mul_add(b, c))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.each(f64::sqrt)
    }
    #[inline(always)]
    fn floor(self) -> Self {
        self.each(f64::floor)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.pairs(other, |a, b| if a > b { a } else { b })
    }
    #[cfg_attr(target_arch = "x86_64", inline(never))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    fn select_less(a: Self, b: Self, yes: Self, no: Self) -> Self {
        Self(std::array::from_fn(|i| if a.0[i] < b.0[i] { yes.0[i] } else { no.0[i] }))
    }
    #[cfg_attr(target_arch = "x86_64", inline(never))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    fn any_above(self, other: Self) -> bool {
        (0..WIDTH).any(|i| self.0[i] > other.0[i])
    }
    #[inline(always)]
    fn and_bits(self, bits: u64) -> Self {
        self.bits(|x| x & bits)
    }
    #[inline(always)]
    fn or_bits(self, bits: u64) -> Self {
        self.bits(|x| x | bits)
    }
    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        self.pairs(other, |a, b| f64::from_bits(a.to_bits() ^ b.to_bits()))
    }
    #[inline(always)]
    fn add_as_integers(self, other: Self) -> Self {
        self.pairs(other, |a, b| f64::from_bits(a.to_bits().wrapping_add(b.to_bits())))
    }
    #[inline(always)]
    fn add_bits(self, bits: u64) -> Self {
        self.bits(|x| x.wrapping_add(bits))
    }
    #[inline(always)]
    fn shift_right<const N: u32>(self) -> Self {
        self.bits(|x| x >> N)
    }
    #[inline(always)]
    fn shift_left<const N: u32>(self) -> Self {
        self.bits(|x| x << N)
    }
}

impl F32x12 for [f32; 12] {
    #[inline(always)]
    fn zero() -> Self {
        [0.0; 12]
    }

    #[inline(always)]
    fn add_weighted(self, row: &[f16; 16], weight: f32) -> Self {
        std::array::from_fn(|i| self[i] + row[i].to_f32() * weight)
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        std::array::from_fn(|i| self[i] + other[i])
    }

    #[inline(always)]
    fn store(self) -> [f32; 16] {
        let mut row = [0.0; 16];
        row[..self.len()].copy_from_slice(&self);
        row
    }
}
