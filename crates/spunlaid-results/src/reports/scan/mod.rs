//! A scan of a web.

pub(crate) mod report;

use crate::Failure;
use crate::files::origin::Performance;
use crate::folders::{Contents, Maker, Page};
use crate::reports::web::WebFolder;
use crate::reports::web::figures::scan_figures;
use crate::reports::web::files::map::write_array as write_scan;
use crate::reports::web::files::summary::summary_of_scan;
use report::scan_report;
use spunlaid_ground::Isa;
use spunlaid_web::Fabric;
use spunlaid_web::fabric::of_scan;
use spunlaid_web::scan::Findings;
use std::time::Instant;

/// Everything of a scan that goes into the files.
#[derive(Debug)]
pub struct ScanFolder {
    /// What the scan is called: the name of its file.
    pub name: String,
    /// The path of its file.
    file: String,
    /// What was found of it.
    pub findings: Findings,
    /// What is reported of the fabric.
    fabric: Fabric,
    /// What a reader must know of what was found.
    notes: Vec<String>,
    /// What it cost.
    performance: Performance,
}

impl ScanFolder {
    /// * `started` – when the scan began to be read
    pub fn new(name: String, file: String, findings: Findings, started: Instant) -> Self {
        let fabric = of_scan(&findings);
        let performance = Performance::measure(started, 1, Isa::detect());
        let notes = findings.notes.iter().map(ToString::to_string).collect();
        Self { name, file, findings, fabric, notes, performance }
    }
}

impl Contents for ScanFolder {
    const ENTRIES: &'static [&'static str] = WebFolder::ENTRIES;

    fn summary(&self) -> String {
        summary_of_scan(&self.file, &self.findings, &self.fabric, self.performance, &self.notes)
    }

    fn found(&self) -> &[String] {
        &self.notes
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let figures = scan_figures(&self.findings);
        let report = || scan_report(&self.file, &self.findings, &self.fabric, &figures, self.performance);
        maker.finish(
            &self.name,
            &self.notes,
            &figures,
            |staging| write_scan(staging, &self.findings.map),
            report,
        )
    }
}
