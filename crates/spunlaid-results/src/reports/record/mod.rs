//! The analysis of a velocity record.

pub(crate) mod figures;
pub(crate) mod files;
pub(crate) mod report;
#[cfg(test)]
pub(crate) mod sample;

pub use files::air::air_block;
pub use files::analysis_json;

use crate::Failure;
use crate::files::folder::{ENTRIES, Staging};
use crate::folders::{Contents, Maker, Page};
use figures::record_figures;
use files::write_curves;
use report::analysis_report;
use spunlaid_air::{Analysis, Record};

/// Everything of an analysis that goes into the files.
#[derive(Clone, Copy, Debug)]
pub struct RecordFolder<'a> {
    /// What the record is called: the name of its file.
    pub name: &'a str,
    /// The record.
    pub record: &'a Record,
    /// What was found in it.
    pub analysis: &'a Analysis,
    /// Remarks about its reading.
    pub remarks: &'a [String],
}

impl Contents for RecordFolder<'_> {
    const ENTRIES: &'static [&'static str] = ENTRIES;
    const SUMMARY: &'static str = "analysis.json";

    fn summary(&self) -> String {
        analysis_json(self.record, self.analysis)
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let Self { name, record, analysis, remarks } = *self;
        let figures = record_figures(record, analysis);
        let air = air_block(&record.file, analysis);
        let warnings: Vec<String> = analysis.warnings.iter().map(ToString::to_string).collect();
        let files = |staging: &Staging<'_>| {
            write_curves(staging, analysis)?;
            staging.write("air.toml", &air)
        };
        let report = || Ok(analysis_report(record, analysis, &figures, remarks, &air));
        maker.finish(name, &warnings, &figures, files, report)
    }
}
