//! Velocity records, as a hot wire or a laser writes them, and what they say about the air.
//!
//! file (CSV, Parquet) → [`Record`] (evenly sampled, SI) → [`analyse`] → [`Analysis`]
//!
//! **In** goes the velocity at a point over time: a row for each sample, a column of time, and one to three columns of
//! velocity. Units stand in the header: `time_ms`, `u [m/s]`. A [`Layout`] tells what a file does not: the sampling
//! rate, units, which columns to take.
//!
//! | format | what is read |
//! |---|---|
//! | text | as [`crate::table`] describes; an empty line is a missing sample where there is no time |
//! | Parquet | plain columns of doubles, floats or integers, with nulls; uncompressed or Snappy |
//!
//! **Out** come, with 95 % confidence intervals: mean velocity [m/s], turbulence intensity [-], integral time [s],
//! length scale [m] and cut-off frequency [Hz]; for each component also rms, skewness, flatness, spectrum
//! [(m/s)²/Hz] and autocorrelation; and [`Warning`]s about what the numbers rest on. `docs/analyse.md` of the
//! repository has the formulas.
//!
//! **Limits.** Samples are evenly spaced to within 1 %; up to [`LONGEST_GAP`] missing samples in a row are put on a
//! straight line between their neighbours. A record has 64 samples at least and [`MOST_NUMBERS`] numbers at most,
//! which take 8 bytes each. Text is read line by line, Parquet as a whole.
//!
//! ```
//! use spunlaid::record::{Layout, Settings, analyse, parse_csv};
//!
//! # fn main() -> Result<(), spunlaid::error::FileError> {
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
mod columns;
mod correlation;
mod flat;
mod interval;
mod moments;
mod parquet;
mod rows;
mod text;
mod warning;

pub use analysis::{Analysis, Component, Settings, SpectrumSettings, analyse};
pub use correlation::{Autocorrelation, IntegralRule};
pub use flat::FlatPart;
pub use interval::Interval;
pub use moments::Moments;
pub use text::parse_csv;
pub use warning::{Trend, Warning};

use crate::error::{FileError, FileKind};
use crate::file;
use std::io::Read;
use std::path::Path;

/// Most numbers of a record that are kept, over all components.
pub const MOST_NUMBERS: usize = 1 << 28;
/// Samples in a row that are filled in where they are missing, unless told otherwise.
pub const LONGEST_GAP: usize = 10;

/// Velocity over time at a point, evenly sampled, in SI units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// What messages call it: the file, as given.
    pub file: String,
    /// Time between samples [s].
    pub interval: f64,
    /// The components, that along the flow first.
    pub components: Vec<Samples>,
    /// What was found and done while reading.
    pub reading: Reading,
}

/// The samples of a component.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Samples {
    /// What the file calls it, without the unit.
    pub name: String,
    /// [m/s]
    pub values: Vec<f64>,
}

/// What was found and done while a record was read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// Missing samples that were filled in along a straight line, over all components.
    pub filled: usize,
    /// Rows with something missing that were cut off at the start and at the end.
    pub cut_off: usize,
    /// Rows the times skip, among those filled in.
    pub skipped: usize,
    /// Most that a step of time is off the usual one, as a share of it.
    pub jitter: f64,
    /// Columns that were not used.
    pub unused: Vec<String>,
    /// Whether there was a column of time.
    pub timed: bool,
    /// CRC-32 of the file.
    pub checksum: u32,
}

impl Record {
    /// Number of samples of a component.
    pub fn samples(&self) -> usize {
        self.components.first().map_or(0, |c| c.values.len())
    }

    /// From the first sample to one interval after the last [s].
    pub fn duration(&self) -> f64 {
        self.samples() as f64 * self.interval
    }
}

/// How a file is to be read, where it does not say itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Sampling rate [Hz]; then a column of time is not needed, and not used.
    pub rate: Option<f64>,
    /// Unit of the time where the header has none: `ms`.
    pub time_unit: Option<String>,
    /// Unit of the velocities where the header has none: `m/s`.
    pub velocity_unit: Option<String>,
    /// Columns that are velocities, by name or by number from 1, that along the flow first.
    pub columns: Vec<String>,
    /// Column that is the time, by name or number.
    pub time_column: Option<String>,
    /// Lines at the start that are left out.
    pub skip_lines: u64,
    /// Most samples in a row that are filled in where they are missing.
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

/// Reads a velocity record: Parquet if it begins like one, CSV otherwise.
///
/// # Errors
/// When the file cannot be read or is no evenly sampled velocity record; the message says where and why.
pub fn read_record(path: &Path, layout: &Layout) -> Result<Record, FileError> {
    let name = path.display().to_string();
    let mut file = file::open(path, FileKind::Record)?;
    let failed = |source| file::unreadable(&source, path, FileKind::Record);
    let mut start = Vec::new();
    file.by_ref().take(4).read_to_end(&mut start).map_err(failed)?;
    if start != parquet::MAGIC {
        return parse_csv(start.chain(file), &name, layout);
    }
    file.read_to_end(&mut start).map_err(failed)?;
    parse_parquet(start, &name, layout)
}

/// Reads a Parquet file held in memory; `name` is what messages call it.
///
/// # Errors
/// As [`read_record`].
pub fn parse_parquet(bytes: Vec<u8>, name: &str, layout: &Layout) -> Result<Record, FileError> {
    parquet::parse(bytes.into(), name, layout)
}
