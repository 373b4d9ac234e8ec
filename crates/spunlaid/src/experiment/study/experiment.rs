//! What a point of a study repeats: flights of a case, webs, or a spinline.

use crate::fibre::case::keys;
use crate::fibre::{Case, SpinSpec};
use crate::simulation::{WEB_KEYS, WebSpec};

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
            Self::Case(case) => enter_keys(sum, case),
            Self::Spinline(spec) => enter_keys(sum, &Case::from(&**spec)),
            Self::Web(web) => {
                for number in 0..web.layers.len() {
                    let alone = web.alone(number);
                    for key in WEB_KEYS {
                        if let Some(value) = key.get(&alone) {
                            sum.update(key.name.as_bytes());
                            sum.update(&value.bytes());
                        }
                    }
                    let layer = &alone.layers[0];
                    // The keys of rows show the first row only.
                    sum.update(format!("{:?}", layer.filaments).as_bytes());
                    layer.source.case().iter().for_each(|case| enter_keys(sum, case));
                }
            }
        }
    }
}

/// Enters the name and the value of every key of a case but those on which no fibre depends. A case that is
/// written and read again has the same values, to the last bit; of files, the contents count.
fn enter_keys(sum: &mut crc32fast::Hasher, case: &Case) {
    for key in keys::all().iter().filter(|key| !["run.replicates", "run.checks"].contains(&key.name)) {
        if let Some(value) = key.get(case) {
            sum.update(key.name.as_bytes());
            // A number that the flow tells along the way is another than the same number everywhere.
            sum.update(&[u8::from(key.is_derived(case))]);
            sum.update(&value.bytes());
        }
    }
}
