//! Runs that are stopped, killed or cannot write: nothing is left, or the next run clears it up.
#![cfg(unix)]

use crate::desk::{Desk, ENTRIES, FED, entries, entries_of_fed, names, success};
use std::fs::{self, File};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

/// A run that would take hours, up to where it has begun to fly.
fn long_run(desk: &Desk, arguments: &str, home: &str) -> Child {
    let long = ["run.duration=10000 s", "run.output_interval=1 s", "air.cutoff_frequency=1 Hz"];
    flying(desk, desk.with("run brief.toml", &long).args(arguments.split_whitespace()), home)
}

/// Starts a run and waits until it has begun to fly.
fn flying(desk: &Desk, command: &mut Command, home: &str) -> Child {
    let before = hidden(&desk.path(home));
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let flying = |folder: &Path| {
        let begun = |name: &String| folder.join(name).join("new/energy.parquet").exists();
        hidden(folder).iter().any(|name| !before.contains(name) && begun(name))
    };
    while !flying(&desk.path(home)) {
        std::thread::sleep(Duration::from_millis(5));
    }
    child
}

fn hidden(folder: &Path) -> Vec<String> {
    let all = if folder.exists() { entries(folder) } else { Default::default() };
    all.into_iter().filter(|name| name.starts_with(".spunlaid-")).collect()
}

fn signal(child: &Child, name: &str) {
    let kill = format!("kill -{name} {}", child.id());
    assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
}

fn end(child: Child, name: &str) -> Output {
    signal(&child, name);
    child.wait_with_output().unwrap()
}

#[test]
fn interrupted_nothing_is_left() {
    let desk = Desk::new();
    for signal in ["INT", "TERM"] {
        let output = end(long_run(&desk, "--out some/where/deep", "some/where"), signal);
        assert_eq!(output.status.code(), Some(130));
        assert!(output.stdout.is_empty());
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(
            said.ends_with("error: interrupted; nothing was written. Repeat the command to start again\n"),
            "{said}"
        );
        assert_eq!(desk.entries(""), names(&["brief.toml"]));
    }
}

#[test]
fn interrupted_old_results_stay() {
    let desk = Desk::new();
    success(&mut desk.spunlaid("run brief.toml --out r"));
    let before = desk.read("r/summary.json");
    assert_eq!(end(long_run(&desk, "--out r --force", "r"), "INT").status.code(), Some(130));
    assert_eq!(desk.entries("r"), names(&ENTRIES));
    assert!(desk.read("r/summary.json") == before);
}

/// Ends a run of many flights when some are kept, and compares what the same command then makes with a run in one go.
#[test]
fn identical_bytes_from_a_run_that_was_interrupted_or_killed() {
    const ALL: u64 = 800;
    let desk = Desk::new();
    let run = |folder: &str| {
        let many = ["run.duration=1 s", "run.output_interval=4 ms", "run.scheme=leapfrog", "run.checks=none"];
        let command = format!("run brief.toml --threads 1 --replicates {ALL} --out {folder}");
        desk.with(&command, &many)
    };
    success(&mut run("whole"));
    let kept = || {
        let files = fs::read_dir(desk.path("")).unwrap().map(|file| file.unwrap().path());
        files.into_iter().find(|file| file.extension().is_some_and(|ending| ending == "simulated"))
    };
    for (process, signal) in (1..).zip(["KILL", "INT", "KILL"]) {
        let mut child = run("stopped").stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let size = || kept().and_then(|file| file.metadata().ok()).map_or(0, |about| about.len());
        // Fibres have 251 rows of 16 numbers; so much as 90 of them have, with what was measured of some.
        while size() <= process * 90 * 251 * 16 * 8 {
            assert!(child.try_wait().unwrap().is_none(), "the run ends before it is signalled");
            std::thread::sleep(Duration::from_millis(1));
        }
        let output = end(child, signal);
        if signal == "INT" {
            assert_eq!(output.status.code(), Some(130));
            let summary = desk.summary("stopped");
            let replicates = summary["replicates"].as_u64().unwrap();
            assert!((8..ALL).contains(&replicates) && replicates.is_multiple_of(8));
            let expected = format!("{replicates} of {ALL} replicates");
            let notes = summary["notes"].as_array().unwrap();
            assert!(notes.iter().any(|note| note.as_str().unwrap().starts_with(&expected)), "{notes:?}");
        } else {
            assert_eq!(output.status.code(), None);
            // As if it had been killed in the middle of writing.
            let landed = File::options().write(true).open(kept().unwrap()).unwrap();
            landed.set_len(landed.metadata().unwrap().len() - 5).unwrap();
        }
    }
    let again = run("stopped").output().unwrap();
    let said = String::from_utf8(again.stderr).unwrap();
    let left = said.split_once("going on: ").and_then(|(_, said)| said.split_once(" of "));
    let left: u64 = left.and_then(|(left, _)| left.parse().ok()).unwrap_or_else(|| panic!("{said}"));
    assert!(again.status.success() && (64..ALL).contains(&left), "{said}");
    assert!(kept().is_none());
    for file in ["case.toml", "end_node.parquet", "energy.parquet", "shape.pvd"] {
        let [one, other] = ["stopped", "whole"].map(|folder| desk.read(&format!("{folder}/{file}")));
        assert!(one == other, "{file}");
    }
    let [one, other] = ["stopped", "whole"].map(|folder| {
        let mut summary = desk.summary(folder);
        summary["performance"] = serde_json::Value::Null;
        summary
    });
    assert!(one == other);
}

