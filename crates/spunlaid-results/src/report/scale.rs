//! What a CV means: the same web with weaker and stronger clouds, and where on this scale the web itself lies.

use super::unevenness::per_cent;
use super::words::millimetres;
use crate::Failure;
use crate::failure::undrawable;
use crate::numbers::{THIN, significant};
use crate::output::web::with_clouds;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use spunlaid::web::Map;
use spunlaid::web::map::PatchFindings;

/// The CVs of the pictures.
const LEVELS: [f64; 5] = [0.03, 0.06, 0.1, 0.15, 0.2];

/// Pictures above a ruler.
#[derive(Debug)]
pub(super) struct Scale {
    /// Captions, and pictures as base64.
    pub(super) tiles: Vec<(String, String)>,
    /// What is marked on the ruler, by the name of its style: from where, and how wide it is, in per cent.
    pub(super) marks: Vec<(&'static str, f64, f64)>,
    /// What it says.
    pub(super) words: String,
}

/// Place of a CV on the ruler, on which the levels stand below the middles of their pictures [%].
fn place(cv: f64) -> f64 {
    let middle = |number: usize| 100.0 * (number as f64 + 0.5) / LEVELS.len() as f64;
    let after =
        LEVELS.iter().position(|level| cv < *level).unwrap_or(LEVELS.len()).clamp(1, LEVELS.len() - 1);
    let share = (cv - LEVELS[after - 1]) / (LEVELS[after] - LEVELS[after - 1]);
    (middle(after - 1) + share * (middle(after) - middle(after - 1))).clamp(0.5, 99.5)
}

/// What is known of the unevenness of a web.
#[derive(Clone, Copy, Debug)]
pub(super) struct Judged {
    /// Side of the patches [m].
    pub(super) patch: f64,
    /// CV of the map.
    pub(super) of_map: f64,
    /// CV of the web with its error; None if it is not known.
    pub(super) told: Option<(f64, Option<f64>)>,
    /// That of 95 % of such webs.
    pub(super) interval: Option<[f64; 2]>,
    /// That of straight fibres at random, if it is known.
    pub(super) chance: Option<f64>,
}

impl From<&PatchFindings> for Judged {
    fn from(patch: &PatchFindings) -> Self {
        Self {
            patch: patch.map.patch,
            of_map: patch.filled.unwrap_or(patch.map.cv),
            told: patch.told_with_whole_error().map(|told| (told.cv, told.standard_error)),
            interval: patch.interval(),
            chance: Some(patch.straight_fibres),
        }
    }
}

impl Scale {
    /// None if the web is too small for pictures.
    ///
    /// # Errors
    /// If a picture cannot be drawn.
    pub(super) fn new(map: &Map, judged: Judged) -> Result<Option<Self>, Failure> {
        let Judged { patch, of_map, told, interval, chance } = judged;
        let pictures = with_clouds(map, patch, &LEVELS.map(|level| level / of_map));
        let Some(pictures) = pictures.filter(|_| of_map > 0.0) else { return Ok(None) };
        let pictures = pictures.map_err(|reason| undrawable("scale", &reason))?;
        let names = LEVELS.map(|level| format!("{}{THIN}%", significant(100.0 * level, 2)));
        let tiles = names.into_iter().zip(pictures.iter().map(|picture| STANDARD.encode(picture))).collect();
        let marks = (interval.into_iter().map(|ends| ends.map(place)))
            .map(|[from, to]| ("band", from, to - from))
            .chain(chance.map(|cv| ("chance", place(cv), 0.0)))
            .chain(told.map(|(cv, _)| ("own", place(cv), 0.0)))
            .collect();
        Ok(Some(Self { tiles, marks, words: words(judged) }))
    }
}

/// What the scale says of a web.
pub(super) fn words(Judged { patch, told, interval, chance, .. }: Judged) -> String {
    let size = millimetres(patch);
    let chance = chance.map_or_else(String::new, |cv| {
        format!(" Chance alone, in straight fibres at random, gives {}{THIN}%.", significant(100.0 * cv, 3))
    });
    let Some((cv, error)) = told else {
        return format!("How uneven this web is over patches of {size} is not known.{chance}");
    };
    let interval = interval.map_or_else(String::new, |ends| {
        let ends = ends.map(|end| significant(100.0 * end, 3));
        format!("; 95{THIN}% of such webs lie between {}{THIN}%", ends.join(" and "))
    });
    format!("This web has {} over patches of {size}{interval}.{chance}", per_cent(cv, error))
}
