//! Errors. A problem names the place, the key, the value, what is wrong, and what to do about it.

mod diagnostic;
mod fault;
mod file;
mod words;

pub use diagnostic::{Diagnostic, FileError, Place, Position, Severity};
pub use fault::Fault;
pub use file::FileKind;
pub use words::{
    IS, WAS, by_count, by_similarity, counted, excerpt, is_invisible, listed, memory, nearest_word, one_of,
    rounded, shortest,
};

use std::borrow::Cow;
use std::io;
use std::path::Path;

/// What can go wrong: what a program must distinguish.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A case, a study or a web cannot be used. All problems found, in the order of the file.
    #[error("{}", one_per_line(.0))]
    Rejected(Vec<Diagnostic>),
    /// A file that cannot be used.
    #[error("{0}")]
    File(FileError),
    /// Fibres cannot fly side by side, or a flight cannot do what is asked of it.
    #[error("{0}")]
    Flight(Fault),
    /// A folder of results, or a file in it, is in use or holds something else. The reason, and details of it.
    #[error("{}", one_per_line(.0))]
    Folder(Vec<Diagnostic>),
    /// The operating system does not let a file be read or written.
    #[error("{0}")]
    System(Box<Diagnostic>),
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
    pub fn flight(message: impl Into<Cow<'static, str>>, remedy: impl Into<Cow<'static, str>>) -> Self {
        Self::Flight(Fault::new(message, remedy))
    }

    /// Whether it is an error of the values that were asked for: others may do.
    pub const fn is_of_values(&self) -> bool {
        matches!(self, Self::Rejected(_) | Self::Flight(_) | Self::Diverged { .. } | Self::NotLanding { .. })
    }

    /// A flight without fibres.
    pub fn no_fibre() -> Self {
        Self::Flight(Fault::plain("a flight needs at least one fibre"))
    }

    /// A folder of results, or a file in it, that is in use or holds something else.
    pub fn folder(path: &Path, fault: Fault) -> Self {
        Self::Folder(vec![Diagnostic::with_path(path, fault)])
    }

    /// A folder that does not hold the results of a run.
    pub fn not_a_run(folder: &Path, reason: &str) -> Self {
        let message = format!("does not hold the results of a run: {reason}");
        Self::folder(folder, Fault::new(message, "name folders that `spunlaid run` has written"))
    }

    /// A file that the operating system does not let be read or written.
    pub fn system(path: &Path, fault: Fault) -> Self {
        Self::System(Box::new(Diagnostic::with_path(path, fault)))
    }

    /// A file or folder of results that the operating system does not let us write.
    pub fn unwritable(path: &Path) -> impl Fn(io::Error) -> Self + '_ {
        |source| {
            let remedy = match source.kind() {
                io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
                    "free some space, or name another folder"
                }
                io::ErrorKind::FileTooLarge => {
                    "lift the limit of the size of files (ulimit -f), or name a folder on another disk"
                }
                _ => "name another folder",
            };
            let fault = Fault::new(format!("cannot be written: {source}"), remedy);
            Self::system(path, fault.option("--out"))
        }
    }

    /// The problems that it consists of.
    pub fn problems(&self) -> &[Diagnostic] {
        match self {
            Self::Rejected(problems) | Self::Folder(problems) => problems,
            Self::File(problem) | Self::System(problem) => std::slice::from_ref(problem),
            _ => &[],
        }
    }

    /// The message for a user of the program `spunlaid`: each problem is followed by what they type for its remedy.
    pub fn with_options(&self) -> String {
        let shown = |problem: &Diagnostic| match &*problem.cause.option {
            "" => problem.to_string(),
            option => format!("{problem} ({option})"),
        };
        match self.problems() {
            [] => self.to_string(),
            problems => lines(problems, shown),
        }
    }

    /// Node, counted from 1 at the root, and time [s] at which a fibre was lost; `None` for other errors.
    /// Such a replicate is counted as lost, and no mean contains it.
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

impl From<Fault> for Error {
    fn from(fault: Fault) -> Self {
        Self::Rejected(vec![fault.into()])
    }
}

impl From<Box<Diagnostic>> for Error {
    fn from(problem: Box<Diagnostic>) -> Self {
        Self::Rejected(vec![*problem])
    }
}

impl From<Vec<Diagnostic>> for Error {
    fn from(problems: Vec<Diagnostic>) -> Self {
        Self::Rejected(problems)
    }
}

/// Largest number of problems that are listed; further ones are only counted.
const MOST_TOLD: usize = 20;

fn one_per_line(problems: &[Diagnostic]) -> String {
    lines(problems, ToString::to_string)
}

fn lines(problems: &[Diagnostic], shown: impl Fn(&Diagnostic) -> String) -> String {
    let mut lines: Vec<String> = problems.iter().take(MOST_TOLD).map(shown).collect();
    if problems.len() > MOST_TOLD {
        lines.push(format!("and {} more like these", problems.len() - MOST_TOLD));
    }
    lines.join("\n")
}
