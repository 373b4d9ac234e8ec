//! A results folder that is written completely or not at all.

use super::leftovers;
use super::leftovers::Claim;
use super::origin::{ORIGIN, Origin};
use super::pictures::FigureFiles;
use super::swap::{self, MARKS, NEW};
use super::table::{Column, TABLES, Table};
use crate::Failure;
use crate::failure::{copied_onto_itself, half_replaced, holds_files_of_others, holds_results, not_a_folder};
use spunlaid_charts::Figure;
use spunlaid_ground::threads::par_map;
use std::borrow::Borrow;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::available_parallelism;
use std::{fs, io};

/// The contents of a results folder of `run`, `analyse` or `reproduce`. The last entry marks it as complete.
pub const ENTRIES: &[&str] = &[
    ORIGIN,
    "case.toml",
    CASE_FILES,
    "end_node.parquet",
    "energy.parquet",
    "laid.parquet",
    "laid.vtp",
    "spinline.parquet",
    TABLES,
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
/// The folder for files that an input names.
pub const CASE_FILES: &str = "case_files";
/// A file that replaces a published one.
const NEXT: &str = "next";
/// Files that are needed only while the results are made.
const SCRATCH: &str = "scratch";

/// A hidden folder, in or beside the results folder, that collects the files. It is removed unless
/// [`Staging::publish`] is called.
#[derive(Debug)]
pub struct Staging<'a> {
    folder: PathBuf,
    staging: PathBuf,
    /// The entries that are moved to the results folder, in this order.
    entries: &'static [&'static str],
    replace: bool,
    /// Whether all results go that the folder has, or only its entries.
    replaces_all: bool,
    /// What the results are made from, if the same command may replace them.
    origin: Option<Origin>,
    /// A lock that shows other runs that this one is alive.
    claim: Option<Claim>,
    /// Parent folders that were created for it, the deepest first. They are removed if nothing is published.
    made: Vec<PathBuf>,
    stop: &'a AtomicBool,
    figures: FigureFiles,
    /// What the results are computed from, once it is kept.
    input: OnceLock<String>,
    /// Whether the results are in their folder: a file that is written now takes the place of an earlier one.
    is_published: bool,
}

