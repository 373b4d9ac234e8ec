//! What matters: a row for each change, with a mark for each of its effects: a bar from zero, or the value
//! with its 95 % confidence interval. Keys of a study, settings and assumed values of a web, and the numbers of a
//! spinline are drawn by it.

use spunlaid_charts::label::{lines, width as width_of};
use spunlaid_charts::palette::{BLUE, Colour, GREY, GRID, INK, VERMILION};
use spunlaid_charts::picture::{Anchor, Picture, Stroke, Text};
use spunlaid_charts::{Axis, Drawing, Figure, Marker, Scale, Table, signed};
use spunlaid_ground::Difference;

const WIDTH: f64 = 720.0;
/// Height of a row, and of one of bars alone, with that of a bar.
const ROW: f64 = 46.0;
const LOW_ROW: f64 = 26.0;
const BAR: f64 = 15.0;
/// Room above the rows for the words of the panel.
const TOP: f64 = 40.0;
/// Room at the ends of bars for their numbers.
const ROOM: f64 = 52.0;
const SIZE: f64 = 14.0;
const SMALL: f64 = 12.0;
const LINE: f64 = 18.0;
/// The marks of the first and of the second effect of a row.
const MARKS: [(Marker, Colour); 2] = [(Marker::Circle, BLUE), (Marker::Triangle, VERMILION)];

/// A figure of effects.
pub(crate) struct EffectsFigure {
    pub(crate) name: String,
    pub(crate) title: String,
    /// One above the other, for effects of different units.
    pub(crate) panels: Vec<Panel>,
}

/// Effects of one unit.
pub(crate) struct Panel {
    /// Above the names.
    pub(crate) heading: &'static str,
    /// What each effect of a row is; empty if there is only one.
    pub(crate) keys: Vec<String>,
    /// Of the axis.
    pub(crate) label: String,
    pub(crate) rows: Vec<EffectRow>,
    /// Of the numbers at the ends of bars.
    pub(crate) decimals: usize,
}

/// A change with its effects.
pub(crate) struct EffectRow {
    pub(crate) name: String,
    /// What changes, below the name.
    pub(crate) detail: String,
    /// As many as there are keys, in the unit of the axis; None of one that is not known.
    pub(crate) effects: Vec<Option<Difference>>,
}

/// A difference in another unit.
pub(crate) fn in_unit(difference: &Difference, factor: f64) -> Difference {
    let value = factor * difference.value;
    let standard_error = factor * difference.standard_error;
    Difference { value, standard_error, ..*difference }
}

impl EffectsFigure {
    /// * `table` – the numbers
    pub(crate) fn figure(self, table: Table, caption: String) -> Figure {
        let (name, title) = (self.name.clone(), self.title.clone());
        Figure::drawn(&name, &title, Drawing::new(WIDTH, move |width| self.picture(width)), table, caption)
    }

    /// The picture, so many pixels wide.
    fn picture(&self, width: f64) -> Picture {
        let rows = self.panels.iter().flat_map(|panel| &panel.rows);
        let names = rows.flat_map(|row| [width_of(&row.name, SIZE), width_of(&row.detail, SMALL)]);
        let left = names.fold(120.0, f64::max).min(0.5 * width) + 24.0;
        let height = |panel: &Panel| panel.bottom() + 40.0 + LINE * panel.words(width).len() as f64;
        let mut picture = Picture::new(width, self.panels.iter().map(height).sum(), &self.title);
        let mut top = 0.0;
        for panel in &self.panels {
            picture.open_shifted(top);
            panel.draw(&mut picture, left, width);
            picture.close();
            top += height(panel);
        }
        picture
    }
}

impl Panel {
    /// Whether the effects are bars from zero, because they have no error.
    fn has_bars(&self) -> bool {
        self.effects().all(|effect| effect.half_width() == 0.0)
    }

    fn effects(&self) -> impl Iterator<Item = &Difference> {
        self.rows.iter().flat_map(|row| row.effects.iter().flatten())
    }

    fn row(&self) -> f64 {
        if self.rows.iter().all(|row| row.detail.is_empty()) { LOW_ROW } else { ROW }
    }

    /// Where the rows end.
    fn bottom(&self) -> f64 {
        TOP + self.row() * self.rows.len() as f64
    }

