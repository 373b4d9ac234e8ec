//! The files of a line: one of its web and its filament, `line.toml`, and the air between slot and belt.

use super::beam::beam;
use super::line::{GIVEN, NewLine, length, speed};
use crate::args::value;
use spunlaid::air::Cabin;
use spunlaid::ground::Dimension;
use spunlaid_results::numbers::significant;

/// Turbulence of the air between slot and belt, of the usual size: intensity, length of an eddy [m], and the
/// velocity at the belt over that at the slot.
const INTENSITY: f64 = 0.1;
const EDDY: f64 = 16e-3;
const SLOWED: f64 = 1.0 / 6.0;

/// The file; all beams have the same filament.
///
/// * `name` – what the line is called
/// * `air` – the file of its air
/// * `spinline` – the tables of a line that begins at the die
pub(super) fn file(line: &NewLine<'_>, name: &str, air: &str, spinline: Option<&str>) -> String {
    let given = line.given;
    // What is assumed and counts for much. The numbers of the air are factors on what its table has.
    let assumed_values = [
        (given.slot_gap.is_none(), "line.slot_gap, "),
        (given.turbulence.is_none(), "air.intensity_factor, "),
        (true, "air.length_factor"),
    ];
    let fabric = value(&given.thickness).map(|thickness| {
        format!("\n[fabric]\nthickness = \"{}\"   # between its bonds\n", length(thickness))
    });
    format!(
        include_str!("line.toml"),
        name = name,
        beams = (1..=given.beams).map(|number| beam(line, number)).collect::<String>(),
        width = length(given.width.value),
        assumed = assumed_values.map(|(is_assumed, key)| if is_assumed { key } else { "" }).concat(),
        fabric = fabric.unwrap_or_default(),
        spinline = spinline.unwrap_or_default(),
        filament = if spinline.is_some() { String::new() } else { filament(line) },
        distance = length(given.distance.value),
        air = air,
        blown = line.cabin.map_or_else(String::new, |cabin| blown(line, cabin)),
    )
}

/// Titre, density and modulus of a filament that begins at the slot.
fn filament(line: &NewLine<'_>) -> String {
    let material = line.polymer.material(false);
    let dtex = |digits| significant(line.filament.linear_density() * 1e7, digits);
    let size = match value(&line.given.diameter) {
        Some(diameter) => {
            format!("diameter = \"{}\"   # {} dtex: π/4 × diameter² × density", length(diameter), dtex(4))
        }
        None => {
            let diameter = Dimension::Length.pretty(line.filament.diameter());
            let titre = dtex(GIVEN);
            format!("linear_density = \"{titre} dtex\"   # of {diameter}: √(4 × titre / (π × density))")
        }
    };
    // A filament as spun is oriented somewhat.
    let modulus = Dimension::Pressure.pretty_to(1.5 * material.unoriented_modulus, 2);
    format!(
        "{size}\n\
         density = \"{}\"   # of solid {}\n\
         youngs_modulus = \"{modulus}\"   # half as much again as without orientation, assumed: the laydown hardly \
         depends on it\n",
        Dimension::Density.pretty(material.solid_density),
        line.polymer.name(),
    )
}

/// The pressure of the cabin, and what it makes.
fn blown(line: &NewLine<'_>, cabin: Cabin) -> String {
    let coefficient = match line.given.air_speed {
        Some(_) => "of this pressure and the measured speed",
        None => "assumed: a measured speed gives it (--air-speed with --cabin-pressure)",
    };
    format!(
        "cabin_pressure = \"{}\"   # above that under the belt: {} at the slot, Mach {}\n\
         speed_coefficient = {}   # {coefficient}\n",
        Dimension::Pressure.pretty_to(cabin.pressure, GIVEN as usize),
        speed(line.air_speed),
        significant(cabin.mach(), 2),
        significant(cabin.coefficient, 4),
    )
}

/// The table of the air between slot and belt, which decelerates linearly.
pub(super) fn air(line: &NewLine<'_>) -> String {
    let intensity = significant(value(&line.given.turbulence).unwrap_or(INTENSITY), GIVEN);
    let row = |[place, velocity]: [f64; 2]| {
        let cutoff = significant(velocity / (4.0 * EDDY), 4);
        format!("{},{velocity},{intensity},{},{cutoff}\n", place * 1e3, EDDY * 1e3)
    };
    let ends = [[0.0, line.air_speed], [line.given.distance.value, SLOWED * line.air_speed]];
    format!(
        "# Air between the slot and the belt: assumed, of the usual shape and size (cut-off = velocity / \
        4 / length scale).\nx_mm,velocity_m_s,turbulence_intensity,length_scale_mm,cutoff_frequency_hz\n\
        {}",
        ends.map(row).concat()
    )
}
