//! The numbers by which two webs are compared: CV over patches, and the spectrum if it counts.

use spunlaid_ground::threads::par_map;
use spunlaid_web::map::uniformity::cv_of_piece;
use spunlaid_web::scan::flattened;
use spunlaid_web::{Clouds, Map};

/// A number by which two webs are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Texture {
    /// CV over square patches of this side [m].
    Patch(f64),
    /// Relative variance of waves in a band, by their wavelength in cross (0) or in machine direction (1).
    Band {
        /// 0 across, 1 along.
        direction: usize,
        /// Shortest and longest wave [m].
        waves: [f64; 2],
    },
}

/// What is measured of every map.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Textures {
    pub(super) all: Vec<Texture>,
    /// Whether a polynomial of second order is taken out of each map, as it was taken out of the scan with
    /// the shading of its lamp.
    pub(super) flat: bool,
}

impl Textures {
    /// The logarithms of the numbers of a map; not finite where there is none.
    pub(super) fn logarithms(&self, map: &Map, threads: usize) -> Vec<f64> {
        let flat = self.flat.then(|| flattened(map));
        let map = flat.as_ref().unwrap_or(map);
        let has_bands = self.all.iter().any(|texture| matches!(texture, Texture::Band { .. }));
        let clouds = if has_bands { Clouds::measure(map) } else { None };
        let spectra = clouds.map(|clouds| [0, 1].map(|direction| clouds.spectrum(direction)));
        par_map(threads, self.all.len(), |i| {
            libm::log(match self.all[i] {
                Texture::Patch(side) => {
                    let side = (side / map.cell).round() as usize;
                    cv_of_piece(map, side).unwrap_or(f64::NAN)
                }
                Texture::Band { direction, waves } => {
                    spectra.as_ref().map_or(f64::NAN, |spectra| variance(&spectra[direction], waves))
                }
            })
        })
    }
}

/// The variance of waves from one length to another.
///
/// * `spectrum` – wavelength and density, from long waves to short
fn variance(spectrum: &[(f64, f64)], [shortest, longest]: [f64; 2]) -> f64 {
    // The density is that of a wave number, and the wave numbers are those of a tile, as long as the longest wave.
    let step = spectrum.first().map_or(f64::NAN, |(wave, _)| 1.0 / wave);
    let within = spectrum.iter().filter(|(wave, _)| (shortest..longest * (1.0 - 1e-9)).contains(wave));
    within.map(|(_, density)| density * step).sum()
}

/// Octaves of the spectrum, from the shortest wave that is known to the longest, which has a few waves of a tile.
///
/// * `shortest` – wave [m]
pub(super) fn bands(map: &Map, shortest: f64) -> Vec<Texture> {
    /// Fewest waves of a tile in the longest one that is reported of.
    const FEWEST: f64 = 2.0;
    let Some(clouds) = Clouds::measure(map) else { return Vec::new() };
    let tile = clouds.spectrum(0).first().map_or(0.0, |(wave, _)| *wave);
    let mut bands = Vec::new();
    let mut from = shortest.max(clouds.shortest());
    while 2.0 * from <= tile / FEWEST * 1.0001 {
        bands.extend([0, 1].map(|direction| Texture::Band { direction, waves: [from, 2.0 * from] }));
        from *= 2.0;
    }
    bands
}
