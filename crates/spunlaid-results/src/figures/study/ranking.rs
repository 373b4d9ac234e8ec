//! Main effects of the factors with their confidence intervals, the largest at the top.

use super::quantity::{FactorAxis, Group, label_of_key};
use crate::figures::with_unit;
use crate::numbers::range;
use spunlaid::study::{Effect, Ranking, Study};
use spunlaid_charts::{
    Axis, Drawing, Figure, Marker, Scale, Table,
    label::{lines, width as width_of},
    palette::{BLUE, Colour, GREY, GRID, INK, VERMILION},
    picture::{Anchor, Picture, Stroke, Text},
};

const WIDTH: f64 = 640.0;
const ROW: f64 = 46.0;
const TOP: f64 = 40.0;
const SIZE: f64 = 14.0;
const SMALL: f64 = 12.0;
const LINE: f64 = 18.0;

/// What is compared: `5 to 30 m/s`, `sakiadis instead of matsui`.
fn change_of(study: &Study, effect: &Effect) -> String {
    let factor = &study.factors[effect.factor];
    let [from, to] = [effect.from, effect.to];
    if factor.words.is_empty() {
        let place = FactorAxis::new(factor, None);
        return format!("{} {}", range(place.place(from), place.place(to)), place.unit).trim_end().to_owned();
    }
    format!("{} instead of {}", factor.input().pretty(to), factor.input().pretty(from))
}

/// The effects of all factors on a group of results.
pub(super) fn figure(study: &Study, rankings: &[Ranking], group: &Group) -> Figure {
    let of_measure = |measure: usize| rankings.iter().find(|ranking| ranking.measure == measure);
    let shown: Vec<(&Ranking, Marker, Colour, &str)> = (group.members.iter())
        .zip([(Marker::Circle, BLUE), (Marker::Triangle, VERMILION)])
        .filter_map(|((measure, label), (marker, colour))| {
            Some((of_measure(*measure)?, marker, colour, label.as_str()))
        })
        .collect();
    let order: &[Effect] = shown.first().map_or(&[], |first| &first.0.effects);
    let ends = |effect: &Effect| {
        let half = effect.half_width.unwrap_or(0.0);
        [effect.change - half, effect.change + half].map(|end| end * group.unit.per_si)
    };
    let with_words = study.factors.iter().any(|factor| !factor.words.is_empty());
    // With words, the change is given below each factor.
    let change = if with_words { "" } else { " from the least to the greatest value" };
    let label = with_unit(&format!("Change of {}{change}", group.figure.words), group.unit.shown);
    let all = shown.iter().flat_map(|shown| shown.0.effects.iter().flat_map(ends)).chain([0.0]);
    let title = format!("Effects on the {}", group.figure.words);
    let row = |main_effect: &Effect| Row {
        name: label_of_key(&study.factors[main_effect.factor].key),
        change: change_of(study, main_effect),
        bars: (shown.iter().enumerate())
            .filter_map(|(index, (ranking, marker, colour, _))| {
                let effect = ranking.effects.iter().find(|effect| effect.is_like(main_effect))?;
                let down = if shown.len() == 1 { 0.0 } else { 16.0 * index as f64 - 8.0 };
                let value = effect.change * group.unit.per_si;
                Some(Bar { down, ends: ends(effect), value, marker: *marker, colour: *colour })
            })
            .collect(),
    };
    let effects = Effects {
        title: title.clone(),
        keys: shown
            .iter()
            .map(|(_, marker, colour, label)| (*marker, *colour, (*label).to_owned()))
            .collect(),
        rows: order.iter().map(row).collect(),
        axis: Axis::linear(&label),
        values: all.collect(),
    };
    let explained: Vec<String> = shown
        .iter()
        .filter(|(ranking, ..)| ranking.explained.is_finite())
        .map(|(ranking, .., label)| {
            let whose =
                if label.is_empty() { String::new() } else { format!(" in {}", label.replace('*', "")) };
            format!("{:.0} %{whose}", 100.0 * ranking.explained)
        })
        .collect();
    let explained = if explained.is_empty() {
        String::new()
    } else {
        format!(
            " Straight lines explain {} of the variation between points; if that is little, look at the curves instead.",
            explained.join(" and ")
        )
    };
    let of_words = if with_words {
        " For a factor of words it is the change of the mean from one word to another."
    } else {
        ""
    };
    let caption = format!(
        "Change of the {} from the least to the greatest value of each factor, on the straight line that fits the points \
         best while the other factors stay constant.{of_words} The bars are 95 % confidence intervals; if a bar crosses zero, there \
         may be no effect.{explained}",
        group.figure.words,
    );
    let change = Axis::linear(&with_unit("Change", group.unit.shown));
    let mut table = Table::new([change.column(), "error".to_owned()]);
    for (ranking, .., label) in &shown {
        for effect in &ranking.effects {
            let half = effect.half_width.unwrap_or(f64::NAN) * group.unit.per_si;
            let factor = &study.factors[effect.factor];
            let words = if factor.words.is_empty() {
                String::new()
            } else {
                format!(": {}", change_of(study, effect))
            };
            let series = format!("{} over {}{words}", label.replace('*', ""), factor.key);
            table.add(&series, [[effect.change * group.unit.per_si, half]]);
        }
    }
    let drawing = Drawing::new(WIDTH, move |width| effects.picture(width));
    Figure::drawn(&format!("{}_ranking", group.figure.name), &title, drawing, table, caption)
}

