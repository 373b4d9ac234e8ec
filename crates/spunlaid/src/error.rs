//! Errors. A problem names the place, the key, the value, what is wrong, and what to do about it.

mod fault;
mod field;
mod file;
mod problem;
mod profile;
mod record;
mod scan;
mod words;

pub use fault::Fault;
pub use field::FieldFault;
pub use file::{FileError, FileFault, FileKind, FilePlace};
pub use problem::{Finding, Place, Problem};
pub use profile::ProfileFault;
pub use record::RecordFault;
pub use scan::ScanFault;
pub(crate) use words::{listed, memory, one_of};

use std::path::Path;

/// What can go wrong: what a program must tell apart.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A case, a study or a web cannot be used. All problems found, in the order of the file.
    #[error("{}", one_per_line(.0))]
    Rejected(Vec<Problem>),
    /// A file that cannot be used.
    #[error(transparent)]
    File(#[from] Box<FileError>),
    /// Fibres cannot fly side by side, or a flight cannot do what is asked of it.
    #[error("{0}")]
    Flight(Fault),
    /// A folder of results, or a file in it, is in use or holds something else.
    #[error("{0}")]
    Folder(Box<Problem>),
    /// The operating system does not let a file be read or written.
    #[error("{0}")]
    System(Box<Problem>),
    /// The computation of a fibre has diverged.
    #[error("replicate {replicate}: {sign} at {time:e} s; {cause}")]
    Diverged {
        /// The replicate, counted from 1.
        replicate: u64,
        /// Node, counted from 1 at the root.
        node: usize,
        /// Time [s].
        time: f64,
        /// What shows it: `node 3 is no longer finite`.
        sign: String,
        /// Likely cause and remedy.
        cause: String,
    },
    /// A fed fibre does not come down.
    #[error("replicate {replicate}: {what}")]
    NotLanding {
        /// The replicate, counted from 1.
        replicate: u64,
        /// Time [s].
        time: f64,
        /// What shows it, and what to do about it.
        what: Fault,
    },
    /// The computation was stopped from outside.
    #[error("interrupted before the end")]
    Interrupted,
}

impl Error {
    /// What is wrong with a flight, and what to do about it.
    pub(crate) fn flight(
        message: impl Into<std::borrow::Cow<'static, str>>,
        remedy: impl Into<std::borrow::Cow<'static, str>>,
    ) -> Self {
        Self::Flight(Fault::new(message, remedy))
    }

    /// A flight without fibres.
    pub(crate) fn no_fibre() -> Self {
        Self::Flight(Fault::plain("a flight needs at least one fibre"))
    }

    /// A folder of results, or a file in it, that is in use or holds something else.
    pub fn folder(path: &Path, fault: Fault) -> Self {
        Self::Folder(Box::new(Problem::with_path(path, fault)))
    }

    /// A file that the operating system does not let be read or written.
    pub fn system(path: &Path, fault: Fault) -> Self {
        Self::System(Box::new(Problem::with_path(path, fault)))
    }

    /// The problems that it consists of.
    pub fn problems(&self) -> &[Problem] {
        match self {
            Self::Rejected(problems) => problems,
            Self::Folder(problem) | Self::System(problem) => std::slice::from_ref(problem),
            _ => &[],
        }
    }

    /// What a user of the program types for the remedy of the first problem that has an option. Empty if none has.
    pub fn option(&self) -> &str {
        let mut options = self.problems().iter().map(|problem| &*problem.what.option);
        options.find(|option| !option.is_empty()).unwrap_or_default()
    }

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
            Self::Diverged { .. } | Self::Interrupted | Self::System(_) => 2,
            _ => 1,
        }
    }
}

impl From<FileError> for Error {
    fn from(error: FileError) -> Self {
        Self::File(Box::new(error))
    }
}

impl From<Fault> for Error {
    fn from(fault: Fault) -> Self {
        Self::Rejected(vec![fault.into()])
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
