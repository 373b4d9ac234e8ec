//! How the samples of a block lie in memory.

/// Samples before a place that its interpolation needs, and all that it needs.
pub(super) const BEFORE: i64 = 1;
pub(super) const NEEDED: usize = 4;
/// Samples, or points, that a piece repeats of the one beside it, so that those around a place lie side by side.
pub(super) const REPEATED: usize = NEEDED - 1;
/// Points along z in a brick. In a row of all points the samples around a place would lie far apart in memory.
pub(super) const BRICK: usize = 32;
/// Numbers of a sample in a brick, with the points that it repeats of the next one.
pub(super) const ROW: usize = 3 * (BRICK + REPEATED);
/// Numbers that are read for a sample: four points of three components, and what follows them.
pub(super) const READ: usize = 16;
/// Numbers in a line of a block. What follows the last point is read, but does not count.
pub(super) fn line_size(samples: usize, points: usize) -> usize {
    points.div_ceil(BRICK) * samples * ROW + READ - 3 * NEEDED
}
