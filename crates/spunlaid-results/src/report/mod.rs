//! `report.html`: one file that shows a run to whoever opens it, offline.
//!
//! ```text
//! Results → words (headline, numbers), table (rows), frames (the moving fibre) → page (assets/report.html)
//! ```

mod advice;
mod air;
mod analysis;
mod comparison;
mod fabric;
mod fit;
mod frames;
mod guesses;
mod headline;
mod light_table;
mod methods;
mod page;
mod paper;
mod scan;
mod spinline;
mod study;
mod table;
#[cfg(test)]
mod tests;
mod web;
mod words;

pub use advice::{advice_commands, advice_words};
pub use air::{AirReport, air_html};
pub use analysis::{AnalysisReport, analysis_html};
pub use comparison::{ComparedPictures, ComparisonReport, comparison_html};
pub use fit::{FitReport, fit_html};
pub use guesses::guess_words;
pub use paper::{PaperReport, paper_html};
pub use scan::{ScanReport, scan_html};
pub use spinline::{LayerSpinline, SpinReport, spinline_html};
pub use study::{StudyReport, study_html};
pub use web::{WebReport, web_html};

use crate::Failure;
use crate::output::spinline::SpinResults;
use crate::output::summary::Performance;
use askama::Template;
use spunlaid::case::Case;
use spunlaid::ensemble::{FinerChecks, Results};
use spunlaid_charts::Figure;

/// Script with the class `Camera`: how the space of the moving fibre is seen and turned, for other pages that show one.
pub const CAMERA: &str = include_str!("../../assets/camera.js");
/// Script with the class `Scene`, which draws the fibre on a canvas as a `Camera` sees it.
pub const SCENE: &str = include_str!("../../assets/scene.js");

/// Everything the report shows.
#[derive(Clone, Copy, Debug)]
pub struct ReportInput<'a> {
    /// What the run is called: the name of the case file.
    pub name: &'a str,
    /// The case.
    pub case: &'a Case,
    /// The resolved case as a case file.
    pub case_toml: &'a str,
    /// The results, with the trajectories that are to be seen moving.
    pub results: &'a Results,
    /// What half the time step changes, if it was computed.
    pub checks: &'a FinerChecks,
    /// The figures, see [`crate::figures::run_figures`].
    pub figures: &'a [Figure],
    /// The spinline from which the fibre is fed, with its figures.
    pub spinline: Option<(&'a SpinResults, &'a [Figure])>,
    /// Warnings and remarks for the reader.
    pub notes: &'a [String],
    /// What the run cost.
    pub performance: Performance,
}

/// The version of the program that writes the pages.
pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The report as one HTML file of less than 6 MB.
///
/// # Errors
/// The file of the shapes cannot be read.
pub fn html(input: &ReportInput<'_>) -> Result<String, Failure> {
    page::render(input)
}

/// A page as HTML.
fn rendered(page: &impl Template) -> String {
    // Writing to a string fails only where a value's own formatting does, and none here can.
    page.render().unwrap_or_else(|error| format!("<!doctype html><title>Report</title><p>{error}"))
}
