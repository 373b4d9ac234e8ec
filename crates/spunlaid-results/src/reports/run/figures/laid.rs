//! What a fed fibre leaves on the belt: its trace, and where it comes down.

use super::MM;
use super::measured::one_of;
use crate::numbers::significant;
use spunlaid_charts::palette::{Colour, GREY, INK, VERMILION};
use spunlaid_charts::picture::{Anchor, Picture, Stroke, Text};
use spunlaid_charts::{Axis, Chart, Drawing, Figure, Map, Series, Shades, Table};
use spunlaid_fibre::{Case, LaidPoint};
use spunlaid_simulation::{Results, Trajectory};
use std::f64::consts::TAU;

/// The figures, without those of the measured curves.
pub(super) fn figures(case: &Case, results: &Results) -> Vec<Figure> {
    vec![trace(results), footprint(case, results)]
}

/// Width of the picture of the trace and room around it [px].
const WIDTH: f64 = 760.0;
const MARGIN: f64 = 14.0;
const BELOW: f64 = 40.0;
/// Length of belt that is shown, in widths of the trace.
const ASPECT: f64 = 3.0;
/// The light table and its edge.
const LIGHT: Colour = Colour([0xfd, 0xfa, 0xf0]);
const EDGE: Colour = Colour([0xd8, 0xd2, 0xbf]);

/// The first replicate's trace, as it lies on the belt.
fn trace(results: &Results) -> Figure {
    const NAME: &str = "laid_trace";
    const TITLE: &str = "The laid fibre, as on a light table";
    let points: &[LaidPoint] = results.trajectories.first().map_or(&[], |trajectory| &trajectory.laid);
    let mut table = Table::new(["md_mm", "cd_mm", "fed_m"]);
    let Some(window) = Window::new(points) else {
        let drawing = Drawing::new(WIDTH, |width| {
            let mut picture = Picture::new(width, 120.0, TITLE);
            let style = Text { size: 14.0, colour: GREY, anchor: Anchor::Middle, upright: true };
            picture.text((width / 2.0, 64.0), "too little has been laid to be shown", style);
            picture
        });
        table.add("fibre", std::iter::empty::<[f64; 3]>());
        return Figure::drawn(NAME, TITLE, drawing, table, "Nothing was laid after the spin-up.");
    };
    table.add("fibre", window.points.iter().map(|p| [p.md * MM, p.cd * MM, p.fed]));
    let fed = window.points.last().map_or(0.0, |p| p.fed) - window.points[0].fed;
    let caption = format!(
        "The first replicate on {} mm of the belt, in true proportions: {} m of fibre. The belt runs to the \
        right, so the fibre grows to the left. It is drawn much thicker than it is. Its bends are those of \
        the elements: see below what the mesh resolves.",
        significant(window.length * MM, 2),
        significant(fed, 3)
    );
    let drawing = Drawing::new(WIDTH, move |width| {
        let scale = (width - 2.0 * MARGIN) / window.length;
        let height = window.width * scale;
        let mut picture = Picture::new(width, height + 2.0 * MARGIN + BELOW, TITLE);
        let (left, top) = (MARGIN, MARGIN);
        let (right, bottom) = (width - MARGIN, MARGIN + height);
        let frame = [(left, top), (right, top), (right, bottom), (left, bottom)];
        picture.polygon(&frame, LIGHT, 1.0, Some(&Stroke::solid(EDGE, 1.0)));
        picture.open_clip("clip_laid_trace", left, top, right - left, height);
        let place =
            |p: &LaidPoint| (left + (p.md - window.from) * scale, bottom - (p.cd - window.low) * scale);
        picture.path(&window.points.iter().map(place).collect::<Vec<_>>(), &Stroke::solid(INK, 0.9));
        picture.close();
        draw_scale(&mut picture, scale, bottom + 24.0, window.length);
        draw_run_of_belt(&mut picture, right, bottom + 24.0);
        picture
    });
    Figure::drawn(NAME, TITLE, drawing, table, caption)
}

/// A piece of the belt and the fibre that lies on it.
struct Window {
    points: Vec<LaidPoint>,
    /// Its smallest coordinates and its extent in machine and cross direction [m].
    from: f64,
    low: f64,
    length: f64,
    width: f64,
}

