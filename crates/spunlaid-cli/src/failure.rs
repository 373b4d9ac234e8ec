//! The failures of the program, their messages and exit codes.

use spunlaid::ground::{Error, Fault, FileError};
use std::fmt;
use std::panic::{self, AssertUnwindSafe};
use std::path::PathBuf;

/// What ends the program.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Something that the user can mend, or that the operating system does not allow.
    Error(Error),
    /// Work was interrupted that the same command goes on with: so many things of a kind are done.
    Paused { done: u64, total: Option<u64>, noun: &'static str },
    /// What was tried with a web was interrupted, and the web is in its folder, if there is one.
    Kept { folder: Option<PathBuf> },
    /// The results are written but lack something: lost fibres, or the sources of flights that are not steady.
    Incomplete { what: String },
    /// The program panicked; the message has been printed.
    Panicked,
}

impl Failure {
    /// 1 if the input is wrong, 130 if interrupted, 2 otherwise.
    pub(crate) const fn exit_code(&self) -> u8 {
        match self {
            Self::Error(Error::Interrupted) | Self::Paused { .. } | Self::Kept { .. } => 130,
            Self::Error(error) => error.exit_code(),
            Self::Incomplete { .. } | Self::Panicked => 2,
        }
    }

    /// The failure of work that the same command goes on with where it is interrupted.
    pub(crate) fn or_paused(self, done: u64, total: Option<u64>, noun: &'static str) -> Self {
        match self {
            Self::Error(Error::Interrupted) => Self::Paused { done, total, noun },
            other => other,
        }
    }

    /// Does `work`. A panic in it is a fault of the program and becomes a failure.
    pub(crate) fn catch_panic(work: impl FnOnce() -> Result<(), Self>) -> Result<(), Self> {
        // Nothing that the work has touched is used afterwards.
        panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or(Err(Self::Panicked))
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Error(error)
    }
}

impl From<Fault> for Failure {
    fn from(fault: Fault) -> Self {
        Self::Error(fault.into())
    }
}

impl From<FileError> for Failure {
    fn from(problem: FileError) -> Self {
        Self::Error(Error::File(problem))
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Error(Error::Interrupted) => {
                write!(f, "interrupted; nothing was written. Repeat the command to start again")
            }
            Self::Error(error) => f.write_str(&error.with_options()),
            Self::Paused { done, total, noun } => {
                let total = total.map_or_else(String::new, |total| format!(" of {total}"));
                write!(
                    f,
                    "interrupted; {done}{total} {noun}s are done and kept. Repeat the command to continue"
                )
            }
            Self::Kept { folder: Some(folder) } => write!(
                f,
                "interrupted; the web is complete in {}, with what was tried before. Repeat the command to try the \
                rest",
                folder.display()
            ),
            Self::Kept { folder: None } => {
                write!(f, "interrupted; the web is complete, and it has no folder")
            }
            Self::Incomplete { what } => f.write_str(what),
            Self::Panicked => write!(
                f,
                "the program has a fault, see above; please report it with the case or study that shows it"
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spunlaid::experiment::study::{foreign, in_use, unsynced};
    use spunlaid::ground::Diagnostic;
    use std::io;
    use std::path::Path;

    /// Every failure of the program, and those of the library that are not about the text of an input.
    #[test]
    fn each_failure_has_the_exit_code_of_whose_fault_it_is() {
        let path = Path::new("there");
        let full = || io::Error::from(io::ErrorKind::StorageFull);
        for wrong_input in [
            Failure::from(Fault::plain("there is no such figure")),
            FileError::from(Fault::plain("there is no such file")).into(),
            Error::not_a_run(path, "it is a file").into(),
            Error::Flight(Fault::plain("no fibre")).into(),
            Error::Rejected(Vec::new()).into(),
            in_use(path).into(),
            foreign(path).into(),
        ] {
            assert_eq!(wrong_input.exit_code(), 1, "{wrong_input:?}");
        }
        for not_the_inputs_fault in [
            Failure::from(Error::unwritable(path)(full())),
            Error::System(Box::new(Diagnostic::from(Fault::plain("the page cannot be served")))).into(),
            Failure::Incomplete { what: "1 of 2 fibres was lost".to_owned() },
            Failure::Panicked,
            Error::Diverged {
                replicate: 1,
                node: 2,
                time: 0.1,
                sign: "node 2 is no longer finite".to_owned(),
                cause: "stiff".to_owned(),
            }
            .into(),
            unsynced(&full()).into(),
        ] {
            assert_eq!(not_the_inputs_fault.exit_code(), 2, "{not_the_inputs_fault:?}");
        }
        for interrupted in [
            Failure::Paused { done: 1, total: Some(2), noun: "fibre" },
            Failure::Kept { folder: None },
            Error::Interrupted.into(),
        ] {
            assert_eq!(interrupted.exit_code(), 130, "{interrupted:?}");
        }
    }

    #[test]
    fn each_problem_is_followed_by_its_option() {
        let problems = [("makes 300 points", "--points"), ("is unknown", "")];
        let problems = problems.map(|(text, option)| Fault::new(text, "mend it").option(option).into());
        let message = Failure::from(Error::Rejected(problems.into())).to_string();
        assert_eq!(message, "makes 300 points; mend it (--points)\nis unknown; mend it");
    }

    #[test]
    fn a_panic_is_a_failure_of_the_program() {
        let failure = Failure::catch_panic(|| panic!("as a test of it"));
        assert_eq!(failure.map_err(|failure| failure.exit_code()), Err(2));
        assert!(Failure::catch_panic(|| Ok(())).is_ok());
    }
}
