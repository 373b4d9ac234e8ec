//! A folder with a journal: work in it goes on where it was left, and complete results of the same command
//! make room for new ones.
//!
//! ```text
//! new folder → journal begun
//! journal of this input → goes on
//! complete results of the same command, from before its input changed → stay whole until the new ones,
//!   which are made in a hidden folder, are complete
//! ```

use super::contents::{Contents, Making};
use crate::Failure;
use crate::failure::{not_a_folder, other_version};
use crate::files::folder::{Staging, refuse_others};
use crate::files::leftovers;
use crate::files::origin::{ORIGIN, Origin};
use crate::files::pictures::FigureFiles;
use crate::files::swap::{self, LIST, MARKS};
use spunlaid_experiment::{Header, Journal, JournalState};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::SystemTime;

pub(crate) const JOURNAL: &str = "journal";
/// The folder in which new work is done while the results that it will replace are still there. Nobody else
/// uses its name.
const REPLACEMENT: &str = ".spunlaid-replacement";

/// A folder whose journal this process has locked.
#[derive(Debug)]
pub struct JournalFolder<'a> {
    /// Where the results are when they are complete.
    path: PathBuf,
    /// Where the work is done: the folder, or one in it.
    place: PathBuf,
    entries: Entries,
    /// The journal of the results that will be replaced, which keeps other processes away.
    earlier: Option<Journal>,
    /// If this is set, nothing more is written.
    stop: &'a AtomicBool,
    /// How figures and tables are written.
    pub figures: FigureFiles,
}

/// The files and folders that results are, besides journal and origin, in the order in which they are moved.
/// The last one marks them as complete.
pub(crate) type Entries = &'static [&'static [&'static str]];

/// What is to be done in a folder.
#[derive(Debug)]
pub(crate) struct Work<'a> {
    /// The journal of the work begins like this.
    pub(crate) header: &'a Header,
    pub(crate) entries: Entries,
    /// What describes the work and may be left of one that was killed before its journal began.
    pub(crate) description: &'static [&'static str],
    /// Whether what the folder holds is replaced.
    pub(crate) force: bool,
    /// The command that does it, if it may replace what it made before.
    pub(crate) origin: Option<&'a Origin>,
    /// Most points, and most replicates of a point.
    pub(crate) size: (usize, u64),
}

impl<'a> JournalFolder<'a> {
    /// Opens the folder and its journal to begin the work, or to go on with it. Returns what the journal
    /// holds, if it has begun.
    ///
    /// * `begin` – what is done in the folder before the journal begins
    /// * `other` – the error if the folder holds other work
    pub(crate) fn open(
        path: &Path,
        work: &Work<'_>,
        stop: &'a AtomicBool,
        begin: impl FnOnce(&Path) -> Result<(), Failure>,
        other: impl FnOnce(&Path) -> Failure,
    ) -> Result<(Self, Journal, Option<JournalState>), Failure> {
        let (at, mut journal, header) = Self::find(path, work, stop)?;
        let (points, replicates) = work.size;
        let state = match header {
            None => {
                begin(&at.place)?;
                at.sign(work.origin)?;
                journal.begin(work.header)?;
                // The new file must survive a power cut. Some systems cannot sync folders, so an error is ignored.
                let _ = fs::File::open(&at.place).and_then(|folder| folder.sync_all());
                None
            }
            Some(found) if found.version != work.header.version => {
                return Err(other_version(&at.place, &found.version));
            }
            Some(found) if found != *work.header => return Err(other(&at.place)),
            Some(_) => Some(journal.go_on(points, replicates)?),
        };
        Ok((at, journal, state))
    }

    /// Opens the folder and its journal. Returns how the journal begins, if it has begun.
    fn find(
        path: &Path,
        work: &Work<'_>,
        stop: &'a AtomicBool,
    ) -> Result<(Self, Journal, Option<Header>), Failure> {
        if path.exists() && !path.is_dir() {
            return Err(not_a_folder(path));
        }
        let results = [MARKS, &work.entries.concat()].concat();
        if !work.force && !path.join(JOURNAL).exists() {
            refuse_others(path, &results, work.description)?;
        }
        fs::create_dir_all(path).map_err(Failure::unwritable(path))?;
        let (journal, header) = Journal::open(&path.join(JOURNAL), work.force)?;
        leftovers::remove_unclaimed(path)?;
        if !work.force && header.is_none() {
            refuse_others(path, &results, &[&[JOURNAL, ORIGIN], work.description].concat())?;
        }
        let (path, place, entries) = (path.to_owned(), path.join(REPLACEMENT), work.entries);
        let is_begun = !work.force && place.join(JOURNAL).exists();
        if !is_begun {
            // What a process has left that was killed when all was done.
            clear(&place, entries)?;
        }
        let has_changed =
            header.as_ref().is_some_and(|found| found.version == work.header.version && found != work.header);
        let is_own = work.origin.is_some_and(|origin| origin.is_of(&path));
        let figures = FigureFiles::default();
        if !(has_changed && is_own && (is_begun || is_complete(&path, entries))) {
            let place = path.clone();
            return Ok((Self { path, place, entries, earlier: None, stop, figures }, journal, header));
        }
        fs::create_dir_all(&place).map_err(Failure::unwritable(&place))?;
        let (own, header) = Journal::open(&place.join(JOURNAL), false)?;
        leftovers::remove_unclaimed(&place)?;
        Ok((Self { path, place, entries, earlier: Some(journal), stop, figures }, own, header))
    }

