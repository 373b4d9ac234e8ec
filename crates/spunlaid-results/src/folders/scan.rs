//! The folder of a scan of a web.

use super::contents::{Contents, Maker, Page};
use super::web::WebFolder;
use crate::Failure;
use crate::figures::scan_figures;
use crate::output::web::{Performance, summary_of_scan, write_scan};
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

impl Contents for ScanFolder<'_> {
    const ENTRIES: &'static [&'static str] = WebFolder::ENTRIES;

    fn summary(&self) -> String {
        summary_of_scan(self.file, (self.findings, self.fabric), self.performance, self.notes)
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let figures = scan_figures(self.findings);
        let report = || scan_report(self.file, (self.findings, self.fabric), &figures, self.performance);
        maker.finish(
            (self.name, self.notes),
            &figures,
            |staging| write_scan(staging, &self.findings.map),
            report,
        )
    }
}
