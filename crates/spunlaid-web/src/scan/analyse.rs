//! Turns a picture into a map of basis weight and finds out how uneven it is.

use super::chance::scatter;
use super::findings::{Findings, PatchFindings, SHARP, Settings};
use super::frame::Frame;
use super::lamp::{grey_levels, lamp_doubt};
use super::levels::{above_zero, same_size};
use super::note::notes;
use super::optics::{blurred, noise_at_most};
use super::picture::Picture;
use super::spots::{ForeignParts, Spots};
use super::streaks::search;
use super::weigh::{Correction, Light, WeighedPicture, beside, weigh};
use super::{FEWEST, ScanWarning};
use crate::map::uniformity::PatchCv;
use crate::map::{Clouds, autocorrelation};
use spunlaid_ground::units::shortest;
use spunlaid_ground::{Dimension, Fault, FileError};

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
    let lamp = settings.lamp.as_ref();
    same_size(picture, lamp)?;
    let Frame { web, notes: mut all_notes, bare, is_even } = Frame::new(picture, lamp, settings)?;
    let beside_web = picture.values.len() - web.sides[0] * web.sides[1];
    let framed = |picture: &Picture| (beside_web > 0).then(|| picture.part(web));
    let (own, own_lamp) = (framed(picture), lamp.and_then(framed));
    let (picture, lamp) = (own.as_ref().unwrap_or(picture), own_lamp.as_ref().or(lamp));
    let correction = Correction { lamp, keep_shading: settings.keep_shading || is_even };
    let is_cleaned = matches!(settings.light, Light::Transmitted { .. }) && !settings.keep_spots;
    let spots = if is_cleaned { beside(picture, settings.light, correction)? } else { Spots::none(picture) };
    let mut aside = ForeignParts::new(web.corner, beside_web, picture, lamp, &spots);
    aside.bare = bare.or(aside.bare);
    let light = with_level_beside(settings.light, picture, lamp, aside.bare);
    // Only the part that is web, of the picture and of its lamp.
    let part = |picture: &Picture| if spots.bare.is_empty() { None } else { Some(picture.part(spots.web)) };
    let (own, own_lamp) = (part(picture), lamp.and_then(part));
    let (picture, lamp) = (own.as_ref().unwrap_or(picture), own_lamp.as_ref().or(lamp));
    let sides = sides(picture, &settings.patches)?;
    let weighed = weigh(picture, light, Correction { lamp, ..correction }, &spots.dark)?;
    let doubt = doubt(picture, lamp, settings);
    let assumption = doubt.as_ref().and_then(|(doubt, _)| *doubt).or_else(|| weighed.assumption(light));
    let patches = patches(&weighed, &spots.dark, &sides, settings, assumption)?;
    let map = &weighed.map;
    let lags = ((LAG / map.cell).round() as usize + 1).min(LAGS);
    let shading = weighed.shading.as_ref().map(|shading| libm::expm1(shading.range()));
    all_notes.extend(notes(picture, settings, light, is_even, &weighed, &patches, &aside));
    all_notes.extend(doubt.map(|(_, fault)| fault));
    let clouds = Clouds::measure(map);
    let autocorrelation = autocorrelation(map, lags, 1);
    let streaks = search(map, shading.is_some());
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
        assumption,
        aside,
        patches,
        clouds,
        autocorrelation,
        streaks,
        notes: all_notes,
    })
}

/// What the levels mean, with the level of the lamp that is seen beside the web, if no other is known.
fn with_level_beside(light: Light, picture: &Picture, lamp: Option<&Picture>, bare: Option<f64>) -> Light {
    /// A lamp that is brighter than this share of the largest level may be clipped.
    const CLIPPED: f64 = 0.99;
    let is_clipped = |level: &f64| picture.full_scale.is_some_and(|largest| *level > CLIPPED * largest);
    match (light, bare.filter(|level| !is_clipped(level))) {
        (Light::Transmitted { mean, white: None }, Some(level)) if lamp.is_none() => {
            Light::Transmitted { mean, white: Some(level) }
        }
        _ => light,
    }
}

/// Why the numbers of a picture cannot be believed, whatever the lamp was.
fn doubt(
    picture: &Picture,
    lamp: Option<&Picture>,
    settings: &Settings,
) -> Option<(Option<ScanWarning>, Fault)> {
    match settings.light {
        Light::Weight { mean } => {
            let fault = grey_levels(picture, mean, settings.light_is_assumed)?;
            Some((settings.light_is_assumed.then_some(ScanWarning::GreyLevels), fault))
        }
        _ => lamp_doubt(picture, lamp?).map(|(doubt, fault)| (Some(doubt), fault)),
    }
}

/// What is found over the patches of some sides [pixels].
fn patches(
    weighed: &WeighedPicture,
    masked: &[bool],
    sides: &[usize],
    settings: &Settings,
    assumption: Option<ScanWarning>,
) -> Result<Vec<PatchFindings>, Fault> {
    let map = &weighed.map;
    let given = settings.noise.map(|noise| noise * weighed.per_noise);
    let noise = given.unwrap_or_else(|| noise_at_most(map));
    // No camera has blurred a map of basis weight.
    let blurred = (!matches!(settings.light, Light::Weight { .. })).then(|| blurred(map));
    let mut patches = Vec::new();
    for side in sides.iter().copied() {
        let Some(plain) = scatter(map, masked, side) else { continue };
        let behind = match &blurred {
            Some(map) => match scatter(map, masked, side) {
                Some(behind) => Some(behind.cv()),
                None => continue,
            },
            None => None,
        };
        let blur = behind.map(|cv| 1.0 - cv / plain.cv());
        let noise = noise / side as f64;
        let found = if given.is_some() { plain.subtract_noise(noise) } else { Some(plain) };
        let patch = side as f64 * map.cell;
        let found = found.ok_or_else(|| all_noise(patch, settings.noise))?;
        let few = FEWEST * side > map.columns.min(map.rows);
        let (cv, [low, high]) = (found.cv(), found.interval());
        let doubt = assumption
            .or(blur.is_some_and(|blur| blur >= SHARP).then_some(ScanWarning::Blur))
            .or((few || !high.is_finite()).then_some(ScanWarning::Few));
        // Noise that is not taken out is at most in the CV, and what a pixel of blur takes away is missing.
        let low = if given.is_some() { low } else { (low * low - noise * noise).max(0.0).sqrt() };
        let interval = doubt.map_or(Ok([low, high * (1.0 + blur.unwrap_or(0.0).max(0.0))]), Err);
        let standard_error = doubt.is_none().then(|| found.standard_error());
        let patch_cv = PatchCv { patch, cv, standard_error };
        patches.push(PatchFindings { patch_cv, interval, noise, blur });
    }
    Ok(patches)
}

/// The fault of a noise that was given and is all that varies.
fn all_noise(patch: f64, noise: Option<f64>) -> Fault {
    Fault::new(
        format!(
            "varies less over patches of {} than the noise of the camera alone, {} as you gave it, would make it \
            vary",
            Dimension::Length.pretty(patch),
            shortest(noise.unwrap_or(f64::NAN))
        ),
        "give the noise of a single pixel, from two images of the same place",
    )
    .option("--noise")
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
                    "they can have sides from a pixel, {}, to the shorter side of the image, {}",
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
