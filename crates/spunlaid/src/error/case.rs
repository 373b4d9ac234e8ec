//! What can be wrong with a case.

use super::words::{all_of, did_you_mean};
use super::{FileError, StudyFault, WebFault, memory, one_of};
use crate::units::{Dimension, QuantityFault, shortest};

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
    /// The file is a web.
    #[error("belongs to the file of a web, not to a case; read it as a web")]
    IsWeb,
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
    #[error("is not a table of a case file; {}", did_you_mean(nearest, || format!("the tables are {}", all_of(known))))]
    UnknownTable {
        /// The most similar table.
        nearest: Option<String>,
        /// The tables that are known.
        known: Vec<String>,
    },
    /// No key has this name.
    #[error("is not a key of a case file; {}", did_you_mean(nearest, || format!("{where_} takes {}", all_of(known))))]
    UnknownKey {
        /// The most similar key.
        nearest: Option<String>,
        /// The table, or the top of the file.
        where_: String,
        /// The keys that are known there.
        known: Vec<String>,
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
    /// A fault of the file of a web.
    #[error(transparent)]
    Web(#[from] WebFault),
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
    /// A value that is most likely a slip, and with which something else is wrong with the case.
    #[error("{warning}")]
    Slip {
        /// What is said of it.
        warning: String,
    },
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
        "is too long: an element of {} is fed in {}; lower it to at most {}, or lengthen fibre.element_length",
        Dimension::Length.pretty(*element_length),
        if *steps == 1 { "one step at least".to_owned() } else { format!("{steps} steps at least") },
        Dimension::Time.pretty(*limit)
    )]
    StepOverFeed {
        /// The fewest steps in which an element is fed.
        steps: u64,
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
