//! How far the unevenness of a map may be from that of the filaments that were flown: by chance, and by their
//! small number.

use super::PatchFindings;

/// The standard error of the CV of a map, by its causes [as the CV].
///
/// What the flight itself leaves out (its mesh, its time step, its drag law) is not in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WholeError {
    /// By chance: another piece of the same web has another CV. None if the sheet is too small to say.
    pub chance: Option<f64>,
    /// By the filaments that were flown, which are few. None if nothing was flown, or if they do not tell it.
    pub flight: Option<f64>,
}

impl WholeError {
    /// All causes together; None if one of them is not known.
    ///
    /// The square of a difference and the square of its standard error together are what the square of the
    /// true difference is on average, so the squares add up.
    pub fn whole(&self) -> Option<f64> {
        Some(self.chance?.hypot(self.flight?))
    }
}

impl PatchFindings {
    /// The error of the CV of the map, by its causes.
    pub fn whole_error(&self) -> WholeError {
        // Unless a few stand for all, every filament of the sheet has been flown.
        let flight = self.few.map_or(0.0, |few| few.by_pitch);
        let is_known = self.in_one_air && self.doubt.is_none();
        WholeError { chance: self.map.standard_error, flight: is_known.then_some(flight) }
    }
}
