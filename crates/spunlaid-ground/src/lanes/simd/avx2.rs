//! AVX2, FMA and F16C.
//!
//! SAFETY of every block here: the instructions were found on the machine before [`super::super::Isa::run`] picked the
//! type, and loads and stores go through references.

use super::{F32x12, Register, Simd};
use crate::lanes::{Isa, Lanes, WIDTH};
use half::f16;
use std::arch::x86_64::*;

/// Two 256-bit registers.
#[derive(Clone, Copy)]
pub(crate) struct Avx2(__m256d, __m256d);

/// The same instruction on both halves. This is a macro because a closure would not be compiled for it.
macro_rules! halves {
    ($instruction:ident, $a:expr $(, $other:expr)*) => {
        unsafe { Avx2($instruction($a.0 $(, $other.0)*), $instruction($a.1 $(, $other.1)*)) }
    };
}

/// Which halves of a register's numbers come first if those in a mask are moved to its start, by the mask.
const PACKED: [[i32; 8]; 16] = {
    let mut all = [[0; 8]; 16];
    let mut mask = 0;
    while mask < 16 {
        let (mut from, mut to) = (0, 0);
        while from < 4 {
            if mask >> from & 1 == 1 {
                all[mask][2 * to] = 2 * from;
                all[mask][2 * to + 1] = 2 * from + 1;
                to += 1;
            }
            from += 1;
        }
        mask += 1;
    }
    all
};

/// The numbers of a mask, moved to the start.
#[inline(always)]
unsafe fn packed(numbers: __m256d, mask: usize) -> __m256i {
    unsafe {
        let order = _mm256_loadu_si256(PACKED[mask & 15].as_ptr().cast());
        _mm256_permutevar8x32_epi32(_mm256_castpd_si256(numbers), order)
    }
}

/// Four rows of four numbers as columns.
///
/// # Safety
/// The machine has AVX.
#[inline(always)]
pub(super) unsafe fn columns(rows: [&[f64; 4]; 4]) -> [__m256d; 4] {
    unsafe {
        let [a, b, c, d] = rows;
        let (a, b) = (_mm256_loadu_pd(a.as_ptr()), _mm256_loadu_pd(b.as_ptr()));
        let (c, d) = (_mm256_loadu_pd(c.as_ptr()), _mm256_loadu_pd(d.as_ptr()));
        let (even_ab, odd_ab) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
        let (even_cd, odd_cd) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
        [
            _mm256_permute2f128_pd::<0x20>(even_ab, even_cd),
            _mm256_permute2f128_pd::<0x20>(odd_ab, odd_cd),
            _mm256_permute2f128_pd::<0x31>(even_ab, even_cd),
            _mm256_permute2f128_pd::<0x31>(odd_ab, odd_cd),
        ]
    }
}

impl Register for Avx2 {
    const ISA: Isa = Isa::Avx2;
    type F32x12 = Avx2F32x12;
    type F32x16 = super::sixteen::OfAvx2;

    #[inline(always)]
    fn store(self) -> Lanes {
        let mut lanes = Lanes::ZERO;
        let start = lanes.0.as_mut_ptr();
        unsafe {
            _mm256_store_pd(start, self.0);
            _mm256_store_pd(start.add(4), self.1);
        }
        lanes
    }

    #[inline(always)]
    fn load_rows([a, b, c, d, e, f, g, h]: [&[f64; 4]; WIDTH]) -> [Self; 4] {
        let ([l0, l1, l2, l3], [h0, h1, h2, h3]) = unsafe { (columns([a, b, c, d]), columns([e, f, g, h])) };
        [Self(l0, h0), Self(l1, h1), Self(l2, h2), Self(l3, h3)]
    }

    #[inline(always)]
    fn store_less(self, a: Self, b: Self, into: &mut [u64; WIDTH]) -> usize {
        unsafe {
            let low = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(a.0, b.0)) as usize;
            let high = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(a.1, b.1)) as usize;
            let count = low.count_ones() as usize;
            let start = into.as_mut_ptr();
            // The second half begins within the first four, so it ends within the eight.
            _mm256_storeu_si256(start.cast(), packed(self.0, low));
            _mm256_storeu_si256(start.add(count).cast(), packed(self.1, high));
            count + high.count_ones() as usize
        }
    }
}

