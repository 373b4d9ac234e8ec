//! The operations of the kernel for each instruction set.
//!
//! Every operation rounds exactly as IEEE 754 says or moves bits, and so gives the same bits on each of them.

use super::{Lanes, WIDTH};

/// Eight numbers in registers, or several times eight, with the operations that the kernel needs.
///
/// Only [`super::Isa::run`] chooses one of the types that implement it, after it has found the instructions on the
/// machine.
pub(crate) trait Simd: Copy {
    fn splat(value: f64) -> Self;
    fn load(lanes: &Lanes) -> Self;
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn div(self, other: Self) -> Self;
    /// `self · factor + addend`, rounded once.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// `addend − self · factor`, rounded once.
    fn neg_mul_add(self, factor: Self, addend: Self) -> Self;
    fn sqrt(self) -> Self;
    /// The larger of the two; `other` if one of them is NaN.
    fn max(self, other: Self) -> Self;
    /// `a < b ? yes : no`.
    fn select_less(a: Self, b: Self, yes: Self, no: Self) -> Self;
    /// Whether `self > other` in any lane.
    fn any_above(self, other: Self) -> bool;
    fn and_bits(self, bits: u64) -> Self;
    fn or_bits(self, bits: u64) -> Self;
    fn xor(self, other: Self) -> Self;
    /// Adds the bits of both as integers, with wrap-around.
    fn add_as_integers(self, other: Self) -> Self;
    /// Adds an integer to the bits, with wrap-around.
    fn add_bits(self, bits: u64) -> Self;
    fn shift_right<const N: u32>(self) -> Self;
    fn shift_left<const N: u32>(self) -> Self;
}

/// [`Simd`] of exactly the eight lanes of a flight.
pub(crate) trait Register: Simd {
    fn store(self) -> Lanes;
}

/// Plain Rust, for any machine.
///
/// On x86-64 it is for machines without AVX2 only, where a fused multiplication calls a function anyway. There the dearer
/// operations are calls too: inlined, they would be two thirds of the library's code and take most of its compile time.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(crate) struct Plain([f64; WIDTH]);

impl Plain {
    #[inline(always)]
    fn each(self, of: impl Fn(f64) -> f64) -> Self {
        Self(self.0.map(of))
    }

    #[inline(always)]
    fn pairs(self, other: Self, of: impl Fn(f64, f64) -> f64) -> Self {
        Self(std::array::from_fn(|i| of(self.0[i], other.0[i])))
    }

    #[inline(always)]
    fn bits(self, of: impl Fn(u64) -> u64) -> Self {
        self.each(|x| f64::from_bits(of(x.to_bits())))
    }
}

impl Register for Plain {
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
    #[cfg_attr(target_arch = "x86_64", inline(never))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    fn div(self, other: Self) -> Self {
        self.pairs(other, |a, b| a / b)
    }
    #[cfg_attr(target_arch = "x86_64", inline(never))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].mul_add(factor.0[i], addend.0[i])))
    }
    #[cfg_attr(target_arch = "x86_64", inline(never))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    fn neg_mul_add(self, factor: Self, addend: Self) -> Self {
        self.each(|x| -x).mul_add(factor, addend)
    }
    #[cfg_attr(target_arch = "x86_64", inline(never))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    fn sqrt(self) -> Self {
        self.each(f64::sqrt)
    }
    #[cfg_attr(target_arch = "x86_64", inline(never))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
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

#[cfg(target_arch = "x86_64")]
pub(crate) use x86::{Avx2, Avx512};

#[cfg(target_arch = "x86_64")]
mod x86 {
    //! SAFETY of every block here: the instructions were found on the machine before
    //! [`super::super::Isa::run`] picked the type, and loads and stores go through references.

    use super::super::Lanes;
    use super::{Register, Simd};
    use std::arch::x86_64::*;

    /// One 512-bit register.
    #[derive(Clone, Copy)]
    pub(crate) struct Avx512(__m512d);

    /// Two 256-bit registers.
    #[derive(Clone, Copy)]
    pub(crate) struct Avx2(__m256d, __m256d);

    impl Register for Avx512 {
        #[inline(always)]
        fn store(self) -> Lanes {
            let mut lanes = Lanes::ZERO;
            unsafe { _mm512_store_pd(lanes.0.as_mut_ptr(), self.0) };
            lanes
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

    /// The same instruction on both halves. This is a macro because a closure would not be compiled for it.
    macro_rules! halves {
        ($instruction:ident, $a:expr $(, $other:expr)*) => {
            unsafe { Avx2($instruction($a.0 $(, $other.0)*), $instruction($a.1 $(, $other.1)*)) }
        };
    }

    impl Register for Avx2 {
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
}
