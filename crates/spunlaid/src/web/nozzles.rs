//! Where the filaments of a layer come from.

use super::{Filaments, Row, Sheet};
use crate::random::{stream, uniform};
use crate::sort::sort_by_key;

/// Last word of the keys of the places of filaments, and of the depths in a slot.
pub(super) const PLACES: u64 = 4;
const DEPTHS: u64 = 6;

/// Where the inlets of the filaments of a layer are in cross and in machine direction, in order across the web [m].
///
/// * `seed` – of the web
/// * `number` – of the layer
pub(crate) fn inlets(sheet: &Sheet, seed: u64, number: usize, filaments: &Filaments) -> Vec<[f64; 2]> {
    sorted_nozzles(sheet, seed, number, filaments).into_iter().map(|nozzle| nozzle.at).collect()
}

/// Where a filament comes from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nozzle {
    /// Its place in cross and in machine direction [m].
    pub(super) at: [f64; 2],
    /// The number of its row, from 1.
    pub(super) row: u64,
}

/// The nozzles of a layer, in order across the web. See [`inlets`].
pub(super) fn sorted_nozzles(sheet: &Sheet, seed: u64, number: usize, filaments: &Filaments) -> Vec<Nozzle> {
    let random = |kind| stream([seed, (number as u64) << 48 | 1 << 47, 0, kind]);
    let count = filaments.count(sheet);
    let single = |at: [f64; 2]| Nozzle { at, row: 1 };
    let mut nozzles: Vec<Nozzle> = match filaments {
        Filaments::AtRandom { .. } => {
            let mut random = random(PLACES);
            (0..count).map(|_| single([uniform(&mut random) * sheet.width, 0.0])).collect()
        }
        Filaments::Slot { depth, .. } => {
            let (mut random, pitch) = (random(DEPTHS), sheet.width / count as f64);
            let inlet = |i| [(i as f64 + 0.5) * pitch, (uniform(&mut random) - 0.5) * depth];
            (0..count).map(inlet).map(single).collect()
        }
        Filaments::Rows(rows) => {
            let of_row = |(row, of): (u64, &Row)| {
                let of = *of;
                (0..of.filaments).map(move |i| Nozzle { at: [of.offset + of.pitch * i as f64, of.md], row })
            };
            (1..).zip(rows).flat_map(of_row).collect()
        }
    };
    sort_by_key(&mut nozzles, |nozzle| nozzle.at[0]);
    nozzles
}
