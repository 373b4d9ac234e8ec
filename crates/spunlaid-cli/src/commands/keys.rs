//! `spunlaid keys`: explains the keys of a case.

use crate::args::Keys;
use crate::failure::Failure;
use crate::say;
use spunlaid::case::keys::{self, Key, LeftOut, TABLES};
use spunlaid::units::{Dimension, Wanted};
use std::fmt::Write;

/// Largest number of suggestions if no key is found.
const MOST_NEAREST: usize = 3;
/// Longest line of the reference, in characters.
const WIDTH: usize = 100;

pub(crate) fn keys(asked: &Keys) -> Result<(), Failure> {
    let pattern = asked.pattern.clone().unwrap_or_default();
    let word = pattern.trim().to_lowercase();
    let has = |text: &str| text.to_lowercase().contains(&word);
    let found: Vec<&Key> = keys::all().iter().filter(|key| has(key.name) || has(key.meaning)).collect();
    if found.is_empty() {
        let nearest = keys::like(&word).iter().take(MOST_NEAREST).map(|key| key.name).collect();
        return Err(Failure::NoSuchKey { pattern, nearest });
    }
    if asked.markdown {
        say::text(&markdown(&found));
    } else {
        let texts: Vec<String> = found.into_iter().map(reference).collect();
        say::text(&texts.join("\n"));
    }
    Ok(())
}

/// The description of a key for the terminal.
fn reference(key: &Key) -> String {
    let mut text = format!("{}\n", key.name);
    let default = match key.left_out {
        LeftOut::Required(example) => format!("none; the key is required, like {example}"),
        LeftOut::Value(words) | LeftOut::Follows(words) => words.to_owned(),
    };
    for (title, words) in [
        ("", key.meaning.replace('`', "\"")),
        ("takes     ", takes(key)),
        ("default   ", default),
        ("may change", may_change(key)),
    ] {
        if words.is_empty() {
            continue;
        }
        let mut line = if title.is_empty() { "   ".to_owned() } else { format!("    {title}") };
        for word in words.split(' ') {
            if line.chars().count() + 1 + word.chars().count() > WIDTH {
                let _ = writeln!(text, "{line}");
                line = if title.is_empty() { "   ".to_owned() } else { " ".repeat(14) };
            }
            line.push(' ');
            line.push_str(word);
        }
        let _ = writeln!(text, "{line}");
    }
    text
}

/// The allowed values, with the units of a quantity.
fn takes(key: &Key) -> String {
    match key.dimension() {
        Some(dimension) if dimension != Dimension::Ratio => {
            let wanted = Wanted(dimension).to_string();
            let units = wanted.split_once(": ").map_or("", |(_, units)| units);
            format!("{}; in {units}", key.allowed())
        }
        _ => key.allowed(),
    }
}

/// Where its value may change.
fn may_change(key: &Key) -> String {
    match (key.varies, key.in_flight) {
        (true, true) => "in a study, and during a flight",
        (true, false) => "in a study",
        (false, true) => "during a flight",
        (false, false) => "",
    }
    .to_owned()
}

/// The keys as a Markdown document with one table for each table of the case.
fn markdown(found: &[&Key]) -> String {
    let mut text = "# The keys of a case

This page is made by `spunlaid keys --markdown > docs/keys.md`. `spunlaid keys WORD` shows the keys with a word in their
name or meaning.

A quantity is written with its unit, in quotes: `diameter = \"50 µm\"`. `um` is the same as `µm`, and `kg/m^3` is the same
as `kg/m³`. Each key can also be set for one run, `--set air.velocity=\"20 m/s\"`. `spunlaid sweep` can vary keys marked
*study*. A program can change keys marked *flight* during a flight.
"
    .to_owned();
    for table in TABLES {
        let mut rows = found.iter().filter(|key| key.table() == table).peekable();
        if rows.peek().is_none() {
            continue;
        }
        // Writing to a text cannot fail.
        let _ = writeln!(
            text,
            "\n## [{table}]\n\n| key | takes | if left out | meaning | |\n|---|---|---|---|---|"
        );
        for key in rows {
            let left_out = match key.left_out {
                LeftOut::Required(example) => format!("required, like `{example}`"),
                LeftOut::Value(value) => format!("`{value}`"),
                LeftOut::Follows(words) => words.to_owned(),
            };
            let marks = [(key.varies, "study"), (key.in_flight, "flight")];
            let marks: Vec<&str> = marks.into_iter().filter(|(is, _)| *is).map(|(_, mark)| mark).collect();
            let _ = writeln!(
                text,
                "| `{}` | {} | {left_out} | {} | {} |",
                key.short(),
                takes(key),
                key.meaning,
                marks.join(", ")
            );
        }
    }
    text
}
