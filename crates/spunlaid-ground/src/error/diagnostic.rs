//! A diagnostic: an error, a warning or a note about something that a user gave, with the place where it was written.

use super::Fault;
use super::words::{Printable, excerpt};
use std::borrow::Cow;
use std::fmt::{self, Write};
use std::panic::Location;
use std::path::Path;

/// A position in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Position {
    /// The whole file.
    #[default]
    Whole,
    /// A line of a text file, counted from 1.
    Line(u64),
    /// A character of a text file.
    Character {
        /// Its line, counted from 1.
        line: u64,
        /// Its place in the line, counted from 1.
        column: u64,
    },
    /// A row of a binary table, counted from 1.
    Row(u64),
    /// A byte of a file, counted from 1.
    Byte(u64),
    /// A point, counted from 1.
    Point(u64),
    /// A cell of a mesh, counted from 1.
    Cell(u64),
}

/// The place where a value was written.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// In a program that built the case in memory.
    #[default]
    Code,
    /// In a file.
    File {
        /// Name of the file, as given. Empty if there is no file.
        file: String,
        /// The position in it.
        position: Position,
        /// The column or array that is wrong, if it is known: `column u_m_s`.
        part: Option<String>,
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
    /// A position in the file of this name.
    pub fn in_file(name: &str, position: Position) -> Self {
        Self::File { file: excerpt(name, 1000), position, part: None }
    }

    /// The line of a text file, counted from 1, if it is known.
    pub const fn line(&self) -> Option<u64> {
        match self {
            Self::File { position: Position::Line(line) | Position::Character { line, .. }, .. } => {
                Some(*line)
            }
            _ => None,
        }
    }

    /// The character of the line, counted from 1, if it is known.
    pub const fn column(&self) -> Option<u64> {
        match self {
            Self::File { position: Position::Character { column, .. }, .. } => Some(*column),
            _ => None,
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (file, position, part) = match self {
            Self::Code => return Ok(()),
            Self::Override(word) => return write!(f, "{word} "),
            Self::Point { study, number, values } => {
                return write!(f, "{study}: point {number} ({values}): ");
            }
            Self::File { file, position, part } => (file, *position, part),
        };
        f.write_str(file)?;
        match position {
            Position::Line(line) => write!(f, ":{line}")?,
            Position::Character { line, column } => write!(f, ":{line}:{column}")?,
            _ => {}
        }
        if !file.is_empty() {
            f.write_str(": ")?;
        }
        match position {
            Position::Whole | Position::Line(_) | Position::Character { .. } => {}
            Position::Row(row) => write!(f, "row {row}: ")?,
            Position::Byte(byte) => write!(f, "byte {byte}: ")?,
            Position::Point(point) => write!(f, "point {point}: ")?,
            Position::Cell(cell) => write!(f, "cell {cell}: ")?,
        }
        part.iter().try_for_each(|part| write!(f, "{part}: "))
    }
}

/// How much a diagnostic matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// A choice of the program, which is no flaw: the input with every default written out has it.
    Choice,
    /// For example on rounding.
    Note,
    /// The results may mislead.
    Warning,
    /// A warning about a number that nothing real is known to have.
    Implausible,
    /// The input cannot be used.
    Error,
}

/// From how many times outside of what is usual on a number is taken for a slip.
const ABSURD: f64 = 10.0;

/// An error, a warning or a note about something that a user gave.
///
/// It is shown as `cases/a.toml:12: run.time_step = "50 µs" ` and its cause.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// How much it matters.
    pub severity: Severity,
    /// The place where the value was written.
    pub place: Place,
    /// Key in the file, `run.time_step`. Empty if it is not about a key.
    pub key: String,
    /// The value as written, or formatted for people. None if there is no value.
    pub value: Option<String>,
    /// What is wrong or worth a note, and what to do about it.
    pub cause: Fault,
    /// Whether its number is outside of the usual range.
    pub is_unusual: bool,
    /// Whether its number is outside of the usual range by a factor of ten or more, as after a slip of a unit.
    pub is_absurd: bool,
    /// Where in the program a note or a warning arises: all from there are of one kind.
    pub origin: Option<&'static Location<'static>>,
}

/// A problem with a file, as readers return it: `wire.csv:12: column u_m_s: "x" is not a number…`.
pub type FileError = Box<Diagnostic>;

impl Diagnostic {
    /// A problem with a whole file or folder.
    pub fn with_path(path: &Path, cause: Fault) -> Self {
        let place = Place::in_file(&path.display().to_string(), Position::Whole);
        Self { place, ..cause.into() }
    }

    /// A choice of the program, without its place.
    #[track_caller]
    pub fn choice(text: impl Into<Cow<'static, str>>) -> Self {
        Self::remark(Severity::Choice, text)
    }

    /// A note, without its place.
    #[track_caller]
    pub fn note(text: impl Into<Cow<'static, str>>) -> Self {
        Self::remark(Severity::Note, text)
    }

    /// A warning, without its place.
    #[track_caller]
    pub fn warning(text: impl Into<Cow<'static, str>>) -> Self {
        Self::remark(Severity::Warning, text)
    }

    /// A warning about a number that nothing real is known to have, without its place.
    #[track_caller]
    pub fn implausible(text: impl Into<Cow<'static, str>>) -> Self {
        Self::remark(Severity::Implausible, text)
    }

