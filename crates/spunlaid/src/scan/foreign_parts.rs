//! The part of a picture that is not web.

use super::picture::Picture;
use super::spots::{Spots, region};
use crate::sort::sort_by_key;
use crate::statistics::median;
use std::cmp::Reverse;

/// The parts of a picture that are not web.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ForeignParts {
    /// Area beside the rectangle that was cut out: the bare lamp, a bare strip, or pixels without a value [m²].
    pub cut_off: f64,
    /// First column and row of the rectangle in the picture [pixels].
    pub corner: [usize; 2],
    /// Median grey level of the bare lamp, over its picture if there is one; none if it is not seen.
    pub bare: Option<f64>,
    /// Dark spots on the web, the largest first. They count for no patch, and are filled in along their row in the map.
    pub spots: Vec<Spot>,
    /// Their area [m²].
    pub masked: f64,
    /// Their pixels, row by row of the web; empty without any.
    pub mask: Vec<bool>,
}

/// A dark spot on the web.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Area [m²].
    pub area: f64,
    /// Its middle, from the left and the upper edge of the web, which begins at [`ForeignParts::corner`] [m].
    pub place: [f64; 2],
}

impl ForeignParts {
    /// * `corner` – of the picture in its file
    /// * `beside` – pixels of the file beside it
    pub(super) fn new(
        (corner, beside): ([usize; 2], usize),
        picture: &Picture,
        lamp: Option<&Picture>,
        found: &Spots,
    ) -> Self {
        let (pixel, area) = (picture.pixel, picture.pixel * picture.pixel);
        let ([left, top], [columns, rows]) = (found.web.corner, found.web.sides);
        let masked = &found.dark;
        let lamp_level = |at: usize| lamp.map_or(1.0, |lamp| lamp.scale_to(picture) * lamp.values[at]);
        let level = |at: usize| picture.values[at] / lamp_level(at);
        let bare = (0..found.bare.len()).filter(|at| found.bare[*at]).map(level);
        let mut visited = vec![false; masked.len()];
        let mut spots = Vec::new();
        for first in 0..masked.len() {
            if masked[first] && !visited[first] {
                let region = region(&mut visited, found.web.sides, first, |at| masked[at]);
                let count = region.len() as f64;
                let mean = |place: &dyn Fn(usize) -> usize| {
                    (region.iter().map(|at| place(*at) as f64).sum::<f64>() / count + 0.5) * pixel
                };
                let place = [mean(&|at| at % columns), mean(&|at| at / columns)];
                spots.push(Spot { area: count * area, place });
            }
        }
        sort_by_key(&mut spots, |spot| Reverse(spot.area));
        let pixels = masked.iter().filter(|is| **is).count();
        Self {
            cut_off: (beside + picture.values.len() - columns * rows) as f64 * area,
            corner: [corner[0] + left, corner[1] + top],
            bare: (!found.bare.is_empty()).then(|| median(&bare.collect::<Vec<_>>())),
            spots,
            masked: pixels as f64 * area,
            mask: masked.clone(),
        }
    }
}
