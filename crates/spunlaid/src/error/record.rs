//! Errors of velocity records.

use super::{listed, memory};
use crate::units::{Dimension, shortest};

/// What is wrong with a velocity record, and how to correct it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecordFault {
    /// The Parquet file cannot be decoded.
    #[error(
        "is not a readable Parquet file: {message}; write it with Snappy compression or without compression"
    )]
    Parquet {
        /// Message of the decoder.
        message: String,
    },
    /// A column has a type that cannot hold velocities.
    #[error("holds {found}; a plain column of doubles, floats or integers is needed")]
    ColumnType {
        /// The type found.
        found: String,
    },
    /// No column is a velocity.
    #[error(
        "none of the columns is a velocity ({}); name them like u_m_s, or say which columns are velocities, and in which unit",
        listed(found)
    )]
    NoVelocity {
        /// The columns in the file.
        found: Vec<String>,
    },
    /// There are more than three velocity columns.
    #[error("has {} velocity columns, {}; say which of them to take, one to three", found.len(), listed(found))]
    TooManyComponents {
        /// The columns found.
        found: Vec<String>,
    },
    /// There is neither a time column nor a sampling rate.
    #[error(
        "has no column of time (it has {}); name it like time_s, or give the sampling rate",
        listed(found)
    )]
    NoTime {
        /// The columns in the file.
        found: Vec<String>,
    },
    /// The column that was asked for does not exist.
    #[error("has no column {asked}; there are {}", listed(found))]
    NoSuchColumn {
        /// As asked.
        asked: String,
        /// The columns in the file.
        found: Vec<String>,
    },
    /// The same column was asked for twice.
    #[error("is asked for twice; name each column once")]
    ColumnTwice,
    /// The unit in the header differs from the unit asked for.
    #[error(
        "has the unit {written} in its header, but {asked} was given; give no unit, or correct the header"
    )]
    MixedUnits {
        /// As in the header.
        written: String,
        /// As asked.
        asked: String,
    },
    /// The sampling rate is not positive.
    #[error("a sampling rate of {} Hz is not possible; give a rate above zero", shortest(*rate))]
    Rate {
        /// As given [Hz].
        rate: f64,
    },
    /// The time does not increase.
    #[error(
        "time goes from {} s to {} s; rows must be in order of time. If the times are only written with too few \
         digits, give the sampling rate", shortest(*before), shortest(*after)
    )]
    TimeNotIncreasing {
        /// [s]
        before: f64,
        /// [s]
        after: f64,
    },
    /// The samples are not evenly spaced.
    #[error(
        "the time step changes from {} to {}; samples must be evenly spaced to within 1 %. Resample the record, or \
         give the sampling rate if you know that the clock was even",
        Dimension::Time.pretty(*usual), Dimension::Time.pretty(*step)
    )]
    Uneven {
        /// [s]
        step: f64,
        /// [s]
        usual: f64,
    },
    /// Too many samples in a row are missing.
    #[error(
        "{} samples in a row are missing up to here, more than the {most} that are filled in; cut the record \
         here, or fill in the missing samples", shortest(*missing)
    )]
    GapTooLong {
        /// Missing samples.
        missing: f64,
        /// Most that are filled in.
        most: usize,
    },
    /// The record has too few samples.
    #[error("has {found} samples; at least {least} are needed for statistics of turbulence")]
    TooFewSamples {
        /// Number of samples.
        found: usize,
        /// Least number.
        least: usize,
    },
    /// The record has too many samples.
    #[error("holds more than {most} numbers, which would take more than {} of memory; cut it into pieces", memory(*most as f64 * 8.0))]
    TooManySamples {
        /// Most numbers that are kept.
        most: usize,
    },
    /// The velocity is constant.
    #[error("is constant, {} m/s in every sample; there is no turbulence in it. Is the probe connected?", shortest(*value))]
    Constant {
        /// [m/s]
        value: f64,
    },
    /// The numbers are too large to be squared.
    #[error("holds numbers as large as {} m/s, which cannot be computed with; is the unit right?", shortest(*value))]
    TooLarge {
        /// [m/s]
        value: f64,
    },
    /// The record contains the fluctuation only.
    #[error(
        "the mean velocity is zero within its error ({} ± {} m/s); if the mean has been subtracted, give \
         the mean velocity", shortest(*mean), shortest(*error)
    )]
    NoMean {
        /// [m/s]
        mean: f64,
        /// Half of the 95 % interval [m/s].
        error: f64,
    },
    /// The time of integration is too long for the record.
    #[error(
        "an integral over {} reaches beyond a quarter of the record, {}; give a shorter time",
        Dimension::Time.pretty(*asked), Dimension::Time.pretty(*most)
    )]
    IntegralTooLong {
        /// As asked [s].
        asked: f64,
        /// The longest [s].
        most: f64,
    },
    /// The segment length is not possible.
    #[error(
        "a segment of {asked} samples is not possible; write a power of two from 8 to {most}, like {advice}"
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
