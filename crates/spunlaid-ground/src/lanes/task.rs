//! Runs work that is compiled for each instruction set on the one that is chosen.

use super::simd::Plain;
use super::{Isa, Register};

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