impl<'a> Staging<'a> {
    /// Prepares to write results to `folder`, and checks now whether this is possible.
    ///
    /// * `entries` – the possible files and folders of these results, in the order in which they are moved
    /// * `replace` – whether results that the folder holds are replaced
    /// * `stop` – if this is set, nothing more is written
    pub fn new(
        folder: &Path,
        entries: &'static [&'static str],
        replace: bool,
        stop: &'a AtomicBool,
    ) -> Result<Self, Failure> {
        Self::with_origin(folder, entries, replace, None, stop)
    }

    /// [`Staging::new`]. Results of the same origin, if there is one, are replaced in any case; `entries`
    /// have [`ORIGIN`].
    pub fn with_origin(
        folder: &Path,
        entries: &'static [&'static str],
        replace: bool,
        origin: Option<Origin>,
        stop: &'a AtomicBool,
    ) -> Result<Self, Failure> {
        let exists = folder.symlink_metadata().is_ok();
        if exists && !folder.is_dir() {
            return Err(not_a_folder(folder));
        }
        if exists {
            leftovers::remove(folder)?;
        }
        refuse_results(folder, entries, replace, origin.as_ref())?;
        let unwritable = Failure::unwritable(folder);
        let above = match folder.parent() {
            Some(above) if above.as_os_str().is_empty() => Path::new("."),
            Some(above) => above,
            None => folder,
        };
        leftovers::remove(above)?;
        // For an existing folder, staging happens inside it, so that publishing never crosses file systems.
        let home = if exists { folder } else { above };
        let made: Vec<PathBuf> =
            above.ancestors().take_while(|above| !above.exists()).map(Path::to_owned).collect();
        let staging = fs::create_dir_all(home)
            .and_then(|()| leftovers::hidden_folder(home))
            .inspect_err(|_| remove_empty(&made))
            .map_err(&unwritable)?;
        let claim = Claim::on(&staging);
        let (folder, figures) = (folder.to_owned(), FigureFiles::default());
        let (input, is_published) = (OnceLock::new(), false);
        let staging = Self {
            folder,
            staging,
            entries,
            replace,
            replaces_all: true,
            origin,
            claim,
            made,
            stop,
            figures,
            input,
            is_published,
        };
        fs::create_dir(staging.staging.join(NEW)).map_err(&unwritable)?;
        staging.origin.iter().try_for_each(|origin| staging.write(ORIGIN, origin.text()))?;
        Ok(staging)
    }

    /// Other results in the folder, which are no entries of these, stay.
    #[must_use]
    pub(crate) fn beside_others(mut self) -> Self {
        self.replaces_all = false;
        self
    }

    /// From now on, figures are written like this.
    pub fn set_figures(&mut self, figures: &FigureFiles) {
        self.figures = figures.clone();
    }

    /// Whether the folder holds results of the same origin, which will be replaced.
    pub fn replaces_own(&self) -> bool {
        self.origin.as_ref().is_some_and(|origin| origin.is_of(&self.folder))
    }

    /// Where the results will be.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The present and the final path of a file of the results.
    pub fn place(&self, name: &str) -> (PathBuf, PathBuf) {
        (self.staging.join(NEW).join(name), self.folder.join(name))
    }

    /// A folder for files that are needed only while the results are made. It may not exist yet.
    pub fn scratch(&self) -> PathBuf {
        self.staging.join(SCRATCH)
    }

    /// The present and the final path of a file, whose parent folders are there.
    pub(super) fn begin(&self, name: &str) -> Result<(PathBuf, PathBuf), Failure> {
        if self.is_published {
            swap::add_to_list(&self.folder, name).map_err(Failure::unwritable(&self.folder))?;
            return Ok((self.staging.join(NEXT), self.folder.join(name)));
        }
        self.go_on()?;
        let (now, later) = self.place(name);
        now.parent().map_or(Ok(()), fs::create_dir_all).map_err(Failure::unwritable(&later))?;
        Ok((now, later))
    }

    /// Begins a table.
    ///
    /// * `name` – of its files, without the ending
    /// * `usual` – the formats in which it is written besides those that are asked for
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn table(&self, name: &str, usual: &[&str], columns: &[Column]) -> Result<Table, Failure> {
        Table::create(name, usual, &self.figures.tables, columns, |file| self.begin(file))
    }

    /// What the results lack of the formats of tables that were asked for, in a sentence.
    ///
    /// * `fixed` – files that have one format
    pub fn lacking_tables(&self, fixed: &[&str]) -> Option<String> {
        let formats: Vec<&str> = self.figures.tables.iter().map(|format| format.name).collect();
        let (new, formats) = (self.staging.join(NEW), formats.join(", "));
        let fixed: Vec<&str> = fixed.iter().copied().filter(|file| new.join(file).exists()).collect();
        let stay = format!("{} stay as they are: they have too many rows for text", fixed.join(", "));
        match (formats.is_empty(), new.join(TABLES).is_dir(), fixed.is_empty()) {
            (true, ..) | (_, true, true) => None,
            (_, true, false) => Some(format!("not all tables are written as {formats} too: {stay}")),
            (_, false, true) => {
                Some(format!("nothing is written as {formats}: results of this kind have no tables"))
            }
            (_, false, false) => Some(format!("nothing is written as {formats}: {stay}")),
        }
    }

    /// Writes a file and creates its parent folders.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> Result<(), Failure> {
        self.write_with(name, |file| file.write_all(content.as_ref()))
    }

    /// The same, part by part. Who reads a file that is replaced finds the earlier one or this one, and each is whole.
    pub fn write_with(
        &self,
        name: &str,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let (now, later) = self.begin(name)?;
        fs::File::create(&now)
            .map(BufWriter::new)
            .and_then(|mut file| write(&mut file).and_then(|()| file.flush()))
            .and_then(|()| if self.is_published { fs::rename(&now, &later) } else { Ok(()) })
            .map_err(Failure::unwritable(&later))
    }

    /// Writes the files of figures, which are drawn on all threads, with their numbers as CSV; of results that are in
    /// their folder, those that they do not have yet.
    pub fn write_figures<F: Borrow<Figure> + Sync>(&self, figures: &[F]) -> Result<(), Failure> {
        let name = |figure: &Figure| format!("figures/{}.csv", figure.name);
        let is_new = |figure: &&Figure| !self.is_published || !self.folder.join(name(figure)).exists();
        let new: Vec<&Figure> = figures.iter().map(F::borrow).filter(is_new).collect();
        let threads = available_parallelism().map_or(1, usize::from);
        // A few at a time: the pictures of many points are large, and only those of these few are held.
        for figures in new.chunks(threads) {
            let drawn = par_map(threads, figures.len(), |i| self.figures.drawn(figures[i]));
            for (figure, files) in figures.iter().zip(drawn) {
                self.write_with(&name(figure), |to| figure.table().write_csv(to))?;
                for (ending, content) in files? {
                    self.write(&format!("figures/{}.{ending}", figure.name), content)?;
                }
            }
        }
        Ok(())
    }

    /// What the results are computed from, as it is kept by the first who asks.
    pub(crate) fn input(&self, keep: impl FnOnce() -> Result<String, Failure>) -> Result<String, Failure> {
        match self.input.get() {
            Some(kept) => Ok(kept.clone()),
            None => keep().map(|kept| self.input.get_or_init(|| kept).clone()),
        }
    }

    /// Whether the results are in their folder.
    pub const fn is_published(&self) -> bool {
        self.is_published
    }

    /// Moves the results to their folder. If there was no folder, this is one renaming; otherwise the entries are
    /// moved one by one, and what marks the results as complete comes last. Files may be replaced later.
    pub fn publish(&mut self) -> Result<(), Failure> {
        self.go_on()?;
        // Another run may have written results in the meantime.
        refuse_results(&self.folder, self.entries, self.replace, self.origin.as_ref())?;
        let folder = self.folder.clone();
        let moved = self
            .move_into_folder()
            .and_then(|()| swap::publish(&self.staging, &folder, self.entries, self.replaces_all));
        moved.map_err(|error| match swap::is_unfinished(&self.staging) {
            true => half_replaced(&self.staging, error),
            false => Failure::unwritable(&folder)(error),
        })?;
        self.made.clear();
        self.is_published = true;
        Ok(())
    }

    /// Where the folder of the results exists, the staging folder lies in it. Another process may have made it
    /// meanwhile.
    fn move_into_folder(&mut self) -> io::Result<()> {
        if self.folder.exists() && self.staging.parent() != Some(&self.folder) {
            let inside = self.folder.join(self.staging.file_name().unwrap_or_default());
            fs::rename(&self.staging, &inside)?;
            self.staging = inside;
        }
        Ok(())
    }

    fn go_on(&self) -> Result<(), Failure> {
        if self.stop.load(Ordering::Relaxed) {
            return Err(Failure::Interrupted);
        }
        Ok(())
    }
}

