//! Charts, and the figures of a run.
//!
//! ```text
//! data → Chart (chart) → layout, ticks (scale), thinning (decimate), legend → SVG (svg) → PNG (png)
//! ```

mod chart;
mod decimate;
#[cfg(test)]
mod drag_laws;
mod draw;
mod legend;
mod map;
mod palette;
pub(crate) mod paper;
mod png;
mod record;
#[cfg(test)]
pub(crate) mod record_sample;
mod run;
#[cfg(test)]
pub(crate) mod sample;
mod scale;
mod study;
mod svg;
#[cfg(test)]
mod tests;

pub(crate) use decimate::even;
pub(crate) use png::png;
pub(crate) use record::record_figures;
pub(crate) use run::{run_figures, significant};
pub(crate) use scale::signed;
pub(crate) use study::{name_of_key, study_figures};

/// A figure: a picture and what it shows.
#[derive(Clone, Debug)]
pub(crate) struct Figure {
    /// File name without ending.
    pub(crate) name: String,
    /// A few words.
    pub(crate) title: String,
    /// What is shown and what the numbers mean.
    pub(crate) caption: String,
    /// The picture.
    pub(crate) svg: String,
}
