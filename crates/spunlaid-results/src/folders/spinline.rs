//! The folder of a spinline.

use crate::Failure;
use crate::figures::{SPINLINE, spinline_figures};
use crate::output::copied_files;
use crate::output::folder::Staging;
use crate::output::spinline::{SpinResults, Summary, write_stations};
use crate::report::spinline_report;
use spunlaid::input::{SpinFile, write_spinline};
use spunlaid_charts::Figure;

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

impl SpinFolder<'_> {
    /// The text of `summary.json`.
    pub fn summary(&self) -> String {
        Summary::new(&self.results.rows, &self.results.influences, self.notes).to_json()
    }

    /// Writes the thread, the figures, the report, the file and the summary.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn write(&self, staging: &Staging<'_>) -> Result<(), Failure> {
        let spec = &self.file.spec;
        let copied = copied_files::copy(spec.files(), &staging.place(copied_files::CASE_FILES).0)?;
        let toml = write_spinline(&spec.with_files_at(copied_files::place(&copied)));
        write_stations(staging, &[(1, &self.results.rows)])?;
        let figures = self.figures();
        staging.write_figures(&figures)?;
        staging.write("report.html", self.page(&toml, &figures))?;
        staging.write("spinline.toml", toml)?;
        staging.write("summary.json", self.summary())
    }

    /// The report as one HTML file.
    pub fn report(&self) -> String {
        self.page(&write_spinline(&self.file.spec), &self.figures())
    }

    fn figures(&self) -> Vec<Figure> {
        spinline_figures(SPINLINE, &self.results.rows, &self.results.influences)
    }

    fn page(&self, toml: &str, figures: &[Figure]) -> String {
        let report = spinline_report(&self.file.spec, self.results, figures, toml);
        report.named(self.name).noting(self.notes).html()
    }
}
