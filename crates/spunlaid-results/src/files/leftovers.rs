//! Removes what killed runs have left behind, and recognises runs that are still alive by their locks.

use super::swap;
use crate::Failure;
use crate::failure::half_replaced;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// The beginning and the end of the name of a staging folder.
const PREFIX: &str = ".spunlaid-";
const SUFFIX: &str = ".partial";

/// The file in it that is locked while the run is alive. The operating system releases the lock when the process ends.
const LOCK: &str = "lock";

/// The lock of a folder, which is released when this value is dropped.
#[derive(Debug)]
pub(super) struct Claim {
    _locked: File,
}

impl Claim {
    /// Locks a folder. None if the file system has no locks; then leftovers are not removed either.
    pub(super) fn on(folder: &Path) -> Option<Self> {
        // The file must not be found before it is locked.
        let unlocked = folder.join(".lock");
        let file = File::create(&unlocked).ok()?;
        file.try_lock().ok()?;
        fs::rename(unlocked, folder.join(LOCK)).ok()?;
        Some(Self { _locked: file })
    }
}

/// Creates a folder with a name that no other run uses.
pub(super) fn hidden_folder(above: &Path) -> io::Result<PathBuf> {
    let mut number = std::process::id();
    loop {
        let folder = above.join(format!("{PREFIX}{number}{SUFFIX}"));
        match fs::create_dir(&folder) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => number = number.wrapping_add(1),
            made => return made.map(|()| folder),
        }
    }
}

/// Removes what killed runs have left in a folder, and finishes what they were replacing.
///
/// # Errors
/// If results that were being replaced cannot be moved to their places. What only cannot be removed stays.
pub(super) fn remove(folder: &Path) -> Result<(), Failure> {
    remove_if(folder, is_abandoned)
}

/// The same in a folder that only this process uses, where no other run can be about to lock anything.
///
/// # Errors
/// As `remove`.
pub fn remove_unclaimed(folder: &Path) -> Result<(), Failure> {
    remove_if(folder, |found| !found.join(LOCK).exists() || is_abandoned(found))
}

fn remove_if(folder: &Path, is_left: impl Fn(&Path) -> bool) -> Result<(), Failure> {
    let Ok(entries) = fs::read_dir(folder) else { return Ok(()) };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let is_ours = name.to_str().is_some_and(|name| name.starts_with(PREFIX) && name.ends_with(SUFFIX));
        if is_ours && entry.file_type().is_ok_and(|kind| kind.is_dir()) && is_left(&entry.path()) {
            swap::finish(&entry.path()).map_err(|error| half_replaced(&entry.path(), error))?;
            let _ = fs::remove_dir_all(entry.path());
        }
    }
    Ok(())
}

/// Whether the run that locked a folder has ended. A folder without a lock file may belong to a run that is about
/// to lock it.
fn is_abandoned(folder: &Path) -> bool {
    File::options().write(true).open(folder.join(LOCK)).is_ok_and(|file| file.try_lock().is_ok())
}
