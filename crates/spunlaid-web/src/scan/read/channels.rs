//! The channels of a pixel: shades of grey or colours, and how opaque it is.

/// What the channel behind the colours is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Extra {
    /// How opaque the pixel is; its colours are as they are.
    Opacity,
    /// How opaque the pixel is; its colours have been multiplied by that.
    Multiplied,
    /// The file does not say. It is taken as opacity if it is a mask.
    Unknown,
}

/// What the channels of a picture make of its pixels.
#[derive(Debug, Default)]
pub(super) struct Pixels {
    /// Luminance; NaN of a pixel that is not opaque.
    pub(super) values: Vec<f64>,
    /// Pixels that are not opaque.
    pub(super) transparent: usize,
    /// Pixels of which a channel has the largest level.
    pub(super) clipped: usize,
}

/// A pixel with less of the largest opacity in the picture is not opaque.
const OPAQUE: f64 = 0.99;
/// Shares of red, green and blue in the luminance.
///
/// Source: Recommendation ITU-R BT.709, 3.2.
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// The pixels of some channels: one or two begin with a shade of grey, three or four with colours.
///
/// * `extra` – what the last of two or four channels is
/// * `full` – the largest level, if there is one
pub(super) fn pixels(
    levels: impl Iterator<Item = f64>,
    channels: usize,
    extra: Extra,
    full: Option<f64>,
) -> Pixels {
    let weights: &[f64] = if channels < 3 { &[1.0] } else { &LUMINANCE };
    let (mut found, mut opacities) = (Pixels::default(), Vec::new());
    let (mut sum, mut is_clipped) = (0.0, false);
    for (level, channel) in levels.zip((0..channels).cycle()) {
        match weights.get(channel) {
            Some(weight) => {
                sum += weight * level;
                is_clipped |= full == Some(level);
            }
            None => opacities.push(level),
        }
        if channel + 1 == channels {
            found.values.push(sum);
            found.clipped += usize::from(is_clipped);
            (sum, is_clipped) = (0.0, false);
        }
    }
    let most = opacities.iter().copied().fold(0.0, f64::max);
    if extra != Extra::Unknown || is_mask(&opacities, most) {
        let is_opaque = |opacity: f64| most > 0.0 && opacity >= OPAQUE * most;
        for (value, opacity) in found.values.iter_mut().zip(opacities) {
            if !is_opaque(opacity) {
                *value = f64::NAN;
                found.transparent += 1;
            } else if extra == Extra::Multiplied {
                *value *= full.unwrap_or(1.0) / opacity;
            }
        }
    }
    found
}

/// Whether most pixels have the largest level and all others none.
fn is_mask(levels: &[f64], most: f64) -> bool {
    let whole = levels.iter().filter(|level| **level == most).count();
    2 * whole > levels.len() && levels.iter().all(|level| *level == most || *level == 0.0)
}
