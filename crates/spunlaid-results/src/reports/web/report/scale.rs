//! What a CV means: the same web with weaker and stronger clouds, and where on this scale the web itself lies.

use super::patch_cv::per_cent;
use crate::Failure;
use crate::failure::undrawable;
use crate::numbers::{THIN, significant};
use crate::page::words::millimetres;
use crate::reports::web::files::map::light_table_of;
use crate::reports::web::files::pieces::MEAN;
use askama::Template;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use spunlaid_web::Map;
use spunlaid_web::map::PatchFindings;

/// The CVs of the pictures.
const LEVELS: [f64; 5] = [0.03, 0.06, 0.1, 0.15, 0.2];

/// Pictures above a ruler.
#[derive(Debug, Template)]
#[template(path = "scale.html")]
pub(crate) struct Scale {
    /// Captions, and pictures as base64.
    pub(crate) tiles: Vec<(String, String)>,
    /// What is marked on the ruler, by the name of its style: from where, and how wide it is, in per cent.
    pub(crate) marks: Vec<(&'static str, f64, f64)>,
    /// What it says.
    pub(crate) words: String,
}

/// Place of a CV on the ruler, on which the levels stand below the middles of their pictures [%].
fn place(cv: f64) -> f64 {
    let middle = |number: usize| 100.0 * (number as f64 + 0.5) / LEVELS.len() as f64;
    let after =
        LEVELS.iter().position(|level| cv < *level).unwrap_or(LEVELS.len()).clamp(1, LEVELS.len() - 1);
    let share = (cv - LEVELS[after - 1]) / (LEVELS[after] - LEVELS[after - 1]);
    (middle(after - 1) + share * (middle(after) - middle(after - 1))).clamp(0.5, 99.5)
}

/// What is known of the CV of a web.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Judged {
    /// Side of the patches [m].
    pub(crate) patch: f64,
    /// CV of the map.
    pub(crate) of_map: f64,
    /// CV of the web with its error; None if it is not known.
    pub(crate) reported: Option<(f64, Option<f64>)>,
    /// That of 95 % of such webs.
    pub(crate) interval: Option<[f64; 2]>,
    /// That of straight fibres at random, if it is known.
    pub(crate) chance: Option<f64>,
}

