//! A results folder that is written whole or not at all.

use super::beside::CASE_FILES;
use super::leftovers::{self, Claim};
use crate::failure::Failure;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// What the results folder of a run, a record or the paper holds; the last one says that it is complete.
pub(crate) const ENTRIES: &[&str] = &[
    "case.toml",
    CASE_FILES,
    "end_node.parquet",
    "energy.parquet",
    "shape.pvd",
    "shape",
    "figures",
    "report.html",
    "air.toml",
    "spectrum.csv",
    "autocorrelation.csv",
    "analysis.json",
    COMPLETE,
];
const COMPLETE: &str = "summary.json";
/// The new results and, while they take their place, the old ones: folders of the staging.
const NEW: &str = "new";
const OLD: &str = "old";

/// A hidden folder beside or in the wanted one that collects the files; gone again unless
/// [`Staging::publish`]ed.
#[derive(Debug)]
pub(crate) struct Staging<'a> {
    folder: PathBuf,
    staging: PathBuf,
    /// What is moved to its place, in this order.
    entries: &'static [&'static str],
    replace: bool,
    /// Tells other runs that this one lives.
    claim: Option<Claim>,
    /// Folders above that were made for it, the deepest first, removed again if nothing is published.
    made: Vec<PathBuf>,
    stop: &'a AtomicBool,
}

impl<'a> Staging<'a> {
    /// Gets ready to write results to `folder`; finds out now whether that will be possible.
    ///
    /// * `entries` – what belongs to these results, in the order in which it is moved to its place
    /// * `stop` – set from elsewhere, nothing is written any more
    pub(crate) fn new(
        folder: &Path,
        entries: &'static [&'static str],
        replace: bool,
        stop: &'a AtomicBool,
    ) -> Result<Self, Failure> {
        let exists = folder.symlink_metadata().is_ok();
        if exists && !folder.is_dir() {
            return Err(Failure::NotAFolder { path: folder.to_owned() });
        }
        refuse_results(folder, entries, replace)?;
        let unwritable = |source| Failure::Unwritable { path: folder.to_owned(), source };
        let above = match folder.parent() {
            Some(above) if above.as_os_str().is_empty() => Path::new("."),
            Some(above) => above,
            None => folder,
        };
        leftovers::remove(above);
        // An existing folder is staged inside, so that publishing never crosses file systems.
        let home = if exists { folder } else { above };
        if exists {
            leftovers::remove(folder);
        }
        let made: Vec<PathBuf> =
            above.ancestors().take_while(|above| !above.exists()).map(Path::to_owned).collect();
        let staging = fs::create_dir_all(home)
            .and_then(|()| leftovers::hidden_folder(home))
            .inspect_err(|_| remove_empty(&made))
            .map_err(unwritable)?;
        let claim = Claim::on(&staging);
        let staging = Self { folder: folder.to_owned(), staging, entries, replace, claim, made, stop };
        fs::create_dir(staging.staging.join(NEW)).map_err(unwritable)?;
        Ok(staging)
    }

    /// Where a file of the results goes for now, and where it will be.
    pub(crate) fn place(&self, name: &str) -> (PathBuf, PathBuf) {
        (self.staging.join(NEW).join(name), self.folder.join(name))
    }

    /// Writes a file, making the folders above it.
    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) -> Result<(), Failure> {
        self.go_on()?;
        let (now, later) = self.place(name);
        now.parent()
            .map_or(Ok(()), fs::create_dir_all)
            .and_then(|()| fs::write(&now, content))
            .map_err(|source| Failure::Unwritable { path: later, source })
    }

    /// Moves everything to where it belongs: at once where there was no folder, else entry by entry, the one
    /// that marks the results as complete last.
    pub(crate) fn publish(mut self) -> Result<(), Failure> {
        self.go_on()?;
        // Another run may have been faster.
        refuse_results(&self.folder, self.entries, self.replace)?;
        let (new, folder) = (self.staging.join(NEW), self.folder.clone());
        let moved = if folder.exists() { self.swap(&new, &folder) } else { fs::rename(&new, &folder) };
        moved.map_err(Failure::unwritable(&folder))?;
        self.made.clear();
        Ok(())
    }

    /// Puts the new entries in the place of the old ones, and these back should that fail.
    fn swap(&self, new: &Path, folder: &Path) -> std::io::Result<()> {
        let old = self.staging.join(OLD);
        fs::create_dir(&old)?;
        let there = |path: &Path| path.symlink_metadata().is_ok();
        let mut moved: Vec<(PathBuf, PathBuf)> = Vec::new();
        let mut step = |from: PathBuf, to: PathBuf| {
            if !there(&from) {
                return Ok(());
            }
            fs::rename(&from, &to)?;
            moved.push((from, to));
            Ok(())
        };
        let swapped =
            (self.entries.iter().rev().try_for_each(|name| step(folder.join(name), old.join(name))))
                .and_then(|()| {
                    self.entries.iter().try_for_each(|name| step(new.join(name), folder.join(name)))
                });
        if swapped.is_err() {
            for (from, to) in moved.iter().rev() {
                let _ = fs::rename(to, from);
            }
        }
        swapped
    }

    fn go_on(&self) -> Result<(), Failure> {
        if self.stop.load(Ordering::Relaxed) {
            return Err(spunlaid::error::Error::Interrupted.into());
        }
        Ok(())
    }
}

impl Drop for Staging<'_> {
    fn drop(&mut self) {
        // Some systems do not remove what is open.
        self.claim = None;
        let _ = fs::remove_dir_all(&self.staging);
        remove_empty(&self.made);
    }
}

/// Says no to a folder that holds any part of results, unless they may be replaced.
fn refuse_results(folder: &Path, entries: &[&str], replace: bool) -> Result<(), Failure> {
    let holds = |entry: &&&str| folder.join(entry).symlink_metadata().is_ok();
    match entries.iter().find(holds) {
        Some(found) if !replace => {
            Err(Failure::HoldsResults { folder: folder.to_owned(), found: (*found).to_owned() })
        }
        _ => Ok(()),
    }
}

/// Removes folders, the deepest first, as far as they are empty.
fn remove_empty(folders: &[PathBuf]) {
    for folder in folders {
        let _ = fs::remove_dir(folder);
    }
}
