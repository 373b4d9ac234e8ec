//! The operations of the kernel for each instruction set.
//!
//! Every operation rounds exactly as IEEE 754 says or moves bits, and so gives the same bits on each of them.
//!
//! ```text
//! plain    plain Rust, for any machine
//! avx2     AVX2, FMA and F16C
//! avx512   AVX-512 F, DQ and VL
//! sixteen  sixteen numbers of single precision, of each of them
//! ```

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod plain;
mod sixteen;

#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::Avx2;
#[cfg(target_arch = "x86_64")]
pub(crate) use avx512::Avx512;
pub use plain::Plain;
pub use sixteen::F32x16;

use super::{Isa, Lanes, WIDTH};
use half::f16;

/// Eight numbers in registers, or several times eight, with the operations that the kernel needs.
///
/// Only [`super::Isa::run`] chooses one of the types that implement it, after it has found the instructions on the
/// machine.
pub trait Simd: Copy {
    /// The same number everywhere.
    fn splat(value: f64) -> Self;
    /// From memory.
    fn load(lanes: &Lanes) -> Self;
    /// `self + other`.
    fn add(self, other: Self) -> Self;
    /// `self − other`.
    fn sub(self, other: Self) -> Self;
    /// `self · other`.
    fn mul(self, other: Self) -> Self;
    /// `self / other`.
    fn div(self, other: Self) -> Self;
    /// `self · factor + addend`, rounded once.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// `addend − self · factor`, rounded once.
    fn neg_mul_add(self, factor: Self, addend: Self) -> Self;
    /// The square root.
    fn sqrt(self) -> Self;
    /// The largest whole number that is not above, for numbers within ±2⁵¹. The sign of a zero is left open.
    fn floor(self) -> Self;
    /// The larger of the two; `other` if one of them is NaN.
    fn max(self, other: Self) -> Self;
    /// `a < b ? yes : no`.
    fn select_less(a: Self, b: Self, yes: Self, no: Self) -> Self;
    /// Whether `self > other` in any lane.
    fn any_above(self, other: Self) -> bool;
    /// The bits that are set in `bits` too.
    fn and_bits(self, bits: u64) -> Self;
    /// With the bits of `bits` set.
    fn or_bits(self, bits: u64) -> Self;
    /// The bits that are set in one of both.
    fn xor(self, other: Self) -> Self;
    /// Adds the bits of both as integers, with wrap-around.
    fn add_as_integers(self, other: Self) -> Self;
    /// Adds an integer to the bits, with wrap-around.
    fn add_bits(self, bits: u64) -> Self;
    /// The bits moved by `N` places.
    fn shift_right<const N: u32>(self) -> Self;
    /// The bits moved by `N` places.
    fn shift_left<const N: u32>(self) -> Self;
}

/// Twelve sums of single precision in registers: of four neighbouring points of a field with three components.
pub trait F32x12: Copy {
    /// Zero everywhere.
    fn zero() -> Self;
    /// `self + row · weight` for the first twelve numbers of a row, rounded after the product and after the sum.
    fn add_weighted(self, row: &[f16; 16], weight: f32) -> Self;
    /// `self + other`.
    fn add(self, other: Self) -> Self;
    /// The sums, and what stands behind them.
    fn store(self) -> [f32; 16];
}

/// [`Simd`] of exactly the eight lanes of a flight.
pub trait Register: Simd {
    /// The instruction set. Work that is seldom done leaves the kernel with it, as a task of its own: what is
    /// inlined is compiled once for every kernel.
    const ISA: Isa;
    /// Its registers of single precision.
    type F32x12: F32x12;
    /// As many numbers of single precision as a register of 512 bits holds.
    type F32x16: F32x16;
    /// Into memory.
    fn store(self) -> Lanes;

    /// Loads a row of four numbers for each lane: the first numbers of all rows, the second, and so on.
    #[inline(always)]
    fn load_rows(rows: [&[f64; 4]; WIDTH]) -> [Self; 4] {
        let mut columns = [Lanes::ZERO; 4];
        for (lane, row) in rows.into_iter().enumerate() {
            for (column, number) in columns.iter_mut().zip(row) {
                column.0[lane] = *number;
            }
        }
        let [a, b, c, d] = &columns;
        [Self::load(a), Self::load(b), Self::load(c), Self::load(d)]
    }

    /// Writes the bits of the lanes in which `a < b` to the start of `into`, one after the other, and returns
    /// their number. What follows them there is left undefined.
    #[inline(always)]
    fn store_less(self, a: Self, b: Self, into: &mut [u64; WIDTH]) -> usize {
        let [bits, a, b] = [self.store(), a.store(), b.store()];
        let mut count = 0;
        for i in 0..WIDTH {
            // An entry that is not wanted is written over by the next.
            into[count % WIDTH] = bits.0[i].to_bits();
            count += usize::from(a.0[i] < b.0[i]);
        }
        count
    }
}
