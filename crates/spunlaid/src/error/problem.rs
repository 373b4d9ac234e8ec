//! A problem: what is wrong with something that a user gave, where it was written, and what to do about it.

use super::Fault;
use crate::units::{Printable, excerpt};
use std::fmt::{self, Write};
use std::path::Path;

/// The place where a value was written.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// In a program that built the case in memory.
    #[default]
    Code,
    /// In a file.
    File {
        /// Name of the file, as given.
        file: String,
        /// Line, counted from 1, if known.
        line: Option<usize>,
        /// Column, counted from 1, if known.
        column: Option<usize>,
    },
    /// In an override, which comes before the key in messages: `override`, or the program's word for it.
    Override(String),
    /// At a point of a study.
    Point {
        /// Name of the study file, as given.
        study: String,
        /// Number of the point, counted from 1.
        number: u64,
        /// The varied values as text.
        values: String,
    },
}

impl Place {
    /// A whole file.
    pub fn of_file(path: &Path) -> Self {
        Self::File { file: excerpt(&path.display().to_string(), 1000), line: None, column: None }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Code => Ok(()),
            Self::Override(word) => write!(f, "{word} "),
            Self::Point { study, number, values } => write!(f, "{study}: point {number} ({values}): "),
            Self::File { file, line, column } => {
                f.write_str(file)?;
                for number in [line, column].into_iter().flatten() {
                    write!(f, ":{number}")?;
                }
                f.write_str(": ")
            }
        }
    }
}

/// A finding about a value. It is shown as `cases/a.toml:12: run.time_step = "50 µs" ` and a text.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding<W> {
    /// The place where the value was written.
    pub place: Place,
    /// Key in the file, `run.time_step`. Empty if the finding is not about a key.
    pub key: String,
    /// The value as written, or formatted for people. None if there is no value.
    pub value: Option<String>,
    /// What was found.
    pub what: W,
}

/// A reason why something that a user gave cannot be used.
pub type Problem = Finding<Fault>;

impl Problem {
    /// A problem with a whole file or folder.
    pub fn with_path(path: &Path, what: Fault) -> Self {
        Self { place: Place::of_file(path), ..what.into() }
    }
}

impl From<Fault> for Problem {
    fn from(what: Fault) -> Self {
        Self { place: Place::Code, key: String::new(), value: None, what }
    }
}

impl<W: fmt::Display> fmt::Display for Finding<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut f = Printable(f);
        write!(f, "{}{}", self.place, self.key)?;
        if let Some(value) = &self.value {
            write!(f, " = {value}")?;
        }
        if !self.key.is_empty() {
            f.write_str(" ")?;
        }
        write!(f, "{}", self.what)
    }
}
