//! Reads the text of a file, which may turn out to be no text at all.

use super::LARGEST_FILE;
use crate::error::{FileError, FileFault, FileKind, FilePlace};
use crate::file;
use std::path::Path;

/// Reads a UTF-8 file no larger than [`LARGEST_FILE`].
pub(super) fn read(path: &Path, kind: FileKind) -> Result<String, FileError> {
    String::from_utf8(file::read(path, kind, LARGEST_FILE)?).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let bytes = error.as_bytes();
        let line = 1 + bytes.iter().take(valid).filter(|byte| **byte == b'\n').count();
        let byte = bytes.get(valid).copied().unwrap_or_default();
        let fault = FileFault::NotUtf8 { byte, position: valid + 1 };
        FileError::from(fault).path(path).at(FilePlace::Line(line as u64))
    })
}
