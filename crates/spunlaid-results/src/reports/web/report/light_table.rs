//! The light table of a web's page: its picture, the single fibres of a window, and what is reported of them.

use crate::Failure;
use crate::failure::undrawable;
use crate::numbers::significant;
use crate::page::document::{View, script};
use crate::page::words::millimetres;
use crate::reports::web::files::map::Shades;
use crate::reports::web::files::picture::{PIECE, Pictures};
use askama::Template;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use spunlaid_web::{Fabric, Map, Marked, Marks, Streak, StripPlace, Window, WindowCurve};

const MM: f64 = 1e3;
/// Most points of fibres in the page.
const POINTS: usize = 150_000;

/// The picture of the web on the page.
#[derive(Debug, Template)]
#[template(path = "light_table.html")]
pub(crate) struct Sheet {
    /// Base64 of the picture.
    pub(crate) picture: String,
    /// Base64 of the picture of what chance alone makes of it; empty where that is not known.
    pub(crate) chance: String,
    /// What is said below each.
    pub(crate) below: [String; 2],
    /// How large the web is, in words.
    pub(crate) words: String,
    /// Width over length of the piece that is seen first.
    pub(crate) aspect: f64,
    /// Side of a pixel of the picture [m].
    pub(crate) pixel: f64,
    /// Whether there are single fibres to be seen.
    pub(crate) has_fibres: bool,
    /// Whether there are places to be marked.
    pub(crate) has_marks: bool,
    /// What the script of the light table gets. Numbers and base64 only: nothing in it can end the script
    /// element it stands in.
    pub(crate) data: String,
}

impl Sheet {
    pub(crate) fn view(&self) -> View {
        View::new(self, &[script!("light_table.js")])
    }
}

/// What the script of the light table gets; lengths in mm.
#[derive(Serialize)]
struct Data {
    width: f64,
    length: f64,
    /// Side of a pixel of the picture.
    pixel: f64,
    /// Side of the piece that is seen first.
    piece: f64,
    window: Option<Fibres>,
    #[serde(skip_serializing_if = "Option::is_none")]
    marks: Option<MarkedPlaces>,
}

/// Places that are worth a look: rectangles by corner and sides; base64 of 32-bit numbers, low byte first.
#[derive(Serialize)]
pub(crate) struct MarkedPlaces {
    /// Thin patches.
    thin: String,
    /// The thinnest ones, with their weight over the mean.
    thinnest: String,
    /// Strips along MD and along CD, and their weakest sections.
    strips: [[String; 2]; 2],
    /// Streaks of the defects of the line.
    streaks: String,
}

impl MarkedPlaces {
    pub(crate) fn new(fabric: &Fabric) -> Self {
        let marks = &fabric.marks;
        let rectangle = |corner: [f64; 2], sides: [f64; 2]| [corner, sides].concat();
        let of_patch = |place: &Marked| rectangle(place.corner, place.sides);
        let parts = |strips: &Vec<StripPlace>| {
            let strip = |strip: &StripPlace| rectangle(strip.corner, strip.sides);
            [
                packed(strips.iter().flat_map(strip)),
                packed(strips.iter().flat_map(|one| of_patch(&one.weakest))),
            ]
        };
        let streak =
            |streak: &Streak| rectangle([streak.place - 0.5 * streak.band, 0.0], [streak.band, streak.until]);
        // A weight is no length, and the script has all numbers in mm.
        let thinnest = |place: &Marked| [of_patch(place), vec![place.weight / MM]].concat();
        Self {
            thin: packed(marks.thin.iter().flat_map(of_patch)),
            thinnest: packed(marks.thinnest.iter().flat_map(thinnest)),
            strips: marks.strips.each_ref().map(parts),
            streaks: packed(fabric.streaks.iter().flat_map(streak)),
        }
    }
}

/// What the marks of a picture mean; nothing without any.
pub(crate) fn marks_note(fabric: &Fabric) -> String {
    let Marks { patch, thin, thin_of_all, strips, .. } = &fabric.marks;
    let mut words = Vec::new();
    if !thin.is_empty() {
        let all = if thin.len() < *thin_of_all {
            format!("the lightest {} of {thin_of_all}", thin.len())
        } else {
            thin_of_all.to_string()
        };
        words.push(format!(
            "orange, patches of {} that are lighter than 80 % of the mean, {all}; the thinnest spots are outlined",
            millimetres(*patch)
        ));
    }
    if strips.iter().any(|strips| !strips.is_empty()) {
        words.push("blue, strips, with their weakest section in orange".to_owned());
    }
    if !fabric.streaks.is_empty() {
        words.push("pink, the bands that are searched for the defects of the line".to_owned());
    }
    if words.is_empty() {
        String::new()
    } else {
        format!(" Marks that can be switched on: {}.", words.join("; "))
    }
}

/// Base64 of lengths in mm.
fn packed(lengths: impl Iterator<Item = f64>) -> String {
    let bytes: Vec<u8> = lengths.flat_map(|length| ((length * MM) as f32).to_le_bytes()).collect();
    STANDARD.encode(bytes)
}

