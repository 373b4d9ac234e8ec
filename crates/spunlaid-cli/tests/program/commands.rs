//! The commands beside `run`: `check`, `new`, `completions`, and help.

use crate::desk::{Desk, names, refusal, success};
use std::fs;
use std::process::Command;

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
    // On standard output the same.
    assert_eq!(success(&mut desk.spunlaid("new -")).as_bytes(), written);
    assert!(success(&mut desk.spunlaid("new - --fed")).contains("[belt]") && !desk.path("-").exists());
    let said = refusal(&mut desk.spunlaid("new no/such/folder/my.toml"), 2);
    assert!(said.starts_with("error: no/such/folder/my.toml: cannot be written: "), "{said}");
    assert!(said.ends_with("; name another file\n"), "{said}");
}

#[test]
fn new_writes_a_study_beside_its_case() {
    let desk = Desk::new();
    let said = success(&mut desk.spunlaid("new --study brief.toml"));
    let wanted =
        "wrote brief_study.toml, which varies brief.toml; change it, then: spunlaid sweep brief_study.toml\n";
    assert_eq!(said, wanted);
    let said = success(&mut desk.spunlaid("sweep brief_study.toml"));
    assert!(said.contains("9 points"), "{said}");
    assert_eq!(
        refusal(&mut desk.spunlaid("new --study brief.toml"), 1),
        "error: brief_study.toml: exists already and is not overwritten; name another file\n"
    );
    // Without a case, that is written too.
    let said = success(&mut desk.spunlaid("new --study --fed line.toml"));
    assert!(said.starts_with("wrote line.toml\nwrote line_study.toml, which varies line.toml;"), "{said}");
    assert!(success(&mut desk.spunlaid("sweep line_study.toml --print-point 1")).contains("[belt]"));
    let said = refusal(&mut desk.spunlaid("new --study line_study.toml"), 1);
    assert!(said.contains("line_study.toml: is a study already"), "{said}");
    assert!(refusal(&mut desk.spunlaid("new --study -"), 1).contains("name a file"));
    std::fs::write(desk.path("bad.toml"), "[fibre]\nlength = 3\n").unwrap();
    assert!(refusal(&mut desk.spunlaid("new --study bad.toml"), 1).starts_with("error: bad.toml:"));
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
fn completions_name_the_keys_of_each_command() {
    let desk = Desk::new();
    fs::write(desk.path("spunlaid.bash"), success(&mut desk.spunlaid("completions bash"))).unwrap();
    // What Bash offers for the last word of a line, as it splits the line.
    let offers = |words: &[&str]| -> Vec<String> {
        let line: Vec<String> = words.iter().map(|word| format!("'{word}'")).collect();
        let ask = format!(
            "compopt() {{ :; }}; source ./spunlaid.bash; COMP_WORDS=(spunlaid {}); COMP_CWORD={}; \
             _spunlaid_and_keys spunlaid '{}' '{}'; printf '%s\\n' \"${{COMPREPLY[@]}}\"",
            line.join(" "),
            words.len(),
            words[words.len() - 1],
            words.get(words.len().wrapping_sub(2)).unwrap_or(&"spunlaid"),
        );
        let output = Command::new("bash").args(["-c", &ask]).current_dir(desk.path("")).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap().lines().map(str::to_owned).collect()
    };
    assert_eq!(offers(&["run", "my.toml", "--set", "air.record_m"]), ["air.record_max_gap="]);
    assert_eq!(offers(&["web", "my.toml", "--set", "line.belt_"]), ["line.belt_speed="]);
    assert_eq!(offers(&["spin", "my.toml", "--set", "air.vel"]), [""]);
    assert_eq!(offers(&["keys", "belt.sp"]), ["belt.speed"]);
    // A key that is no completion is taken all the same.
    assert!(success(&mut desk.spunlaid("keys stiff")).contains("fibre.youngs_modulus"));
    success(&mut desk.with("check brief.toml", &["air.velocity=20 m/s"]));
}

#[test]
fn manual_pages_are_written_for_every_command() {
    let desk = Desk::new();
    let said = success(&mut desk.spunlaid("man pages/man1"));
    assert_eq!(said, "wrote the manual pages to pages/man1; man spunlaid shows the first\n");
    let pages = desk.entries("pages/man1");
    for name in ["spunlaid.1", "spunlaid-run.1", "spunlaid-sweep.1", "spunlaid-man.1"] {
        assert!(pages.contains(name), "{pages:?}");
    }
    let run = String::from_utf8(desk.read("pages/man1/spunlaid-run.1")).unwrap();
    assert!(run.contains(".TH") && run.contains("replicates") && run.contains("origin.toml"), "{run}");
    // Again they are renewed.
    success(&mut desk.spunlaid("man pages/man1"));
    fs::write(desk.path("file"), "mine").unwrap();
    assert!(refusal(&mut desk.spunlaid("man file"), 2).contains("file: cannot be written"));
}

#[test]
fn a_case_may_come_from_standard_input() {
    let desk = Desk::new();
    let piped = |arguments: &str, text: &[u8]| {
        fs::write(desk.path("input"), text).unwrap();
        let input = fs::File::open(desk.path("input")).unwrap();
        desk.spunlaid(arguments).stdin(input).output().unwrap()
    };
    let case = desk.read("brief.toml");
    assert!(piped("run - --quiet", &case).status.success());
    assert!(desk.entries("results/case").contains("summary.json"));
    success(&mut desk.spunlaid("run brief.toml --out r"));
    assert!(desk.read("r/end_node.parquet") == desk.read("results/case/end_node.parquet"));
    // What came from there before is unknown, so nothing is replaced.
    let refused = piped("run -", &case);
    assert_eq!(refused.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("results/case: holds results already"));
    let summary = piped("run - --json --quiet --set air.velocity=20m/s", &case);
    assert!(String::from_utf8_lossy(&summary.stdout).contains("\"velocity_m_s\": 20.0"));
    assert!(piped("check -", &case).status.success());
    let wrong = [
        (&b"[fibre]\nlength = 3\n"[..], "standard input:2: fibre.length"),
        (b"\xff", "standard input: cannot be read as UTF-8"),
    ];
    for (text, words) in wrong {
        let refused = piped("run -", text);
        let said = String::from_utf8(refused.stderr).unwrap();
        assert!(refused.status.code() == Some(1) && said.contains(words), "{said}");
    }
}

#[test]
fn numbers_of_options_are_asked_for_in_plain_words() {
    let desk = Desk::new();
    for (arguments, option) in [
        ("run brief.toml --replicates 1e9", "--replicates <N>"),
        ("run brief.toml --seed x", "--seed <S>"),
        ("sweep study.toml --replicates 0", "--replicates <N>"),
        ("sweep study.toml --points 1.5", "--points <N>"),
    ] {
        let said = refusal(&mut desk.spunlaid(arguments), 1);
        let least = u8::from(arguments.ends_with(" 0"));
        let wanted = format!("for '{option}': write a whole number from {least} in digits, like 1000");
        assert!(said.contains(&wanted), "{said}");
    }
    let hours = success(&mut desk.with("check brief.toml", &["run.duration=1 h", "run.spin_up=30 min"]));
    assert!(hours.contains("duration = \"3600 s\"") && hours.contains("spin_up = \"1800 s\""), "{hours}");
}

#[test]
fn help_teaches_with_examples() {
    let desk = Desk::new();
    for command in ["", "run", "sweep", "check", "new", "completions", "man"] {
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
