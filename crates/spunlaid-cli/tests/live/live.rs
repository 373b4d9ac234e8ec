//! `spunlaid live` as its page meets it: messages, frames, time, what is saved.

use crate::served::{Live, Page};
use serde_json::{Value, json};
use std::process::Command;
use tungstenite::Message;

#[test]
fn what_can_change_in_flight_changes_at_once_and_the_case_follows() {
    let live = Live::start(&["table1.toml"]);
    let mut page = live.page();
    let settings = page.message("settings");
    let keys: Vec<&str> =
        settings["settings"].as_array().unwrap().iter().map(|s| s["key"].as_str().unwrap()).collect();
    assert!(keys.contains(&"air.velocity") && keys.contains(&"drag.along"), "{keys:?}");
    let before = page.message("state");
    assert!(before["text"].as_str().unwrap().contains("scheme = \"implicit-tension\""), "{before}");
    assert!(before["remark"].as_str().unwrap().contains("semi-implicit-euler"), "{before}");
    let (_, _, time) = page.frame();

    page.ask(&json!({ "do": "set", "key": "air.velocity", "value": 20, "stamp": 5 }));
    let applied = page.message("applied");
    assert_eq!(applied["stamp"], 5);
    let state = page.message("state");
    assert!(state["text"].as_str().unwrap().contains("velocity = \"20 m/s\""), "{state}");
    assert!(state["command"].as_str().unwrap().contains("--set 'air.velocity=20 m/s'"), "{state}");
    assert_eq!(state["air"], 20.0);
    let (generation, _, later) = page.frame();
    assert!(u64::from(generation) >= applied["generation"].as_u64().unwrap() && later >= time);

    page.ask(&json!({ "do": "set", "key": "air.length_scale", "value": "60 mm", "stamp": 6 }));
    assert_eq!(page.message("applied")["stamp"], 6);
    // A new flight, but the time of the page goes on.
    assert!(page.frame().2 >= later);
}

#[test]
fn rejects_bad_values_by_key_and_bad_cases_by_line() {
    let live = Live::start(&["table1.toml"]);
    let mut page = live.page();
    let text = page.message("state")["text"].as_str().unwrap().to_owned();
    let set = |key: &str, value: Value| json!({ "do": "set", "key": key, "value": value, "stamp": 1 });
    for (message, line, wanted) in [
        (set("air.velocitiy", json!(1)), None, "did you mean"),
        (set("fibre.diameter", json!(-1e-5)), Some(6), "fibre.diameter = \"-10 µm\" is not positive"),
        (set("fibre.diameter", json!("5 s")), Some(6), "is a time; write a length"),
        (set("fibre.root", json!("glued")), Some(9), "is unknown"),
        (set("air.profile", json!("/etc/passwd")), None, "can use only the files"),
        (json!({ "do": "case", "text": text.replace("50 mm", "50 mmm") }), Some(14), "air.length_scale"),
        (json!({ "do": "case", "text": "a =\n= b" }), Some(1), ""),
        (json!({ "do": "case", "text": "" }), None, "fibre"),
        (json!({ "do": "dance" }), None, "not understood"),
    ] {
        let problem = page.refused(&message);
        assert!(problem["text"].as_str().unwrap().contains(wanted), "{message}: {problem}");
        assert_eq!(problem["line"].as_u64(), line, "{message}: {problem}");
    }
    page.0.send(Message::binary(vec![1, 2, 3])).unwrap();
    assert!(page.message("refused")["problems"][0]["text"].as_str().unwrap().contains("messages are text"));
    page.ask(&json!({ "do": "forget" }));
    assert_eq!(page.message("state")["text"], text);
}

/// What the page says of the filament, the first sentence.
fn filament(state: &Value) -> String {
    state["filament"][0].as_str().unwrap().to_owned()
}

