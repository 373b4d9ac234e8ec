//! AVX-512.
//!
//! SAFETY of every block here: the instructions were found on the machine before [`super::super::Isa::run`] picked the
//! type, and loads and stores go through references.

use super::avx2::columns;
use super::{F32x12, Register, Simd};
use crate::lanes::{Isa, Lanes, WIDTH};
use half::f16;
use std::arch::x86_64::*;

/// One 512-bit register.
#[derive(Clone, Copy)]
pub(crate) struct Avx512(__m512d);

impl Register for Avx512 {
    const ISA: Isa = Isa::Avx512;
    type F32x12 = Avx512F32x12;
    type F32x16 = super::sixteen::OfAvx512;

    #[inline(always)]
    fn store(self) -> Lanes {
        let mut lanes = Lanes::ZERO;
        unsafe { _mm512_store_pd(lanes.0.as_mut_ptr(), self.0) };
        lanes
    }

    #[inline(always)]
    fn load_rows([a, b, c, d, e, f, g, h]: [&[f64; 4]; WIDTH]) -> [Self; 4] {
        unsafe {
            let [l0, l1, l2, l3] = columns([a, b, c, d]);
            let [h0, h1, h2, h3] = columns([e, f, g, h]);
            [
                Self(_mm512_insertf64x4::<1>(_mm512_castpd256_pd512(l0), h0)),
                Self(_mm512_insertf64x4::<1>(_mm512_castpd256_pd512(l1), h1)),
                Self(_mm512_insertf64x4::<1>(_mm512_castpd256_pd512(l2), h2)),
                Self(_mm512_insertf64x4::<1>(_mm512_castpd256_pd512(l3), h3)),
            ]
        }
    }

    #[inline(always)]
    fn store_less(self, a: Self, b: Self, into: &mut [u64; WIDTH]) -> usize {
        unsafe {
            let less = _mm512_cmp_pd_mask::<_CMP_LT_OQ>(a.0, b.0);
            let packed = _mm512_maskz_compress_epi64(less, _mm512_castpd_si512(self.0));
            _mm512_storeu_si512(into.as_mut_ptr().cast(), packed);
            less.count_ones() as usize
        }
    }
}

impl Simd for Avx512 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        unsafe { Self(_mm512_set1_pd(value)) }
    }
    #[inline(always)]
    fn load(lanes: &Lanes) -> Self {
        unsafe { Self(_mm512_load_pd(lanes.0.as_ptr())) }
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        unsafe { Self(_mm512_add_pd(self.0, other.0)) }
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        unsafe { Self(_mm512_sub_pd(self.0, other.0)) }
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        unsafe { Self(_mm512_mul_pd(self.0, other.0)) }
    }
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        unsafe { Self(_mm512_div_pd(self.0, other.0)) }
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        unsafe { Self(_mm512_fmadd_pd(self.0, factor.0, addend.0)) }
    }
    #[inline(always)]
    fn neg_mul_add(self, factor: Self, addend: Self) -> Self {
        unsafe { Self(_mm512_fnmadd_pd(self.0, factor.0, addend.0)) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        unsafe { Self(_mm512_sqrt_pd(self.0)) }
    }
    #[inline(always)]
    fn floor(self) -> Self {
        unsafe { Self(_mm512_roundscale_pd::<{ _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC }>(self.0)) }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        unsafe { Self(_mm512_max_pd(self.0, other.0)) }
    }
    #[inline(always)]
    fn select_less(a: Self, b: Self, yes: Self, no: Self) -> Self {
        unsafe {
            let less = _mm512_cmp_pd_mask::<_CMP_LT_OQ>(a.0, b.0);
            Self(_mm512_mask_blend_pd(less, no.0, yes.0))
        }
    }
    #[inline(always)]
    fn any_above(self, other: Self) -> bool {
        unsafe { _mm512_cmp_pd_mask::<_CMP_GT_OQ>(self.0, other.0) != 0 }
    }
    #[inline(always)]
    fn and_bits(self, bits: u64) -> Self {
        unsafe { Self(_mm512_and_pd(self.0, _mm512_set1_pd(f64::from_bits(bits)))) }
    }
    #[inline(always)]
    fn or_bits(self, bits: u64) -> Self {
        unsafe { Self(_mm512_or_pd(self.0, _mm512_set1_pd(f64::from_bits(bits)))) }
    }
    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        unsafe { Self(_mm512_xor_pd(self.0, other.0)) }
    }
    #[inline(always)]
    fn add_as_integers(self, other: Self) -> Self {
        unsafe {
            let sum = _mm512_add_epi64(_mm512_castpd_si512(self.0), _mm512_castpd_si512(other.0));
            Self(_mm512_castsi512_pd(sum))
        }
    }
    #[inline(always)]
    fn add_bits(self, bits: u64) -> Self {
        unsafe {
            let sum = _mm512_add_epi64(_mm512_castpd_si512(self.0), _mm512_set1_epi64(bits as i64));
            Self(_mm512_castsi512_pd(sum))
        }
    }
    #[inline(always)]
    fn shift_right<const N: u32>(self) -> Self {
        unsafe { Self(_mm512_castsi512_pd(_mm512_srli_epi64::<N>(_mm512_castpd_si512(self.0)))) }
    }
    #[inline(always)]
    fn shift_left<const N: u32>(self) -> Self {
        unsafe { Self(_mm512_castsi512_pd(_mm512_slli_epi64::<N>(_mm512_castpd_si512(self.0)))) }
    }
}

/// Twelve numbers in one register.
#[derive(Clone, Copy)]
pub(crate) struct Avx512F32x12(__m512);

impl F32x12 for Avx512F32x12 {
    #[inline(always)]
    fn zero() -> Self {
        unsafe { Self(_mm512_setzero_ps()) }
    }

    #[inline(always)]
    fn add_weighted(self, row: &[f16; 16], weight: f32) -> Self {
        unsafe {
            let row = _mm512_cvtph_ps(_mm256_loadu_si256(row.as_ptr().cast()));
            Self(_mm512_add_ps(self.0, _mm512_mul_ps(row, _mm512_set1_ps(weight))))
        }
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        unsafe { Self(_mm512_add_ps(self.0, other.0)) }
    }

    #[inline(always)]
    fn store(self) -> [f32; 16] {
        let mut row = [0.0; 16];
        unsafe { _mm512_storeu_ps(row.as_mut_ptr(), self.0) };
        row
    }
}
