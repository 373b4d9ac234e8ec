//! A rose: how often each direction occurs, as wedges around a centre.

use crate::figure::{Drawing, Figure};
use crate::label::width as width_of;
use crate::numbers::shortest;
use crate::palette::{BLUE, GREY, GRID, INK, PAPER};
use crate::picture::{Anchor, Picture, Stroke, Text};
use crate::table::Table;
use std::f64::consts::{PI, TAU};

/// Width on the screen [px], and what lies beside, above and below the outermost ring.
const WIDTH: f64 = 580.0;
const BESIDE: f64 = 105.0;
const ABOVE: f64 = 29.0;
const BELOW: f64 = 61.0;
/// Most rings.
const RINGS: f64 = 5.0;

/// Values over classes of direction, all as wide, counter-clockwise; the first begins at the right.
#[derive(Clone, Debug)]
pub struct Rose {
    /// File name without ending.
    pub name: String,
    /// A few words.
    pub title: String,
    /// The value of each class, and its error if it is known. NaN where there is none.
    pub classes: Vec<(f64, Option<f64>)>,
    /// A value with a dashed ring of its own, and what it is.
    pub reference: Option<(f64, String)>,
    /// What lies to the right, up, to the left and down.
    pub sides: [String; 4],
    /// Names of the columns of the table: direction and value.
    pub columns: [String; 2],
    /// Name of the series in the table.
    pub series: String,
}

impl Rose {
    /// The figure. Wedges are as long as their values.
    pub fn figure(&self, caption: impl Into<String>) -> Figure {
        let rose = self.clone();
        let drawing = Drawing::new(WIDTH, move |width| rose.picture(width));
        Figure::drawn(&self.name, &self.title, drawing, self.table(), caption)
    }

    fn picture(&self, width: f64) -> Picture {
        let disc = Disc { radius: 0.5 * width - BESIDE };
        let mut picture = Picture::new(width, ABOVE + 2.0 * disc.radius + BELOW, &self.title);
        let reference = self.reference.as_ref().map_or(0.0, |reference| reference.0);
        let values = self.classes.iter().map(|class| class.0).filter(|value| value.is_finite());
        let largest = values.fold(reference, f64::max);
        let step = ring_step(largest);
        let rings = (largest / step - 1e-9).ceil().max(1.0);
        let at = |value: f64| value / (rings * step) * disc.radius;
        self.draw_wedges(&mut picture, disc, at);
        let grid = Stroke::solid(GREY, 0.5);
        for ring in 1..=rings as u32 {
            picture.path(&disc.circle(at(f64::from(ring) * step)), &grid);
        }
        for turn in 0..4 {
            let far = disc.place(disc.radius, f64::from(turn) * PI / 2.0);
            picture.line(disc.centre(), far, &grid);
        }
        if let Some((value, _)) = &self.reference {
            picture.path(&disc.circle(at(*value)), &Stroke { colour: INK, width: 1.3, dash: &[5.0, 4.0] });
        }
        self.draw_labels(&mut picture, disc, [rings, step], at);
        picture
    }

    fn draw_wedges(&self, picture: &mut Picture, disc: Disc, at: impl Fn(f64) -> f64) {
        let width = TAU / self.classes.len().max(1) as f64;
        let edge = Stroke::solid(BLUE, 0.8);
        for (i, (value, _)) in self.classes.iter().enumerate() {
            if !(value.is_finite() && *value > 0.0) {
                continue;
            }
            let mut corners = vec![disc.centre()];
            // Arcs of three degrees cannot be distinguished from a circle.
            let parts = (width / (TAU / 120.0)).ceil().max(1.0) as usize;
            let angle = |k: usize| width * (i as f64 + k as f64 / parts as f64);
            corners.extend((0..=parts).map(|k| disc.place(at(*value), angle(k))));
            picture.polygon(&corners, BLUE, 0.28, Some(&edge));
        }
    }

