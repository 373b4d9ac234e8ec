//! `report.html`: one file that shows a run to whoever opens it, offline.
//!
//! ```text
//! Results → words (headline, numbers), table (rows), frames (the moving fibre) → page (assets/report.html)
//! ```

mod analysis;
mod comparison;
mod frames;
mod page;
mod paper;
mod study;
mod table;
#[cfg(test)]
mod tests;
mod words;

pub(crate) use analysis::{AnalysisReport, analysis_html};
pub(crate) use comparison::{ComparisonReport, comparison_html};
pub(crate) use paper::{PaperReport, paper_html};
pub(crate) use study::{StudyReport, study_html};

use spunlaid::case::Case;
use spunlaid::ensemble::Results;
use spunlaid_charts::Figure;

/// Everything the report shows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReportInput<'a> {
    /// What the run is called: the name of the case file.
    pub(crate) name: &'a str,
    /// The case.
    pub(crate) case: &'a Case,
    /// The resolved case as a case file.
    pub(crate) case_toml: &'a str,
    /// The results, with the flights that are to be seen moving.
    pub(crate) results: &'a Results,
    /// The figures, see [`crate::figures::run_figures`].
    pub(crate) figures: &'a [Figure],
    /// Warnings and remarks for the reader.
    pub(crate) notes: &'a [String],
    /// What the run cost.
    pub(crate) performance: Performance<'a>,
    /// Version of the program.
    pub(crate) version: &'a str,
}

/// What a run cost.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Performance<'a> {
    /// Time on the clock [s].
    pub(crate) wall_seconds: f64,
    /// Number of threads.
    pub(crate) threads: usize,
    /// Time per element and step [ns].
    pub(crate) nanoseconds_per_element_step: f64,
    /// Instruction set, as in [`spunlaid::lanes::Isa::name`].
    pub(crate) instructions: &'a str,
}

/// The report as one HTML file of less than 6 MB.
pub(crate) fn html(input: &ReportInput<'_>) -> String {
    page::render(input)
}
