//! Errors. A message names the place, the key, the value, what is allowed, and how to correct it.

mod field;
mod file;
mod flight;
mod profile;
mod record;
mod study;
mod web;

pub use field::FieldFault;
pub use file::{FileError, FileFault, FileKind, FilePlace};
pub use flight::FlightFault;
pub use profile::ProfileFault;
pub use record::RecordFault;
pub(crate) use record::listed;
pub use study::{JournalError, StudyFault};
pub use web::WebFault;

use crate::units::{Dimension, Printable, QuantityFault, shortest};
use std::fmt::{self, Write};

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
    /// The positions of a fibre have become infinite or NaN.
    #[error("replicate {replicate}: node {node} is no longer finite at {time:e} s; {cause}")]
    NotFinite {
        /// The replicate, counted from 1.
        replicate: u64,
        /// Node, counted from 1 at the root.
        node: usize,
        /// Time [s].
        time: f64,
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
    Web(#[from] WebFault),
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
    /// The exit code for a program: 1 if the input is wrong, 2 if the cause is something else.
    pub const fn exit_code(&self) -> u8 {
        match self {
            Self::NotFinite { .. } | Self::Interrupted => 2,
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

/// The place where a value was written.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// In a program that built the case in memory.
    #[default]
    Code,
    /// In a case file.
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

/// A finding about a value of a case. It is shown as `cases/a.toml:12: run.time_step = "50 µs" ` and a text.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding<W> {
    /// The place where the value was written.
    pub place: Place,
    /// Key in the case file, `run.time_step`. Empty if the finding is not about a key.
    pub key: String,
    /// The value as written, or formatted for people. None if there is no value.
    pub value: Option<String>,
    /// What was found.
    pub what: W,
}

/// A reason why a case cannot be run.
pub type Problem = Finding<Fault>;

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

/// What is wrong with a value of a case. The text continues after `key = value `.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// The file is not TOML.
    #[error("not valid TOML: {message}")]
    Syntax {
        /// What the parser says.
        message: String,
    },
    /// The key is written twice.
    #[error("\"{key}\" is written twice; keep one")]
    Duplicate {
        /// The key as written.
        key: String,
    },
    /// The file has a newer version of the format.
    #[error("is newer than the format that this spunlaid reads ({known}); update spunlaid")]
    NewerVersion {
        /// The newest version known.
        known: u32,
    },
    /// The file is a study.
    #[error("belongs to a study, not to a case; read the file as a study")]
    IsStudy,
    /// A required key is missing.
    #[error("is missing; add {line} to [{table}]")]
    Missing {
        /// The table it belongs in.
        table: &'static str,
        /// An example line.
        line: String,
    },
    /// A key that another table needs.
    #[error(
        "is missing, and a case with [{table_there}] needs it; add {line} to [{table}], or leave out [{table_there}]"
    )]
    MissingBeside {
        /// The table that needs it.
        table_there: &'static str,
        /// The table it belongs in.
        table: &'static str,
        /// An example line.
        line: String,
    },
    /// A required key is not there, and the field lacks what would tell it.
    #[error(
        "is missing, and the field does not contain it: {why}; write these arrays too, or add {line} to [{table}]"
    )]
    MissingOfField {
        /// What the field lacks and what it has.
        why: String,
        /// The table it belongs in.
        table: &'static str,
        /// A line that would do.
        line: String,
    },
    /// No table has this name.
    #[error("is not a table of a case file; {}", did_you_mean(nearest, || "the tables are [fibre], [air], [drag] and [run]".into()))]
    UnknownTable {
        /// The most similar table.
        nearest: Option<String>,
    },
    /// No key has this name.
    #[error("is not a key of a case file; {}", did_you_mean(nearest, || format!("{where_} takes {}", all_of(known))))]
    UnknownKey {
        /// The most similar key.
        nearest: Option<String>,
        /// The table, or the top of the file.
        where_: String,
        /// The keys that are known there.
        known: Vec<&'static str>,
    },
    /// The key belongs to another table.
    #[error("is out of place; it belongs in [{table}], as {table}.{key}")]
    Misplaced {
        /// The table it belongs in.
        table: &'static str,
        /// The key.
        key: &'static str,
    },
    /// A value of the wrong kind.
    #[error("is {found}; write {wanted}")]
    WrongType {
        /// The kind found, with an article.
        found: &'static str,
        /// What to write.
        wanted: String,
    },
    /// A quantity that cannot be read.
    #[error(transparent)]
    Quantity(#[from] QuantityFault),
    /// A fault of a study file.
    #[error(transparent)]
    Study(#[from] StudyFault),
    /// A name that the key does not take.
    #[error("is unknown; {}", did_you_mean(nearest, || format!("write {}", one_of(allowed))))]
    NotOneOf {
        /// The most similar name, in quotes.
        nearest: Option<String>,
        /// The names that the key takes.
        allowed: Vec<&'static str>,
    },
    /// A whole number out of range.
    #[error("is out of range; write {}", if least == most { least.to_string() } else { format!("a whole number from {least} to {most}") })]
    OutOfRange {
        /// The smallest allowed.
        least: u64,
        /// The largest allowed.
        most: u64,
    },
    /// NaN or infinite.
    #[error("is not a finite number; write a finite one")]
    NotFinite,
    /// Zero or negative.
    #[error("is not positive; {quantity} above zero is needed")]
    NotPositive {
        /// What is needed, with an article.
        quantity: &'static str,
    },
    /// Negative.
    #[error("is negative; {quantity} of zero or more is needed")]
    Negative {
        /// What is needed, with an article.
        quantity: &'static str,
    },
    /// A file named in the case cannot be used.
    #[error("cannot be used: {0}")]
    File(Box<FileError>),
    /// A temperature for which the viscosity of air is not known.
    #[error(
        "is not between {least} and {most} K, where the formula of the air's viscosity holds; correct the temperature \
         or its unit, or write air.density and air.kinematic_viscosity instead"
    )]
    Temperature {
        /// Lowest temperature [K].
        least: f64,
        /// Highest temperature [K].
        most: f64,
    },
    /// A number that the flow gives already.
    #[error(
        "has no effect because {flow} gives the velocity; leave it out, and scale the flow with air.speed_factor"
    )]
    FlowTells {
        /// The key that names the flow.
        flow: &'static str,
    },
    /// A key that needs another key.
    #[error("has no effect without {needed}; {remedy}")]
    Needs {
        /// What it needs.
        needed: &'static str,
        /// How to correct it.
        remedy: &'static str,
    },
    /// A value that can only be set by reading the case again.
    #[error("is read from a file together with the case; write it in the case file and read the case again")]
    ReadWithCase,
    /// Two keys that exclude each other.
    #[error("cannot be combined with {other}; {remedy}")]
    Excludes {
        /// The other key.
        other: &'static str,
        /// How to correct it.
        remedy: &'static str,
    },
    /// A record that is too short for the flight of a fibre.
    #[error(
        "is too short: the turbulence along one fibre needs {stretches} stretches of {} that start 5 integral times apart, \
         which needs a record of {}; shorten run.duration, lengthen air.length_scale or record for longer",
        Dimension::Time.pretty(*duration), Dimension::Time.pretty_to(*wanted, 3)
    )]
    RecordTooShort {
        /// Number of stretches that one fibre needs.
        stretches: u64,
        /// Length of a stretch [s].
        duration: f64,
        /// Length of a sufficient record [s].
        wanted: f64,
    },
    /// The numbers of records and eddies differ.
    #[error(
        "names {records} records, but the fibre has {eddies} eddies; name one record for all, or one for each eddy"
    )]
    RecordsPerEddy {
        /// Records there are.
        records: usize,
        /// Eddies along the fibre.
        eddies: usize,
    },
    /// Records of different sampling rates.
    #[error(
        "names records of different sampling rates, {first} and {other} Hz; resample them to the same rate"
    )]
    RecordRates {
        /// Of the first [Hz].
        first: f64,
        /// Of another [Hz].
        other: f64,
    },
    /// A direction of length zero.
    #[error("has length zero; write a vector like [1.0, 0.0, 0.0] of any other length")]
    ZeroDirection,
    /// A direction that is not a unit vector, in a case built by a program.
    #[error("is not a unit vector; divide it by its length")]
    NotUnit,
    /// A diameter that is not smaller than the length.
    #[error("is not smaller than fibre.length = {}; a fibre must be longer than it is thick", Dimension::Length.pretty(*length))]
    TooThick {
        /// Length of the fibre [m].
        length: f64,
    },
    /// A time step at or above the stability limit.
    #[error(
        "exceeds the stability limit {} ({cause} of {} elements); lower it to at most {} or lengthen fibre.element_length",
        Dimension::Time.pretty(*limit), Dimension::Length.pretty(*element_length), Dimension::Time.pretty(*advice)
    )]
    StepTooLong {
        /// The limit [s].
        limit: f64,
        /// What sets it.
        cause: &'static str,
        /// Rest length of an element [m].
        element_length: f64,
        /// A stable step [s].
        advice: f64,
    },
    /// A time step in which a fed fibre moves too far.
    #[error(
        "is longer than half the time in which an element of {} is fed; lower it to at most {}, or lengthen \
         fibre.element_length",
        Dimension::Length.pretty(*element_length), Dimension::Time.pretty(*limit)
    )]
    StepOverFeed {
        /// The limit [s].
        limit: f64,
        /// Rest length of an element [m].
        element_length: f64,
    },
    /// Elements that do not fit between inlet and belt.
    #[error(
        "is longer than half of belt.distance = {}, so that the fibre cannot bend on its way; shorten the elements, or \
         correct the distance",
        Dimension::Length.pretty(*distance)
    )]
    TooLongForBelt {
        /// Distance from the inlet to the belt [m].
        distance: f64,
    },
    /// More steps than are allowed.
    #[error(
        "needs {steps:.1e} steps of {}, more than {most:e}; shorten it or lengthen run.time_step",
        Dimension::Time.pretty(*time_step)
    )]
    TooManySteps {
        /// Number of steps.
        steps: f64,
        /// The largest allowed.
        most: f64,
        /// Time step [s].
        time_step: f64,
    },
    /// More memory than is allowed.
    #[error("needs {} of memory for eight fibres side by side, most of it for {what}; at most {} is allowed; {remedy}", memory(*bytes), memory(*most))]
    TooMuchMemory {
        /// Memory needed [bytes].
        bytes: f64,
        /// The most allowed [bytes].
        most: f64,
        /// What needs most of it.
        what: &'static str,
        /// How to correct it.
        remedy: &'static str,
    },
    /// More recorded instants than are allowed.
    #[error(
        "records {instants:.1e} instants over all replicates, more than {most:e}; lengthen it or lower run.replicates"
    )]
    TooManyInstants {
        /// Recorded instants times replicates.
        instants: f64,
        /// The largest allowed.
        most: f64,
    },
    /// A spin-up as long as the run.
    #[error("is not shorter than run.duration = {}, so that no time is left for the statistics; shorten it", Dimension::Time.pretty(*duration))]
    SpinUpTooLong {
        /// Time simulated [s].
        duration: f64,
    },
    /// An interval longer than the run.
    #[error("is longer than run.duration = {}; shorten it", Dimension::Time.pretty(*duration))]
    IntervalTooLong {
        /// Time simulated [s].
        duration: f64,
    },
    /// Values from which a number follows that is too large or too small.
    #[error(
        "makes {what} {}, which is out of the range of floating-point numbers; check the values that it follows from", shortest(*value)
    )]
    Degenerate {
        /// The number that follows from the values.
        what: &'static str,
        /// Its value in SI units.
        value: f64,
    },
}

