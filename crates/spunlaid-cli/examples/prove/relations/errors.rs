//! Errors are as large as what two computations of the same thing differ by.

use super::Outcome;
use crate::draw::{Change, Drawn};
use crate::evidence::{Evidence, TOO_LARGE, TOO_SMALL, Wrong};
use crate::lines::Lines;
use crate::numbers::{Name, Numbers, Reported, numbers};
use crate::program::{Program, Said, with_folder};
use serde_json::Value as Json;
use std::collections::BTreeMap;

/// Most seeds of an input that looks suspicious.
const MOST: u64 = 40;
/// Bits of the numbers of seeds of an input.
const SEEDS: u32 = 8;
/// Seeds after which an input that does not is left.
const FIRST: u64 = 2;
/// Numbers that are not the same of a web of another size, or of other filaments.
const OF_SIZE: [&str; 3] = ["fibre_length", "layers.", "neighbours."];

/// A deviation of a number in units of its error, and the degrees of freedom of that error.
pub struct Deviation {
    pub name: Name,
    pub of: f64,
    pub degrees: f64,
    words: String,
}

/// A seed that no other input has.
fn seed(drawn: &Drawn, number: u64) -> u64 {
    (drawn.number << SEEDS) + number + 1
}

pub(super) fn with_seed(drawn: &Drawn, number: u64) -> Drawn {
    drawn.with(&drawn.base.seeds(seed(drawn, number)))
}

/// Looks at one set of deviations after the other until none is suspicious, or one is surely too large.
fn sequential(wrong: &'static Wrong, mut next: impl FnMut(u64) -> Option<Vec<Deviation>>) -> Outcome {
    let mut all: BTreeMap<Name, (Evidence, Vec<String>)> = BTreeMap::new();
    let mut seen = Vec::new();
    for number in 0..MOST {
        let Some(deviations) = next(number) else { return Outcome::Refused };
        for deviation in deviations {
            let (evidence, words) =
                all.entry(deviation.name.clone()).or_insert_with(|| (Evidence::new(wrong), Vec::new()));
            evidence.take(deviation.of, deviation.degrees);
            words.push(deviation.words.clone());
            // As many of each input: one that looks suspicious is tested by itself.
            if number < FIRST {
                seen.push(deviation);
            }
        }
        let value = |entry: &(&Name, &(Evidence, Vec<String>))| entry.1.0.value();
        let worst = all.iter().max_by(|a, b| value(a).total_cmp(&value(b)));
        let of_worst = worst.as_ref().map_or(0.0, value);
        if let Some((name, (evidence, words))) = worst
            && evidence.is_enough()
        {
            return Outcome::Broken(format!(
                "{} {} is off by too many or too few of its errors (evidence {of_worst:.0e}, {} observations):\n{}",
                name.0,
                name.1,
                evidence.observations,
                words.join("\n")
            ));
        }
        if number + 1 >= FIRST && of_worst < Evidence::SUSPECTED {
            break;
        }
    }
    Outcome::Deviations(seen)
}

/// Another seed gives the same numbers within their errors: each beside the mean of those before.
pub fn seeds(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    other_seeds(&TOO_SMALL, program, drawn, results)
}

/// Numbers of other seeds are not much closer together than their errors say. That is so only where no error is one
/// that all seeds have, like that of a mesh.
pub fn errors_not_too_large(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    match other_seeds(&TOO_LARGE, program, drawn, results) {
        Outcome::Deviations(_) => Outcome::Holds,
        outcome => outcome,
    }
}

fn other_seeds(wrong: &'static Wrong, program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    let mut before: BTreeMap<Name, Vec<Reported>> = BTreeMap::new();
    numbers(results).into_iter().for_each(|(name, own)| drop(before.insert(name, vec![own])));
    sequential(wrong, |number| {
        let found = program.numbers(&with_seed(drawn, number))?;
        let mut deviations = Vec::new();
        for (name, own) in found {
            let Some(others) = before.get_mut(&name) else { continue };
            let count = others.len() as f64;
            let mean = others.iter().map(|of| of.value).sum::<f64>() / count;
            let squares = others.iter().chain([&own]).map(|of| of.error * of.error).sum::<f64>();
            let error = (squares / (count + 1.0) * (1.0 + 1.0 / count)).sqrt();
            let degrees = others.iter().chain([&own]).map(|of| of.degrees).sum();
            deviations.extend(deviation(&name, own.value, mean, error, degrees, "with another seed"));
            others.push(own);
        }
        Some(deviations)
    })
}

