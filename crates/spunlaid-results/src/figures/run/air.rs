//! The air that the fibre flies in, where it is not the same everywhere.

use super::MM;
use crate::numbers::range;
use spunlaid::air::{Hint, LocalAir};
use spunlaid::fibre::Case;
use spunlaid_charts::palette::GREEN;
use spunlaid_charts::{Axis, Chart, Figure, Series};

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
