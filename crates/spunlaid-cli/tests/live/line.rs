//! `spunlaid live` of a line, as its page meets it: knobs, numbers, files.

use crate::served::{Live, Page};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::Command;

/// A line of which a few filaments are simulated, in a second or so.
const LINE: &str = include_str!("line.toml");

fn start() -> Live {
    Live::start_in(|folder| {
        fs::write(folder.join("line.toml"), LINE).unwrap();
        vec!["line.toml".into()]
    })
}

/// The first message of a kind of which something holds.
fn until(page: &mut Page, is: &str, holds: impl Fn(&Value) -> bool) -> Value {
    loop {
        let message = page.message(is);
        if holds(&message) {
            return message;
        }
    }
}

/// The numbers once all of them are complete.
fn complete(page: &mut Page, generation: u64) -> Value {
    let is_known = |patch: &Value| patch["now"].is_object() || patch["now"].is_null();
    until(page, "found", |found| {
        let patches = found["patches"].as_array().unwrap();
        found["generation"] == generation && found["stage"] == "complete" && patches.iter().all(is_known)
    })
}

fn set(name: &str, value: &Value, stamp: u64) -> Value {
    json!({"do": "set", "key": name, "value": value, "stamp": stamp})
}

/// What `spunlaid web` says: the patches of its summary.
fn web(folder: &Path, file: &str) -> Vec<Value> {
    let done = Command::new(env!("CARGO_BIN_EXE_spunlaid"))
        .args(["web", "--json", "--quiet", "--no-advice"])
        .arg(file)
        .current_dir(folder)
        .output()
        .unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let summary: Value = serde_json::from_slice(&done.stdout).unwrap();
    summary["web"]["patches"].as_array().unwrap().clone()
}

/// Whether the numbers of a page are those of the program, to the last bit.
fn assert_same(found: &Value, which: &str, patches: &[Value]) {
    let on_page: Vec<&Value> = found["patches"].as_array().unwrap().iter().collect();
    let mut compared = 0;
    for patch in patches {
        let is_it = |one: &&&Value| one["side_m"] == patch["patch_m"];
        let page = &on_page.iter().find(is_it).unwrap_or_else(|| panic!("{patch}"))[which];
        if patch["cv"].is_null() {
            assert!(page.is_null(), "{page}");
            continue;
        }
        let error = if patch["cv_total_error"].is_null() {
            &patch["cv_standard_error"]
        } else {
            &patch["cv_total_error"]
        };
        assert_eq!(
            (&page["cv"], &page["standard_error"], &page["is_complete"]),
            (&patch["cv"], error, &json!(true))
        );
        compared += 1;
    }
    assert!(compared > 0, "{patches:?}");
}

#[test]
fn identical_numbers_of_the_page_and_of_the_program_before_and_after_a_knob_is_turned() {
    let live = start();
    let mut page = live.page();
    let knobs = page.message("knobs");
    let knob =
        knobs["knobs"].as_array().unwrap().iter().find(|knob| knob["name"] == "throughput").unwrap().clone();
    assert_eq!((&knob["unit"], &knob["value"], &knob["was"]), (&json!("g/min"), &json!(0.5), &json!(0.5)));
    let folder = live.folder.path();
    let found = complete(&mut page, 0);
    assert!(found["patches"].as_array().unwrap().iter().all(|patch| patch["now"].is_null()), "{found}");

    page.ask(&set("throughput", &json!(0.6), 5));
    assert_eq!(page.message("applied"), json!({"is": "applied", "stamp": 5, "generation": 1}));
    let state = until(&mut page, "state", |state| state["generation"] == 1);
    let command = state["command"].as_str().unwrap();
    assert!(command.starts_with("spunlaid web line.toml --set 'line.throughput=0.6 g/min'"), "{command}");
    // The first numbers are a change with an error, at a look.
    let sketch = until(&mut page, "found", |found| found["generation"] == 1 && found["stage"] == "sketch");
    let patch =
        sketch["patches"].as_array().unwrap().iter().find(|patch| patch["change"].is_object()).unwrap();
    let number = |value: &Value| value.as_f64().unwrap();
    let (before, now, change) = (&patch["before"], &patch["now"], &patch["change"]);
    let expected = number(&before["cv"]) * (1.0 + number(&change["value"]));
    assert!((number(&now["cv"]) / expected - 1.0).abs() < 1e-12 && now["is_complete"] == false, "{patch}");
    let error = (number(&before["standard_error"]) * (1.0 + number(&change["value"])))
        .hypot(number(&before["cv"]) * number(&change["standard_error"]));
    assert!((number(&now["standard_error"]) / error - 1.0).abs() < 1e-12, "{patch}");
    assert!(number(&sketch["area_m2"]) >= 0.039, "{sketch}");

    let found = complete(&mut page, 1);
    assert_same(&found, "before", &web(folder, "line.toml"));
    // The file that is saved is the same web.
    page.ask(&json!({"do": "save", "name": "line_2.toml", "replace": false}));
    assert_eq!(page.message("saved")["name"], "line_2.toml");
    assert_same(&found, "now", &web(folder, "line_2.toml"));
    let state = until(&mut page, "state", |state| state["save_name"] == "line_3.toml");
    assert_eq!(state["answers"].as_array().unwrap().len(), 2, "{state}");

    // What was found is remembered.
    page.ask(&json!({"do": "reset"}));
    page.ask(&json!({"do": "back", "to": 1}));
    let again = until(&mut page, "found", |found| found["generation"] == 3);
    assert_eq!((&again["patches"], &again["stage"]), (&found["patches"], &json!("complete")));
}