fn deviation(name: &Name, value: f64, other: f64, error: f64, degrees: f64, what: &str) -> Option<Deviation> {
    let by = value - other;
    // Rounding is no error of a number that is known.
    if counts_elements(name) || by.abs() <= 1e-9 * value.abs().max(other.abs()) || error.is_nan() {
        return None;
    }
    let words =
        format!("    {value:.6} against {other:.6} {what}, with an error of {error:.2e} between them");
    Some(Deviation { name: name.clone(), of: by / error, degrees, words })
}

/// Two ways to the same numbers, with equal seeds or different ones: pairs of them.
pub(super) fn pairs(
    what: &str,
    is_compared: impl Fn(&Name) -> bool,
    mut pair: impl FnMut(u64) -> Option<(Numbers, Numbers)>,
) -> Outcome {
    sequential(&TOO_SMALL, |number| {
        let (ours, others) = pair(number)?;
        let mut deviations = Vec::new();
        for (name, own) in ours.iter().filter(|(name, _)| is_compared(name)) {
            let Some(other) = others.get(name) else { continue };
            let error = own.error.hypot(other.error);
            let degrees = own.degrees.min(other.degrees);
            deviations.extend(deviation(name, own.value, other.value, error, degrees, what));
        }
        Some(deviations)
    })
}

/// Measures of the fibre, not of its steps and nodes.
fn is_of_the_fibre(name: &Name) -> bool {
    !name.0.starts_with("energy.") && !name.0.contains("nodes")
}

/// What is counted in whole elements says nothing beyond an element.
fn counts_elements(name: &Name) -> bool {
    name.0 == "laydown.laid_length_m"
}

/// The change of every measure with a finer step or mesh lies within its whole error.
fn refined(program: &Program, drawn: &Drawn, results: &Json, key: &str, check: &str) -> Outcome {
    let si = match key {
        "run.time_step" => results["case"]["run"]["time_step_s"].as_f64(),
        _ => results["case"]["fibre"]["element_length_m"].as_f64(),
    };
    let Some(si) = si else { return Outcome::Refused };
    let unit = if key == "run.time_step" { "s" } else { "m" };
    let full = drawn.with(&[Change::new("run.checks", "full"), Change::new("run.replicates", "6")]);
    let fine =
        full.with(&[Change::new(key, format!("{:e} {unit}", si / 2.0)), Change::new("run.checks", "none")]);
    let mut of_check: Option<Outcome> = None;
    let outcome = pairs("with half of it", is_of_the_fibre, |number| {
        let coarse = program.computed(&with_seed(&full, number), &[]).results()?;
        // A run that is too short has no check, and says so.
        if coarse[check].is_null() {
            return None;
        }
        let finer = program.computed(&with_seed(&fine, number), &[]).results()?;
        if number == 0 {
            // The check computes both meshes in the same steps.
            let step = coarse[check]["finer_time_step_s"].as_f64().filter(|_| key != "run.time_step");
            let mut changes = vec![Change::new("run.checks", "none")];
            changes.extend(step.map(|step| Change::new("run.time_step", format!("{step:e} s"))));
            let in_steps = program.computed(&with_seed(&full.with(&changes), number), &[]).results()?;
            of_check = by_hand(&coarse[check], &in_steps, &finer);
        }
        Some((numbers(&coarse), numbers(&finer)))
    });
    match of_check {
        Some(Outcome::Broken(words)) => Outcome::Broken(words),
        _ => outcome,
    }
}