impl Drop for Staging<'_> {
    fn drop(&mut self) {
        // Some operating systems cannot remove open files.
        self.claim = None;
        if !swap::is_unfinished(&self.staging) {
            let _ = fs::remove_dir_all(&self.staging);
        }
        remove_empty(&self.made);
    }
}

/// Copies a results folder with all that it holds. Results that are in its place go; files of others stay.
///
/// * `replace` – whether results are replaced
///
/// # Errors
/// If both are one folder, if it holds results that are not replaced, or if something cannot be read or written.
pub fn copy(from: &Path, to: &Path, replace: bool, stop: &AtomicBool) -> Result<(), Failure> {
    if let (Ok(from), Ok(same)) = (from.canonicalize(), to.canonicalize())
        && (from == same || same.starts_with(&from))
    {
        return Err(copied_onto_itself(to));
    }
    let mut staging = Staging::new(to, ENTRIES, replace, stop)?;
    let (now, later) = staging.place("");
    swap::copy(from, &now).map_err(Failure::unwritable(&later))?;
    staging.publish()
}

/// Rejects a folder that holds anything, unless it may be replaced or has the same origin.
fn refuse_results(
    folder: &Path,
    entries: &[&str],
    replace: bool,
    origin: Option<&Origin>,
) -> Result<(), Failure> {
    if replace || origin.is_some_and(|origin| origin.is_of(folder)) {
        return Ok(());
    }
    refuse_others(folder, entries, &[])
}

