//! Pictures of webs beside each other.

use super::words::{metres, millimetres};
use crate::numbers::{THIN, significant};
use crate::output::web::Pictures;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// Pictures of webs with their names.
#[derive(Clone, Debug)]
pub struct ComparedPictures {
    /// Names of the webs.
    pub names: Vec<String>,
    /// Their pictures, in the same order.
    pub pictures: Pictures,
}

/// Pictures of webs beside each other, at one scale and in the same shades.
#[derive(Debug)]
pub(super) struct Beside<'a> {
    /// Names and pictures, as base64.
    pub(super) webs: Vec<(&'a str, String)>,
    /// Width over height of each.
    pub(super) aspect: f64,
    /// Length of the bar below a picture, and its share of the width in per cent.
    pub(super) bar: (String, f64),
    /// Below white and below black.
    pub(super) ends: [String; 2],
}

impl<'a> Beside<'a> {
    pub(super) fn new(webs: &'a ComparedPictures) -> Self {
        let Pictures { sides: [width, length], contrast, files, .. } = &webs.pictures;
        let names = webs.names.iter().map(String::as_str);
        let contrast = |sign: char| format!("{sign}{}{THIN}%", significant(100.0 * contrast, 2));
        let bar = round_length(0.4 * width);
        Self {
            webs: names.zip(files.iter().map(|file| STANDARD.encode(file))).collect(),
            aspect: width / length,
            bar: (metres(bar), 100.0 * bar / width),
            ends: ['−', '+'].map(contrast),
        }
    }
}

/// The longest of 1, 2 and 5 times a power of ten that is no longer than a length.
fn round_length(most: f64) -> f64 {
    let power = 10f64.powf(most.log10().floor());
    [5.0, 2.0].into_iter().map(|step| step * power).find(|length| *length <= most).unwrap_or(power)
}

/// What is said below pictures of webs.
pub(super) fn caption(Pictures { sides: [width, length], pixel, .. }: &Pictures) -> String {
    format!(
        "The middle of each web, {} across and {} along it, at the same scale and in the same shades: the \
        same shade is the same basis weight relative to the mean of the piece, lighter where there is less \
        fibre. Black and white are three standard deviations of the most uneven piece apart from the mean. \
        The machine direction runs downwards. A pixel is {} wide in all pictures; finer maps are averaged to \
        it.",
        metres(*width),
        metres(*length),
        millimetres(*pixel)
    )
}