/// What the check says of a finer mesh is what is found by hand, if it refines alike.
fn by_hand(of: &Json, coarse: &Json, fine: &Json) -> Option<Outcome> {
    /// Statistics of checks with the measures that they are of.
    const MEASURES: [(&str, &[&str]); 5] = [
        ("spread_difference", &["sigma_md_m", "sigma_cd_m"]),
        (
            "half_correlation_length_difference",
            &["half_correlation_length_md_m", "half_correlation_length_cd_m"],
        ),
        ("chord_over_arc_difference", &["chord_over_arc"]),
        ("amplitude_difference", &["amplitude_y_m", "amplitude_z_m"]),
        ("frequency_difference", &["frequency_y_hz", "frequency_z_hz"]),
    ];
    /// Errors between the two, of which one has few replicates.
    const FAR: f64 = 12.0;
    /// What is left out of the check, relative: it may have other turbulence.
    const LEFT_OUT: f64 = 0.05;
    let is_same = |key: &str, path: [&str; 2]| {
        let (a, b) = (of[key].as_f64(), fine["case"][path[0]][path[1]].as_f64());
        a.zip(b).is_some_and(|(a, b)| (a / b - 1.0).abs() < 1e-6)
    };
    let is_whole = is_same("duration_s", ["run", "duration_s"])
        && is_same("finer_element_length_m", ["fibre", "element_length_m"])
        && is_same("finer_time_step_s", ["run", "time_step_s"]);
    if !is_whole || of["finer_scheme"] != fine["case"]["run"]["scheme"] {
        return None;
    }
    let groups = ["laydown", "end_node"];
    let values = |run: &Json, measure: &str| -> Option<Vec<f64>> {
        let found = groups.iter().find_map(|group| run[*group][measure]["values"].as_array())?;
        found.iter().map(Json::as_f64).collect()
    };
    for (difference, measures) in MEASURES {
        let Some(by_check) = of[difference]["mean"].as_f64() else { continue };
        let error = of[difference]["standard_error"].as_f64()?;
        let mut changes = Vec::new();
        for measure in measures {
            let (a, b) = (values(coarse, measure)?, values(fine, measure)?);
            changes.extend(a.iter().zip(&b).map(|(a, b)| a / b - 1.0));
        }
        let count = changes.len() as f64;
        let mean = changes.iter().sum::<f64>() / count;
        let variance = changes.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count - 1.0) / count;
        if (by_check - mean).abs() > FAR * error.hypot(variance.sqrt()) + LEFT_OUT {
            return Some(Outcome::Broken(format!(
                "{difference} of the check is {by_check:.4} ± {error:.4}, and by hand {mean:.4} ± {:.4}",
                variance.sqrt()
            )));
        }
    }
    Some(Outcome::Holds)
}

pub fn half_the_step(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    refined(program, drawn, results, "run.time_step", "step_check")
}

pub fn half_the_elements(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    refined(program, drawn, results, "fibre.element_length", "mesh_check")
}

/// Numbers of the whole web, which do not depend on its size or on what a layer is.
fn is_of_the_sheet(name: &Name) -> bool {
    OF_SIZE.iter().all(|start| !name.0.contains(start))
}

/// Layers in another order are the same web.
pub fn layers_turned(program: &Program, drawn: &Drawn, _: &Json) -> Outcome {
    let text = Lines::new(&with_folder(drawn.base.text)).with_turned_layers().text();
    let turned = drawn.map(|Change { key, value }| {
        let key = match key.split_once('.').filter(|(first, _)| *first == "layer") {
            Some((_, rest)) if rest.starts_with('1') => format!("layer.2{}", &rest[1..]),
            Some((_, rest)) => format!("layer.1{}", &rest[1..]),
            None => key.clone(),
        };
        Change::new(&key, value.clone())
    });
    pairs("with its layers in another order", is_of_the_sheet, |number| {
        let ours = program.numbers(&with_seed(drawn, 2 * number))?;
        let other = with_seed(&turned, 2 * number + 1);
        let set = other.changes.iter().map(|Change { key, value }| format!("--set={key}={value}"));
        let said = program.computed_text("web", &text, &set.collect::<Vec<_>>());
        Some((ours, numbers(&said.results()?)))
    })
}

/// A web whose defect lies elsewhere across it. What is sold of it may have the defect or not.
pub fn shifted_across(program: &Program, drawn: &Drawn, _: &Json) -> Outcome {
    const DEFECT: &str = "layer.1.line.defects.1.from";
    let is_in_the_way = |change: &Change| change.key == DEFECT || change.key == "web.edges";
    if drawn.changes.iter().any(is_in_the_way) {
        return Outcome::Refused;
    }
    let shifted = drawn.with(&[Change::new(DEFECT, "0.05 m")]);
    let is_of_the_web = |name: &Name| is_of_the_sheet(name) && !name.0.starts_with("fabric");
    pairs("with its defect elsewhere", is_of_the_web, |number| {
        let ours = program.numbers(&with_seed(drawn, 2 * number))?;
        Some((ours, program.numbers(&with_seed(&shifted, 2 * number + 1))?))
    })
}

/// A layer as two layers of half as many filaments each.
pub fn two_equal_layers(program: &Program, drawn: &Drawn, _: &Json) -> Outcome {
    let mut text = Lines::new(&with_folder(drawn.base.text));
    if !drawn.changes.iter().all(|Change { key, value }| text.set(key, value)) {
        return Outcome::Refused;
    }
    let half = |value: &str| Some(value.trim_matches('"').parse::<u64>().ok()? / 2);
    let layers = text.with_two_layers(&["fibre", "laydown", "line"], |number, key, value| {
        let name = key.split_once('.').map_or(key, |(_, name)| name);
        match key {
            "line.belt_speed" | "line.basis_weight" if number > 0 => None,
            "line.filaments_per_metre" => Some(format!("{name} = {}", half(value)?)),
            _ => Some(format!("{name} = {value}")),
        }
    });
    let text = layers.text();
    pairs("as two equal layers", is_of_the_sheet, |number| {
        let ours = program.numbers(&with_seed(drawn, 2 * number))?;
        let seeds = drawn.base.seeds(seed(drawn, 2 * number + 1));
        let set = seeds.iter().map(|Change { key, value }| format!("--set={key}={value}"));
        let others = numbers(&program.computed_text("web", &text, &set.collect::<Vec<_>>()).results()?);
        Some((ours, others))
    })
}

