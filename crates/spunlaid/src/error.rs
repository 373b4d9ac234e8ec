//! What can go wrong, and how it is told: where, which key, what value, what is allowed, the way out.

mod field;
mod file;
mod flight;
mod profile;
mod record;
mod study;

pub use field::FieldFault;
pub use file::{FileError, FileFault, FileKind, FilePlace};
pub use flight::FlightFault;
pub use profile::ProfileFault;
pub use record::RecordFault;
pub(crate) use record::listed;
pub use study::{JournalError, StudyFault};

use crate::units::{Dimension, Printable, QuantityFault, shortest};
use std::fmt::{self, Write};

/// What can go wrong.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file cannot be used.
    #[error(transparent)]
    File(#[from] Box<FileError>),
    /// The case cannot be run as it is: everything found, in the order of the file.
    #[error("{}", one_per_line(.0))]
    Rejected(Vec<Problem>),
    /// A fibre's positions are no longer numbers.
    #[error("replicate {replicate}: node {node} is no longer finite at {time:e} s; {cause}")]
    NotFinite {
        /// Which replicate, counted from 1.
        replicate: u64,
        /// Node, counted from 1 at the root.
        node: usize,
        /// Time [s].
        time: f64,
        /// Likely cause and remedy.
        cause: String,
    },
    /// Fibres cannot fly side by side, or a flight cannot do what is asked of it.
    #[error(transparent)]
    Flight(#[from] FlightFault),
    /// The records of a study cannot be read or written.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// Stopped from outside before the end.
    #[error("interrupted before the end")]
    Interrupted,
}

impl Error {
    /// What a program should exit with: 1 the input is wrong, 2 the input is not to blame.
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

/// Most problems that are told at once; more are counted.
const MOST_TOLD: usize = 20;

fn one_per_line(problems: &[Problem]) -> String {
    let mut lines: Vec<String> = problems.iter().take(MOST_TOLD).map(ToString::to_string).collect();
    if problems.len() > MOST_TOLD {
        lines.push(format!("and {} more like these", problems.len() - MOST_TOLD));
    }
    lines.join("\n")
}

/// Where a value was written.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// In a program that built the case itself.
    #[default]
    Code,
    /// In a case file.
    File {
        /// Name of the file, as given.
        file: String,
        /// Line, from 1, where one is to blame.
        line: Option<usize>,
        /// Column, from 1, where one is to blame.
        column: Option<usize>,
    },
    /// In an override, `--set key=value`.
    Override,
    /// At a point of a study.
    Point {
        /// Name of the study file, as given.
        study: String,
        /// Number of the point, from 1.
        number: u64,
        /// What varies, as people read it.
        values: String,
    },
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Code => Ok(()),
            Self::Override => f.write_str("--set "),
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

/// Something found in a case: reads as `cases/a.toml:12: run.time_step = "50 µs" ` and what of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding<W> {
    /// Where the value was written.
    pub place: Place,
    /// Key in the case file, `run.time_step`; empty where no key is to blame.
    pub key: String,
    /// The value as written, or else as people read it; none where there is none.
    pub value: Option<String>,
    /// What of it.
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

/// What is wrong with a value of a case; reads on after `key = value `.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// The file is not TOML.
    #[error("not valid TOML: {message}")]
    Syntax {
        /// What the parser says.
        message: String,
    },
    /// The key is there twice.
    #[error("\"{key}\" is written twice; keep one")]
    Duplicate {
        /// The key as written.
        key: String,
    },
    /// The file is of a later version of the format.
    #[error("is newer than this spunlaid reads ({known}); update spunlaid")]
    NewerVersion {
        /// The newest version known.
        known: u32,
    },
    /// A required key is not there.
    #[error("is missing; add {line} to [{table}]")]
    Missing {
        /// The table it belongs in.
        table: &'static str,
        /// A line that would do.
        line: String,
    },
    /// A required key is not there, and the field lacks what would tell it.
    #[error(
        "is missing, and the field does not tell it: {why}; write these arrays too, or add {line} to [{table}]"
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
        /// The table that may be meant.
        nearest: Option<String>,
    },
    /// No key has this name.
    #[error("is not a key of a case file; {}", did_you_mean(nearest, || format!("{where_} takes {}", all_of(known))))]
    UnknownKey {
        /// The key that may be meant.
        nearest: Option<String>,
        /// The table, or the top of the file.
        where_: String,
        /// What that takes.
        known: Vec<&'static str>,
    },
    /// The key belongs in another table.
    #[error("is out of place; it belongs in [{table}], as {table}.{key}")]
    Misplaced {
        /// The table it belongs in.
        table: &'static str,
        /// The key.
        key: &'static str,
    },
    /// Not the kind of value the key takes.
    #[error("is {found}; write {wanted}")]
    WrongType {
        /// The kind found, with its article.
        found: &'static str,
        /// What to write.
        wanted: String,
    },
    /// A quantity that cannot be read.
    #[error(transparent)]
    Quantity(#[from] QuantityFault),
    /// Something that only a study file has.
    #[error(transparent)]
    Study(#[from] StudyFault),
    /// Not one of the names the key takes.
    #[error("is unknown; {}", did_you_mean(nearest, || format!("write {}", one_of(allowed))))]
    NotOneOf {
        /// What may be meant, in quotes.
        nearest: Option<String>,
        /// The names.
        allowed: Vec<&'static str>,
    },
    /// A whole number out of range.
    #[error("is out of range; write {}", if least == most { least.to_string() } else { format!("a whole number from {least} to {most}") })]
    OutOfRange {
        /// The least allowed.
        least: u64,
        /// The most allowed.
        most: u64,
    },
    /// NaN or infinite.
    #[error("is not a finite number; write one that is")]
    NotFinite,
    /// Zero or negative.
    #[error("is not positive; {quantity} greater than zero is needed here")]
    NotPositive {
        /// What is needed, with its article.
        quantity: &'static str,
    },
    /// Negative.
    #[error("is negative; {quantity} of zero or more is needed here")]
    Negative {
        /// What is needed, with its article.
        quantity: &'static str,
    },
    /// A file that the case names.
    #[error("cannot be used: {0}")]
    File(Box<FileError>),
    /// A number that the flow tells already.
    #[error("has no effect where {flow} tells the velocity; leave it out, and scale with air.speed_factor")]
    FlowTells {
        /// The key that names the flow.
        flow: &'static str,
    },
    /// A key that needs another.
    #[error("has no effect without {needed}; {remedy}")]
    Needs {
        /// What it needs.
        needed: &'static str,
        /// The way out.
        remedy: &'static str,
    },
    /// A value that only reading the case anew can set.
    #[error("is read from a file together with the case; write it in the case file and read that again")]
    ReadWithCase,
    /// Two keys that exclude each other.
    #[error("cannot go with {other}; {remedy}")]
    Excludes {
        /// The other key.
        other: &'static str,
        /// The way out.
        remedy: &'static str,
    },
    /// A record too short for the fibre.
    #[error(
        "is too short: the turbulence along one fibre takes {stretches} stretches of {} that begin 5 integral times apart, \
         a record of {}; shorten run.duration, lengthen air.length_scale or measure for longer",
        Dimension::Time.pretty(*duration), Dimension::Time.pretty_to(*wanted, 3)
    )]
    RecordTooShort {
        /// Stretches that one fibre takes.
        stretches: u64,
        /// Time that each lasts [s].
        duration: f64,
        /// How long a record would do [s].
        wanted: f64,
    },
    /// Another number of records than eddies.
    #[error("names {records} records where the fibre has {eddies} eddies; name one for all, or one for each")]
    RecordsPerEddy {
        /// Records there are.
        records: usize,
        /// Eddies along the fibre.
        eddies: usize,
    },
    /// Records of different sampling rates.
    #[error("names records of different sampling rates, {first} and {other} Hz; resample them to the same")]
    RecordRates {
        /// Of the first [Hz].
        first: f64,
        /// Of another [Hz].
        other: f64,
    },
    /// A direction of length zero.
    #[error("points nowhere; write a vector like [1.0, 0.0, 0.0], of any length but zero")]
    ZeroDirection,
    /// A direction that is not a unit vector, in a case built by a program.
    #[error("is not a unit vector; divide it by its length")]
    NotUnit,
    /// A fibre as thick as long.
    #[error("is not smaller than fibre.length = {}; a fibre is longer than it is thick", Dimension::Length.pretty(*length))]
    TooThick {
        /// Length of the fibre [m].
        length: f64,
    },
    /// A step longer than the explicit schemes bear.
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
        /// A safe step [s].
        advice: f64,
    },
    /// More steps than can be waited for.
    #[error(
        "takes {steps:.1e} steps of {}, more than {most:e}; shorten it or lengthen run.time_step",
        Dimension::Time.pretty(*time_step)
    )]
    TooManySteps {
        /// Number of steps.
        steps: f64,
        /// The most allowed.
        most: f64,
        /// Time step [s].
        time_step: f64,
    },
    /// More than memory holds.
    #[error("needs {} for eight fibres side by side, most of it for {what}, where {} may be taken; {remedy}", memory(*bytes), memory(*most))]
    TooMuchMemory {
        /// How much [bytes].
        bytes: f64,
        /// The most allowed [bytes].
        most: f64,
        /// What takes most of it.
        what: &'static str,
        /// The way out.
        remedy: &'static str,
    },
    /// More results than can be kept.
    #[error(
        "records {records:.1e} instants over all replicates, more than {most:e}; lengthen it or lower run.replicates"
    )]
    TooManyRecords {
        /// Instants times replicates.
        records: f64,
        /// The most allowed.
        most: f64,
    },
    /// A time not shorter than the run.
    #[error("leaves nothing to observe of run.duration = {}; shorten it", Dimension::Time.pretty(*duration))]
    SpinUpTooLong {
        /// Time simulated [s].
        duration: f64,
    },
    /// A time longer than the run.
    #[error("is longer than run.duration = {}; shorten it", Dimension::Time.pretty(*duration))]
    IntervalTooLong {
        /// Time simulated [s].
        duration: f64,
    },
    /// Numbers too large or too small to compute with.
    #[error(
        "makes {what} {}, beyond what can be computed with; check the magnitude of the values it follows from", shortest(*value)
    )]
    Degenerate {
        /// What follows from the values.
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

fn one_of(words: &[&str]) -> String {
    joined(words.iter().map(|word| format!("\"{word}\"")).collect(), "or")
}

fn joined(mut words: Vec<String>, last: &str) -> String {
    match words.pop() {
        Some(word) if words.is_empty() => word,
        Some(word) => format!("{} {last} {word}", words.join(", ")),
        None => String::new(),
    }
}

/// Memory as people read it: `3.1 GiB`.
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
