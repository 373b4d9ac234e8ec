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

pub use functions::{bend_ratio, cos_sin_turn, exp2, indices, integers, log2, power, singles};
pub use isa::Isa;
pub use simd::{F32x12, F32x16, Plain, Register, Simd};
pub use wide::Wide;

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
    #[inline]
    pub const fn splat(value: f64) -> Self {
        Self([value; WIDTH])
    }

    /// A value for each lane from its index `0..8`.
    #[inline]
    pub fn from_fn(mut value: impl FnMut(usize) -> f64) -> Self {
        let mut lanes = Self::ZERO;
        // A loop is compiled faster than `array::from_fn`, of which each closure makes five functions.
        for (lane, number) in lanes.0.iter_mut().enumerate() {
            *number = value(lane);
        }
        lanes
    }
}

macro_rules! lane_operator {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for Lanes {
            type Output = Self;
            #[inline]
            fn $method(self, other: Self) -> Self {
                Self(from_fn(|i| self.0[i] $op other.0[i]))
            }
        }
    };
}
lane_operator!(Add, add, +);
lane_operator!(Sub, sub, -);
lane_operator!(Mul, mul, *);

impl Isa {
    /// Runs `task` compiled for this instruction set, or for the baseline if the machine lacks it.
    ///
    /// Only code that is inlined into the task's `call` is compiled for it.
    #[inline]
    pub fn run<T: Task>(self, task: T) -> T::Output {
        #[cfg(target_arch = "x86_64")]
        {
            if self != Self::Baseline && self.is_available() {
                // SAFETY: the features each function is compiled for were just found on this machine.
                return unsafe {
                    match self {
                        Self::Avx512 => x86::avx512(task),
                        _ => x86::avx2(task),
                    }
                };
            }
        }
        task.call::<Plain>()
    }
}

/// Work that is compiled once for every instruction set.
pub trait Task {
    /// What the work returns.
    type Output;
    /// Does the work. It and everything that it calls must be `#[inline(always)]`.
    fn call<S: Register>(self) -> Self::Output;
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::Task;
    use super::simd::{Avx2, Avx512};

    #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma,f16c")]
    pub(super) fn avx512<T: Task>(task: T) -> T::Output {
        task.call::<Avx512>()
    }

    #[target_feature(enable = "avx2,fma,f16c")]
    pub(super) fn avx2<T: Task>(task: T) -> T::Output {
        task.call::<Avx2>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows by the largest whole number that is not above.
    struct LookUp<'a> {
        table: &'a [[f64; 4]],
        at: Lanes,
    }

    impl Task for LookUp<'_> {
        type Output = ([Lanes; 4], Lanes, [usize; WIDTH]);

        #[inline(always)]
        fn call<S: Register>(self) -> Self::Output {
            let start = Wide::<S>::load(&self.at).floor();
            let indices = indices(start);
            let mut rows = [&self.table[0]; WIDTH];
            for (row, index) in rows.iter_mut().zip(indices) {
                *row = &self.table[index];
            }
            let [a, b, c, d] = S::load_rows(rows);
            ([a.store(), b.store(), c.store(), d.store()], start.store(), indices)
        }
    }

    #[test]
    fn identical_rows_of_a_table_on_every_instruction_set() {
        let table: Vec<[f64; 4]> = (0..70).map(|i| from_fn(|k| f64::from(i) + 0.1 * k as f64)).collect();
        for offset in [0.0, 0.25, 0.5, 0.75, 1.0 - f64::EPSILON] {
            let at = Lanes([0.0, 1.0, 2.0, 33.0, 7.0, 64.0, 65.0, 12.0].map(|whole: f64| whole + offset));
            for isa in Isa::available() {
                let (columns, start, indices) = isa.run(LookUp { table: &table, at });
                for lane in 0..WIDTH {
                    let (x, n) = (at.0[lane], start.0[lane]);
                    assert!(n == x.floor() && n as usize == indices[lane], "{isa:?}: {x} {n}");
                    let row: [f64; 4] = from_fn(|k| columns[k].0[lane]);
                    assert_eq!(row, table[indices[lane]], "{isa:?}");
                }
            }
        }
    }
}