impl Window {
    /// The newest piece, without the end that the next loops will still cover.
    fn new(laid: &[LaidPoint]) -> Option<Self> {
        let finite = laid.iter().all(|p| p.md.is_finite() && p.cd.is_finite());
        if laid.len() < 3 || !finite {
            return None;
        }
        let range = |coordinate: fn(&LaidPoint) -> f64, points: &[LaidPoint]| {
            points
                .iter()
                .map(coordinate)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)))
        };
        let all = range(|p| p.md, laid);
        let across = range(|p| p.cd, laid);
        // A fibre that lies straight is seen over some elements.
        let wide = (across.1 - across.0).max(5.0 * (laid[1].fed - laid[0].fed)).max(1e-6);
        let length = (ASPECT * wide).min(all.1 - all.0).max(1e-6);
        let from = all.0 + 0.5 * wide.min(all.1 - all.0 - length);
        let inside = |p: &LaidPoint| (from..=from + length).contains(&p.md);
        let first = laid.iter().position(inside)?.saturating_sub(1);
        let last = laid.iter().rposition(inside)? + 1;
        let points = &laid[first..=last.min(laid.len() - 1)];
        let across = range(|p| p.cd, points);
        let width = (1.12 * (across.1 - across.0)).max(0.1 * length);
        let low = 0.5 * (across.0 + across.1 - width);
        Some(Self { points: points.to_vec(), from, low, length, width })
    }
}

/// A bar of a round length, about a fifth of the picture.
fn draw_scale(picture: &mut Picture, scale: f64, y: f64, length: f64) {
    let rough = length * MM / 5.0;
    let power = 10f64.powf(rough.log10().floor());
    let bar = [1.0, 2.0, 5.0].into_iter().rfind(|step| step * power <= rough).unwrap_or(1.0) * power;
    let (from, to) = (MARGIN, MARGIN + bar / MM * scale);
    let stroke = Stroke::solid(INK, 2.5);
    picture.line((from, y), (to, y), &stroke);
    for x in [from, to] {
        picture.line((x, y - 5.0), (x, y + 5.0), &Stroke::solid(INK, 1.5));
    }
    let style = Text { size: 14.0, colour: INK, anchor: Anchor::Start, upright: true };
    picture.text((to + 9.0, y + 5.0), &format!("{} mm", significant(bar, 2)), style);
}

/// An arrow along the belt's run.
fn draw_run_of_belt(picture: &mut Picture, right: f64, y: f64) {
    let style = Text { size: 14.0, colour: INK, anchor: Anchor::End, upright: true };
    picture.text((right - 62.0, y + 5.0), "belt travel (MD)", style);
    picture.line((right - 52.0, y), (right - 8.0, y), &Stroke::solid(INK, 1.8));
    picture.polygon(&[(right, y), (right - 12.0, y - 5.0), (right - 12.0, y + 5.0)], INK, 1.0, None);
}

/// Cells along each side of the footprint, and its half width in spreads.
const CELLS: usize = 44;
const REACH: f64 = 3.3;

