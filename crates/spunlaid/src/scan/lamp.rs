//! Whether the picture of the lamp can be believed.

use super::doubt::Doubt;
use super::levels::per_cent;
use super::picture::Picture;
use crate::error::Fault;
use crate::statistics::quantile;
use crate::units::shortest;

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
pub(super) fn lamp_doubt(picture: &Picture, lamp: &Picture) -> Option<(Doubt, Fault)> {
    if let Some((level, share)) = clipped(lamp) {
        let message = format!(
            "the picture of the lamp is clipped: {} of its pixels have its largest level, {}, where the lamp \
            may be brighter, so every CV may be wrong, and no interval is given",
            per_cent(share),
            shortest(level)
        );
        let remedy = "choose so short an exposure that no pixel of the lamp has the largest level, and take \
            both pictures with it";
        return Some((Doubt::ClippedLamp, Fault::new(message, remedy)));
    }
    let scale = STRONGER * lamp.scale_to(picture);
    let pairs =
        || picture.values.iter().zip(&lamp.values).filter(|(level, lamp)| (**level - **lamp).is_finite());
    let stronger = pairs().filter(|(level, lamp)| **level > scale * **lamp).count();
    let share = stronger as f64 / pairs().count() as f64;
    (share > MANY).then(|| {
        let message = format!(
            "{} of the pixels let through more light than the lamp gives, so its picture does not belong to this \
            one, and no interval is given",
            per_cent(share)
        );
        let remedy = "take both pictures at the same exposure, from the same place, with the same lamp";
        (Doubt::DarkLamp, Fault::new(message, remedy))
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
