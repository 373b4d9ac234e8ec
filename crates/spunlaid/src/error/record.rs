//! What can be wrong with a velocity record.

use super::{all_of, memory};
use crate::units::{Dimension, QuantityFault, Wanted, shortest};
use std::fmt;

/// Where in a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordPlace {
    /// Nowhere in particular.
    Whole,
    /// A line of a text file, from 1.
    Line(u64),
    /// A row of a table, from 1.
    Row(u64),
}

/// A reason why a velocity record cannot be used: reads as `wire.csv:12: column u_m_s: "x" is not a number…`.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordProblem {
    /// Name of the file, as given.
    pub file: String,
    /// Where in it.
    pub place: RecordPlace,
    /// The column, as the file calls it, where one is to blame.
    pub column: Option<String>,
    /// What is wrong.
    pub fault: RecordFault,
}

impl fmt::Display for RecordProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        match self.place {
            RecordPlace::Whole => f.write_str(": ")?,
            RecordPlace::Line(line) => write!(f, ":{line}: ")?,
            RecordPlace::Row(row) => write!(f, ": row {row}: ")?,
        }
        if let Some(column) = &self.column {
            write!(f, "column {column}: ")?;
        }
        self.fault.fmt(f)
    }
}

/// What is wrong with a velocity record, and the way out.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecordFault {
    /// No such file.
    #[error("there is no such file; name a velocity record, CSV or Parquet")]
    NotThere,
    /// A folder.
    #[error("is a folder; name the record in it")]
    IsFolder,
    /// The system does not let it be read.
    #[error("cannot be read: {message}")]
    Unreadable {
        /// What the system says.
        message: String,
    },
    /// A binary file, or text in two-byte characters.
    #[error("is not plain text; a record is CSV in UTF-8 or Latin-1, or a Parquet file")]
    NotText,
    /// A line without end.
    #[error(
        "this line is longer than {most} bytes, which no row of a record is; end each row with a line break"
    )]
    LineTooLong {
        /// The longest line read [bytes].
        most: usize,
    },
    /// Parquet that cannot be decoded.
    #[error("is no Parquet file that can be read: {message}; write it with Snappy compression or none")]
    Parquet {
        /// What the decoder says.
        message: String,
    },
    /// A column of a type that holds no velocities.
    #[error("holds {found}; a plain column of doubles, floats or integers is needed")]
    ColumnType {
        /// The type found.
        found: String,
    },
    /// No rows of data.
    #[error("holds no rows of numbers; a row for each sample is needed")]
    Empty,
    /// No velocity among the columns.
    #[error(
        "no column is a velocity, among {}; name them like u_m_s, or pick them with --columns and --velocity-unit",
        listed(found)
    )]
    NoVelocity {
        /// The columns there are.
        found: Vec<String>,
    },
    /// More velocities than directions.
    #[error("has {} velocity columns, {}; pick one to three with --columns", found.len(), listed(found))]
    TooManyComponents {
        /// The columns found.
        found: Vec<String>,
    },
    /// No time and no rate.
    #[error(
        "has no column of time, among {}; name it like time_s, or give the sampling rate, --rate \"20 kHz\"",
        listed(found)
    )]
    NoTime {
        /// The columns there are.
        found: Vec<String>,
    },
    /// A column asked for that is not there.
    #[error("has no column {asked}; there are {}", listed(found))]
    NoSuchColumn {
        /// As asked.
        asked: String,
        /// The columns there are.
        found: Vec<String>,
    },
    /// The same column asked for twice.
    #[error("is asked for twice; name each column once")]
    ColumnTwice,
    /// A column without a unit.
    #[error("has no unit; write it in the header, {example}, or say {flag}")]
    NoUnit {
        /// A header that would do.
        example: &'static str,
        /// An option that would do.
        flag: &'static str,
    },
    /// A unit of something else.
    #[error("has the unit \"{unit}\"; {} is needed", Wanted(*wanted))]
    WrongUnit {
        /// As written.
        unit: String,
        /// What is needed.
        wanted: Dimension,
    },
    /// The header and the command line do not agree.
    #[error(
        "is in {written} by its header and in {asked} by {flag}; leave the option out, or mend the header"
    )]
    MixedUnits {
        /// As in the header.
        written: String,
        /// As asked.
        asked: String,
        /// The option.
        flag: &'static str,
    },
    /// An option with a quantity that cannot be read.
    #[error("{option} {fault}")]
    Option {
        /// The option and its value.
        option: String,
        /// What is wrong with it.
        fault: QuantityFault,
    },
    /// A rate that is none.
    #[error("a sampling rate of {} Hz is not one; give one above zero", shortest(*rate))]
    Rate {
        /// As given [Hz].
        rate: f64,
    },
    /// A row with cells missing or too many.
    #[error("this row has {found} cells where {wanted} are needed; {}", if found < wanted { "is the file cut off here?" } else { "do decimal commas meet a comma between cells?" })]
    Cells {
        /// Cells there are.
        found: usize,
        /// Cells needed.
        wanted: usize,
    },
    /// A cell that is no number.
    #[error("\"{text}\" is not a number; write one, or leave the cell empty where a sample is missing")]
    NotANumber {
        /// The cell.
        text: String,
    },
    /// An infinite number.
    #[error("\"{text}\" is not finite; leave the cell empty where a sample is missing")]
    NotFinite {
        /// The cell.
        text: String,
    },
    /// Decimal points and decimal commas in one file.
    #[error(
        "\"{text}\" has the other decimal sign than the rows before; write all numbers with a point, or all with a comma"
    )]
    MixedDecimals {
        /// The cell.
        text: String,
    },
    /// Time that stands still or runs back.
    #[error(
        "time goes from {} s to {} s; rows must be in order of time. If the times are only written with too few \
         digits, give the sampling rate with --rate", shortest(*before), shortest(*after)
    )]
    TimeNotIncreasing {
        /// [s]
        before: f64,
        /// [s]
        after: f64,
    },
    /// A step unlike the others.
    #[error(
        "a step of {} after steps of {}; samples must be evenly spaced to within 1 %. Resample the record, or \
         give --rate if the clock was even all the same",
        Dimension::Time.pretty(*step), Dimension::Time.pretty(*usual)
    )]
    Uneven {
        /// [s]
        step: f64,
        /// [s]
        usual: f64,
    },
    /// Too many samples missing in a row.
    #[error(
        "{} samples in a row are missing up to here, more than the {most} that are filled in; cut the record \
         here, or allow more with --max-gap", shortest(*missing)
    )]
    GapTooLong {
        /// Missing samples.
        missing: f64,
        /// Most that are filled in.
        most: usize,
    },
    /// Too few samples.
    #[error("holds {found} samples; at least {least} are needed to say anything about turbulence")]
    TooFewSamples {
        /// Samples there are.
        found: usize,
        /// Least number.
        least: usize,
    },
    /// More than can be kept.
    #[error("holds more than {most} numbers, which would take more than {} of memory; cut it in pieces", memory(*most as f64 * 8.0))]
    TooManySamples {
        /// Most numbers that are kept.
        most: usize,
    },
    /// Nothing fluctuates.
    #[error("is constant, {} m/s in every sample; there is no turbulence in it. Is the probe connected?", shortest(*value))]
    Constant {
        /// [m/s]
        value: f64,
    },
    /// Numbers too large to square.
    #[error("holds numbers as large as {} m/s, which cannot be computed with; is the unit right?", shortest(*value))]
    TooLarge {
        /// [m/s]
        value: f64,
    },
    /// A record of the fluctuation alone.
    #[error(
        "the mean velocity is zero within its error ({} ± {} m/s); if the mean was taken off the record, give \
         it with --mean-velocity \"10 m/s\"", shortest(*mean), shortest(*error)
    )]
    NoMean {
        /// [m/s]
        mean: f64,
        /// Half of the 95 % interval [m/s].
        error: f64,
    },
    /// An integral over more than the record bears.
    #[error(
        "--integral fixed={} reaches beyond a quarter of the record, {}; give a shorter time",
        Dimension::Time.pretty(*asked), Dimension::Time.pretty(*most)
    )]
    IntegralTooLong {
        /// As asked [s].
        asked: f64,
        /// The longest [s].
        most: f64,
    },
    /// Segments that do not fit.
    #[error(
        "--segment {asked} is not a power of two from 8 to {most}, the samples of this record; try {advice}"
    )]
    Segment {
        /// As asked.
        asked: usize,
        /// The longest that fits.
        most: usize,
        /// One that would do.
        advice: usize,
    },
}

pub(super) fn listed(names: &[String]) -> String {
    const MOST: usize = 12;
    let mut shown: Vec<&str> = names.iter().take(MOST).map(String::as_str).collect();
    let more = format!("{} more", names.len().saturating_sub(MOST));
    if names.len() > MOST {
        shown.push(&more);
    }
    if shown.is_empty() { "none".to_owned() } else { all_of(&shown) }
}
