//! Whether the reported errors of a web are as large as its numbers scatter: all numbers of `summary.json` that
//! have an error, on lines drawn at random.
//!
//!     cargo run --release -p spunlaid-cli --example web_errors -- --known
//!     cargo run --release -p spunlaid-cli --example web_errors -- --shared --lines 3 --seeds 10
//!
//! `--against-all` compares simulated samples with all filaments in the same air. `--seed` draws other lines, `--write`
//! puts their files into a folder, `--threads` is the number of webs at a time.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, clippy::print_stderr)]

mod draw;
#[allow(dead_code)]
#[path = "../prove/numbers.rs"]
mod numbers;
mod scatter;
mod webs;

use draw::{Family, line};
use numbers::Numbers;
use scatter::{BOUNDS, Scatter, differences, scatter, table};
use spunlaid_ground::threads::par_map;
use std::collections::{BTreeMap, BTreeSet};
use std::time::Instant;

fn main() {
    let words: Vec<String> = std::env::args().collect();
    let is_asked = |name: &str| words.iter().any(|word| word == name);
    let word_after = |name: &str| Some(&words[words.iter().position(|word| word == name)? + 1]);
    let number = |name: &str, or: u64| word_after(name).map_or(or, |word| word.parse().expect("a number"));
    let lines = number("--lines", 6);
    let seeds = number("--seeds", 24);
    let seed = number("--seed", 1);
    let threads = std::thread::available_parallelism().map_or(1, usize::from) as u64;
    let threads = number("--threads", threads) as usize;
    let family = if is_asked("--shared") { Family::Shared } else { Family::Known };
    let mut all: Vec<(String, Scatter)> = Vec::new();
    let mut untested: BTreeSet<String> = BTreeSet::new();
    for number in 1..=lines {
        let (web, begun) = (line(family, seed, number), Instant::now());
        if let Some(folder) = word_after("--write") {
            std::fs::write(format!("{folder}/line_{number}.toml"), &web.text).expect("a file");
        }
        let of = |seed: usize, simulated: &str| {
            let found = webs::numbers_of(&web, 1 + seed as u64, simulated);
            found.inspect_err(|error| eprintln!("line {number}, seed {}: {error}", 1 + seed)).ok()
        };
        let first = of(0, "auto");
        // What cannot be laid once is tried no further.
        let seeds = if first.is_some() { seeds as usize } else { 0 };
        let found = if is_asked("--against-all") {
            let pairs = par_map(threads, seeds, |seed| Some([of(seed, "auto")?, of(seed, "all")?]));
            differences(number as usize, &pairs.into_iter().flatten().collect::<Vec<_>>())
        } else {
            let webs = par_map(threads, seeds.saturating_sub(1), |seed| of(1 + seed, "auto"));
            let webs: Vec<Numbers> = first.into_iter().chain(webs.into_iter().flatten()).collect();
            untested.extend(webs.iter().flat_map(BTreeMap::keys).map(|(name, _)| name.clone()));
            scatter(number as usize, &webs)
        };
        println!("Line {number}: {} numbers, {:.0} s", found.len(), begun.elapsed().as_secs_f64());
        found.iter().for_each(|(name, found)| print_if_outside(name, found));
        all.extend(found);
    }
    println!("\n{}", table(&all));
    untested.retain(|name| !all.iter().any(|(other, _)| other == name));
    println!("In too few webs of each line: {untested:?}");
}

/// Prints a ratio that is out of bounds, with a mark if it is so beyond chance.
fn print_if_outside(name: &str, found: &Scatter) {
    let Scatter { of, mean, ratio, webs, hold, .. } = found;
    if (BOUNDS[0]..BOUNDS[1]).contains(ratio) {
        return;
    }
    let [low, high] = found.by_chance(3.0);
    let mark = if (BOUNDS[0] * low..BOUNDS[1] * high).contains(ratio) { ' ' } else { '!' };
    println!("{mark} {name} {of}: {ratio:.2}, mean {mean:.4}, {hold} of {webs} intervals hold");
}
