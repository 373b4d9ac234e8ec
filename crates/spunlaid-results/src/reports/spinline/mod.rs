//! A spinline from the melt.

pub(crate) mod figures;
pub mod files;
pub(crate) mod report;
#[cfg(test)]
pub(crate) mod sample;

pub use files::SpinResults;
pub use report::spinline_text;

use crate::Failure;
use crate::figures::drag_laws;
use crate::files::folder::{CASE_FILES, Staging};
use crate::files::kept_input::Input;
use crate::files::origin::ORIGIN;
use crate::files::table::TABLES;
use crate::folders::{Contents, Maker, Page};
use figures::{SPINLINE, spinline_figures};
use files as spinline;
use files::{STATIONS, remarks, write_stations};
use report::spinline_report;
use spunlaid_fibre::{Drag, NormalLaw};
use spunlaid_ground::{Diagnostic, Error};
use spunlaid_input::SpinFile;

/// Everything of a spinline that goes into the files.
#[derive(Debug)]
pub struct SpinFolder {
    /// What the spinline is called: the name of its file.
    pub name: String,
    /// The spinline.
    pub file: SpinFile,
    /// Its solution.
    pub results: SpinResults,
    /// Remarks about what was found.
    found: Vec<String>,
}

impl SpinFolder {
    /// Solves a spinline.
    ///
    /// # Errors
    /// If it has no steady state that a line could run in.
    pub fn solve(name: String, file: SpinFile) -> Result<Self, Error> {
        let results = SpinResults::new(&file)?;
        let found = remarks(file.spec.drag.along, &results.rows);
        Ok(Self { name, file, results, found })
    }

    /// Notes for the reader.
    fn notes(&self) -> Vec<String> {
        [Diagnostic::notes_of_results(&self.file.notes), self.found.clone()].concat()
    }
}

impl Contents for SpinFolder {
    const ENTRIES: &'static [&'static str] =
        &[ORIGIN, "spinline.toml", CASE_FILES, STATIONS, TABLES, "figures", "report.html", "summary.json"];

    fn summary(&self) -> String {
        spinline::summary(&self.results, &self.notes())
    }

    fn found(&self) -> &[String] {
        &self.found
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let SpinResults { rows, influences } = &self.results;
        let input = maker.keep(Input::Spinline(&self.file.spec))?;
        let mut figures = spinline_figures(SPINLINE, rows, influences);
        // Only the friction along the thread counts here.
        let drag = Drag { across: NormalLaw::MarheinekeWegener, ..self.file.spec.drag };
        figures.extend(rows.first().iter().flat_map(|row| drag_laws::of_files(&drag, row.final_diameter)));
        let report = || Ok(spinline_report(&self.file.spec, &self.results, &figures, &input));
        let files = |staging: &Staging<'_>| write_stations(staging, &[(1, rows)]);
        maker.finish(&self.name, &self.notes(), &figures, files, report)
    }
}
