//! Errors of webs that cannot be laid.

use crate::units::Dimension;
use std::path::PathBuf;

/// What is wrong with a web.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LayingFault {
    /// A layer without filaments or without fibre.
    #[error(
        "layer {layer} of the web lays nothing: it needs filaments, a feed speed and a belt speed above zero"
    )]
    NoLayer {
        /// Number of the layer, from 1.
        layer: usize,
    },
    /// No cells, or cells so large that they cannot count the fibre in them.
    #[error(
        "the web has no layer or no cells, or its cells are too large for the fibre that they would hold; choose smaller cells (web.cell)"
    )]
    NoSheet,
    /// A cell that holds more than can be counted.
    #[error(
        "a cell of {cell:e} m holds more fibre than can be counted, since the filaments lie in few places; choose smaller cells (web.cell)"
    )]
    FullCell {
        /// Side of a cell [m].
        cell: f64,
    },
    /// A web that is nothing but edges.
    #[error(
        "the edges of the web, where it is thin, take {} and {} of its width of {} (3 σ_CD inwards of the outermost filament), and no two patches of {} fit between \
         them; write web.edges = \"periodic\", or a larger web.width",
        Dimension::Length.pretty(margins[0]), Dimension::Length.pretty(margins[1]), Dimension::Length.pretty(*width),
        Dimension::Length.pretty(*smallest)
    )]
    OnlyEdges {
        /// Width of the web [m].
        width: f64,
        /// Width of its edges [m].
        margins: [f64; 2],
        /// Side of the smallest patch [m].
        smallest: f64,
    },
    /// A surrogate without a path.
    #[error("no path can be made with the standard deviations {:e} m and {:e} m and the noise {:e} m^-0.5; all must be above zero",
        sigmas[0], sigmas[1], noise)]
    NoPath {
        /// Standard deviations in machine and cross direction [m].
        sigmas: [f64; 2],
        /// Noise [m^-½].
        noise: f64,
    },
    /// Curves that cannot be laid.
    #[error(
        "there are no laid curves, or they are too short: each needs more than 16 points at a spacing above zero; fly the case for longer (run.duration)"
    )]
    NoCurves,
    /// Curves that were flown on another line.
    #[error(
        "the curves were laid at a belt speed of {curves} times the feed speed, the layer has {layer} times; fly the case at the belt speed of the web"
    )]
    OtherLine {
        /// Speed of the belt over speed of the feed of the curves.
        curves: f64,
        /// The same of the layer.
        layer: f64,
    },
    /// What fibres have laid cannot make a web.
    #[error("{}: {reason}", origin.display())]
    Nothing {
        /// The case or the folder of results.
        origin: PathBuf,
        /// Why.
        reason: String,
    },
    /// A folder does not hold the results of a run.
    #[error(
        "{}: does not hold the results of a run: {reason}; name folders that `spunlaid run` has written",
        folder.display()
    )]
    NotARun {
        /// The folder.
        folder: PathBuf,
        /// Why.
        reason: String,
    },
}
