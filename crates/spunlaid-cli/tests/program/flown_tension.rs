//! The tension at the end of a spinline that flights find: with the threads that are asked for, until Ctrl-C.
#![cfg(target_os = "linux")]

use crate::desk::{Desk, success};
use std::fs;
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

const STUDY: &str = "case = 'line.toml'\ndesign = 'grid'\nreplicates = 2\n[vary]\n\
    'spinline.throughput' = ['0.45 g/min', '0.5 g/min']\n";

/// The filament of the whole line, whose tension is that of flights, and a study of it.
///
/// * `run` – the lines of its table `[run]`
fn desk(element_length: &str, run: &str) -> Desk {
    let cases = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases");
    let text = fs::read_to_string(format!("{cases}/whole_line_fibre.toml")).unwrap();
    let (text, _) = text.split_once("[run]").unwrap();
    let text = text
        .replace("\"tables/", &format!("\"{cases}/tables/"))
        .replace("die_temperature", "end_tension = 'simulated'\ndie_temperature")
        .replace("4 mm", element_length);
    let desk = Desk::new();
    fs::write(desk.path("line.toml"), format!("{text}[run]\n{run}")).unwrap();
    fs::write(desk.path("study.toml"), STUDY).unwrap();
    desk
}

/// One whose flights take an hour.
fn slow() -> Desk {
    desk("1 mm", "duration = '1 s'\ntime_step = '0.2 µs'\nreplicates = 8\n")
}

/// Starts a command and waits until it hears Ctrl-C: its flights begin then.
fn flying(mut command: Command) -> Child {
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let hears = |caught: &str| u64::from_str_radix(caught, 16).unwrap() & 0b10 != 0;
    while !hears(&status(&child, "SigCgt:")) {
        sleep(Duration::from_millis(5));
    }
    child
}

/// What the system reports of a process.
fn status(child: &Child, name: &str) -> String {
    let all = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap();
    all.lines().find_map(|line| line.strip_prefix(name)).unwrap().trim().to_owned()
}

fn interrupt(child: Child) -> Output {
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    child.wait_with_output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn interrupted_while_it_flies_for_the_tension_nothing_is_left() {
    let desk = slow();
    for arguments in
        ["run line.toml --threads 1 --out r", "spin line.toml --out r", "sweep study.toml --out r"]
    {
        let output = interrupt(flying(desk.spunlaid(arguments)));
        assert_eq!(output.status.code(), Some(130), "{}", said(&output));
        assert!(said(&output).contains("error: interrupted; nothing was written"), "{}", said(&output));
        assert!(!desk.path("r").exists());
    }
}

#[test]
#[ignore = "slow: tensions from flights, twice"]
fn tensions_fly_in_as_many_threads_as_are_asked_for() {
    let desk = slow();
    // For each that flies one waits; one waits for Ctrl-C, and one reports how far it is.
    for (threads, there) in [("1", 4), ("2", 6)] {
        let child = flying(desk.spunlaid(&format!("sweep study.toml --threads {threads} --out r")));
        let count = || status(&child, "Threads:").parse::<u32>().unwrap();
        while count() < there {
            sleep(Duration::from_millis(5));
        }
        for _ in 0..40 {
            assert_eq!(count(), there);
            sleep(Duration::from_millis(5));
        }
        assert_eq!(interrupt(child).status.code(), Some(130));
    }
}

#[test]
fn a_check_flies_nothing_and_says_so() {
    let desk = desk("10 mm", "duration = '0.2 s'\n");
    let output = desk.spunlaid("check line.toml").output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let note = "spinline.end_tension is found when the case is simulated; until then, all that follows \
        from it belongs to a tension of 0 N";
    assert!(said(&output).contains(note), "{}", said(&output));
    let shown = String::from_utf8(output.stdout).unwrap();
    assert!(shown.contains("end_tension = \"simulated\""), "{shown}");
    // What it shows is such a case.
    fs::write(desk.path("shown.toml"), &shown).unwrap();
    let again = desk.spunlaid("check shown.toml").output().unwrap();
    assert!(again.status.success(), "{}", said(&again));
    success(&mut desk.spunlaid("check study.toml"));
    let point = success(&mut desk.spunlaid("sweep study.toml --print-point 1"));
    assert!(point.contains("end_tension = \"simulated\""), "{point}");
}