fn did_you_mean(nearest: &Option<String>, otherwise: impl Fn() -> String) -> String {
    nearest.as_ref().map_or_else(otherwise, |nearest| format!("did you mean {nearest}?"))
}

fn all_of(words: &[&str]) -> String {
    joined(words.iter().map(ToString::to_string).collect(), "and")
}

/// `"a", "b" or "c"`.
pub(crate) fn one_of(words: &[&str]) -> String {
    joined(words.iter().map(|word| format!("\"{word}\"")).collect(), "or")
}

fn joined(mut words: Vec<String>, last: &str) -> String {
    match words.pop() {
        Some(word) if words.is_empty() => word,
        Some(word) => format!("{} {last} {word}", words.join(", ")),
        None => String::new(),
    }
}

/// Memory formatted for people: `3.1 GiB`.
pub(crate) fn memory(bytes: f64) -> String {
    let (unit, size) = [("GiB", 30), ("MiB", 20), ("KiB", 10), ("bytes", 0)]
        .into_iter()
        .map(|(unit, power)| (unit, f64::from(1u32 << power)))
        .find(|(_, size)| bytes >= *size)
        .unwrap_or(("bytes", 1.0));
    let number = bytes / size;
    if number < 1e4 {
        format!("{} {unit}", (number * 10.0).round() / 10.0)
    } else {
        format!("{number:.1e} {unit}")
    }
}
