//! The air that the fibre flies in, where it is not the same everywhere, and a CFD field around its way.

use super::MM;
use crate::numbers::range;
use spunlaid_air::{Hint, LocalAir, PlacedField};
use spunlaid_charts::palette::{GREEN, INK, ORANGE, VERMILION};
use spunlaid_charts::{Axis, Chart, Figure, Map, Series, Shades};
use spunlaid_fibre::Case;
use spunlaid_ground::Vec3;
use spunlaid_simulation::Results;

/// Places that are asked along the fibre.
const PLACES: usize = 201;

/// Mean velocity and turbulence along the straight fibre.
pub(super) fn along_fibre(case: &Case) -> Figure {
    let (along, length) = (case.along(), case.fibre.length);
    let mut hint = Hint::default();
    let share = |i: usize| i as f64 / (PLACES - 1) as f64;
    let places: Vec<(f64, LocalAir)> =
        (0..PLACES).map(|i| (length * share(i) * MM, case.air.local(along * share(i), &mut hint))).collect();
    let mean = places.iter().map(|(s, air)| (*s, air.velocity.x));
    let band = places.iter().map(|(s, air)| (*s, air.velocity.x - air.rms, air.velocity.x + air.rms));
    let (title, from, straight) = match case.line {
        None => ("Air along the fibre", "root", "The air where the straight fibre would lie"),
        Some(_) => (
            "Air from the inlet to the belt",
            "inlet",
            "The air on the straight way from the inlet to the belt",
        ),
    };
    let chart = Chart::new(
        "air_along_fibre",
        title,
        Axis::linear(&format!("Distance from the {from} (mm)")).tight(),
        Axis::linear("Velocity along *x* (m/s)"),
    )
    .band(Series::new("± rms of the fluctuation", GREEN), band)
    .line(Series::new("mean", GREEN), mean);
    let between = |quantity: fn(&LocalAir) -> f64, scale: f64, unit: &str| {
        let values = || places.iter().map(|(_, air)| quantity(air) * scale);
        let least = values().fold(f64::INFINITY, f64::min);
        let most = values().fold(0.0, f64::max);
        let least = if most - least <= 1e-9 * most { most } else { least };
        format!("{} {unit}", range(least, most))
    };
    let caption = format!(
        "{straight}: mean velocity along x, and the rms of each component of the turbulence \
         about it. The eddies are {} long, and the turbulence has no energy above {}.",
        between(|air| air.length_scale, MM, "mm"),
        between(|air| air.cutoff_frequency, 1.0, "Hz"),
    );
    Figure::new(&chart, caption)
}

/// Columns and rows of a slice.
const GRID: (usize, usize) = (276, 112);

/// A plane along the fibre, and the direction across the fibre in it.
struct Plane {
    name: &'static str,
    /// Machine or cross direction.
    direction: &'static str,
    /// Its number among the axes of the fibre.
    axis: usize,
    /// Of the field [m].
    across: (f64, f64),
}

/// The speed of the air of a CFD field in the planes of x and y and of x and z, with the directions of the line, the
/// belt and where the fibres of a run have ended.
pub fn field_figure(case: &Case, results: Option<&Results>) -> Option<Figure> {
    let placed = case.air.flow.field()?;
    let ((low, high), length) = (placed.extent(), case.fibre.length);
    // As much of the field as the fibre could reach, and a little more.
    let within = |low: f64, high: f64| (low.max(-length), high.min(length));
    let x = (low.x.max(-0.1 * length), high.x.min(1.1 * length));
    let (md, cd) = (within(low.y, high.y), within(low.z, high.z));
    // A plane flow is as it is at all places across.
    let shown = |own: (f64, f64), other: (f64, f64), axis: usize| match placed.field.plane_axis() {
        Some(plane) if plane == placed.axes()[axis].index => {
            (-0.5 * (other.1 - other.0), 0.5 * (other.1 - other.0))
        }
        _ => own,
    };
    let planes = [
        Plane { name: "*y*", direction: "MD", axis: 1, across: shown(md, cd, 1) },
        Plane { name: "*z*", direction: "CD", axis: 2, across: shown(cd, md, 2) },
    ];
    let mut maps = planes.each_ref().map(|plane| slice(case, plane, x));
    let fastest =
        maps.iter().flat_map(|map| &map.values).copied().filter(|v| v.is_finite()).fold(0.0, f64::max);
    if fastest > 0.0 {
        maps.iter_mut().for_each(|map| map.range = (0.0, fastest));
    }
    let charts = maps.into_iter().zip(&planes).map(|(map, plane)| {
        let chart = chart(case, placed, plane).map(map);
        with_fibres(chart, plane, case, results)
    });
    let charts: Vec<Chart> = charts.map(|chart| chart.sized(640.0, 300.0)).collect();
    let fibres = match results {
        Some(results) => format!(", and up to {} fibres as they were at the end", results.trajectories.len()),
        None => String::new(),
    };
    let caption = format!(
        "Speed of the mean flow in two planes through the root, of {}{fibres}. The arrows are the machine direction \
         (MD), in which the belt runs, and the cross direction (CD), each with its axis in the field. The spot, the \
         {}, is at {} of the field. Grey: outside the field.",
        placed.field.describe(),
        if case.line.is_some() { "middle of the slot" } else { "root" },
        PlacedField::in_words(placed.root),
    );
    let charts: Vec<&Chart> = charts.iter().collect();
    Some(Figure::stacked("air_slices", "The field and the line", &charts, caption))
}

