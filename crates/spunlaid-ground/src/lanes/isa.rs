//! The instruction sets.

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
