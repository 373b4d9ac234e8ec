//! What a solved spinline says, in sentences.

use crate::numbers::{number_to, significant, to_decimals};
use spunlaid::case::Case;
use spunlaid::input::{Influence, OfFilament};
use spunlaid::spinline::{FreezingCause, Solution};
use spunlaid::units::Dimension;
use spunlaid_charts::label::plain;

/// What is known of the error of the model.
///
/// * `has_low_birefringence` – as of the solution
pub fn model_error(has_low_birefringence: bool) -> String {
    let of_modulus = if has_low_birefringence {
        "The birefringence of polypropylene is 3 to 5 times too low, because crystals orient more than the \
        stress of the melt does; so the modulus that follows from it is too low, and neither is an estimate \
        of a real filament."
    } else {
        "The modulus can be wrong by a factor of two."
    };
    format!(
        "How far the model is from a real line is not known: no diameter that it gives has been compared \
        with a measured one. {of_modulus}"
    )
}

/// How well the equations are solved, in a sentence.
pub fn numerical_error(rows: &[Solution]) -> String {
    let largest = |residual: fn(&Solution) -> f64| {
        number_to(rows.iter().map(|row| residual(row).abs()).fold(0.0, f64::max), 1)
    };
    format!(
        "The equations are solved such that over the whole line the balance of momentum holds to {} of the \
        largest tension and that of energy to {} of the heat that the air takes.",
        largest(|row| row.momentum_residual),
        largest(|row| row.energy_residual)
    )
}

/// What a fed case says of its filament, in sentences: size, speed and throughput, and where it comes from if
/// it has a spinline.
pub fn filament(case: &Case) -> Vec<String> {
    let (Some(line), Some(throughput)) = (case.line, case.throughput()) else { return Vec::new() };
    let fed = format!(
        "filaments of {}, {} dtex, fed at {}: {} g/min from each hole",
        Dimension::Length.pretty_to(case.fibre.diameter, 4),
        significant(case.linear_density() * 1e7, 3),
        Dimension::Velocity.pretty_to(line.feed_speed, 4),
        significant(throughput * 6e4, 3),
    );
    let solution = case.spinline.as_ref().and_then(|spinline| spinline.solve(case.drag.along).ok());
    let frozen = solution.map(|solution| format!("from the spinline: {}", freezing(&solution)));
    [fed].into_iter().chain(frozen).collect()
}

/// Where and by what the thread freezes, in a sentence.
pub fn freezing(solution: &Solution) -> String {
    let point = solution.freezing;
    format!(
        "The thread is drawn {}-fold and freezes {} below the die, at {}, {}, under a stress of {} MPa and \
        while it cools at {} K/s.",
        significant(solution.draw_ratio(), 3),
        Dimension::Length.pretty_to(point.distance, 3),
        Dimension::Temperature.pretty_to(point.temperature, 4),
        match point.by {
            FreezingCause::Temperature => "by its temperature",
            FreezingCause::Crystallisation => "by crystallisation",
        },
        significant(point.stress * 1e-6, 3),
        two_digits(point.cooling_rate)
    )
}

/// `9400` of 9379.2.
fn two_digits(value: f64) -> String {
    let magnitude = if value > 0.0 { value.log10().floor() as i32 } else { 0 };
    to_decimals(value, 1 - magnitude)
}

/// What a number does to the diameter, in a sentence: `Throughput: 1 % more makes the filament 0.43 % thicker.`
pub fn influence(influence: &Influence) -> String {
    let diameter = influence.on(OfFilament::Diameter).map_or(f64::NAN, |effect| effect.difference.value);
    let (change, percent) = match influence.change.keys[0].by_kelvin {
        false => ("1 % more makes", diameter),
        true => ("10 K more make", 100.0 * diameter),
    };
    let way = if percent < 0.0 { "finer" } else { "thicker" };
    let label = plain(influence.change.setting.words);
    format!("{label}: {change} the filament {} % {way}.", significant(percent.abs(), 2))
}

/// What a reader must know of the solution.
pub fn remarks(rows: &[Solution]) -> Vec<String> {
    let several: Vec<String> = (rows.iter().enumerate())
        .filter(|(_, row)| row.has_second)
        .map(|(i, _)| (i + 1).to_string())
        .collect();
    let whose = match rows.len() {
        0 | 1 => String::new(),
        _ => format!(" in row {}", several.join(", ")),
    };
    let remark =
        format!("there are two steady states{whose}; the one with the smaller tension at the die is given");
    (!several.is_empty()).then_some(remark).into_iter().collect()
}
