//! Reads a file into memory and says why it cannot be read.

use crate::error::{Fault, FileError, FileKind};
use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// Opens a file.
///
/// # Errors
/// When the file does not exist, is a folder or may not be read.
pub(crate) fn open(path: &Path, kind: FileKind) -> Result<File, FileError> {
    let failed = |source| unreadable(&source, path, kind);
    let file = File::open(path).map_err(failed)?;
    if file.metadata().map_err(failed)?.is_dir() {
        return Err(FileError::from(kind.is_folder()).path(path));
    }
    Ok(file)
}

/// Reads a file of at most `most` bytes into memory.
///
/// # Errors
/// The errors of [`open`], and when the file is larger.
pub(crate) fn read(path: &Path, kind: FileKind, most: u64) -> Result<Vec<u8>, FileError> {
    let file = open(path, kind)?;
    let failed = |source| unreadable(&source, path, kind);
    // A device or a pipe has no size or reports zero, so that the bytes read are counted too.
    let stated = file.metadata().map_err(failed)?.len();
    let mut bytes = Vec::new();
    if stated <= most {
        bytes.reserve_exact(usize::try_from(stated).unwrap_or_default());
        file.take(most.saturating_add(1)).read_to_end(&mut bytes).map_err(failed)?;
    }
    if stated.max(bytes.len() as u64) > most {
        return Err(FileError::from(kind.too_large(most)).path(path));
    }
    Ok(bytes)
}

/// The reason why the system cannot read a file.
pub(crate) fn unreadable(source: &io::Error, path: &Path, kind: FileKind) -> FileError {
    let fault = match source.kind() {
        ErrorKind::NotFound => kind.not_there(),
        ErrorKind::IsADirectory => kind.is_folder(),
        _ => Fault::unreadable(source),
    };
    FileError::from(fault).path(path)
}