/// Rejects a folder that holds results, or files of others, with which results would be mixed. Hidden files
/// are no reason.
///
/// * `results` – names of results, besides those that mark any results
/// * `own` – names that may be there
pub(crate) fn refuse_others(folder: &Path, results: &[&str], own: &[&str]) -> Result<(), Failure> {
    let named =
        |entry: io::Result<fs::DirEntry>| Some(entry.ok()?.file_name().to_string_lossy().into_owned());
    // A folder that cannot be read is reported of where it is written to.
    let mut found: Vec<String> = fs::read_dir(folder).into_iter().flatten().filter_map(named).collect();
    found.retain(|name| !name.starts_with('.') && !own.contains(&name.as_str()));
    found.sort_unstable();
    match (
        results.iter().chain(MARKS).find(|result| found.iter().any(|name| name == *result)),
        found.as_slice(),
    ) {
        (Some(result), _) => Err(holds_results(folder, result)),
        (None, []) => Ok(()),
        (None, [first, more @ ..]) => Err(holds_files_of_others(folder, first, more.len())),
    }
}

/// Removes those of the folders that are empty, the deepest first.
fn remove_empty(folders: &[PathBuf]) {
    for folder in folders {
        let _ = fs::remove_dir(folder);
    }
}

#[cfg(test)]
mod tests {
    use super::swap::LIST;
    use super::swap::refused::refuse;
    use super::*;
    use std::collections::BTreeSet;

    const ENTRIES: &[&str] = &["case.toml", "figures", "laid.parquet", "summary.json"];
    static STOP: AtomicBool = AtomicBool::new(false);

    /// Writes results whose files all have this text.
    fn write(folder: &Path, text: &str, names: &[&str]) -> Result<(), crate::Failure> {
        let mut staging = Staging::new(folder, ENTRIES, true, &STOP)?;
        names.iter().try_for_each(|name| staging.write(name, text))?;
        staging.publish()
    }

    const FIRST: &[&str] = &["case.toml", "figures/a.svg", "figures/b.svg", "laid.parquet", "summary.json"];
    const SECOND: &[&str] = &["case.toml", "figures/a.svg", "figures/c.svg", "summary.json"];

    /// All files below a folder.
    fn files(folder: &Path) -> Vec<PathBuf> {
        let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
    }

    /// The results of a folder: their text, and whether there are those of only this text.
    fn found(folder: &Path) -> (String, bool) {
        let text = fs::read_to_string(folder.join("summary.json")).unwrap();
        let names = if text == "old" { FIRST } else { SECOND };
        let all = files(folder);
        let is_own = |file: &&PathBuf| !file.ends_with(LIST) && !file.ends_with("notes.txt");
        let all: Vec<_> = all.iter().filter(is_own).collect();
        let alike = all.iter().all(|file| fs::read_to_string(file).unwrap() == text);
        let notes = fs::read_to_string(folder.join("figures/notes.txt")).unwrap();
        (text, alike && all.len() == names.len() && notes == "mine")
    }

    fn old_results() -> tempfile::TempDir {
        let place = tempfile::tempdir().unwrap();
        write(&place.path().join("r"), "old", FIRST).unwrap();
        fs::write(place.path().join("r/figures/notes.txt"), "mine").unwrap();
        place
    }

    /// From one rename on nothing works any more, as if the process had been killed there. The next process finds one
    /// of both results, whole, with the file of the user's.
    #[test]
    fn a_kill_at_any_rename_loses_neither_results_nor_files_of_others() {
        let mut seen = BTreeSet::new();
        for first in 0.. {
            let place = old_results();
            let folder = place.path().join("r");
            refuse(first..usize::MAX);
            let result = write(&folder, "new", SECOND);
            refuse(0..0);
            // The next process finishes, or moves back.
            drop(Staging::new(&folder, ENTRIES, true, &STOP).unwrap());
            let (text, whole) = found(&folder);
            assert!(whole, "{first}: {text}");
            seen.insert(text);
            if result.is_ok() {
                assert!(first > 8, "{first}");
                break;
            }
        }
        assert_eq!(seen.len(), 2);
    }

    /// One rename is refused, whichever it is: the results are the old ones or the new ones at once.
    #[test]
    fn a_refused_rename_brings_the_old_results_back() {
        for number in 0.. {
            let place = old_results();
            let folder = place.path().join("r");
            refuse(number..number + 1);
            let result = write(&folder, "new", SECOND);
            refuse(0..0);
            let hidden =
                fs::read_dir(&folder).unwrap().flatten().any(|entry| entry.path().join(NEW).exists());
            if hidden {
                drop(Staging::new(&folder, ENTRIES, true, &STOP).unwrap());
            }
            assert!(found(&folder).1, "{number}");
            if result.is_ok() {
                break;
            }
        }
    }
}
