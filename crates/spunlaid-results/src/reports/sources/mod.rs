//! The force of filaments on the cells of their CFD field.

mod files;
mod report;

use crate::Failure;
use crate::files::folder::{CASE_FILES, Staging};
use crate::files::kept_input::Input;
use crate::files::origin::ORIGIN;
use crate::folders::{Contents, Maker, Page};
use crate::reports::run::lost;
use files as sources;
use files::openfoam::{OPENFOAM, write_openfoam};
use files::vtk::VTK;
use files::{outside_of_cells, unsteady};
use report::sources_report;
use spunlaid_charts::Figure;
use spunlaid_fibre::Case;
use spunlaid_ground::Diagnostic;
use spunlaid_simulation::Sources;

/// Everything of the sources that goes into the files.
#[derive(Debug)]
pub struct SourcesFolder<'a> {
    name: String,
    case: &'a Case,
    input: Input<'a>,
    sources: Sources,
    /// What the results lack: lost fibres, and the sources of flights that are not steady.
    pub lacking: Vec<String>,
    found: Vec<String>,
    /// Notes for the reader, with both.
    notes: Vec<String>,
}

impl<'a> SourcesFolder<'a> {
    /// * `name` – what the line is called: the name of its file
    /// * `input` – what it is from
    /// * `case` – that was simulated
    /// * `notes` – about both
    pub fn new(
        name: String,
        input: Input<'a>,
        case: &'a Case,
        notes: &[Diagnostic],
        sources: Sources,
    ) -> Self {
        let lost = lost(&sources.lost, case.run.replicates);
        let lacking: Vec<String> = lost.into_iter().chain(unsteady(case, &sources)).collect();
        let found = Vec::from_iter(outside_of_cells(&sources));
        let notes = [&Diagnostic::notes_of_results(notes)[..], &lacking, &found].concat();
        Self { name, case, input, sources, lacking, found, notes }
    }
}

impl Contents for SourcesFolder<'_> {
    const ENTRIES: &'static [&'static str] =
        &[ORIGIN, CASE_FILES, "case.toml", "web.toml", VTK, OPENFOAM, "report.html", "summary.json"];

    fn summary(&self) -> String {
        sources::summary(self.case, &self.sources, &self.notes)
    }

    fn found(&self) -> &[String] {
        &self.found
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let input = maker.keep(self.input)?;
        let files = |staging: &Staging<'_>| {
            if !self.sources.are_steady() {
                return Ok(());
            }
            sources::vtk::write_vtk(staging, self.case, &self.sources)?;
            write_openfoam(staging, self.case, &self.sources)
        };
        let report = || Ok(sources_report(self.case, &input, &self.sources));
        maker.finish(&self.name, &self.notes, &[] as &[Figure], files, report)
    }
}