    /// The lines of the label of the axis.
    fn words(&self, width: f64) -> Vec<String> {
        lines(&self.label, SIZE, width - 40.0)
    }

    fn draw(&self, picture: &mut Picture, left: f64, width: f64) {
        let text = |size, colour, anchor| Text { size, colour, anchor, upright: true };
        let (right, bottom) = (width - 20.0, self.bottom());
        let room = if self.has_bars() { ROOM } else { 0.0 };
        let (inner_left, inner_right) = (left + room, right - room);
        let ends = |effect: &Difference| {
            let half = effect.known_half_width().unwrap_or(0.0);
            [effect.value - half, effect.value + half]
        };
        let count = (7.0 * ((inner_right - inner_left) / 330.0).min(1.0)).round().max(2.0) as usize;
        let axis = Axis::linear(&self.label);
        let axis = if self.has_bars() { axis.tight() } else { axis };
        let scale = Scale::fit(&axis, self.effects().flat_map(ends).chain([0.0]), count);
        let along = |value: f64| inner_left + scale.place(value) * (inner_right - inner_left);

        for tick in scale.ticks.iter().filter(|tick| tick.label.is_some()) {
            let x = along(tick.value);
            picture.line((x, TOP), (x, bottom), &Stroke::solid(GRID, 0.8));
            let label = tick.label.as_deref().unwrap_or_default();
            picture.text((x, bottom + 20.0), label, text(13.0, INK, Anchor::Middle));
        }
        picture.line((along(0.0), TOP), (along(0.0), bottom), &Stroke::solid(GREY, 1.2));
        picture.line((left, bottom), (right, bottom), &Stroke::solid(INK, 0.9));
        let words = self.words(width);
        let longest = words.iter().map(|line| width_of(line, SIZE)).fold(0.0, f64::max);
        let middle = (0.5 * (left + right)).min(width - 20.0 - 0.5 * longest);
        for (number, line) in words.iter().enumerate() {
            let y = bottom + 44.0 + LINE * number as f64;
            picture.text((middle, y), line, text(SIZE, INK, Anchor::Middle));
        }
        picture.text((left - 12.0, 22.5), self.heading, text(SIZE, GREY, Anchor::End));
        let mut key = left;
        for (label, (marker, colour)) in self.keys.iter().zip(MARKS) {
            picture.marker((key + 8.0, 18.0), marker, colour);
            picture.text((key + 20.0, 22.5), label, text(13.0, INK, Anchor::Start));
            key += 40.0 + width_of(label, 13.0).max(20.0);
        }
        for (number, row) in self.rows.iter().enumerate() {
            let y = TOP + self.row() * (number as f64 + 0.5);
            let up = if row.detail.is_empty() { -4.5 } else { 2.0 };
            picture.text((left - 12.0, y - up), &row.name, text(SIZE, INK, Anchor::End));
            for (line, words) in lines(&row.detail, SMALL, left - 16.0).iter().enumerate() {
                let y = y + 14.0 * (line as f64 + 1.0);
                picture.text((left - 12.0, y), words, text(SMALL, GREY, Anchor::End));
            }
            for (index, (effect, (marker, colour))) in row.effects.iter().zip(MARKS).enumerate() {
                let Some(effect) = effect else { continue };
                let (from, to) = (along(0.0), along(effect.value));
                if self.has_bars() {
                    let colour = if effect.value < 0.0 { BLUE } else { VERMILION };
                    let bar = ((from.min(to), y - 0.5 * BAR), (from.max(to), y + 0.5 * BAR));
                    picture.rectangles(&[bar], colour);
                    let (x, anchor, plus) = match effect.value < 0.0 {
                        true => (to - 6.0, Anchor::End, ""),
                        false => (to + 6.0, Anchor::Start, "+"),
                    };
                    let number = format!("{plus}{}", signed(effect.value, self.decimals));
                    picture.text((x, y + 4.5), &number, text(SMALL, INK, anchor));
                    continue;
                }
                let y = if row.effects.len() == 1 { y } else { y + 16.0 * index as f64 - 8.0 };
                let ends = ends(effect).map(along);
                let stroke = Stroke::solid(colour, 1.4);
                picture.line((ends[0], y), (ends[1], y), &stroke);
                for end in ends {
                    picture.line((end, y - 3.5), (end, y + 3.5), &stroke);
                }
                picture.marker((to, y), marker, colour);
            }
        }
    }
}
