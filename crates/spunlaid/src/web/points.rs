//! Curves of filaments as they are laid, point by point.

use crate::lanes::Lanes;
use crate::surrogate::Paths;

/// Curves of up to eight filaments, point by point.
pub(super) trait Points {
    /// Fills `points` with the ends of at most so many pieces: the first is where the next piece begins, the
    /// others where pieces end. Returns the number of points.
    fn next(&mut self, pieces: usize, points: &mut [[Lanes; 2]]) -> usize;

    /// The paths that they follow, if they are paths of the surrogate.
    fn paths(&mut self) -> Option<&mut Paths> {
        None
    }
}
