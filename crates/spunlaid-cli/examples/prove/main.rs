//! Looks for wrong numbers where no test looks: inputs drawn at random from the tables of keys, held against relations
//! that hold whatever the numbers are.
//!
//!     release/prove --minutes 10 --seed 3
//!     release/prove --only threads
//!
//! A finding is shrunk to the fewest keys and printed with the command that shows it; the exit code is then 1.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, clippy::print_stderr)]

mod draw;
mod program;
mod relations;

use draw::{BASES, Drawn, Random};
use program::{Program, Said};
use relations::{Outcome, RELATIONS, Relation};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// How often a relation was tried.
#[derive(Default)]
struct Tally {
    held: u64,
    broken: u64,
    refused: u64,
}

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let word_after = |name: &str| Some(&words[words.iter().position(|word| word == name)? + 1]);
    let number = |name: &str, or: f64| word_after(name).map_or(or, |word| word.parse().expect("a number"));
    let (minutes, seed) = (number("--minutes", 1.0), number("--seed", 1.0) as u64);
    let only = word_after("--only");
    let chosen: Vec<&Relation> =
        RELATIONS.iter().filter(|relation| only.is_none_or(|name| *name == relation.name)).collect();
    assert!(
        !chosen.is_empty(),
        "the relations are {:?}",
        RELATIONS.iter().map(|relation| relation.name).collect::<Vec<_>>()
    );
    let program = Program::new();
    let (begun, most) = (Instant::now(), Duration::from_secs_f64(60.0 * minutes));
    let mut tallies: BTreeMap<(&str, &str), Tally> = BTreeMap::new();
    for number in 0.. {
        if begun.elapsed() > most {
            break;
        }
        let mut random = Random::new(seed, number);
        let base = &BASES[random.weighted(&BASES.iter().map(|base| base.weight).collect::<Vec<_>>())];
        let (drawn, results) = accepted(&program, Drawn::new(base, &mut random));
        let Said::Results(results) = results else {
            println!("\nFINDING: seed {seed}, draw {number}\n{}\n{}", results.words(), drawn.command());
            tallies.entry(("is computed", base.name)).or_default().broken += 1;
            continue;
        };
        for relation in chosen.iter().filter(|relation| relation.applies(base)) {
            let tally = tallies.entry((relation.name, base.name)).or_default();
            match relation.holds(&program, &drawn, &results) {
                Outcome::Holds => tally.held += 1,
                Outcome::Refused => tally.refused += 1,
                Outcome::Broken(said) => {
                    tally.broken += 1;
                    let (fewest, said) = shrunk(relation, &program, drawn.clone(), said);
                    println!("\nFINDING: seed {seed}, draw {number}, relation {}\n{said}", relation.name);
                    println!("{}", fewest.command());
                }
            }
        }
    }
    println!("\n{:16} {:12} {:>8} {:>8} {:>8}", "relation", "input", "held", "broken", "refused");
    for ((relation, base), Tally { held, broken, refused }) in &tallies {
        println!("{relation:16} {base:12} {held:>8} {broken:>8} {refused:>8}");
    }
    let broken: u64 = tallies.values().map(|tally| tally.broken).sum();
    std::process::exit(i32::from(broken > 0));
}

/// The input without the changes that the program refuses, and its results, or why it has none.
fn accepted(program: &Program, mut drawn: Drawn) -> (Drawn, Said) {
    loop {
        match program.computed(&drawn, &[]) {
            Said::Refused(_) if drawn.changes.pop().is_some() => {}
            said => return (drawn, said),
        }
    }
}

/// The input with the fewest changed keys that still breaks a relation.
fn shrunk(relation: &Relation, program: &Program, mut drawn: Drawn, mut said: String) -> (Drawn, String) {
    let mut at = 0;
    while at < drawn.changes.len() {
        let mut fewer = drawn.clone();
        fewer.changes.remove(at);
        let outcome = match program.computed(&fewer, &[]) {
            Said::Results(results) => relation.holds(program, &fewer, &results),
            _ => Outcome::Refused,
        };
        match outcome {
            Outcome::Broken(words) => (drawn, said) = (fewer, words),
            _ => at += 1,
        }
    }
    (drawn, said)
}
