//! The text of a file that may be anything.

use super::LARGEST_FILE;
use crate::error::Error;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

/// Reads a UTF-8 file no larger than [`LARGEST_FILE`]; never more than that into memory.
pub(super) fn read(path: &Path) -> Result<String, Error> {
    let unreadable = |source: std::io::Error| match source.kind() {
        ErrorKind::NotFound => Error::NotThere { path: path.to_owned() },
        ErrorKind::IsADirectory => Error::IsFolder { path: path.to_owned() },
        _ => Error::Unreadable { path: path.to_owned(), source },
    };
    let too_large = || Error::TooLarge { path: path.to_owned(), most: LARGEST_FILE };
    let file = File::open(path).map_err(unreadable)?;
    let about = file.metadata().map_err(unreadable)?;
    if about.is_dir() {
        return Err(Error::IsFolder { path: path.to_owned() });
    }
    if about.len() > LARGEST_FILE {
        return Err(too_large());
    }
    let mut bytes = Vec::new();
    // A device or pipe tells no size, or zero.
    file.take(LARGEST_FILE + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > LARGEST_FILE {
        return Err(too_large());
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let bytes = error.as_bytes();
        let line = 1 + bytes.iter().take(valid).filter(|byte| **byte == b'\n').count();
        let byte = bytes.get(valid).copied().unwrap_or_default();
        Error::NotText { path: path.to_owned(), line, byte, position: valid + 1 }
    })
}
