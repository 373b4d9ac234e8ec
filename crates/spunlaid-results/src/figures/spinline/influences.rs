//! What decides the diameter: a bar for each number of the line.

use spunlaid::input::{Change, Influence};
use spunlaid_charts::{
    Axis, Drawing, Figure, Scale, Table,
    label::{plain, width as width_of},
    palette::{BLUE, GREY, GRID, INK, VERMILION},
    picture::{Anchor, Picture, Stroke, Text},
    signed,
};

const WIDTH: f64 = 720.0;
const ROW: f64 = 26.0;
/// Height of a bar [px].
const BAR: f64 = 15.0;
/// Room above the bars for the words of the panel, and below them for ticks and label.
const ABOVE: f64 = 34.0;
const BELOW: f64 = 58.0;
const SIZE: f64 = 13.5;
const SMALL: f64 = 12.5;
/// Most bars of a panel; the table has all.
const MOST: usize = 16;

/// The numbers that are changed in one way.
struct Panel {
    title: &'static str,
    label: &'static str,
    /// From the number of an influence to that of the axis.
    factor: f64,
    decimals: usize,
    influences: Vec<Influence>,
}

impl Panel {
    fn height(&self) -> f64 {
        ABOVE + ROW * self.influences.len() as f64 + BELOW
    }
}

/// The influences on the diameter, relative changes and those of 10 K apart.
pub(super) fn figure(prefix: &str, influences: &[Influence]) -> Figure {
    let changed = |change: Change| -> Vec<Influence> {
        influences.iter().filter(|influence| influence.change == change).take(MOST).cloned().collect()
    };
    let panels = [
        Panel {
            title: "1 % more of",
            label: "Change of the diameter (%)",
            factor: 1.0,
            decimals: 2,
            influences: changed(Change::Relative),
        },
        Panel {
            title: "10 K more of",
            label: "Change of the diameter (%)",
            factor: 100.0,
            decimals: 1,
            influences: changed(Change::TenKelvin),
        },
    ];
    let panels: Vec<Panel> = panels.into_iter().filter(|panel| !panel.influences.is_empty()).collect();
    let title = "What decides the diameter";
    let left_out = influences.len() - panels.iter().map(|panel| panel.influences.len()).sum::<usize>();
    let others = if left_out > 0 { " Weaker ones are in the numbers of the figure." } else { "" };
    let caption = format!(
        "Relative change of the diameter of the cold filament when one number changes and all others stay, by small changes of the \
         model: d ln d / d ln x, and the change for 10 K. Blue is finer, orange is thicker.{others} These are slopes: they hold for \
         small changes."
    );
    let drawing = Drawing::new(WIDTH, move |width| picture(title, &panels, width));
    Figure::drawn(&format!("{prefix}_influences"), title, drawing, table(influences), caption)
}

/// The panels one above the other, so many pixels wide.
fn picture(title: &str, panels: &[Panel], width: f64) -> Picture {
    let influences = || panels.iter().flat_map(|panel| &panel.influences);
    let names = influences().map(|influence| width_of(influence.label, SIZE));
    let left = names.fold(120.0, f64::max).min(0.55 * width) + 22.0;
    let mut picture = Picture::new(width, panels.iter().map(Panel::height).sum(), title);
    let mut top = 0.0;
    for panel in panels {
        picture.open_shifted(top);
        draw(&mut picture, panel, left, width - 12.0);
        picture.close();
        top += panel.height();
    }
    picture
}

fn draw(picture: &mut Picture, panel: &Panel, left: f64, right: f64) {
    let value = |influence: &Influence| influence.diameter * panel.factor;
    // Room for the numbers at the ends of the bars.
    const ROOM: f64 = 52.0;
    let (inner_left, inner_right) = (left + ROOM, right - ROOM);
    let values = panel.influences.iter().map(value).chain([0.0]);
    let count = ((inner_right - inner_left) / 60.0).clamp(2.0, 5.0) as usize;
    let scale = Scale::fit(&Axis::linear(panel.label).tight(), values, count);
    let bottom = panel.height() - BELOW;
    let along = |value: f64| inner_left + scale.place(value) * (inner_right - inner_left);

    let heading = Text { size: SIZE, colour: GREY, anchor: Anchor::End, upright: true };
    picture.text((left - 10.0, ABOVE - 14.0), panel.title, heading);
    for tick in scale.ticks.iter().filter(|tick| tick.label.is_some()) {
        let x = along(tick.value);
        picture.line((x, ABOVE - 4.0), (x, bottom), &Stroke::solid(GRID, 0.8));
        let style = Text { size: SMALL, colour: INK, anchor: Anchor::Middle, upright: true };
        picture.text((x, bottom + 19.0), tick.label.as_deref().unwrap_or_default(), style);
    }
    picture.line((left, bottom), (right, bottom), &Stroke::solid(INK, 0.9));
    for (row, influence) in panel.influences.iter().enumerate() {
        let y = ABOVE + ROW * (row as f64 + 0.5);
        let name = Text { size: SIZE, colour: INK, anchor: Anchor::End, upright: true };
        picture.text((left - 10.0, y + 4.5), influence.label, name);
        let (from, to, value) = (along(0.0), along(value(influence)), value(influence));
        let colour = if value < 0.0 { BLUE } else { VERMILION };
        picture.rectangles(&[((from.min(to), y - 0.5 * BAR), (from.max(to), y + 0.5 * BAR))], colour);
        let (x, anchor) = if value < 0.0 { (to - 6.0, Anchor::End) } else { (to + 6.0, Anchor::Start) };
        let style = Text { size: SMALL, colour: INK, anchor, upright: true };
        let plus = if value > 0.0 { "+" } else { "" };
        picture.text((x, y + 4.5), &format!("{plus}{}", signed(value, panel.decimals)), style);
    }
    picture.line((along(0.0), ABOVE - 4.0), (along(0.0), bottom), &Stroke::solid(GREY, 1.2));
    let style = Text { size: SIZE, colour: INK, anchor: Anchor::Middle, upright: true };
    picture.text(((inner_left + inner_right) / 2.0, bottom + 42.0), panel.label, style);
}

/// All influences, on the diameter and on the speed.
fn table(influences: &[Influence]) -> Table {
    let mut table = Table::new([
        "diameter_dlnd_dlnx",
        "speed_dlnv_dlnx",
        "diameter_percent_per_10_k",
        "speed_percent_per_10_k",
    ]);
    for Influence { label, change, diameter, speed, .. } in influences {
        let nan = f64::NAN;
        table.add(
            &plain(label),
            [match change {
                Change::Relative => [*diameter, *speed, nan, nan],
                Change::TenKelvin => [nan, nan, 100.0 * diameter, 100.0 * speed],
            }],
        );
    }
    table
}