#[derive(Serialize)]
pub(crate) struct Fibres {
    corner: [f64; 2],
    sides: [f64; 2],
    diameter: f64,
    /// Number of points of each fibre.
    counts: Vec<usize>,
    /// Base64 of 32-bit numbers, low byte first: x and y of each point from the corner.
    points: String,
}

/// The single fibres in a window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Strands<'a> {
    pub(crate) window: Window,
    pub(crate) strands: &'a [WindowCurve],
    /// Diameter of a fibre [m].
    pub(crate) diameter: f64,
}

impl Strands<'_> {
    /// What is reported of them below the picture.
    pub(crate) fn words(&self) -> String {
        let (drawn, all) = (self.drawn().count(), self.strands.len());
        format!(
            "In the small frame, {} by {}, {} drawn in their true width.",
            millimetres(self.window.sides[0]),
            millimetres(self.window.sides[1]),
            if drawn == all {
                "the single fibres are".to_owned()
            } else {
                format!("{drawn} of the {all} pieces of single fibres are")
            }
        )
    }

    /// As many as the page can hold, the first ones.
    fn drawn(&self) -> impl Iterator<Item = &WindowCurve> {
        let mut points = 0;
        self.strands.iter().take_while(move |strand| {
            points += strand.points.len();
            points <= POINTS
        })
    }
}

impl Fibres {
    /// Those that are drawn.
    pub(crate) fn new(strands: Strands<'_>) -> Self {
        let Strands { window, diameter, .. } = strands;
        let counts = strands.drawn().map(|strand| strand.points.len()).collect();
        let coordinates = strands.drawn().flat_map(|strand| strand.points.iter().flatten());
        Self {
            corner: window.corner.map(|x| x * MM),
            sides: window.sides.map(|x| x * MM),
            diameter: diameter * MM,
            counts,
            points: packed(coordinates.copied()),
        }
    }
}

/// The pictures of a map on the page.
pub(crate) fn sheet(
    map: &Map,
    Pictures { web, chance, words }: &Pictures,
    window: Option<Fibres>,
    marks: Option<MarkedPlaces>,
) -> Result<Sheet, Failure> {
    let failed = |reason: String| undrawable("web", &reason);
    let (pixel, piece) = (web.pixel, PIECE * MM);
    let [width, length] = [map.columns, map.rows].map(|cells| cells as f64 * map.cell * MM);
    let data = Data { width, length, pixel: pixel * MM, piece, window, marks };
    let picture = |shades: &Shades| shades.png().map(|picture| STANDARD.encode(picture)).map_err(failed);
    Ok(Sheet {
        picture: picture(web)?,
        chance: chance.as_ref().map(picture).transpose()?.unwrap_or_default(),
        below: words.clone(),
        words: format!("The web is {} mm wide and {} mm long.", thousands(width), thousands(length)),
        aspect: width.min(piece) / length.min(piece),
        pixel,
        has_fibres: data.window.is_some(),
        has_marks: data.marks.is_some(),
        data: serde_json::to_string(&data).map_err(|error| failed(error.to_string()))?,
    })
}

/// `4,500`, or `62.5` below a hundred.
fn thousands(number: f64) -> String {
    if number < 100.0 {
        return significant(number, 3);
    }
    let digits = format!("{number:.0}");
    let groups: Vec<&str> =
        digits.as_bytes().rchunks(3).rev().filter_map(|part| str::from_utf8(part).ok()).collect();
    groups.join(",")
}

/// What is reported of a picture below it.
pub(crate) fn picture_note(Sheet { pixel, chance, .. }: &Sheet) -> String {
    let has_chance = !chance.is_empty();
    format!(
        "Lighter where there is less fibre; black and white are three standard deviations apart from the \
        mean. The machine direction runs downwards. A pixel is {} wide. Drag to move the web, zoom with the \
        wheel, two fingers, the buttons or the keys + and −; the key 0 shows the whole web.{}",
        millimetres(*pixel),
        if has_chance {
            " Next to it, at the same scale and in the same shades: straight fibres of the same mass at random, the \
             most uniform web that randomness allows."
        } else {
            ""
        }
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_words_are_those_of_the_web() {
        let map = Map {
            columns: 4500,
            rows: 800,
            cell: 1e-3,
            quantum: 1.0,
            closed: [false; 2],
            cells: (0..4500 * 800).map(|i| 5 + i % 7).collect(),
        };
        let sheet = sheet(&map, &Pictures::new(&map, None, Default::default()), None, None).unwrap();
        assert_eq!(sheet.words, "The web is 4,500 mm wide and 800 mm long.");
        // Two cells to a pixel: an elongated web is as fine as a square one of the same area. A square piece is seen.
        assert_eq!((sheet.pixel, sheet.aspect), (2e-3, 1.0));
        let data = r#"{"width":4500.0,"length":800.0,"pixel":2.0,"piece":500.0,"#;
        assert!(sheet.data.starts_with(data), "{}", sheet.data);
        for (number, words) in [(62.5, "62.5"), (999.0, "999"), (12_345_678.0, "12,345,678")] {
            assert_eq!(thousands(number), words);
        }
    }
}