/// A sheet that is twice as wide.
pub fn twice_as_wide(program: &Program, drawn: &Drawn, _: &Json) -> Outcome {
    // Positions of rows and defects across the web would be others.
    if drawn.base.has_layers() {
        return Outcome::Refused;
    }
    twice(program, drawn, "width")
}

/// A sheet that is twice as long.
pub fn twice_as_long(program: &Program, drawn: &Drawn, _: &Json) -> Outcome {
    // A defect that begins later would be on another part of it.
    if drawn.changes.iter().any(|change| change.key.ends_with("after")) {
        return Outcome::Refused;
    }
    twice(program, drawn, "length")
}

fn twice(program: &Program, drawn: &Drawn, side: &str) -> Outcome {
    let own = Lines::new(drawn.base.text).value("web", side).expect("a side");
    let metres: f64 = own.trim_end_matches(" m").parse().expect("metres");
    let large = drawn.with(&[Change::new(&format!("web.{side}"), format!("{} m", 2.0 * metres))]);
    pairs(&format!("of a sheet of twice the {side}"), is_of_the_sheet, |number| {
        let ours = program.numbers(&with_seed(drawn, 2 * number))?;
        Some((ours, program.numbers(&with_seed(&large, 2 * number + 1))?))
    })
}

/// The CV of independent filaments at random places is that which a single one makes, in closed form.
pub fn independent(program: &Program, drawn: &Drawn, _: &Json) -> Outcome {
    if drawn.changes.iter().any(|change| ["line.slot_gap", "web.edges"].contains(&change.key.as_str())) {
        return Outcome::Refused;
    }
    const OF_WEB: &str = "web.patches.cv";
    const OF_ONE: &str = "web.patches.cv_one_fibre";
    pairs(
        "from a single filament",
        |name| name.0 == OF_WEB,
        |number| {
            let ours = program.numbers(&with_seed(drawn, number))?;
            let of_one =
                |(name, own): (&Name, &Reported)| Some(((OF_WEB.to_owned(), name.1.clone()), own.clone()));
            let others = ours.iter().filter(|(name, _)| name.0 == OF_ONE).filter_map(of_one).collect();
            Some((ours, others))
        },
    )
}

/// A sample of the filaments and all filaments in the same air.
pub fn few_and_all(program: &Program, drawn: &Drawn, _: &Json) -> Outcome {
    let all = drawn.with(&[Change::new("web.simulated", "all")]);
    /// The error by the sample alone is known within this factor: on sheets of few clouds fillings may agree.
    const KNOWN_WITHIN: f64 = 2.0;
    // Both are in the same air, and differ by what the sample of filaments leaves open.
    let of_sample = |of: Numbers| {
        let own = |(name, own): (Name, Reported)| {
            let error = own.of_sample.map_or(own.error, |error| KNOWN_WITHIN * error);
            (name, Reported { error, ..own })
        };
        of.into_iter().map(own).collect::<Numbers>()
    };
    pairs("of all filaments", is_of_the_sheet, |number| {
        let ours = program.numbers(&with_seed(drawn, number))?;
        Some((of_sample(ours), of_sample(program.numbers(&with_seed(&all, number))?)))
    })
}

/// Two runs that differ in their seed are not found different more often than once in twenty.
pub fn nothing_changed(program: &Program, drawn: &Drawn, _: &Json) -> Outcome {
    for (number, name) in ["one", "other"].into_iter().enumerate() {
        program.new_place(name);
        let said = program.computed(&with_seed(drawn, number as u64), &[&format!("--out={name}")]);
        if !matches!(said, Said::Results(_)) {
            return Outcome::Refused;
        }
    }
    let Some(found) = program.compared("one", "other") else { return Outcome::Refused };
    let measures = found["comparisons"][0]["measures"].as_object();
    let claims = measures
        .into_iter()
        .flatten()
        .filter_map(|(name, of)| Some((format!("{} {name}", drawn.base.name), of["significant"].as_bool()?)));
    Outcome::Claims(claims.collect())
}
