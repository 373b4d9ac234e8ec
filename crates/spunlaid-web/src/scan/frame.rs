//! The part of a picture that holds the web: without the pixels along its edges that have no value, without the
//! border of one level around it, without the bare strips beside the web of a map, and without rows that are all the
//! same.

use super::border::Border;
use super::findings::Settings;
use super::levels::{FILLED, per_cent};
use super::picture::{Picture, Rectangle, cut};
use super::spots::{FEWEST, Level, largest, region, widen};
use super::weigh::Light;
use spunlaid_ground::{Dimension, Fault};
use std::ops::Range;

/// Blocks of a map with less of its median weight are bare: a web that becomes thin towards its edge is a web
/// down to that.
const BARE: f64 = 0.05;
/// A part of the edge is no web if it reaches along this share of a side.
const ALONG: f64 = 0.5;
/// Fewest rows or columns in succession that are equal because they were not scanned. A picture that was enlarged has
/// some.
const REPEATED: usize = 8;
/// Pixels beside a bare strip that it may have part in.
const MARGIN: usize = 1;

/// The part of a picture that holds the web, and what was left out.
pub(super) struct Frame {
    pub(super) web: Rectangle,
    pub(super) notes: Vec<Fault>,
    /// Level of the lamp beside the web, over its picture if there is one; none if it is not seen.
    pub(super) bare: Option<f64>,
    /// Whether the border around the web shows that the light is even.
    pub(super) is_even: bool,
}

/// What a part of a picture is that is no web.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Outside {
    /// Without a value, or transparent.
    Absent,
    /// Without any light, as a scan that was turned is around it.
    Black,
    /// Without weight.
    Bare,
    /// The lamp.
    Lamp,
    /// Of one level, that of a light lid or ground.
    Light,
    /// Of one level, that of a dark lid or ground.
    Dark,
    /// Rows or columns that are all the same.
    Repeated,
}

impl Frame {
    /// * `lamp` – of the same size as the picture
    ///
    /// # Errors
    /// If no large rectangle is web alone.
    pub(super) fn new(picture: &Picture, lamp: Option<&Picture>, settings: &Settings) -> Result<Self, Fault> {
        let mut frame = Self { web: picture.whole(), notes: Vec::new(), bare: None, is_even: false };
        if picture.transparent > 0 {
            let count = picture.transparent;
            let share = per_cent(count as f64 / picture.values.len() as f64);
            let message = format!("pixels that are transparent: {count} ({share}); they are taken as no web");
            frame.notes.push(Fault::plain(message));
        }
        let is_absent = |at: usize| {
            !picture.values[at].is_finite() || lamp.is_some_and(|lamp| !lamp.values[at].is_finite())
        };
        let absent: Vec<bool> = (0..picture.values.len()).map(is_absent).collect();
        frame.leave_out(
            &along_edges(&absent, picture.columns, Outside::Absent),
            picture.pixel,
            Outside::Absent,
        )?;
        if settings.keep_spots {
            return Ok(frame);
        }
        frame.leave_out_border(picture, lamp, settings.light)?;
        let part = picture.part(frame.web);
        let (marks, outside) = match settings.light {
            Light::Transmitted { .. } => {
                (part.values.iter().map(|level| *level <= 0.0).collect(), Outside::Black)
            }
            Light::Reflected { .. } => (bare(part.values, part.columns), Outside::Bare),
            Light::Weight { .. } => (bare(part.weights().collect(), part.columns), Outside::Bare),
        };
        let mut marks = along_edges(&marks, part.columns, outside);
        widen(&mut marks, part.columns, [MARGIN; 2]);
        frame.leave_out(&marks, picture.pixel, outside)?;
        let part = picture.part(frame.web);
        // Without any fibre, and where the lamp is too bright for the picture, a line may repeat another.
        let empty = match settings.light {
            Light::Transmitted { .. } => part.full_scale,
            _ => Some(0.0),
        };
        frame.leave_out(&repeated(&part.values, part.columns, empty), picture.pixel, Outside::Repeated)?;
        Ok(frame)
    }

    /// Cuts off the border of one level around the web, and another one within it.
    fn leave_out_border(
        &mut self,
        picture: &Picture,
        lamp: Option<&Picture>,
        light: Light,
    ) -> Result<(), Fault> {
        for _ in 0..2 {
            let mut part = picture.part(self.web);
            if let Some(lamp) = lamp {
                let scale = lamp.scale_to(picture);
                let lamp = cut(&lamp.values, lamp.columns, self.web);
                part.values.iter_mut().zip(lamp).for_each(|(level, lamp)| *level /= scale * lamp);
            }
            let border = match light {
                Light::Weight { .. } => None,
                _ => Border::find(&part.values, part.columns),
            };
            let Some(border) = border else { break };
            let outside = match light {
                Light::Transmitted { .. } if border.is_light => Outside::Lamp,
                _ if border.is_light => Outside::Light,
                _ => Outside::Dark,
            };
            self.is_even |= border.is_light && border.is_even;
            self.bare = self.bare.or((outside == Outside::Lamp).then_some(border.level));
            self.leave_out(&border.marks, picture.pixel, outside)?;
        }
        Ok(())
    }

