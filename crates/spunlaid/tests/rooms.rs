//! The house stands: modules import only from rooms left of their own, and every equation the source names
//! is in `docs/theory.md`.

#![allow(clippy::expect_used)]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The rooms from left to right; those of one group stand side by side and may not import one another.
const ROOMS: &[&[&str]] = &[
    &["lanes"],
    &["vec3", "fft", "units"],
    &["error"],
    &["file", "table"],
    &["fibre"],
    &["field"],
    &["air", "drag"],
    &["chain"],
    &["energy", "observe"],
    &["statistics"],
    &["record"],
    &["case"],
    &["flight"],
    &["ensemble"],
    &["study"],
    &["input"],
    &["paper"],
];

fn rank(room: &str) -> Option<usize> {
    ROOMS.iter().position(|group| group.contains(&room))
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder of sources") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// The source without comments and without what stands in quotes, so that only code can name a room.
fn code_only(source: &str) -> String {
    let mut code = String::new();
    let mut rest = source.chars().peekable();
    while let Some(c) = rest.next() {
        match (c, rest.peek()) {
            ('/', Some('/')) => {
                while rest.peek().is_some_and(|&c| c != '\n') {
                    rest.next();
                }
            }
            ('"', _) => {
                while let Some(c) = rest.next() {
                    match c {
                        '\\' => drop(rest.next()),
                        '"' => break,
                        _ => {}
                    }
                }
                code.push_str("\"\"");
            }
            ('\'', Some('"')) => {
                // The character '"' opens no text.
                rest.next();
            }
            _ => code.push(c),
        }
    }
    code
}

/// First names of the paths that follow `prefix` in the code: `prefix::a::…` and `prefix::{a::…, b}`.
fn named_after(code: &str, prefix: &str) -> BTreeSet<String> {
    let identifier = |text: &str| -> String {
        text.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
    };
    let mut names = BTreeSet::new();
    for (at, _) in code.match_indices(prefix) {
        let before = code[..at].chars().next_back();
        if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':') {
            continue;
        }
        let rest = code[at + prefix.len()..].trim_start();
        let Some(group) = rest.strip_prefix('{') else {
            names.insert(identifier(rest));
            continue;
        };
        let mut depth = 0;
        let mut start = true;
        for (i, c) in group.char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => start = true,
                c if start && !c.is_whitespace() => {
                    names.insert(identifier(&group[i..]));
                    start = false;
                }
                _ => {}
            }
        }
    }
    names
}

/// Rooms that a file imports from, its own left out.
fn imports(source: &str, room: &str, depth: usize) -> BTreeSet<String> {
    let code = code_only(source);
    // `super` as often as the file is deep leaves the room, as `crate` does.
    let mut found = named_after(&code, "crate::");
    found.extend(named_after(&code, &"super::".repeat(depth)));
    found.retain(|name| rank(name).is_some() && name != room);
    found
}

#[test]
fn rooms_import_only_from_their_left() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut seen = BTreeSet::new();
    let mut wrong = Vec::new();
    for path in sources(&root) {
        let inside: Vec<String> = path
            .strip_prefix(&root)
            .expect("below the root")
            .components()
            .map(|part| part.as_os_str().to_string_lossy().into_owned())
            .collect();
        let room = inside[0].trim_end_matches(".rs").to_owned();
        if room == "lib" {
            continue;
        }
        let Some(own) = rank(&room) else {
            wrong.push(format!("{room} is a room this test does not know; put it in its place in ROOMS"));
            continue;
        };
        seen.insert(room.clone());
        // src/a.rs and src/a/mod.rs are the room itself, src/a/b.rs is one deeper.
        let is_room = inside.len() == 1 || inside.last().is_some_and(|name| name == "mod.rs");
        let depth = if is_room { inside.len().max(2) - 1 } else { inside.len() };
        let source = fs::read_to_string(&path).expect("a readable source");
        for imported in imports(&source, &room, depth) {
            if rank(&imported).is_some_and(|other| other < own) {
                continue;
            }
            wrong.push(format!("{}: imports {imported}, which is not to its left", path.display()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(seen.len() > 10, "the sources were not found: {seen:?}");
}

#[test]
fn rooms_are_found_however_they_are_imported() {
    let found = |source: &str, depth| imports(source, "fibre", depth).into_iter().collect::<Vec<_>>();
    assert_eq!(found("use crate::chain::Chain;", 1), ["chain"]);
    assert_eq!(found("use crate::{\n    air::{Air, Eddies},\n    vec3::Vec3,\n};", 1), ["air", "vec3"]);
    assert_eq!(found("fn f() { super::super::case::check() }", 2), ["case"]);
    assert_eq!(found("fn f() { super::case::check() }", 2), [""; 0]);
    assert_eq!(found("// crate::case\n/// [`crate::case`]\nconst A: &str = \"crate::case\";", 1), [""; 0]);
    assert_eq!(found("let q = '\"'; crate::input::read();", 1), ["input"]);
    assert_eq!(found("use crate::fibre::Fibre; use thecrate::case;", 1), [""; 0]);
}

#[test]
fn equations_named_in_the_source_are_in_the_theory() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a folder of crates");
    let docs = crates.parent().expect("the repository").join("docs");
    let theory = fs::read_to_string(docs.join("theory.md")).expect("docs/theory.md");
    let numbers = |text: &str, before: &str, after: char| -> Vec<u32> {
        text.split(before).skip(1).filter_map(|rest| rest.split(after).next()?.parse().ok()).collect()
    };
    let there = numbers(&theory, "\\tag{", '}');
    assert_eq!(there, (1..=there.len() as u32).collect::<Vec<_>>(), "equations are numbered in order");
    let mut count = 0;
    for path in sources(crates) {
        let source = fs::read_to_string(&path).expect("a readable source");
        for number in numbers(&source, "theory.md (", ')') {
            assert!(there.contains(&number), "{}: theory.md ({number}) is not there", path.display());
            count += 1;
        }
    }
    assert!(count > 20, "only {count} equations are named");
}