#[test]
#[ignore = "slow: every command is killed"]
fn killed_nothing_looks_like_results_and_the_next_run_clears_up() {
    let desk = Desk::new();
    assert_eq!(end(long_run(&desk, "--out r", ""), "KILL").status.code(), None);
    assert!(!desk.path("r").exists());
    assert_eq!(hidden(&desk.path("")).len(), 1);
    // A run that lives is left alone, whoever clears up.
    let live = long_run(&desk, "--out elsewhere", "");
    success(&mut desk.spunlaid("run brief.toml --out r"));
    assert_eq!(hidden(&desk.path("")).len(), 1);
    assert_eq!(end(live, "INT").status.code(), Some(130));
    assert_eq!(desk.entries(""), names(&["brief.toml", "r"]));

    // The same inside a folder that is there.
    end(long_run(&desk, "--out r --force", "r"), "KILL");
    assert_eq!(hidden(&desk.path("r")).len(), 1);
    assert_eq!(desk.summary("r")["steps"], 500, "the old results are still there");
    success(&mut desk.spunlaid("run brief.toml --out r --force"));
    assert_eq!(desk.entries("r"), names(&ENTRIES));
}

#[test]
fn what_only_looks_like_a_leftover_stays() {
    let desk = Desk::new();
    fs::create_dir(desk.path(".spunlaid-mine.partial")).unwrap();
    fs::write(desk.path(".spunlaid-notes.partial"), "mine").unwrap();
    success(&mut desk.spunlaid("run brief.toml --out r"));
    assert_eq!(hidden(&desk.path("")).len(), 2);
}

#[test]
fn results_that_appear_during_a_run_are_not_overwritten() {
    let desk = Desk::new();
    // Held up while another run is done with the same folder.
    let slow = long_run(&desk, "--out r --set run.duration=200s", "");
    signal(&slow, "STOP");
    success(&mut desk.spunlaid("run brief.toml --out r --seed 8"));
    let output = end(slow, "CONT");
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("error: r: holds results already"), "{said}");
    assert_eq!(desk.summary("r")["case"]["run"]["seed"], 8);
    assert_eq!(desk.entries(""), names(&["brief.toml", "r"]));
}

#[test]
fn a_disk_that_takes_no_more_leaves_nothing() {
    let desk = Desk::new();
    let record = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/records/probe.csv");
    let analyse = format!("analyse {record} --out");
    // Files may grow to so many blocks of 512 or 1024 bytes.
    for (blocks, command) in [
        (1, "run brief.toml --out"),
        (16, "run brief.toml --out"),
        (100, "run brief.toml --out"),
        (20, &analyse),
    ] {
        let shell = format!("ulimit -f {blocks}; exec {} {command} a/b", env!("CARGO_BIN_EXE_spunlaid"));
        let output =
            Command::new("sh").args(["-c", &shell]).current_dir(desk.folder.path()).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.starts_with("error: a/b/") && said.contains(": cannot be written: "), "{said}");
        assert!(said.contains("File too large") && said.ends_with("on another disk (--out)\n"), "{said}");
        assert_eq!(desk.entries(""), names(&["brief.toml"]));
    }
}

#[test]
fn a_reader_that_has_enough_is_no_error() {
    let desk = Desk::new();
    for arguments in
        ["check brief.toml", "run brief.toml --json --out results/brief", "completions bash", "run --help"]
    {
        let mut child = Command::new(env!("CARGO_BIN_EXE_spunlaid"))
            .current_dir(desk.folder.path())
            .args(arguments.split_whitespace())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!((output.status.code(), said.as_str()), (Some(0), ""), "{arguments}");
    }
    assert_eq!(desk.entries("results/brief"), names(&ENTRIES));
}

