//! The air that the fibre flies in, where it is not the same everywhere.

use super::MM;
use crate::numbers::range;
use spunlaid::air::{Flow, LocalAir};
use spunlaid::case::Case;
use spunlaid::ensemble::Results;
use spunlaid::field::Hint;
use spunlaid::vec3::Vec3;
use spunlaid_charts::{
    Axis, Chart, Figure, Map, Series, Shades,
    palette::{GREEN, VERMILION},
};

/// Places that are asked along the fibre.
const PLACES: usize = 201;

/// Mean velocity and turbulence along the straight fibre.
pub(super) fn along_fibre(case: &Case) -> Figure {
    let (along, length) = (case.along(), case.fibre.length);
    let mut hint = Hint::default();
    let share = |i: usize| i as f64 / (PLACES - 1) as f64;
    let places: Vec<(f64, LocalAir)> =
        (0..PLACES).map(|i| (length * share(i) * MM, case.air.local(along * share(i), &mut hint))).collect();
    let mean: Vec<_> = places.iter().map(|(s, air)| (*s, air.velocity.x)).collect();
    let band: Vec<_> =
        places.iter().map(|(s, air)| (*s, air.velocity.x - air.rms, air.velocity.x + air.rms)).collect();
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
    .band(Series::new("± rms of the fluctuation", GREEN), &band)
    .line(Series::new("mean", GREEN), &mean);
    let between = |quantity: fn(&LocalAir) -> f64, scale: f64, unit: &str| {
        let values = || places.iter().map(|(_, air)| quantity(air) * scale);
        let (least, most) = (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max));
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
    /// Of the field [m].
    across: (f64, f64),
    coordinate: fn(&Vec3<f64>) -> f64,
    at: fn(f64) -> Vec3<f64>,
}

/// The speed of the air of a CFD field in the planes of x and y and of x and z, with where the fibres ended.
pub(super) fn slices(case: &Case, results: &Results) -> Option<Figure> {
    let Flow::Field(placed) = &case.air.flow else {
        return None;
    };
    let (low, high) = placed.extent();
    let length = case.fibre.length;
    // As much of the field as the fibre could reach, and a little more.
    let x = (low.x.max(-0.1 * length), high.x.min(1.1 * length));
    let planes = [
        Plane { name: "*y*", across: (low.y, high.y), coordinate: |p| p.y, at: |y| Vec3::new(0.0, y, 0.0) },
        Plane { name: "*z*", across: (low.z, high.z), coordinate: |p| p.z, at: |z| Vec3::new(0.0, 0.0, z) },
    ];
    let mut maps = planes.each_ref().map(|Plane { across, at, .. }| {
        let across = (across.0.max(-length), across.1.min(length));
        let mut hint = Hint::default();
        let mut speed = |i: usize, j: usize| {
            let share = |n: usize, count: usize| (n as f64 + 0.5) / count as f64;
            let along = Vec3::new(x.0 + (x.1 - x.0) * share(i, GRID.0), 0.0, 0.0);
            let air =
                case.air.local(at(across.0 + (across.1 - across.0) * share(j, GRID.1)) + along, &mut hint);
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
    });
    let fastest =
        maps.iter().flat_map(|map| &map.values).copied().filter(|v| v.is_finite()).fold(0.0, f64::max);
    if fastest > 0.0 {
        maps.iter_mut().for_each(|map| map.range = (0.0, fastest));
    }
    let charts = maps.into_iter().zip(&planes).map(|(map, Plane { name, coordinate, .. })| {
        let chart = Chart::new(
            &format!("air_slice_{}", name.trim_matches('*')),
            "The field and the fibres",
            Axis::linear("*x* from the root (mm)").tight(),
            Axis::linear(&format!("{name} (mm)")).tight(),
        )
        .sized(640.0, 300.0)
        .map(map);
        results.trajectories.iter().enumerate().fold(chart, |chart, (i, trajectory)| {
            let end = trajectory.shapes.last().unwrap_or_default().position;
            let path: Vec<_> = end.iter().map(|p| (p.x * MM, coordinate(p) * MM)).collect();
            let name = format!("fibre {}", trajectory.replicate + 1);
            let series = Series::new("fibres at the end", VERMILION).named(&name).width(1.3);
            chart.path(if i == 0 { series } else { series.unlabelled() }, &path)
        })
    });
    let charts: Vec<Chart> = charts.collect();
    let caption = format!(
        "Speed of the mean flow in two planes through the root, of {}, and up to {} fibres as they were at \
        the end. Grey: outside the field.",
        placed.field.describe(),
        results.trajectories.len(),
    );
    let charts: Vec<&Chart> = charts.iter().collect();
    Some(Figure::stacked("air_slices", "The field and the fibres", &charts, caption))
}
