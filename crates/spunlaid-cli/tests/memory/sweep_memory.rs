//! The memory of a study does not grow with its points.

use crate::common::{StudyFolder, case};
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
    let place = StudyFolder::new(&case, &study);
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
    let _alone = crate::alone();
    let three = |points, replicates| [(); 3].map(|()| peak(points, replicates));
    let (few, many, often) = (three(1000, 2), three(10_000, 2), three(1000, 20));
    // A peak wanders by 3 MiB with the pictures that happen to be drawn side by side, and a look may miss the last
    // moments of a short run. So the largest peak of the small study counts, and the smallest of the large ones.
    let largest = |quantity: fn(&Peak) -> u64| few.iter().map(quantity).max().unwrap_or(0);
    let smallest = |peaks: &[Peak], quantity: fn(&Peak) -> u64| peaks.iter().map(quantity).min().unwrap_or(0);
    // A point is a case, its values and its results: less than 1.5 KiB.
    let (before, after) = (largest(|peak| peak.whole), smallest(&many, |peak| peak.whole));
    assert!(after < before + 9000 * 3 / 2, "{before} KiB for 1,000 points, {after} KiB for 10,000");
    // A fibre is an index of 4 bytes. If its 272 bytes of results were kept, this would be 4,800 KiB.
    let (before, after) = (largest(|peak| peak.flying), smallest(&often, |peak| peak.flying));
    assert!(after < before + 2000, "{before} KiB for 2,000 fibres in flight, {after} KiB for 20,000");
}
