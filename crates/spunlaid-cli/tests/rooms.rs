//! The rooms of the program, of results and of charts import one another one way only; and texts of all
//! crates name only what exists.
#![allow(clippy::unwrap_used)]

#[path = "../../spunlaid/tests/rooms_of/mod.rs"]
mod rooms_of;

mod desk;

use desk::{Desk, success};
use rooms_of::{circles, code_and_texts, faults, sources};
use spunlaid::fibre::case::keys;
use spunlaid::input::{WEB_KEYS, WEB_TABLES};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The rooms of the program from left to right; those of one group may not import one another.
const PROGRAM: &[&[&str]] =
    &[&["args", "failure", "file", "say"], &["progress"], &["control"], &["delivery"], &["commands"]];

const RESULTS: &[&[&str]] = &[
    &["command", "failure", "numbers"],
    &["effects"],
    &["figures"],
    &["files"],
    &["page"],
    &["folders"],
    &["reports"],
];

const REPORTS: &[&[&str]] = &[
    &["spinline"],
    &["load"],
    &["run"],
    &["air", "record", "sources"],
    &["web"],
    &["finished", "scan"],
    &["fit", "study"],
    &["paper"],
    &["comparison", "declared"],
];

const CHARTS: &[&[&str]] = &[
    &["decimate", "glyphs", "numbers", "palette"],
    &["label", "picture"],
    &["outline", "svg"],
    &["pixels", "pdf", "table", "map"],
    &["png", "scale"],
    &["chart"],
    &["legend"],
    &["layout"],
    &["draw"],
    &["figure"],
    &["rose"],
];

#[test]
fn rooms_import_only_from_their_left_and_files_not_from_one_another() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut wrong = faults(&crates.join("spunlaid-cli/src"), None, PROGRAM, &["lib", "main"]);
    wrong.extend(faults(&crates.join("spunlaid-results/src"), None, RESULTS, &["lib"]));
    let reports = crates.join("spunlaid-results/src/reports");
    wrong.extend(faults(&reports, Some("reports"), REPORTS, &["mod"]));
    wrong.extend(faults(&crates.join("spunlaid-charts/src"), None, CHARTS, &["lib"]));
    for name in ["cli", "live", "results", "charts", "python"] {
        wrong.extend(circles(&crates.join(format!("spunlaid-{name}/src"))));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The formatter leaves long texts and comments as they are.
#[test]
fn no_line_is_longer_than_a_screen_is_wide() {
    let mut long = Vec::new();
    for path in sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("..")) {
        let source = std::fs::read_to_string(&path).unwrap();
        let lines = (1..).zip(source.lines()).filter(|(_, line)| line.chars().count() > 120);
        long.extend(lines.map(|(number, _)| format!("{}:{number}", path.display())));
    }
    assert!(long.is_empty(), "{}", long.join("\n"));
}

/// The texts in the sources of every crate that a message can be made of, with the file. What comes after the
/// tests of a file begin is left out.
fn texts() -> Vec<(String, String)> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut all = Vec::new();
    // All but the table of what is gone.
    let is_read = |path: &PathBuf| {
        path.components().any(|part| part.as_os_str() == "src")
            && !path.ends_with("spunlaid-ground/src/removed.rs")
    };
    for path in sources(&crates).into_iter().filter(is_read) {
        let source = std::fs::read_to_string(&path).unwrap();
        let shown = path.strip_prefix(&crates).unwrap().display().to_string();
        let before_tests = source.split("#[cfg(test)]").next().unwrap_or_default();
        all.extend(code_and_texts(before_tests).1.into_iter().map(|text| (shown.clone(), text)));
    }
    assert!(all.len() > 3000, "only {} texts", all.len());
    all
}

/// A message that proposes a key which does not exist sends its reader on a search.
#[test]
fn every_key_that_a_text_names_exists() {
    let names: BTreeSet<&str> =
        keys::all().iter().map(|key| key.name).chain(WEB_KEYS.iter().map(|key| key.name)).collect();
    let tables: BTreeSet<&str> = keys::TABLES.into_iter().chain(WEB_TABLES).collect();
    // What else is written with the name of a table and a dot: the tables of a layer, endings of files, a
    // group of measures, and a field of a case that a program fills in.
    let exists = |name: &str| {
        let (table, rest) = name.split_once('.').unwrap();
        names.contains(name)
            || names.iter().any(|key| key.strip_prefix(name).is_some_and(|rest| rest.starts_with('.')))
            || table == "layer" && tables.contains(rest)
            || ["toml", "html", "svg", "csv", "js", "css", "json", "parquet"].contains(&rest)
            || ["laydown.surrogate", "fibre.elements"].contains(&name)
    };
    let mut seen = BTreeSet::new();
    let mut wrong = Vec::new();
    for (file, text) in texts() {
        let is_of_name = |c: char| c.is_ascii_lowercase() || c == '_' || c == '.';
        for word in text.split(|c: char| !(is_of_name(c) || c.is_alphanumeric() || "/-{}".contains(c))) {
            let word = word.trim_matches('.');
            let begins =
                word.split_once('.').is_some_and(|(table, rest)| tables.contains(table) && !rest.is_empty());
            if !begins || !word.chars().all(is_of_name) {
                continue;
            }
            if exists(word) {
                seen.insert(word.to_owned());
            } else {
                wrong.push(format!("{file}: {word}"))
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(seen.len() > 50, "{seen:?}");
}

#[test]
fn every_option_and_command_that_a_text_names_exists() {
    let script = success(&mut Desk::new().spunlaid("completions bash"));
    let known: BTreeSet<&str> = script.split(|c: char| !(c.is_alphanumeric() || c == '-')).collect();
    let is_of_name = |c: char| c.is_ascii_lowercase() || c == '-';
    let (mut seen, mut wrong) = (BTreeSet::new(), Vec::new());
    for (file, text) in texts() {
        let options = text
            .split(|c: char| !is_of_name(c))
            .filter(|word| word.starts_with("--") && !word.ends_with('-'));
        let commands =
            text.split("`spunlaid ").skip(1).filter_map(|rest| rest.split(|c| !is_of_name(c)).next());
        for word in options.chain(commands).filter(|word| !word.is_empty()) {
            if known.contains(word) {
                seen.insert(word.to_owned());
            } else {
                wrong.push(format!("{file}: {word}"))
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(seen.len() > 25, "{seen:?}");
}

/// Each command has a page of the manual.
#[test]
fn the_tour_shows_every_command() {
    let desk = Desk::new();
    success(&mut desk.spunlaid("man pages"));
    let tour = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/tour.md");
    let tour = std::fs::read_to_string(tour).unwrap();
    let mut seen = 0;
    for page in std::fs::read_dir(desk.path("pages")).unwrap() {
        let page = page.unwrap().file_name().into_string().unwrap();
        let Some(command) = page.strip_prefix("spunlaid-") else { continue };
        let command = command.strip_suffix(".1").unwrap();
        assert!(tour.contains(&format!("spunlaid {command}")), "{command}");
        seen += 1;
    }
    assert!(seen > 10, "{seen}");
}
