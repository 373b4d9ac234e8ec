//! Asks for the numbers of a line that are not given.

use crate::args::{
    LineNumbers, basis_weight, beams, belt_speed, depth, holes, length, polymer, speed, throughput, titre,
    turbulence,
};
use crate::failure::Failure;
use crate::say;
use spunlaid::ground::Fault;
use std::io::BufRead;

/// The numbers with those that were missing, from a person's answers. Where nobody answers, those that cannot be
/// missing are refused.
///
/// * `answers` – lines that a person types, or that come through a pipe
pub(super) fn complete(mut numbers: LineNumbers, answers: &mut impl BufRead) -> Result<LineNumbers, Failure> {
    let missing = missing(&numbers);
    if missing.is_empty() {
        return Ok(numbers);
    }
    if answers.fill_buf().map_or(true, <[u8]>::is_empty) {
        let message = format!("the numbers of the line are incomplete: {} missing", is_or_are(&missing));
        let remedy =
            "give them, or call the command in a terminal, where it asks; `spunlaid new --help` has examples";
        return Err(Fault::new(message, remedy).into());
    }
    ask(answers, &mut numbers.polymer, "Polymer: pp, pet, pa6 or pla", "pp", polymer)?;
    ask(answers, &mut numbers.throughput, "Throughput of a hole", "0.5 g/min", throughput)?;
    if numbers.diameter.is_none() {
        ask(answers, &mut numbers.dtex, "Titre of a filament", "2 dtex", titre)?;
    }
    if numbers.belt_speed.is_none() && numbers.basis_weight.is_none() {
        let mut weight_or_speed = None;
        let read =
            |text: &str| basis_weight(text).map(Ok).or_else(|why| belt_speed(text).map(Err).map_err(|_| why));
        ask(answers, &mut weight_or_speed, "Basis weight of the web, or speed of its belt", "20 g/m²", read)?;
        match weight_or_speed {
            Some(Ok(weight)) => numbers.basis_weight = Some(weight),
            Some(Err(speed)) => numbers.belt_speed = Some(speed),
            None => {}
        }
    }
    ask(answers, &mut numbers.width, "Width of the web", "1 m", length)?;
    if numbers.holes.is_none() {
        ask(answers, &mut numbers.holes_per_metre, "Holes of a beam per metre of width", "5000", holes)?;
    }
    ask(answers, &mut numbers.beams, "Number of equal beams", "1", beams)?;
    ask(answers, &mut numbers.air_speed, "Speed of the air at the end of the slot", "60 m/s", speed)?;
    ask(answers, &mut numbers.distance, "Distance from the slot to the belt", "0.5 m", length)?;
    ask_if_known(answers, &mut numbers.slot_depth, "Depth of the slot", "20 mm, a guess", depth)?;
    ask_if_known(
        answers,
        &mut numbers.turbulence,
        "Turbulence of the air at its end",
        "10 %, a guess",
        turbulence,
    )?;
    ask_if_known(answers, &mut numbers.thickness, "Thickness of the finished fabric", "not known", depth)?;
    Ok(numbers)
}

/// The options without which there is no line.
fn missing(numbers: &LineNumbers) -> Vec<&'static str> {
    let needed = [
        (numbers.polymer.is_some(), "--polymer"),
        (numbers.throughput.is_some(), "--throughput"),
        (numbers.dtex.is_some() || numbers.diameter.is_some(), "--dtex (or --diameter)"),
        (numbers.basis_weight.is_some() || numbers.belt_speed.is_some(), "--basis-weight (or --belt-speed)"),
        (numbers.holes_per_metre.is_some() || numbers.holes.is_some(), "--holes-per-metre (or --holes)"),
        (numbers.air_speed.is_some(), "--air-speed"),
    ];
    needed.into_iter().filter(|(is_there, _)| !is_there).map(|(_, option)| option).collect()
}

/// `--dtex is`, `--dtex and --polymer are`.
fn is_or_are(options: &[&str]) -> String {
    match options {
        [one] => format!("{one} is"),
        [more @ .., last] => format!("{} and {last} are", more.join(", ")),
        [] => String::new(),
    }
}

/// Asks for a value that is not there, again and again until the answer can be read. An empty answer is the
/// usual value.
fn ask<T>(
    answers: &mut impl BufRead,
    value: &mut Option<T>,
    question: &str,
    usual: &str,
    read: impl Fn(&str) -> Result<T, String>,
) -> Result<(), Failure> {
    while value.is_none() {
        let answer = answer(answers, question, usual).ok_or_else(|| {
            Fault::new(format!("the answers end before \"{question}\""), "answer each question")
        })?;
        *value = understood(if answer.is_empty() { usual } else { &answer }, &read);
    }
    Ok(())
}

/// As [`ask`] for a value that need not be known: it stays away after an empty answer, and without one.
fn ask_if_known<T>(
    answers: &mut impl BufRead,
    value: &mut Option<T>,
    question: &str,
    otherwise: &str,
    read: impl Fn(&str) -> Result<T, String>,
) -> Result<(), Failure> {
    while value.is_none() {
        match answer(answers, question, otherwise).filter(|answer| !answer.is_empty()) {
            Some(answer) => *value = understood(&answer, &read),
            None => break,
        }
    }
    Ok(())
}

