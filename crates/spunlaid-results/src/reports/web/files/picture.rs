//! The web as it is seen beside what chance alone makes of it, at one scale and in one set of shades; for a slide with
//! a scale, the CV and the name of the line.

use super::map::{Shades, grey_png};
use crate::files::pictures::SOFTWARE;
use crate::numbers::{HARD, THIN};
use spunlaid_charts::palette::INK;
use spunlaid_charts::picture::{Anchor, Text};
use spunlaid_charts::{Picture, png};
use spunlaid_web::{Map, Web};
use std::io::Cursor;

/// Most pixels of the whole web: a page of some megabytes.
const PIXELS: usize = 3_000_000;
/// Side of the piece that is seen first [m].
pub(crate) const PIECE: f64 = 0.5;
/// Sides of the random piece [m], its fewest and its most pixels, and most pixels through which its fibres go.
const BESIDE: [f64; 2] = [0.2, 0.5];
const FEWEST: usize = 64;
const MOST: usize = 1000;
const DRAWN: f64 = 5e7;

/// Pictures of a web.
#[derive(Clone, Debug)]
pub(crate) struct Pictures {
    /// The whole web.
    pub(crate) web: Shades,
    /// Straight fibres at random of the same mass, which go on at all edges; None where these are not known.
    pub(crate) chance: Option<Shades>,
    /// What is said below each.
    pub(crate) words: [String; 2],
}

impl Pictures {
    /// * `web` – what the map is of; None of a scan
    pub(crate) fn new(map: &Map, web: Option<&Web>, words: [String; 2]) -> Self {
        let shades = Shades::new(map, PIXELS);
        let pixel = shades.pixel;
        let chance = web.and_then(|web| {
            let [columns, rows] = BESIDE.map(|side| ((side / pixel) as usize).clamp(FEWEST, MOST));
            let per_row = web.fibre_length() / (web.sheet.width * web.sheet.length) * pixel * columns as f64;
            let rows = rows.min((DRAWN / per_row) as usize).max(FEWEST);
            Some(Shades::of(&web.at_random([columns, rows], pixel).ok()?, shades.deviation))
        });
        Self { web: shades, chance, words }
    }

    /// The middle of the web and what chance makes of it, as PNG.
    ///
    /// * `name` – of the line
    ///
    /// # Errors
    /// If it cannot be drawn: why, in words.
    pub(crate) fn slide(&self, name: &str) -> Result<Vec<u8>, String> {
        let pixels = |length: f64| (length / self.web.pixel).round().max(1.0) as usize;
        let size = self.web.size.map(|cells| cells.min(pixels(PIECE)));
        let times = (SIDE / size[0].max(size[1])).max(1);
        let middle = [0, 1].map(|axis| (self.web.size[axis] - size[axis]) / 2);
        let beside = self.chance.as_ref().map(|chance| (chance, [0, 0], size[0].div_ceil(3)));
        let panes: Vec<_> = [(&self.web, middle, size[0])].into_iter().chain(beside).collect();
        let width = panes.iter().map(|(_, _, columns)| columns * times + EDGE).sum::<usize>() + EDGE;
        let rows = size[1] * times;
        let height = HEAD + rows + FOOT;
        let mut words = Picture::new(width as f64, height as f64, name);
        let room = (width - 2 * EDGE) as f64;
        write(
            &mut words,
            [EDGE, 56],
            Anchor::Start,
            name,
            (1.6 * room / name.chars().count() as f64).min(32.0),
        );
        // The longest bar of a round length that is at most a quarter of the piece.
        let quarter = 0.25 * size[0] as f64 * self.web.pixel;
        let power = 10f64.powf(quarter.log10().floor());
        let bar = [5.0, 2.0, 1.0].into_iter().find(|step| step * power <= quarter).unwrap_or(1.0) * power;
        let foot = HEAD + rows + 40;
        let [to, long] = [EDGE + size[0] * times, pixels(bar) * times];
        let ends = [(to - long.min(to), foot - 12), (to, foot - 6)].map(|(x, y)| (x as f64, y as f64));
        words.rectangles(&[(ends[0], ends[1])], INK);
        let scale = spunlaid_ground::Dimension::Length.pretty_to(bar, 2);
        write(&mut words, [to - long.min(to) - 12, foot], Anchor::End, &scale, 24.0);
        let mut left = EDGE;
        for ((_, _, columns), said) in panes.iter().zip(&self.words) {
            // The font has no thin space.
            write(&mut words, [left, foot], Anchor::Start, &said.replace(THIN, &HARD.to_string()), 24.0);
            left += columns * times + EDGE;
        }
        let mut levels = greys(&words)?;
        left = EDGE;
        for (shades, corner, columns) in panes {
            for (row, column) in
                (0..rows).flat_map(|row| (0..columns * times).map(move |column| (row, column)))
            {
                let at = [column, row].map(|place| place / times);
                let [x, y] = [0, 1].map(|axis| (corner[axis] + at[axis]) % shades.size[axis]);
                levels[(HEAD + row) * width + left + column] = shades.levels[y * shades.size[0] + x];
            }
            left += columns * times + EDGE;
        }
        grey_png([width, height], &levels, &[("Title", name.to_owned()), ("Software", SOFTWARE.to_owned())])
    }
}

/// Side of the web on a slide where its pixels allow it, what is around it, and the room for words above and below it
/// [px].
const SIDE: usize = 1000;
const EDGE: usize = 24;
const HEAD: usize = 84;
const FOOT: usize = 64;

fn write(on: &mut Picture, at: [usize; 2], anchor: Anchor, text: &str, size: f64) {
    let [x, y] = at.map(|place| place as f64);
    on.text((x, y), text, Text { size, colour: INK, anchor, upright: true });
}

/// A picture of grey words, pixel by pixel.
fn greys(picture: &Picture) -> Result<Vec<u8>, String> {
    let file = png(picture, 96, &[]).map_err(|error| error.to_string())?;
    let failed = |error: ::png::DecodingError| error.to_string();
    let mut reader = ::png::Decoder::new(Cursor::new(file)).read_info().map_err(failed)?;
    let mut colours = vec![0; reader.output_buffer_size().unwrap_or(0)];
    reader.next_frame(&mut colours).map_err(failed)?;
    Ok(colours.chunks_exact(3).map(|pixel| pixel[0]).collect())
}