    #[track_caller]
    fn remark(severity: Severity, text: impl Into<Cow<'static, str>>) -> Self {
        Self { severity, origin: Some(Location::caller()), ..Fault::plain(text).into() }
    }

    /// The same of a number that is so many times outside of what is usual.
    #[must_use]
    pub fn outside_by(self, times: f64) -> Self {
        Self { is_unusual: times > 0.0, is_absurd: times >= ABSURD, ..self }
    }

    /// The same about a key: `run.time_step`.
    #[must_use]
    pub fn with_key(self, key: impl Into<String>, value: Option<String>) -> Self {
        Self { key: key.into(), value, ..self }
    }

    /// The same as an error: where something else is wrong with the input, a warning may be its cause.
    #[must_use]
    pub fn into_error(self) -> Self {
        Self { severity: Severity::Error, ..self }
    }

    /// The same about one file of several.
    #[must_use]
    pub fn of_file(mut self, file: &str) -> Self {
        self.cause.message = format!("{file}: {}", self.cause.message).into();
        self
    }

    /// The text without the place, for a reader who sees the value.
    pub fn without_place(&self) -> String {
        Self { place: Place::Code, ..self.clone() }.to_string()
    }

    /// Whether the results may mislead. Otherwise it is a note, for example on rounding.
    pub fn is_warning(&self) -> bool {
        self.severity >= Severity::Warning
    }

    /// Whether another one says the same about the same key, perhaps with other numbers.
    pub fn is_like(&self, other: &Self) -> bool {
        self.origin == other.origin && self.key == other.key
    }

    /// The notes that go with results: all but choices.
    pub fn notes_of_results(notes: &[Self]) -> Vec<String> {
        notes.iter().filter(|note| note.severity > Severity::Choice).map(Self::to_string).collect()
    }

    /// Changes what is known of the place in the file.
    fn placed(
        mut self: Box<Self>,
        change: impl FnOnce(&mut String, &mut Position, &mut Option<String>),
    ) -> Box<Self> {
        if !matches!(self.place, Place::File { .. }) {
            self.place = Place::in_file("", Position::Whole);
        }
        if let Place::File { file, position, part } = &mut self.place {
            change(file, position, part);
        }
        self
    }

    /// Adds a position in the file, unless one is known already.
    #[must_use]
    pub fn at(self: Box<Self>, place: Position) -> Box<Self> {
        self.placed(|_, position, _| {
            if *position == Position::Whole {
                *position = place;
            }
        })
    }

    /// Adds the name of an array, unless a part is known already.
    #[must_use]
    pub fn array(self: Box<Self>, name: &str) -> Box<Self> {
        self.placed(|_, _, part| {
            part.get_or_insert_with(|| excerpt(name, 40));
        })
    }

    /// Adds the name of a column, unless a part is known already.
    #[must_use]
    pub fn column(self: Box<Self>, name: &str) -> Box<Self> {
        self.placed(|_, _, part| {
            // A column without a name is called by its number.
            let word = if name.starts_with("column ") { "" } else { "column " };
            part.get_or_insert_with(|| format!("{word}{}", excerpt(name, 40)));
        })
    }

    /// Adds the name of the file, unless it is known already.
    #[must_use]
    pub fn file(self: Box<Self>, name: &str) -> Box<Self> {
        self.placed(|file, _, _| {
            if file.is_empty() {
                *file = excerpt(name, 1000);
            }
        })
    }

    /// Adds the path of the file, unless it is known already.
    #[must_use]
    pub fn path(self: Box<Self>, path: &Path) -> Box<Self> {
        self.file(&path.display().to_string())
    }

    /// Turns the byte of a text file into its line.
    #[must_use]
    pub fn in_text(self: Box<Self>, text: &[u8]) -> Box<Self> {
        self.placed(|_, position, _| {
            if let Position::Byte(byte) = *position {
                let before = text.iter().take(byte.saturating_sub(1) as usize);
                *position = Position::Line(before.filter(|byte| **byte == b'\n').count() as u64 + 1);
            }
        })
    }
}

impl From<Fault> for Diagnostic {
    fn from(cause: Fault) -> Self {
        Self {
            severity: Severity::Error,
            place: Place::Code,
            key: String::new(),
            value: None,
            cause,
            is_unusual: false,
            is_absurd: false,
            origin: None,
        }
    }
}

impl From<Fault> for FileError {
    fn from(cause: Fault) -> Self {
        Self::new(cause.into())
    }
}

/// The fault of a key that names a file which cannot be used.
impl From<FileError> for Fault {
    fn from(error: FileError) -> Self {
        // Options of the program are for a file that is named on the command line.
        let Diagnostic { place, key, value, cause: Self { message, remedy, .. }, .. } = *error;
        let named = match (key.as_str(), value) {
            ("", _) => String::new(),
            (key, Some(value)) => format!("{key} = {value} "),
            (key, None) => format!("{key} "),
        };
        Self::new(format!("cannot be used: {place}{named}{message}"), remedy)
    }
}

impl std::error::Error for Diagnostic {}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut f = Printable(f);
        write!(f, "{}{}", self.place, self.key)?;
        if let Some(value) = &self.value {
            write!(f, " = {value}")?;
        }
        if !self.key.is_empty() {
            f.write_str(" ")?;
        }
        write!(f, "{}", self.cause)
    }
}
