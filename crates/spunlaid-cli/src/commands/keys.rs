//! `spunlaid keys`: explains the keys of a case, of a web and of a study.

use crate::args::Keys;
use crate::failure::Failure;
use crate::say;
use spunlaid::experiment::STUDY;
use spunlaid::fibre::case::keys::{self, CASE, Key, KeyTable, Kind};
use spunlaid::ground::{Dimension, Fault, Removed, UnitAdvice};
use spunlaid::simulation::{WEB, WEB_KEYS, WebKey};
use spunlaid::web::fabric::about;
use std::fmt::Write;

/// Largest number of suggestions if no key is found.
const MOST_NEAREST: usize = 3;
/// Longest line of the reference, in characters.
const WIDTH: usize = 100;

/// What is shown of a key, of a case, a web or a study.
struct KeyEntry {
    name: &'static str,
    kind: Kind,
    /// What applies if it is left out, with backquotes around values and names of keys.
    left_out: String,
    meaning: &'static str,
    synonyms: Vec<&'static str>,
    /// The file in which it stands, if it is not that of a case.
    file: &'static str,
    /// Outside of these a value is warned of, in SI units.
    usual: Option<(f64, f64)>,
    /// Whether it may change in a study, and during a flight.
    may_change: [bool; 2],
}

impl KeyEntry {
    fn new<T>(table: &KeyTable<T>, key: &Key<T>) -> Self {
        let Key { name, kind, meaning, usual, varies, in_flight, .. } = *key;
        let (left_out, synonyms) = (table.left_out(key), key.synonyms.to_vec());
        Self { name, kind, left_out, meaning, synonyms, file: "", usual, may_change: [varies, in_flight] }
    }

    fn from_case_key(key: &Key) -> Self {
        Self::new(&CASE, key)
    }

    fn from_web_key(key: &WebKey) -> Self {
        Self { synonyms: key.all_synonyms(), usual: key.usual_range(), ..Self::new(&WEB, key) }
    }

