//! A fit of settings to a scan.

mod figures;
mod files;
mod report;

pub use files::{fit_json, pretty, sentences};

use crate::Failure;
use crate::files::folder::CASE_FILES;
use crate::files::kept_input::Input;
use crate::files::origin::Origin;
use crate::files::table::TABLES;
use crate::folders::{Contents, JournalFolder, Maker, Page, Work};
use figures::fit_figures;
use files::write_trials;
use report::fit_report;
use spunlaid::experiment::fit::identity;
use spunlaid::experiment::{Fit, Header, Journal, JournalState, MOST_TRIALS, Target};
use spunlaid::ground::Fault;
use spunlaid::input::{FitFile, WebSpec};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The files of a fit, with the cases of earlier versions; the last one marks it as complete.
const FILES: &[&str] =
    &["web.toml", "cases", CASE_FILES, "trials.csv", TABLES, "figures", "report.html", "fit.json"];

/// What is fitted to what.
#[derive(Clone, Copy, Debug)]
pub struct FitInput<'a> {
    /// What the fit is called: the name of the web's file.
    pub name: &'a str,
    /// Path of the web's file, and results folder of the scan.
    pub paths: [&'a str; 2],
    /// The web and the keys.
    pub file: &'a FitFile,
    /// What it is compared with.
    pub target: &'a Target,
    /// Simulated webs of each trial.
    pub webs: u64,
    /// Notes for the reader.
    pub notes: &'a [String],
}

impl FitInput<'_> {
    fn identity(&self) -> u32 {
        identity(&self.file.start.spec, &self.file.parameters, self.target, self.webs)
    }
}

/// Opens the folder to begin a fit, or to continue the same one. Returns its journal, and what that holds if
/// there was one.
///
/// * `force` – what the folder holds is replaced
/// * `origin` – the command that asks; a complete fit that the same one made before is replaced too, when
///   this one is complete
/// * `stop` – if this is set, nothing more is written
///
/// # Errors
/// If it cannot be written, or holds something else.
pub fn open<'a>(
    path: &Path,
    input: &FitInput<'_>,
    force: bool,
    origin: Option<&Origin>,
    stop: &'a AtomicBool,
) -> Result<(JournalFolder<'a>, Journal, Option<JournalState>), Failure> {
    let wanted = Header { version: env!("CARGO_PKG_VERSION").to_owned(), study: input.identity() };
    let size = (MOST_TRIALS, input.webs);
    let work = Work { header: &wanted, entries: &[FILES], description: &[], force, origin, size };
    let other = |path: &Path| {
        let fault = Fault::new(
            "holds a fit of another web, to another scan, of other keys or ranges, or with another number of webs",
            "name another folder, or start again",
        );
        Failure::folder(path, fault.option("--out, --force"))
    };
    JournalFolder::open(path, &work, stop, |_| Ok(()), other)
}

/// A fit, and what was found.
#[derive(Clone, Copy, Debug)]
pub struct FoundFit<'a> {
    /// What was fitted to what.
    pub input: FitInput<'a>,
    /// The values.
    pub fit: &'a Fit,
    /// The web with these values.
    pub spec: &'a WebSpec,
}

impl Contents for FoundFit<'_> {
    const ENTRIES: &'static [&'static str] = FILES;
    const SUMMARY: &'static str = "fit.json";

    fn summary(&self) -> String {
        let FitInput { target, paths, notes, .. } = self.input;
        fit_json(self.fit, target, paths, notes)
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let FitInput { name, paths, target, notes, .. } = self.input;
        let (input, figures) = (maker.keep(Input::Web(self.spec))?, fit_figures(self.fit));
        let report = || Ok(fit_report(self.fit, (paths[1], target), (self.spec, &input), &figures));
        maker.finish((name, notes), &figures, |staging| write_trials(staging, self.fit), report)
    }
}
