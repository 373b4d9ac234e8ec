//! Looks for wrong numbers where no test looks: inputs drawn at random from the tables of keys, held against relations
//! that hold whatever the numbers are.
//!
//!     release/prove --minutes 10 --seed 3
//!     release/prove --only threads --base web
//!
//! A finding is shrunk to the fewest keys and printed with the command that shows it; the exit code is then 1.
//!
//! `--keys` says which keys are drawn, `--draw N` repeats one draw, `--first` stops at the first finding,
//! `--threads` is the number of inputs at a time. `--python PYTHON` is one that has the packages spunlaid
//! and polars: the relation `python` is held with it.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, clippy::print_stderr)]

mod draw;
mod evidence;
mod lines;
mod numbers;
mod program;
mod relations;

use draw::{BASES, Base, Drawn, Random, drawn_keys};
use evidence::{Claims, Evidence, TOO_SMALL_IN_ALL};
use program::{Program, Said};
use relations::{Deviation, Outcome, PYTHON, RELATIONS, Relation};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// How often a relation was tried.
#[derive(Default)]
struct Tally {
    held: u64,
    broken: u64,
    refused: u64,
    seconds: f64,
}

/// What is looked at.
struct Search {
    seed: u64,
    /// One draw, or all that there is time for.
    draw: Option<u64>,
    most: Duration,
    /// Whether nothing is looked at after the first finding.
    first: bool,
    relations: Vec<&'static Relation>,
    bases: Vec<&'static Base>,
}

/// What was found so far.
#[derive(Default)]
struct Found {
    draws: u64,
    tallies: BTreeMap<(&'static str, &'static str), Tally>,
    claims: BTreeMap<String, Claims>,
    /// Against the errors of a number in all inputs of a kind, by relation, input and number.
    evidence: BTreeMap<String, Evidence>,
    /// What has been printed: of each relation, input and number the first one.
    printed: BTreeSet<String>,
}

fn main() {
    let words: Vec<String> = std::env::args().collect();
    if words.iter().any(|word| word == "--keys") {
        let [drawn, others] = drawn_keys();
        println!("{} keys are drawn: {}", drawn.len(), drawn.join(", "));
        return println!("\n{} keys are not: {}", others.len(), others.join(", "));
    }
    let word_after = |name: &str| Some(&words[words.iter().position(|word| word == name)? + 1]);
    let number = |name: &str| word_after(name).map(|word| word.parse::<f64>().expect("a number"));
    let is_asked = |name: &str, of: &str| word_after(name).is_none_or(|word| word == of);
    let python = word_after("--python").map_or("", String::as_str);
    let is_held = |relation: &&Relation| {
        is_asked("--only", relation.name) && (relation.name != PYTHON || !python.is_empty())
    };
    let relations: Vec<&Relation> = RELATIONS.iter().filter(is_held).collect();
    let has_relation =
        |base: &&'static Base| relations.iter().any(|relation| relation.applies(&base.unchanged()));
    let search = Search {
        seed: number("--seed").unwrap_or(1.0) as u64,
        draw: number("--draw").map(|draw| draw as u64),
        most: Duration::from_secs_f64(60.0 * number("--minutes").unwrap_or(1.0)),
        first: words.iter().any(|word| word == "--first"),
        bases: BASES.iter().filter(|base| is_asked("--base", base.name) && has_relation(base)).collect(),
        relations,
    };
    let names = || RELATIONS.iter().map(|relation| relation.name).collect::<Vec<_>>();
    assert!(!search.relations.is_empty(), "the relations are {:?}", names());
    assert!(!search.bases.is_empty(), "the bases are {:?}", BASES.map(|base| base.name));
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = number("--threads").map_or(threads, |threads| threads as usize);
    let found = Mutex::default();
    let next = AtomicU64::new(0);
    let begun = Instant::now();
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                let program = Program::new(python);
                while begun.elapsed() < search.most && !search.is_over(&found) {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    match search.draw {
                        Some(draw) if number == 0 => search.look_at(draw, &program, &found),
                        Some(_) => break,
                        None => search.look_at(number, &program, &found),
                    }
                }
            });
        }
    });
    std::process::exit(i32::from(found.into_inner().expect("what was found").report()));
}

impl Search {
    fn is_over(&self, found: &Mutex<Found>) -> bool {
        self.first && found.lock().expect("what was found").is_broken()
    }

