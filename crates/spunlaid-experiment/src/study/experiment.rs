//! What a point of a study repeats: flights of a case, webs, or a spinline.

use spunlaid_fibre::{Case, SpinSpec};
use spunlaid_simulation::WebSpec;

/// What a point repeats, with its seed.
#[derive(Clone, Debug, PartialEq)]
pub enum Experiment {
    /// Each replicate is a fibre of this case, in turbulence of its own. The case has the largest number of replicates
    /// that may be simulated.
    Case(Box<Case>),
    /// Each replicate is such a web, with a seed of its own.
    Web(Box<WebSpec>),
    /// A spinline. Nothing of it is by chance, so one replicate is enough.
    Spinline(Box<SpinSpec>),
}

impl From<Case> for Experiment {
    fn from(case: Case) -> Self {
        Self::Case(Box::new(case))
    }
}

impl From<WebSpec> for Experiment {
    fn from(web: WebSpec) -> Self {
        Self::Web(Box::new(web))
    }
}

impl Experiment {
    /// The case of fibres that are measured themselves.
    pub const fn case(&self) -> Option<&Case> {
        match self {
            Self::Case(case) => Some(case),
            Self::Web(_) | Self::Spinline(_) => None,
        }
    }

    /// The web.
    pub const fn web(&self) -> Option<&WebSpec> {
        match self {
            Self::Web(web) => Some(web),
            Self::Case(_) | Self::Spinline(_) => None,
        }
    }

    /// The spinline.
    pub const fn spinline(&self) -> Option<&SpinSpec> {
        match self {
            Self::Spinline(spec) => Some(spec),
            Self::Case(_) | Self::Web(_) => None,
        }
    }

    /// Whether nothing of it is by chance, so that a single replicate has no error: a spinline, or a fibre in air
    /// without turbulence.
    pub(crate) fn is_exact(&self) -> bool {
        match self {
            Self::Case(case) => case.air.turbulence_intensity == 0.0 && case.air.records.is_empty(),
            Self::Web(_) => false,
            Self::Spinline(_) => true,
        }
    }

    /// The seed of its random numbers.
    pub const fn seed(&self) -> u64 {
        match self {
            Self::Case(case) => case.run.seed,
            Self::Web(web) => web.seed,
            Self::Spinline(_) => 0,
        }
    }

    /// What a replicate is called.
    pub const fn noun(&self) -> &'static str {
        match self {
            Self::Case(_) => "fibre",
            Self::Web(_) => "web",
            Self::Spinline(_) => "spinline",
        }
    }

    /// A checksum over everything on which its records depend.
    pub fn checksum(&self) -> u32 {
        let mut sum = crc32fast::Hasher::new();
        self.enter(&mut sum);
        sum.finalize()
    }

    /// Enters everything on which its records depend into a checksum.
    pub(super) fn enter(&self, sum: &mut crc32fast::Hasher) {
        match self {
            Self::Case(case) => case.enter(sum),
            Self::Spinline(spec) => Case::from(&**spec).enter(sum),
            Self::Web(web) => web.enter(sum),
        }
    }
}
