//! Velocity records of hot wires and lasers, and the statistics of the air in them.
//!
//! file (CSV, Parquet) → [`Record`] (evenly sampled, SI) → [`analyse`] → [`Analysis`]
//!
//! **The input** is the velocity at a point over time: a row for each sample, a column of time, and one to
//! three columns of velocity. The header gives the units: `time_ms`, `u [m/s]`; times may also be stamps, ISO
//! or German. A [`Layout`] gives what the file does not: sampling rate, units, columns to use.
//!
//! | format | what is read |
//! |---|---|
//! | text | as [`spunlaid_ground::table`] describes; without a column of time an empty line is a missing sample |
//! | Parquet | columns of numbers or times by their logical types, with nulls; uncompressed or Snappy |
//!
//! **The results**, with 95 % confidence intervals, are mean velocity [m/s], turbulence intensity [-],
//! integral time [s], length scale [m] and cut-off frequency [Hz]; for each component also rms, skewness,
//! flatness, spectrum [(m/s)²/Hz] and autocorrelation; and warnings, each with what to do about it. The
//! formulas are in `docs/analyse.md` of the repository.
//!
//! **Limits.** Samples are evenly spaced to within 1 %; up to [`LONGEST_GAP`] missing samples in a row are
//! interpolated linearly. A record has at least 64 samples and at most `MOST_NUMBERS` numbers of 8 bytes.
//! Text is read line by line, Parquet as a whole.
//!
//! ```
//! use spunlaid_air::record::{Layout, Settings, analyse, parse_csv};
//!
//! # fn main() -> Result<(), spunlaid_ground::error::FileError> {
//! let mut text = String::from("time_ms;u_m_s\n");
//! for i in 0..2000 {
//!     let u = 10.0 + f64::from(i * i % 1009) / 1009.0;
//!     text.push_str(&format!("{};{u:.3}\n", i).replace('.', ","));
//! }
//! let record = parse_csv(text.as_bytes(), "wire.csv", &Layout::default())?;
//! let analysis = analyse(&record, &Settings::default())?;
//! assert!((analysis.mean_velocity.value - 10.5).abs() < 0.02);
//! # Ok(())
//! # }
//! ```

mod analysis;
mod artefacts;
mod clock;
mod columns;
mod compute;
mod correlation;
mod doubts;
mod flat;
mod grid;
mod interval;
mod jackknife;
mod measures;
mod parquet;
mod rows;
mod text;

use spunlaid_ground::error::counted;
use spunlaid_ground::units::{rounded, shortest};
use spunlaid_ground::{Dimension, Fault, FileError, FileKind, file};
use std::io::Read;
use std::path::Path;

pub use analysis::{Analysis, Component, Settings, SpectrumSettings};
pub use compute::analyse;
pub use compute::analyse_fluctuation;
pub use correlation::{Autocorrelation, IntegralRule};
pub use flat::FlatPart;
pub use interval::Trend;
pub use jackknife::Moments;
pub use measures::{COMPONENT_MEASURES, RECORD_MEASURES};
pub use text::parse_csv;

/// Largest number of samples in a record, over all components.
pub(crate) const MOST_NUMBERS: usize = 1 << 28;
/// Largest number of missing samples in a row that are interpolated, by default.
pub const LONGEST_GAP: usize = 10;

/// Velocity at a point over time, evenly sampled, in SI units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// The path of the file as given; messages use it.
    pub file: String,
    /// Time between samples [s].
    pub interval: f64,
    /// The components; the first is along the mean flow.
    pub components: Vec<Samples>,
    /// What the reader found and did.
    pub reading: Reading,
}

/// The samples of a component.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Samples {
    /// Its name in the file, without the unit.
    pub name: String,
    /// [m/s]
    pub values: Vec<f64>,
}