/// The speed in a plane.
fn slice(case: &Case, plane: &Plane, x: (f64, f64)) -> Map {
    let across = plane.across;
    let mut hint = Hint::default();
    let mut speed = |i: usize, j: usize| {
        let share = |n: usize, count: usize| (n as f64 + 0.5) / count as f64;
        let aside = across.0 + (across.1 - across.0) * share(j, GRID.1);
        let along = x.0 + (x.1 - x.0) * share(i, GRID.0);
        let at = if plane.axis == 1 { Vec3::new(along, aside, 0.0) } else { Vec3::new(along, 0.0, aside) };
        let air = case.air.local(at, &mut hint);
        if air.inside { air.velocity.norm() } else { f64::NAN }
    };
    let values = (0..GRID.0 * GRID.1).map(|n| speed(n % GRID.0, n / GRID.0)).collect();
    Map {
        x: (x.0 * MM, x.1 * MM),
        y: (across.0 * MM, across.1 * MM),
        columns: GRID.0,
        values,
        range: (0.0, 1.0),
        label: "|*U*| (m/s)".to_owned(),
        shades: Shades::Amount,
    }
}

/// The axes of a plane, with the directions of the line and the belt.
fn chart(case: &Case, placed: &PlacedField, plane: &Plane) -> Chart {
    let Plane { name, direction, axis, across } = *plane;
    let length = case.fibre.length * MM;
    let of_field = |axis: usize| placed.axes()[axis].name().replace('-', "−");
    let (along, aside) = (of_field(0), of_field(axis));
    let (root, axis) = match case.line {
        Some(_) => ("inlet", "*x* from the inlet (mm)"),
        None => ("root", "*x* from the root (mm)"),
    };
    let chart = Chart::new(
        &format!("air_slice_{}", name.trim_matches('*')),
        "The field and the line",
        Axis::linear(axis).tight(),
        Axis::linear(&format!("{name}, {direction} (mm)")).tight(),
    );
    // The belt is seen as a whole where the field ends at it.
    let chart = match case.line {
        Some(_) => Chart { x: chart.x.clone().including(1.02 * length), ..chart },
        None => chart,
    };
    let head = 0.6 * across.1.min(-across.0).max(0.25 * (across.1 - across.0)) * MM;
    let chart = chart
        .arrow(INK, [(0.0, 0.0), (0.3 * length, 0.0)], &format!("*x*, gravity: {along} of the field"))
        .arrow(INK, [(0.0, 0.0), (0.0, head)], &format!("{direction}: {aside} of the field"))
        .scatter(Series::spots(root, ORANGE).drawn_only(), [(0.0, 0.0, None)]);
    if case.line.is_none() {
        return chart;
    }
    let belt = Series::new("belt", INK).drawn_only().width(4.0);
    chart.path(belt, [(length, across.0 * MM), (length, across.1 * MM)])
}

/// The fibres of a run where they were at its end; without one the straight way.
fn with_fibres(chart: Chart, plane: &Plane, case: &Case, results: Option<&Results>) -> Chart {
    let Some(results) = results else {
        let end = (case.along().x * MM, 0.0);
        let series = Series::new("straight fibre", VERMILION).drawn_only().dashed(&[6.0, 4.0]);
        return chart.path(series, [(0.0, 0.0), end]);
    };
    results.trajectories.iter().enumerate().fold(chart, |chart, (i, trajectory)| {
        let end = trajectory.shapes.last().unwrap_or_default().position;
        let aside = |p: &Vec3<f64>| if plane.axis == 1 { p.y } else { p.z };
        let path: Vec<_> = end.iter().map(|p| (p.x * MM, aside(p) * MM)).collect();
        let name = format!("fibre {}", trajectory.replicate + 1);
        let series = Series::new("fibres at the end", VERMILION).named(&name).width(1.3);
        chart.path(if i == 0 { series } else { series.unlabelled() }, &path)
    })
}
