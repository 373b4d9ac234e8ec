//! The house stands: wings and rooms import only from those left of their own, and every equation the source names
//! is in `docs/theory.md`.

#![allow(clippy::expect_used)]

mod rooms_of;

use rooms_of::{Rooms, circles, code_and_texts, faults, paths, sources};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The wings of the library from left to right, each with its rooms from left to right; those of one group stand side
/// by side and may not import one another.
const WINGS: &[(&str, &[&[&str]])] = &[
    ("air", &[&["record"], &["motion"]]),
    (
        "fibre",
        &[
            &["body", "line"],
            &["drag", "charge"],
            &["spinline", "chain"],
            &["energy"],
            &["case"],
            &["flight", "load"],
        ],
    ),
    ("web", &[&["laydown", "surrogate"], &["map"], &["curtain", "scan"], &["fabric"]]),
    ("simulation", &[&["observe"], &["ensemble"], &["layers"], &["one_air"]]),
    ("experiment", &[&["claim", "plausible", "plant"], &["study"], &["advice", "fit"]]),
    ("input", &[]),
];

/// The rooms of the crates that the library stands on, from left to right.
const BELOW: &[(&str, Rooms<'_>)] = &[
    (
        "ground",
        &[
            &["named"],
            &["lanes"],
            &["vec3", "fft", "nodes", "sort", "random", "place"],
            &["error"],
            &["units", "threads", "removed"],
            &["company", "log"],
            &["file", "table"],
            &["statistics"],
            &["measure"],
            &["effects"],
        ],
    ),
    (
        "field",
        &[
            &["fault", "cells_of_file", "evenness"],
            &["node"],
            &["tree", "lattice", "bricks"],
            &["holes", "mesh"],
            &["points"],
            &["read"],
        ],
    ),
];

fn crates() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("a folder of crates")
}

#[test]
fn rooms_below_the_library_import_only_from_their_left() {
    for (name, rooms) in BELOW {
        let src = crates().join(format!("spunlaid-{name}/src"));
        let wrong = [faults(&src, None, rooms, &["lib"]), circles(&src)].concat();
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }
}

#[test]
fn wings_import_only_from_their_left() {
    let wings: Vec<&[&str]> = WINGS.iter().map(|(wing, _)| std::slice::from_ref(wing)).collect();
    let wrong = faults(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), None, &wings, &["lib"]);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn rooms_import_only_from_their_left() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    // The files of a wing without rooms are held apart by the next test.
    let in_rooms = WINGS.iter().filter(|(_, rooms)| !rooms.is_empty());
    let wrong: Vec<_> =
        in_rooms.flat_map(|(wing, rooms)| faults(&src.join(wing), Some(wing), rooms, &["mod"])).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Types that a file takes from deep within a wing of the library though its door has them: names of wing, room and
/// type.
fn past_doors(file: &Path, doors: &BTreeMap<&str, String>) -> Vec<String> {
    let source = fs::read_to_string(file).expect("a readable source");
    let past = paths(&code_and_texts(&source).0).into_iter().filter(|path| {
        // What `crate::ground` has is also in `spunlaid_ground`.
        let names = match &path.names[..] {
            [root, rest @ ..] if root == "spunlaid_ground" => {
                [&["crate", "ground"].map(str::to_owned), rest].concat()
            }
            names => names.to_vec(),
        };
        let [root, wing, _, name, ..] = &names[..] else { return false };
        let at_door =
            |door: &String| door.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == name);
        let own = file.iter().zip(file.iter().skip(1)).any(|(src, folder)| src == "src" && folder == &**wing);
        let is_type = name.starts_with(|c: char| c.is_uppercase());
        ["crate", "spunlaid"].contains(&&**root) && is_type && !own && doors.get(&**wing).is_some_and(at_door)
    });
    past.map(|path| format!("{}: {}", file.display(), path.names.join("::"))).collect()
}

/// What a wing gives to others stands in its `mod.rs`, and others take it there.
#[test]
fn types_of_a_wing_are_taken_at_its_door() {
    let wings = WINGS.iter().map(|(wing, _)| (*wing, format!("spunlaid/src/{wing}/mod.rs")));
    let wings = wings.chain([("ground", "spunlaid-ground/src/lib.rs".to_owned())]);
    let door = |file: String| fs::read_to_string(crates().join(file)).expect("a wing");
    let code = |text: String| {
        text.lines().filter(|line| !line.trim().starts_with("//")).collect::<Vec<_>>().join("\n")
    };
    let doors = wings.map(|(wing, file)| (wing, code(door(file)))).collect();
    let wrong: Vec<_> = sources(crates()).iter().flat_map(|file| past_doors(file, &doors)).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn files_do_not_import_one_another() {
    let wrong = circles(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn equations_named_in_the_source_are_in_the_theory() {
    let docs = crates().parent().expect("the repository").join("docs");
    let theory = fs::read_to_string(docs.join("theory.md")).expect("docs/theory.md");
    let numbers = |text: &str, before: &str, after: char| -> Vec<u32> {
        text.split(before).skip(1).filter_map(|rest| rest.split(after).next()?.parse().ok()).collect()
    };
    let there = numbers(&theory, "\\tag{", '}');
    assert_eq!(there, (1..=there.len() as u32).collect::<Vec<_>>(), "equations are numbered in order");
    let mut count = 0;
    for path in sources(crates()) {
        let source = fs::read_to_string(&path).expect("a readable source");
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
    for path in sources(crates()) {
        let main = path.with_file_name("main.rs");
        let in_tests = path.iter().any(|part| part == "tests") && path != main && main.exists();
        if in_tests && let Some(name) = path.file_stem().and_then(|name| name.to_str()) {
            let program = fs::read_to_string(&main).expect("a readable source");
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
