//! What goes into a folder of results, and the one way in which it is written.

use crate::Failure;
use crate::files::folder::Staging;
use crate::files::kept_input::Input;
use crate::page::document::Report;
use spunlaid_charts::Figure;
use std::borrow::Borrow;
use std::io;
use std::io::Write;
use std::panic::resume_unwind;
use std::sync::atomic::AtomicBool;

/// How files are made of results.
#[derive(Clone, Copy, Debug)]
pub struct Making<'a> {
    /// Threads that may be used; they do not change what is made.
    pub threads: usize,
    /// If this is set, nothing more is made.
    pub stop: &'a AtomicBool,
    /// Columns of the terminal that shows the results.
    pub room: usize,
}

/// Results as they go into their folder.
pub trait Contents: Sync {
    /// The files and folders that such results may have, in the order in which they are moved to their
    /// folder. The last one marks them as complete.
    const ENTRIES: &'static [&'static str];
    /// The file of the summary.
    const SUMMARY: &'static str = "summary.json";
    /// Files of many numbers that have one format only.
    const OF_ONE_FORMAT: &'static [&'static str] = &[];

    /// The numbers, as JSON.
    fn summary(&self) -> String;

    /// Remarks about what was found, for a terminal too.
    fn found(&self) -> &[String] {
        &[]
    }

    /// Writes the summary, in parts if it is long.
    ///
    /// # Errors
    /// If it cannot be written.
    fn write_summary(&self, to: &mut dyn Write) -> io::Result<()> {
        to.write_all(self.summary().as_bytes())
    }

    /// Makes everything else, and passes it on: the input, then figures, files and the report.
    ///
    /// # Errors
    /// If something cannot be drawn or written, or the computation is interrupted.
    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure>;

    /// The report as one HTML file.
    ///
    /// # Errors
    /// The errors of [`Contents::make`].
    fn html(&self, making: Making<'_>) -> Result<String, Failure> {
        Ok(self.make(&Maker { making, staging: None })?.html)
    }

    /// Writes all files; of results that are in their folder, report, summary and new figures again, when more is
    /// known. Returns what a terminal shows.
    ///
    /// # Errors
    /// The errors of [`Contents::make`].
    fn write(&self, staging: &Staging<'_>, making: Making<'_>) -> Result<String, Failure> {
        let page = self.make(&Maker { making, staging: Some(staging) })?;
        staging.write(REPORT, page.html)?;
        staging.write_with(Self::SUMMARY, |to| self.write_summary(to))?;
        Ok(page.text)
    }
}

/// The file of the report.
const REPORT: &str = "report.html";

/// Takes what is made of results; it is written if there is a folder.
#[derive(Debug)]
pub struct Maker<'a> {
    /// How it is made.
    pub making: Making<'a>,
    /// Where files are written; none if only the page is asked for.
    staging: Option<&'a Staging<'a>>,
}

impl Maker<'_> {
    /// Keeps what the results are computed from, with the files that it names. Returns it as a file.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn keep(&self, input: Input<'_>) -> Result<String, Failure> {
        match self.staging {
            Some(staging) => staging.input(|| input.keep(staging)),
            None => Ok(input.text()),
        }
    }

    /// Writes figures and the files that only such results have, while the report is made.
    ///
    /// * `name`, `notes` – what the results are called, and warnings and remarks for the reader
    ///
    /// # Errors
    /// If something cannot be drawn or written.
    pub fn finish<'r, F: Borrow<Figure> + Sync>(
        &self,
        name: &str,
        notes: &[String],
        figures: &[F],
        files: impl FnOnce(&Staging<'_>) -> Result<(), Failure> + Send,
        report: impl FnOnce() -> Result<Report<'r>, Failure>,
    ) -> Result<Page, Failure> {
        let page = || {
            let report = report()?.named(name).noting(notes);
            Ok(Page { html: report.html(), text: report.text(self.making.room) })
        };
        let Some(staging) = self.staging else { return page() };
        if staging.is_published() {
            return staging.write_figures(figures).and_then(|()| page());
        }
        // Writing many small files waits for the disk, and pictures take time.
        std::thread::scope(|scope| {
            let files = scope.spawn(|| files(staging));
            let figures = scope.spawn(|| staging.write_figures(figures));
            let (page, threads) = (page(), [files, figures]);
            let joined = threads.map(|thread| thread.join().unwrap_or_else(|panic| resume_unwind(panic)));
            joined.into_iter().collect::<Result<(), _>>().and(page)
        })
    }
}

/// A report.
#[derive(Debug)]
pub struct Page {
    html: String,
    /// What a terminal shows.
    text: String,
}
