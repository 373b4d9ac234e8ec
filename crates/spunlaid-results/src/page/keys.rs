//! The keys of cases, webs and studies, explained: on a terminal, and as the pages of the documentation.

use spunlaid_experiment::STUDY;
use spunlaid_fibre::case::keys::{self, CASE, Key, KeyTable, Kind, Sign};
use spunlaid_ground::{Dimension, Fault, FileKind, UnitAdvice};
use spunlaid_simulation::{WEB, WEB_KEYS};
use spunlaid_web::fabric::about;
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
    synonyms: &'static [&'static str],
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
        let (left_out, synonyms) = (table.left_out(key), key.synonyms);
        Self { name, kind, left_out, meaning, synonyms, file: "", usual, may_change: [varies, in_flight] }
    }

    /// Those of a table that are found by a word.
    fn with_word<T>(table: &'static KeyTable<T>, word: &str) -> impl Iterator<Item = Self> {
        table.rows.iter().filter(move |key| key.has_word(word)).map(|key| Self::new(table, key))
    }

    /// Its name within a table, if it belongs there.
    fn within(&self, table: &str) -> Option<&'static str> {
        match table {
            "" => Some(self.name).filter(|name| !name.contains('.')),
            _ => self.name.strip_prefix(table)?.strip_prefix('.'),
        }
    }
}

/// The keys with a word in their name or meaning, or with it as a unit, as a terminal shows them.
///
/// * `of` – the file whose keys they are; None for those of cases, and with a word for those of all files
/// * `columns` – of the terminal, if there is one
///
/// # Errors
/// If there is none, with those that are like it.
pub fn keys_text(word: &str, of: Option<FileKind>, columns: Option<usize>) -> Result<String, Fault> {
    let width = columns.map_or(WIDTH, |columns| columns.min(WIDTH));
    let about = about(&word.trim().to_lowercase()).map(|sentence| {
        let mut text = String::new();
        wrap(&mut text, width, String::new(), 0, &sentence.replace('`', "\""));
        text
    });
    let found = found(word, of, false, about.is_some())?;
    let texts: Vec<String> = about.into_iter().chain(found.iter().map(|key| reference(key, width))).collect();
    Ok(texts.join("\n"))
}

/// The page of the keys of a file, in Markdown; see [`keys_text`].
///
/// # Errors
/// As [`keys_text`].
pub fn keys_page(word: &str, of: Option<FileKind>) -> Result<String, Fault> {
    let found = found(word, of, true, false)?;
    Ok(match of {
        Some(FileKind::Web) => markdown(&found, WEB_HEAD, &WEB, &[]),
        Some(FileKind::Study) => markdown(&found, STUDY_HEAD, &STUDY, &["range"]),
        _ => markdown(&found, HEAD, &CASE, &[]),
    })
}

/// The keys with a word.
fn found(
    pattern: &str,
    of: Option<FileKind>,
    is_page: bool,
    allows_none: bool,
) -> Result<Vec<KeyEntry>, Fault> {
    let word = pattern.trim().to_lowercase();
    let is_plain = |word: &str| {
        WEB_KEYS.iter().any(|key| key.has_word(word))
            || keys::all().iter().any(|key| key.has_word(word))
            || STUDY.rows.iter().any(|key| key.has_word(word))
    };
    // A plural that stands nowhere is its singular.
    let word = match word.strip_suffix('s') {
        Some(singular) if singular.len() > 2 && !is_plain(&word) => singular.to_owned(),
        _ => word,
    };
    let web_keys = || KeyEntry::with_word(&WEB, &word);
    let case_keys = || KeyEntry::with_word(&CASE, &word);
    let study_keys = KeyEntry::with_word(&STUDY, &word);
    let found: Vec<KeyEntry> = match of {
        Some(FileKind::Web) => web_keys().collect(),
        Some(FileKind::Study) => study_keys.collect(),
        _ if word.is_empty() || is_page => case_keys().collect(),
        // Who searches a word need not know whose key it is.
        _ => {
            let further = web_keys().filter(|key| keys::find(key.name).is_none());
            let further = further.map(|key| KeyEntry { file: "  (of a web file)", ..key });
            let of_study = study_keys.map(|key| KeyEntry { file: "  (of a study file)", ..key });
            case_keys().chain(further).chain(of_study).collect()
        }
    };
    if !found.is_empty() || allows_none {
        return Ok(found);
    }
    let nearest = if of.is_none() { keys::like(&word) } else { Vec::new() };
    let nearest: Vec<&str> = nearest.iter().take(MOST_NEAREST).map(|key| key.name).collect();
    let remedy = match &nearest[..] {
        [] => "`spunlaid keys` lists them all".to_owned(),
        keys => format!("did you mean {}?", keys.join(" or ")),
    };
    let message = format!("no key has \"{}\" in its name or meaning", pattern.escape_debug());
    Err(Fault::new(message, remedy))
}

/// The description of a key for the terminal.
fn reference(key: &KeyEntry, width: usize) -> String {
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
        wrap(&mut text, width, first, next, &words);
    }
    text
}

