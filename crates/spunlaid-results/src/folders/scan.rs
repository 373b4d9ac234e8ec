//! The folder of a scan of a web.

use crate::Failure;
use crate::figures::scan_figures;
use crate::output::folder::Staging;
use crate::output::web::{Performance, Summary, write_scan};
use crate::report::scan_report;
use spunlaid::fabric::Fabric;
use spunlaid::scan::Findings;

/// Everything of a scan that goes into the files.
#[derive(Clone, Copy, Debug)]
pub struct ScanFolder<'a> {
    /// What the scan is called: the name of its file.
    pub name: &'a str,
    /// The path of its file.
    pub file: &'a str,
    /// What was found of it.
    pub findings: &'a Findings,
    /// What is told of the fabric.
    pub fabric: &'a Fabric,
    /// Notes for the reader, [`notes`].
    pub notes: &'a [String],
    /// What it cost.
    pub performance: Performance,
}

/// What a reader must know of what was found.
pub fn notes(findings: &Findings) -> Vec<String> {
    findings.notes.iter().map(ToString::to_string).collect()
}

impl ScanFolder<'_> {
    /// The text of `summary.json`.
    pub fn summary(&self) -> String {
        Summary::from_scan(self.file, (self.findings, self.fabric), self.performance, self.notes).to_json()
    }

    /// Writes the map, the figures, the report and the summary.
    ///
    /// # Errors
    /// If a file cannot be written, or the computation is interrupted.
    pub fn write(&self, staging: &Staging<'_>) -> Result<(), Failure> {
        let Self { name, file, findings, fabric, notes, performance } = *self;
        write_scan(staging, &findings.map)?;
        let figures = scan_figures(findings);
        staging.write_figures(&figures)?;
        let report = scan_report(file, (findings, fabric), &figures, performance)?;
        staging.write("report.html", report.named(name).noting(notes).html())?;
        staging.write("summary.json", self.summary())
    }
}
