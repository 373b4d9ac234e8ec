//! A quantity over a plane, in colours, with their key beside it.

use crate::numbers::signed;
use crate::palette::{Colour, INK};
use crate::picture::{Anchor, Picture, Stroke, Text};

/// Values over a rectangle of the plane.
#[derive(Clone, Debug)]
pub struct Map {
    /// From where to where along.
    pub x: (f64, f64),
    /// From where to where up.
    pub y: (f64, f64),
    /// Number of values in a row.
    pub columns: usize,
    /// Row by row from the lowest y, along x; NaN outside, which is drawn in grey.
    pub values: Vec<f64>,
    /// The lowest and the highest value that colours give.
    pub range: (f64, f64),
    /// What they are.
    pub label: String,
    /// Which colours they have.
    pub shades: Shades,
}

/// The colours of a [`Map`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shades {
    /// From a light to a dark blue.
    #[default]
    Amount,
    /// From brown for the lowest value over a light grey to blue for the highest, where the middle means nothing.
    Signed,
}

/// Room for the key [px].
pub(crate) const KEY: f64 = 84.0;
/// Shades; the eye does not see the step from one to the next.
const LEVELS: usize = 64;
/// Of places without a value: a grey, which no value has.
const OUTSIDE: Colour = Colour([0xc9, 0xc7, 0xc2]);

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

    /// Draws the rectangles; `at` places a point. Those of one shade are one path.
    pub(crate) fn draw(&self, picture: &mut Picture, at: impl Fn((f64, f64)) -> (f64, f64)) {
        let columns = self.columns.max(1);
        let rows = self.values.len() / columns;
        let place = |i: usize, j: usize| {
            let share =
                |ends: (f64, f64), k: usize, n: usize| ends.0 + (ends.1 - ends.0) * k as f64 / n as f64;
            at((share(self.x, i, columns), share(self.y, j, rows)))
        };
        picture.rectangles(&[(place(0, 0), place(columns, rows))], OUTSIDE);
        let mut shades: Vec<Vec<_>> = vec![Vec::new(); LEVELS];
        for (j, row) in self.values.chunks(columns).enumerate() {
            let levels: Vec<Option<usize>> =
                row.iter().map(|value| Self::level(*value, self.range)).collect();
            let mut start = 0;
            for run in levels.chunk_by(|a, b| a == b) {
                let end = start + run.len();
                if let Some(level) = run[0] {
                    shades[level].push((place(start, j), place(end, j + 1)));
                }
                start = end;
            }
        }
        for (level, rectangles) in shades.iter().enumerate().filter(|(_, some)| !some.is_empty()) {
            picture.rectangles(rectangles, self.shades.colour(level));
        }
    }

    /// Draws the key: from the bottom to the top of the chart, `left` of it the picture.
    pub(crate) fn draw_key(&self, picture: &mut Picture, left: f64, (top, bottom): (f64, f64)) {
        let (low, high) = self.range;
        let at = |share: f64| bottom - share * (bottom - top);
        let (l, r) = (left + 14.0, left + 28.0);
        for level in 0..LEVELS {
            let b = at(level as f64 / LEVELS as f64);
            let t = at((level + 1) as f64 / LEVELS as f64);
            picture.rectangles(&[((l, b), (r, t))], self.shades.colour(level));
        }
        let stroke = Stroke::solid(INK, 0.9);
        picture.path(&[(l, bottom), (r, bottom), (r, top), (l, top), (l, bottom)], &stroke);
        let decimals = if high - low < 1.0 { 2 } else { usize::from(high - low < 20.0) };
        for share in [0.0, 0.5, 1.0] {
            let y = at(share);
            picture.line((r, y), (r + 4.0, y), &stroke);
            let text = Text { size: 13.0, colour: INK, anchor: Anchor::Start, upright: true };
            picture.text((r + 7.0, y + 4.5), &signed(low + share * (high - low), decimals), text);
        }
        let text = Text { size: 13.0, colour: INK, anchor: Anchor::End, upright: true };
        picture.text((left + KEY - 4.0, top - 10.0), &self.label, text);
    }
}

/// In even steps of lightness.
const AMOUNT: [[f64; 3]; 5] = [
    [226.0, 238.0, 248.0],
    [189.0, 215.0, 236.0],
    [112.0, 169.0, 213.0],
    [45.0, 113.0, 177.0],
    [9.0, 54.0, 112.0],
];
/// As dark at one end as at the other.
const SIGNED: [[f64; 3]; 5] = [
    [128.0, 56.0, 8.0],
    [224.0, 148.0, 84.0],
    [244.0, 243.0, 240.0],
    [112.0, 169.0, 213.0],
    [9.0, 54.0, 112.0],
];

impl Shades {
    fn colour(self, level: usize) -> Colour {
        let stops = match self {
            Self::Amount => AMOUNT,
            Self::Signed => SIGNED,
        };
        let place = level as f64 / (LEVELS - 1) as f64 * (stops.len() - 1) as f64;
        let below = (place as usize).min(stops.len() - 2);
        let mix =
            |i: usize| stops[below][i] + (place - below as f64) * (stops[below + 1][i] - stops[below][i]);
        Colour([0, 1, 2].map(|i| mix(i) as u8))
    }
}

#[cfg(test)]
mod tests {
    use super::{LEVELS, Map, OUTSIDE, Shades};
    use crate::palette::Colour;
    use crate::picture::Picture;
    use crate::svg::svg;

    #[test]
    fn zero_and_outside_look_different() {
        let values = vec![0.0, f64::NAN, 1.0, 1.0];
        let map = Map {
            x: (0.0, 1.0),
            y: (0.0, 1.0),
            columns: 2,
            values,
            range: (0.0, 1.0),
            label: "".into(),
            shades: Shades::Amount,
        };
        let mut picture = Picture::new(100.0, 100.0, "");
        map.draw(&mut picture, |(x, y)| (100.0 * x, 100.0 * (1.0 - y)));
        let svg = svg(&picture);
        let shade = |fill: Colour| -> String {
            svg.split("<path ").filter(|path| path.contains(&fill.to_string())).collect()
        };
        // Below everything the grey of outside, then a quarter for zero and the upper half for one.
        assert!(shade(OUTSIDE).contains("M0 100H100V0H0Z"), "{svg}");
        assert!(shade(Shades::Amount.colour(0)).contains("M0 100H50V50H0Z"), "{svg}");
        assert!(shade(Shades::Amount.colour(LEVELS - 1)).contains("M0 50H100V0H0Z"), "{svg}");
    }

    #[test]
    fn neighbouring_shades_cannot_be_distinguished() {
        for level in 1..LEVELS {
            for (shades, most) in [(Shades::Amount, 6), (Shades::Signed, 12)] {
                let [a, b] = [level, level - 1].map(|level| shades.colour(level).0);
                let steps = a.into_iter().zip(b).map(|(a, b)| a.abs_diff(b));
                assert!(steps.max() <= Some(most), "{shades:?} {level}");
            }
        }
    }
}