/// Adds words in lines that are not too long.
///
/// * `line` – with which the first one begins
/// * `next` – spaces with which the others begin
fn wrap(text: &mut String, width: usize, mut line: String, next: usize, words: &str) {
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
    let units = key.kind.dimension().filter(|of| *of != Dimension::Ratio).map(units);
    let units = units.map_or_else(String::new, |units| format!("; in {units}"));
    let usual = usual(key).map_or_else(String::new, |usual| format!("; usually {usual}"));
    key.kind.allowed() + &units + &usual
}

/// The usual range of a quantity.
fn usual(key: &KeyEntry) -> Option<String> {
    let (dimension, (least, greatest)) = (key.kind.dimension()?, key.usual?);
    Some(format!("{} to {}", dimension.pretty(least), dimension.pretty(greatest)))
}

/// The same in a row of a page, which says of what sign quantities are, and the units of some dimensions.
fn takes_in_row(key: &KeyEntry, listed: &[Dimension]) -> String {
    let (Kind::Quantity(dimension, sign), Some(usual)) = (key.kind, usual(key)) else {
        return key.kind.allowed();
    };
    let units = match listed.contains(&dimension) || dimension == Dimension::Ratio {
        true => String::new(),
        false => format!("; in {}", units(dimension)),
    };
    let sign = match sign {
        Sign::Positive => "",
        Sign::NotNegative => ", or 0",
        Sign::Share => "; 0 to 1 can be written",
        Sign::Any => ", of either sign",
    };
    usual + sign + &units
}

/// The units of a dimension, `m, cm or mm`.
fn units(dimension: Dimension) -> String {
    let advice = UnitAdvice(dimension).to_string();
    advice.split_once(": ").map_or_else(String::new, |(_, units)| units.to_owned())
}

/// The dimensions of several keys, whose units are reported once.
fn shared(found: &[KeyEntry]) -> Vec<Dimension> {
    let mut dimensions = Vec::new();
    for dimension in found.iter().filter_map(|key| key.kind.dimension()) {
        let keys = found.iter().filter(|key| key.kind.dimension() == Some(dimension)).count();
        if keys > 1 && dimension != Dimension::Ratio && !dimensions.contains(&dimension) {
            dimensions.push(dimension);
        }
    }
    dimensions
}

/// Where its value may change.
fn may_change(key: &KeyEntry) -> String {
    let words = ["in a study", "during a flight"];
    let may: Vec<&str> =
        key.may_change.into_iter().zip(words).filter_map(|(may, word)| may.then_some(word)).collect();
    may.join(", and ")
}

const HEAD: &str = "# The keys of a case

`spunlaid keys --markdown > docs/keys.md` writes this page. `spunlaid keys WORD` shows the keys with this word in their
name or meaning, or with this unit: `spunlaid keys dtex`.

A quantity has a unit, in quotes: `diameter = \"50 µm\"`; `um` is the same as `µm`, and `kg/m^3` as `kg/m³`.
`--set air.velocity=\"20 m/s\"` sets a key for one run, and `--set air.velocity=\"+20 %\"` or `\"+2 m/s\"` changes its
value, as in a study, a fit and Python. (For a key that takes negative values, `\"-2 mm\"` is a value.) A study can
vary all keys but those marked *fixed*; those marked *flight* can change during a flight. Ranges are the usual ones:
outside of them the program warns. Quantities are above zero unless their row says otherwise.
";
const WEB_HEAD: &str = "# The keys of a web

`spunlaid keys --web --markdown > docs/web_keys.md` writes this page. [keys.md](keys.md) explains how keys are written,
marked and searched. `--set layer.2.line.filaments_per_metre=4000` sets a key of a layer, by its number or name;
without `layer` and a number it sets the key of all layers that have it. `line.rows.1.pitch` is that of a row of holes.
";

const STUDY_HEAD: &str = "# The keys of a study

`spunlaid keys --study --markdown > docs/study_keys.md` writes this page. `*` is any key of the case, the web or the
spinline that varies; in `[replicates.until]` it is any result. [studies.md](studies.md) explains their use.
";

/// The keys as a Markdown document with one table for each table of the file.
///
/// * `within` – tables in place of values
fn markdown<T>(found: &[KeyEntry], head: &str, keys: &KeyTable<T>, within: &[&'static str]) -> String {
    let mut text = head.to_owned();
    let listed = shared(found);
    if !listed.is_empty() {
        text += "\n| quantity | units |\n|---|---|\n";
    }
    for dimension in &listed {
        // Writing to a text cannot fail.
        let _ =
            writeln!(text, "| {} |", UnitAdvice(*dimension).to_string().replace(" with its unit: ", " | "));
    }
    let any_varies = found.iter().any(|key| key.may_change[0]);
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
        let title = if table.is_empty() { "Above the tables".to_owned() } else { keys.header(table) };
        let _ = writeln!(text, "\n## {title}\n\n| key | takes | if left out | meaning |\n|---|---|---|---|");
        for (key, short) in rows {
            let also = match key.synonyms {
                [] => String::new(),
                words => format!(" Also: {}.", words.join(", ")),
            };
            let mark = match key.may_change {
                [_, true] => " *flight*",
                [false, _] if any_varies => " *fixed*",
                _ => "",
            };
            let takes = takes_in_row(key, &listed);
            let left_out = &key.left_out;
            let meaning = key.meaning;
            let _ = writeln!(text, "| `{short}`{mark} | {takes} | {left_out} | {meaning}{also} |");
        }
    }
    text
}
