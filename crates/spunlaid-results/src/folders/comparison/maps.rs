//! What the maps of webs show beside each other: pictures at one scale and in the same shades, and spectra in
//! cells of one size.

use super::web::Web;
use crate::figures::{ComparedSpectrum, overlaid_spectra};
use crate::output::web::{MapFile, Pictures};
use crate::report::ComparedPictures;
use spunlaid::web::Clouds;
use spunlaid::web::scan::shortest_sharp_wave;
use spunlaid_charts::Figure;

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
