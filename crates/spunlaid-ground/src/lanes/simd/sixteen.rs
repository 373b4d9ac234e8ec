//! Sixteen numbers of single precision in registers.
//!
//! SAFETY of every block here: the instructions were found on the machine before [`super::super::Isa::run`] picked the
//! type, and loads and stores go through references.

use half::f16;
use half::slice::HalfFloatSliceExt;

/// Sixteen numbers of single precision in registers, each of another signal. Every operation is rounded by itself.
pub trait F32x16: Copy {
    /// The same number everywhere.
    fn splat(value: f32) -> Self;
    /// From memory.
    fn load(numbers: &[f32; 16]) -> Self;
    /// Into memory.
    fn store(self, into: &mut [f32; 16]);
    /// `self + other`.
    fn add(self, other: Self) -> Self;
    /// `self − other`.
    fn sub(self, other: Self) -> Self;
    /// `self · other`.
    fn mul(self, other: Self) -> Self;

    /// Loads numbers of half precision.
    #[inline(always)]
    fn load_halves(halves: &[f16; 16]) -> Self {
        let mut numbers = [0.0; 16];
        halves.convert_to_f32_slice(&mut numbers);
        Self::load(&numbers)
    }

    /// Rounds to half precision.
    #[inline(always)]
    fn store_halves(self, into: &mut [f16; 16]) {
        let mut numbers = [0.0; 16];
        self.store(&mut numbers);
        into.convert_from_f32_slice(&numbers);
    }

    /// Rounds three components to half precision, the three of a signal side by side.
    #[inline(always)]
    fn store_interleaved(components: [Self; 3], into: &mut [f16; 48]) {
        let mut numbers = [0.0; 48];
        for (component, of_signals) in components.into_iter().enumerate() {
            let mut values = [0.0; 16];
            of_signals.store(&mut values);
            for (signal, value) in values.into_iter().enumerate() {
                numbers[3 * signal + component] = value;
            }
        }
        into.convert_from_f32_slice(&numbers);
    }
}

/// On x86-64 they are calls, as those of [`super::Plain`].
impl F32x16 for [f32; 16] {
    #[inline(always)]
    fn splat(value: f32) -> Self {
        [value; 16]
    }
    #[inline(always)]
    fn load(numbers: &[f32; 16]) -> Self {
        *numbers
    }
    #[inline(always)]
    fn store(self, into: &mut [f32; 16]) {
        *into = self;
    }
    #[cfg_attr(target_arch = "x86_64", inline(never))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    fn add(self, other: Self) -> Self {
        std::array::from_fn(|i| self[i] + other[i])
    }
    #[cfg_attr(target_arch = "x86_64", inline(never))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    fn sub(self, other: Self) -> Self {
        std::array::from_fn(|i| self[i] - other[i])
    }
    #[cfg_attr(target_arch = "x86_64", inline(never))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
    fn mul(self, other: Self) -> Self {
        std::array::from_fn(|i| self[i] * other[i])
    }
}

