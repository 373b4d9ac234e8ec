//! The memory of a study does not grow with its points.
#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::{Place, case};
use std::fs;
use std::process::Stdio;

/// Largest memory of a sweep [KiB].
struct Peak {
    /// While the fibres fly.
    flying: u64,
    /// From the start to the end, the drawing of the figures included.
    whole: u64,
}

fn peak(points: u64, replicates: u64) -> Peak {
    // As short as can be: three elements, ten steps.
    let case = case(2e-4).replace("length_scale = '50 mm'", "length_scale = '350 mm'");
    let study = format!(
        "case = 'case.toml'\ndesign = 'latin-hypercube'\npoints = {points}\nreplicates = {replicates}\n[vary]\n\
         'air.velocity' = {{ from = '5 m/s', to = '20 m/s' }}\n'fibre.diameter' = {{ from = '30 µm', to = '60 µm' }}\n"
    );
    let place = Place::new(&case, &study);
    // The allocator gives back at once what is free, so that the peak is what is in use.
    let mut sweep = place.sweep("out", &["--threads", "1"]);
    sweep.env("MALLOC_ARENA_MAX", "1").env("MALLOC_MMAP_THRESHOLD_", "65536");
    let mut child = sweep.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let out = place.path("out");
    let status = format!("/proc/{}/status", child.id());
    let (mut peak, mut landed) = (Peak { flying: 0, whole: 0 }, false);
    let exit = loop {
        let status = fs::read_to_string(&status).unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let now = line.and_then(|line| line.trim().strip_suffix(" kB")?.parse().ok()).unwrap_or(0);
        peak.whole = peak.whole.max(now);
        // Looked at after the memory: the folder of the results is begun when the last fibre is down.
        let files = fs::read_dir(&out).into_iter().flatten().map(|file| file.unwrap().file_name());
        let files: Vec<_> = files.map(|name| name.into_string().unwrap()).collect();
        let has = |end| files.iter().any(|name| name.ends_with(end));
        landed |= has("journal") && has(".partial");
        if !landed {
            peak.flying = peak.whole;
        }
        if let Some(exit) = child.try_wait().unwrap() {
            break exit;
        }
        std::thread::sleep(std::time::Duration::from_millis(2));
    };
    assert!(exit.success() && peak.flying > 0);
    let rows = fs::read_to_string(out.join("results.csv")).unwrap().lines().count();
    assert_eq!(rows as u64, points + 1);
    peak
}

#[test]
fn memory_is_flat() {
    let (few, many, often) = (peak(1000, 2), peak(10_000, 2), peak(1000, 20));
    // A look may miss the last moments of a run so short, so the largest of three counts.
    let again = [peak(1000, 2), peak(1000, 2)];
    let few = again
        .into_iter()
        .fold(few, |a, b| Peak { flying: a.flying.max(b.flying), whole: a.whole.max(b.whole) });
    // A point is a case, its values and its results: less than 1.5 KiB.
    let points = many.whole - few.whole.min(many.whole);
    assert!(points < 9000 * 3 / 2, "{} KiB for 1,000 points, {} KiB for 10,000", few.whole, many.whole);
    // A fibre is an index of 4 bytes. If its 272 bytes of results were kept, this would be 4,800 KiB.
    let fibres = often.flying - few.flying.min(often.flying);
    assert!(fibres < 2000, "{} KiB for 2,000 fibres in flight, {} KiB for 20,000", few.flying, often.flying);
}
