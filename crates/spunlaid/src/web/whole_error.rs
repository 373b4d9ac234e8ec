//! How far the unevenness of a map may be from that of the fibres that were flown: by chance, by the few
//! fibres, by the model.

use super::{Fibres, PatchFindings, Web};

/// The standard error of the CV of a map, by its causes [as the CV].
///
/// What the flight itself leaves out (its mesh, its time step, its drag law) is not in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WholeError {
    /// By chance: another piece of the same web has another CV. None if the sheet is too small to say.
    pub chance: Option<f64>,
    /// By the fibres that were flown, which are few. None if the web was not laid from flights, or from a single curve.
    pub flight: Option<f64>,
    /// By the model that laid the map: how far its expected CV is from that of the flown curves. Zero for the
    /// flown curves themselves; None for a surrogate whose numbers were given, because nothing was flown
    /// beside it.
    pub model: Option<f64>,
}

impl WholeError {
    /// All causes together; None if one of them is not known.
    ///
    /// The square of a difference and the square of its standard error together are what the square of the
    /// true difference is on average, so the squares add up.
    pub fn whole(&self) -> Option<f64> {
        Some(self.chance?.hypot(self.flight?).hypot(self.model?))
    }
}

/// How far the surrogate may be from the flown curves before one of them has to be believed.
const FAR: f64 = 0.05;
/// Standard errors within which a difference may be chance.
const CHANCE: f64 = 2.0;

impl PatchFindings {
    /// The error of the CV of the map, by its causes.
    pub fn whole_error(&self) -> WholeError {
        if self.independent.is_some() {
            // Unless a few stand for all, every filament of the sheet has been flown.
            let flight = self.few.map_or(0.0, |few| few.by_pitch);
            let [flight, model] = [flight, 0.0].map(|part| self.doubt.is_none().then_some(part));
            return WholeError { chance: self.map.standard_error, flight, model };
        }
        // What is expected of the web is as far off, in parts of itself.
        let per_expected = self.map.cv / self.single_fibres.0;
        let parts = self.flown.map(|(flown, error)| [error, flown - self.single_fibres.0]);
        let part = |part: usize| parts.map(|parts| (parts[part] * per_expected).abs());
        let [flight, model] = [0, 1].map(|i| part(i).filter(|error| error.is_finite()));
        WholeError { chance: self.map.standard_error, flight, model }
    }

    /// The CV that the surrogate lets expect over that of the flown curves, less one, with its standard
    /// error; None unless both are known.
    pub fn surrogate_over_flown(&self) -> Option<(f64, f64)> {
        let ((surrogate, own), (flown, error)) = (self.surrogate?, self.flown?);
        let ratio = surrogate / flown;
        Some((ratio - 1.0, ratio * (own / surrogate).hypot(error / flown)))
    }

    /// Whether the surrogate's CV is more than 5 % and more than two standard errors from that of the flown curves.
    pub fn surrogate_is_far(&self) -> bool {
        self.surrogate_over_flown()
            .is_some_and(|(apart, error)| apart.abs() > FAR && apart.abs() > CHANCE * error)
    }
}

impl Web {
    /// Longest distance from point to point along the flown curves of the layers [m]: over smaller patches
    /// the flight, which has straight pieces of this length, says little more than the surrogate. None if
    /// nothing was flown.
    pub fn longest_element(&self) -> Option<f64> {
        let fibres =
            self.layers.iter().flat_map(|layer| [Some(&layer.fibres), layer.other_description.as_ref()]);
        let elements = fibres.flatten().filter_map(|fibres| match fibres {
            Fibres::Curves(curves) => Some(curves.spacing()),
            Fibres::Surrogate(_) => None,
        });
        elements.reduce(f64::max)
    }
}
