//! Asks for the numbers of a line that are not given.

use crate::args::{
    LineNumbers, MOST_BEAMS, MOST_HOLES, basis_weight, length, polymer, speed, throughput, titre,
};
use crate::failure::Failure;
use crate::say;
use spunlaid::error::Fault;
use std::io::BufRead;

/// The numbers with those that were missing, from a person's answers; without one to ask, those that cannot be missing are
/// refused.
///
/// * `answers` – lines that a person types
pub(super) fn complete(
    mut numbers: LineNumbers,
    mut answers: Option<&mut impl BufRead>,
) -> Result<LineNumbers, Failure> {
    let Some(answers) = &mut answers else {
        let missing = missing(&numbers);
        if missing.is_empty() {
            return Ok(numbers);
        }
        let message = format!("the numbers of the line are incomplete: {} missing", is_or_are(&missing));
        let remedy =
            "give them, or call the command in a terminal, where it asks; `spunlaid new --help` has examples";
        return Err(Fault::new(message, remedy).into());
    };
    let [holes, beams] = [MOST_HOLES, MOST_BEAMS].map(read_number);
    ask(answers, &mut numbers.polymer, "Polymer: pp, pet, pa6 or pla", "pp", polymer)?;
    ask(answers, &mut numbers.throughput, "Throughput of a hole", "0.5 g/min", throughput)?;
    if numbers.diameter.is_none() {
        ask(answers, &mut numbers.dtex, "Titre of a filament", "2 dtex", titre)?;
    }
    ask(answers, &mut numbers.basis_weight, "Basis weight of the web", "20 g/m²", basis_weight)?;
    ask(answers, &mut numbers.width, "Width of the web", "1 m", length)?;
    if numbers.holes.is_none() {
        ask(answers, &mut numbers.holes_per_metre, "Holes of a beam per metre of width", "5000", holes)?;
    }
    ask(answers, &mut numbers.beams, "Number of equal beams", "1", beams)?;
    ask(answers, &mut numbers.air_speed, "Speed of the air at the end of the slot", "60 m/s", speed)?;
    ask(answers, &mut numbers.distance, "Distance from the slot to the belt", "0.5 m", length)?;
    Ok(numbers)
}

/// Reads a whole number from 1.
fn read_number(most: u64) -> impl Fn(&str) -> Result<u64, String> {
    move |text| {
        let number = text.parse().ok().filter(|number| (1..=most).contains(number));
        number.ok_or_else(|| format!("write a whole number from 1 to {most}"))
    }
}

/// The options without which there is no line.
fn missing(numbers: &LineNumbers) -> Vec<&'static str> {
    let needed = [
        (numbers.polymer.is_some(), "--polymer"),
        (numbers.throughput.is_some(), "--throughput"),
        (numbers.dtex.is_some() || numbers.diameter.is_some(), "--dtex (or --diameter)"),
        (numbers.basis_weight.is_some(), "--basis-weight"),
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

/// Asks for a value that is not there, again and again until the answer can be read. An empty answer is the usual value.
fn ask<T>(
    answers: &mut impl BufRead,
    value: &mut Option<T>,
    question: &str,
    usual: &str,
    read: impl Fn(&str) -> Result<T, String>,
) -> Result<(), Failure> {
    while value.is_none() {
        say::prompt(&format!("{question} [{usual}]: "));
        let mut answer = String::new();
        let is_there = answers.read_line(&mut answer).is_ok_and(|bytes| bytes > 0);
        if !is_there {
            return Err(Fault::new("the answers end too early", "answer each question").into());
        }
        let answer = if answer.trim().is_empty() { usual } else { answer.trim() };
        match read(answer) {
            Ok(found) => *value = Some(found),
            Err(why) => say::aside(&format!("\"{answer}\" {why}")),
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn asks_for_what_is_missing_until_it_can_be_read() {
        let given = LineNumbers { throughput: Some(1e-5), diameter: Some(16e-6), ..LineNumbers::default() };
        // Polymer, basis weight with two answers that cannot be read, width, holes, beams, air, distance. A number without a unit has that of the
        // question.
        let mut answers = "PET\ntwenty\n15 dtex\n15\n4.5\n\n2\n70\n500 mm\n".as_bytes();
        let numbers = complete(given, Some(&mut answers)).unwrap_or_default();
        assert_eq!(numbers.polymer.map(spunlaid::spinline::Polymer::name), Some("pet"));
        assert_eq!((numbers.throughput, numbers.diameter, numbers.dtex), (Some(1e-5), Some(16e-6), None));
        assert_eq!(
            (numbers.basis_weight, numbers.width, numbers.holes_per_metre),
            (Some(0.015), Some(4.5), Some(5000))
        );
        assert_eq!((numbers.beams, numbers.air_speed, numbers.distance), (Some(2), Some(70.0), Some(0.5)));
        assert_eq!(throughput("0.55 g/min/hole"), throughput("0.55"));
        assert_eq!(throughput("0.55 ghm"), Ok(0.55 / 60_000.0));
        let melt = polymer("PP, MFR 35 g/10min").unwrap_err();
        assert!(melt.contains("a melt flow rate changes nothing here"), "{melt}");
        let message = complete(LineNumbers::default(), Some(&mut "pp\n".as_bytes())).unwrap_err().to_string();
        assert!(message.contains("the answers end too early"), "{message}");
    }
}
