//! The load of filaments on their air: `curtain` in the summaries of webs and runs.

use super::measured::values;
use super::spinline::SpinResults;
use serde_json::Value as Json;
use spunlaid::fibre::{Case, Load, OF_LOAD_PLACES, OF_LOADS, WayPlace};

/// The load of the filaments of a case; None for a fibre of fixed length.
///
/// * `slot` – size in machine direction of the slot of the air [m], if it is known
/// * `way` – of a flown filament; empty if none was flown
pub fn load_of(case: &Case, filaments_per_metre: f64, slot: Option<f64>, way: &[WayPlace]) -> Option<Load> {
    let spun = SpinResults::from_case(case);
    let first = spun.as_ref().and_then(|spun| spun.rows.first());
    Load::new(case, filaments_per_metre, slot, way, first)
}

/// The load of the filaments of a case whose spinline has a curtain of them; None of any other.
pub fn load_of_spinline(case: &Case, way: &[WayPlace]) -> Option<Load> {
    let curtain = case.spinline.as_ref()?.curtain?;
    load_of(case, curtain.rows as f64 * curtain.filaments_per_metre, None, way)
}

/// Its measures, and those of each place where filaments were flown.
pub fn summary(load: &Load) -> Json {
    let mut told = values(OF_LOADS, load);
    if !load.places.is_empty() {
        told["places"] = load.places.iter().map(|place| values(OF_LOAD_PLACES, place)).collect();
    }
    told
}
