//! The commands beside `run`: `check`, `new`, `completions`, and help.

use crate::desk::{Desk, names, refusal, success};

#[test]
fn check_prints_a_case_that_can_be_read_again() {
    let desk = Desk::new();
    let said = success(&mut desk.with("check brief.toml", &["air.velocity=12 m/s"]));
    for part in [
        "velocity = \"12 m/s\"",
        "friction_coefficient = 0.9",
        "4 elements of 50 mm, 4 eddies of 50 mm",
        "time step 20 µs, 500 steps; stable below",
        "34.46 µs",
        "axial waves",
        "expected: less than a second on 1 of ",
        "MiB of memory, 1 MB of results",
        "ready: spunlaid run brief.toml --set 'air.velocity=12 m/s'",
    ] {
        assert!(said.contains(part), "{part}\n{said}");
    }
    assert_eq!(desk.entries(""), names(&["brief.toml"]));
    // What it prints is the case file that a run resolves to, and remarks.
    success(&mut desk.with("run brief.toml --out r", &["air.velocity=12 m/s"]));
    let resolved = String::from_utf8(desk.read("r/case.toml")).unwrap();
    assert!(said.contains(&resolved), "{said}");
    std::fs::write(desk.path("printed.toml"), said.split("\nready").next().unwrap()).unwrap();
    assert!(success(&mut desk.spunlaid("check printed.toml")).contains(&resolved));
}

#[test]
fn check_remarks_on_rounded_elements_and_extrapolated_drag_once() {
    let desk = Desk::new();
    let mut command = desk.with("check brief.toml", &["fibre.element_length=33 mm", "fibre.diameter=5 um"]);
    let output = command.arg("--set").arg("run.time_step=1 us").output().unwrap();
    assert!(output.status.success());
    let said = String::from_utf8(output.stderr).unwrap();
    let note = "note: --set fibre.element_length = \"33 mm\" does not divide fibre.length into whole elements: 6 of 33.33 mm are used";
    assert_eq!(said.matches(note).count(), 1, "{said}");
    assert_eq!(
        said.matches("warning: --set fibre.diameter = \"5 um\" is outside 13 µm to 390 µm").count(),
        1
    );
    assert_eq!(said.lines().count(), 2, "{said}");
}

#[test]
fn new_writes_a_case_that_can_be_run_and_overwrites_nothing() {
    let desk = Desk::new();
    let said = success(&mut desk.spunlaid("new my.toml"));
    assert_eq!(said, "wrote my.toml; change it, then: spunlaid run my.toml\n");
    let written = desk.read("my.toml");
    let shorter = ["run.duration=2 ms", "run.time_step=20 us"];
    success(&mut desk.with("run my.toml", &shorter));
    assert_eq!(
        refusal(&mut desk.spunlaid("new my.toml"), 1),
        "error: my.toml: exists already and is not overwritten; name another file\n"
    );
    assert!(desk.read("my.toml") == written);
    let said = refusal(&mut desk.spunlaid("new no/such/folder/my.toml"), 2);
    assert!(said.starts_with("error: no/such/folder/my.toml: cannot be written: "), "{said}");
    assert!(said.ends_with("; name another file\n"), "{said}");
}

#[test]
fn new_writes_a_fed_fibre_that_can_be_run() {
    let desk = Desk::new();
    success(&mut desk.spunlaid("new --fed line.toml"));
    let said = success(&mut desk.spunlaid("check line.toml"));
    for part in [
        "elements of 2 mm, one fed every 40 µs (2 steps); 250 from the inlet to the belt",
        "16.7 m of fibre on each metre of belt; 12.5 m are fed in the run, 10.5 m of them after the spin-up",
        "the air at 126 stations, 4 mm apart",
        "feed of an element",
    ] {
        assert!(said.contains(part), "{part}\n{said}");
    }
    assert!(!said.contains("eddies of"), "{said}");
    let said = success(&mut desk.with("run line.toml", &["run.duration=30 ms", "run.replicates=2"]));
    assert!(said.contains("Spread in machine direction"), "{said}");
    // Lines that are commented out show the default.
    let written = String::from_utf8(desk.read("line.toml")).unwrap();
    let optional = |line: &&str| {
        line.strip_prefix("# ").is_some_and(|rest| rest.contains(" = ") && !rest.contains("version"))
    };
    let all: Vec<&str> = written.lines().filter(optional).collect();
    assert!(all.len() > 8, "{all:?}");
    let uncommented: String = written
        .lines()
        .map(|line| if optional(&line) { &line[2..] } else { line }.to_owned() + "\n")
        .collect();
    std::fs::write(desk.path("all.toml"), uncommented).unwrap();
    let resolved = |name: &str| {
        success(&mut desk.spunlaid(&format!("check {name}"))).split("# mesh").next().unwrap().to_owned()
    };
    assert_eq!(resolved("all.toml"), resolved("line.toml"));
}

#[test]
fn completions_name_every_command_and_option() {
    let desk = Desk::new();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = success(&mut desk.spunlaid(&format!("completions {shell}")));
        for word in ["spunlaid", "run", "sweep", "check", "new", "replicates", "force"] {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
    assert!(refusal(&mut desk.spunlaid("completions tcsh"), 1).contains("possible values: bash"));
}

#[test]
fn help_teaches_with_examples() {
    let desk = Desk::new();
    for command in ["", "run", "sweep", "check", "new", "completions"] {
        let help = success(&mut desk.spunlaid(&format!("{command} --help")));
        assert!(help.contains("Example") && help.contains(&format!("spunlaid {command}")), "{help}");
        assert!(!help.contains('\u{1b}'), "colour without a terminal");
    }
    assert!(success(&mut desk.spunlaid("--help")).contains("Exit codes: 0 done; 1 the input is wrong"));
    let version = success(&mut desk.spunlaid("--version"));
    assert_eq!(version, format!("spunlaid {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn errors_are_coloured_on_request_only() {
    let desk = Desk::new();
    let said = |key: &str| refusal(desk.spunlaid("check nowhere.toml").env(key, "1"), 1);
    assert!(said("CLICOLOR_FORCE").starts_with("\u{1b}["));
    assert!(said("NO_COLOR").starts_with("error:"));
}
