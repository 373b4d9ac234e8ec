//! Reads a file into memory and says why it cannot be read.

use crate::error::{Fault, FileError, FileKind, memory};
use std::fs::File;
use std::io::{self, ErrorKind, Read, Seek};
use std::path::Path;

/// Largest file that may be a pointer [bytes].
const LONGEST_POINTER: u64 = 2048;

/// Opens a file.
///
/// # Errors
/// When the file does not exist, is a folder, may not be read, or is a pointer to a file that was not fetched.
pub fn open(path: &Path, kind: FileKind) -> Result<File, FileError> {
    let failed = |source| unreadable(&source, path, kind);
    let mut file = File::open(path).map_err(failed)?;
    let about = file.metadata().map_err(failed)?;
    if about.is_dir() {
        return Err(FileError::from(kind.is_folder()).path(path));
    }
    // Of a pipe nothing can be read twice.
    if about.is_file() && about.len() <= LONGEST_POINTER {
        let mut start = Vec::new();
        file.by_ref().take(LONGEST_POINTER).read_to_end(&mut start).map_err(failed)?;
        file.rewind().map_err(failed)?;
        if let Some((what, remedy)) = pointer(&start) {
            return Err(FileError::from(Fault::format(what, remedy)).path(path));
        }
    }
    Ok(file)
}

/// What stands in place of a file that was left in another store, and how the file is fetched.
fn pointer(text: &[u8]) -> Option<(&'static str, &'static str)> {
    let git_lfs =
        [&b"version https://git-lfs.github.com/spec/"[..], b"version https://hawser.github.com/spec/"];
    if git_lfs.iter().any(|start| text.starts_with(start)) {
        Some((
            "a Git LFS pointer instead of the file, which was not fetched with the repository",
            "fetch it with `git lfs pull` in its folder",
        ))
    } else if text.starts_with(b"/annex/objects/") {
        let remedy = "fetch it with `git annex get` in its folder";
        Some(("a git-annex pointer instead of the file, which was not fetched with the repository", remedy))
    } else {
        None
    }
}

/// Reads a file of at most `most` bytes into memory.
///
/// # Errors
/// The errors of [`open`], and when the file is larger.
pub fn read(path: &Path, kind: FileKind, most: u64) -> Result<Vec<u8>, FileError> {
    let file = open(path, kind)?;
    let failed = |source| unreadable(&source, path, kind);
    // A device or a pipe has no size or reports zero, so that the bytes read are counted too.
    let stated = file.metadata().map_err(failed)?.len();
    let mut bytes = Vec::new();
    if stated <= most {
        bytes = with_room(stated).map_err(|fault| FileError::from(fault).path(path))?;
        file.take(most.saturating_add(1)).read_to_end(&mut bytes).map_err(failed)?;
    }
    if stated.max(bytes.len() as u64) > most {
        return Err(FileError::from(kind.too_large(most)).path(path));
    }
    Ok(bytes)
}

/// Memory for a file of a stated size, of which a sparse file may have less on the disk.
fn with_room(stated: u64) -> Result<Vec<u8>, Fault> {
    let mut bytes = Vec::new();
    let room = usize::try_from(stated).ok().filter(|room| bytes.try_reserve_exact(*room).is_ok());
    let remedy = "write a smaller file, or read it on a machine with more memory";
    let no_room =
        || Fault::new(format!("has {}, for which there is not enough memory", memory(stated as f64)), remedy);
    room.map(|_| bytes).ok_or_else(no_room)
}

/// The reason why the system cannot read a file.
pub fn unreadable(source: &io::Error, path: &Path, kind: FileKind) -> FileError {
    let fault = match source.kind() {
        ErrorKind::NotFound => kind.not_there(),
        ErrorKind::IsADirectory => kind.is_folder(),
        _ => Fault::unreadable(source),
    };
    FileError::from(fault).path(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rejects_a_size_for_which_there_is_no_memory() {
        assert!(with_room(1 << 20).is_ok_and(|bytes| bytes.capacity() >= 1 << 20));
        for size in [1 << 50, u64::MAX] {
            assert!(with_room(size).unwrap_err().to_string().contains("not enough memory"));
        }
    }
}
