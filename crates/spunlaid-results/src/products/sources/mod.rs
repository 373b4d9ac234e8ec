//! The force of filaments on the cells of their CFD field.

mod files;
mod report;

pub use files::{outside_of_cells, unsteady};

use crate::Failure;
use crate::files::folder::{CASE_FILES, Staging};
use crate::files::kept_input::Input;
use crate::files::origin::ORIGIN;
use crate::folders::{Contents, Maker, Page};
use files as sources;
use files::openfoam::{OPENFOAM, write_openfoam};
use files::vtk::VTK;
use report::sources_report;
use spunlaid::fibre::Case;
use spunlaid::simulation::Sources;
use spunlaid_charts::Figure;

/// Everything of the sources that goes into the files.
#[derive(Clone, Copy, Debug)]
pub struct SourcesFolder<'a> {
    /// What the line is called: the name of its file.
    pub name: &'a str,
    /// The case that was flown.
    pub case: &'a Case,
    /// What it is from.
    pub input: Input<'a>,
    /// What was found.
    pub sources: &'a Sources,
    /// Notes for the reader.
    pub notes: &'a [String],
}

impl Contents for SourcesFolder<'_> {
    const ENTRIES: &'static [&'static str] =
        &[ORIGIN, CASE_FILES, "case.toml", "web.toml", VTK, OPENFOAM, "report.html", "summary.json"];

    fn summary(&self) -> String {
        sources::summary(self.case, self.sources, self.notes)
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let input = maker.keep(self.input)?;
        let files = |staging: &Staging<'_>| {
            if !self.sources.are_steady() {
                return Ok(());
            }
            sources::vtk::write_vtk(staging, self.case, self.sources)?;
            write_openfoam(staging, self.case, self.sources)
        };
        let report = || Ok(sources_report((self.case, &input), self.sources));
        maker.finish((self.name, self.notes), &[] as &[Figure], files, report)
    }
}
