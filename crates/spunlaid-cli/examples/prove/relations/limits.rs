//! Similar inputs, inputs that are almost the same, and inputs of which the answer is known.

use super::errors::{pairs, with_seed};
use super::{Outcome, leaves};
use crate::draw::{Change, Drawn};
use crate::lines::Lines;
use crate::numbers::{Name, numbers};
use crate::program::{Program, Said};
use serde_json::Value as Json;
use spunlaid_fibre::case::keys::{self, Kind};
use spunlaid_ground::{Dimension, Powers};

/// A change that is nothing, relative.
const NOTHING: f64 = 1e-12;

/// Metre, kilogram and second are halved or doubled: the numbers of the input and of the results are others, and the
/// fibre is the same.
pub fn similarity(program: &Program, drawn: &Drawn, _: &Json) -> Outcome {
    const SMALLER: [f64; 5] = [2.0, 4.0, 0.5, 1.0, 1.0];
    // What is in files is not scaled.
    if !["fixed", "fed"].contains(&drawn.base.name) {
        return Outcome::Refused;
    }
    pairs(
        "in other units",
        |name| factor_of(name, SMALLER).is_some(),
        |number| {
            let out = program.new_place("similar");
            let seeded = with_seed(drawn, number);
            let mut ours = numbers(&program.computed(&seeded, &["--out=similar"]).results()?);
            for (name, own) in &mut ours {
                let factor = factor_of(name, SMALLER).unwrap_or(1.0);
                own.value *= factor;
                own.error *= factor;
            }
            let text = std::fs::read_to_string(out.join("case.toml")).ok()?;
            let scaled = Lines::new(&text).map(|key, value| {
                let Kind::Quantity(dimension, _) = keys::find(key)?.kind else { return None };
                let si = dimension.parse(value).ok()?;
                Some(dimension.exact(si * Powers::from_dimension(dimension).factor(SMALLER)))
            });
            // Where a limit or a usual range is in the way, nothing is compared.
            let said = program.computed_text(drawn.base.command, &scaled.text(), &[]);
            Some((ours, numbers(&said.results()?)))
        },
    )
}

/// By what a number is larger in smaller units; None of what has a unit that is not known here.
fn factor_of(name: &Name, smaller: [f64; 5]) -> Option<f64> {
    const KNOWN: [Dimension; 4] =
        [Dimension::Velocity, Dimension::Length, Dimension::Time, Dimension::Frequency];
    // Of a ratio the last unit is not that of the whole.
    if name.0.contains("_per_") {
        return None;
    }
    // A velocity, which ends as a time does, comes first.
    let dimension = KNOWN.into_iter().find(|dimension| name.0.ends_with(&dimension.suffix()))?;
    Some(Powers::from_dimension(dimension).factor(smaller))
}

/// Something that is almost not there changes nothing, and takes no number away.
pub fn next_to_nothing(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    let all = drawn.next_to_nothing();
    if all.is_empty() {
        return Outcome::Refused;
    }
    let one = &all[drawn.random().below(all.len())];
    let words = format!("with {} = {}", one.key, one.value);
    match program.computed(&drawn.with(std::slice::from_ref(one)), &[]) {
        Said::Results(found) => {
            let (wanted, found) = (leaves(results), leaves(&found));
            // Charged filaments have more numbers. Errors of few cells may be known of one flight and not of another,
            // and of rare places there is a number or a bound. Heights are those at which there is a filament.
            let is_number = |path: &&String| {
                ["/heights/", "error", "interval", "_se", "degrees", "at_most", "value"]
                    .iter()
                    .all(|word| !path.contains(word))
            };
            if let Some(path) = wanted.keys().filter(is_number).find(|path| !found.contains_key(*path)) {
                return Outcome::Broken(format!("{words} there is no {path}"));
            }
        }
        Said::Refused(_) => return Outcome::Refused,
        Said::Failed(said) => return Outcome::Broken(said),
    }
    pairs(
        &words,
        |_| true,
        |number| {
            let ours = program.numbers(&with_seed(drawn, number))?;
            Some((ours, program.numbers(&with_seed(&drawn.with(std::slice::from_ref(one)), number))?))
        },
    )
}

