//! Turns a picture into a map of basis weight and finds out how uneven it is.

use super::chance::scatter;
use super::doubt::{Doubt, FEWEST};
use super::findings::{Findings, PatchFindings, SHARP, Settings};
use super::foreign_parts::ForeignParts;
use super::levels::above_zero;
use super::note::notes;
use super::optics::{blurred, noise_at_most};
use super::picture::Picture;
use super::spots::Spots;
use super::weigh::{Correction, Light, WeighedPicture, beside, weigh};
use crate::error::{Fault, FileError};
use crate::units::{Dimension, shortest};
use crate::web::uniformity::Unevenness;
use crate::web::{Clouds, autocorrelation};

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
    above_zero("a titre [kg/m]", settings.titre)?;
    let correction = Correction { lamp: settings.lamp.as_ref(), keep_shading: settings.keep_shading };
    let is_cleaned = matches!(settings.light, Light::Transmitted { .. }) && !settings.keep_spots;
    let spots = if is_cleaned { beside(picture, settings.light, correction)? } else { Spots::none(picture) };
    let aside = ForeignParts::new(picture, settings.lamp.as_ref(), &spots);
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
        let found = if given.is_some() { plain.subtract_noise(noise) } else { Some(plain) };
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
    let notes = notes(picture, settings, &weighed, &patches, &aside);
    let (clouds, autocorrelation) = (Clouds::measure(map), autocorrelation(map, lags, 1));
    let WeighedPicture { map, mean_known, white, density, pixels, .. } = weighed;
    Ok(Findings {
        map,
        mean_known,
        white,
        density,
        shading,
        noise: settings.noise,
        titre: settings.titre,
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
