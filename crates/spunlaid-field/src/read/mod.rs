//! Fields from files.
//!
//! A file is read as a whole. Further memory is taken only for the bytes that are there, never for what a header
//! promises.

mod array;
mod arrays;
mod assembly;
mod blanks;
mod encoding;
mod foreign;
mod grid;
mod join;
mod legacy;
mod list;
mod missing;
mod names;
mod piece;
mod table;
mod times;
mod unstructured;
mod xml;

use super::{Field, FieldLayout};
use spunlaid_ground::{Fault, FileError, FileKind, file};
use std::path::{Path, PathBuf};

/// A field with what is known of its files.
#[derive(Debug)]
pub struct ReadField {
    /// The field.
    pub field: Field,
    /// What was left out or corrected.
    pub warnings: Vec<Fault>,
    /// Checksum of the file and of its parts.
    pub checksum: u32,
    /// The files that a list names, relative to its folder. Empty for a file that is no list.
    pub parts: Vec<PathBuf>,
}

impl ReadField {
    /// Reads a field from a file, with the files that this one lists.
    pub fn read(path: &Path, layout: &FieldLayout) -> Result<Self, FileError> {
        if let Some(fault) = foreign::folder(path) {
            return Err(FileError::from(fault).path(path));
        }
        let bytes = file::read(path, FileKind::Field, u64::MAX)?;
        if list::is_list(&bytes) {
            return list::read(path, &bytes, layout);
        }
        let (field, warnings) = Field::parse_as(&bytes, &path.display().to_string(), layout)?;
        Ok(Self { field, warnings, checksum: crc32fast::hash(&bytes), parts: Vec::new() })
    }
}

impl Field {
    /// Reads a field from a file, VTK or a table; the format is recognised from the file's content. A file of VTK that
    /// lists others is the field of all of them.
    ///
    /// `docs/air.md` of the repository lists the formats and the names of arrays and columns.
    ///
    /// # Errors
    /// When the file cannot be read or holds no field of air. The message says where and why.
    pub fn read(path: &Path) -> Result<(Self, Vec<Fault>), FileError> {
        ReadField::read(path, &FieldLayout::default()).map(|read| (read.field, read.warnings))
    }

    /// Reads a field from the bytes of a file. Messages call it `name`.
    ///
    /// # Errors
    /// As [`Field::read`].
    pub fn parse(bytes: &[u8], name: &str) -> Result<(Self, Vec<Fault>), FileError> {
        Self::parse_as(bytes, name, &FieldLayout::default())
    }

    /// As [`Field::parse`], with the names of arrays that are not usual.
    ///
    /// # Errors
    /// As [`Field::read`], and if an array that the layout names is not there.
    pub fn parse_as(bytes: &[u8], name: &str, layout: &FieldLayout) -> Result<(Self, Vec<Fault>), FileError> {
        let start = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let read = if let Some(fault) = foreign::refusal(start, name) {
            Err(fault.into())
        } else if list::is_list(start) {
            Err(list::without_path().into())
        } else if start.trim_ascii_start().starts_with(b"<") {
            xml::read(start, layout)
        } else if start.starts_with(legacy::START) {
            legacy::read(start, layout)
        } else {
            table::read(start, layout)
        };
        read.map_err(|error| error.file(name))
    }
}
