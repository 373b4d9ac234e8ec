//! Reads the text of a file, which may turn out to be no text at all.

use super::LARGEST_FILE;
use crate::error::{Error, Fault, FileError, FileKind, Position};
use crate::file;
use std::path::Path;

/// Reads a UTF-8 file no larger than [`LARGEST_FILE`].
pub(super) fn read(path: &Path, kind: FileKind) -> Result<String, Error> {
    let bytes = file::read(path, kind, LARGEST_FILE).map_err(Error::File)?;
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        let fault = Fault::new(
            "is UTF-16 text, as some editors and Windows PowerShell save it",
            "save the file as UTF-8",
        );
        return Err(Error::File(FileError::from(fault).path(path)));
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let bytes = error.as_bytes();
        let line = 1 + bytes.iter().take(valid).filter(|byte| **byte == b'\n').count();
        let byte = bytes.get(valid).copied().unwrap_or_default();
        let number = valid + 1;
        let fault = Fault::new(
            format!("byte {byte:#04x} (number {number} of the file) is not UTF-8 text"),
            "save the file as UTF-8, or write um for µm",
        );
        Error::File(FileError::from(fault).path(path).at(Position::Line(line as u64)))
    })
}
