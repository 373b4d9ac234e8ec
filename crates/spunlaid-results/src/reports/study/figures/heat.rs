//! Results over two factors with many values: a colour map.

use super::quantity::{FactorAxis, QuantityGroup, label_of_key, name_of_key};
use crate::numbers::significant;
use spunlaid_charts::palette::{Colour, INK, PAPER};
use spunlaid_charts::picture::{Anchor, Picture, Stroke, Text};
use spunlaid_charts::{Drawing, Figure, Table};
use spunlaid_experiment::{PointResults, Study};

/// Width on the screen, and room around the map [px].
const WIDTH: f64 = 640.0;
const LEFT: f64 = 84.0;
const TOP: f64 = 22.0;
const BESIDE: f64 = 140.0;
const BELOW: f64 = 70.0;
/// Height of the map over its width.
const RATIO: f64 = 348.0 / 416.0;
/// Dark blue to yellow, readable with any colour vision: matplotlib's viridis at eight values.
const COLOURS: [(f64, f64, f64); 8] = [
    (68.0, 1.0, 84.0),
    (70.0, 50.0, 126.0),
    (54.0, 92.0, 141.0),
    (39.0, 127.0, 142.0),
    (31.0, 161.0, 135.0),
    (74.0, 193.0, 109.0),
    (160.0, 218.0, 57.0),
    (253.0, 231.0, 37.0),
];

/// A map of each result of a group; the first factor is on the vertical axis, the second on the horizontal one.
pub(super) fn maps(study: &Study, results: &[PointResults], group: &QuantityGroup) -> Vec<Figure> {
    group.members.iter().map(|(measure, label)| map(study, results, group, *measure, label)).collect()
}

fn map(
    study: &Study,
    results: &[PointResults],
    group: &QuantityGroup,
    measure: usize,
    label: &str,
) -> Figure {
    let [up, along] = [0, 1].map(|i| study.factors[i].values());
    let value = |i: usize, j: usize| {
        results.get(i * along.len() + j).map_or(f64::NAN, |point| point.mean(measure) * group.unit.per_si)
    };
    let all: Vec<f64> = (0..up.len() * along.len())
        .map(|k| value(k / along.len(), k % along.len()))
        .filter(|value| value.is_finite())
        .collect();
    let (least, most) =
        all.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| (a.min(*value), b.max(*value)));
    let share = |value: f64| if most > least { (value - least) / (most - least) } else { 0.5 };

    let called = label.replace('*', "");
    let which =
        if group.members.len() == 2 { format!("{} in {called}", group.title) } else { group.title.clone() };
    let names = [0, 1].map(|i| name_of_key(&study.factors[i].key.name));
    let title = format!("{which} over {} and {}", names[1], names[0]);
    let [of_up, of_along] = [0, 1].map(|i| FactorAxis::from_study(study, i));
    let labels = |axis: &FactorAxis, values: &[f64]| -> Vec<String> {
        values.iter().map(|value| significant(axis.place(*value), 3)).collect()
    };
    let heat = Heat {
        title: title.clone(),
        labels: [of_up.axis.label.clone(), of_along.axis.label.clone()],
        up: labels(&of_up, &up),
        along: labels(&of_along, &along),
        shares: (0..up.len() * along.len())
            .map(|k| Some(value(k / along.len(), k % along.len())).filter(|value| value.is_finite()))
            .map(|value| value.map(share))
            .collect(),
        unit: group.unit.shown,
        ends: (least, most),
    };
    let caption = format!(
        "{which}, mean over the replicates, over {} (horizontal) and {} (vertical). The values and their standard \
         errors are in results.csv.",
        spunlaid_charts::label::plain(&label_of_key(&study.factors[1].key.name)),
        spunlaid_charts::label::plain(&label_of_key(&study.factors[0].key.name)),
    );
    let axis =
        if group.members.len() == 2 { format!("_{}", called.replace(' ', "_")) } else { String::new() };
    let columns = [of_along.axis.column(), of_up.axis.column(), group.axis().column(), "error".to_owned()];
    let mut table = Table::new(columns);
    table.add(
        &called,
        results.iter().enumerate().map(|(k, point)| {
            let (value, error) = group.value(point, measure);
            let (i, j) = (k / along.len(), k % along.len());
            [of_along.place(along[j]), of_up.place(up[i]), value, error.unwrap_or(f64::NAN)]
        }),
    );
    let drawing = Drawing::new(WIDTH, move |width| heat.picture(width));
    Figure::drawn(&format!("{}{axis}_map", group.figure.name), &title, drawing, table, caption)
}