/// What the reader of a record found and did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// Number of missing samples that were interpolated, over all components.
    pub filled: usize,
    /// Number of incomplete rows that were dropped at the start and at the end.
    pub cut_off: usize,
    /// Number of them at the start.
    pub cut_off_start: usize,
    /// Number of rows that are missing by the times; they were interpolated.
    pub skipped: usize,
    /// Largest deviation of a time step from the usual one, as a share of it.
    pub jitter: f64,
    /// What its times leave open.
    pub doubt: Option<Fault>,
    /// Columns that were not used.
    pub unused: Vec<String>,
    /// Whether there was a column of time.
    pub timed: bool,
    /// From the unit of the file to m/s, of each component; 1 where it is not known.
    pub factors: Vec<f64>,
    /// CRC-32 of the file.
    pub checksum: u32,
}

impl Record {
    /// Number of samples of a component.
    pub fn samples(&self) -> usize {
        self.components.first().map_or(0, |c| c.values.len())
    }

    /// From the first sample to one interval after the last [s].
    pub(crate) fn duration(&self) -> f64 {
        self.samples() as f64 * self.interval
    }
}

/// How to read a file that does not say everything itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Sampling rate [Hz]; it replaces a column of time.
    pub rate: Option<f64>,
    /// Unit of the time if the header has none: `ms`.
    pub time_unit: Option<String>,
    /// Unit of the velocities if the header has none: `m/s`.
    pub velocity_unit: Option<String>,
    /// Columns of velocity, by name or by number from 1; the first is along the mean flow.
    pub columns: Vec<String>,
    /// Column of time, by name or number.
    pub time_column: Option<String>,
    /// Number of lines to skip at the start.
    pub skip_lines: u64,
    /// Largest number of missing samples in a row that are interpolated.
    pub longest_gap: usize,
}

impl Default for Layout {
    fn default() -> Self {
        Self {
            rate: None,
            time_unit: None,
            velocity_unit: None,
            columns: Vec::new(),
            time_column: None,
            skip_lines: 0,
            longest_gap: LONGEST_GAP,
        }
    }
}

/// Reads a velocity record. A file that begins like Parquet is read as Parquet, any other as text.
///
/// # Errors
/// When the file cannot be read or is not an evenly sampled velocity record; the message says where and why.
pub fn read_record(path: &Path, layout: &Layout) -> Result<Record, FileError> {
    parse_record(file::open(path, FileKind::Record)?, &path.display().to_string(), layout)
}

/// Reads what [`read_record`] reads from any source; messages call it `name`.
///
/// # Errors
/// The errors of [`read_record`].
pub fn parse_record(mut source: impl Read, name: &str, layout: &Layout) -> Result<Record, FileError> {
    let failed = |error| file::unreadable(&error, name.as_ref(), FileKind::Record);
    let mut start = Vec::new();
    source.by_ref().take(4).read_to_end(&mut start).map_err(failed)?;
    if start != parquet::MAGIC {
        return parse_csv(start.chain(source), name, layout);
    }
    source.read_to_end(&mut start).map_err(failed)?;
    parse_parquet(start, name, layout)
}

/// Reads a Parquet file held in memory; messages call it `name`.
///
/// # Errors
/// The errors of [`read_record`].
pub fn parse_parquet(bytes: Vec<u8>, name: &str, layout: &Layout) -> Result<Record, FileError> {
    parquet::parse(bytes.into(), name, layout)
}

/// Least number of samples.
pub(super) const LEAST_SAMPLES: usize = 64;

/// The fault of a record that has too few samples.
pub(super) fn too_few_samples(found: usize, least: usize) -> Fault {
    Fault::new(
        format!("has {}", counted(found as u64, "sample")),
        format!("at least {least} are needed for statistics of turbulence"),
    )
}

/// The fault of a sampling rate [Hz] that is not above zero.
pub(super) fn rate_fault(rate: f64) -> Fault {
    Fault::new(format!("the sampling rate cannot be {} Hz", shortest(rate)), "give a rate above zero")
}

pub(super) fn time(seconds: f64) -> String {
    Dimension::Time.pretty_to(seconds, 3)
}

pub(super) fn hertz(frequency: f64) -> String {
    Dimension::Frequency.pretty_to(frequency, 3)
}

pub(super) fn number(value: f64) -> String {
    shortest(rounded(value, 2))
}