/// Values that differ by rounding give the same numbers, as far as the motion is not chaotic.
pub fn rounded(program: &Program, drawn: &Drawn, _: &Json) -> Outcome {
    let other = drawn.in_si_units().map(|Change { key, value }| {
        let (number, unit) = value.split_once(' ').unwrap_or((value, ""));
        let value = match number.parse::<f64>() {
            Ok(number) if !unit.is_empty() => format!("{} {unit}", number * (1.0 + NOTHING)),
            _ => value.clone(),
        };
        Change::new(key, value)
    });
    pairs(
        "with values that are rounded",
        |_| true,
        |number| {
            let ours = program.numbers(&with_seed(drawn, number))?;
            Some((ours, program.numbers(&with_seed(&other, number))?))
        },
    )
}

/// What a key moves, as `spin` says, is what it moves by hand.
pub fn influences(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    /// Change by hand, relative.
    const STEP: f64 = 0.01;
    /// The influences may be rounded or of steps of another size.
    const ALMOST: f64 = 0.1;
    let of_all = results["spinline"]["influences"].as_array().cloned().unwrap_or_default();
    let of_all: Vec<Json> = of_all.into_iter().filter(|of| of["change"] == "relative").collect();
    if of_all.is_empty() {
        return Outcome::Refused;
    }
    let one = &of_all[drawn.random().below(of_all.len())];
    let key = one["key"].as_str().unwrap_or_default();
    let out = program.new_place("moved");
    let Said::Results(_) = program.computed(drawn, &["--out=moved"]) else { return Outcome::Refused };
    let text = Lines::new(&std::fs::read_to_string(out.join("spinline.toml")).expect("a spinline"));
    let Some((table, name)) = key.rsplit_once('.') else { return Outcome::Refused };
    let Some((value, kind)) = text.value(table, name).zip(keys::find(key).map(|key| key.kind)) else {
        return Outcome::Refused;
    };
    let Kind::Quantity(dimension, _) = kind else { return Outcome::Refused };
    let Ok(si) = dimension.parse(&value) else { return Outcome::Refused };
    let moved = |factor: f64| {
        let set = format!("--set={key}={}", dimension.exact(si * factor));
        program.computed_text("spin", &text.text(), &[set]).results()
    };
    let (Some(less), Some(more)) = (moved(1.0 - STEP), moved(1.0 + STEP)) else { return Outcome::Refused };
    for (name, result) in [("diameter", "final_diameter_m"), ("speed", "final_speed_m_s")] {
        let of = |results: &Json| results["spinline"][result].as_f64().unwrap_or(f64::NAN);
        let found = (of(&more) / of(&less)).ln() / ((1.0 + STEP) / (1.0 - STEP)).ln();
        let said = one[name].as_f64().unwrap_or(f64::NAN);
        // Where a line almost has another steady state, or solidifies elsewhere, slopes are steep.
        if (found - said).abs() > ALMOST * (1.0 + found.abs().max(said.abs())) {
            return Outcome::Broken(format!(
                "{key} moves the {name} by {said:.4}, and by hand by {found:.4}"
            ));
        }
    }
    Outcome::Holds
}

