//! Asks for the numbers of a line that are not given.

use crate::args::Need::{IfKnown, Needed};
use crate::args::{Arguments, Invocation, QUESTIONS};
use crate::failure::Failure;
use crate::say;
use clap::CommandFactory;
use spunlaid::ground::Fault;
use spunlaid::ground::error::{by_count, listed};
use std::error::Error;
use std::ffi::OsString;
use std::io::BufRead;

/// The numbers that are missing, as options of a command line, from a person's answers. Where nobody answers, those
/// that cannot be missing are refused.
///
/// * `answers` – lines that a person types, or that come through a pipe
pub(super) fn ask(invocation: &Invocation, answers: &mut impl BufRead) -> Result<Vec<OsString>, Failure> {
    let is_known = |options: &[&str]| options.iter().any(|option| invocation.has(option));
    let open: Vec<_> = QUESTIONS.into_iter().filter(|(options, ..)| !is_known(options)).collect();
    let name = |options: &[&str]| match options {
        [one, other] => format!("--{one} (or --{other})"),
        _ => format!("--{}", options.concat()),
    };
    let needed = open.iter().filter(|(_, need, ..)| *need == Needed);
    let missing: Vec<String> = needed.map(|(options, ..)| name(options)).collect();
    if missing.is_empty() {
        return Ok(Vec::new());
    }
    if answers.fill_buf().map_or(true, <[u8]>::is_empty) {
        let are = by_count(missing.len() as u64, ("is", "are"));
        let message = format!("the numbers of the line are incomplete: {} {are} missing", listed(&missing));
        let remedy =
            "give them, or call the command in a terminal, where it asks; `spunlaid new --help` has examples";
        return Err(Fault::new(message, remedy).into());
    }
    let mut given = Vec::new();
    for (options, need, question, usual) in open {
        // Again and again until the answer can be read.
        loop {
            say::prompt(&format!("{question} [{usual}]: "));
            let mut answer = String::new();
            let is_there = answers.read_line(&mut answer).is_ok_and(|bytes| bytes > 0);
            let answer = match answer.trim() {
                "" if need == IfKnown => break,
                _ if !is_there => {
                    let message = format!("the answers end before \"{question}\"");
                    return Err(Fault::new(message, "answer each question").into());
                }
                "" => usual,
                answer => answer,
            };
            match as_option(options, answer) {
                Ok(option) => {
                    given.push(option);
                    break;
                }
                Err(why) => say::aside(&format!("\"{answer}\" {why}")),
            }
        }
    }
    Ok(given)
}

