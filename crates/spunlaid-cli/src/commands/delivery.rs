//! How a command delivers what it has found: into its folder, then as JSON or as lines of the terminal.

use super::{plural, stop_on_ctrl_c};
use crate::args::{Output, Threads};
use crate::failure::Failure;
use crate::say;
use spunlaid::study::JournalState;
use spunlaid_results::folders::{Contents, Making, Written};
use spunlaid_results::output::folder::{Published, Staging};
use spunlaid_results::output::origin::Origin;
use spunlaid_results::output::pictures::FigureFiles;
use std::path::{Path, PathBuf};

/// The folder of a command, if it writes one, and what is said.
#[derive(Debug)]
pub(super) struct Delivery<'a> {
    folder: Option<PathBuf>,
    staging: Option<Staging<'static>>,
    output: &'a Output,
}

/// What has been delivered.
#[derive(Debug)]
pub(super) struct Delivered {
    written: Option<(Published<'static>, Written)>,
    making: Making<'static>,
}

/// What is said besides the results.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Asides<'a> {
    /// Lines below the results.
    pub(super) lines: &'a [String],
    /// Remarks about what was found.
    pub(super) found: &'a [String],
}

impl<'a> Delivery<'a> {
    /// Opens the folder for results of a kind, if there shall be one. What the same command wrote before is
    /// replaced, and a note says so.
    ///
    /// * `origin` – of results in a folder
    pub(super) fn open<C: Contents>(
        folder: Option<PathBuf>,
        origin: impl FnOnce(&Path) -> Option<Origin>,
        output: &'a Output,
        figures: &FigureFiles,
    ) -> Result<Self, Failure> {
        let open = |folder: &PathBuf| -> Result<_, Failure> {
            let (origin, stop) = (origin(folder), stop_on_ctrl_c());
            let mut staging = Staging::with_origin(folder, C::ENTRIES, output.force, origin, stop)?;
            staging.set_figures(figures);
            if staging.replaces_own() {
                say_replaced(folder, output);
            }
            Ok(staging)
        };
        let staging = folder.as_ref().map(open).transpose()?;
        Ok(Self { folder, staging, output })
    }

    /// The folder that collects the files.
    pub(super) const fn staging(&self) -> Option<&Staging<'static>> {
        self.staging.as_ref()
    }

    /// Whether results go into files.
    pub(super) fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// Writes results, and says what was found.
    pub(super) fn deliver(
        mut self,
        contents: &impl Contents,
        threads: Threads,
        asides: Asides<'_>,
    ) -> Result<(), Failure> {
        let delivered = self.publish(contents, threads)?;
        self.tell(contents, delivered, asides);
        Ok(())
    }

    /// Writes results into the folder, where files can be replaced later.
    pub(super) fn publish<C: Contents>(
        &mut self,
        contents: &C,
        threads: Threads,
    ) -> Result<Delivered, Failure> {
        let making = making(threads);
        let write = |staging| contents.write(staging, making);
        let written = self.staging.as_ref().map(write).transpose()?;
        let lacking = self.staging.as_ref().and_then(|staging| staging.lacking_tables(C::OF_ONE_FORMAT));
        lacking.iter().filter(|_| !self.output.quiet).for_each(|lacking| say::remark(false, lacking));
        let published = self.staging.take().map(Staging::publish_first).transpose()?;
        Ok(Delivered { written: published.zip(written), making })
    }

    /// Says what was found: as JSON or as lines.
    pub(super) fn tell(self, contents: &impl Contents, delivered: Delivered, asides: Asides<'_>) {
        let text = delivered.written.map_or_else(String::new, |(_, written)| written.text);
        tell(contents, (self.folder(), &text), self.output, asides);
    }
}

impl Delivered {
    /// Whether there are files.
    pub(super) const fn is_in_folder(&self) -> bool {
        self.written.is_some()
    }

    /// Writes report and summary again, when more is known.
    pub(super) fn rewrite(&mut self, contents: &impl Contents) -> Result<(), Failure> {
        if let Some((folder, written)) = &mut self.written {
            *written = contents.rewrite(folder, written, self.making)?;
        }
        Ok(())
    }
}

/// How files are made; Ctrl-C ends it.
pub(super) fn making(threads: Threads) -> Making<'static> {
    Making { threads: threads.number(), stop: stop_on_ctrl_c(), room: say::room() }
}

/// Says what was found: as JSON, or as lines with the report to open.
pub(super) fn tell(
    contents: &impl Contents,
    (folder, text): (Option<&Path>, &str),
    output: &Output,
    asides: Asides<'_>,
) {
    if output.json {
        say::text(&contents.summary());
    } else if !output.quiet {
        say::table(text);
        asides.lines.iter().for_each(|line| say::line(line));
        asides.found.iter().for_each(|note| say::remark(false, note));
        folder.iter().for_each(|folder| say::line(&format!("open {}", folder.join("report.html").display())));
    }
}

/// Says that the earlier results of the same command are replaced.
pub(super) fn say_replaced(folder: &Path, output: &Output) {
    if !output.quiet {
        let replaced =
            format!("{}: holds earlier results of this command, which are replaced", folder.display());
        say::remark(false, &replaced);
    }
}

/// Says what has been done before of work that goes on.
///
/// * `done` – how much of it
/// * `noun` – of which a record of the journal is
pub(super) fn say_continued(found: &JournalState, done: &str, noun: &str, output: &Output) {
    if !output.quiet {
        say::aside(&format!("continuing: {done}"));
    }
    if found.damaged > 0 {
        let records = plural(found.damaged, "record");
        say::warning(&format!(
            "the journal has damaged records ({records}); these {noun}s are made again, all others are kept"
        ));
    }
}
