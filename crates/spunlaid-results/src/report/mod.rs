//! `report.html`: one file that shows results to whoever opens it, offline.
//!
//! ```text
//! results → a function for each product (run, web, study, …) → Report: headline, notes, sections of parts
//!   → one template (assets/page.html)
//! ```
//!
//! `document` has the parts, `table` tables, `view` what is looked at. `words`, `unevenness`, `methods` and
//! `spinline` say what several reports say.

mod air;
mod analysis;
mod cards;
mod claims;
mod comparison;
mod document;
mod effects;
mod fabric;
mod fit;
mod frames;
mod light_table;
mod load;
mod methods;
mod paper;
mod patches;
mod pictures;
mod run;
mod run_table;
mod scale;
mod scan;
mod sources;
mod spinline;
mod study;
mod table;
#[cfg(test)]
mod tests;
mod text;
mod unevenness;
mod view;
mod web;
mod words;

pub use air::air_report;
pub use analysis::analysis_report;
pub use comparison::comparison_report;
pub use document::Report;
pub use effects::Advised;
pub use fit::fit_report;
pub use load::load_words;
pub use paper::paper_report;
pub use pictures::ComparedPictures;
pub use run::run_report;
pub use scan::scan_report;
pub use sources::sources_report;
pub use spinline::{LayerSpinline, spinline_report, spinline_text};
pub use study::study_report;
pub use text::aligned;
pub use web::web_report;

/// Script with the class `Camera`: how the space of the moving fibre is seen and turned, for other pages that show one.
pub const CAMERA: &str = include_str!("../../assets/camera.js");
/// Script with the class `Scene`, which draws the fibre on a canvas as a `Camera` sees it.
pub const SCENE: &str = include_str!("../../assets/scene.js");
