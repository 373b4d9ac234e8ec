//! What the maps of webs show beside each other: pictures at one scale and in the same shades, and spectra.

use super::figures::{ComparedSpectrum, overlaid_spectra};
use super::web::Web;
use crate::numbers::{THIN, significant};
use crate::page::words::{metres, millimetres};
use crate::reports::web::files::pieces::{MapFile, Pictures};
use askama::Template;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use spunlaid_charts::Figure;
use spunlaid_web::Clouds;
use spunlaid_web::scan::shortest_sharp_wave;

/// What the maps show, and why one shows nothing.
#[derive(Debug, Default)]
pub(super) struct Maps {
    pub(super) pictures: Option<ComparedPictures>,
    pub(super) spectra: Option<Figure>,
    pub(super) notes: Vec<String>,
}

/// Looks at the maps of the webs that have one.
pub(super) fn maps(webs: &[Web]) -> Maps {
    let mut notes: Vec<String> = (webs.iter())
        .filter_map(|web| Some(without(&web.name, web.map.as_ref().err()?, "neither picture nor spectrum")))
        .collect();
    let known: Vec<(&Web, &MapFile)> =
        webs.iter().filter_map(|web| Some((web, web.map.as_ref().ok()?))).collect();
    if known.is_empty() {
        return Maps { notes, ..Maps::default() };
    }
    let named: Vec<(&str, &MapFile)> = known.iter().map(|(web, map)| (web.name.as_str(), *map)).collect();
    let pictures = match Pictures::new(&named) {
        Ok(pictures) => {
            let names = named.iter().map(|(name, _)| (*name).to_owned()).collect();
            Some(ComparedPictures { names, pictures })
        }
        Err(reason) => {
            notes.push(format!("there are no pictures: {reason}"));
            None
        }
    };
    let cell = known.iter().map(|(_, map)| map.cell).fold(0.0, f64::max);
    let mut spectra = Vec::new();
    for (web, map) in known {
        let clouds = map.whole(cell).and_then(|map| {
            Clouds::measure(&map)
                .ok_or_else(|| "its map has fewer than 16 cells of that size either way".to_owned())
        });
        match clouds {
            Ok(clouds) => {
                let sharp_from = web.has_camera.then(|| shortest_sharp_wave(map.cell));
                spectra.push(ComparedSpectrum { name: web.name.clone(), clouds, sharp_from });
            }
            Err(reason) => notes.push(without(&web.name, &reason, "no spectrum")),
        }
    }
    Maps { pictures, spectra: overlaid_spectra(&spectra, cell), notes }
}

fn without(name: &str, reason: &str, what: &str) -> String {
    format!("{name} has {what} here: {reason}")
}

/// Pictures of webs with their names.
#[derive(Clone, Debug)]
pub struct ComparedPictures {
    /// Names of the webs.
    pub names: Vec<String>,
    /// Their pictures, in the same order.
    pub pictures: Pictures,
}

/// Pictures of webs beside each other, at one scale and in the same shades.
#[derive(Debug, Template)]
#[template(path = "beside.html")]
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
        "The middle of each web, {} across and {} along it, at the same scale and in the same shades. The \
        same shade is the same basis weight relative to the mean of the piece, lighter where there is less \
        fibre. Black and white are three standard deviations of the least uniform piece from the mean. \
        The machine direction runs downwards. A pixel is {} wide in all pictures; finer maps are averaged to \
        it.",
        metres(*width),
        metres(*length),
        millimetres(*pixel)
    )
}