impl From<&PatchFindings> for Judged {
    fn from(patch: &PatchFindings) -> Self {
        Self {
            patch: patch.map.patch,
            of_map: patch.of_map,
            reported: patch.with_total_error().map(|reported| (reported.cv, reported.standard_error)),
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
    pub(crate) fn new(map: &Map, judged: Judged) -> Result<Option<Self>, Failure> {
        let Judged { patch, of_map, reported, interval, chance } = judged;
        let pictures = with_clouds(map, patch, &LEVELS.map(|level| level / of_map));
        let Some(pictures) = pictures.filter(|_| of_map > 0.0) else { return Ok(None) };
        let pictures = pictures.map_err(|reason| undrawable("scale", &reason))?;
        let names = LEVELS.map(|level| format!("{}{THIN}%", significant(100.0 * level, 2)));
        let tiles = names.into_iter().zip(pictures.iter().map(|picture| STANDARD.encode(picture))).collect();
        let marks = (interval.into_iter().map(|ends| ends.map(place)))
            .map(|[from, to]| ("band", from, to - from))
            .chain(chance.map(|cv| ("chance", place(cv), 0.0)))
            .chain(reported.map(|(cv, _)| ("own", place(cv), 0.0)))
            .collect();
        Ok(Some(Self { tiles, marks, words: words(judged) }))
    }
}

/// What the scale says of a web.
pub(crate) fn words(Judged { patch, reported, interval, chance, .. }: Judged) -> String {
    let size = millimetres(patch);
    let chance = chance.map_or_else(String::new, |cv| {
        format!(" Straight fibres at random positions give {}{THIN}%.", significant(100.0 * cv, 3))
    });
    let Some((cv, error)) = reported else {
        return format!("The CV of this web over patches of {size} is not known.{chance}");
    };
    let interval = interval.map_or_else(String::new, |ends| {
        let [low, high] = ends.map(|end| significant(100.0 * end, 3));
        match ends[1].is_finite() {
            true => format!("; 95{THIN}% of such webs lie between {low} and {high}{THIN}%"),
            false => format!("; 95{THIN}% of such webs have at least {low}{THIN}%"),
        }
    });
    format!("This web has {} over patches of {size}{interval}.{chance}", per_cent(cv, error))
}

/// Largest side of the piece that is shown [m].
const SIDE: f64 = 0.12;
/// Fewest patches along a side of it: fewer show no clouds.
const LEAST_PATCHES: f64 = 3.0;
/// Pixels along the side of a patch.
const PIXELS: f64 = 10.0;
/// Three of these are black and white in all pictures, as a share of the mean.
const SHADES: f64 = 0.2;

/// The middle of a map with its clouds made weaker and stronger, all in the same shades, as pictures: what is
/// uneven over patches has so many times the deviation, and the grain of single fibres stays. None if the map is
/// too small.
///
/// * `patch` – side of the patches over which it is uneven [m]
/// * `factors` – by which the deviations of the patches are multiplied
///
/// # Errors
/// If a picture cannot be drawn.
pub fn with_clouds(map: &Map, patch: f64, factors: &[f64]) -> Option<Result<Vec<Vec<u8>>, String>> {
    let each = ((patch / PIXELS / map.cell).round() as usize).max(1);
    let (pixel, most) = (each as f64 * map.cell, map.columns.min(map.rows) / each);
    let side = ((SIDE / pixel) as usize).min(most);
    if side as f64 * pixel < LEAST_PATCHES * patch {
        return None;
    }
    let [left, top] = [map.columns, map.rows].map(|cells| (cells - side * each) / 2);
    let mean = map.total() as f64 / map.cells.len() as f64 * (each * each) as f64;
    let weight = |row: usize, column: usize| -> f64 {
        let rows = (0..each).map(|i| &map.row(top + row * each + i)[left + column * each..][..each]);
        rows.flatten().map(|quanta| f64::from(*quanta)).sum::<f64>() / mean - 1.0
    };
    let deviations: Vec<Vec<f64>> =
        (0..side).map(|row| (0..side).map(|column| weight(row, column)).collect()).collect();
    let reach = (0.5 * patch / pixel) as usize;
    let around = |at: usize| at.saturating_sub(reach)..(at + reach + 1).min(side);
    // First along the rows, then across them.
    let averaged = |lines: &[Vec<f64>]| -> Vec<Vec<f64>> {
        let of = |line: &Vec<f64>, at: usize| line[around(at)].iter().sum::<f64>() / around(at).len() as f64;
        (0..side).map(|at| lines.iter().map(|line| of(line, at)).collect()).collect()
    };
    let clouds = averaged(&averaged(&deviations));
    let picture = |factor: &f64| {
        let cells = (deviations.iter().flatten().zip(clouds.iter().flatten()))
            .map(|(deviation, cloud)| (1.0 + deviation + (factor - 1.0) * cloud).max(0.0))
            .map(|weight| (weight * MEAN).round() as u32)
            .collect();
        let piece = Map { columns: side, rows: side, cell: pixel, quantum: 1.0, closed: [false; 2], cells };
        light_table_of(&piece, SHADES)
    };
    Some(factors.iter().map(picture).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Waves of 40 mm along the machine direction are clouds for patches of 10 mm: their CV follows the factor.
    #[test]
    fn analytic_the_clouds_of_a_picture_follow_its_factor() {
        let columns = 200;
        let rows = 200;
        let cell = 1e-3;
        let wave = |row: usize| 1.0 + 0.1 * (row as f64 * std::f64::consts::TAU / 40.0).sin();
        let cells = (0..rows).flat_map(|row| vec![(1e6 * wave(row)) as u32; columns]).collect();
        let map = Map { columns, rows, cell, quantum: 1.0, closed: [false; 2], cells };
        let spread = |picture: &[u8]| {
            let mut reader = png::Decoder::new(std::io::Cursor::new(picture)).read_info().unwrap();
            let mut levels = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut levels).unwrap();
            let [low, high] =
                [levels.iter().min(), levels.iter().max()].map(|level| f64::from(*level.unwrap()));
            high - low
        };
        let pictures = with_clouds(&map, 10e-3, &[0.5, 1.0, 2.0]).unwrap().unwrap();
        let [half, whole, twice] = [0, 1, 2].map(|i| spread(&pictures[i]));
        // A mean over 11 of 40 mm keeps sin(x)/x = 0.88 of a wave; a shade is a 210th of the mean weight.
        let kept = 0.88;
        assert!((half - whole * (1.0 - 0.5 * kept)).abs() < 2.0, "{half} {whole}");
        assert!((twice - whole * (1.0 + kept)).abs() < 2.0, "{twice} {whole}");
        assert!(with_clouds(&map, 0.1, &[1.0]).is_none());
    }
}
