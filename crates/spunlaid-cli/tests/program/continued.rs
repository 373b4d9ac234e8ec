//! A finished run flown for longer, `run FOLDER --until TIME`: the first part has the same bits, the old results stay
//! until the new ones are complete, and what cannot be continued is refused.

use crate::desk::{Desk, assert_identical, entries_without_origin, refusal, success};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Row;
use std::fs::{self, File};

/// The rows of the free end's table by replicate.
fn end_node(desk: &Desk, folder: &str) -> Vec<Vec<Row>> {
    let file = File::open(desk.path(&format!("{folder}/end_node.parquet"))).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let rows: Vec<Row> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
    rows.chunk_by(|a, b| a.get_column_iter().next() == b.get_column_iter().next())
        .map(<[Row]>::to_vec)
        .collect()
}

fn assert_begins_like(desk: &Desk, longer: &str, shorter: &str) {
    let (longer, shorter) = (end_node(desk, longer), end_node(desk, shorter));
    assert_eq!(longer.len(), shorter.len());
    for (longer, shorter) in longer.iter().zip(&shorter) {
        assert!(longer.len() > shorter.len());
        assert_eq!(longer[..shorter.len()], shorter[..]);
    }
}

#[test]
fn identical_first_part_when_flown_for_longer() {
    let desk = Desk::new();
    // A flight of 1 s would have 256 harmonics by itself.
    for scheme in ["semi-implicit-euler", "leapfrog", "implicit-tension"] {
        let changes = [format!("run.scheme={scheme}"), "run.spin_up=2 ms".to_owned()];
        success(
            &mut desk
                .with(&format!("run brief.toml --out {scheme}"), &changes.each_ref().map(String::as_str)),
        );
        success(&mut desk.spunlaid(&format!("run {scheme} --until 1s --out longer --force")));
        assert_begins_like(&desk, "longer", scheme);
        let [before, after] = [scheme, "longer"].map(|folder| desk.summary(folder)["case"].clone());
        assert_eq!(after["air"], before["air"]);
        assert_eq!(after["run"]["duration_s"], 1.0);
        assert_eq!(after["run"]["time_step_s"], before["run"]["time_step_s"]);
        assert_eq!(after["run"]["spin_up_s"], before["run"]["spin_up_s"]);
        // The comparison can fail: left alone, the longer flight has other turbulence.
        success(&mut desk.with(
            "run brief.toml --out other --force",
            &[&changes[0], "run.spin_up=2 ms", "run.duration=1 s"],
        ));
        assert_ne!(end_node(&desk, "other")[0][..5], end_node(&desk, scheme)[0][..5]);
    }
}

#[test]
fn a_continued_run_replaces_its_results_and_can_be_continued_again() {
    let desk = Desk::new();
    success(&mut desk.spunlaid("run brief.toml --out first"));
    success(&mut desk.spunlaid("run first --until 30ms --out straight"));
    fs::write(desk.path("first/thesis.tex"), "mine").unwrap();
    success(&mut desk.spunlaid("run first --until 20ms"));
    let output = desk.spunlaid("run first --until 30ms").output().unwrap();
    assert!(output.status.success());
    let (said, aside) =
        (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    assert!(said.ends_with("open first/report.html\n"), "{said}");
    assert!(aside.contains("flying again from the start, to 30 ms in place of 20 ms"), "{aside}");
    assert_eq!(fs::read(desk.path("first/thesis.tex")).unwrap(), b"mine");
    fs::remove_file(desk.path("first/thesis.tex")).unwrap();
    // The case from which it began would make a shorter run, and so does not replace it.
    assert_eq!(desk.entries("first"), entries_without_origin());
    assert_identical(&desk, "first", "straight");
    let again = success(&mut desk.spunlaid("run first --until 40ms --json --quiet"));
    assert_eq!(again.as_bytes(), desk.read("first/summary.json"));
}

#[test]
fn files_of_the_case_stay_with_a_continued_run() {
    let desk = Desk::new();
    let profile = "distance_m,velocity_m_s\n0,12\n0.2,8\n";
    fs::write(desk.path("air.csv"), profile).unwrap();
    success(&mut desk.with("run brief.toml --out r", &["air.velocity=auto", "air.profile=air.csv"]));
    success(&mut desk.spunlaid("run r --until 20ms --out longer"));
    success(&mut desk.spunlaid("run r --until 20ms"));
    assert_eq!(desk.read("r/case_files/air.csv"), profile.as_bytes());
    assert_identical(&desk, "r", "longer");
}

#[test]
fn a_time_between_two_steps_is_rounded_and_told() {
    let desk = Desk::new();
    success(&mut desk.spunlaid("run brief.toml --out r"));
    let output = desk.spunlaid("run r --until 15.013ms --out longer").output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.contains(
            "--until run.duration = 15.01 ms is not a whole number of time steps: 15.02 ms is used"
        ),
        "{said}"
    );
    assert_eq!(desk.summary("longer")["case"]["run"]["time_step_s"], 20e-6);
    assert_begins_like(&desk, "longer", "r");
}

#[test]
fn rejects_what_cannot_be_continued() {
    let desk = Desk::new();
    success(&mut desk.spunlaid("run brief.toml --out r"));
    let before = desk.read("r/summary.json");
    fs::create_dir(desk.path("empty")).unwrap();
    let record: String = (0..4000)
        .map(|i| format!("{},{}\n", f64::from(i) * 1e-4, 10.0 + f64::from(i * 7919 % 97) / 97.0))
        .collect();
    fs::write(desk.path("wire.csv"), format!("time_s,u_m_s\n{record}")).unwrap();
    success(&mut desk.with("run brief.toml --out of_record", &["air.record=wire.csv"]));
    for (arguments, wanted) in [
        ("run r --until 5ms", "r: cannot be continued: it lasts for 10 ms already, and --until says 5 ms"),
        ("run r --until 10ms", "it lasts for 10 ms already"),
        ("run r --until 1e9s", "--until run.duration"),
        ("run r --until 20", "unit"),
        ("run r --until=-1s", "is not above zero"),
        ("run r --until 20ms --set air.velocity=5m/s", "cannot be used with"),
        ("run r --until 20ms --seed 8", "cannot be used with"),
        ("run r", "is a folder; name the case file in it (--until flies a finished run for longer)"),
        ("run brief.toml --until 20ms", "brief.toml: does not hold the results of a run: it is a file"),
        ("run nothing --until 20ms", "there is no such folder"),
        ("run empty --until 20ms", "empty: does not hold the results of a run: summary.json"),
        ("run of_record --until 20ms", "of_record: cannot be continued: its air follows a record"),
    ] {
        let said = refusal(&mut desk.spunlaid(arguments), 1);
        assert!(said.contains(wanted), "{arguments}: {said}");
    }
    assert_eq!(desk.read("r/summary.json"), before);
    fs::remove_file(desk.path("r/case.toml")).unwrap();
    assert!(
        refusal(&mut desk.spunlaid("run r --until 20ms"), 1).contains("r/case.toml: there is no such file")
    );
}