#[cfg(target_arch = "x86_64")]
pub(crate) use x86::{OfAvx2, OfAvx512};

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::F32x16;
    use half::f16;
    use std::arch::x86_64::*;

    /// Two registers of AVX2.
    #[derive(Clone, Copy)]
    pub(crate) struct OfAvx2(__m256, __m256);

    impl F32x16 for OfAvx2 {
        #[inline(always)]
        fn splat(value: f32) -> Self {
            unsafe { Self(_mm256_set1_ps(value), _mm256_set1_ps(value)) }
        }
        #[inline(always)]
        fn load(numbers: &[f32; 16]) -> Self {
            let start = numbers.as_ptr();
            unsafe { Self(_mm256_loadu_ps(start), _mm256_loadu_ps(start.add(8))) }
        }
        #[inline(always)]
        fn store(self, into: &mut [f32; 16]) {
            let start = into.as_mut_ptr();
            unsafe {
                _mm256_storeu_ps(start, self.0);
                _mm256_storeu_ps(start.add(8), self.1);
            }
        }
        #[inline(always)]
        fn add(self, other: Self) -> Self {
            unsafe { Self(_mm256_add_ps(self.0, other.0), _mm256_add_ps(self.1, other.1)) }
        }
        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            unsafe { Self(_mm256_sub_ps(self.0, other.0), _mm256_sub_ps(self.1, other.1)) }
        }
        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            unsafe { Self(_mm256_mul_ps(self.0, other.0), _mm256_mul_ps(self.1, other.1)) }
        }
    }

    /// One register of AVX-512.
    #[derive(Clone, Copy)]
    pub(crate) struct OfAvx512(__m512);

    /// Which of two registers' numbers come where in three registers of neighbouring triples: first of the
    /// first and the second component, and then of those and the third one, which are 16 and above.
    const TRIPLES: [[[i32; 16]; 2]; 3] = {
        let mut order = [[[0; 16]; 2]; 3];
        let mut at = 0;
        while at < 48 {
            let signal = at / 3;
            let component = at % 3;
            let register = at / 16;
            let place = at % 16;
            order[register][0][place] = (signal + 16 * (component % 2)) as i32;
            order[register][1][place] = if component == 2 { 16 + signal as i32 } else { place as i32 };
            at += 1;
        }
        order
    };

    impl F32x16 for OfAvx512 {
        #[inline(always)]
        fn splat(value: f32) -> Self {
            unsafe { Self(_mm512_set1_ps(value)) }
        }
        #[inline(always)]
        fn load(numbers: &[f32; 16]) -> Self {
            unsafe { Self(_mm512_loadu_ps(numbers.as_ptr())) }
        }
        #[inline(always)]
        fn store(self, into: &mut [f32; 16]) {
            unsafe { _mm512_storeu_ps(into.as_mut_ptr(), self.0) }
        }
        #[inline(always)]
        fn add(self, other: Self) -> Self {
            unsafe { Self(_mm512_add_ps(self.0, other.0)) }
        }
        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            unsafe { Self(_mm512_sub_ps(self.0, other.0)) }
        }
        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            unsafe { Self(_mm512_mul_ps(self.0, other.0)) }
        }
        #[inline(always)]
        fn load_halves(halves: &[f16; 16]) -> Self {
            unsafe { Self(_mm512_cvtph_ps(_mm256_loadu_si256(halves.as_ptr().cast()))) }
        }
        #[inline(always)]
        fn store_halves(self, into: &mut [f16; 16]) {
            unsafe {
                let halves = _mm512_cvtps_ph::<_MM_FROUND_TO_NEAREST_INT>(self.0);
                _mm256_storeu_si256(into.as_mut_ptr().cast(), halves);
            }
        }
        #[inline(always)]
        fn store_interleaved([a, b, c]: [Self; 3], into: &mut [f16; 48]) {
            let start = into.as_mut_ptr();
            for (register, [of_both, of_all]) in TRIPLES.iter().enumerate() {
                unsafe {
                    let of_both = _mm512_loadu_si512(of_both.as_ptr().cast());
                    let of_all = _mm512_loadu_si512(of_all.as_ptr().cast());
                    let both = _mm512_permutex2var_ps(a.0, of_both, b.0);
                    let all = _mm512_permutex2var_ps(both, of_all, c.0);
                    let halves = _mm512_cvtps_ph::<_MM_FROUND_TO_NEAREST_INT>(all);
                    _mm256_storeu_si256(start.add(16 * register).cast(), halves);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{Isa, Register, Task};

    struct Halves([[f32; 16]; 3]);

    impl Task for Halves {
        type Output = ([f16; 48], [f16; 16], [f32; 16]);

        #[inline(always)]
        fn call<S: Register>(self) -> Self::Output {
            let [a, b, c] = &self.0;
            let [a, b, c] = [S::F32x16::load(a), S::F32x16::load(b), S::F32x16::load(c)];
            let mut triples = [f16::ZERO; 48];
            let mut halves = [f16::ZERO; 16];
            let mut numbers = [0.0; 16];
            S::F32x16::store_interleaved([a, b, c], &mut triples);
            a.mul(b).sub(c).add(S::F32x16::splat(0.125)).store_halves(&mut halves);
            S::F32x16::load_halves(&halves).store(&mut numbers);
            (triples, halves, numbers)
        }
    }

    #[test]
    fn identical_halves_on_every_instruction_set() {
        let value = |i: usize| [0.7548776, 0.618034, 1.3247179].map(|x: f32| (x * (i * i) as f32).sin());
        let all: [[f32; 3]; 16] = std::array::from_fn(value);
        let components = [0, 1, 2].map(|c| all.map(|of| of[c]));
        for isa in Isa::available() {
            let (triples, halves, numbers) = isa.run(Halves(components));
            for (i, [a, b, c]) in all.into_iter().enumerate() {
                assert_eq!(triples[3 * i..][..3], [a, b, c].map(f16::from_f32), "{isa:?} {i}");
                let half = f16::from_f32(a * b - c + 0.125);
                assert!(halves[i] == half && numbers[i] == half.to_f32(), "{isa:?} {i}");
            }
        }
    }
}
