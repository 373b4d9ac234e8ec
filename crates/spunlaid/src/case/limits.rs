//! How large a case may be.

/// Largest number of steps of a run.
pub const MOST_STEPS: u64 = 1_000_000_000_000;
/// Largest number of shapes of a fibre that are kept.
pub const MOST_SHAPES: u64 = 20_000;
/// Largest number of replicates. Each takes half a kilobyte of memory for its values in the summary.
pub const MOST_REPLICATES: u64 = 10_000_000;
/// Largest number of recorded instants over all replicates. They are written to disk during the run, so they take
/// no memory. Each takes 150 bytes in the tables of a run, which makes 150 GB in all.
pub const MOST_INSTANTS: f64 = 1e9;

/// How many times `part` fits into `whole`, rounded to a whole number, and whether it fits exactly (apart from
/// floating-point rounding).
pub(crate) fn whole_parts(whole: f64, part: f64) -> (u64, bool) {
    let ratio = whole / part;
    let nearest = ratio.round();
    (nearest as u64, (ratio - nearest).abs() <= 8.0 * f64::EPSILON * ratio)
}
