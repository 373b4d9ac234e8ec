//! Case and study files: TOML as people write it, to a [`Case`] or a study in SI units, and back.
//!
//! A quantity is written with its unit, `diameter = "50 µm"`. Everything wrong with a file is told at
//! once, each with its line, key, value, what is allowed and the way out.

mod data;
mod document;
mod file;

mod resolve;
mod source;
mod study;
mod values;
mod write;
mod written;

pub use study::{MOST_POINTS_UNASKED, StudyFile, StudyNote, differences, parse_study, read_study};
pub use write::write_case;

use crate::case::{Case, Note};
use crate::error::{Error, FileKind};
use std::path::Path;

/// The version of the case file format that this library writes, and the newest it reads.
pub const FORMAT_VERSION: u32 = 1;
/// Largest case file read [bytes].
pub const LARGEST_FILE: u64 = 1 << 20;

/// Reads and checks a case file.
///
/// * `overrides` – keys and values that replace the file's or add to it, `("air.velocity", "20 m/s")`; a
///   value is taken as TOML if it is, else as text
///
/// Returns the case and what there is to remark on it.
///
/// # Errors
/// When the file cannot be read, and when the case cannot be run: then everything found wrong with it.
pub fn read_case(path: &Path, overrides: &[(String, String)]) -> Result<(Case, Vec<Note>), Error> {
    let text = file::read(path, FileKind::Case)?;
    parse_case(&text, &path.display().to_string(), overrides)
}

/// Reads and checks the text of a case file; `name` is what messages call the file.
///
/// # Errors
/// As [`read_case`].
pub fn parse_case(
    text: &str,
    name: &str,
    overrides: &[(String, String)],
) -> Result<(Case, Vec<Note>), Error> {
    parse_with(&data::DataFiles::default(), text, name, overrides)
}

/// [`parse_case`] with files that may have been read before.
fn parse_with(
    files: &data::DataFiles,
    text: &str,
    name: &str,
    overrides: &[(String, String)],
) -> Result<(Case, Vec<Note>), Error> {
    resolve::open(document::Document::read(text, name, overrides)?, files)?.resolve()
}

/// A commented case file to start from: Table 1 of the paper, every optional key with its default.
pub const fn starter_case() -> &'static str {
    include_str!("starter.toml")
}
