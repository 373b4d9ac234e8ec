//! A beam of a line in its file, `beam.toml`.

use super::line::{GIVEN, NewLine, length, speed};
use crate::args::value;
use spunlaid::ground::Dimension;
use spunlaid_results::numbers::significant;

/// Depth of the slot [m], if the user gives none.
const DEPTH: f64 = 20e-3;

/// What comes from a beam; the first one says the weight of all.
pub(super) fn beam(line: &NewLine<'_>, number: u64) -> String {
    let NewLine { given, holes_per_metre, filament, flow, belt_speed, .. } = *line;
    let throughput = filament.throughput();
    let (header, prefix, times) = match given.beams {
        1 => (String::new(), "", String::new()),
        beams => (format!("\n[[layer]]\nname = \"beam {number}\"\n"), "layer.", format!("{beams} beams × ")),
    };
    let of_hole = Dimension::MassFlow.pretty(throughput);
    let of_all = format!("of the whole web: {times}{holes_per_metre} holes/m × {of_hole}");
    let belt = speed(belt_speed);
    let web = Dimension::BasisWeight.pretty(flow / belt_speed);
    let weight = match (value(&given.belt_speed), value(&given.basis_weight)) {
        _ if number > 1 => String::new(),
        (Some(speed), _) => {
            let speed = significant(speed * 60.0, GIVEN);
            format!("belt_speed = \"{speed} m/min\"   # {of_all} / {belt} = {web}\n")
        }
        (None, weight) => {
            let weight = Dimension::BasisWeight.pretty_to(weight.unwrap_or(f64::NAN), GIVEN as usize);
            format!("basis_weight = \"{weight}\"   # {of_all} / {web} = a belt of {belt}\n")
        }
    };
    let holes = given.holes.map(|holes| format!("{holes} holes / {}; ", length(given.width.value)));
    // Of the whole width [kg/h].
    let of_width = |flow: f64| format!("{} kg/h", significant(flow * given.width.value * 3600.0, 4));
    let of_beam = flow / given.beams as f64;
    let in_all = match given.beams {
        1 => format!("{} in all", of_width(flow)),
        beams => format!("{} of this beam, {} of all {beams}", of_width(of_beam), of_width(flow)),
    };
    format!(
        include_str!("beam.toml"),
        header = header,
        prefix = prefix,
        throughput = Dimension::MassFlow.pretty_to(throughput, GIVEN as usize),
        of_hole = of_hole,
        titre = significant(filament.linear_density() * 1e7, 4),
        feed_speed = speed(filament.feed_speed()),
        weight = weight,
        per_metre = holes_per_metre,
        holes = holes.unwrap_or_default(),
        flow = significant(of_beam * 3600.0, 4),
        in_all = in_all,
        depth = length(value(&given.slot_gap).unwrap_or(DEPTH)),
        assumed = if given.slot_gap.is_none() { ", assumed" } else { "" },
    )
}