    /// Holds one draw against the relations.
    fn look_at(&self, number: u64, program: &Program, found: &Mutex<Found>) {
        let mut random = Random::new(self.seed, number);
        let weights: Vec<f64> = self.bases.iter().map(|base| base.weight).collect();
        let base = self.bases[random.weighted(&weights)];
        let (drawn, results) =
            accepted(program, Drawn::new(base, self.seed * 1_000_000 + number, &mut random));
        let add = |relation: &'static str, outcome: &Outcome, seconds: f64| {
            found.lock().expect("what was found").add(relation, base.name, outcome, seconds);
        };
        found.lock().expect("what was found").draws += 1;
        let Said::Results(results) = results else {
            println!(
                "\nFINDING: --seed {} --draw {number} --base {}\n{}\n{}",
                self.seed,
                base.name,
                results.words(),
                drawn.command()
            );
            return add("is computed", &Outcome::Broken(String::new()), 0.0);
        };
        for relation in &self.relations {
            let is_chosen = self.relations.len() == 1 || random.is_within(relation.share);
            if !relation.applies(&drawn) || !is_chosen || self.is_over(found) {
                continue;
            }
            let begun = Instant::now();
            let outcome = relation.holds(program, &drawn, &results);
            add(relation.name, &outcome, begun.elapsed().as_secs_f64());
            if let Outcome::Broken(said) = outcome
                && found.lock().expect("what was found").is_new(relation.name, base.name, &said)
            {
                let (fewest, said) = shrunk(relation, program, drawn.clone(), said);
                println!(
                    "\nFINDING: --seed {} --draw {number} --base {} --only '{}'\n{said}\n{}",
                    self.seed,
                    base.name,
                    relation.name,
                    fewest.command()
                );
            }
        }
    }
}

impl Found {
    /// Whether no other input has shown this of a relation. Its words begin with the name of the number.
    fn is_new(&mut self, relation: &str, base: &str, said: &str) -> bool {
        let number: Vec<&str> = said.split(' ').take(2).collect();
        self.printed.insert(format!("{relation} {base} {}", number.join(" ")))
    }

    fn add(&mut self, relation: &'static str, base: &'static str, outcome: &Outcome, seconds: f64) {
        let tally = self.tallies.entry((relation, base)).or_default();
        tally.seconds += seconds;
        match outcome {
            Outcome::Holds => tally.held += 1,
            Outcome::Deviations(deviations) => {
                tally.held += 1;
                for Deviation { name: (number, of), of: deviation, degrees, .. } in deviations {
                    let name = format!("{relation}, {base}: {number} {of}");
                    let evidence =
                        self.evidence.entry(name.clone()).or_insert_with(|| Evidence::new(&TOO_SMALL_IN_ALL));
                    evidence.take(*deviation, *degrees);
                    if evidence.is_enough() && self.printed.insert(name.clone()) {
                        println!(
                            "\nFINDING: after {} draws the errors of all inputs together are too small: {name} \
                             (evidence {evidence})",
                            self.draws
                        );
                    }
                }
            }
            Outcome::Refused => tally.refused += 1,
            Outcome::Broken(_) => tally.broken += 1,
            Outcome::Claims(claims) => {
                tally.held += 1;
                for (name, is_false) in claims {
                    self.claims.entry(name.clone()).or_default().take(*is_false);
                }
            }
        }
    }

    /// Prints what was found, and whether something does not hold.
    fn report(&self) -> bool {
        println!("\n{} draws", self.draws);
        println!(
            "{:18} {:10} {:>7} {:>7} {:>7} {:>9}",
            "relation", "input", "held", "broken", "refused", "seconds"
        );
        for ((relation, base), Tally { held, broken, refused, seconds }) in &self.tallies {
            println!("{relation:18} {base:10} {held:>7} {broken:>7} {refused:>7} {seconds:>9.1}");
        }
        let wrong: Vec<_> = self.claims.iter().filter(|(_, claims)| claims.are_wrong()).collect();
        for (name, claims) in &wrong {
            println!(
                "\nFINDING: {name} is found changed where nothing is: {} of {}",
                claims.false_ones, claims.all
            );
        }
        let all: u64 = self.claims.values().map(|claims| claims.all).sum();
        let false_ones: u64 = self.claims.values().map(|claims| claims.false_ones).sum();
        println!("claims that something has changed where nothing has: {false_ones} of {all}");
        let largest = self.evidence.iter().max_by(|(_, a), (_, b)| a.value().total_cmp(&b.value()));
        if let Some((name, evidence)) = largest {
            println!("largest evidence against errors of all inputs together: {evidence} against {name}");
        }
        self.is_broken() || !wrong.is_empty()
    }

    /// Whether some relation does not hold of some input, or of all.
    fn is_broken(&self) -> bool {
        self.tallies.values().any(|tally| tally.broken > 0) || self.evidence.values().any(Evidence::is_enough)
    }
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