impl Simd for Avx2 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        unsafe { Self(_mm256_set1_pd(value), _mm256_set1_pd(value)) }
    }
    #[inline(always)]
    fn load(lanes: &Lanes) -> Self {
        let start = lanes.0.as_ptr();
        unsafe { Self(_mm256_load_pd(start), _mm256_load_pd(start.add(4))) }
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        halves!(_mm256_add_pd, self, other)
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        halves!(_mm256_sub_pd, self, other)
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        halves!(_mm256_mul_pd, self, other)
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        halves!(_mm256_div_pd, self, other)
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        halves!(_mm256_fmadd_pd, self, factor, addend)
    }
    #[inline(always)]
    fn neg_mul_add(self, factor: Self, addend: Self) -> Self {
        halves!(_mm256_fnmadd_pd, self, factor, addend)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        halves!(_mm256_sqrt_pd, self)
    }
    #[inline(always)]
    fn floor(self) -> Self {
        halves!(_mm256_floor_pd, self)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        halves!(_mm256_max_pd, self, other)
    }
    #[inline(always)]
    fn select_less(a: Self, b: Self, yes: Self, no: Self) -> Self {
        unsafe {
            let low = _mm256_cmp_pd::<_CMP_LT_OQ>(a.0, b.0);
            let high = _mm256_cmp_pd::<_CMP_LT_OQ>(a.1, b.1);
            Self(_mm256_blendv_pd(no.0, yes.0, low), _mm256_blendv_pd(no.1, yes.1, high))
        }
    }
    #[inline(always)]
    fn any_above(self, other: Self) -> bool {
        unsafe {
            let low = _mm256_cmp_pd::<_CMP_GT_OQ>(self.0, other.0);
            let high = _mm256_cmp_pd::<_CMP_GT_OQ>(self.1, other.1);
            _mm256_movemask_pd(_mm256_or_pd(low, high)) != 0
        }
    }
    #[inline(always)]
    fn and_bits(self, bits: u64) -> Self {
        let mask = Self::splat(f64::from_bits(bits));
        halves!(_mm256_and_pd, self, mask)
    }
    #[inline(always)]
    fn or_bits(self, bits: u64) -> Self {
        let mask = Self::splat(f64::from_bits(bits));
        halves!(_mm256_or_pd, self, mask)
    }
    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        halves!(_mm256_xor_pd, self, other)
    }
    #[inline(always)]
    fn add_as_integers(self, other: Self) -> Self {
        unsafe {
            let low = _mm256_add_epi64(_mm256_castpd_si256(self.0), _mm256_castpd_si256(other.0));
            let high = _mm256_add_epi64(_mm256_castpd_si256(self.1), _mm256_castpd_si256(other.1));
            Self(_mm256_castsi256_pd(low), _mm256_castsi256_pd(high))
        }
    }
    #[inline(always)]
    fn add_bits(self, bits: u64) -> Self {
        unsafe {
            let bits = _mm256_set1_epi64x(bits as i64);
            let low = _mm256_add_epi64(_mm256_castpd_si256(self.0), bits);
            let high = _mm256_add_epi64(_mm256_castpd_si256(self.1), bits);
            Self(_mm256_castsi256_pd(low), _mm256_castsi256_pd(high))
        }
    }
    #[inline(always)]
    fn shift_right<const N: u32>(self) -> Self {
        unsafe {
            let count = _mm_cvtsi32_si128(N as i32);
            let low = _mm256_srl_epi64(_mm256_castpd_si256(self.0), count);
            let high = _mm256_srl_epi64(_mm256_castpd_si256(self.1), count);
            Self(_mm256_castsi256_pd(low), _mm256_castsi256_pd(high))
        }
    }
    #[inline(always)]
    fn shift_left<const N: u32>(self) -> Self {
        unsafe {
            let count = _mm_cvtsi32_si128(N as i32);
            let low = _mm256_sll_epi64(_mm256_castpd_si256(self.0), count);
            let high = _mm256_sll_epi64(_mm256_castpd_si256(self.1), count);
            Self(_mm256_castsi256_pd(low), _mm256_castsi256_pd(high))
        }
    }
}

/// Twelve numbers in a large and a small register.
#[derive(Clone, Copy)]
pub(crate) struct Avx2F32x12(__m256, __m128);

impl F32x12 for Avx2F32x12 {
    #[inline(always)]
    fn zero() -> Self {
        unsafe { Self(_mm256_setzero_ps(), _mm_setzero_ps()) }
    }

    #[inline(always)]
    fn add_weighted(self, row: &[f16; 16], weight: f32) -> Self {
        unsafe {
            let start = row.as_ptr();
            let large = _mm256_cvtph_ps(_mm_loadu_si128(start.cast()));
            let small = _mm_cvtph_ps(_mm_loadl_epi64(start.add(8).cast()));
            let large = _mm256_mul_ps(large, _mm256_set1_ps(weight));
            let small = _mm_mul_ps(small, _mm_set1_ps(weight));
            Self(_mm256_add_ps(self.0, large), _mm_add_ps(self.1, small))
        }
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        unsafe { Self(_mm256_add_ps(self.0, other.0), _mm_add_ps(self.1, other.1)) }
    }

    #[inline(always)]
    fn store(self) -> [f32; 16] {
        let mut row = [0.0; 16];
        unsafe {
            _mm256_storeu_ps(row.as_mut_ptr(), self.0);
            _mm_storeu_ps(row.as_mut_ptr().add(8), self.1);
        }
        row
    }
}
