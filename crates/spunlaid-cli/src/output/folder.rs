//! A results folder that is written whole or not at all.

use crate::failure::Failure;
use std::fs;
use std::path::{Path, PathBuf};

/// What a results folder holds; the last one written says that it is complete.
const ENTRIES: [&str; 8] = [
    "case.toml",
    "end_node.parquet",
    "energy.parquet",
    "shape.pvd",
    "shape",
    "figures",
    "report.html",
    COMPLETE,
];
const COMPLETE: &str = "summary.json";

/// A folder beside the wanted one that collects the files; gone again unless [`Staging::publish`]ed.
#[derive(Debug)]
pub(crate) struct Staging {
    folder: PathBuf,
    staging: tempfile::TempDir,
    /// Folders above that were made for it, the deepest first, removed again if nothing is published.
    made: Vec<PathBuf>,
}

impl Staging {
    /// Gets ready to write results to `folder`; finds out now whether that will be possible.
    pub(crate) fn new(folder: &Path, replace: bool) -> Result<Self, Failure> {
        if folder.exists() && !folder.is_dir() {
            return Err(Failure::NotAFolder { path: folder.to_owned() });
        }
        if !replace {
            if let Some(found) = ENTRIES.iter().find(|e| folder.join(e).exists()) {
                return Err(Failure::HoldsResults { folder: folder.to_owned(), found: (*found).to_owned() });
            }
        }
        let mut made: Vec<PathBuf> = folder
            .ancestors()
            .skip(1)
            .take_while(|above| !above.as_os_str().is_empty() && !above.exists())
            .map(Path::to_owned)
            .collect();
        // An existing folder is staged inside, so that publishing never crosses file systems.
        let above = if folder.is_dir() { folder } else { folder.parent().unwrap_or(folder) };
        let above = if above.as_os_str().is_empty() { Path::new(".") } else { above };
        let made_all = fs::create_dir_all(above).and_then(|()| {
            tempfile::Builder::new().prefix(".spunlaid-").suffix(".partial").tempdir_in(above)
        });
        match made_all {
            Ok(staging) => Ok(Self { folder: folder.to_owned(), staging, made: std::mem::take(&mut made) }),
            Err(source) => {
                remove_empty(&made);
                Err(Failure::Unwritable { path: folder.to_owned(), source })
            }
        }
    }

    /// Where a file of the results goes for now.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.staging.path().join(name)
    }

    /// Writes a file, making the folders above it.
    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) -> Result<(), Failure> {
        let path = self.path(name);
        path.parent()
            .map_or(Ok(()), fs::create_dir_all)
            .and_then(|()| fs::write(&path, content))
            .map_err(|source| Failure::Unwritable { path: self.folder.join(name), source })
    }

    /// Moves everything to where it belongs.
    pub(crate) fn publish(mut self) -> Result<(), Failure> {
        let folder = self.folder.clone();
        fs::create_dir_all(&folder).map_err(Failure::unwritable(&folder))?;
        self.made.clear();
        let remove =
            |path: &Path| if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
        // Incomplete from here until the last entry, which marks it complete, is in place.
        for name in std::iter::once(&COMPLETE).chain(&ENTRIES) {
            let (from, to) = (self.path(name), folder.join(name));
            if to.exists() {
                remove(&to).map_err(Failure::unwritable(&to))?;
            }
            if *name != COMPLETE && from.exists() {
                fs::rename(&from, &to).map_err(Failure::unwritable(&to))?;
            }
        }
        let to = folder.join(COMPLETE);
        fs::rename(self.path(COMPLETE), &to).map_err(Failure::unwritable(&to))
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(self.staging.path());
        remove_empty(&self.made);
    }
}

/// Removes folders, the deepest first, as far as they are empty.
fn remove_empty(folders: &[PathBuf]) {
    for folder in folders {
        let _ = fs::remove_dir(folder);
    }
}