#[test]
fn a_new_value_stops_the_old_web_and_a_hidden_page_stops_all() {
    let live = start();
    let (mut page, mut other) = (live.page(), live.page());
    let stage = |state: &Value| state["work"]["stage"].as_str().map(str::to_owned);
    until(&mut page, "state", |state| stage(state).as_deref() == Some("complete"));
    page.ask(&set("throughput", &json!(0.55), 1));
    page.ask(&set("throughput", &json!("0.6 g/min"), 2));
    // Another page sees the knob move.
    let moved = until(&mut other, "knobs", |knobs| {
        knobs["knobs"]
            .as_array()
            .unwrap()
            .iter()
            .any(|knob| knob["name"] == "throughput" && knob["value"] == 0.6)
    });
    assert!(
        moved["knobs"].as_array().unwrap().iter().any(|knob| knob["name"] == "titre" || knob["was"] == 0.5)
    );
    // The web before was being laid in full; the comparison begins without waiting for it.
    let state = until(&mut page, "state", |state| state["work"].is_object() && state["generation"] != 0);
    assert_eq!(stage(&state).as_deref(), Some("sketch"), "{state}");
    for page in [&mut page, &mut other] {
        page.ask(&json!({"do": "look", "visible": false}));
    }
    until(&mut page, "state", |state| state["work"].is_null());
    // It stops after the block in which it is.
    let rests = || {
        let spent = live.processor_seconds();
        std::thread::sleep(std::time::Duration::from_millis(300));
        live.processor_seconds() - spent < 0.03
    };
    assert!((0..20).any(|_| rests()) && rests());
    page.ask(&json!({"do": "look", "visible": true}));
    until(&mut page, "found", |found| found["stage"] == "sketch");
    page.ask(&json!({"do": "pause"}));
    until(&mut page, "state", |state| state["stands"] == true && state["work"].is_null());
}

#[test]
fn rejects_what_is_no_knob_and_what_cannot_be_laid() {
    let live = start();
    let mut page = live.page();
    page.ask(&json!({"do": "pause"}));
    let state = until(&mut page, "state", |state| state["stands"] == true);
    assert_eq!((&state["generation"], &state["text"]), (&json!(0), &json!(LINE)));
    for (message, wanted) in [
        (set("thruput", &json!(0.6), 1), "there is no knob \"thruput\"; there are throughput"),
        (set("throughput", &json!("0.6 mm"), 1), "write a mass flow"),
        (set("throughput", &json!(-1), 1), "throughput"),
        (set("throughput", &json!("../secret.toml"), 1), "throughput"),
        (json!({"do": "back", "to": 77}), "not remembered"),
        (json!({"do": "step"}), "no such message"),
        (json!({"do": "case", "text": ""}), "no such message"),
        (json!({"do": "save", "name": "../a", "replace": true}), "cannot be the name of the file"),
    ] {
        let problem = page.refused(&message);
        assert!(problem["text"].as_str().unwrap().contains(wanted), "{message}: {problem}");
    }
    page.ask(&json!({"do": "go"}));
    let state = until(&mut page, "state", |state| state["stands"] == false);
    assert_eq!((&state["generation"], &state["text"]), (&json!(0), &json!(LINE)));
}

#[test]
fn rejects_files_without_a_page_and_says_what_shows_them() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let refused = |name: &str| {
        let done = Command::new(env!("CARGO_BIN_EXE_spunlaid"))
            .args(["live", "--no-open"])
            .arg(cases.join(name))
            .output()
            .unwrap();
        assert!(!done.status.success(), "{name}");
        String::from_utf8(done.stderr).unwrap()
    };
    for (name, wanted) in [
        ("web_known.toml", "spunlaid web "),
        ("spinline.toml", "spunlaid spin "),
        ("studies/velocity.toml", "spunlaid sweep "),
    ] {
        let said = refused(name);
        assert!(said.contains(wanted), "{name}: {said}");
    }
}