/// An answer as the first of these options that can read it, or why the first one cannot.
fn as_option(options: &[&str], answer: &str) -> Result<OsString, String> {
    let read = |option: &&str| {
        let word = format!("--{option}={answer}");
        let read = Arguments::command().try_get_matches_from(["spunlaid", "new", "-", "--web", &word]);
        let why = |error: clap::Error| error.source().map_or_else(String::new, ToString::to_string);
        read.map(|_| word.into()).map_err(why)
    };
    let either = |first: Result<_, _>, other: Result<_, _>| first.or_else(|why| other.map_err(|_| why));
    options.iter().map(read).reduce(either).unwrap_or_else(|| Err(String::new()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::expect_used)]

    use super::*;
    use crate::args::{Command, LineNumbers, value};
    use crate::parse;

    /// The numbers of a line with these options, and the answers to what is missing.
    fn complete(options: &[&str], mut answers: &[u8]) -> Result<LineNumbers, Failure> {
        let words = ["spunlaid", "new", "-", "--web"].iter().chain(options);
        let mut words: Vec<OsString> = words.map(OsString::from).collect();
        words.extend(ask(&parse(&words).expect("options").0, &mut answers)?);
        match parse(&words).expect("answers").1.command {
            Command::New(new) => Ok(new.line),
            other => unreachable!("{other:?}"),
        }
    }

    #[test]
    fn asks_for_what_is_missing_until_it_can_be_read() {
        // Polymer, basis weight with two answers that cannot be read, width, holes with one, beams, air,
        // distance. A number without a unit has that of the question.
        let given = ["--throughput", "0.6 g/min", "--diameter", "16 µm"];
        let answers = "PET\ntwenty\n15 dtex\n15\n4.5\n0\n\n2\n70\n500 mm\n";
        let numbers = complete(&given, answers.as_bytes()).expect("all answers");
        assert_eq!(value(&numbers.polymer).map(|polymer| polymer.name()), Some("pet"));
        assert_eq!(
            [&numbers.throughput, &numbers.diameter, &numbers.dtex].map(value),
            [Some(0.6 / 60_000.0), Some(16e-6), None]
        );
        assert_eq!((value(&numbers.basis_weight), numbers.width.value), (Some(0.015), 4.5));
        assert_eq!((numbers.holes_per_metre, numbers.beams), (Some(5000), 2));
        assert_eq!((value(&numbers.air_speed), numbers.distance.value), (Some(70.0), 0.5));
        // What need not be known stays away where the answers end.
        assert_eq!([&numbers.slot_gap, &numbers.turbulence, &numbers.thickness].map(value), [None; 3]);
        let remarks: Vec<&str> = numbers.remarks().collect();
        assert_eq!(
            remarks,
            [
                "15 has no unit and is taken as 15 g/m²",
                "70 has no unit and is taken as 70 m/s",
                "4.5 has no unit and is taken as 4.5 m"
            ]
        );
        let answers = "\n0,6\n\n250 m/min\n\n\n\n\n\n25\n12 %\n0,3 mm\n";
        let known = complete(&[], answers.as_bytes()).expect("all answers");
        assert_eq!((value(&known.basis_weight), value(&known.belt_speed)), (None, Some(250.0 / 60.0)));
        assert_eq!(
            [&known.throughput, &known.slot_gap, &known.turbulence, &known.thickness].map(value),
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
        let refused = complete(&[], "pp\n".as_bytes()).map(|_| ()).unwrap_err().to_string();
        assert!(refused.contains("the answers end before \"Throughput of a hole\""), "{refused}");
    }

    #[test]
    fn a_number_is_read_however_it_is_written() {
        // All that a line cannot be without but the one that is tried.
        let needed =
            ["--polymer=pp", "--throughput=1", "--dtex=2", "--basis-weight=9", "--holes=9", "--width=1"];
        let with = |option: &str, text: &str| {
            let others = needed.iter().filter(|other| !other.starts_with(option)).copied();
            let word = as_option(&[&option[2..]], text)?.into_string().unwrap_or_default();
            let options: Vec<&str> = others.chain(["--air-speed=60 m/s", &word]).collect();
            complete(&options, b"").map_err(|failure| failure.to_string())
        };
        for text in ["0.55", "0.55 g/min", "0.55 g/min/hole", "0.55 g/(min hole)", " 0.55 ghm "] {
            let line = with("--throughput", text).expect(text);
            assert_eq!(value(&line.throughput), Some(0.55 / 60_000.0), "{text}");
        }
        for text in ["0.1", "10 %"] {
            assert_eq!(value(&with("--turbulence", text).expect(text).turbulence), Some(0.1), "{text}");
        }
        let polymer = |text: &str| Ok::<_, String>(with("--polymer", text)?.polymer.expect("it was given"));
        for text in ["PP, MFR 35 g/10min", "pp (MFI 35)", "PP 35 g/10 min", "MFR 35 pp"] {
            let given = polymer(text).expect(text);
            assert_eq!(given.value.name(), "pp");
            assert!(given.remark.is_some_and(|remark| remark.contains("--melt-flow-rate")), "{text}");
        }
        assert_eq!(polymer("PA 6, melt flow rate 3").expect("two words").value.name(), "pa6");
        assert!(polymer(" Pa-6 ").is_ok_and(|given| given.value.name() == "pa6" && given.remark.is_none()));
        assert!(polymer("MFR 35").is_err_and(|why| why.contains("before the melt flow rate")));
        assert!(polymer("pp pet").is_err() && polymer("nylon").is_err());
    }
}
