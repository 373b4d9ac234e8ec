//! Whether the picture of the lamp can be believed.

use super::ScanWarning;
use super::levels::per_cent;
use super::picture::Picture;
use spunlaid_ground::Fault;
use spunlaid_ground::statistics::quantile;
use spunlaid_ground::units::shortest;

/// A larger share of clipped pixels changes the CV.
const CLIPPED: f64 = 1e-3;
/// The largest levels that cameras and programs write: of 8 to 16 bits, plain or raised to 16.
const LARGEST: [f64; 9] = [1.0, 255.0, 1023.0, 4095.0, 16_383.0, 65_472.0, 65_520.0, 65_532.0, 65_535.0];
/// A lamp that is clipped at another level has at least this share of its pixels there, and so many times more
/// of them than at the next level, though the darkest hundredth lies more than so many levels below.
const HEAP: f64 = 0.02;
const TIMES: usize = 10;
const SPREAD: f64 = 5.0;
/// Light that is stronger than the lamp by this factor, on this share of the pixels, is no noise.
const STRONGER: f64 = 1.05;
const MANY: f64 = 0.01;

/// Why a picture of the lamp cannot be believed, and what to do about it.
pub(super) fn lamp_doubt(picture: &Picture, lamp: &Picture) -> Option<(ScanWarning, Fault)> {
    if let Some((level, share)) = clipped(lamp) {
        let message = format!(
            "the image of the lamp is clipped: {} of its pixels have its largest level, {}, where the \
            lamp may be brighter, so every CV may be wrong, and no interval is given",
            per_cent(share),
            shortest(level)
        );
        let remedy = "choose so short an exposure that no pixel of the lamp has the largest level, and \
            take both images with it";
        return Some((ScanWarning::ClippedLamp, Fault::new(message, remedy)));
    }
    let scale = STRONGER * lamp.scale_to(picture);
    let pairs =
        || picture.values.iter().zip(&lamp.values).filter(|(level, lamp)| (**level - **lamp).is_finite());
    let stronger = pairs().filter(|(level, lamp)| **level > scale * **lamp).count();
    let share = stronger as f64 / pairs().count() as f64;
    (share > MANY).then(|| {
        let message = format!(
            "{} of the pixels let through more light than the lamp gives, so its image does not belong to \
            this one, and no interval is given",
            per_cent(share)
        );
        let remedy = "take both images at the same exposure, from the same place, with the same lamp";
        (ScanWarning::DarkLamp, Fault::new(message, remedy))
    })
}

/// The largest level and the share of pixels that have it, if they are too many to be by chance.
fn clipped(lamp: &Picture) -> Option<(f64, f64)> {
    let levels: Vec<f64> = lamp.values.iter().copied().filter(|level| level.is_finite()).collect();
    let largest = levels.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let count = |wanted: f64| levels.iter().filter(|level| **level == wanted).count();
    let share = |pixels: usize| pixels as f64 / levels.len() as f64;
    // Of colours, one channel may be clipped, and the luminance lie below the largest level.
    let of_channel = lamp.full_scale.filter(|_| share(lamp.clipped) > CLIPPED);
    if let Some(full) = of_channel {
        return Some((full, share(lamp.clipped)));
    }
    let at_largest = count(largest);
    if lamp.full_scale == Some(largest) || LARGEST.contains(&largest) {
        return (share(at_largest) > CLIPPED).then(|| (largest, share(at_largest)));
    }
    let next = levels.iter().copied().filter(|level| *level < largest).fold(f64::NEG_INFINITY, f64::max);
    let is_heap = share(at_largest) > HEAP && at_largest > TIMES * count(next);
    let is_uneven = largest - quantile(&levels, 0.01) > SPREAD * (largest - next);
    (is_heap && is_uneven).then(|| (largest, share(at_largest)))
}

/// Largest levels of pictures, and how the numbers of a file may be related to them: whole, or parts of one.
const LEVELS: [(f64, f64); 4] =
    [(255.0, 1.0), (65_535.0, 1.0), (255.0, 1.0 / 255.0), (65_535.0, 1.0 / 65_535.0)];
/// A number is a level if it is so near to it [levels].
const NEAR: f64 = 0.01;
/// Fewest different levels of a picture.
const FEWEST: usize = 16;
/// Units in which weights are whole numbers, in kg/m²: grams, tenths of them and so on.
const UNITS: [f64; 4] = [1e-3, 1e-4, 1e-5, 1e-6];
/// The mean of a map lies so near to that of its sheet.
const SAME: f64 = 0.1;

/// The doubt that a map holds grey levels: all numbers are levels of 8 or 16 bits, and their mean is not that
/// of the sheet in a usual unit.
///
/// * `mean` – of the sheet, if it is known [kg/m²]
/// * `is_assumed` – whether nobody has said that they are weights
pub(super) fn grey_levels(picture: &Picture, mean: Option<f64>, is_assumed: bool) -> Option<Fault> {
    if picture.weight_of_black.is_some() {
        return None;
    }
    let values = || picture.values.iter().copied().filter(|value| value.is_finite());
    let largest = values().fold(0.0, f64::max);
    let is_level =
        |step: f64, value: f64| value >= 0.0 && (value / step - (value / step).round()).abs() < NEAR;
    let fits =
        |(full, step): &(f64, f64)| largest <= full * step && values().all(|value| is_level(*step, value));
    let (full, step) = LEVELS.into_iter().find(fits)?;
    let mut seen: Vec<u32> = values().map(|value| (value / step).round() as u32).collect();
    seen.sort_unstable();
    seen.dedup();
    let found = values().sum::<f64>() / values().count() as f64;
    let is_same = |unit: &f64| mean.is_some_and(|mean| (found * unit / mean - 1.0).abs() < SAME);
    if seen.len() < FEWEST || UNITS.iter().any(is_same) {
        return None;
    }
    let bits = if full == 255.0 { 8 } else { 16 };
    let message = format!(
        "all numbers are levels of {bits} bits, up to {}, as those of an image; {}",
        shortest(largest),
        if is_assumed {
            "if they are grey levels and not basis weights, every CV is wrong, so no interval is given"
        } else {
            "they are taken as basis weights, as you said"
        }
    );
    let remedy = if is_assumed { "say what they are (--light transmitted or --light weight)" } else { "" };
    Some(Fault::new(message, remedy))
}