/// The answer to a question; None where the answers end.
fn answer(answers: &mut impl BufRead, question: &str, usual: &str) -> Option<String> {
    say::prompt(&format!("{question} [{usual}]: "));
    let mut answer = String::new();
    let is_there = answers.read_line(&mut answer).is_ok_and(|bytes| bytes > 0);
    is_there.then(|| answer.trim().to_owned())
}

/// The value of an answer; None, with the reason for the person, if it cannot be read.
fn understood<T>(answer: &str, read: impl Fn(&str) -> Result<T, String>) -> Option<T> {
    read(answer).inspect_err(|why| say::aside(&format!("\"{answer}\" {why}"))).ok()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::expect_used)]

    use super::*;
    use crate::args::Given;

    #[test]
    fn asks_for_what_is_missing_until_it_can_be_read() {
        let given = LineNumbers {
            throughput: Some(1e-5.into()),
            diameter: Some(16e-6.into()),
            ..LineNumbers::default()
        };
        // Polymer, basis weight with two answers that cannot be read, width, holes with one, beams, air,
        // distance. A number without a unit has that of the question.
        let mut answers = "PET\ntwenty\n15 dtex\n15\n4.5\n0\n\n2\n70\n500 mm\n".as_bytes();
        let numbers = complete(given, &mut answers).unwrap_or_default();
        let value = |given: &Option<Given<f64>>| given.as_ref().map(|given| given.value);
        assert_eq!(numbers.polymer.as_ref().map(|given| given.value.name()), Some("pet"));
        assert_eq!(
            [&numbers.throughput, &numbers.diameter, &numbers.dtex].map(value),
            [Some(1e-5), Some(16e-6), None]
        );
        assert_eq!((value(&numbers.basis_weight), value(&numbers.width)), (Some(0.015), Some(4.5)));
        assert_eq!((numbers.holes_per_metre, numbers.beams), (Some(5000), Some(2)));
        assert_eq!((value(&numbers.air_speed), value(&numbers.distance)), (Some(70.0), Some(0.5)));
        // What need not be known stays away where the answers end.
        assert_eq!([&numbers.slot_depth, &numbers.turbulence, &numbers.thickness].map(value), [None; 3]);
        assert_eq!(
            [turbulence("0.1"), turbulence("10 %")].map(|of| of.map(|of| of.value)),
            [Ok(0.1), Ok(0.1)]
        );
        let remarks: Vec<&str> = numbers.remarks().collect();
        assert_eq!(
            remarks,
            [
                "15 has no unit and is taken as 15 g/m²",
                "70 has no unit and is taken as 70 m/s",
                "4.5 has no unit and is taken as 4.5 m"
            ]
        );
        let mut answers = "\n0,6\n\n250 m/min\n\n\n\n\n\n25\n12 %\n0,3 mm\n".as_bytes();
        let known = complete(LineNumbers::default(), &mut answers).unwrap_or_default();
        assert_eq!((value(&known.basis_weight), value(&known.belt_speed)), (None, Some(250.0 / 60.0)));
        assert_eq!(
            [&known.throughput, &known.slot_depth, &known.turbulence, &known.thickness].map(value),
            [Some(0.6 / 60_000.0), Some(0.025), Some(0.12), Some(3e-4)]
        );
        let remarks: Vec<&str> = known.remarks().collect();
        assert_eq!(
            remarks,
            [
                "0,6 has a decimal comma and is taken as 0.6 g/min",
                "25 has no unit and is taken as 25 mm",
                "0,3 mm has a decimal comma and is taken as 0.3 mm"
            ]
        );
        for text in ["0.55", "0.55 g/min", "0.55 g/min/hole", "0.55 g/(min hole)", " 0.55 ghm "] {
            assert_eq!(throughput(text).map(|given| given.value), Ok(0.55 / 60_000.0), "{text}");
        }
        for text in ["PP, MFR 35 g/10min", "pp (MFI 35)", "PP 35 g/10 min", "MFR 35 pp"] {
            let given = polymer(text).expect(text);
            assert_eq!(given.value.name(), "pp");
            assert!(given.remark.is_some_and(|remark| remark.contains("spinline.melt_flow_rate")), "{text}");
        }
        assert_eq!(polymer("PA 6, melt flow rate 3").expect("two words").value.name(), "pa6");
        assert!(polymer(" Pa-6 ").is_ok_and(|given| given.value.name() == "pa6" && given.remark.is_none()));
        assert!(polymer("MFR 35").is_err_and(|why| why.contains("before the melt flow rate")));
        assert!(polymer("pp pet").is_err() && polymer("nylon").is_err());
        let message = complete(LineNumbers::default(), &mut "pp\n".as_bytes()).unwrap_err().to_string();
        assert!(message.contains("the answers end before \"Throughput of a hole\""), "{message}");
    }
}
