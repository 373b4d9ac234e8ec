//! Everything that is found out about a scanned web.

use super::chance::scatter;
use super::note;
use super::optics::{blurred, noise_at_most};
use super::picture::Picture;
use super::spots::{Spots, region};
use super::weigh::{Correction, Light, Pixels, Weighed, above_zero, beside, weigh};
use crate::error::{Fault, FileError};
use crate::statistics::median;
use crate::units::{Dimension, shortest};
use crate::web::uniformity::Unevenness;
use crate::web::{Clouds, Map, autocorrelation};
use std::fmt;

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
    /// Whether all of a picture in transmitted light is web. Otherwise the bare lamp beside it, dust and blots are left out.
    pub keep_spots: bool,
    /// Standard deviation of the noise of a single pixel, if it is known: its variance is taken out [levels].
    pub noise: Option<f64>,
    /// Sides of the patches; if empty, usual ones up to a fifth of the picture [m].
    pub patches: Vec<f64>,
}

impl Settings {
    /// What is usual.
    pub const fn new(light: Light) -> Self {
        Self { light, lamp: None, keep_shading: false, keep_spots: false, noise: None, patches: Vec::new() }
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
    /// What of the lamp is a guess, if anything: then nothing that depends on it has an interval.
    pub guess: Option<Doubt>,
    /// What of the picture is no web and was left out.
    pub aside: Aside,
    /// How uneven it is, patch by patch.
    pub patches: Vec<PatchFindings>,
    /// Sizes of the clouds.
    pub clouds: Option<Clouds>,
    /// Autocorrelation coefficients of the basis weight in cross and in machine direction, pixel by pixel from lag zero.
    pub autocorrelation: [Vec<f64>; 2],
    /// What was assumed, corrected or left out, and what to do about it.
    pub notes: Vec<Fault>,
}

/// The unevenness over patches of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchFindings {
    /// The unevenness, without the noise of the camera if that is known. It has no standard error where [`interval`](Self::interval) has none.
    pub unevenness: Unevenness,
    /// The 95 % confidence interval of the CV of the web, of which this is a piece, or why none can be told.
    pub interval: Result<[f64; 2], Doubt>,
    /// CV of the noise of the camera over such patches: as given and taken out, or at most.
    pub noise: f64,
    /// Share by which one more pixel of blur lowers the CV.
    pub blur: f64,
}

/// What of a picture is no web.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Aside {
    /// Area beside the rectangle that was cut out, because the bare lamp is seen there [m²].
    pub cut_off: f64,
    /// First column and row of the rectangle [pixels].
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
    /// Its middle, from the left and the upper edge of the picture [m].
    pub place: [f64; 2],
}

impl Aside {
    fn new(picture: &Picture, lamp: Option<&Picture>, found: &Spots) -> Self {
        let (pixel, area) = (picture.pixel, picture.pixel * picture.pixel);
        let ([left, top], [columns, rows]) = (found.web.corner, found.web.sides);
        let masked = &found.dark;
        let level = |at: usize| picture.values[at] / lamp.map_or(1.0, |lamp| lamp.values[at]);
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
                let place = [mean(&|at| left + at % columns), mean(&|at| top + at / columns)];
                spots.push(Spot { area: count * area, place });
            }
        }
        spots.sort_by(|a, b| b.area.total_cmp(&a.area));
        let pixels = masked.iter().filter(|is| **is).count();
        Self {
            cut_off: (picture.values.len() - columns * rows) as f64 * area,
            corner: found.web.corner,
            bare: (!found.bare.is_empty()).then(|| median(&bare.collect::<Vec<_>>())),
            spots,
            masked: pixels as f64 * area,
            mask: masked.clone(),
        }
    }
}

impl PatchFindings {
    /// Whether a blur of a pixel lowers the CV by less than one per cent.
    pub fn is_sharp(&self) -> bool {
        self.blur < SHARP
    }
}

/// Why the true CV over patches of a size cannot be told from a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Doubt {
    /// The level of the lamp without web is a guess: all CVs may be wrong by the same factor.
    White,
    /// The shading of the lamp is a guess: a polynomial took it out, with what the web varies as smoothly.
    Shading,
    /// The blur of the camera has lowered the CV.
    Blur,
    /// The sheet holds too few such patches.
    Few,
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::White => "the level of the lamp is a guess",
            Self::Shading => "the shading of the lamp is a guess",
            Self::Blur => "below the blur of the scan",
            Self::Few => "the sheet holds too few such patches",
        })
    }
}

