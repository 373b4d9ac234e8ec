//! How a command delivers what it has found: into its folder, then as JSON or as lines of the terminal.

use crate::args::{Output, Threads};
use crate::control::stop_on_ctrl_c;
use crate::failure::Failure;
use crate::say;
use spunlaid::experiment::JournalState;
use spunlaid::ground::error::counted;
use spunlaid_results::files::folder::Staging;
use spunlaid_results::files::origin::Origin;
use spunlaid_results::files::pictures::FigureFiles;
use spunlaid_results::folders::{Contents, Making};
use std::path::{Path, PathBuf};

/// The folder of a command, if it writes one, and what is said.
#[derive(Debug)]
pub(crate) struct Delivery<'a> {
    folder: Option<PathBuf>,
    staging: Option<Staging<'static>>,
    making: Making<'static>,
    output: &'a Output,
    /// What a terminal shows of the results, and what it has shown.
    text: String,
    said: Option<String>,
}

/// What is said besides the results.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Asides<'a> {
    /// Lines below the results.
    pub(crate) lines: &'a [String],
    /// Remarks about what was found.
    pub(crate) found: &'a [String],
}

impl<'a> Delivery<'a> {
    /// Opens the folder for results of a kind, if there shall be one. What the same command wrote before is
    /// replaced, and a note says so.
    ///
    /// * `origin` – of results in a folder
    pub(crate) fn open<C: Contents>(
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
        let (making, text) = (making(Threads::default()), String::new());
        Ok(Self { folder, staging, making, output, text, said: None })
    }

    /// The folder that collects the files.
    pub(crate) const fn staging(&self) -> Option<&Staging<'static>> {
        self.staging.as_ref()
    }

    /// Whether results go into files.
    pub(crate) fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// Writes results, and says what was found.
    pub(crate) fn deliver(
        mut self,
        contents: &impl Contents,
        threads: Threads,
        asides: Asides<'_>,
    ) -> Result<(), Failure> {
        self.publish(contents, threads)?;
        self.say(asides);
        self.finish(contents);
        Ok(())
    }

    /// Writes results into the folder, where files can be replaced later.
    pub(crate) fn publish<C: Contents>(&mut self, contents: &C, threads: Threads) -> Result<(), Failure> {
        self.making = making(threads);
        let Some(staging) = &mut self.staging else { return Ok(()) };
        self.text = contents.write(staging, self.making)?;
        let lacking = staging.lacking_tables(C::OF_ONE_FORMAT).filter(|_| !self.output.quiet);
        lacking.iter().for_each(|lacking| say::remark(false, lacking));
        Ok(staging.publish()?)
    }

    /// Writes report, summary and new figures again, when more is known.
    pub(crate) fn rewrite(&mut self, contents: &impl Contents) -> Result<(), Failure> {
        if let Some(staging) = &self.staging {
            self.text = contents.write(staging, self.making)?;
        }
        Ok(())
    }

    /// Says only the result, because the rest is told again when more is known.
    pub(crate) fn say_headline(&self) {
        self.text.lines().take(1).for_each(|headline| self.line(headline));
    }

    /// Says as lines what was found and has not been said; the first time also which page to open.
    pub(crate) fn say(&mut self, asides: Asides<'_>) {
        if self.output.json || self.output.quiet {
            return;
        }
        let page = self.folder.as_deref().filter(|_| self.said.is_none());
        say_lines(&new_text(self.said.as_deref().unwrap_or_default(), &self.text), page, asides);
        self.said = Some(self.text.clone());
    }

    /// Says a line beside the results.
    pub(crate) fn line(&self, line: &str) {
        if !self.output.json && !self.output.quiet {
            say::line(line);
        }
    }

    /// Says what was found as JSON, if that is asked for.
    pub(crate) fn finish(&self, contents: &impl Contents) {
        if self.output.json {
            say::text(&contents.summary());
        }
    }
}

/// What a text says that an earlier one did not: the lines of its first paragraph, and whole paragraphs below it.
fn new_text(before: &str, now: &str) -> String {
    if before.is_empty() {
        return now.to_owned();
    }
    let (first, rest) = now.split_once("\n\n").unwrap_or((now, ""));
    let first = first.lines().filter(|line| !before.lines().any(|other| other == *line));
    let rest = rest.split("\n\n").filter(|part| !part.is_empty() && !before.contains(part.trim_end()));
    let lines = |part: &str| format!("{}\n", part.trim_end());
    let parts: Vec<String> = [first.collect::<Vec<_>>().join("\n")]
        .into_iter()
        .chain(rest.map(str::to_owned))
        .filter(|part| !part.is_empty())
        .map(|part| lines(&part))
        .collect();
    if parts.is_empty() { String::new() } else { format!("\n{}", parts.join("\n")) }
}

/// How files are made; Ctrl-C ends it.
pub(crate) fn making(threads: Threads) -> Making<'static> {
    Making { threads: threads.number(), stop: stop_on_ctrl_c(), room: say::room() }
}

/// Says what was found: as JSON, or as lines with the report to open.
pub(crate) fn tell(
    contents: &impl Contents,
    (folder, text): (Option<&Path>, &str),
    output: &Output,
    asides: Asides<'_>,
) {
    if output.json {
        say::text(&contents.summary());
    } else if !output.quiet {
        say_lines(text, folder, asides);
    }
}

fn say_lines(text: &str, folder: Option<&Path>, asides: Asides<'_>) {
    say::table(text);
    asides.lines.iter().for_each(|line| say::line(line));
    asides.found.iter().for_each(|note| say::remark(false, note));
    folder.iter().for_each(|folder| say::line(&format!("open {}", folder.join("report.html").display())));
}

/// Says that the earlier results of the same command are replaced.
pub(crate) fn say_replaced(folder: &Path, output: &Output) {
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
pub(crate) fn say_continued(found: &JournalState, done: &str, noun: &str, output: &Output) {
    if !output.quiet {
        say::aside(&format!("continuing: {done}"));
    }
    if found.damaged > 0 {
        let records = counted(found.damaged, "record");
        say::warning(&format!(
            "the journal has damaged records ({records}); these {noun}s are made again, all others are kept"
        ));
    }
}
