//! The load of filaments on their air: `curtain` in the summaries of webs and runs.

use super::in_order::OrderedObject;
use super::measured::{json, values};
use super::spinline::SpinResults;
use serde::{Serialize, Serializer};
use spunlaid::case::Case;
use spunlaid::load::{Load, WayPlace};
use spunlaid::observe::{OF_LOAD_PLACES, OF_LOADS};

/// A load in a summary: its measures, and those of each place where filaments were flown.
#[derive(Clone, Debug)]
pub struct LoadSummary(pub Load);

impl LoadSummary {
    /// The load of the filaments of a case; None for a fibre of fixed length.
    ///
    /// * `slot` – size in machine direction of the slot of the air [m], if it is known
    /// * `way` – of a flown filament; empty if none was flown
    pub fn new(case: &Case, filaments_per_metre: f64, slot: Option<f64>, way: &[WayPlace]) -> Option<Self> {
        let spun = SpinResults::from_case(case);
        let first = spun.as_ref().and_then(|spun| spun.rows.first());
        Load::new(case, filaments_per_metre, slot, way, first).map(Self)
    }

    /// The load of the filaments of a case whose spinline has a curtain of them; None of any other.
    pub fn of_spinline(case: &Case, way: &[WayPlace]) -> Option<Self> {
        let curtain = case.spinline.as_ref()?.curtain?;
        Self::new(case, curtain.rows as f64 * curtain.filaments_per_metre, None, way)
    }
}

impl Serialize for LoadSummary {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(load) = self;
        let known = values(OF_LOADS, load).0.into_iter();
        let mut entries: Vec<_> = known.map(|(name, value)| (name, json(value))).collect();
        if !load.places.is_empty() {
            let places = load.places.iter().map(|place| json(values(OF_LOAD_PLACES, place)));
            entries.push(("places".to_owned(), places.collect()));
        }
        OrderedObject(entries).serialize(serializer)
    }
}