#[cfg(target_os = "linux")]
#[test]
fn a_standard_output_that_is_full_is_reported() {
    let desk = Desk::new();
    for arguments in ["check brief.toml", "run brief.toml --json"] {
        let output = Command::new(env!("CARGO_BIN_EXE_spunlaid"))
            .current_dir(desk.folder.path())
            .args(arguments.split_whitespace())
            .stdout(File::create("/dev/full").unwrap())
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2));
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.starts_with("error: standard output: cannot be written: "), "{said}");
    }
}

#[test]
fn a_fed_fibre_that_is_killed_or_cannot_be_written_leaves_nothing() {
    let desk = Desk::with_case(FED);
    let long = ["run.duration=600 s", "run.output_interval=0.1 s", "air.cutoff_frequency=10 Hz"];
    let mut command = desk.with("run brief.toml --out r", &long);
    assert_eq!(end(flying(&desk, &mut command, ""), "KILL").status.code(), None);
    assert!(!desk.path("r").exists());
    assert_eq!(hidden(&desk.path("")).len(), 1);
    // What it had laid lies in files that the next run clears up.
    let output = end(flying(&desk, &mut command, ""), "INT");
    assert_eq!(output.status.code(), Some(130));
    success(&mut desk.spunlaid("run brief.toml --out r"));
    assert_eq!(desk.entries(""), names(&["brief.toml", "r"]));
    assert_eq!(desk.entries("r"), entries_of_fed());

    // Files may grow to so many blocks of 512 or 1024 bytes: the points of one replicate do not fit.
    let finer = "--set fibre.element_length=1mm --set run.duration=100ms --set run.output_interval=10ms";
    let program = env!("CARGO_BIN_EXE_spunlaid");
    let shell = format!("ulimit -f 100; exec {program} run brief.toml {finer} --out a/b");
    let output = Command::new("sh").args(["-c", &shell]).current_dir(desk.folder.path()).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("error: a/b/") && said.contains(".parquet: cannot be written: "), "{said}");
    assert_eq!(desk.entries(""), names(&["brief.toml", "r"]));
}

const WEB: &str = "[fibre]\ndiameter = '18 µm'\ndensity = '910 kg/m³'\n[laydown]\nsigma_md = '18 mm'\n\
    sigma_cd = '18 mm'\nnoise = '12 m^-0.5'\n[line]\nfeed_speed = '50 m/s'\nbelt_speed = '5 m/s'\n\
    filaments_per_metre = 100\n[web]\nwidth = '0.5 m'\nlength = '0.5 m'\ncell = '1 mm'\n";

#[test]
fn a_web_that_is_killed_or_cannot_be_written_leaves_nothing() {
    let desk = Desk::new();
    fs::write(desk.path("web.toml"), WEB).unwrap();
    let there = names(&["brief.toml", "web.toml"]);
    // It would take far longer than the test.
    let laying = || {
        let mut command = desk.spunlaid("web web.toml --out w --set line.filaments_per_metre=1000000");
        let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        while !hidden(&desk.path("")).iter().any(|name| desk.path(name).join("new").exists()) {
            std::thread::sleep(Duration::from_millis(5));
        }
        std::thread::sleep(Duration::from_millis(100));
        child
    };
    let output = end(laying(), "INT");
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(130), "{said}");
    assert!(said.ends_with("nothing was written. Repeat the command to start again\n"), "{said}");
    assert_eq!(desk.entries(""), there);
    assert_eq!(end(laying(), "KILL").status.code(), None);
    assert!(!desk.path("w").exists());
    assert_eq!(hidden(&desk.path("")).len(), 1);
    success(&mut desk.spunlaid("web web.toml --out w"));
    assert_eq!(desk.entries(""), names(&["brief.toml", "w", "web.toml"]));

    // Files may grow to so many blocks of 512 or 1024 bytes.
    let program = env!("CARGO_BIN_EXE_spunlaid");
    let shell = format!("ulimit -f 100; exec {program} web web.toml --out a/b");
    let output = Command::new("sh").args(["-c", &shell]).current_dir(desk.folder.path()).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("error: a/b/") && said.contains(": cannot be written: "), "{said}");
    assert!(!desk.path("a").exists());
}

/// A few filaments in shared turbulence, whose flight would take hours.
#[test]
fn a_web_in_one_air_that_is_interrupted_leaves_nothing() {
    let desk = Desk::with_case(FED);
    let web = "[laydown]\ncase = 'brief.toml'\n[line]\nfilaments_per_metre = 2000\n[web]\nwidth = '0.6 m'\n\
        length = '0.5 m'\n";
    fs::write(desk.path("web.toml"), web).unwrap();
    let mut command = desk.with("web web.toml --out w", &["run.time_step=0.1 us"]);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    while !hidden(&desk.path("")).iter().any(|name| desk.path(name).join("new").exists()) {
        std::thread::sleep(Duration::from_millis(5));
    }
    // Until it flies.
    std::thread::sleep(Duration::from_millis(300));
    let output = end(child, "INT");
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(130), "{said}");
    assert!(said.ends_with("nothing was written. Repeat the command to start again\n"), "{said}");
    assert_eq!(desk.entries(""), names(&["brief.toml", "web.toml"]));
}

