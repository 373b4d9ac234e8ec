//! The folder of the sources of a case.

use super::contents::{Contents, Maker, Page};
use crate::Failure;
use crate::output::folder::{CASE_FILES, Staging};
use crate::output::kept_input::Input;
use crate::output::origin::ORIGIN;
use crate::output::sources::{OPENFOAM, VTK, summary, write_openfoam, write_vtk};
use crate::report::sources_report;
use spunlaid::case::Case;
use spunlaid::ensemble::Sources;
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
        summary(self.case, self.sources, self.notes)
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let input = maker.keep(self.input)?;
        let files = |staging: &Staging<'_>| {
            if !self.sources.are_steady() {
                return Ok(());
            }
            write_vtk(staging, self.case, self.sources)?;
            write_openfoam(staging, self.case, self.sources)
        };
        let report = || Ok(sources_report((self.case, &input), self.sources));
        maker.finish((self.name, self.notes), &[] as &[Figure], files, report)
    }
}
