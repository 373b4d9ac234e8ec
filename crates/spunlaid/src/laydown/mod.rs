//! A laid fibre as a curve on the belt: what its points say about the lay-down.
//!
//! A [`Trace`] takes the points of one fibre in the order of feed and keeps sums only, so its memory does not grow
//! with the length of the fibre.

mod correlation;
mod footprint;
mod trace;

pub use footprint::Footprint;
pub use trace::{LaidCurve, Trace, TraceSettings};
