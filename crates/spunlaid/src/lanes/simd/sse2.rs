//! SSE2, which every x86-64 machine has. It has no fused multiply-add, which is computed in software, exactly but slowly.
//!
//! SAFETY of every block here: every machine of this target has the instructions, and stores go through references.

use super::{Register, Simd};
use crate::lanes::functions::ROUND;
use crate::lanes::{Isa, Lanes};
use std::arch::x86_64::*;

/// Four 128-bit registers.
#[derive(Clone, Copy)]
pub(crate) struct Sse2([__m128d; 4]);

/// The same instruction on all four registers.
macro_rules! quarters {
    ($instruction:ident, $a:expr $(, $other:expr)*) => {
        unsafe { Sse2([
            $instruction($a.0[0] $(, $other.0[0])*),
            $instruction($a.0[1] $(, $other.0[1])*),
            $instruction($a.0[2] $(, $other.0[2])*),
            $instruction($a.0[3] $(, $other.0[3])*),
        ]) }
    };
}

/// The same instruction on the bits of all four registers as integers.
macro_rules! integers {
    ($instruction:ident, $a:expr, $with:expr) => {
        Sse2(std::array::from_fn(|i| unsafe {
            _mm_castsi128_pd($instruction(_mm_castpd_si128($a.0[i]), $with(i)))
        }))
    };
}

impl Register for Sse2 {
    const ISA: Isa = Isa::Baseline;

    #[inline(always)]
    fn store(self) -> Lanes {
        let mut lanes = Lanes::ZERO;
        for (pair, to) in self.0.into_iter().zip(lanes.0.chunks_exact_mut(2)) {
            unsafe { _mm_storeu_pd(to.as_mut_ptr(), pair) };
        }
        lanes
    }
}

impl Simd for Sse2 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([unsafe { _mm_set1_pd(value) }; 4])
    }
    #[inline(always)]
    fn load(lanes: &Lanes) -> Self {
        let pair = |i: usize| unsafe { _mm_set_pd(lanes.0[2 * i + 1], lanes.0[2 * i]) };
        Self([pair(0), pair(1), pair(2), pair(3)])
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        quarters!(_mm_add_pd, self, other)
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        quarters!(_mm_sub_pd, self, other)
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        quarters!(_mm_mul_pd, self, other)
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        quarters!(_mm_div_pd, self, other)
    }
    /// A call: inlined, its eight calls would be most of the library's code, and of its compile time.
    #[inline(never)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        let [a, b, c] = [self, factor, addend].map(Register::store);
        Self::load(&Lanes::from_fn(|i| a.0[i].mul_add(b.0[i], c.0[i])))
    }
    #[inline(always)]
    fn neg_mul_add(self, factor: Self, addend: Self) -> Self {
        self.xor(Self::splat(-0.0)).mul_add(factor, addend)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        quarters!(_mm_sqrt_pd, self)
    }
    #[inline(always)]
    fn floor(self) -> Self {
        let shift = Self::splat(ROUND);
        let near = self.add(shift).sub(shift);
        Self::select_less(self, near, near.sub(Self::splat(1.0)), near)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        quarters!(_mm_max_pd, self, other)
    }
    #[inline(always)]
    fn select_less(a: Self, b: Self, yes: Self, no: Self) -> Self {
        let less = quarters!(_mm_cmplt_pd, a, b);
        let (yes, no) = (quarters!(_mm_and_pd, less, yes), quarters!(_mm_andnot_pd, less, no));
        quarters!(_mm_or_pd, yes, no)
    }
    #[inline(always)]
    fn any_above(self, other: Self) -> bool {
        let Self([a, b, c, d]) = quarters!(_mm_cmpgt_pd, self, other);
        unsafe { _mm_movemask_pd(_mm_or_pd(_mm_or_pd(a, b), _mm_or_pd(c, d))) != 0 }
    }
    #[inline(always)]
    fn and_bits(self, bits: u64) -> Self {
        let mask = Self::splat(f64::from_bits(bits));
        quarters!(_mm_and_pd, self, mask)
    }
    #[inline(always)]
    fn or_bits(self, bits: u64) -> Self {
        let mask = Self::splat(f64::from_bits(bits));
        quarters!(_mm_or_pd, self, mask)
    }
    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        quarters!(_mm_xor_pd, self, other)
    }
    #[inline(always)]
    fn add_as_integers(self, other: Self) -> Self {
        integers!(_mm_add_epi64, self, |i: usize| _mm_castpd_si128(other.0[i]))
    }
    #[inline(always)]
    fn add_bits(self, bits: u64) -> Self {
        integers!(_mm_add_epi64, self, |_| _mm_set1_epi64x(bits as i64))
    }
    #[inline(always)]
    fn shift_right<const N: u32>(self) -> Self {
        integers!(_mm_srl_epi64, self, |_| _mm_cvtsi32_si128(N as i32))
    }
    #[inline(always)]
    fn shift_left<const N: u32>(self) -> Self {
        integers!(_mm_sll_epi64, self, |_| _mm_cvtsi32_si128(N as i32))
    }
}