/// Where the fibre comes down about its straight trace, of all replicates whose laid fibre is kept.
fn footprint(case: &Case, results: &Results) -> Figure {
    let ratio = case.line.map_or(f64::NAN, |line| line.belt_ratio());
    let curves: Vec<Vec<(f64, f64)>> =
        results.trajectories.iter().map(|trajectory| about_straight_trace(trajectory, ratio)).collect();
    let points: Vec<(f64, f64)> = curves.iter().flatten().copied().collect();
    let [md, cd] = ["sigma_md", "sigma_cd"].map(|name| results.estimate(name).mean * MM);
    let label = |direction| Axis::linear(&format!("{direction} direction (mm)"));
    let chart = Chart::new(
        "footprint",
        "Where the fibre lands",
        label("Machine").in_column("md_mm"),
        label("Cross").in_column("cd_mm"),
    )
    .sized(600.0, 520.0)
    .equal()
    .when_empty("too little has been laid to be shown");
    let half = REACH * md.max(cd);
    if points.is_empty() || !(md > 0.0 && cd > 0.0 && half.is_finite()) {
        return Figure::new(&chart, "Too little was laid after the spin-up to show where the fibre lands.");
    }
    let values = density(&points, half);
    let largest = values.iter().copied().fold(0.0, f64::max);
    let map = Map {
        x: (-half, half),
        y: (-half, half),
        columns: CELLS,
        values,
        range: (0.0, largest),
        label: "%/cm^{2}".to_owned(),
        shades: Shades::Amount,
    };
    let ellipse = |times: f64| {
        let at = |k: u32| TAU * f64::from(k) / 180.0;
        (0..=180).map(move |k| (times * md * at(k).cos(), times * cd * at(k).sin()))
    };
    let within = |times: f64| {
        let inside = points.iter().filter(|(x, y)| (x / md).hypot(y / cd) <= times).count();
        significant(100.0 * inside as f64 / points.len() as f64, 3)
    };
    let chart = chart
        .map(map)
        .path(Series::new("1 *σ*", VERMILION).width(1.8), ellipse(1.0))
        .path(Series::new("2 *σ*", VERMILION).width(1.8).dashed(&[7.0, 4.0]), ellipse(2.0));
    let caption = format!(
        "Fraction of the fibre per square centimetre of belt, about the straight trace that a fibre would leave if \
         it landed at one point; {} of fibre from {}. The ellipses have the half axes σ and 2σ of the table: {} mm \
         and {} mm in machine and cross direction for σ. They contain {} % and {} % of the fibre; for a normal \
         distribution these are 39.3 % and 86.5 %.",
        format_args!("{} m", significant(points.len() as f64 * case.fibre.rest_length(), 3)),
        one_of(curves.len(), "replicate"),
        significant(md, 3),
        significant(cd, 3),
        within(1.0),
        within(2.0)
    );
    Figure::new(&chart, caption)
}

/// The laid points about the straight trace, in machine and cross direction [mm].
fn about_straight_trace(trajectory: &Trajectory, ratio: f64) -> Vec<(f64, f64)> {
    let positions = trajectory.laid.iter().map(|p| (p.md + ratio * p.fed, p.cd));
    let points: Vec<(f64, f64)> = positions.filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(a, b), (x, y)| (a + x / n, b + y / n));
    points.into_iter().map(|(a, b)| ((a - x) * MM, (b - y) * MM)).collect()
}

/// Share of the points in each cell over the cell's area [%/cm²]; cells without a point have no value.
fn density(points: &[(f64, f64)], half: f64) -> Vec<f64> {
    let cell = 2.0 * half / CELLS as f64;
    let mut counts = vec![0_u32; CELLS * CELLS];
    for (x, y) in points {
        let [i, j] = [x, y].map(|v| ((v + half) / cell).floor());
        if (0.0..CELLS as f64).contains(&i) && (0.0..CELLS as f64).contains(&j) {
            counts[j as usize * CELLS + i as usize] += 1;
        }
    }
    let per = 100.0 / points.len() as f64 / (cell * cell / 100.0);
    counts.into_iter().map(|count| f64::from(count) * per).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_density_sums_to_all_the_fibre() {
        let points = [(0.1, 0.1), (0.2, 0.3), (-3.0, 9.9), (9.0, -9.0)];
        let values = density(&points, 10.0);
        let area = (20.0 / CELLS as f64 / 10.0).powi(2);
        assert!((values.iter().sum::<f64>() * area - 100.0).abs() < 1e-9);
        // Two of the four lie in the cell to the upper right of the middle.
        assert!((values[CELLS / 2 * CELLS + CELLS / 2] * area - 50.0).abs() < 1e-9);
    }

    #[test]
    fn the_window_holds_the_newest_fibre() {
        let at = |i: u32| {
            let s = f64::from(i) * 0.004;
            LaidPoint { fed: s, time: s / 50.0, md: -0.06 * s, cd: 0.02 * (40.0 * s).sin() }
        };
        let points: Vec<LaidPoint> = (0..5000).map(at).collect();
        let window = Window::new(&points).unwrap();
        // 40 mm wide, so 120 mm long, and half a width from the end at −1.2 m.
        assert!((window.length - 0.12).abs() < 1e-4, "{}", window.length);
        assert!((window.from + 0.06 * 4999.0 * 0.004 - 0.02).abs() < 1e-3, "{}", window.from);
        assert_eq!(window.points.len(), (0.12_f64 / 0.06 / 0.004).round() as usize + 2);
        assert!(Window::new(&points[..2]).is_none());
        assert!(Window::new(&[LaidPoint { md: f64::NAN, ..LaidPoint::default() }; 9]).is_none());
    }
}
