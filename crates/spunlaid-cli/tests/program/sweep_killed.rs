//! A study that is killed at any moment continues, and ends with the same bits.

use crate::common::{StudyFolder, assert_same, case, results, said};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

/// Pseudo-random moments.
struct Moments(u64);

impl Moments {
    /// A time of at most this many milliseconds.
    fn next(&mut self, most: u64) -> Duration {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        Duration::from_micros((self.0 >> 33) % (most * 1000))
    }
}

/// Number of records in a journal.
fn records(place: &StudyFolder, out: &str) -> u64 {
    let record = 8 * (6 + spunlaid_simulation::MEASURES.len() as u64);
    fs::metadata(place.path(out).join("journal")).map_or(0, |about| about.len() / record)
}

/// Kills sweeps at random moments until one completes or the limit is reached; returns the number of kills. Where a
/// busy machine gets nothing done before a kill, the next one may come later.
fn killed(place: &StudyFolder, out: &str, most_kills: u32, mut most_ms: u64) -> u32 {
    let mut moments = Moments(42);
    let mut kept = 0;
    for kills in 0..most_kills {
        let mut child = place.under_way(out, &["--threads", "2"]);
        sleep(moments.next(most_ms));
        child.kill().unwrap();
        if child.wait().unwrap().success() {
            return kills;
        }
        let now = records(place, out);
        assert!(now >= kept, "{kept} records were kept and {now} are left");
        if now == kept {
            most_ms += most_ms / 4;
        }
        kept = now;
    }
    most_kills
}

const STUDY: &str = "case = 'case.toml'
design = 'grid'
common_phases = false
[replicates]
at_least = 6
at_most = 12
until = { amplitude_y = '8 %' }
[vary]
'air.velocity' = { from = '5 m/s', to = '20 m/s', steps = 6 }
'air.length_scale' = ['50 mm', '100 mm', '200 mm']
'fibre.diameter' = ['30 µm', '60 µm']
";

#[test]
fn identical_after_many_kills() {
    let place = StudyFolder::new(&case(0.5), STUDY);
    place.swept("whole", &["--threads", "2"]);
    let expected = results(&place.path("whole"));
    let kills = killed(&place, "killed", 25, 60);
    assert!(kills >= 10, "only {kills} kills before the end");
    let output = said(&place.swept("killed", &["--threads", "1"]));
    assert!(output.contains("continuing: "), "{output}");
    assert_same(&expected, &results(&place.path("killed")));
    // The journal holds every fibre once, so no kept fibre was simulated again.
    assert_eq!(records(&place, "killed"), records(&place, "whole"));
}

#[test]
fn identical_when_killed_while_files_are_begun_and_written() {
    let study = STUDY.replace("steps = 6", "steps = 2").replace("'100 mm', ", "");
    let place = StudyFolder::new(&case(0.002), &study);
    place.swept("whole", &[]);
    let mut moments = Moments(7);
    for round in 0..60 {
        let mut child = place.under_way("killed", &[]);
        sleep(moments.next(if round % 2 == 0 { 25 } else { 300 }));
        child.kill().unwrap();
        child.wait().unwrap();
    }
    place.swept("killed", &[]);
    assert_same(&results(&place.path("whole")), &results(&place.path("killed")));
}