/// Share of the CV that may be lost by one pixel of blur.
const SHARP: f64 = 0.01;
/// A sheet that is less than so many patches wide or long tells nothing about the web.
const FEWEST: usize = 4;
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

fn found(picture: &Picture, settings: &Settings) -> Result<Findings, Fault> {
    above_zero("a noise", settings.noise)?;
    let correction = Correction { lamp: settings.lamp.as_ref(), keep_shading: settings.keep_shading };
    let is_cleaned = matches!(settings.light, Light::Transmitted { .. }) && !settings.keep_spots;
    let spots = if is_cleaned { beside(picture, settings.light, correction)? } else { Spots::none(picture) };
    let aside = Aside::new(picture, settings.lamp.as_ref(), &spots);
    // Only the part that is web, of the picture and of its lamp.
    let part = |picture: &Picture| if spots.bare.is_empty() { None } else { Some(picture.part(spots.web)) };
    let (own, lamp) = (part(picture), settings.lamp.as_ref().and_then(part));
    let picture = own.as_ref().unwrap_or(picture);
    let correction = Correction { lamp: lamp.as_ref().or(settings.lamp.as_ref()), ..correction };
    let masked: &[bool] = &spots.dark;
    let sides = sides(picture, &settings.patches)?;
    let weighed = weigh(picture, settings.light, correction, masked)?;
    let map = &weighed.map;
    let given = settings.noise.map(|noise| noise * weighed.per_noise);
    let noise = given.unwrap_or_else(|| noise_at_most(map));
    let blurred = blurred(map);
    let mut patches = Vec::new();
    let guess = weighed.guess(settings.light);
    for side in sides {
        let (Some(plain), Some(behind)) = (scatter(map, masked, side), scatter(&blurred, masked, side))
        else {
            continue;
        };
        let blur = 1.0 - behind.cv() / plain.cv();
        let noise = noise / side as f64;
        let found = if given.is_some() { plain.without(noise) } else { Some(plain) };
        let patch = side as f64 * map.cell;
        let found = found.ok_or(
            Fault::new(
                format!(
                    "varies less over patches of {} than the noise of the camera alone, {} as you gave it, would \
                     make it vary",
                    Dimension::Length.pretty(patch),
                    shortest(settings.noise.unwrap_or(f64::NAN))
                ),
                "give the noise of a single pixel, from two pictures of the same place",
            )
            .option("--noise"),
        )?;
        let few = FEWEST * side > map.columns.min(map.rows);
        let (cv, [low, high]) = (found.cv(), found.interval());
        let doubt = guess
            .or((blur >= SHARP).then_some(Doubt::Blur))
            .or((few || !high.is_finite()).then_some(Doubt::Few));
        // Noise that is not taken out is at most in the CV, and what a pixel of blur takes away is missing.
        let low = if given.is_some() { low } else { (low * low - noise * noise).max(0.0).sqrt() };
        let interval = doubt.map_or(Ok([low, high * (1.0 + blur.max(0.0))]), Err);
        let standard_error = doubt.is_none().then(|| found.standard_error());
        let unevenness = Unevenness { patch, cv, standard_error };
        patches.push(PatchFindings { unevenness, interval, noise, blur });
    }
    let lags = ((LAG / map.cell).round() as usize + 1).min(LAGS);
    let shading = weighed.shading.as_ref().map(|shading| libm::expm1(shading.range()));
    let notes = note::notes(picture, settings, &weighed, &patches, &aside);
    let (clouds, autocorrelation) = (Clouds::of(map), autocorrelation(map, lags));
    let Weighed { map, mean_known, white, density, pixels, .. } = weighed;
    Ok(Findings {
        map,
        mean_known,
        white,
        density,
        shading,
        pixels,
        guess,
        aside,
        patches,
        clouds,
        autocorrelation,
        notes,
    })
}

/// Sides of the patches [pixels], each once, the smallest first.
fn sides(picture: &Picture, patches: &[f64]) -> Result<Vec<usize>, Fault> {
    let (pixel, shorter) = (picture.pixel, picture.columns.min(picture.rows));
    let side = |patch: f64| (patch / pixel).round();
    let mut sides = Vec::new();
    for patch in patches {
        if !(1.0..=shorter as f64).contains(&side(*patch)) {
            return Err(Fault::new(
                format!("has no patches of {}", Dimension::Length.pretty(*patch)),
                format!(
                    "they can have sides from a pixel, {}, to the shorter side of the picture, {}",
                    Dimension::Length.pretty(pixel),
                    Dimension::Length.pretty(picture.shorter())
                ),
            )
            .option("--patches"));
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
