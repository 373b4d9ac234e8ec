//! The part of a picture that holds the web: without the pixels along its edges that have no value, and
//! without the bare strips beside the web of a map.

use super::findings::Settings;
use super::levels::{FILLED, per_cent};
use super::picture::{Picture, Rectangle};
use super::spots::{FEWEST, KEPT, Level, largest, region, widen};
use super::weigh::Light;
use crate::ground::{Dimension, Fault};

/// Blocks of a map with less of its median weight are bare: a web that becomes thin towards its edge is a web
/// down to that.
const BARE: f64 = 0.05;
/// A part of the edge is no web if it reaches along this share of a side.
const ALONG: f64 = 0.5;
/// Pixels beside a bare strip that it may have part in.
const MARGIN: usize = 1;

/// The part of a picture that holds the web, and what was left out.
pub(super) struct Frame {
    pub(super) web: Rectangle,
    pub(super) notes: Vec<Fault>,
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
}

impl Frame {
    /// * `lamp` – of the same size as the picture
    ///
    /// # Errors
    /// If no large rectangle is web alone.
    pub(super) fn new(picture: &Picture, lamp: Option<&Picture>, settings: &Settings) -> Result<Self, Fault> {
        let mut frame = Self { web: picture.whole(), notes: Vec::new() };
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
        Ok(frame)
    }

    /// Cuts out the largest rectangle without any mark.
    fn leave_out(&mut self, marks: &[bool], pixel: f64, outside: Outside) -> Result<(), Fault> {
        let marked = marks.iter().filter(|is| **is).count();
        if marked == 0 {
            return Ok(());
        }
        let [columns, rows] = self.web.sides;
        let part = largest(marks, columns);
        let what = match outside {
            Outside::Absent => "has no values",
            Outside::Black => "is black",
            Outside::Bare => "is bare",
        };
        if (part.sides[0] * part.sides[1]) as f64 <= KEPT * (marks.len() - marked) as f64 {
            let share = (100.0 * marked as f64 / marks.len() as f64).round();
            let message = format!(
                "{what} along its edges, on {share} % of its area, and no large rectangle of web can be cut out"
            );
            let fault = Fault::new(message, "turn it straight, and cut it so that it holds web only");
            return Err(if outside == Outside::Bare { fault.option("--keep-spots") } else { fault });
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
            "the picture {what} along its edges, so strips were cut off: {}",
            strips.collect::<Vec<_>>().join(", ")
        );
        let is_bare = outside == Outside::Bare;
        let remedy = if is_bare { "if they belong to the web, say so (--keep-spots)" } else { "" };
        self.notes.push(Fault::new(message, remedy));
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
