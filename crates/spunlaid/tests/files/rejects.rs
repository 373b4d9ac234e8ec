//! Bad input and what is said of it: each file `bad_cases/NAME.toml` is refused with the message in
//! `bad_cases/NAME.txt`. With `BLESS=1` in the environment the messages are written, to be read over.

use crate::messages;
use spunlaid_ground::Error;
use spunlaid_input::{LARGEST_FILE, read_case, starter_case};
use std::fs;
use std::path::Path;

fn refusal(path: &Path, overrides: &[(&str, &str)]) -> Error {
    let overrides: Vec<_> = (overrides.iter()).map(|(k, v)| (k.to_string(), v.to_string())).collect();
    read_case(path, &overrides).unwrap_err()
}

fn fault(path: &Path) -> String {
    match refusal(path, &[]) {
        Error::File(problem) => problem.cause.to_string(),
        other => panic!("{other}"),
    }
}

#[test]
fn no_control_character_of_a_name_reaches_the_terminal() {
    let case = starter_case();
    for (name, shown) in [("t\\bles/x.csv", "t\\u{8}les/x.csv"), ("\\u001b[2J.csv", "\\u{1b}[2J.csv")] {
        let text = case.replace("[air]", &format!("[air]\nprofile = \"{name}\""));
        let said = read_case((&text, "\u{7}.toml"), &[]).unwrap_err().to_string();
        assert!(said.contains(shown) && said.contains("\\u{7}.toml:"), "{said}");
        assert!(said.chars().all(|c| c == '\n' || !c.is_control()), "{said:?}");
    }
}

#[test]
fn rejects_every_bad_case_with_its_message() {
    messages::are_as_meant("bad_cases", 40, |path| read_case(path, &[]));
}

#[test]
fn rejects_what_is_no_readable_file() {
    let folder = tempfile::tempdir().unwrap();
    let nowhere = Path::new("no/such/case.toml");
    assert_eq!(fault(nowhere), "there is no such file; name a case file");
    assert_eq!(
        refusal(nowhere, &[]).to_string(),
        "no/such/case.toml: there is no such file; name a case file"
    );
    assert_eq!(fault(folder.path()), "is a folder; name the case file in it");
    let below_a_file = folder.path().join("file/case.toml");
    fs::write(folder.path().join("file"), "").unwrap();
    let below_a_file = fault(&below_a_file);
    assert!(
        ["cannot be read: ", "there is no such file"].iter().any(|said| below_a_file.starts_with(said)),
        "{below_a_file}"
    );
}

#[test]
fn rejects_a_file_of_two_gigabytes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.toml");
    fs::File::create(&path).unwrap().set_len(2 << 30).unwrap();
    let started = std::time::Instant::now();
    assert!(fault(&path).starts_with("is larger than"));
    assert!(started.elapsed().as_secs_f64() < 1.0);
}

#[test]
fn rejects_one_byte_more_than_the_largest_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.toml");
    let mut text = fs::read_to_string("../../cases/table1.toml").unwrap();
    text.push_str(&"#".repeat(LARGEST_FILE as usize - text.len()));
    fs::write(&path, &text).unwrap();
    read_case(&path, &[]).unwrap();
    text.push('#');
    fs::write(&path, &text).unwrap();
    assert!(fault(&path).starts_with("is larger than"));
}

#[cfg(target_os = "linux")]
#[test]
fn rejects_a_device_without_end() {
    assert!(fault(Path::new("/dev/zero")).starts_with("is larger than"));
    assert!(matches!(refusal(Path::new("/dev/null"), &[]), Error::Rejected(_)));
}

#[test]
fn rejects_overrides_by_their_name() {
    let table1 = Path::new("../../cases/table1.toml");
    for (key, value, message) in [
        (
            "run.time_step",
            "50 µs",
            "override run.time_step = \"50 µs\" exceeds the stability limit 34.46 µs (axial waves of 50 mm elements); \
             lower it to at most 31 µs or lengthen fibre.element_length",
        ),
        (
            "air.velocity",
            "20",
            "override air.velocity = 20 has no unit; write a velocity with its unit: m/s, cm/s, mm/s, km/h or m/min",
        ),
        (
            "air.velocty",
            "20 m/s",
            "override air.velocty = \"20 m/s\" is not a key of a case file; did you mean air.velocity?",
        ),
        (
            "velocity",
            "20 m/s",
            "override velocity = \"20 m/s\" is out of place; it belongs in [air], as air.velocity",
        ),
        ("fibre.root", "clampd", "override fibre.root = \"clampd\" is unknown; did you mean \"clamped\"?"),
        ("aer.velocity", "20 m/s", "override [aer] is not a table of a case file; did you mean [air]?"),
        ("air", "still", "override air is a table; write one of its keys, override air.key=value"),
        (
            "air.velocity",
            "",
            "override air.velocity = \"\" does not start with a number; write a velocity with its unit: \
             m/s, cm/s, mm/s, km/h or m/min",
        ),
        (
            "run.time_step",
            "1e-300 s",
            "../../cases/table1.toml:18: run.duration = \"1 s\" needs 1.0e300 steps of 1e-300 s, more than 1e12; \
             shorten it or lengthen run.time_step\noverride run.time_step = \"1e-300 s\" is outside the usual range, \
             0.1 ns to 100 ms; check the value and its unit",
        ),
    ] {
        assert_eq!(refusal(table1, &[(key, value)]).to_string(), message);
    }
}

#[test]
fn rejects_no_more_than_people_read() {
    let text: String = (0..1000).map(|i| format!("strange_key_{i} = 1\n")).collect();
    let error = read_case((&text, "many.toml"), &[]).unwrap_err();
    assert_eq!(error.to_string().lines().count(), 21);
    assert!(error.to_string().ends_with("\nand 989 more like these"), "{error}");
}

/// It is refused by the memory that it would need, before anything is made for each eddy: their list alone
/// would need more than a machine has.
#[test]
fn rejects_far_too_many_eddies_of_a_record() {
    let case = Path::new("../../cases/record.toml");
    let error = refusal(case, &[("air.length_scale", "1e-15 m")]).to_string();
    assert!(error.contains("air.length_scale = \"1e-15 m\""), "{error}");
    assert!(
        error.contains("of memory for eight fibres side by side, most of it for the turbulence"),
        "{error}"
    );
}

#[test]
fn rejects_a_case_that_code_built() {
    let (mut case, _) = read_case((starter_case(), "starter.toml"), &[]).unwrap();
    case.check().unwrap();
    case.fibre.length = -1.0;
    case.fibre.elements = 0;
    case.fibre.direction.x = 1.1;
    case.air.harmonics = 0;
    case.air.velocity = f64::NAN;
    case.run.replicates = 0;
    case.run.steps = 0;
    case.run.output_steps = 0;
    let said: Vec<_> = case.check().unwrap_err().iter().map(ToString::to_string).collect();
    assert_eq!(
        said,
        [
            "fibre.length = -1 m is not positive; a length above zero is needed",
            "fibre.direction = [1.1, 0, 0] is not a unit vector; divide it by its length",
            "air.velocity = NaN m/s is not a finite number; write a finite one",
            "air.harmonics = 0 is out of range; write a whole number from 1 to 18446744073709551615",
            "run.duration = 0 s is not positive; a time above zero is needed",
            "run.replicates = 0 is out of range; write a whole number from 1 to 10000000",
            "run.output_interval = 0 s is not positive; a time above zero is needed",
            "fibre.elements = 0 is out of range; write a whole number from 1 to 18446744073709551615",
        ]
    );
}
