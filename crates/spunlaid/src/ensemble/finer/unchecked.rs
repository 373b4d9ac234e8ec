//! Why a run has no check.

use std::fmt::{self, Display, Formatter};

/// Why the step or the mesh of a run is not checked. Its text is a sentence without a full stop.
#[derive(Clone, Debug, PartialEq)]
pub enum Unchecked {
    /// The case says so.
    NotAsked,
    /// The results are there before the check has been flown.
    Pending,
    /// It was interrupted.
    Stopped,
    /// It would cost more than it may.
    Dear {
        /// Computing time of a check of the whole run, in computing times of the run.
        times: f64,
    },
    /// There are too few recorded instants, or the fibre does not come down.
    TooShort,
    /// Another reason.
    Other(String),
}

impl Unchecked {
    pub(super) fn beyond() -> Self {
        Self::Other("the finer flights are beyond what the program can fly".to_owned())
    }

    /// Whether the error of the run is left open though it could be known.
    pub const fn leaves_doubt(&self) -> bool {
        matches!(self, Self::Pending | Self::Stopped | Self::Dear { .. })
    }
}

impl Display for Unchecked {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotAsked => write!(f, "it was not asked for"),
            Self::Pending => write!(f, "these results were written before the check was flown"),
            Self::Stopped => write!(f, "it was stopped"),
            Self::Dear { times } => {
                let digits = usize::from(*times < 10.0);
                write!(
                    f,
                    "it would take {times:.digits$} times the computing time of the run; write run.checks = \
                    \"full\" for it"
                )
            }
            Self::TooShort => write!(f, "the run is too short for it"),
            Self::Other(why) => write!(f, "{why}"),
        }
    }
}
