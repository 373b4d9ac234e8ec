//! Wrong input: exit code 1, a message with the way out, nothing written. What is not the fault of the input: 2.

use crate::desk::{BRIEF, Desk, ENTRIES, names, refusal, success};
use std::fs;
use std::path::Path;

/// A brief case with one line written otherwise.
fn spoilt(line: &str, otherwise: &str) -> String {
    assert!(BRIEF.contains(line));
    BRIEF.replace(line, otherwise)
}

#[test]
fn rejects_bad_cases_and_writes_nothing() {
    let desk = Desk::new();
    let diameter = r#"diameter = "50 µm""#;
    for (text, wanted) in [
        (
            spoilt(diameter, r#"diametre = "50 µm""#),
            &["case.toml:6: fibre.diametre", "did you mean fibre.diameter?"][..],
        ),
        (spoilt(diameter, ""), &["fibre.diameter is missing; add diameter = \"50 µm\" to [fibre]"]),
        (spoilt(diameter, "diameter = 50e-6"), &["case.toml:6: fibre.diameter = 50e-6", "unit"]),
        (spoilt(diameter, r#"diameter = "50 µs""#), &["case.toml:6: fibre.diameter = \"50 µs\"", "length"]),
        (spoilt(diameter, r#"diameter = "-50 µm""#), &["is not positive"]),
        (spoilt(diameter, "diameter = nan"), &["case.toml:6: fibre.diameter = nan"]),
        (
            spoilt(r#"time_step = "20 µs""#, r#"time_step = "50 µs""#),
            &["exceeds the stability limit 34.", "lower it"],
        ),
        (
            spoilt("version = 1", "version = 2"),
            &["case.toml:2: version = 2 is newer than the format that this spunlaid reads (1)"],
        ),
        (spoilt("[run]", "[run"), &["write [run]"]),
        (spoilt("seed = 7", "seed = 7\nharmonics = 3"), &["run.harmonics = 3 is out of place", "[air]"]),
        (
            spoilt(r#"cutoff_frequency = "100 Hz""#, "cutoff_frequency = \"100 Hz\"\nharmonics = 0"),
            &["air.harmonics = 0 is out of range"],
        ),
        (
            spoilt("[air]", "element_length = \"1 nm\"\n[air]"),
            &["fibre.element_length = \"1 nm\"", "needs", "GiB"],
        ),
        (String::new(), &["fibre.length is missing", "run.duration is missing"]),
    ] {
        fs::write(desk.path("case.toml"), &text).unwrap();
        let said = refusal(&mut desk.spunlaid("run case.toml"), 1);
        assert!(said.lines().all(|line| line.starts_with("error: case.toml")), "{said}");
        for part in wanted {
            assert!(said.contains(part), "{text}\n{said}\n{part}");
        }
        assert_eq!(refusal(&mut desk.spunlaid("check case.toml"), 1), said);
        assert_eq!(desk.entries(""), names(&["brief.toml", "case.toml"]));
    }
}

#[test]
fn rejects_files_that_are_no_case() {
    let desk = Desk::new();
    fs::write(desk.path("binary.toml"), [0x5b, 0x0a, 0xff, 0x00]).unwrap();
    let sparse = fs::File::create(desk.path("large.toml")).unwrap();
    sparse.set_len(2 << 30).unwrap();
    fs::create_dir(desk.path("folder.toml")).unwrap();
    for (name, wanted) in [
        ("nowhere.toml", "nowhere.toml: there is no such file; name a case file (`spunlaid new` writes one)"),
        ("folder.toml", "folder.toml: is a folder"),
        ("large.toml", "large.toml: is larger than"),
        ("binary.toml", "binary.toml:2: byte 0xff (number 3 of the file) is not UTF-8 text"),
        ("brief.toml/case.toml", "brief.toml/case.toml: "),
        #[cfg(unix)]
        ("/dev/zero", "/dev/zero: is larger than"),
        #[cfg(unix)]
        ("/dev/null", "/dev/null: fibre.length is missing"),
    ] {
        let said = refusal(&mut desk.spunlaid(&format!("run {name}")), 1);
        assert!(said.starts_with(&format!("error: {wanted}")), "{said}");
    }
    assert_eq!(desk.entries(""), names(&["binary.toml", "brief.toml", "folder.toml", "large.toml"]));
}

#[test]
fn rejects_bad_arguments() {
    let desk = Desk::new();
    for (arguments, wanted) in [
        ("run", "<CASE>"),
        ("fly brief.toml", "unrecognized subcommand 'fly'"),
        ("run brief.toml --set", "--set <KEY=VALUE>"),
        ("run brief.toml --set air.velocity", "write a key and a value, as air.velocity=\"20 m/s\""),
        ("run brief.toml --set air.velocty=20", "did you mean"),
        ("run brief.toml --set air.velocity=20", "unit"),
        ("run brief.toml --set =20", "error:"),
        ("run brief.toml --replicates 0", "run.replicates = 0 is out of range"),
        ("run brief.toml --replicates -1", "error:"),
        ("run brief.toml --seed 1.5", "error:"),
        ("run brief.toml --threads 0", "--threads"),
        (
            "run brief.toml --set run.time_step=50us",
            "error: --set run.time_step = \"50us\" exceeds the stability",
        ),
    ] {
        let said = refusal(&mut desk.spunlaid(arguments), 1);
        assert!(said.contains(wanted), "{said}");
    }
    assert_eq!(desk.entries(""), names(&["brief.toml"]));
}

#[test]
fn refuses_results_that_are_there_without_force() {
    let desk = Desk::new();
    success(&mut desk.spunlaid("run brief.toml --out r"));
    for entry in ENTRIES {
        // Each of them alone is something of value.
        let alone = desk.path("alone");
        fs::create_dir(&alone).unwrap();
        fs::write(alone.join(entry), "mine").unwrap();
        let said = refusal(&mut desk.spunlaid("run brief.toml --out alone --seed 8"), 1);
        let wanted = format!(
            "error: alone: holds results already ({entry}); name another folder, or replace them (--out, "
        );
        assert!(said.starts_with(&wanted) && said.contains("--force"), "{said}");
        assert_eq!(desk.entries("alone"), names(&[entry]));
        assert_eq!(desk.read(&format!("alone/{entry}")), b"mine");
        fs::remove_dir_all(alone).unwrap();
    }
}

#[test]
fn the_same_command_replaces_its_results_after_an_edit_and_says_so() {
    let desk = Desk::new();
    let said = desk.spunlaid("run brief.toml --out r").output().unwrap();
    assert!(said.status.success() && !String::from_utf8_lossy(&said.stderr).contains("replaced"));
    fs::write(desk.path("r/thesis.tex"), "mine").unwrap();
    let edited = String::from_utf8(desk.read("brief.toml")).unwrap().replace("10 m/s", "12 m/s");
    fs::write(desk.path("brief.toml"), &edited).unwrap();
    let said = desk.spunlaid("run brief.toml --out r").output().unwrap();
    let notes = String::from_utf8(said.stderr).unwrap();
    assert!(said.status.success(), "{notes}");
    assert!(notes.contains("note: r: holds earlier results of this command, which are replaced"), "{notes}");
    assert_eq!(desk.summary("r")["case"]["air"]["velocity_m_s"], 12.0);
    assert_eq!(desk.read("r/thesis.tex"), b"mine");
    // The folder and the case may be moved together.
    fs::create_dir(desk.path("moved")).unwrap();
    for name in ["brief.toml", "r"] {
        fs::rename(desk.path(name), desk.path(&format!("moved/{name}"))).unwrap();
    }
    success(&mut desk.spunlaid("run moved/brief.toml --out moved/r"));
    // What another command, another case, or other changes would replace stays.
    fs::write(desk.path("other.toml"), &edited).unwrap();
    for arguments in ["run other.toml --out moved/r", "run moved/brief.toml --out moved/r --seed 8"] {
        let refused = refusal(&mut desk.spunlaid(arguments), 1);
        assert!(refused.contains("moved/r: holds results already"), "{refused}");
    }
}

#[test]
fn every_command_replaces_its_own_results_and_no_others() {
    let desk = Desk::new();
    let probe = fs::read_to_string("../../cases/records/probe.csv").unwrap();
    fs::write(desk.path("probe.csv"), probe.lines().take(4000).collect::<Vec<_>>().join("\n")).unwrap();
    for run in ["a", "b"] {
        success(&mut desk.spunlaid(&format!("run brief.toml --quiet --out {run}")));
    }
    let ran = |command: &str| {
        let output = desk.spunlaid(command).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    for (command, other, complete) in [
        ("air brief.toml --frames 1 --out air", "air brief.toml --frames 2 --out air", "summary.json"),
        ("analyse probe.csv --out analyse", "analyse probe.csv --segment 512 --out analyse", "analysis.json"),
        (
            "analyse a/map.csv --pixel 1mm --weight 13gsm --out scan",
            "analyse a/map.csv --pixel 2mm --weight 13gsm --out scan",
            "summary.json",
        ),
        ("compare a b --out compare", "compare b a --out compare", "comparison.json"),
        ("reproduce --figures 2 --out reproduce", "reproduce --figures 3 --out reproduce", "summary.json"),
    ] {
        let rows =
            (0..40).map(|i| (0..40).map(|j| format!("{}", 10 + (i * j) % 7)).collect::<Vec<_>>().join(","));
        fs::write(desk.path("a/map.csv"), rows.collect::<Vec<_>>().join("\n")).unwrap();
        let folder = command.rsplit(' ').next().unwrap();
        let (code, said) = ran(command);
        assert!(code == Some(0) && !said.contains("replaced"), "{command}: {said}");
        let (code, said) = ran(command);
        let wanted = format!("note: {folder}: holds earlier results of this command, which are replaced");
        assert!(code == Some(0) && said.contains(&wanted), "{command}: {said}");
        assert!(!ran(&format!("{command} --quiet")).1.contains("replaced"), "{command}");
        let before = desk.read(&format!("{folder}/{complete}"));
        let (code, said) = ran(other);
        assert!(code == Some(1) && said.contains(": holds results already (origin.toml)"), "{other}: {said}");
        assert!(desk.read(&format!("{folder}/{complete}")) == before, "{other}");
    }
}

#[test]
fn force_replaces_results_and_keeps_what_others_put_there() {
    let desk = Desk::new();
    success(&mut desk.with("run brief.toml --out r", &["run.output_interval=0.5 ms"]));
    fs::write(desk.path("r/thesis.tex"), "mine").unwrap();
    fs::create_dir(desk.path("r/notes")).unwrap();
    fs::write(desk.path("r/notes/shape.pvd"), "mine").unwrap();
    let before = desk.entries("r/shape").len();
    success(&mut desk.spunlaid("run brief.toml --out r --force --seed 8"));
    assert_eq!(desk.read("r/thesis.tex"), b"mine");
    assert_eq!(desk.read("r/notes/shape.pvd"), b"mine");
    assert_eq!(desk.summary("r")["case"]["run"]["seed"], 8);
    let mut wanted = names(&ENTRIES);
    wanted.extend(names(&["thesis.tex", "notes"]));
    assert_eq!(desk.entries("r"), wanted);
    assert_eq!((before, desk.entries("r/shape").len()), (21, 11), "no shapes of the old run among the new");
    // A run that fails leaves the old results as they are.
    refusal(&mut desk.spunlaid("run brief.toml --out r --force --set run.seed=-1"), 1);
    assert_eq!(desk.summary("r")["case"]["run"]["seed"], 8);
}

/// Of a run, and of a study that has changed.
#[test]
fn a_file_of_the_users_in_figures_stays() {
    let desk = Desk::new();
    let study = |speeds: &str| {
        let text = format!(
            "version = 1\ncase = \"brief.toml\"\ndesign = \"grid\"\nreplicates = 1\n\
            [vary]\n\"air.velocity\" = {speeds}\n"
        );
        fs::write(desk.path("study.toml"), text).unwrap();
    };
    study("[\"8 m/s\", \"9 m/s\"]");
    for (command, folder) in [("run brief.toml", "results/brief"), ("sweep study.toml", "results/study")] {
        success(&mut desk.spunlaid(command));
        let mine = ["figures/mine.svg", "figures/more/mine.txt"].map(|file| format!("{folder}/{file}"));
        fs::create_dir_all(desk.path(&mine[1]).parent().unwrap()).unwrap();
        mine.iter().for_each(|file| fs::write(desk.path(file), "mine").unwrap());
        let figures = || desk.entries(&format!("{folder}/figures"));
        let before = figures();
        study("[\"8 m/s\", \"12 m/s\"]");
        success(&mut desk.spunlaid(command));
        mine.iter().for_each(|file| assert_eq!(desk.read(file), b"mine", "{file}"));
        assert_eq!(figures(), before);
    }
}

/// One rule for all commands: results are not mixed with files of others unless it is asked for.
#[test]
fn rejects_folders_with_files_of_others_without_force() {
    let desk = Desk::new();
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    for file in ["web_known.toml", "spinline.toml", "records/probe.csv", "tables/spinline.csv"] {
        let to = desk.path(&file.replace("records/", ""));
        fs::create_dir_all(to.parent().unwrap()).unwrap();
        fs::copy(cases.join(file), to).unwrap();
    }
    let study = "version = 1\ncase = \"brief.toml\"\ndesign = \"grid\"\nreplicates = 1\n\
        [vary]\n\"air.velocity\" = [\"9 m/s\", \"10 m/s\"]\n";
    fs::write(desk.path("study.toml"), study).unwrap();
    let web = "web_known.toml --set web.width=250mm --set web.length=250mm";
    success(&mut desk.spunlaid(&format!("web {web} --out laid --quiet --no-advice")));
    success(&mut desk.spunlaid("run brief.toml --out run --quiet"));
    for (command, complete) in [
        ("run brief.toml", "summary.json"),
        (&*format!("web {web} --no-advice"), "summary.json"),
        ("spin spinline.toml", "summary.json"),
        ("analyse probe.csv", "analysis.json"),
        ("analyse laid/map.png", "summary.json"),
        ("sweep study.toml", "results.csv"),
        (&*format!("fit {web} --to laid --vary laydown.noise --webs 8"), "fit.json"),
        ("compare run run", "comparison.json"),
    ] {
        let command = format!("{command} --quiet --out theirs");
        let _ = fs::remove_dir_all(desk.path("theirs"));
        fs::create_dir_all(desk.path("theirs/notes")).unwrap();
        fs::write(desk.path("theirs/thesis.tex"), "mine").unwrap();
        let said = refusal(&mut desk.spunlaid(&command), 1);
        let wanted = "error: theirs: holds other files already (notes and 1 more), and results are not mixed \
            with them; name another folder, or write next to them (--out, --force)\n";
        assert!(said.ends_with(wanted), "{command}: {said}");
        assert_eq!(desk.entries("theirs"), names(&["thesis.tex", "notes"]), "{command}");
        if !command.starts_with("fit ") {
            success(&mut desk.spunlaid(&format!("{command} --force")));
            assert!(desk.path("theirs").join(complete).exists(), "{command}");
            assert_eq!(desk.read("theirs/thesis.tex"), b"mine", "{command}");
        }
    }
    // What a system hides in a folder is no reason.
    fs::create_dir(desk.path("hidden")).unwrap();
    fs::write(desk.path("hidden/.DS_Store"), "").unwrap();
    success(&mut desk.spunlaid("run brief.toml --out hidden"));
    let mut wanted = names(&ENTRIES);
    wanted.insert(".DS_Store".to_owned());
    assert_eq!(desk.entries("hidden"), wanted);
}

#[test]
fn refuses_folders_that_cannot_be_written() {
    let desk = Desk::new();
    let said = refusal(&mut desk.spunlaid("run brief.toml --out brief.toml"), 1);
    assert_eq!(said, "error: brief.toml: is a file; name a folder (--out)\n");
    let said = refusal(&mut desk.spunlaid("run brief.toml --out brief.toml/below/it"), 2);
    assert!(said.starts_with("error: brief.toml/below/it: cannot be written: "), "{said}");
    assert!(said.ends_with("name another folder (--out)\n"), "{said}");
    if cfg!(target_os = "linux") {
        let said = refusal(&mut desk.spunlaid("run brief.toml --out /proc/spunlaid/r"), 2);
        assert!(said.starts_with("error: /proc/spunlaid/r: cannot be written: "), "{said}");
    }
    assert_eq!(desk.entries(""), names(&["brief.toml"]));
}

#[test]
fn a_run_that_blows_up_names_node_time_and_cause() {
    let desk = Desk::new();
    // Stable for the mesh, but stiff against the air: a fibre as light as this is swept along at once.
    let changes = ["fibre.diameter=0.05 µm", "fibre.density=20 kg/m³", "run.time_step=4 us"];
    let said = refusal(&mut desk.with("run brief.toml --out some/where", &changes), 2);
    let last = said.lines().last().unwrap();
    assert!(last.starts_with("error: replicate ") && last.contains("node "), "{said}");
    assert!(
        last.contains("node 2 moves with ") && last.contains(" m/s at ") && last.contains(" s; "),
        "{said}"
    );
    assert_eq!(desk.entries(""), names(&["brief.toml"]));
}

#[test]
fn a_record_that_cannot_be_used_is_reported_with_the_option_that_helps() {
    let desk = Desk::new();
    for (text, wanted) in [
        ("u_m_s\n1\n2\n", "or give the sampling rate (--time-column, --rate)\n"),
        ("time_s,u\n0,1\n1,2\n", "like u_m_s (or --time-unit, --velocity-unit)\n"),
        ("time_s,p\n0,1\n1,2\n", "in which unit (--columns, --velocity-unit)\n"),
    ] {
        fs::write(desk.path("a.csv"), text).unwrap();
        let said = refusal(&mut desk.spunlaid("analyse a.csv"), 1);
        assert!(said.starts_with("error: a.csv: ") && said.ends_with(wanted), "{said}");
    }
}

#[test]
fn a_broken_case_is_refused_in_the_same_words_wherever_it_comes_from() {
    let desk = Desk::new();
    for (bytes, wanted) in [
        (
            &b"version = 1\n[fibre]\ndirection = [1.0, 0.0, 0.0\n"[..],
            "case.toml:3:13: the list that begins with [",
        ),
        (
            b"[fibre]\nlength = 1,5 m\n",
            "case.toml:2:11: the line has a decimal comma; write length = \"1.5 m\"",
        ),
        (
            b"[fibre]\ndiameter = \"50 \xb5m\"\n",
            "case.toml:2: is not UTF-8 text: byte 0xb5 in this line would be \u{b5}",
        ),
        (b"\xff\xfe[\0r\0u\0n\0]\0", "case.toml: is UTF-16 text"),
        (b"[\0r\0u\0n\0]\0", "case.toml: is UTF-16 text"),
    ] {
        fs::write(desk.path("case.toml"), bytes).unwrap();
        let said = refusal(&mut desk.spunlaid("check case.toml"), 1);
        assert!(said.starts_with(&format!("error: {wanted}")), "{said}");
        assert_eq!(refusal(&mut desk.spunlaid("live case.toml --no-open"), 1), said);
        let file = fs::File::open(desk.path("case.toml")).unwrap();
        let piped = refusal(desk.spunlaid("check -").stdin(file), 1);
        assert_eq!(piped.replace("standard input", "case.toml"), said);
    }
}
