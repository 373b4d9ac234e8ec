//! A quantity over a plane, in colours, with their key beside it.

use crate::numbers::signed;
use crate::palette::INK;
use crate::svg::{Anchor, Stroke, Svg, Text};

/// Values over a rectangle of the plane.
#[derive(Clone, Debug)]
pub struct Map {
    /// From where to where along.
    pub x: (f64, f64),
    /// From where to where up.
    pub y: (f64, f64),
    /// Number of values in a row.
    pub columns: usize,
    /// Row by row from the lowest y, along x; NaN where there is nothing.
    pub values: Vec<f64>,
    /// The lowest and the highest value that colours tell.
    pub range: (f64, f64),
    /// What they are.
    pub label: String,
}

/// Room for the key [px].
pub(crate) const KEY: f64 = 84.0;
/// Colours that are told apart.
const LEVELS: usize = 20;

impl Map {
    /// The middle of each cell with its value: x, y, value.
    pub(crate) fn cells(&self) -> impl Iterator<Item = [f64; 3]> {
        let (columns, rows) = (self.columns.max(1), self.values.len() / self.columns.max(1));
        let middle =
            |ends: (f64, f64), i: usize, n: usize| ends.0 + (ends.1 - ends.0) * (i as f64 + 0.5) / n as f64;
        let cells = self.values.iter().enumerate();
        cells.map(move |(k, value)| {
            [middle(self.x, k % columns, columns), middle(self.y, k / columns, rows), *value]
        })
    }

    /// Which colour, if there is a value.
    fn level(value: f64, (low, high): (f64, f64)) -> Option<usize> {
        let share = (value - low) / (high - low);
        value.is_finite().then(|| ((share * LEVELS as f64) as usize).min(LEVELS - 1))
    }

    /// Draws the rectangles, those of one colour in a row together; `at` places a point.
    pub(crate) fn draw(&self, svg: &mut Svg, at: impl Fn((f64, f64)) -> (f64, f64)) {
        let range = self.range;
        let rows = self.values.len() / self.columns.max(1);
        let x = |i: usize| self.x.0 + (self.x.1 - self.x.0) * i as f64 / self.columns as f64;
        let y = |j: usize| self.y.0 + (self.y.1 - self.y.0) * j as f64 / rows as f64;
        for (j, row) in self.values.chunks(self.columns.max(1)).enumerate() {
            let levels: Vec<Option<usize>> = row.iter().map(|value| Self::level(*value, range)).collect();
            let mut start = 0;
            for run in levels.chunk_by(|a, b| a == b) {
                let end = start + run.len();
                if let Some(level) = run[0] {
                    let ((l, b), (r, t)) = (at((x(start), y(j))), at((x(end), y(j + 1))));
                    // A little larger, so that no paper shines through between neighbours.
                    let (r, t) = (r + 0.4, t - 0.4);
                    svg.polygon(&[(l, b), (r, b), (r, t), (l, t)], &colour(level), 1.0, None);
                }
                start = end;
            }
        }
    }

    /// Draws the key: from the bottom to the top of the chart, `left` of it the picture.
    pub(crate) fn draw_key(&self, svg: &mut Svg, left: f64, (top, bottom): (f64, f64)) {
        let (low, high) = self.range;
        let at = |share: f64| bottom - share * (bottom - top);
        let (l, r) = (left + 14.0, left + 28.0);
        for level in 0..LEVELS {
            let (b, t) = (at(level as f64 / LEVELS as f64), at((level + 1) as f64 / LEVELS as f64) - 0.4);
            svg.polygon(&[(l, b), (r, b), (r, t), (l, t)], &colour(level), 1.0, None);
        }
        let stroke = Stroke::solid(INK, 0.9);
        svg.path(&[(l, bottom), (r, bottom), (r, top), (l, top), (l, bottom)], &stroke);
        let decimals = if high - low < 1.0 { 2 } else { usize::from(high - low < 20.0) };
        for share in [0.0, 0.5, 1.0] {
            let y = at(share);
            svg.line((r, y), (r + 4.0, y), &stroke);
            let text = Text { size: 13.0, colour: INK, anchor: Anchor::Start, upright: true };
            svg.text((r + 7.0, y + 4.5), &signed(low + share * (high - low), decimals), text);
        }
        let text = Text { size: 13.0, colour: INK, anchor: Anchor::End, upright: true };
        svg.text((left + KEY - 4.0, top - 10.0), &self.label, text);
    }
}

/// From nearly white to dark blue, of even steps in lightness.
fn colour(level: usize) -> String {
    const STOPS: [[f64; 3]; 5] = [
        [240.0, 246.0, 251.0],
        [189.0, 215.0, 236.0],
        [112.0, 169.0, 213.0],
        [45.0, 113.0, 177.0],
        [9.0, 54.0, 112.0],
    ];
    let place = level as f64 / (LEVELS - 1) as f64 * (STOPS.len() - 1) as f64;
    let below = (place as usize).min(STOPS.len() - 2);
    let mix = |i: usize| STOPS[below][i] + (place - below as f64) * (STOPS[below + 1][i] - STOPS[below][i]);
    format!("#{:02x}{:02x}{:02x}", mix(0) as u8, mix(1) as u8, mix(2) as u8)
}
