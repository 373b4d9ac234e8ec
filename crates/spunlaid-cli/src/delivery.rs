//! How a command delivers what it has found: into its folder, then as JSON or as lines of the terminal.

use crate::args::{Invocation, Output, Threads};
use crate::control::stop_on_ctrl_c;
use crate::failure::Failure;
use crate::say;
use spunlaid::experiment::JournalState;
use spunlaid::ground::error::counted;
use spunlaid_results::files::folder::Staging;
use spunlaid_results::files::pictures::FigureFiles;
use spunlaid_results::folders::{Contents, JournalFolder, Making};
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

impl<'a> Delivery<'a> {
    /// Opens the folder for results of a kind, if there shall be one. What the same command wrote before is
    /// replaced, and a note says so.
    ///
    /// * `files` – that the command reads
    /// * `name` – of the folder, if none is named
    pub(crate) fn open<'f, C: Contents>(
        invocation: &Invocation,
        files: impl IntoIterator<Item = &'f PathBuf>,
        name: impl AsRef<Path>,
        output: &'a Output,
        figures: FigureFiles,
    ) -> Result<Self, Failure> {
        let open = |folder: &PathBuf| -> Result<_, Failure> {
            let (origin, stop) = (invocation.origin_of(files, folder), stop_on_ctrl_c());
            let mut staging = Staging::with_origin(folder, C::ENTRIES, output.force, origin, stop)?;
            staging.set_figures(&figures);
            if staging.replaces_own() {
                say_replaced(folder, output);
            }
            Ok(staging)
        };
        let folder = output.optional_folder(name);
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
    ///
    /// * `lines` – below the results
    pub(crate) fn deliver(
        mut self,
        contents: &impl Contents,
        threads: Threads,
        lines: &[String],
    ) -> Result<(), Failure> {
        self.publish(contents, threads)?;
        self.finish(contents, lines);
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

    /// Says as lines what was found and has not been said; the first time also which page to open.
    pub(crate) fn say(&mut self, contents: &impl Contents, lines: &[String]) {
        if self.output.json || self.output.quiet {
            return;
        }
        match &self.said {
            None => say_lines(&self.text, contents, lines, self.folder.as_deref()),
            Some(said) => say::table(&new_text(said, &self.text)),
        }
        self.said = Some(self.text.clone());
    }

    /// Whether nothing shall be said.
    pub(crate) const fn is_quiet(&self) -> bool {
        self.output.quiet
    }

    /// Says a line beside the results.
    pub(crate) fn line(&self, line: &str) {
        if !self.output.json && !self.output.quiet {
            say::line(line);
        }
    }

    /// Says the rest of what was found, or all of it as JSON.
    pub(crate) fn finish(&mut self, contents: &impl Contents, lines: &[String]) {
        self.say(contents, lines);
        if self.output.json {
            say::text(&contents.summary());
        }
    }
}

/// What a text says that an earlier one did not: the lines of its first paragraph, and whole paragraphs below it.
fn new_text(before: &str, now: &str) -> String {
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
pub(crate) fn print_results(
    contents: &impl Contents,
    folder: &Path,
    text: &str,
    lines: &[String],
    output: &Output,
) {
    if output.json {
        say::text(&contents.summary());
    } else if !output.quiet {
        say_lines(text, contents, lines, Some(folder));
    }
}

fn say_lines(text: &str, contents: &impl Contents, lines: &[String], folder: Option<&Path>) {
    say::table(text);
    lines.iter().for_each(|line| say::line(line));
    contents.found().iter().for_each(|found| say::remark(false, found));
    folder.iter().for_each(|folder| say::line(&format!("open {}", folder.join("report.html").display())));
}

/// Says beside the results how the work goes, unless nothing shall be said.
pub(crate) fn aside(output: &Output, text: &str) {
    if !output.quiet {
        say::aside(text);
    }
}

/// Says that the earlier results of the same command are replaced.
fn say_replaced(folder: &Path, output: &Output) {
    if !output.quiet {
        let replaced =
            format!("{}: holds earlier results of this command, which are replaced", folder.display());
        say::remark(false, &replaced);
    }
}

/// Begins to write results in a folder with a journal; a note says that earlier ones are replaced.
pub(crate) fn begin(folder: &mut JournalFolder<'_>, figures: FigureFiles, output: &Output) {
    if folder.replaces() {
        say_replaced(folder.path(), output);
    }
    folder.figures = figures;
}

/// Says what has been done before of work that goes on.
///
/// * `done` – how much of it
/// * `noun` – of which a record of the journal is
pub(crate) fn say_continued(found: &JournalState, done: &str, noun: &str, output: &Output) {
    aside(output, &format!("continuing: {done}"));
    if found.damaged > 0 {
        let records = counted(found.damaged, "record");
        say::warning(&format!(
            "the journal has damaged records ({records}); these {noun}s are made again, all others are kept"
        ));
    }
}