#[test]
fn earlier_results_stay_whole_until_those_of_a_changed_study_are() {
    let study = STUDY.replace("steps = 6", "steps = 2").replace("'100 mm', ", "");
    let place = StudyFolder::new(&case(0.02), &study);
    place.swept("out", &["--threads", "2"]);
    let earlier = results(&place.path("out"));
    let changed = study.replace("'20 m/s'", "'25 m/s'");
    fs::write(place.path("study.toml"), &changed).unwrap();
    place.swept("whole", &["--threads", "2"]);
    let new = results(&place.path("whole"));
    let mut moments = Moments(5);
    let mut kills = 0;
    let mut kept = 0;
    let now = || {
        let all = results(&place.path("out")).into_iter();
        // What is being made is in hidden folders.
        all.filter(|(name, _)| !name.to_string_lossy().starts_with(".spunlaid-")).collect::<BTreeMap<_, _>>()
    };
    loop {
        let mut child = place.under_way("out", &["--threads", "2"]);
        // Longer each time, so that a slow machine too comes to the end.
        sleep(moments.next(60 + 10 * kills));
        child.kill().unwrap();
        if child.wait().unwrap().success() {
            break;
        }
        kills += 1;
        if now().contains_key(Path::new("report.html")) {
            let now = now();
            let is_new = !place.path("out").join(".spunlaid-replacement").exists();
            assert_same(&now, if is_new && now != earlier { &new } else { &earlier });
        }
        let records = records(&place, "out/.spunlaid-replacement");
        assert!(
            records >= kept || !place.path("out").join(".spunlaid-replacement").exists(),
            "{kept}, {records}"
        );
        kept = records;
        // A third study does not take what has been done for the second.
        if kills == 3 && kept > 0 {
            fs::write(place.path("study.toml"), study.replace("'20 m/s'", "'30 m/s'")).unwrap();
            // The first try removes the files that the killed process had begun; the second one changes nothing.
            place.sweep("out", &[]).output().unwrap();
            let refusal = place.refused("out", &[]);
            assert!(refusal.contains(".spunlaid-replacement: holds results of another study"), "{refusal}");
            fs::write(place.path("study.toml"), &changed).unwrap();
        }
    }
    assert!(kills >= 3, "only {kills} kills before the end");
    place.swept("out", &[]);
    assert_same(&results(&place.path("out")), &new);
}

#[test]
fn identical_when_killed_while_complete_results_replace_earlier_ones() {
    let study = STUDY.replace("steps = 6", "steps = 2").replace("'100 mm', ", "");
    let changed = study.replace("'20 m/s'", "'25 m/s'");
    let place = StudyFolder::new(&case(0.002), &study);
    let write = |study: &str| fs::write(place.path("study.toml"), study).unwrap();
    let [out, hidden] = ["out", "out/.spunlaid-replacement"].map(|folder| place.path(folder));
    let entries = |folder: &Path| -> Vec<_> {
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    };
    // Before the journal is moved, after it, and when all but a few are moved.
    for moved in
        [&[][..], &["journal"], &["journal", "origin.toml", "study.toml", "case.toml", "results.csv"]]
    {
        write(&study);
        place.swept("out", &["--force"]);
        write(&changed);
        place.swept("whole", &["--force"]);
        for name in entries(&out).iter().filter(|name| !["journal", "origin.toml"].contains(&name.as_str())) {
            let path = out.join(name);
            if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) }.unwrap();
        }
        fs::create_dir(&hidden).unwrap();
        for name in entries(&place.path("whole")).iter().filter(|name| *name != "figures") {
            let to = if moved.contains(&name.as_str()) { &out } else { &hidden };
            fs::copy(place.path("whole").join(name), to.join(name)).unwrap();
        }
        place.swept("out", &[]);
        assert_same(&results(&place.path("whole")), &results(&out));
    }
}

#[test]
fn rejects_a_second_process_and_forgets_the_lock_of_a_dead_one() {
    let place = StudyFolder::new(&case(20.0), STUDY);
    let mut child = place.under_way("out", &[]);
    while !place.path("out").join("journal").exists() {
        sleep(Duration::from_millis(5));
    }
    // The file exists a moment before it is locked.
    sleep(Duration::from_millis(100));
    for more in [&[][..], &["--force"]] {
        let output = place.sweep("out", more).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{}", said(&output));
        assert!(said(&output).contains("another spunlaid process is using this folder"), "{}", said(&output));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let mut child = place.under_way("out", &[]);
    sleep(Duration::from_millis(300));
    assert_eq!(child.try_wait().unwrap(), None, "the lock of the dead process is still held");
    child.kill().unwrap();
    child.wait().unwrap();
}

#[cfg(unix)]
#[test]
fn interrupted_it_says_how_to_go_on() {
    let place = StudyFolder::new(&case(2.0), STUDY);
    let child = place
        .sweep("out", &[])
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    // Wait until a flight is finished.
    while records(&place, "out") < 2 {
        sleep(Duration::from_millis(5));
    }
    let interrupted =
        std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(interrupted.success());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", said(&output));
    assert!(
        said(&output).contains("fibres are done and kept. Repeat the command to continue"),
        "{}",
        said(&output)
    );
    assert!(!place.path("out").join("results.csv").exists());
}