/// The assumed depth is tried in one flight, and each of the lengths of the eddies in one of its own.
#[test]
#[ignore = "slow: a web with its assumed values, interrupted and again"]
fn identical_assumed_values_that_were_interrupted_and_went_on() {
    let desk = Desk::with_case(FED);
    let web = "[laydown]\ncase = 'brief.toml'\n[line]\nfilaments_per_metre = 4000\nslot_gap = '10 mm'\n[web]\n\
        width = '0.2 m'\nlength = '0.1 m'\npatches = ['5 mm', '10 mm']\n\
        assumed = 'line.slot_gap, air.length_scale'\n";
    fs::write(desk.path("web.toml"), web).unwrap();
    success(&mut desk.spunlaid("web web.toml --out whole --no-advice --quiet"));
    let whole = desk.summary("whole");
    let mut command = desk.spunlaid("web web.toml --out w --no-advice");
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // Longer than its first line when a flight is kept.
    while fs::metadata(desk.path(".w.kept")).map_or(0, |about| about.len()) < 60 {
        std::thread::sleep(Duration::from_millis(5));
    }
    let output = end(child, "INT");
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(130), "{said}");
    assert!(
        said.contains("interrupted; the web is complete in w") && desk.path("w/report.html").exists(),
        "{said}"
    );
    assert!(desk.summary("w").get("assumed_values").is_none());
    let said = success(&mut desk.spunlaid("web web.toml --out w --no-advice"));
    assert!(said.contains("going on: 1 simulation of earlier commands is kept"), "{said}");
    let numbers = whole["assumed_values"].to_string().replace(" --out whole-", " --out w-");
    assert_eq!(desk.summary("w")["assumed_values"].to_string(), numbers);
    assert!(whole["assumed_values"]["values"].as_array().unwrap().len() >= 3, "{whole}");
    assert!(!desk.path(".w.kept").exists() && desk.path("w/kept").exists());
}

/// One that is killed after its first coarse sheet, and one that asks for a smaller error in the same folder, have the
/// numbers of one that was left alone; and nothing is simulated twice but the fine sheet.
#[test]
#[ignore = "slow: a web of two levels that is killed several times"]
fn identical_a_web_goes_on_after_a_kill_and_with_a_smaller_error() {
    let desk = Desk::with_case(FED);
    let web = |error: &str| {
        let text = format!(
            "[laydown]\ncase = 'brief.toml'\n[line]\nfilaments_per_metre = 4000\nslot_gap = '10 mm'\n[web]\n\
            width = '0.2 m'\nlength = '0.1 m'\npatches = ['5 mm', '10 mm']\nerror = '{error}'\n"
        );
        fs::write(desk.path("web.toml"), text).unwrap();
    };
    let run = |folder: &str| success(&mut desk.spunlaid(&format!("web web.toml --out {folder} --no-advice")));
    web("6 %");
    let alone = run("alone");
    assert!(!alone.contains("going on") && desk.path("alone/kept").exists(), "{alone}");
    let whole = desk.summary("alone");
    assert!(whole.to_string().contains("are counted on the map, which has the clouds of 0.02 m²"), "{whole}");
    let numbers = |folder: &str| desk.summary(folder)["web"].to_string();

    let mut command = desk.spunlaid("web web.toml --out killed --no-advice --threads 1");
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    while fs::metadata(desk.path(".killed.kept")).map_or(0, |about| about.len()) < 60 {
        std::thread::sleep(Duration::from_millis(5));
    }
    end(child, "KILL");
    let said = run("killed");
    assert!(said.contains(" of earlier commands ") && !desk.path(".killed.kept").exists(), "{said}");
    assert_eq!(numbers("killed"), numbers("alone"));

    web("30 %");
    run("smaller");
    let before = desk.read("smaller/kept");
    web("6 %");
    let said = run("smaller");
    assert!(said.contains(" of earlier commands are kept"), "{said}");
    assert_eq!(numbers("smaller"), numbers("alone"));
    // The log only grows: what was kept is not written again.
    let after = desk.read("smaller/kept");
    assert!(after.starts_with(&before) && after.len() > before.len(), "{}", after.len());
    assert_eq!(after.len(), desk.read("alone/kept").len());
}
