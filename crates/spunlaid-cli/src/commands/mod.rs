//! The commands of the program.

pub(crate) mod air;
pub(crate) mod analyse;
pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod completions;
pub(crate) mod fit;
pub(crate) mod keys;
pub(crate) mod live;
pub(crate) mod new;
pub(crate) mod reproduce;
pub(crate) mod run;
pub(crate) mod spin;
pub(crate) mod sweep;
pub(crate) mod web;

use crate::args::is_standard;
use crate::say;
use spunlaid::ground::FileKind;
use spunlaid::ground::error::counted;
use spunlaid::input::kind_of;
use std::ffi::OsStr;
use std::path::Path;
use std::str::Utf8Chunk;

/// Largest number of points of a study that are listed.
const LISTED: usize = 24;

/// The name of a file without its extension.
fn stem(file: &Path, otherwise: &str) -> String {
    let stem = file.file_stem().filter(|_| !is_standard(file)).unwrap_or(otherwise.as_ref());
    named_by(stem)
}

/// A name as a text. Bytes that are no UTF-8 are written as `%E9`, so that two names do not become one.
fn named_by(name: &OsStr) -> String {
    let part = |part: Utf8Chunk<'_>| {
        let others: String = part.invalid().iter().map(|byte| format!("%{byte:02X}")).collect();
        part.valid().to_owned() + &others
    };
    name.as_encoded_bytes().utf8_chunks().map(part).collect()
}

/// What results are called if nobody says it: after their file, and where that is a file of something else, after what
/// they are of, `line_fibre`. So results of several commands on one file lie beside each other.
fn name_of(file: &Path, own: FileKind, [otherwise, what]: [&str; 2]) -> String {
    let name = stem(file, otherwise);
    if is_standard(file) || kind_of(file) == own { name } else { format!("{name}_{what}") }
}

/// A table whose columns stand below their heads. Columns for which the terminal is too narrow follow below,
/// beside the first column once more.
fn aligned(rows: &[Vec<String>]) -> String {
    spunlaid_results::page::aligned(rows, &[], say::room())
}
