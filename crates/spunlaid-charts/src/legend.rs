//! The legend: rows above the plot, where there are no data to cover.

use crate::chart::{Chart, Mark, Series};
use crate::label::width;
use crate::palette::{INK, Marker};
use crate::picture::{Anchor, Picture, Stroke, Text};

const SIZE: f64 = 13.0;
const ROW: f64 = 20.0;
const KEY: f64 = 28.0;
const GAP: f64 = 18.0;

/// An entry: what is drawn, and its label.
#[derive(Clone, Copy)]
pub(crate) struct Entry<'a> {
    label: &'a str,
    series: &'a Series,
    mark: &'a Mark,
}

/// The labelled series, in the order they were added.
pub(crate) fn entries(chart: &Chart) -> Vec<Entry<'_>> {
    let marks = chart.marks.iter();
    marks.filter_map(|(series, mark)| Some(Entry { label: series.label.as_deref()?, series, mark })).collect()
}

/// Height the legend takes [px].
pub(crate) fn height(entries: &[Entry<'_>], room: f64) -> f64 {
    rows(entries, room).len() as f64 * ROW
}

fn extent(entry: &Entry<'_>) -> f64 {
    KEY + 6.0 + width(entry.label, SIZE)
}

fn rows<'a>(entries: &[Entry<'a>], room: f64) -> Vec<Vec<Entry<'a>>> {
    let mut rows: Vec<Vec<Entry<'_>>> = Vec::new();
    let mut used = f64::INFINITY;
    for &entry in entries {
        let needed = extent(&entry);
        if used + GAP + needed > room {
            rows.push(Vec::new());
            used = 0.0;
        }
        if let Some(row) = rows.last_mut() {
            row.push(entry);
        }
        used += GAP + needed;
    }
    rows
}

/// Draws the legend between two edges.
pub(crate) fn draw(picture: &mut Picture, entries: &[Entry<'_>], left: f64, right: f64) {
    for (i, row) in rows(entries, right - left).into_iter().enumerate() {
        let y = 16.0 + i as f64 * ROW;
        let mut x = left + 4.0;
        for entry in row {
            draw_key(picture, &entry, x, y);
            let style = Text { size: SIZE, colour: INK, anchor: Anchor::Start, upright: true };
            picture.text((x + KEY + 6.0, y + 4.5), entry.label, style);
            x += extent(&entry) + GAP;
        }
    }
}

fn draw_key(picture: &mut Picture, &Entry { series, mark, .. }: &Entry<'_>, x: f64, y: f64) {
    let stroke = Stroke { colour: series.colour, width: series.width, dash: series.dash };
    let middle = (x + KEY / 2.0, y);
    match mark {
        // Its key stands beside the picture.
        Mark::Map(_) | Mark::Arrow(..) => {}
        Mark::Band(_) | Mark::Stretch(..) => {
            let corners = [(x, y - 6.0), (x + KEY, y - 6.0), (x + KEY, y + 6.0), (x, y + 6.0)];
            picture.polygon(&corners, series.colour, 0.2, None);
        }
        Mark::Scatter(points) => {
            if points.iter().any(|spot| !spot[2].is_nan()) {
                let bar = Stroke::solid(series.colour, 1.2);
                picture.line((middle.0, y - 8.0), (middle.0, y + 8.0), &bar);
            }
            picture.marker(middle, series.marker.unwrap_or(Marker::Spot), series.colour);
        }
        Mark::Line(_) | Mark::Path(_) | Mark::Vertical(_) => {
            picture.line((x, y), (x + KEY, y), &stroke);
            if let Some(marker) = series.marker {
                picture.marker(middle, marker, series.colour);
            }
        }
    }
}
