//! A fit of settings to a scan.

mod figures;
mod files;
mod report;

pub use files::{pretty, sentences};

use crate::Failure;
use crate::files::folder::CASE_FILES;
use crate::files::kept_input::Input;
use crate::files::origin::Origin;
use crate::files::table::TABLES;
use crate::folders::{Contents, JournalFolder, Maker, Page, Work};
use crate::reports::finished::read_measured_web;
use figures::fit_figures;
use files::{fit_json, write_trials};
use report::fit_report;
use spunlaid_experiment::fit::{fit, identity};
use spunlaid_experiment::{Fit, Header, Journal, JournalState, MOST_TRIALS, Question, Target, WebInProgress};
use spunlaid_ground::{Diagnostic, Error, Fault, RunContext};
use spunlaid_input::{FitFile, WebFile, WebSpec};
use spunlaid_simulation::{Flights, Flyer};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The files of a fit, with the cases of earlier versions; the last one marks it as complete.
const FILES: &[&str] =
    &["web.toml", "cases", CASE_FILES, "trials.csv", TABLES, "figures", "report.html", "fit.json"];

/// What is fitted to what.
#[derive(Debug)]
pub struct FitInput<'a> {
    /// What the fit is called: the name of the web's file.
    pub name: String,
    /// Path of the web's file, and results folder of the scan.
    pub paths: [String; 2],
    /// The web and the keys.
    pub file: &'a FitFile,
    /// What it is compared with.
    pub target: &'a Target,
    /// Simulated webs of each trial.
    pub webs: u64,
}

impl FitInput<'_> {
    /// Finds the values of the keys, and makes the web with them.
    ///
    /// * `web` – the web with some values of the keys
    /// * `journal`, `watch` – as of [`fit`]
    ///
    /// # Errors
    /// Those of [`fit`].
    pub fn find(
        &self,
        web: &(dyn Fn(&[f64]) -> Result<WebFile, Error> + Sync),
        by: RunContext<'_>,
        journal: &mut Journal,
        watch: &dyn Fn(WebInProgress<'_>),
    ) -> Result<FoundFit<'_>, Error> {
        let make = |values: &[f64]| Ok(web(values)?.spec);
        let (parameters, target) = (&self.file.parameters[..], self.target);
        let question = Question { parameters, target, make: &make, webs: self.webs };
        let follow = |_: Flights<'_>, work: &mut (dyn FnMut() + Send)| work();
        let fit = fit(question, Flyer::new(by.threads, by.stop, &follow), by, journal, watch)?;
        let values: Vec<f64> = fit.keys.iter().map(|key| key.value).collect();
        Ok(FoundFit { input: self, spec: make(&values)?, fit })
    }

    fn notes(&self) -> Vec<String> {
        Diagnostic::notes_of_results(&self.file.start.notes)
    }

    fn identity(&self) -> u32 {
        identity(&self.file.start.spec, &self.file.parameters, self.target, self.webs)
    }
}

/// What the web of a results folder asks of webs that shall be like it.
///
/// * `spectrum` – whether its spectrum is compared too
///
/// # Errors
/// If the folder holds no web, or one with which this one cannot be compared.
pub fn target(folder: &Path, file: &FitFile, spectrum: bool) -> Result<Target, Error> {
    let target = Target::new(&read_measured_web(folder)?, &file.start.spec.sheet, spectrum);
    target.map_err(|fault| Error::folder(folder, fault))
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
#[derive(Debug)]
pub struct FoundFit<'a> {
    input: &'a FitInput<'a>,
    /// The values.
    pub fit: Fit,
    /// The web with these values.
    spec: WebSpec,
}

impl Contents for FoundFit<'_> {
    const ENTRIES: &'static [&'static str] = FILES;
    const SUMMARY: &'static str = "fit.json";

    fn summary(&self) -> String {
        let FitInput { target, paths, .. } = self.input;
        fit_json(&self.fit, target, paths, &self.input.notes())
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let Self { input, fit, spec } = self;
        let FitInput { name, paths, target, .. } = input;
        let (text, figures) = (maker.keep(Input::Web(spec))?, fit_figures(fit));
        let report = || Ok(fit_report(fit, &paths[1], target, spec, &text, &figures));
        maker.finish(name, &input.notes(), &figures, |staging| write_trials(staging, fit), report)
    }
}