#[test]
fn a_spinline_is_solved_again_and_the_fibre_flies_with_its_filament() {
    let live = Live::start(&["whole_line_fibre.toml"]);
    let mut page = live.page();
    let settings = page.message("settings");
    let settings = settings["settings"].as_array().unwrap();
    let labels: Vec<&str> = settings
        .iter()
        .filter(|setting| setting["table"] == "spinline" && setting["first"] == true)
        .map(|setting| setting["key"].as_str().unwrap().strip_prefix("spinline.").unwrap())
        .collect();
    for key in
        ["throughput", "die_temperature", "velocity_factor", "cross_velocity_factor", "temperature_offset"]
    {
        assert!(labels.contains(&key), "{key}: {labels:?}");
    }
    let before = page.message("state");
    assert!(filament(&before).contains(": 0.5 g/min from each hole"), "{before}");
    let frozen = before["filament"][1].as_str().unwrap();
    assert!(frozen.contains("below the die, at 110 °C"), "{frozen}");

    // A slider sends a number in SI units, which is rounded in the unit of the key.
    page.ask(&json!({ "do": "set", "key": "spinline.throughput", "value": 1.3333e-5, "stamp": 1 }));
    assert_eq!(page.message("applied")["stamp"], 1);
    let state = page.message("state");
    assert!(
        state["text"].as_str().unwrap().contains("throughput = \"0.8 g/min\"                # per hole"),
        "{state}"
    );
    assert!(state["command"].as_str().unwrap().contains("--set 'spinline.throughput=0.8 g/min'"), "{state}");
    assert!(filament(&state).contains(": 0.8 g/min from each hole"), "{state}");
    let feed = |state: &Value| state["belt"]["feed"].as_f64().unwrap();
    assert!((feed(&state) / feed(&before) - 1.0).abs() > 0.02, "{state}");
    // It is the filament of the same spinline on the command line.
    let cases = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let alone = Command::new(env!("CARGO_BIN_EXE_spunlaid"))
        .args(["spin", "--json", "--set", "spinline.throughput=0.8 g/min"])
        .arg(cases.join("whole_line_fibre.toml"))
        .output()
        .unwrap();
    let alone: Value = serde_json::from_slice(&alone.stdout).unwrap();
    assert_eq!(alone["spinline"]["final_speed_m_s"], state["belt"]["feed"]);

    // No steady state: the page says why, and the setting before flies on.
    let problem = page
        .refused(&json!({ "do": "set", "key": "spinline.die_temperature", "value": "100 °C", "stamp": 2 }));
    assert!(
        problem["text"].as_str().unwrap().starts_with("spinline.die_temperature = \"100 °C\" "),
        "{problem}"
    );
    assert_eq!(problem["line"], 8);
    let after = page.message("state");
    assert_eq!((&after["text"], &after["generation"]), (&state["text"], &state["generation"]));
    let first = page.frame().2;
    while page.frame().2 <= first {}
}

#[test]
fn the_tension_of_flights_is_a_number_on_the_page() {
    let live = Live::start(&["whole_line_fibre.toml"]);
    let mut page = live.page();
    // Coarse and short, so that the flights take no longer than they must.
    let short = [("fibre.element_length", "20 mm"), ("run.duration", "30 ms"), ("run.spin_up", "12 ms")];
    for (key, value) in short.into_iter().chain([("spinline.end_tension", "simulated")]) {
        page.ask(&json!({ "do": "set", "key": key, "value": value, "stamp": 1 }));
        assert_eq!(page.message("applied")["stamp"], 1, "{key}");
    }
    let line = |state: &Value| {
        let text = state["text"].as_str().unwrap();
        text.lines().find(|line| line.starts_with("end_tension")).unwrap().to_owned()
    };
    // The page goes on while other fibres fly for the tension; the one on the page flies without it.
    let before = page.message("state");
    assert!(line(&before).contains("simulated"), "{before}");
    let first = page.frame().2;
    while page.frame().2 <= first {}
    page.ask(&json!({ "do": "pace", "pace": "hundredth" }));
    let state = loop {
        let state = page.message("state");
        if !line(&state).contains("simulated") {
            break state;
        }
    };
    assert!(line(&state).ends_with(" N\""), "{state}");
    // It pulls, so the filament is faster than one with a free end.
    let feed = |state: &Value| state["belt"]["feed"].as_f64().unwrap();
    assert!(feed(&state) > 1.01 * feed(&before), "{} {}", feed(&before), feed(&state));
}

/// A fibre in the air of a record with a eddy of 45 km/s, which no flight survives.
const GUST: &str = "version = 1\n[fibre]\nlength = '0.2 m'\ndiameter = '50 µm'\ndensity = '950 kg/m³'\n\
    youngs_modulus = '2 GPa'\nelement_length = '50 mm'\n[air]\nrecord = 'gust.csv'\nvelocity = '10 m/s'\n\
    turbulence_intensity = 450\nlength_scale = '0.2 m'\n[run]\nduration = '50 ms'\ntime_step = '20 µs'\n";

