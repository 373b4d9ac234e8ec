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
    // Without bitmaps, of which two that are drawn side by side take as much as thousands of points. The allocator
    // gives back at once what is free, so that the peak is what is in use.
    let mut sweep = place.sweep("out", &["--threads", "1", "--figures", "svg"]);
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
#[ignore = "slow: studies of many fibres"]
fn memory_is_flat() {
    let _alone = crate::alone();
    // A peak wanders by 1 MiB with what happens to be made side by side, and a look may miss the last moments of a
    // short run. So the largest peak of the small study counts, and the smallest of the large ones.
    let few = [(); 3].map(|()| peak(1000, 2));
    let largest = |quantity: fn(&Peak) -> u64| few.iter().map(quantity).max().unwrap_or(0);
    let stays_below = |bound: u64, points, replicates, quantity: fn(&Peak) -> u64| {
        let stays = (0..3).any(|_| quantity(&peak(points, replicates)) < bound);
        assert!(stays, "more than {bound} KiB for {points} points of {replicates} fibres");
    };
    // A point is a case, its values, its results and what of them is in figures: less than 1.5 KiB.
    stays_below(largest(|peak| peak.whole) + 9000 * 3 / 2, 10_000, 2, |peak| peak.whole);
    // A fibre is an index of 4 bytes. If its 272 bytes of results were kept, this would be 4,800 KiB.
    stays_below(largest(|peak| peak.flying) + 2000, 1000, 20, |peak| peak.flying);
}
