//! Reads and writes a spinline: the tables `[spinline]`, `[spinline.material]` and `[drag]` of a file, which may be a whole case.

use super::{Overrides, file};
use crate::case::Note;
use crate::drag::Drag;
use crate::error::{Error, FileKind};
use crate::spinline::{Solution, Spinline};
use std::path::Path;

/// A spinline as a file describes it.
#[derive(Clone, Debug)]
pub struct SpinFile {
    /// What is known of the line.
    pub spinline: Spinline,
    /// The drag laws; the one along the thread is used.
    pub drag: Drag,
    /// Notes and warnings.
    pub notes: Vec<Note>,
}

/// What a change of a key does to the diameter of the filament.
#[derive(Clone, Debug, PartialEq)]
pub struct Influence {
    /// Full name of the key, `spinline.throughput`; of a column of a table, `spinline.profile` is named.
    pub key: &'static str,
    /// What is changed, in words with its symbol: `Throughput`, `Air velocity along the thread, from 10 m/s`.
    pub label: String,
    /// The change: relative, or in kelvin.
    pub change: Change,
    /// What the change does to the final diameter: `d ln d / d ln x` [-], or its relative change [-] per 10 K.
    pub diameter: f64,
    /// The same for the final speed.
    pub speed: f64,
}

/// How a key is changed to see its influence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// By a share of its value.
    Relative,
    /// By 10 K.
    TenKelvin,
}

/// Reads a spinline.
///
/// # Errors
/// If the file cannot be read, or with every problem found in these tables.
pub fn read_spinline<'a>(path: &Path, overrides: impl Into<Overrides<'a>>) -> Result<SpinFile, Error> {
    let text = file::read(path, FileKind::Case)?;
    parse_spinline(&text, &path.display().to_string(), overrides)
}

/// Reads the text of a spinline. Messages call the file `name`.
///
/// # Errors
/// As [`read_spinline`].
pub fn parse_spinline<'a>(
    _text: &str,
    _name: &str,
    _overrides: impl Into<Overrides<'a>>,
) -> Result<SpinFile, Error> {
    todo!()
}

/// Writes a spinline as a file that reads back to the same bits.
pub fn write_spinline(_file: &SpinFile) -> String {
    todo!()
}

impl SpinFile {
    /// The steady state of each row of the curtain, the quenched side first; one if there is no curtain.
    ///
    /// # Errors
    /// If there is none, with the reason, at the key to blame.
    pub fn solve(&self) -> Result<Vec<Solution>, Error> {
        todo!()
    }

    /// What decides the diameter: the influence of each number, computed by small changes of it, the largest first. The drag
    /// law's factor is among them. Numbers without influence are left out.
    ///
    /// # Errors
    /// As [`SpinFile::solve`].
    pub fn influences(&self) -> Result<Vec<Influence>, Error> {
        todo!()
    }
}
