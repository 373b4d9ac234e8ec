//! The memory of a study does not grow with its points.
#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::{Place, case};
use std::fs;

/// Largest memory of a sweep [KiB].
fn peak(points: u64, replicates: u64) -> u64 {
    // As short as can be: three elements, ten steps.
    let case = case(2e-4).replace("length_scale = '50 mm'", "length_scale = '350 mm'");
    let study = format!(
        "case = 'case.toml'\ndesign = 'latin-hypercube'\npoints = {points}\nreplicates = {replicates}\n[vary]\n\
         'air.velocity' = {{ from = '5 m/s', to = '20 m/s' }}\n'fibre.diameter' = {{ from = '30 µm', to = '60 µm' }}\n"
    );
    let place = Place::new(&case, &study);
    let mut child = place.under_way("out", &["--threads", "2"]);
    let status = format!("/proc/{}/status", child.id());
    let mut peak = 0;
    let exit = loop {
        let status = fs::read_to_string(&status).unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let now = line.and_then(|line| line.trim().strip_suffix(" kB")?.parse().ok()).unwrap_or(0);
        peak = peak.max(now);
        if let Some(exit) = child.try_wait().unwrap() {
            break exit;
        }
        std::thread::sleep(std::time::Duration::from_millis(2));
    };
    assert!(exit.success());
    let rows = fs::read_to_string(place.path("out").join("results.csv")).unwrap().lines().count();
    assert_eq!(rows as u64, points + 1);
    peak
}

#[test]
fn memory_is_flat() {
    let (few, many, often) = (peak(1000, 2), peak(10_000, 2), peak(1000, 20));
    // A point is a case, its values and its results: less than 1.5 KiB; a fibre is an index of 4 bytes.
    assert!(many - few.min(many) < 9000 * 3 / 2, "{few} KiB for 1,000 points, {many} KiB for 10,000");
    assert!(often - few.min(often) < 4000, "{few} KiB for 2,000 fibres, {often} KiB for 20,000");
}
