//! Places of the sheet that are worth a look: the thinnest ones, strips with their weakest section.

use super::Marked;
use super::patches::{lightest, weights};
use super::strips::{StripPlace, StripSize, places as strip_places};
use crate::map::Map;

/// Side of the patches that are marked [m], and the share of the mean below which they are thin.
const PATCH: f64 = 5e-3;
const THIN: f64 = 0.8;
/// Most patches and strips that are marked, and the thinnest places that are reported.
const MOST: usize = 4000;
const THINNEST: usize = 6;

/// Places that are worth a look; all of them on the whole sheet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Marks {
    /// Side of the patches [m].
    pub patch: f64,
    /// Patches of the lattice that are lighter than 80 % of the mean, the lightest first, as many as can be shown.
    pub thin: Vec<Marked>,
    /// Number of all of them.
    pub thin_of_all: usize,
    /// The lightest patches at any place of the lattice of cells that do not touch each other, the lightest first.
    pub thinnest: Vec<Marked>,
    /// The strips along MD and those along CD.
    pub strips: [Vec<StripPlace>; 2],
}

impl Marks {
    /// * `corner` – where the map begins across the sheet [m]
    pub(super) fn new(map: &Map, corner: f64, size: StripSize) -> Self {
        let side = ((PATCH / map.cell).round().max(1.0) as usize).min(map.columns.min(map.rows));
        let patch = side as f64 * map.cell;
        let mut thin = thin_patches(map, corner, side);
        let thin_of_all = thin.len();
        thin.sort_by(|a, b| a.weight.total_cmp(&b.weight));
        thin.truncate(MOST);
        let thinnest = lightest(map, side, THINNEST).into_iter().map(|(at, weight)| {
            let at = at.map(|cells| cells as f64 * map.cell);
            Marked { corner: [corner + at[0], at[1]], sides: [patch; 2], weight }
        });
        let thinnest = thinnest.collect();
        let mut strips = strip_places(map, size);
        for place in strips.iter_mut().flatten() {
            place.corner[0] += corner;
            place.weakest.corner[0] += corner;
        }
        strips.iter_mut().for_each(|strips| strips.truncate(MOST));
        Self { patch, thin, thin_of_all, thinnest, strips }
    }
}

/// Those of the patches of the map side by side that are thin.
fn thin_patches(map: &Map, corner: f64, side: usize) -> Vec<Marked> {
    let size = side as f64 * map.cell;
    let ([columns, _], weights) = weights(map, size);
    let thin = weights.into_iter().enumerate().filter(|(_, weight)| *weight < THIN);
    thin.map(|(number, weight)| {
        let at = [number % columns, number / columns].map(|place| place as f64 * size);
        Marked { corner: [corner + at[0], at[1]], sides: [size; 2], weight }
    })
    .collect()
}
