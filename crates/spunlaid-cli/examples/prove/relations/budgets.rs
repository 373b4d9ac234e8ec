//! What goes in comes out, and numbers lie where such numbers can lie.

use super::errors::{pairs, with_seed};
use super::{Outcome, leaves};
use crate::draw::{Change, Drawn};
use crate::lines::Lines;
use crate::numbers::{Name, Numbers, Reported, numbers};
use crate::program::{Program, Said};
use serde_json::Value as Json;
use spunlaid_ground::Dimension;
use std::collections::BTreeMap;

/// Shares are between 0 and 1, errors are not negative, an interval holds its value, quantiles are in order.
pub fn bounds(_: &Program, _: &Drawn, results: &Json) -> Outcome {
    const SHARES: [&str; 5] = ["share", "fraction", "bare_area", "opacity", "_transmission"];
    const NEVER_NEGATIVE: [&str; 7] =
        ["error", "_se", "standard_error", "cv", "amplitude", "diameter", "variance"];
    let all = leaves(results);
    for (path, value) in &all {
        let name = path.rsplit('/').find(|part| part.parse::<u64>().is_err()).unwrap_or_default();
        let parent = path.rsplit('/').nth(1).unwrap_or_default();
        let Some(number) = value.as_f64() else { continue };
        let is_of_input =
            ["/case", "/web/case", "/spinline/influences"].iter().any(|input| path.starts_with(input))
                || path.contains("interval");
        if is_of_input {
            continue;
        }
        let is_change = ["differ", "change", "over", "of_momentum"].iter().any(|word| path.contains(word));
        let is_error = NEVER_NEGATIVE.iter().any(|word| name.contains(word));
        if is_error && !is_change && number < 0.0 {
            return Outcome::Broken(format!("{path} is {number}, below zero"));
        }
        let is_share = SHARES.iter().any(|word| name.starts_with(word) || parent.starts_with(word));
        let is_value = name == "mean" || SHARES.iter().any(|word| name.starts_with(word));
        if is_share && is_value && !is_change && !(-1e-9..=1.0 + 1e-9).contains(&number) {
            return Outcome::Broken(format!("{path} is {number}, outside of 0 to 1"));
        }
    }
    for (name, Reported { value, interval: [low, high], .. }) in numbers(results) {
        if !(low..=high).contains(&value) {
            return Outcome::Broken(format!("{name:?} is {value}, outside of its interval, {low} to {high}"));
        }
    }
    quantiles(&all)
}

fn quantiles(all: &BTreeMap<String, Json>) -> Outcome {
    const ORDERED: [&str; 5] = [
        "weight_of_1_percent",
        "weight_of_5_percent",
        "median_weight",
        "weight_of_95_percent",
        "weight_of_99_percent",
    ];
    for path in all.keys().filter(|path| path.contains(ORDERED[0]) && path.ends_with("value")) {
        let at = |name: &&str| all.get(&path.replace(ORDERED[0], name)).and_then(Json::as_f64);
        let of_all: Vec<f64> = ORDERED.iter().filter_map(at).collect();
        if !of_all.is_sorted() {
            return Outcome::Broken(format!("{path}: {ORDERED:?} are {of_all:?}"));
        }
    }
    Outcome::Holds
}

/// What is laid in a second is what is fed: the mean weight of each layer is the mass that its filaments bring, and the
/// web weighs what its layers do.
pub fn mass_of_a_web(_: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    let width = Lines::new(drawn.base.text).value("web", "width").expect("a width");
    let width = Dimension::Length.parse(&width).expect("a width");
    for layer in results["layers"].as_array().into_iter().flatten() {
        let of = |name: &str| layer[name].as_f64().unwrap_or(f64::NAN);
        let fed = of("filaments") * of("linear_density_kg_m") * of("feed_speed_m_s");
        let wanted = fed / (width * of("belt_speed_m_s"));
        let found = of("basis_weight_kg_m2");
        if (found / wanted - 1.0).abs() > 1e-6 {
            return Outcome::Broken(format!("a layer weighs {found}, and is fed with {wanted} kg/m²"));
        }
    }
    Outcome::Holds
}

