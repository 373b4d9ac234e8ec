//! Where filaments stand beside each other across the flow.

use std::collections::BTreeMap;

/// The inlet of a fibre: where its root is, across the flow. The fibre's own coordinates begin there; the air is looked
/// up at the sum of the two. The mean flow is the same for all `z`, the turbulence is not.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Inlet {
    /// Distance from the middle of the slot along the machine direction [m].
    pub y: f64,
    /// Distance from the first fibre along the cross direction [m].
    pub z: f64,
}

/// The filaments of each row across, at equal places in machine direction. Those in a slot, at places of
/// their own, count as one.
pub fn rows(places: &[Inlet]) -> Vec<Vec<usize>> {
    let mut rows: BTreeMap<u64, Vec<usize>> = BTreeMap::new();
    for (filament, place) in places.iter().enumerate() {
        rows.entry(place.y.to_bits()).or_default().push(filament);
    }
    match rows.values().any(|row| row.len() == 1) {
        true => vec![(0..places.len()).collect()],
        false => rows.into_values().collect(),
    }
}