/// A map as it is drawn.
struct Heat {
    title: String,
    /// Of the axis up and of the axis along.
    labels: [String; 2],
    /// Of the rows, the lowest first, and of the columns.
    up: Vec<String>,
    along: Vec<String>,
    /// How far each value lies between the ends, row by row from the lowest; none where there is no value.
    shares: Vec<Option<f64>>,
    unit: &'static str,
    ends: (f64, f64),
}

impl Heat {
    /// The map, so many pixels wide.
    fn picture(&self, width: f64) -> Picture {
        let left = LEFT;
        let top = TOP;
        let right = width - BESIDE;
        let bottom = top + (right - left) * RATIO;
        let mut picture = Picture::new(width, bottom + BELOW, &self.title);
        let (rows, columns) = (self.up.len(), self.along.len());
        let (w, h) = ((right - left) / columns as f64, (bottom - top) / rows as f64);
        for (k, share) in self.shares.iter().enumerate() {
            let (i, j) = (k / columns, k % columns);
            let (x, y) = (left + j as f64 * w, bottom - (i + 1) as f64 * h);
            // The small overlap prevents visible gaps.
            let fill = share.map_or(PAPER, colour);
            rectangle(&mut picture, (x, y), (w + 0.3, h + 0.3), fill);
        }
        let text = |anchor| Text { size: 13.0, colour: INK, anchor, upright: true };
        // Labels along are wider than high.
        for j in some(columns, (8.0 * width / WIDTH) as usize) {
            let x = left + (j as f64 + 0.5) * w;
            picture.text((x, bottom + 18.0), &self.along[j], text(Anchor::Middle));
        }
        for i in some(rows, 8) {
            let y = bottom - (i as f64 + 0.5) * h + 4.5;
            picture.text((left - 8.0, y), &self.up[i], text(Anchor::End));
        }
        let title_text = |upright| Text { size: 14.0, colour: INK, anchor: Anchor::Middle, upright };
        let [up, along] = &self.labels;
        picture.text(((left + right) / 2.0, bottom + 42.0), along, title_text(true));
        picture.text((18.0, (top + bottom) / 2.0), up, title_text(false));
        self.draw_scale(&mut picture, right, (top, bottom));
        picture
    }

    /// The colour scale.
    fn draw_scale(&self, picture: &mut Picture, right: f64, (top, bottom): (f64, f64)) {
        let (least, most) = self.ends;
        let left = right + 24.0;
        let width = 16.0;
        let steps = 64;
        let height = (bottom - top) / f64::from(steps);
        for k in 0..steps {
            let y = bottom - f64::from(k + 1) * height;
            rectangle(picture, (left, y), (width, height + 0.3), colour(f64::from(k) / f64::from(steps - 1)));
        }
        let style = Text { size: 13.0, colour: INK, anchor: Anchor::Start, upright: true };
        for k in 0..=4 {
            let share = f64::from(k) / 4.0;
            let y = bottom - share * (bottom - top);
            picture.line((left + width, y), (left + width + 4.0, y), &Stroke::solid(INK, 0.9));
            if least.is_finite() {
                let value = significant(least + share * (most - least), 3);
                picture.text((left + width + 8.0, y + 4.5), &value, style);
            }
        }
        picture.text((left, bottom + 18.0), self.unit, style);
    }
}

fn rectangle(picture: &mut Picture, (x, y): (f64, f64), (w, h): (f64, f64), fill: Colour) {
    picture.polygon(&[(x, y), (x + w, y), (x + w, y + h), (x, y + h)], fill, 1.0, None);
}

fn colour(share: f64) -> Colour {
    let place = share.clamp(0.0, 1.0) * (COLOURS.len() - 1) as f64;
    let below = (place.floor() as usize).min(COLOURS.len() - 2);
    let a = COLOURS[below];
    let b = COLOURS[below + 1];
    let rest = place - below as f64;
    let mixed = |a: f64, b: f64| (a + (b - a) * rest).round() as u8;
    Colour([mixed(a.0, b.0), mixed(a.1, b.1), mixed(a.2, b.2)])
}

/// Indices of at most so many evenly spaced labels.
fn some(count: usize, most: usize) -> impl Iterator<Item = usize> {
    let stride = count.div_ceil(most.max(1)).max(1);
    (0..count).step_by(stride)
}
