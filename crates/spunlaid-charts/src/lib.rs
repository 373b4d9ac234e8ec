//! Charts for reports: the picture as SVG, PNG and PDF, and the numbers it shows as CSV.
//!
//! The same data give the same bytes on every machine: the fonts are part of the crate, and nothing depends on the
//! time, the locale or the number of threads.
//!
//! ```text
//! data → Chart (axes, series, marks) → Figure ─ picture   layout, ticks, thinning, legend: a list of shapes,
//!                                             │            written as svg, png or pdf with the crate's own fonts
//!                                             └ table     every point that the figure shows, as CSV
//! ```
//!
//! # Example
//!
//! ```
//! use spunlaid_charts::{Axis, Chart, Figure, Series, png};
//!
//! let velocity = Axis::linear("Velocity *U* (m/s)");
//! let amplitude = Axis::linear("Amplitude (mm)").zero_based();
//! let chart = Chart::new("amplitude_over_velocity", "Amplitude over the velocity", velocity, amplitude)
//!     .scatter(Series::circles("*y*"), &[(5.0, 4.8, Some(0.1)), (10.0, 9.8, Some(0.2))])
//!     .scatter(Series::triangles("*z*"), &[(5.0, 4.7, Some(0.1)), (10.0, 9.5, None)]);
//! let figure = Figure::new(&chart, "Mean over ten replicates; bars are one standard error.");
//!
//! assert!(figure.svg().starts_with("<svg"));
//! assert!(png(&figure.picture(), 192, &[])?.starts_with(b"\x89PNG"));
//! assert_eq!(
//!     figure.table().csv(),
//!     "series,velocity_m_s,amplitude_mm,error\n\
//!      y,5,4.8,0.1\n\
//!      y,10,9.8,0.2\n\
//!      z,5,4.7,0.1\n\
//!      z,10,9.5,\n"
//! );
//! # Ok::<(), spunlaid_charts::PictureError>(())
//! ```
//!
//! Labels have a small mark-up: `*t*` is italic, `^{2}` is raised, `_{n}` is lowered.
//! Directions are shown by a [`Rose`]. What neither can show is a [`Drawing`]: a [`Picture`] is made of lines,
//! areas and texts, in the colours of [`palette`].

// Units stand in brackets, [px], which rustdoc takes for links that lead nowhere.
#![allow(rustdoc::broken_intra_doc_links)]

mod chart;
mod decimate;
mod draw;
mod figure;
mod glyphs;
pub mod label;
mod layout;
mod legend;
mod map;
mod numbers;
mod outline;
pub mod palette;
mod pdf;
pub mod picture;
mod pixels;
mod png;
mod rose;
mod scale;
mod svg;
mod table;

pub use chart::{Chart, Mark, Series};
pub use decimate::even;

pub use figure::{Drawing, Figure};
pub use map::{Map, Shades};
pub use numbers::{shortest, signed, significant};
pub use palette::Marker;
pub use pdf::pdf;
pub use picture::{Picture, PictureError};
pub use png::png;
pub use rose::Rose;
pub use scale::{Axis, Scale, Spacing, Tick};
pub use svg::svg;
pub use table::Table;