    /// Those of two words, for studies and for flights, in which it may change.
    fn name_changes(&self, words: [&'static str; 2]) -> Vec<&'static str> {
        self.may_change.into_iter().zip(words).filter_map(|(may, word)| may.then_some(word)).collect()
    }

    /// Its name within a table, if it belongs there.
    fn within(&self, table: &str) -> Option<&'static str> {
        match table {
            "" => Some(self.name).filter(|name| !name.contains('.')),
            _ => self.name.strip_prefix(table)?.strip_prefix('.'),
        }
    }
}

pub(crate) fn keys(arguments: &Keys) -> Result<(), Failure> {
    let pattern = arguments.pattern.clone().unwrap_or_default();
    let word = pattern.trim().to_lowercase();
    let is_of_web =
        |key: &&WebKey| key.has_word(&word) || key.key_of_case().is_some_and(|key| key.has_word(&word));
    let web_keys = || WEB_KEYS.iter().filter(is_of_web).map(KeyEntry::from_web_key);
    let case_keys = || keys::all().iter().filter(|key| key.has_word(&word)).map(KeyEntry::from_case_key);
    let of_study = STUDY.rows.iter().filter(|key| key.has_word(&word));
    let study_keys = of_study.map(|key| KeyEntry::new(&STUDY, key));
    let found: Vec<KeyEntry> = match arguments {
        Keys { web: true, .. } => web_keys().collect(),
        Keys { study: true, .. } => study_keys.collect(),
        _ if word.is_empty() || arguments.markdown => case_keys().collect(),
        // Who searches a word need not know whose key it is.
        _ => {
            let further = web_keys().filter(|key| keys::find(key.name).is_none());
            let further = further.map(|key| KeyEntry { file: "  (of a web file)", ..key });
            let of_study = study_keys.map(|key| KeyEntry { file: "  (of a study file)", ..key });
            case_keys().chain(further).chain(of_study).collect()
        }
    };
    let about = about(&word).filter(|_| !arguments.markdown);
    if found.is_empty() && about.is_none() {
        let is_of_case = !arguments.web && !arguments.study;
        let nearest = if is_of_case { keys::like(&word) } else { Vec::new() };
        let nearest: Vec<&str> = nearest.iter().take(MOST_NEAREST).map(|key| key.name).collect();
        let message = format!("no key has \"{}\" in its name or meaning", pattern.escape_debug());
        if let Some(fault) = Removed::Key.fault(&word) {
            return Err(Fault::new(format!("{word} {}", fault.message), fault.remedy).into());
        }
        let remedy = match &nearest[..] {
            [] => "`spunlaid keys` lists them all".to_owned(),
            keys => format!("did you mean {}?", keys.join(" or ")),
        };
        return Err(Fault::new(message, remedy).into());
    }
    if arguments.markdown {
        say::text(&match arguments {
            Keys { web: true, .. } => markdown(&found, WEB_HEAD, &WEB, &[]),
            Keys { study: true, .. } => markdown(&found, STUDY_HEAD, &STUDY, &["range"]),
            _ => markdown(&found, HEAD, &CASE, &[]),
        });
    } else {
        let about = about.map(|sentence| {
            let mut text = String::new();
            wrap(&mut text, String::new(), 0, &sentence.replace('`', "\""));
            text
        });
        let texts: Vec<String> = about.into_iter().chain(found.iter().map(reference)).collect();
        say::text(&texts.join("\n"));
    }
    Ok(())
}

/// The description of a key for the terminal.
fn reference(key: &KeyEntry) -> String {
    let mut text = format!("{}{}\n", key.name, key.file);
    let none = if key.left_out.starts_with("required") { "none; " } else { "" };
    let default = none.to_owned() + &key.left_out.replace('`', "");
    for (title, words) in [
        ("", key.meaning.replace('`', "\"")),
        ("takes     ", takes(key)),
        ("also      ", key.synonyms.join(", ")),
        ("default   ", default),
        ("may change", may_change(key)),
    ] {
        if words.is_empty() {
            continue;
        }
        let (first, next) =
            if title.is_empty() { ("   ".to_owned(), 3) } else { (format!("    {title}"), 14) };
        wrap(&mut text, first, next, &words);
    }
    text
}

/// Adds words in lines that are not too long.
///
/// * `line` – with which the first one begins
/// * `next` – spaces with which the others begin
fn wrap(text: &mut String, mut line: String, next: usize, words: &str) {
    let width = say::columns().map_or(WIDTH, |columns| columns.min(WIDTH));
    for word in words.split(' ') {
        if line.chars().count() + 1 + word.chars().count() > width {
            let _ = writeln!(text, "{line}");
            line = " ".repeat(next);
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    let _ = writeln!(text, "{line}");
}

/// The allowed values, with the units of a quantity and its usual range.
fn takes(key: &KeyEntry) -> String {
    let usual = match (key.kind.dimension(), key.usual) {
        (Some(dimension), Some((least, greatest))) => {
            format!("; usually {} to {}", dimension.pretty(least), dimension.pretty(greatest))
        }
        _ => String::new(),
    };
    let allowed = match key.kind.dimension() {
        Some(dimension) if dimension != Dimension::Ratio => {
            let advice = UnitAdvice(dimension).to_string();
            let units = advice.split_once(": ").map_or("", |(_, units)| units);
            format!("{}; in {units}", key.kind.allowed())
        }
        _ => key.kind.allowed(),
    };
    allowed + &usual
}

/// Where its value may change.
fn may_change(key: &KeyEntry) -> String {
    key.name_changes(["in a study", "during a flight"]).join(", and ")
}

const HEAD: &str = "# The keys of a case

This page is made by `spunlaid keys --markdown > docs/keys.md`. `spunlaid keys WORD` shows the keys with a word in their
name or meaning, or among the other words for them, or with this unit: `spunlaid keys dtex`.

A quantity is written with its unit, in quotes: `diameter = \"50 µm\"`. `um` is the same as `µm`, and `kg/m^3` is the same
as `kg/m³`. Each key can also be set for one run, `--set air.velocity=\"20 m/s\"`, and replaces what stands in the file, also
in other words. `spunlaid sweep` can vary keys marked *study*. A program can change keys marked *flight* during a flight. A
value outside of the range after *usually*, unless it is zero, is most likely in a wrong unit: the program warns and uses it.
";
const WEB_HEAD: &str = "# The keys of a web

This page is made by `spunlaid keys --web --markdown > docs/web_keys.md`. `spunlaid keys --web WORD` shows the keys with a
word in their name or meaning, or among the other words for them, or with this unit: `spunlaid keys --web gsm`.

A quantity is written with its unit, in quotes, as in a case ([keys.md](keys.md)). Each key can also be set for one web,
`--set line.belt_speed=\"6 m/s\"`; of a file with `[[layer]]`, `--set layer.2.line.filaments_per_metre=4000`, or with the
layer's name in place of its number. `spunlaid sweep` can vary keys marked *study*, those of a layer or of a row of nozzles
by its number: `layer.2.line.filaments_per_metre`, `line.rows.1.pitch`.
";

const STUDY_HEAD: &str = "# The keys of a study

This page is made by `spunlaid keys --study --markdown > docs/study_keys.md`. A key called `*` stands for any key of the case,
the web or the spinline that varies; of `[replicates.until]` for any result. [studies.md](studies.md) says how to use them.
";

/// The keys as a Markdown document with one table for each table of the file.
///
/// * `within` – tables in place of values
fn markdown<T>(found: &[KeyEntry], head: &str, keys: &KeyTable<T>, within: &[&'static str]) -> String {
    let mut text = head.to_owned();
    let tables = [&[""], keys.tables, within].concat();
    for table in &tables {
        // A key of a table that stands in this one is shown there, if that table has a section of its own.
        let is_deeper = |key: &KeyEntry| {
            tables.iter().any(|inner| inner.len() > table.len() && key.within(inner).is_some())
        };
        let here = found.iter().filter(|key| !is_deeper(key));
        let mut rows = here.filter_map(|key| Some((key, key.within(table)?))).peekable();
        if rows.peek().is_none() {
            continue;
        }
        // Writing to a text cannot fail.
        let title = if table.is_empty() { "Above the tables".to_owned() } else { keys.header(table) };
        let _ = writeln!(
            text,
            "\n## {title}\n\n| key | takes | if left out | meaning | |\n|---|---|---|---|---|"
        );
        for (key, short) in rows {
            let _ = writeln!(
                text,
                "| `{short}` | {} | {} | {}{} | {} |",
                takes(key),
                key.left_out,
                key.meaning,
                if key.synonyms.is_empty() {
                    String::new()
                } else {
                    format!(" Also: {}.", key.synonyms.join(", "))
                },
                key.name_changes(["study", "flight"]).join(", ")
            );
        }
    }
    text
}
