//! The folder of a spinline.

use super::contents::{Contents, Maker, Page};
use crate::Failure;
use crate::figures::{SPINLINE, spinline_figures};
use crate::output::folder::CASE_FILES;
use crate::output::kept_input::Input;
use crate::output::origin::ORIGIN;
use crate::output::spinline::{STATIONS, SpinResults, summary, write_stations};
use crate::output::table::TABLES;
use crate::report::spinline_report;
use spunlaid::input::SpinFile;

/// Everything of a spinline that goes into the files.
#[derive(Clone, Copy, Debug)]
pub struct SpinFolder<'a> {
    /// What the spinline is called: the name of its file.
    pub name: &'a str,
    /// The spinline.
    pub file: &'a SpinFile,
    /// Its solution.
    pub results: &'a SpinResults,
    /// Notes for the reader.
    pub notes: &'a [String],
}

impl Contents for SpinFolder<'_> {
    const ENTRIES: &'static [&'static str] =
        &[ORIGIN, "spinline.toml", CASE_FILES, STATIONS, TABLES, "figures", "report.html", "summary.json"];

    fn summary(&self) -> String {
        summary(self.results, self.notes)
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let SpinResults { rows, influences } = self.results;
        let input = maker.keep(Input::Spinline(&self.file.spec))?;
        let figures = spinline_figures(SPINLINE, rows, influences);
        let report = || Ok(spinline_report(&self.file.spec, self.results, &figures, &input));
        maker.finish(
            (self.name, self.notes),
            &figures,
            |staging| write_stations(staging, &[(1, rows)]),
            report,
        )
    }
}