/// The effects as they are drawn.
struct Effects {
    title: String,
    /// Marker, colour and label of each result.
    keys: Vec<(Marker, Colour, String)>,
    rows: Vec<Row>,
    axis: Axis,
    /// All that lies on the axis.
    values: Vec<f64>,
}

/// A factor with its bars.
struct Row {
    name: String,
    change: String,
    bars: Vec<Bar>,
}

/// An effect with its interval.
struct Bar {
    /// How far below the middle of its row [px].
    down: f64,
    ends: [f64; 2],
    value: f64,
    marker: Marker,
    colour: Colour,
}

impl Effects {
    /// The picture, so many pixels wide.
    fn picture(&self, width: f64) -> Picture {
        let label = lines(&self.axis.label, SIZE, width - 40.0);
        let below = 40.0 + LINE * label.len() as f64;
        let height = TOP + ROW * self.rows.len() as f64 + below;
        let mut picture = Picture::new(width, height, &self.title);
        let names =
            self.rows.iter().flat_map(|row| [width_of(&row.name, SIZE), width_of(&row.change, SMALL)]);
        let left = names.fold(120.0, f64::max).min(0.5 * width) + 24.0;
        let (right, bottom) = (width - 20.0, height - below);
        let count = (7.0 * ((right - left) / 330.0).min(1.0)).round() as usize;
        let scale = Scale::fit(&self.axis, self.values.iter().copied(), count);
        let along = |value: f64| left + scale.place(value) * (right - left);

        for tick in scale.ticks.iter().filter(|tick| tick.label.is_some()) {
            let x = along(tick.value);
            picture.line((x, TOP), (x, bottom), &Stroke::solid(GRID, 0.8));
            let style = Text { size: 13.0, colour: INK, anchor: Anchor::Middle, upright: true };
            picture.text((x, bottom + 20.0), tick.label.as_deref().unwrap_or_default(), style);
        }
        picture.line((along(0.0), TOP), (along(0.0), bottom), &Stroke::solid(GREY, 1.2));
        picture.line((left, bottom), (right, bottom), &Stroke::solid(INK, 0.9));
        let longest = label.iter().map(|line| width_of(line, SIZE)).fold(0.0, f64::max);
        let middle = (0.5 * (left + right)).min(width - 20.0 - 0.5 * longest);
        for (number, line) in label.iter().enumerate() {
            let style = Text { size: SIZE, colour: INK, anchor: Anchor::Middle, upright: true };
            picture.text((middle, bottom + 44.0 + LINE * number as f64), line, style);
        }

        let mut key = left;
        for (marker, colour, label) in self.keys.iter().filter(|(.., label)| !label.is_empty()) {
            picture.marker((key + 8.0, 18.0), *marker, *colour);
            let style = Text { size: 13.0, colour: INK, anchor: Anchor::Start, upright: true };
            picture.text((key + 20.0, 22.5), label, style);
            key += 60.0;
        }
        for (number, row) in self.rows.iter().enumerate() {
            let y = TOP + ROW * (number as f64 + 0.5);
            let name = Text { size: SIZE, colour: INK, anchor: Anchor::End, upright: true };
            picture.text((left - 12.0, y - 2.0), &row.name, name);
            let style = Text { size: SMALL, colour: GREY, anchor: Anchor::End, upright: true };
            for (line, words) in lines(&row.change, SMALL, left - 16.0).iter().enumerate() {
                picture.text((left - 12.0, y + 14.0 * (line as f64 + 1.0)), words, style);
            }
            for bar in &row.bars {
                let y = y + bar.down;
                let [low, high] = bar.ends.map(along);
                let stroke = Stroke::solid(bar.colour, 1.4);
                picture.line((low, y), (high, y), &stroke);
                for end in [low, high] {
                    picture.line((end, y - 3.5), (end, y + 3.5), &stroke);
                }
                picture.marker((along(bar.value), y), bar.marker, bar.colour);
            }
        }
        picture
    }
}