/// A thread of a very viscous melt, whose weight, inertia and friction are nothing beside its tension: the tension is
/// `3 η Q ln(v/v₀) / z` up to where it solidifies (A. Ziabicki: Fundamentals of Fibre Formation, 1976, isothermal
/// line).
pub fn line_in_closed_form(program: &Program, drawn: &Drawn, _: &Json) -> Outcome {
    const VISCOSITY: f64 = 1e5;
    const SPECIFIC_VOLUME: f64 = 8e-4;
    /// The melt still becomes more viscous by some 7 % before it solidifies, and it is not free of the three forces.
    const SHARE: std::ops::RangeInclusive<f64> = 0.97..=1.1;
    let stiff = [
        ("law", "newtonian".to_owned()),
        ("crystallisation", "false".to_owned()),
        ("die_temperature", "570 K".to_owned()),
        ("die_swell", "1".to_owned()),
        ("temperature", "10 °C".to_owned()),
        ("length", "4 m".to_owned()),
        ("take_up_speed", "20 m/s".to_owned()),
        ("material.viscosity", format!("{VISCOSITY} Pa s")),
        ("material.viscosity_temperature", "570 K".to_owned()),
        ("material.activation_energy", "1 kJ/mol".to_owned()),
        ("material.solidification_temperature", "450 K".to_owned()),
        ("material.specific_volume", format!("{SPECIFIC_VOLUME} m³/kg")),
        ("material.specific_volume_slope", "1e-8 m³/(kg K)".to_owned()),
    ];
    let stiff = stiff.map(|(key, value)| Change::new(&format!("spinline.{key}"), value));
    let is_of_friction = |change: &Change| change.key.starts_with("drag.");
    let mut slow = drawn.with(&stiff);
    slow.changes.retain(|change| !is_of_friction(change));
    let Said::Results(found) = program.computed(&slow, &[]) else { return Outcome::Refused };
    let of = |name: &str| found["spinline"][name].as_f64();
    let frozen = &found["spinline"]["solidification"];
    let (Some(force), Some(ratio), Some(distance)) =
        (of("force_at_die_n"), of("draw_ratio"), frozen["distance_m"].as_f64())
    else {
        return Outcome::Refused;
    };
    let throughput = of("linear_density_kg_m").zip(of("final_speed_m_s")).map(|(titre, speed)| titre * speed);
    let Some(throughput) = throughput else { return Outcome::Refused };
    let wanted = 3.0 * VISCOSITY * throughput * SPECIFIC_VOLUME * ratio.ln() / distance;
    match SHARE.contains(&(force / wanted)) {
        true => Outcome::Holds,
        false => {
            Outcome::Broken(format!("the tension at the die is {force} N, and in closed form {wanted} N"))
        }
    }
}

/// A fibre that hangs in air at rest pulls at its root with its weight.
pub fn chain(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    let of = |table: &str, key: &str| results["case"][table][key].as_f64();
    let (Some(diameter), Some(density), Some(length), Some(element)) = (
        of("fibre", "diameter_m"),
        of("fibre", "density_kg_m3"),
        of("fibre", "length_m"),
        of("fibre", "element_length_m"),
    ) else {
        return Outcome::Refused;
    };
    let calm = Drawn { changes: Vec::new(), ..drawn.clone() }.with(&[
        Change::new("fibre.diameter", Dimension::Length.exact(diameter)),
        Change::new("fibre.density", Dimension::Density.exact(density)),
        Change::new("fibre.length", Dimension::Length.exact(length)),
        Change::new("air.turbulence_intensity", "0"),
        Change::new("air.velocity", "1 mm/s"),
        Change::new("run.duration", "1 s"),
    ]);
    let Said::Results(found) = program.computed(&calm, &[]) else { return Outcome::Refused };
    let Some(found) = found["fibre"]["root_tension_n"]["mean"].as_f64() else { return Outcome::Refused };
    let area = 0.25 * std::f64::consts::PI * diameter * diameter;
    // The tension is that of the first element, of which half hangs below its middle.
    let wanted = density * area * 9.81 * (length - 0.5 * element);
    match (found / wanted - 1.0).abs() < 0.02 {
        true => Outcome::Holds,
        false => Outcome::Broken(format!("the tension at the root is {found} N, and the weight {wanted} N")),
    }
}
