//! `check` reports the memory that a run takes.

use crate::desk::{Desk, success};
use std::fs;
use std::process::{Command, Stdio};
use std::time::Duration;

/// Largest resident memory of a command so far [bytes], as the system keeps it; read until the command ends.
fn peak(command: &mut Command) -> f64 {
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let status = format!("/proc/{}/status", child.id());
    let mut peak = 0.0_f64;
    while child.try_wait().unwrap().is_none() {
        let text = fs::read_to_string(&status).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kilobytes = line.and_then(|line| line.trim().strip_suffix(" kB")?.trim().parse::<f64>().ok());
        peak = peak.max(1024.0 * kilobytes.unwrap_or(0.0));
        std::thread::sleep(Duration::from_millis(2));
    }
    assert!(child.wait().unwrap().success() && peak > 0.0);
    peak
}

#[test]
fn check_reports_the_memory_of_a_run() {
    let _alone = crate::alone();
    let desk = Desk::new();
    let field = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/openfoam_diffuser.toml");
    for (name, case, changes) in [
        // Little but the program itself, many recorded instants, many replicates, a field and many shapes.
        ("little", "brief.toml", &["run.duration=0.1 s"][..]),
        ("instants", "brief.toml", &["run.duration=1 s", "run.output_interval=20 us", "run.replicates=16"]),
        ("replicates", "brief.toml", &["run.duration=0.3 s", "run.replicates=800"]),
        ("field", field, &["run.replicates=8"]),
    ] {
        let estimated = success(&mut desk.with(&format!("check {case}"), changes));
        let estimated =
            estimated.split(" MiB of memory").next().and_then(|before| before.rsplit(' ').next()).unwrap();
        let estimated = estimated.parse::<f64>().unwrap() * f64::from(1 << 20);
        let taken = peak(&mut desk.with(&format!("run {case} --out {name}"), changes));
        println!("{name}: {:.0} MB estimated, {:.0} MB taken", estimated / 1e6, taken / 1e6);
        let share = estimated / taken;
        assert!((0.67..1.5).contains(&share), "{name}: {estimated:e} bytes estimated, {taken:e} taken");
    }
}

/// Tables and shapes go to files while fibres fly, and what observers keep of the instants is bounded.
#[test]
#[ignore = "slow: runs of many instants"]
fn memory_of_a_run_does_not_grow_with_its_duration_or_its_recorded_instants() {
    let _alone = crate::alone();
    let desk = Desk::new();
    let seldom = ["run.output_interval=50 ms", "run.replicates=1"];
    let often = ["run.duration=2.1 s", "run.replicates=16"];
    for (name, figures, changes, [few, many]) in [
        // The turbulence is made window by window, and a window lasts for some ten seconds.
        ("duration", "svg,png", &seldom[..], ["run.duration=20 s", "run.duration=200 s"]),
        // More instants than are kept whole, and three times as many. Without bitmaps: as many of them are in memory
        // as happen to be drawn side by side.
        ("instants", "svg", &often[..], ["run.output_interval=60 us", "run.output_interval=20 us"]),
    ] {
        let once = |change: &str| {
            let mut run = desk.with(
                &format!("run brief.toml --threads 1 --figures {figures} --force --out {name}"),
                &[changes, &[change]].concat(),
            );
            // The allocator gives back at once what is free, so that the peak is what is in use.
            peak(run.env("MALLOC_ARENA_MAX", "1").env("MALLOC_MMAP_THRESHOLD_", "65536"))
        };
        // It wanders by some MB with the pictures that happen to be drawn side by side: the smaller of two counts, but
        // the long run is repeated only if it needs to be.
        let most = once(few).min(once(few)) + 8e6;
        let taken = once(many);
        println!("{name}: {:.0} MB for {many}, at most {:.0} MB", taken / 1e6, most / 1e6);
        assert!(taken < most || once(many) < most, "{name}: {taken} bytes for {many}, at most {most}");
    }
}
