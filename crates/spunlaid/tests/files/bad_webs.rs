//! Bad files of webs and their messages: each file `bad_webs/NAME.toml` is rejected with the message in
//! `bad_webs/NAME.txt`. With `BLESS=1` in the environment the test writes the messages, to be reviewed.

use crate::messages;
use spunlaid_ground::Error;
use spunlaid_input::{read_case, read_web};
use std::fs;
use std::path::Path;

#[test]
fn rejects_every_bad_web_with_its_message() {
    messages::are_as_meant("bad_webs", 50, |path| read_web(path, &[]));
}

#[test]
fn rejects_a_web_without_a_filament_that_is_read_as_a_case() {
    let text = fs::read_to_string("../../cases/web_known.toml").unwrap();
    let said = read_case((&text, "web_known.toml"), &[]).unwrap_err().to_string();
    assert!(
        said.contains("[laydown] simulates no filament: how its fibres lie is known; to lay the web"),
        "{said}"
    );
}

#[test]
fn rejects_what_is_no_readable_file() {
    let fault = |path: &Path| match read_web(path, &[]).unwrap_err() {
        Error::File(problem) => problem.cause.to_string(),
        other => panic!("{other}"),
    };
    assert_eq!(fault(Path::new("no/such/web.toml")), "there is no such file; name the file of a web");
    assert_eq!(fault(Path::new("tests")), "is a folder; name the file of a web in it");
}

/// What is said of the known web with one override.
fn refusal(text: &str, key: &str, value: &str) -> String {
    read_web((text, "web.toml"), &[(key.to_owned(), value.to_owned())]).unwrap_err().to_string()
}

#[test]
fn rejects_overrides_by_their_name() {
    let known = fs::read_to_string("../../cases/web_known.toml").unwrap();
    for (key, value, message) in [
        (
            "line.belt_speed",
            "60 m/s",
            "override line.belt_speed = \"60 m/s\" is more than line.feed_speed = 50 m/s, which would tear \
            the fibre; slow the belt, or feed faster",
        ),
        (
            "line.belt_speed",
            "3",
            "override line.belt_speed = 3 has no unit; write a velocity with its unit: m/s, cm/s, mm/s, km/h or m/min",
        ),
        (
            "line.belt_sped",
            "3 m/s",
            "override line.belt_sped = \"3 m/s\" is not a key of a web file; did you mean line.belt_speed?",
        ),
        (
            "belt_speed",
            "3 m/s",
            "override belt_speed = \"3 m/s\" is out of place; it belongs in [line], as line.belt_speed",
        ),
        ("line", "fast", "override line is a table; write one of its keys, override line.key=value"),
        (
            "layer.2.line.belt_speed",
            "3 m/s",
            "override layer.2.line.belt_speed = \"3 m/s\" is of a layer that the file does not have; it has \
            no [[layer]], so write the key without layer",
        ),
        (
            "line.rows.1.pitch",
            "1 mm",
            "override line.rows.1.pitch = \"1 mm\" is of a row of holes that the file does not have; \
             write a list of rows, like [{ offset = \"0 mm\", pitch = \"0.2 mm\", filaments = 5000 }]",
        ),
    ] {
        assert_eq!(refusal(&known, key, value), message);
    }
    let layers = "[web]\nwidth = \"1 m\"\nlength = \"1 m\"\n[[layer]]\nname = \"S 1.2\"\n[layer.line]\n\
        belt_speed = \"3 m/s\"\n";
    let refusals =
        |key: &str| refusal(layers, key, "0 m/s").lines().map(ToOwned::to_owned).collect::<Vec<_>>();
    let is_reported = |said: &[String], part: &str| said.iter().any(|line| line.contains(part));
    for key in ["layer.1.line.belt_speed", "layer.S 1.2.line.belt_speed"] {
        let said = refusals(key);
        assert!(
            is_reported(&said, "override layer.1.line.belt_speed = \"0 m/s\" is not positive"),
            "{said:?}"
        );
    }
    // Without the number of a layer it is that of all layers.
    let said = refusals("line.belt_speed");
    assert!(is_reported(&said, "override layer.1.line.belt_speed = \"0 m/s\" is not positive"), "{said:?}");
    let said = refusals("layer.3.line.belt_speed");
    assert!(is_reported(&said, "is of a layer that the file does not have; it has one, layer.1"), "{said:?}");
}
