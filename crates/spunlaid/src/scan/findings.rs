//! Everything that is found out about a scanned web.

use super::note::{self, Note};
use super::optics::{blurred, noise_at_most};
use super::picture::Picture;
use super::weigh::{Correction, Light, Pixels, Weighed, above_zero, weigh};
use crate::error::{FileError, ScanFault};
use crate::statistics::NORMAL_95;
use crate::web::uniformity::{Unevenness, unevenness};
use crate::web::{Clouds, Map, autocorrelation};

/// How a picture is read.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// What its values mean.
    pub light: Light,
    /// A picture of the lamp without web, at the same exposure and of the same size: it takes the place of the level of the lamp and of
    /// the polynomial for its shading.
    pub lamp: Option<Picture>,
    /// Whether the lamp is taken as even. Maps of basis weight are never corrected.
    pub keep_shading: bool,
    /// Standard deviation of the noise of a single pixel, if it is known: its variance is taken out [levels].
    pub noise: Option<f64>,
    /// Sides of the patches; if empty, usual ones up to a fifth of the picture [m].
    pub patches: Vec<f64>,
}

impl Settings {
    /// What is usual.
    pub const fn of(light: Light) -> Self {
        Self { light, lamp: None, keep_shading: false, noise: None, patches: Vec::new() }
    }
}

/// A scanned web.
#[derive(Clone, Debug)]
pub struct Findings {
    /// The map of its basis weight.
    pub map: Map,
    /// Whether the mean of the map is that of the sheet; otherwise it is 1 kg/m².
    pub mean_known: bool,
    /// Grey level of the lamp without web; none for a map of basis weight, and where there is a picture of the lamp.
    pub white: Option<f64>,
    /// Mean optical density; none for a map of basis weight.
    pub density: Option<f64>,
    /// How much brighter the lamp is at its brightest than at its darkest place, as a share, if that was taken out.
    pub shading: Option<f64>,
    /// Pixels that needed care.
    pub pixels: Pixels,
    /// How uneven it is, patch by patch.
    pub patches: Vec<PatchFindings>,
    /// Sizes of the clouds.
    pub clouds: Option<Clouds>,
    /// Autocorrelation coefficients of the basis weight in cross and in machine direction, pixel by pixel from lag zero.
    pub autocorrelation: [Vec<f64>; 2],
    /// What a reader must know.
    pub notes: Vec<Note>,
}

/// The unevenness over patches of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchFindings {
    /// The unevenness, without the noise of the camera if that is known.
    pub unevenness: Unevenness,
    /// CV of the noise of the camera over such patches: as given and taken out, or at most.
    pub noise: f64,
    /// Share by which one more pixel of blur lowers the CV.
    pub blur: f64,
}

impl PatchFindings {
    /// The 95 % confidence interval of the CV; none if the picture is too small to say.
    pub fn interval(&self) -> Option<[f64; 2]> {
        let width = NORMAL_95 * self.unevenness.standard_error?;
        Some([(self.unevenness.cv - width).max(0.0), self.unevenness.cv + width])
    }

    /// Whether a blur of a pixel lowers the CV by less than one per cent.
    pub fn is_sharp(&self) -> bool {
        self.blur < SHARP
    }
}

/// Share of the CV that may be lost by one pixel of blur.
const SHARP: f64 = 0.01;
/// Usual sides of patches [m].
const USUAL: [f64; 9] = [0.5e-3, 1e-3, 2e-3, 5e-3, 10e-3, 20e-3, 50e-3, 100e-3, 200e-3];
/// A usual patch is at most this share of the picture.
const PARTS: usize = 5;
/// Longest lag of the autocorrelation [m], and most lags.
const LAG: f64 = 0.1;
const LAGS: usize = 513;

/// Turns a picture into a map of basis weight and says how uneven it is.
///
/// # Errors
/// If a setting is not above zero, a patch does not fit on the picture, or the picture is not that of a web.
pub fn analyse(picture: &Picture, settings: &Settings) -> Result<Findings, FileError> {
    found(picture, settings).map_err(|fault| FileError::from(fault).file(&picture.file))
}

fn found(picture: &Picture, settings: &Settings) -> Result<Findings, ScanFault> {
    above_zero("a noise", settings.noise)?;
    let sides = sides(picture, &settings.patches)?;
    let correction = Correction { lamp: settings.lamp.as_ref(), keep_shading: settings.keep_shading };
    let weighed = weigh(picture, settings.light, correction)?;
    let map = &weighed.map;
    let given = settings.noise.map(|noise| noise * weighed.per_noise);
    let noise = given.unwrap_or_else(|| noise_at_most(map));
    let blurred = blurred(map);
    let mut patches = Vec::new();
    for side in sides {
        let (Some(mut found), Some(behind)) = (unevenness(map, side), unevenness(&blurred, side)) else {
            continue;
        };
        let blur = 1.0 - behind.cv / found.cv;
        let noise = noise / side as f64;
        if given.is_some() {
            found = without(found, noise).ok_or(ScanFault::NoiseTooLarge {
                patch: found.patch,
                noise: settings.noise.unwrap_or(f64::NAN),
            })?;
        }
        patches.push(PatchFindings { unevenness: found, noise, blur });
    }
    let lags = ((LAG / map.cell).round() as usize + 1).min(LAGS);
    let shading = weighed.shading.as_ref().map(|shading| libm::expm1(shading.range()));
    let notes = note::notes(picture, settings, &weighed, &patches);
    let (clouds, autocorrelation) = (Clouds::of(map), autocorrelation(map, lags));
    let Weighed { map, mean_known, white, density, pixels, .. } = weighed;
    Ok(Findings { map, mean_known, white, density, shading, pixels, patches, clouds, autocorrelation, notes })
}

/// The unevenness without that of independent noise.
fn without(of: Unevenness, noise: f64) -> Option<Unevenness> {
    let cv = (of.cv * of.cv - noise * noise).sqrt();
    // The error of the variance stays as it is.
    let standard_error = of.standard_error.map(|error| error * of.cv / cv);
    (cv > 0.0).then_some(Unevenness { cv, standard_error, ..of })
}

/// Sides of the patches [pixels], each once, the smallest first.
fn sides(picture: &Picture, patches: &[f64]) -> Result<Vec<usize>, ScanFault> {
    let (pixel, shorter) = (picture.pixel, picture.columns.min(picture.rows));
    let side = |patch: f64| (patch / pixel).round();
    let mut sides = Vec::new();
    for patch in patches {
        if !(1.0..=shorter as f64).contains(&side(*patch)) {
            return Err(ScanFault::Patch { patch: *patch, pixel, side: picture.shorter() });
        }
        sides.push(side(*patch) as usize);
    }
    if patches.is_empty() {
        let fits = |side: &f64| (1.0..=(shorter / PARTS) as f64).contains(side);
        sides.extend(USUAL.into_iter().map(side).filter(fits).map(|side| side as usize));
    }
    if sides.is_empty() {
        sides.push(1);
    }
    sides.sort_unstable();
    sides.dedup();
    Ok(sides)
}