/// The mass that passes the end in a second is the throughput of the hole.
pub fn mass_of_a_line(_: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    let own = Lines::new(drawn.base.text).value("spinline", "throughput").expect("a throughput");
    let throughput = drawn.value("spinline.throughput").unwrap_or(&own);
    let wanted = Dimension::MassFlow.parse(throughput).expect("a throughput");
    let of = |name: &str| results["spinline"][name].as_f64();
    let Some((titre, speed)) = of("linear_density_kg_m").zip(of("final_speed_m_s")) else {
        return Outcome::Refused;
    };
    let found = titre * speed;
    match (found / wanted - 1.0).abs() < 1e-6 {
        true => Outcome::Holds,
        false => Outcome::Broken(format!("{found} kg/s pass the end, and {wanted} kg/s the hole")),
    }
}

/// A line ends as it was asked to: at the speed of the godet, and with balanced momentum and energy.
pub fn end_of_a_line(_: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    /// Largest imbalance of momentum and of energy, as a share of the whole.
    const BALANCED: f64 = 1e-4;
    let line = &results["spinline"];
    for name in ["momentum_residual", "energy_residual"] {
        if let Some(residual) = line[name].as_f64()
            && residual.abs() > BALANCED
        {
            return Outcome::Broken(format!("{name} is {residual:.1e}"));
        }
    }
    let own = Lines::new(drawn.base.text);
    let written = |key: &str| {
        drawn.value(&format!("spinline.{key}")).map(str::to_owned).or_else(|| own.value("spinline", key))
    };
    if written("end").is_none_or(|end| end != "take-up") {
        return Outcome::Holds;
    }
    let (Some(wanted), Some(found)) = (written("take_up_speed"), line["final_speed_m_s"].as_f64()) else {
        return Outcome::Refused;
    };
    let wanted = Dimension::Velocity.parse(&wanted).expect("a speed");
    match (found / wanted - 1.0).abs() < 1e-5 {
        true => Outcome::Holds,
        false => {
            Outcome::Broken(format!("the filament ends at {found} m/s, and the godet draws at {wanted} m/s"))
        }
    }
}

/// What the air of a line loses is what its filaments feel: the drag on them is their change of momentum, that in the
/// cells of a field is all of it, and a web of the same filaments says the same of its air.
pub fn momentum_of_the_air(program: &Program, drawn: &Drawn, _: &Json) -> Outcome {
    const ALONG: &str = "force_along_n_per_m";
    // The web of the same seed has other turbulence, because its filaments are in one air.
    let sources = |number: u64| {
        let seeded = with_seed(drawn, number).with(&[Change::new("run.replicates", "8")]);
        program.computed_as("air", &seeded, &["--sources"])
    };
    let own = match sources(0) {
        Said::Results(own) => own,
        Said::Refused(_) => return Outcome::Refused,
        Said::Failed(words) => return Outcome::Broken(words),
    };
    let mean = |number: &Json| number["mean"].as_f64().unwrap_or(f64::NAN);
    let (along, outside) = (mean(&own[ALONG]), mean(&own["outside_n_per_m"]));
    let axes: Vec<f64> = own["force_n_per_m"].as_array().into_iter().flatten().map(mean).collect();
    let is_whole = |axis: &f64| (axis.abs() - along.abs()).abs() <= 1e-9 * along.abs();
    if !axes.iter().any(is_whole) {
        return Outcome::Broken(format!(
            "the force on all cells is {axes:?} N/m, and that along the way {along} N/m"
        ));
    }
    // The force on the air of the web is also that outside of the field.
    if outside != 0.0 {
        return Outcome::Holds;
    }
    let name = |what: &str| -> Name { (what.to_owned(), String::new()) };
    pairs(
        "of the same filaments",
        |_| true,
        |number| {
            let sources = numbers(&sources(number).results()?);
            let web = program.numbers(&with_seed(drawn, number))?;
            let place = |((_, of), _): &(&Name, &Reported)| {
                of.rsplit(' ').next().and_then(|of| of.parse::<u32>().ok())
            };
            let is_force = |((name, _), _): &(&Name, &Reported)| name.ends_with("places.force_n_per_m");
            let at_belt = web.iter().filter(is_force).max_by_key(place);
            let of = |what: &str| sources.get(&name(what)).cloned();
            let ours = [("drag", of("above_belt_n_per_m")), ("force on the air", of(ALONG))];
            let others = [
                ("drag", of("by_momentum_n_per_m")),
                ("force on the air", at_belt.map(|(_, own)| own.clone())),
            ];
            let known = |pairs: [(&str, Option<Reported>); 2]| -> Numbers {
                pairs.into_iter().filter_map(|(what, own)| Some((name(what), own?))).collect()
            };
            Some((known(ours), known(others)))
        },
    )
}