    /// Notes which command the results are of.
    fn sign(&self, origin: Option<&Origin>) -> Result<(), Failure> {
        let file = self.place.join(ORIGIN);
        match origin {
            Some(origin) => fs::write(&file, origin.text()).map_err(Failure::unwritable(&file)),
            None => remove(&file),
        }
    }

    /// Where the results are when they are complete.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Where the work is done.
    pub(crate) fn place(&self) -> &Path {
        &self.place
    }

    /// Whether there are earlier results that these will replace.
    pub const fn replaces(&self) -> bool {
        self.earlier.is_some()
    }

    /// Writes results. Returns what a terminal shows.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn write<C: Contents>(&mut self, contents: &C, making: Making<'_>) -> Result<String, Failure> {
        let staging = self.staging::<C>()?;
        self.finish(staging, contents, making)
    }

    /// Collects the files of results.
    pub(crate) fn staging<C: Contents>(&self) -> Result<Staging<'a>, Failure> {
        let mut staging = Staging::new(&self.place, C::ENTRIES, true, self.stop)?.beside_others();
        staging.set_figures(&self.figures);
        Ok(staging)
    }

    /// Writes results beside what has been written of them.
    pub(crate) fn finish(
        &mut self,
        mut staging: Staging<'_>,
        contents: &impl Contents,
        making: Making<'_>,
    ) -> Result<String, Failure> {
        let text = contents.write(&staging, making)?;
        staging.publish()?;
        // What it needed lies in the folder that is cleared.
        drop(staging);
        self.replace()?;
        Ok(text)
    }

    /// Puts complete results in the place of the earlier ones. A process that is killed meanwhile leaves no
    /// mixture: the earlier results go first, then comes the journal, from which all else is made again.
    fn replace(&mut self) -> Result<(), Failure> {
        if self.earlier.is_none() {
            return Ok(());
        }
        let entries = self.entries.concat();
        swap::keep_others(&self.path, &self.place, &entries).map_err(Failure::unwritable(&self.path))?;
        entries.iter().rev().try_for_each(|name| remove(&self.path.join(name)))?;
        // Some operating systems cannot replace an open file.
        self.earlier = None;
        for name in [LIST, JOURNAL, ORIGIN].into_iter().chain(entries) {
            let (from, to) = (self.place.join(name), self.path.join(name));
            if from.symlink_metadata().is_ok() {
                fs::rename(&from, &to).map_err(Failure::unwritable(&to))?;
            }
        }
        clear(&self.place, self.entries)?;
        self.place.clone_from(&self.path);
        Ok(())
    }
}

/// Removes the folder of a replacement, unless someone else has put something into it.
fn clear(place: &Path, entries: Entries) -> Result<(), Failure> {
    if place.is_dir() {
        for name in [LIST, JOURNAL, ORIGIN].into_iter().chain(entries.concat()) {
            remove(&place.join(name))?;
        }
        let _ = fs::remove_dir(place);
    }
    Ok(())
}

/// Whether the results of a folder were written after the last work for them.
fn is_complete(path: &Path, entries: Entries) -> bool {
    let last = entries.last().and_then(|entries| entries.last()).copied().unwrap_or_default();
    let written = |name: &str| -> Option<SystemTime> { path.join(name).metadata().ok()?.modified().ok() };
    written(last).zip(written(JOURNAL)).is_some_and(|(last, journal)| last >= journal)
}

/// Removes a file or a folder, if it is there.
pub(crate) fn remove(path: &Path) -> Result<(), Failure> {
    let removed = match path.symlink_metadata() {
        Err(_) => return Ok(()),
        Ok(about) if about.is_dir() => fs::remove_dir_all(path),
        Ok(_) => fs::remove_file(path),
    };
    removed.map_err(Failure::unwritable(path))
}
