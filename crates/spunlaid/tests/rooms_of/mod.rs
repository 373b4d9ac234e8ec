//! Reads which rooms of a crate, the modules at its root, import which others.
#![allow(clippy::expect_used)]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The rooms of a crate from left to right; those of one group stand side by side and may not import one another.
pub type Rooms<'a> = &'a [&'a [&'a str]];

fn rank(rooms: Rooms<'_>, room: &str) -> Option<usize> {
    rooms.iter().position(|group| group.contains(&room))
}

pub fn sources(folder: &Path) -> Vec<PathBuf> {
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
    code_and_texts(source).0
}

/// The code of a source, in which texts are empty, and the texts as they are written.
pub fn code_and_texts(source: &str) -> (String, Vec<String>) {
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
fn imports(rooms: Rooms<'_>, source: &str, room: &str, depth: usize) -> BTreeSet<String> {
    let code = code_only(source);
    // `super` as often as the file is deep leaves the room, as `crate` does.
    let mut found = named_after(&code, "crate::");
    found.extend(named_after(&code, &"super::".repeat(depth)));
    found.retain(|name| rank(rooms, name).is_some() && name != room);
    found
}

/// What is wrong with the imports of the sources below `root`, a line each, the files of `entrances` left out.
pub fn faults(root: &Path, rooms: Rooms<'_>, entrances: &[&str]) -> Vec<String> {
    let mut seen = BTreeSet::new();
    let mut wrong = Vec::new();
    for path in sources(root) {
        let inside: Vec<String> = path
            .strip_prefix(root)
            .expect("below the root")
            .components()
            .map(|part| part.as_os_str().to_string_lossy().into_owned())
            .collect();
        let room = inside[0].trim_end_matches(".rs").to_owned();
        if entrances.contains(&room.as_str()) {
            continue;
        }
        let Some(own) = rank(rooms, &room) else {
            wrong.push(format!("{room} is a room this test does not know; put it in its place in ROOMS"));
            continue;
        };
        seen.insert(room.clone());
        // src/a.rs and src/a/mod.rs are the room itself, src/a/b.rs is one deeper.
        let is_room = inside.len() == 1 || inside.last().is_some_and(|name| name == "mod.rs");
        let depth = if is_room { inside.len().max(2) - 1 } else { inside.len() };
        let source = fs::read_to_string(&path).expect("a readable source");
        for imported in imports(rooms, &source, &room, depth) {
            if rank(rooms, &imported).is_some_and(|other| other < own) {
                continue;
            }
            wrong.push(format!("{}: imports {imported}, which is not to its left", path.display()));
        }
    }
    let missing = rooms.iter().copied().flatten().filter(|room| !seen.contains(**room));
    wrong.extend(missing.map(|room| format!("{room} is in ROOMS, but there is no such room")));
    wrong
}

#[test]
fn rooms_are_found_however_they_are_imported() {
    const ROOMS: Rooms<'_> = &[&["fibre", "chain", "air", "vec3", "case", "input"]];
    let found = |source: &str, depth| imports(ROOMS, source, "fibre", depth).into_iter().collect::<Vec<_>>();
    assert_eq!(found("use crate::chain::Chain;", 1), ["chain"]);
    assert_eq!(found("use crate::{\n    air::{Air, Eddies},\n    vec3::Vec3,\n};", 1), ["air", "vec3"]);
    assert_eq!(found("fn f() { super::super::case::check() }", 2), ["case"]);
    assert_eq!(found("fn f() { super::case::check() }", 2), [""; 0]);
    assert_eq!(found("// crate::case\n/// [`crate::case`]\nconst A: &str = \"crate::case\";", 1), [""; 0]);
    assert_eq!(found("let q = '\"'; crate::input::read();", 1), ["input"]);
    assert_eq!(found("use crate::fibre::Fibre; use thecrate::case;", 1), [""; 0]);
}