    /// Cuts out the largest rectangle without any mark.
    fn leave_out(&mut self, marks: &[bool], pixel: f64, outside: Outside) -> Result<(), Fault> {
        let marked = marks.iter().filter(|is| **is).count();
        if marked == 0 {
            return Ok(());
        }
        let [columns, rows] = self.web.sides;
        let part = largest(marks, columns);
        let is_optional = !matches!(outside, Outside::Absent | Outside::Black);
        let what = match outside {
            Outside::Absent => "has no values",
            Outside::Black => "is black",
            Outside::Bare => "is bare",
            Outside::Lamp => "shows the bare lamp",
            Outside::Light => "has a light border",
            Outside::Dark => "has a dark border",
            Outside::Repeated => "has rows or columns that are all the same, as one that is not finished,",
        };
        if !part.is_large(marks.len() - marked) {
            let share = (100.0 * marked as f64 / marks.len() as f64).round();
            let message = format!(
                "{what} on {share} % of its area, along its edges, and no large rectangle of web can be cut out"
            );
            let fault = Fault::new(message, "turn the scan straight, and cut it so that it holds web only");
            return Err(if is_optional { fault.option("--keep-spots") } else { fault });
        }
        let ([left, top], [across, along]) = (part.corner, part.sides);
        let strips = [
            (left, "left"),
            (columns - left - across, "right"),
            (top, "top"),
            (rows - top - along, "bottom"),
        ];
        let strips = strips.into_iter().filter(|(pixels, _)| *pixels > 0).map(|(pixels, side)| {
            format!("{} at the {side}", Dimension::Length.pretty_to(pixels as f64 * pixel, 3))
        });
        let message = format!(
            "the image {what} along its edges, so strips were cut off: {}",
            strips.collect::<Vec<_>>().join(", ")
        );
        let remedy = if is_optional { "if they belong to the web, say so (--keep-spots)" } else { "" };
        // The note of the bare lamp says what was cut off.
        if outside != Outside::Lamp {
            self.notes.push(Fault::new(message, remedy));
        }
        self.web =
            Rectangle { corner: [self.web.corner[0] + left, self.web.corner[1] + top], sides: part.sides };
        Ok(())
    }
}

/// The blocks of one, three, nine … pixels at the edge that are bare.
fn bare(values: Vec<f64>, columns: usize) -> Vec<bool> {
    let mut bare = vec![false; values.len()];
    let mut level = Level { values, columns, block: 1 };
    let sides = [columns, level.rows()];
    while level.columns.min(level.rows()) >= FEWEST {
        if let Some(median) = level.median_if_even() {
            let is_bare = |x: f64| x < BARE * median;
            level.paint(&mut bare, sides, is_bare, is_bare, true);
        }
        level = level.coarser();
    }
    bare
}

/// The marks that hang together with a good part of a side. Where nothing is known, a large part at an edge is
/// enough; a hole of a web that lies there is web.
fn along_edges(marks: &[bool], columns: usize, outside: Outside) -> Vec<bool> {
    let sides = [columns, marks.len() / columns];
    let mut kept = vec![false; marks.len()];
    let mut visited = vec![false; marks.len()];
    let ends = |at: usize| {
        let place = [at % columns, at / columns];
        [place[0] == 0, place[0] + 1 == columns, place[1] == 0, place[1] + 1 == sides[1]]
    };
    for first in 0..marks.len() {
        if !marks[first] || visited[first] || !ends(first).contains(&true) {
            continue;
        }
        let region = region(&mut visited, sides, first, |at| marks[at]);
        let reaches = |end: usize| {
            let along = region.iter().filter(|at| ends(**at)[end]).count();
            along as f64 >= ALONG * sides[1 - end / 2] as f64
        };
        if (0..4).any(reaches) || outside == Outside::Absent && region.len() > marks.len() / FILLED {
            region.into_iter().for_each(|at| kept[at] = true);
        }
    }
    kept
}

/// The pixels of rows and of columns that are equal to those before them, where many in succession are; not where all
/// of the picture is so.
///
/// * `empty` – value of a pixel without web
fn repeated(values: &[f64], columns: usize, empty: Option<f64>) -> Vec<bool> {
    let rows = values.len() / columns;
    let mut marks = vec![false; values.len()];
    let is_row = |row: usize| repeats(values, row * columns..(row + 1) * columns, columns, empty);
    let is_column = |column: usize| repeats(values, (column..values.len()).step_by(columns), 1, empty);
    for run in runs(rows, is_row) {
        marks[run.start * columns..run.end * columns].fill(true);
    }
    for run in runs(columns, is_column) {
        marks.chunks_exact_mut(columns).for_each(|row| row[run.clone()].fill(true));
    }
    marks
}

/// Whether the pixels of a line are those of the line before it, and are not all empty.
///
/// * `back` – from a pixel to that of the line before it
fn repeats(values: &[f64], line: impl Iterator<Item = usize>, back: usize, empty: Option<f64>) -> bool {
    let mut is_empty = true;
    let mut pairs = line.map(|at| [values[at], values[at - back]]);
    pairs.all(|[value, before]| {
        is_empty &= Some(value) == empty;
        value == before
    }) && !is_empty
}

/// Where many of some lines in succession repeat the line before them.
fn runs(lines: usize, repeats: impl Fn(usize) -> bool) -> Vec<Range<usize>> {
    let (mut runs, mut first) = (Vec::new(), 1);
    for line in 1..=lines {
        if line == lines || !repeats(line) {
            if line - first >= REPEATED && line - first + 1 < lines {
                // The line that is repeated may not have been scanned either.
                runs.push(first - 1..line);
            }
            first = line + 1;
        }
    }
    runs
}
