//! What a run that was killed leaves behind, and how the next one tells it from a run that lives.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// How the name of a folder begins and ends in which a run collects its files.
const PREFIX: &str = ".spunlaid-";
const SUFFIX: &str = ".partial";

/// The file in it that is locked while the run lives; the system takes the lock off a process that dies.
const LOCK: &str = "lock";

/// A folder's lock; off when dropped.
#[derive(Debug)]
pub(super) struct Claim {
    _locked: File,
}

impl Claim {
    /// Claims a folder; none on a file system without locks, where nobody clears up either.
    pub(super) fn on(folder: &Path) -> Option<Self> {
        // Nobody is to find it before it is locked.
        let unlocked = folder.join(".lock");
        let file = File::create(&unlocked).ok()?;
        file.try_lock().ok()?;
        fs::rename(unlocked, folder.join(LOCK)).ok()?;
        Some(Self { _locked: file })
    }
}

/// Makes a folder of a name that no other run has.
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

/// Removes what runs that were killed have left in a folder. It is no matter if that does not work.
pub(super) fn remove(folder: &Path) {
    remove_if(folder, is_abandoned);
}

/// The same in a folder that this process has to itself: there no other run is about to claim anything.
pub(crate) fn remove_unclaimed(folder: &Path) {
    remove_if(folder, |found| !found.join(LOCK).exists() || is_abandoned(found));
}

fn remove_if(folder: &Path, is_left: impl Fn(&Path) -> bool) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let is_ours = name.to_str().is_some_and(|name| name.starts_with(PREFIX) && name.ends_with(SUFFIX));
        if is_ours && entry.file_type().is_ok_and(|kind| kind.is_dir()) && is_left(&entry.path()) {
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}

/// Whether the run that claimed a folder is dead. Without a lock in it the folder may be one that a run is
/// about to claim.
fn is_abandoned(folder: &Path) -> bool {
    File::options().write(true).open(folder.join(LOCK)).is_ok_and(|file| file.try_lock().is_ok())
}
