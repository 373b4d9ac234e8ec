//! Flights that outlive the process that flies them: what a run has flown is kept beside its folder until the
//! run is complete.
//!
//! ```text
//! .<folder>.flown/header        version of the program, identity of the case, what is kept of a fibre
//! .<folder>.flown/lock          locked while a run uses it
//! .<folder>.flown/<n>/landed    of the n-th process that flies: what was measured, where the rows are, rows of no group yet
//! .<folder>.flown/<n>/<table>   the table itself, as a second name of the file that the run writes
//!
//! record     a record of `landed`
//! keeping    writes while fibres land
//! earlier    reads what an earlier process has left
//! ```
//!
//! Rows are many, so they are not written twice: a group of rows of a table is kept as soon as it is in the
//! table. Only the rows after the last group are written to `landed` too, now and then.
//!
//! Nothing here ends a run: what cannot be kept or read is flown again.

mod earlier;
mod keeping;
mod record;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;

pub(super) use earlier::Earlier;
pub(super) use keeping::Keeping;

use crate::output::folder::Staging;
use crate::output::tables::table_names;
use spunlaid::case::Case;
use spunlaid::ensemble::Keep;
use spunlaid::observe::{DECLARED, Measure};
use spunlaid::study::Experiment;
use std::fs::{self, File};
use std::io;
use std::path::PathBuf;

/// A run that fails leaves nothing if it has flown fewer steps of elements: flying them again takes seconds.
/// They are counted, since the time would be another one on a busy machine.
const FEW: f64 = 1e9;
const HEADER: &str = "header";
const LOCK: &str = "lock";
const LANDED: &str = "landed";

/// The flights of a run that are kept.
#[derive(Debug)]
pub(super) struct KeptFlights {
    pub(super) earlier: Earlier,
    pub(super) keeping: Keeping,
    /// Steps of elements of a replicate.
    steps_of_each: f64,
    /// Whether the run was interrupted, so that another process goes on.
    pub(super) interrupted: bool,
}

/// The folder of kept flights.
#[derive(Debug)]
struct Home {
    folder: PathBuf,
    header: String,
    /// What only one process has.
    lock: Option<File>,
}

impl KeptFlights {
    /// Finds what was flown for a results folder, if it is of the same case.
    pub(super) fn open(staging: &Staging<'_>, case: &Case, keep: Keep) -> Self {
        let results = staging.folder();
        let name = results.file_name().unwrap_or_default().to_string_lossy();
        let folder = results.with_file_name(format!(".{name}.flown"));
        let identity = Experiment::Case(case.clone()).checksum();
        let header =
            format!("spunlaid-flown version={} case={identity:08x} {keep:?}\n", env!("CARGO_PKG_VERSION"));
        let mut home = Home { folder, header, lock: None };
        let fed = case.line.is_some();
        let found = if home.folder.is_dir() && home.claim() { home.processes() } else { Vec::new() };
        let all = found.iter().map(|process| Earlier::read(home.of_process(*process), fed, keep));
        let most = all.max_by_key(Earlier::fibres);
        let earlier = most.unwrap_or_else(|| Earlier::none(fed, keep));
        for process in &found {
            let place = home.of_process(*process);
            if earlier.fibres() == 0 || !earlier.is_at(&place) {
                // What cannot be removed has fewer fibres, and is not read.
                let _ = fs::remove_dir_all(place);
            }
        }
        let place = home.of_process(found.iter().max().map_or(1, |last| last + 1));
        let tables = table_names(fed).into_iter().map(|name| (name, staging.place(name).0));
        let keeping = Keeping::new(home, place, tables.collect());
        let steps_of_each = case.run.steps as f64 * case.fibre.elements as f64;
        Self { earlier, keeping, steps_of_each, interrupted: false }
    }

    /// Forgets all of it: the run is complete.
    pub(super) fn finish(mut self) {
        self.keeping.forget();
    }
}

impl Drop for KeptFlights {
    fn drop(&mut self) {
        let steps = self.steps_of_each * self.keeping.landed() as f64;
        if !self.interrupted && self.earlier.fibres() == 0 && steps < FEW {
            self.keeping.forget();
        }
    }
}

impl Home {
    /// Locks the folder for this process, and empties it if it is of another case.
    fn claim(&mut self) -> bool {
        let claimed = || -> io::Result<File> {
            fs::create_dir_all(&self.folder)?;
            let file =
                File::options().write(true).create(true).truncate(false).open(self.folder.join(LOCK))?;
            file.try_lock()?;
            let header = self.folder.join(HEADER);
            if fs::read_to_string(&header).ok().as_ref() != Some(&self.header) {
                for process in self.processes() {
                    fs::remove_dir_all(self.of_process(process))?;
                }
                fs::write(header, &self.header)?;
            }
            Ok(file)
        };
        if self.lock.is_none() {
            self.lock = claimed().ok();
        }
        self.lock.is_some()
    }

    /// Removes the folder, if it is this process's own.
    fn remove(&mut self) {
        if self.lock.take().is_some() {
            // What cannot be removed is found by the next run, and says nothing wrong.
            let _ = fs::remove_dir_all(&self.folder);
        }
    }

    /// The numbers of the processes that have left something.
    fn processes(&self) -> Vec<u64> {
        let entries = fs::read_dir(&self.folder).into_iter().flatten().flatten();
        entries.filter_map(|entry| entry.file_name().to_str()?.parse().ok()).collect()
    }

    fn of_process(&self, process: u64) -> PathBuf {
        self.folder.join(process.to_string())
    }
}

/// All measures. The header has the version of the program, so their order is known.
fn measures() -> impl Iterator<Item = &'static Measure> {
    DECLARED.iter().flat_map(|declaration| declaration.measures)
}
