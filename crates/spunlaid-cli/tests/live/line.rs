//! `spunlaid live` of a line, as its page meets it: knobs, numbers, files.

use crate::served::{Live, Page};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::Command;

/// A line of which a few filaments are simulated, in a second or so.
const LINE: &str = include_str!("line.toml");

fn start() -> Live {
    start_with(LINE)
}

fn start_with(text: &str) -> Live {
    Live::start_in(|folder| {
        fs::write(folder.join("line.toml"), text).unwrap();
        vec!["line.toml".into()]
    })
}

/// The patches of a message.
fn patches(found: &Value) -> &[Value] {
    found["patches"].as_array().unwrap()
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
    let before = &patch["before"];
    let now = &patch["now"];
    let change = &patch["change"];
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
    // On a busy machine a block takes long, and the program may wait for a processor meanwhile.
    assert!((0..100).any(|_| (0..4).all(|_| rests())));
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
        (json!({"do": "back", "to": 77}), "no longer stored"),
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

#[test]
#[ignore = "slow: webs with two seeds"]
fn identical_confirmation_and_change_of_a_line_with_the_other_seed() {
    let live = start();
    let mut page = live.page();
    page.ask(&json!({"do": "confirm"}));
    let problem = page.message("refused")["problems"][0]["text"].as_str().unwrap().to_owned();
    assert!(problem.contains("change a setting"), "{problem}");
    page.ask(&set("throughput", &json!(0.6), 1));
    until(&mut page, "found", |found| patches(found).iter().any(|patch| patch["change"].is_object()));
    page.ask(&json!({"do": "confirm"}));
    let state = until(&mut page, "state", |state| state["confirmation"]["is_done"] == true);
    assert_eq!(state["confirmation"]["seed"], 2);
    let found = live.page().message("found");

    let other = start_with(&LINE.replace("[web]", "[web]\nseed = 2"));
    let mut page = other.page();
    page.ask(&set("throughput", &json!(0.6), 1));
    until(&mut page, "state", |state| state["work"]["stage"] == "complete" && state["generation"] == 1);
    let alone = other.page().message("found");
    let mut compared = 0;
    for (patch, alone) in patches(&found).iter().zip(patches(&alone)) {
        assert_eq!((&patch["side_m"], &patch["confirmed"]), (&alone["side_m"], &alone["change"]));
        // The sample may say nothing over patches of some size.
        if patch["confirmed"].is_object() {
            assert!(patch["confirmed"]["standard_error"].as_f64().unwrap() > 0.0, "{patch}");
            assert_ne!(patch["confirmed"]["value"], patch["change"]["value"], "{patch}");
            compared += 1;
        }
    }
    assert!(compared > 0, "{found}");
}

#[test]
fn plant_numbers_of_a_slider_that_moves_are_those_of_the_line_with_this_value() {
    let live = start();
    let mut page = live.page();
    page.ask(&json!({"do": "pause"}));
    let before = until(&mut page, "state", |state| state["stands"] == true);
    let key = "throughput";
    let preview =
        |value: Value, stamp: u64| json!({"do": "preview", "key": key, "value": value, "stamp": stamp});
    for (value, stamp) in [(0.55, 3), (0.6, 4)] {
        page.ask(&preview(json!(value), stamp));
    }
    let shown = until(&mut page, "preview", |message| message["stamp"] == 4);
    assert_eq!(shown["generation"], 0);
    assert_ne!(shown["plant"], before["plant"]);
    page.ask(&preview(json!("1 mm"), 5));
    assert_eq!(page.message("refused")["about"], json!({"is": "preview"}));
    // The line has not changed by it.
    let state = live.page().message("state");
    assert_eq!(
        (&state["generation"], &state["plant"], &state["text"]),
        (&json!(0), &before["plant"], &json!(LINE))
    );
    page.ask(&set("throughput", &json!(0.6), 6));
    let turned = until(&mut page, "state", |state| state["generation"] == 1);
    assert_eq!(shown["plant"], turned["plant"]);
}

/// The value of a key on the page of a fibre, as it is written there.
fn on_fibre(state: &Value, key: &str) -> String {
    let values = state["values"].as_array().unwrap();
    let found = values.iter().find(|value| value["key"] == key);
    found.unwrap_or_else(|| panic!("no {key} in {values:?}"))["text"].as_str().unwrap().to_owned()
}

#[test]
fn the_filament_of_the_line_is_a_tab_whose_sliders_do_something_and_that_follows_the_knobs() {
    let live = start();
    for (tab, other) in [("", "<a href=\"./fibre/\">Fibre</a>"), ("fibre/", "<a href=\"../\">Web</a>")] {
        let page = live.get(tab);
        assert!(page.starts_with("HTTP/1.1 200 ") && page.contains(other), "{page}");
    }
    assert!(live.get("fibre/scene.js").starts_with("HTTP/1.1 200 "));
    for file in ["fibre/line.js", "scene.js", "fibre", "fibre-2/", "fibre/fibre/"] {
        assert!(live.get(file).starts_with("HTTP/1.1 404 "), "{file}");
    }
    let (mut web, mut fibre) = (live.page(), live.page_at("fibre/"));
    web.ask(&json!({"do": "pause"}));
    let (settings, before) = (fibre.message("settings"), fibre.message("state"));
    // 0.5 g/min of 2 dtex.
    assert_eq!(
        (on_fibre(&before, "feed.speed"), before["title"].as_str()),
        ("41.67 m/s".to_owned(), Some("line_filament"))
    );
    let slider = |setting: &&Value| setting["takes"] == "quantity" && setting["first"] == true;
    let sliders: Vec<&Value> = settings["settings"].as_array().unwrap().iter().filter(slider).collect();
    assert!(sliders.len() > 5, "{settings}");
    for (stamp, slider) in (1..).zip(sliders) {
        let key = slider["key"].as_str().unwrap();
        let state = live.page_at("fibre/").message("state");
        let value = 1.05
            * state["values"].as_array().unwrap().iter().find(|one| one["key"] == key).unwrap()["si"]
                .as_f64()
                .unwrap();
        fibre.ask(&set(key, &json!(value), stamp));
        assert_eq!(fibre.message("applied")["stamp"], stamp, "{key}");
        let turned = until(&mut fibre, "state", |now| now["generation"] != state["generation"]);
        assert_ne!(on_fibre(&turned, key), on_fibre(&state, key), "{key}");
    }
    // The line has its own knobs; turned there, its filament comes back as it is now.
    web.ask(&set("throughput", &json!(0.6), 1));
    let followed = until(&mut fibre, "state", |state| on_fibre(state, "feed.speed") == "50 m/s");
    assert_eq!(on_fibre(&followed, "air.velocity"), on_fibre(&before, "air.velocity"));
}

/// The short line, from two beams with slots of their own.
fn of_two_layers() -> String {
    let (head, rest) = LINE.split_once("[line]").unwrap();
    let (line, rest) = rest.split_once("[web]").unwrap();
    let beam = |depth: &str| format!("\n[[layer]]\n[layer.line]{}", line.replace("10 mm", depth));
    format!("{head}[web]{rest}{}{}", beam("10 mm"), beam("15 mm"))
}

#[test]
#[ignore = "slow: webs of two layers, in the page and in the program"]
fn identical_numbers_of_a_line_of_two_layers_with_a_knob_and_a_tab_of_each() {
    let live = start_with(&of_two_layers());
    let mut page = live.page();
    let knobs = page.message("knobs");
    let names: Vec<&str> =
        knobs["knobs"].as_array().unwrap().iter().map(|knob| knob["name"].as_str().unwrap()).collect();
    for knob in ["throughput.1", "throughput.2", "slot_gap", "air_speed"] {
        assert!(names.contains(&knob), "no {knob} in {names:?}");
    }
    let found = complete(&mut page, 0);
    assert_same(&found, "before", &web(live.folder.path(), "line.toml"));
    page.ask(&set("throughput.2", &json!(0.6), 1));
    until(&mut page, "found", |found| {
        found["generation"] == 1 && patches(found).iter().any(|patch| patch["change"].is_object())
    });
    let found = complete(&mut page, 1);
    page.ask(&json!({"do": "save", "name": "line_2.toml", "replace": false}));
    assert_eq!(page.message("saved")["name"], "line_2.toml");
    assert_same(&found, "now", &web(live.folder.path(), "line_2.toml"));
    for tab in ["fibre-1/", "fibre-2/"] {
        assert!(live.get("").contains(tab) && live.get(tab).starts_with("HTTP/1.1 200 "), "{tab}");
        assert!(live.page_at(tab).message("state")["belt"].is_object());
    }
}

/// The short line from the die on, whose tension flights find.
fn of_simulated_tension() -> String {
    const DIE: &str = "[spinline]\npolymer = \"pp\"\nmelt_flow_rate = 35\ndie_temperature = \"230 °C\"\n\
        hole_diameter = \"0.6 mm\"\nlength = \"1.2 m\"\nvelocity = \"50 m/s\"\nend_tension = \"simulated\"\n\n[fibre]";
    let given = ["linear_density", "density", "youngs_modulus"];
    let kept = LINE.lines().filter(|line| !given.iter().any(|key| line.starts_with(key)));
    // Long enough for a mean tension.
    kept.collect::<Vec<_>>().join("\n").replace("[fibre]", DIE).replace("40 ms", "0.2 s")
}

#[test]
#[ignore = "slow: rounds of flights that find a tension"]
fn a_line_whose_tension_flights_find_has_numbers_once_it_is_found() {
    let live = start_with(&of_simulated_tension());
    let mut page = live.page();
    page.ask(&json!({"do": "pause"}));
    let before = until(&mut page, "state", |state| state["stands"] == true);
    let speed = |state: &Value| {
        let plant = state["plant"].as_array().unwrap();
        plant.iter().find(|number| number["name"] == "spinning_speed").unwrap()["now"]
            .as_str()
            .unwrap()
            .to_owned()
    };
    // Of a value for which the tension is not known there are no numbers while the slider moves.
    page.ask(&json!({"do": "preview", "key": "throughput", "value": 0.57, "stamp": 1}));
    assert_eq!(page.message("preview")["plant"], json!([]));
    page.ask(&set("throughput", &json!(0.57), 2));
    page.ask(&json!({"do": "go"}));
    let settling = until(&mut page, "state", |state| state["generation"] == 1);
    let settled =
        until(&mut page, "state", |state| state["generation"] == 1 && speed(state) != speed(&settling));
    assert_ne!(speed(&settled), speed(&before));
    // Its filament is shown with the tension that was found: no other flights look for it.
    let fibre = live.page_at("fibre/").message("state");
    let text = fibre["text"].as_str().unwrap();
    let tension = text.lines().find(|line| line.starts_with("end_tension")).unwrap();
    assert!(tension.ends_with(" N\""), "{tension}");
    let found = until(&mut page, "found", |found| {
        found["generation"] == 1 && patches(found).iter().any(|patch| patch["change"].is_object())
    });
    assert!(patches(&found)[0]["before"].is_object(), "{found}");
}
