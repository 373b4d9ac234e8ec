//! What the sources of all crates name exists: keys, options, commands, equations, files of tests.
#![allow(clippy::unwrap_used)]

mod desk;

use desk::{Desk, success};
use spunlaid_fibre::case::keys;
use spunlaid_input::{WEB_KEYS, WEB_TABLES};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn crates() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The sources below a folder.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// The code of a source, in which texts are empty, and the texts as they are written.
fn code_and_texts(source: &str) -> (String, Vec<String>) {
    let (mut code, mut texts) = (String::new(), Vec::new());
    let mut rest = source.chars().peekable();
    while let Some(c) = rest.next() {
        match (c, rest.peek()) {
            ('/', Some('/')) => {
                while rest.peek().is_some_and(|&c| c != '\n') {
                    rest.next();
                }
            }
            ('"', _) => {
                let mut text = String::new();
                while let Some(c) = rest.next() {
                    match c {
                        '\\' => text.extend(rest.next().filter(|c| !c.is_alphabetic())),
                        '"' => break,
                        c => text.push(c),
                    }
                }
                code.push_str("\"\"");
                texts.push(text);
            }
            ('\'', Some('"')) => {
                // The character '"' opens no text.
                rest.next();
            }
            _ => code.push(c),
        }
    }
    (code, texts)
}

/// The formatter leaves long texts and comments as they are.
#[test]
fn no_line_is_longer_than_a_screen_is_wide() {
    let mut long = Vec::new();
    for path in sources(&crates()) {
        let source = std::fs::read_to_string(&path).unwrap();
        let lines = (1..).zip(source.lines()).filter(|(_, line)| line.chars().count() > 120);
        long.extend(lines.map(|(number, _)| format!("{}:{number}", path.display())));
    }
    assert!(long.is_empty(), "{}", long.join("\n"));
}

/// The texts in the sources of every crate that a message can be made of, with the file. What comes after the
/// tests of a file begin is left out.
fn texts() -> Vec<(String, String)> {
    let crates = crates();
    let mut all = Vec::new();
    let is_read = |path: &PathBuf| path.components().any(|part| part.as_os_str() == "src");
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

#[test]
fn equations_named_in_the_source_are_in_the_theory() {
    let docs = crates().join("../docs");
    let theory = std::fs::read_to_string(docs.join("theory.md")).unwrap();
    let numbers = |text: &str, before: &str, after: char| -> Vec<u32> {
        text.split(before).skip(1).filter_map(|rest| rest.split(after).next()?.parse().ok()).collect()
    };
    let there = numbers(&theory, "\\tag{", '}');
    assert_eq!(there, (1..=there.len() as u32).collect::<Vec<_>>(), "equations are numbered in order");
    let mut count = 0;
    for path in sources(&crates()) {
        let source = std::fs::read_to_string(&path).unwrap();
        for number in numbers(&source, "theory.md (", ')') {
            assert!(there.contains(&number), "{}: theory.md ({number}) is not there", path.display());
            count += 1;
        }
    }
    assert!(count > 20, "only {count} equations are named");
}

/// A file of tests that its program does not name is never compiled.
#[test]
fn every_file_of_tests_is_in_its_program() {
    let mut count = 0;
    for path in sources(&crates()) {
        let main = path.with_file_name("main.rs");
        let in_tests = path.iter().any(|part| part == "tests") && path != main && main.exists();
        if in_tests && let Some(name) = path.file_stem().and_then(|name| name.to_str()) {
            let program = std::fs::read_to_string(&main).unwrap();
            assert!(
                program.contains(&format!("mod {name};")),
                "{} is not in {}",
                path.display(),
                main.display()
            );
            count += 1;
        }
    }
    assert!(count > 40, "only {count} files of tests");
}