    fn draw_labels(
        &self,
        picture: &mut Picture,
        disc: Disc,
        [rings, step]: [f64; 2],
        at: impl Fn(f64) -> f64,
    ) {
        let radius = disc.radius;
        let text = |anchor, colour, size| Text { size, colour, anchor, upright: true };
        for ring in 1..=rings as u32 {
            let value = f64::from(ring) * step;
            let (x, y) = disc.place(at(value), PI * 0.375);
            // Readable on the wedges below.
            let label = shortest((value * 1e6).round() / 1e6);
            let half = 0.5 * width_of(&label, 12.0) + 2.0;
            let box_ = [(x - half, y - 8.0), (x + half, y - 8.0), (x + half, y + 7.0), (x - half, y + 7.0)];
            picture.polygon(&box_, PAPER, 0.8, None);
            picture.text((x, y + 4.0), &label, text(Anchor::Middle, GREY, 12.0));
        }
        let [right, up, left, down] = &self.sides;
        let (x, y) = disc.centre();
        picture.text((x + radius + 8.0, y + 5.0), right, text(Anchor::Start, INK, 13.0));
        picture.text((x, y - radius - 10.0), up, text(Anchor::Middle, INK, 13.0));
        picture.text((x - radius - 8.0, y + 5.0), left, text(Anchor::End, INK, 13.0));
        picture.text((x, y + radius + 22.0), down, text(Anchor::Middle, INK, 13.0));
        if let Some((_, words)) = &self.reference {
            let y = y + radius + BELOW - 9.0;
            let width = width_of(words, 13.0);
            let left = x - 0.5 * (width + 34.0);
            picture.line(
                (left, y - 4.5),
                (left + 28.0, y - 4.5),
                &Stroke { colour: INK, width: 1.3, dash: &[5.0, 4.0] },
            );
            picture.text((left + 34.0, y), words, text(Anchor::Start, INK, 13.0));
        }
        if self.classes.iter().all(|class| !class.0.is_finite()) {
            let box_ =
                [(x - 90.0, y - 14.0), (x + 90.0, y - 14.0), (x + 90.0, y + 12.0), (x - 90.0, y + 12.0)];
            picture.polygon(&box_, PAPER, 1.0, Some(&Stroke::solid(GRID, 0.8)));
            picture.text((x, y + 4.0), "no values to show", text(Anchor::Middle, GREY, 14.0));
        }
    }

    fn table(&self) -> Table {
        let [direction, value] = &self.columns;
        let mut table = Table::new([direction.as_str(), value, "error"]);
        let width = 360.0 / self.classes.len().max(1) as f64;
        let rows = self.classes.iter().enumerate();
        let row = |(i, (value, error)): (usize, &(f64, Option<f64>))| {
            [(i as f64 + 0.5) * width, *value, error.unwrap_or(f64::NAN)]
        };
        table.add(&self.series, rows.map(row));
        table
    }
}

/// A round step of at most [`RINGS`] rings.
fn ring_step(largest: f64) -> f64 {
    let rough = largest / RINGS;
    if !(rough > 0.0 && rough.is_finite()) {
        return 1.0;
    }
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0].into_iter().find(|step| step * power >= rough * (1.0 - 1e-9));
    step.unwrap_or(10.0) * power
}

/// The outermost ring.
#[derive(Clone, Copy)]
struct Disc {
    /// [px].
    radius: f64,
}

impl Disc {
    fn centre(self) -> (f64, f64) {
        (self.radius + BESIDE, self.radius + ABOVE)
    }

    /// A point at a distance from the centre [px], in a direction [rad].
    fn place(self, distance: f64, angle: f64) -> (f64, f64) {
        let (x, y) = self.centre();
        (x + distance * angle.cos(), y - distance * angle.sin())
    }

    fn circle(self, radius: f64) -> Vec<(f64, f64)> {
        (0..=120).map(|k| self.place(radius, TAU * f64::from(k) / 120.0)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::svg::svg;

    fn rose(classes: Vec<(f64, Option<f64>)>) -> Rose {
        let words = |text: &str| text.to_owned();
        Rose {
            name: words("rose"),
            title: words("Rose"),
            classes,
            reference: Some((1.0, words("isotropic"))),
            sides: ["right", "up", "left", "down"].map(words),
            columns: ["direction_degrees", "share"].map(words),
            series: words("fibre"),
        }
    }

    #[test]
    fn the_longest_wedge_reaches_as_far_as_its_ring() {
        // Two of four classes: 2 to the upper right, 1 to the lower left. Rings every 0.4 up to 2.
        let rose = rose(vec![(2.0, None), (0.0, None), (1.0, Some(0.1)), (f64::NAN, None)]);
        let figure = rose.figure("");
        let svg = figure.svg();
        let (centre, radius) = ((290.0, 214.0), 185.0);
        let wedges: Vec<&str> = svg.lines().filter(|line| line.contains("fill-opacity=\"0.28\"")).collect();
        assert_eq!(wedges.len(), 2);
        assert!(wedges[0].contains(&format!(
            "M{} {}L{} {}",
            centre.0,
            centre.1,
            centre.0 + radius,
            centre.1
        )));
        assert!(wedges[1].contains(&format!("L{} {}", centre.0 - 0.5 * radius, centre.1)), "{}", wedges[1]);
        assert_eq!(
            figure.table().csv(),
            "series,direction_degrees,share,error\nfibre,45,2,\nfibre,135,0,\nfibre,225,1,0.1\nfibre,315,,\n"
        );
    }

    #[test]
    fn rings_are_round_and_few() {
        for (largest, expected) in [(1.0, 0.2), (1.3, 0.5), (2.0, 0.5), (11.0, 2.5), (36.0, 10.0), (0.0, 1.0)]
        {
            let step = ring_step(largest);
            assert!((step / expected - 1.0).abs() < 1e-9, "{largest}: {step}");
        }
    }

    #[test]
    fn nothing_to_show_is_said() {
        for classes in [vec![], vec![(f64::NAN, None); 36], vec![(f64::INFINITY, None); 4]] {
            let svg = svg(&rose(classes).picture(300.0));
            assert!(svg.contains("no values to show") && !svg.contains("NaN") && !svg.contains("inf"));
        }
    }
}
