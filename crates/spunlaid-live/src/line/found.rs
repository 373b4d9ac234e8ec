//! The numbers of a web as pages get them: its CV before, now, and the change from one to the other.

use super::known_web::KnownWeb;
use super::plan::Air;
use serde::Serialize;
use serde_json::{Value as Json, json};
use spunlaid::ground::Difference;
use spunlaid::web::map::uniformity::PatchCv;

/// Probability with which a look finds no change where there is none. Some looks in a row then find none in 95 %.
const SURE: f64 = 0.987;
/// Patches on which most eyes judge a web [m].
pub(super) const SEEN: f64 = 0.01;
/// Relative difference up to which two patches have one size.
const SAME: f64 = 1e-6;

/// A CV.
#[derive(Clone, Copy, Debug, Serialize, PartialEq)]
pub(super) struct Cv {
    pub(super) cv: f64,
    /// None where it is not known.
    pub(super) standard_error: Option<f64>,
    /// Whether it is that of `spunlaid web`.
    pub(super) is_complete: bool,
}

/// A change, as a share of the CV before.
#[derive(Clone, Copy, Debug, Serialize, PartialEq)]
struct CvChange {
    value: f64,
    standard_error: f64,
    /// Whether it is significant at a look.
    is_sure: bool,
}

impl CvChange {
    fn new(difference: &Difference) -> Self {
        let Difference { value, standard_error, .. } = *difference;
        Self { value, standard_error, is_sure: difference.is_beyond(SURE) }
    }

    /// What becomes of a CV.
    fn of(self, before: Cv) -> Cv {
        let cv = before.cv * (1.0 + self.value);
        let error = |error: f64| (error * (1.0 + self.value)).hypot(before.cv * self.standard_error);
        Cv { cv, standard_error: before.standard_error.map(error), is_complete: false }
    }
}

/// The CV of a web over patches of a side, as far as it is known without another one [m].
fn by_itself(web: &KnownWeb, side: f64) -> Option<Cv> {
    let is_it = |other: f64| (other / side - 1.0).abs() < SAME;
    if let Some(laid) = &web.laid {
        let PatchCv { cv, standard_error, .. } = laid.patches.iter().find(|patch| is_it(patch.side))?.cv?;
        return Some(Cv { cv, standard_error, is_complete: true });
    }
    let of = web.coarse.as_ref()?.cvs.iter().find(|of| is_it(of.patch))?;
    Some(Cv { cv: of.cv, standard_error: of.standard_error, is_complete: false })
}

/// The change of the CV over patches of a side from a web to another one in an air.
fn change(air: Air, before: &KnownWeb, now: &KnownWeb, side: f64) -> Option<CvChange> {
    let look = now.look_beside(air, before.number)?;
    let effect = look.changes.iter().find(|effect| (effect.of / side - 1.0).abs() < SAME)?;
    Some(CvChange::new(&effect.difference))
}

/// The CV of a web now: as it was laid, or the one before with the change.
fn present(before: &KnownWeb, now: &KnownWeb, side: f64) -> Option<Cv> {
    let laid = now.laid.as_ref().map(|_| by_itself(now, side));
    laid.unwrap_or_else(|| Some(change(Air::OfFile, before, now, side)?.of(by_itself(before, side)?)))
}

/// Sides of the patches of which something is known, in their order [m].
fn sides(webs: [&KnownWeb; 2]) -> Vec<f64> {
    let of_web = |web: &KnownWeb| {
        let laid = web.laid.iter().flat_map(|laid| laid.patches.iter().map(|patch| patch.side));
        let coarse = web.coarse.iter().flat_map(|look| look.cvs.iter().map(|cv| cv.patch));
        laid.chain(coarse).collect::<Vec<f64>>()
    };
    let mut all: Vec<f64> = webs.into_iter().flat_map(of_web).collect();
    all.sort_by(f64::total_cmp);
    all.dedup_by(|a, b| (*a / *b - 1.0).abs() < SAME);
    all
}

/// The message with the numbers.
pub(super) fn found(generation: u32, before: &KnownWeb, now: &KnownWeb) -> Json {
    let is_turned = before.number != now.number;
    let patch = |side: f64| {
        json!({
            "side_m": side,
            "before": by_itself(before, side),
            "now": is_turned.then(|| present(before, now, side)).flatten(),
            "change": is_turned.then(|| change(Air::OfFile, before, now, side)).flatten(),
            "confirmed": is_turned.then(|| change(Air::Other, before, now, side)).flatten(),
        })
    };
    let look = if is_turned { now.look_beside(Air::OfFile, before.number) } else { before.coarse.as_ref() };
    let (stage, area) = match (&now.laid, look) {
        (Some(laid), _) => ("complete", Some(laid.area)),
        (None, Some(look)) => (if is_turned { "sketch" } else { "before" }, Some(look.area)),
        (None, None) => ("before", before.laid.as_ref().map(|laid| laid.area)),
    };
    let patches: Vec<Json> = sides([before, now]).into_iter().map(patch).collect();
    json!({"is": "found", "generation": generation, "stage": stage, "area_m2": area, "patches": patches})
}

/// The side that is judged first [m].
fn judged(webs: [&KnownWeb; 2]) -> Option<f64> {
    let far = |side: &f64| (side / SEEN).ln().abs();
    sides(webs).into_iter().min_by(|a, b| far(a).total_cmp(&far(b)))
}

/// The CV of a web over the patches that are judged first: as it is, or by its comparison with another one.
pub(super) fn answer(before: &KnownWeb, web: &KnownWeb) -> Option<Cv> {
    let side = judged([before, web])?;
    let by_itself = by_itself(web, side).filter(|cv| cv.is_complete || web.number == before.number);
    by_itself.or_else(|| present(before, web, side))
}
