//! Errors. A message names the place, the key, the value, what is allowed, and how to correct it.

mod case;
mod divergence;
mod field;
mod file;
mod finding;
mod flight;
mod laying;
mod profile;
mod record;
mod scan;
mod study;
mod web;
mod words;

pub use case::Fault;
pub use divergence::DivergenceSign;
pub use field::FieldFault;
pub use file::{FileError, FileFault, FileKind, FilePlace};
pub use finding::{Finding, Place, Problem};
pub use flight::FlightFault;
pub use laying::LayingFault;
pub use profile::ProfileFault;
pub use record::RecordFault;
pub use scan::ScanFault;
pub use study::{JournalError, StudyFault};
pub use web::WebFault;
pub(crate) use words::{listed, memory, one_of};

use crate::units::Dimension;

/// What can go wrong.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file that cannot be used.
    #[error(transparent)]
    File(#[from] Box<FileError>),
    /// The case cannot be run. All problems found, in the order of the file.
    #[error("{}", one_per_line(.0))]
    Rejected(Vec<Problem>),
    /// The computation of a fibre has diverged.
    #[error("replicate {replicate}: {sign} at {time:e} s; {cause}", sign = sign.at(*node))]
    Diverged {
        /// The replicate, counted from 1.
        replicate: u64,
        /// Node, counted from 1 at the root.
        node: usize,
        /// Time [s].
        time: f64,
        /// What shows it.
        sign: DivergenceSign,
        /// Likely cause and remedy.
        cause: String,
    },
    /// A fed fibre does not come down.
    #[error(
        "replicate {replicate}: the fibre does not reach the belt: after {time:.3} s, {times} times the way to the belt has \
         been fed and has not landed, and the lowest node is {} from the inlet of {}; give faster air towards the belt, more \
         weight, or a belt that is nearer (belt.distance)",
        Dimension::Length.pretty_to(*reached, 3), Dimension::Length.pretty(*distance)
    )]
    NotLanding {
        /// The replicate, counted from 1.
        replicate: u64,
        /// Length of fibre in the air, in distances to the belt.
        times: f64,
        /// Time [s].
        time: f64,
        /// Distance of the lowest node from the inlet [m].
        reached: f64,
        /// Distance to the belt [m].
        distance: f64,
    },
    /// A web cannot be laid.
    #[error(transparent)]
    Laying(#[from] LayingFault),
    /// Fibres cannot fly side by side, or a flight cannot do what is asked of it.
    #[error(transparent)]
    Flight(#[from] FlightFault),
    /// The records of a study cannot be read or written.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// The computation was stopped from outside.
    #[error("interrupted before the end")]
    Interrupted,
}

impl Error {
    /// Node, counted from 1 at the root, and time [s] at which a fibre was lost; `None` for other errors. Such a replicate is
    /// counted as lost, and no mean contains it.
    pub const fn lost_fibre(&self) -> Option<(usize, f64)> {
        match self {
            Self::Diverged { node, time, .. } => Some((*node, *time)),
            Self::NotLanding { time, .. } => Some((1, *time)),
            _ => None,
        }
    }

    /// The exit code for a program: 1 if the input is wrong, 2 if the cause is something else.
    pub const fn exit_code(&self) -> u8 {
        match self {
            Self::Diverged { .. } | Self::Interrupted => 2,
            Self::Journal(
                JournalError::Unusable { .. } | JournalError::Unwritable { .. } | JournalError::Unsynced(_),
            ) => 2,
            _ => 1,
        }
    }
}

impl From<FileError> for Error {
    fn from(error: FileError) -> Self {
        Self::File(Box::new(error))
    }
}

impl From<Box<Problem>> for Error {
    fn from(problem: Box<Problem>) -> Self {
        Self::Rejected(vec![*problem])
    }
}

impl From<Vec<Problem>> for Error {
    fn from(problems: Vec<Problem>) -> Self {
        Self::Rejected(problems)
    }
}

/// Largest number of problems that are listed; further ones are only counted.
const MOST_TOLD: usize = 20;

fn one_per_line(problems: &[Problem]) -> String {
    let mut lines: Vec<String> = problems.iter().take(MOST_TOLD).map(ToString::to_string).collect();
    if problems.len() > MOST_TOLD {
        lines.push(format!("and {} more like these", problems.len() - MOST_TOLD));
    }
    lines.join("\n")
}