#[test]
fn after_lost_fibres_the_time_stands_until_go() {
    let folder = tempfile::tempdir().unwrap();
    let velocity = |i: u32| if (400..420).contains(&i) { 1e5 } else { 10.0 + f64::from(i * i % 101) * 0.01 };
    let rows = (0..2000).map(|i| format!("{},{}\n", f64::from(i) * 1e-3, velocity(i)));
    let record = format!("time_s,u_m_s\n{}", rows.collect::<String>());
    std::fs::write(folder.path().join("gust.csv"), record).unwrap();
    let case = folder.path().join("gust.toml");
    std::fs::write(&case, GUST).unwrap();
    let live = Live::start(&[case.to_str().unwrap()]);
    let mut page = live.page();
    page.ask(&json!({ "do": "pace", "pace": "free" }));
    let until = |page: &mut Page, stands: bool| loop {
        let state = page.message("state");
        if state["stands"] == stands {
            break state;
        }
    };
    let lost = until(&mut page, true);
    assert!(lost["trouble"].is_string(), "{lost}");
    // They are lost again, but not before the page has seen them fly.
    page.ask(&json!({ "do": "pace", "pace": "hundredth" }));
    page.ask(&json!({ "do": "go" }));
    let on = until(&mut page, false);
    assert!(on["trouble"].is_null(), "{on}");
}

#[test]
fn without_a_case_it_is_table_1_as_everywhere() {
    let [own, named] = [&[][..], &["table1.toml"]].map(|case| Live::start(case).page().message("state"));
    assert_eq!(own["text"], named["text"]);
}

#[test]
fn a_refusal_says_what_it_is_about() {
    let live = Live::start(&["table1.toml"]);
    let mut page = live.page();
    let mut about = |message: &Value| {
        page.ask(message);
        page.message("refused")["about"].clone()
    };
    let wrong_unit = json!({ "do": "set", "key": "air.velocity", "value": "10 g", "stamp": 7 });
    assert_eq!(about(&wrong_unit), json!({ "is": "setting", "stamp": 7 }));
    assert_eq!(
        about(&json!({ "do": "save", "name": "../x.toml", "replace": false })),
        json!({ "is": "name" })
    );
    assert_eq!(about(&json!({ "do": "case", "text": "[fibre" })), json!({ "is": "other" }));
}

#[test]
fn only_what_is_saved_by_a_plain_name_is_written() {
    let live = Live::start(&["spunbond.toml"]);
    let mut page = live.page();
    let save = |name: &str, replace: bool| json!({ "do": "save", "name": name, "replace": replace });
    for name in ["../a", "/tmp/a", "a/b", "", ".hidden", "..", "a\u{0}b"] {
        assert!(
            page.refused(&save(name, true))["text"]
                .as_str()
                .unwrap()
                .contains("cannot be the name of the file"),
            "{name}"
        );
    }
    assert_eq!(live.files(), Vec::<String>::new());
    page.ask(&save("mine", false));
    assert_eq!(page.message("saved")["name"], "mine.toml");
    page.ask(&save("mine.toml", false));
    assert_eq!(page.message("exists")["name"], "mine.toml");
    page.ask(&save("mine.toml", true));
    assert_eq!(page.message("saved")["name"], "mine.toml");
    assert_eq!(live.files(), ["mine.toml"]);
    // The saved case runs from where it is, with the profile that it names.
    let done = Command::new(env!("CARGO_BIN_EXE_spunlaid"))
        .args(["check", "mine.toml"])
        .current_dir(&live.folder)
        .output();
    let done = done.unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

#[test]
fn time_stands_goes_step_by_step_and_rests_when_nobody_looks() {
    let live = Live::start(&["table1.toml"]);
    let (mut page, mut other) = (live.page(), live.page());
    page.ask(&json!({ "do": "pause" }));
    let standing = |page: &mut Page| loop {
        let (_, bits, time) = page.frame();
        if bits & 1 == 1 {
            return time;
        }
    };
    let time = standing(&mut page);
    assert_eq!(standing(&mut other), time);
    // The picture is that of the last step but one, from the first step on.
    let mut stepped = |from: f64| {
        page.ask(&json!({ "do": "step" }));
        loop {
            let (_, bits, time) = page.frame();
            assert_eq!(bits & 1, 1);
            if time != from {
                return time;
            }
        }
    };
    let first = stepped(time);
    let second = stepped(first);
    assert!((second - first - 1e-3).abs() < 1e-9, "{time} {first} {second}");
    // Nobody looks any more: the time does not go on, and a message is answered all the same.
    page.ask(&json!({ "do": "go" }));
    for page in [&mut page, &mut other] {
        page.ask(&json!({ "do": "look", "visible": false }));
    }
    other.0.close(None).unwrap();
    let rested = |page: &mut Page| {
        page.ask(&json!({ "do": "forget" }));
        page.message("state");
        page.frame().2
    };
    let first = loop {
        let [first, second] = [rested(&mut page), rested(&mut page)];
        if first == second {
            break first;
        }
    };
    page.ask(&json!({ "do": "look", "visible": true }));
    while page.frame().2 <= first {}
    page.ask(&json!({ "do": "pace", "pace": "free" }));
    assert_eq!(page.message("state")["pace"], "free");
}
