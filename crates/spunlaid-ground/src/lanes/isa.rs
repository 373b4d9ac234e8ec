//! The instruction sets, and how work that is compiled for each of them runs on the one that is chosen.

use super::Register;
use super::simd::Plain;

named! {
    /// An instruction set for which the kernel is compiled. All give the same bits; they differ in speed.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Isa {
        /// x86-64 with AVX-512 F, DQ and VL: eight lanes in one register.
        Avx512 = "AVX-512",
        /// x86-64 with AVX2, FMA and F16C: eight lanes in two registers.
        Avx2 = "AVX2",
        /// The instructions that every machine of the target has, in one plain kernel. On x86-64 it is compiled
        /// for size, and fused multiply-add is computed in software, exactly but slowly.
        Baseline = "baseline",
    }
}

impl Isa {
    /// Every instruction set that this machine can run, the fastest first.
    pub fn available() -> Vec<Self> {
        [Self::Avx512, Self::Avx2, Self::Baseline].into_iter().filter(|isa| isa.is_available()).collect()
    }

    /// Whether this machine has the instructions. The answer is kept, so asking is cheap.
    #[inline]
    pub(super) fn is_available(self) -> bool {
        #[cfg(target_arch = "x86_64")]
        match self {
            Self::Avx512 => {
                is_x86_feature_detected!("avx512f")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512vl")
                    && Self::Avx2.is_available()
            }
            Self::Avx2 => {
                is_x86_feature_detected!("avx2")
                    && is_x86_feature_detected!("fma")
                    && is_x86_feature_detected!("f16c")
            }
            Self::Baseline => true,
        }
        #[cfg(not(target_arch = "x86_64"))]
        matches!(self, Self::Baseline)
    }

    /// The fastest instruction set that this machine can run.
    pub fn detect() -> Self {
        Self::available()[0]
    }
}

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
    use crate::lanes::simd::{Avx2, Avx512};

    #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma,f16c")]
    pub(super) fn avx512<T: Task>(task: T) -> T::Output {
        task.call::<Avx512>()
    }

    #[target_feature(enable = "avx2,fma,f16c")]
    pub(super) fn avx2<T: Task>(task: T) -> T::Output {
        task.call::<Avx2>()
    }
}
