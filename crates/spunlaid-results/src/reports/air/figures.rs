//! The planes as pictures: the eddies in machine direction, which swing a fibre from side to side.

use super::files::{PLANES, Slices};
use crate::numbers::significant;
use spunlaid_charts::{Axis, Chart, Figure, Map, Shades};
use spunlaid_fibre::Case;
use spunlaid_ground::Vec3;

/// The colours reach so many standard deviations.
const DEVIATIONS: f64 = 2.5;
/// Width of a picture [px].
const WIDTH: f64 = 620.0;
const MM: f64 = 1e3;

/// Draws both planes at the first instant. The colours are those of all instants.
pub fn pictures(case: &Case, slices: &Slices) -> Vec<Figure> {
    let draw = |i: usize| {
        let deviation = deviation(&slices.velocities[i]);
        let range = if deviation > 0.0 { DEVIATIONS * deviation } else { 1.0 };
        figure(case, slices, i, range)
    };
    if slices.times.is_empty() { Vec::new() } else { [0, 1].map(draw).into() }
}

/// Standard deviation of the velocity in machine direction over a plane and all times [m/s].
fn deviation(velocities: &[Vec<Vec3<f64>>]) -> f64 {
    let all = || velocities.iter().flatten().map(|velocity| velocity.y);
    let count = all().count().max(1) as f64;
    let mean = all().sum::<f64>() / count;
    (all().map(|y| (y - mean).powi(2)).sum::<f64>() / count).sqrt()
}

/// A plane at the first instant.
///
/// * `range` – the velocity that the darkest colour stands for [m/s]
fn figure(case: &Case, slices: &Slices, i: usize, range: f64) -> Figure {
    let (plane, velocities) = (&slices.planes[i], &slices.velocities[i][0]);
    let [first, second] = [plane.steps[0], plane.steps[1]];
    let [columns, rows] = plane.points;
    let ends = |start: f64, step: f64, points: usize| {
        // A cell around each point.
        ((start - 0.5 * step) * MM, (start + (points as f64 - 0.5) * step) * MM)
    };
    let x = match i {
        0 => ends(plane.corner.x, first.x, columns),
        _ => ends(plane.corner.z, first.z, columns),
    };
    let y = ends(plane.corner.y, second.y, rows);
    let map = Map {
        x,
        y,
        columns,
        values: velocities.iter().map(|velocity| velocity.y).collect(),
        range: (-range, range),
        label: "*v* (m/s)".to_owned(),
        shades: Shades::Signed,
    };
    let time = significant(slices.times[0] * MM, 3);
    let way = significant(case.way_of_air() * MM, 3);
    let (title, axis, caption) = match i {
        0 => (
            "Eddies along the path",
            if case.line.is_some() { "*x* from the inlet (mm)" } else { "*x* from the root (mm)" },
            "Velocity of the air in machine direction in the plane of the way and the machine direction \
            through the middle. The mean flow goes to the right; filaments that land here are moved by \
            what they meet."
                .to_owned(),
        ),
        _ => (
            "Eddies across the end of the path",
            "*z*, cross direction (mm)",
            format!(
                "The same {way} mm from the start of the way, seen along it. Neighbouring filaments \
                that lie in one patch of colour move together."
            ),
        ),
    };
    let axis = format!("{axis}, after {time} ms");
    let aspect = (y.1 - y.0) / (x.1 - x.0);
    let chart = Chart::new(
        PLANES[i],
        title,
        Axis::linear(&axis).tight(),
        Axis::linear("*y*, machine direction (mm)").tight(),
    )
    .sized(WIDTH, (WIDTH * aspect).clamp(240.0, 620.0))
    .map(map);
    Figure::new(&chart, caption)
}
