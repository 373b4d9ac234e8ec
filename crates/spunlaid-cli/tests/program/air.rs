//! Cases whose air comes from files: the files stay with the results, which run again wherever they are.

use crate::desk;
use crate::desk::{Desk, ENTRIES, assert_identical, names, refusal, success};
use std::path::{Path, PathBuf};

const SHORT: [&str; 6] =
    ["--set", "run.duration=30 ms", "--set", "run.time_step=100 µs", "--replicates", "2"];

fn cases() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases")
}

fn entries_with_files() -> Vec<&'static str> {
    ENTRIES.into_iter().chain(["case_files"]).collect()
}

#[test]
fn identical_when_run_again_from_a_moved_results_folder() {
    let desk = Desk::new();
    for (name, file, figure) in [
        ("record", "probe.csv", "turbulence_spectrum.svg"),
        ("profile", "diffuser.csv", "air_along_fibre.svg"),
        ("measured_spectrum", "spectrum.csv", "turbulence_spectrum.svg"),
        ("openfoam_diffuser", "openfoam_diffuser.vtu", "air_slices.svg"),
    ] {
        let case = cases().join(format!("{name}.toml"));
        success(desk.spunlaid("run").arg(case).args(SHORT).args(["--out", name]));
        assert_eq!(desk.entries(name), names(&entries_with_files()), "{name}");
        assert!(desk.path(name).join("case_files").join(file).exists(), "{name}");
        assert!(desk.path(name).join("figures").join(figure).exists(), "{name}");
        let moved = format!("moved/{name}");
        std::fs::create_dir_all(desk.path("moved")).unwrap();
        std::fs::rename(desk.path(name), desk.path(&moved)).unwrap();
        let again = format!("{name}_again");
        success(desk.spunlaid("run").arg(desk.path(&moved).join("case.toml")).args(["--out", &again]));
        assert_identical(&desk, &moved, &again);
        // And over itself: the file is read before it is replaced.
        let case = desk.path(&again).join("case.toml");
        success(desk.spunlaid("run").arg(case).args(["--out", &again, "--force"]));
        assert_identical(&desk, &moved, &again);
    }
}

#[test]
fn a_sweep_through_a_field_keeps_it_and_goes_on_from_its_own_folder() {
    let desk = Desk::new();
    let case = std::fs::read_to_string(cases().join("openfoam_diffuser.toml")).unwrap();
    std::fs::create_dir_all(desk.path("fields")).unwrap();
    let field = "fields/openfoam_diffuser.vtu";
    std::fs::copy(cases().join(field), desk.path(field)).unwrap();
    std::fs::write(desk.path("case.toml"), case.replace("\"1 s\"", "\"20 ms\"")).unwrap();
    let study =
        "case = 'case.toml'\ndesign = 'grid'\nreplicates = 2\n[vary]\n'air.speed_factor' = [0.8, 1.25]\n";
    std::fs::write(desk.path("study.toml"), study).unwrap();
    success(desk.spunlaid("sweep").arg(desk.path("study.toml")).args(["--out", "out"]));
    let read = |name: &str| std::fs::read_to_string(desk.path(name)).unwrap();
    assert!(read("out/case.toml").contains("field = \"case_files/openfoam_diffuser.vtu\""));
    let results = read("out/results.csv");
    assert_eq!(results.lines().count(), 3);

    std::fs::remove_dir_all(desk.path("fields")).unwrap();
    let study = desk.path("out/study.toml");
    let said = success(desk.spunlaid("sweep").arg(&study).args(["--out", "out"]));
    assert!(said.contains("4 fibres"), "{said}");
    assert_eq!(read("out/results.csv"), results);
    success(desk.spunlaid("sweep").arg(&study).args(["--out", "again"]));
    assert_eq!(read("again/results.csv"), results);
    // Over itself, from the beginning: the copies it reads stay.
    success(desk.spunlaid("sweep").arg(&study).args(["--out", "out", "--force"]));
    assert_eq!(read("out/results.csv"), results);
}

/// A list of the parts of a field, and the parts in folders beside it. OpenFOAM lists walls too.
fn listed_field(desk: &Desk) {
    let parts = cases().join("../crates/spunlaid-field/tests/fixtures/lists");
    std::fs::create_dir_all(desk.path("air/blocks")).unwrap();
    for name in ["blocks.vtm", "blocks/blocks_0.vtu", "blocks/blocks_1.vtu"] {
        std::fs::copy(parts.join(name), desk.path("air").join(name)).unwrap();
    }
}

#[test]
fn the_parts_of_a_list_stay_with_the_results() {
    let desk = Desk::new();
    listed_field(&desk);
    let changes = ["air.velocity", "air.turbulence_intensity", "air.length_scale", "air.cutoff_frequency"];
    let case = desk::BRIEF.lines().filter(|line| !changes.iter().any(|key| line.starts_with(&key[4..])));
    let case = case.map(|line| if line == "[air]" { "[air]\nfield = \"air/blocks.vtm\"" } else { line });
    let case = case.collect::<Vec<_>>().join("\n").replace("0.2 m", "0.9 m");
    std::fs::write(desk.path("listed.toml"), case).unwrap();
    success(&mut desk.spunlaid("run listed.toml --out first"));
    let files = ["blocks.vtm", "blocks"];
    assert_eq!(desk.entries("first/case_files/blocks"), names(&files));
    // Walls are not needed.
    assert_eq!(desk.entries("first/case_files/blocks/blocks"), names(&["blocks_0.vtu", "blocks_1.vtu"]));
    std::fs::remove_dir_all(desk.path("air")).unwrap();
    std::fs::create_dir(desk.path("moved")).unwrap();
    std::fs::rename(desk.path("first"), desk.path("moved/first")).unwrap();
    // The notes of the summary name the case, so the tables are compared.
    let identical = || {
        for table in ["end_node.parquet", "energy.parquet"] {
            let content = |folder: &str| desk.read(&format!("{folder}/{table}"));
            assert!(content("moved/first") == content("again"), "{table}");
        }
    };
    success(&mut desk.spunlaid("run moved/first/case.toml --out again"));
    identical();
    // Over itself: the parts are read before they are replaced.
    success(&mut desk.spunlaid("run again/case.toml --out again --force"));
    identical();
    // A part that is gone or is another one is reported.
    std::fs::remove_file(desk.path("again/case_files/blocks/blocks/blocks_1.vtu")).unwrap();
    let said = refusal(&mut desk.spunlaid("run again/case.toml --out third"), 1);
    assert!(
        said.contains("blocks.vtm:6: names the part \"blocks/blocks_1.vtu\", which is not there"),
        "{said}"
    );
}

#[test]
fn a_study_with_another_part_is_another_study() {
    let desk = Desk::new();
    listed_field(&desk);
    let case = std::fs::read_to_string(cases().join("openfoam_diffuser.toml")).unwrap();
    let case = case.replace("fields/openfoam_diffuser.vtu", "air/blocks.vtm").replace("\"1 s\"", "\"20 ms\"");
    let case = case.lines().filter(|line| !line.starts_with("field_root")).collect::<Vec<_>>().join("\n");
    std::fs::write(desk.path("case.toml"), case).unwrap();
    let study =
        "case = 'case.toml'\ndesign = 'grid'\nreplicates = 2\n[vary]\n'air.speed_factor' = [0.8, 1.25]\n";
    std::fs::write(desk.path("study.toml"), study).unwrap();
    success(&mut desk.spunlaid("sweep study.toml --out out"));
    assert!(desk.path("out/case_files/blocks/blocks/blocks_1.vtu").exists());
    success(&mut desk.spunlaid("sweep out/study.toml --out again"));
    assert_eq!(desk.read("again/results.csv"), desk.read("out/results.csv"));
    // A byte that the field does not depend on.
    let part = desk.path("air/blocks/blocks_1.vtu");
    let text = std::fs::read(&part).unwrap();
    std::fs::write(&part, [text, b"\n".to_vec()].concat()).unwrap();
    // An unfinished study is not replaced.
    std::fs::remove_file(desk.path("out/report.html")).unwrap();
    let said = refusal(&mut desk.spunlaid("sweep study.toml --out out"), 1);
    assert!(said.contains("another study"), "{said}");
}

#[test]
fn a_study_of_another_field_is_another_study() {
    let desk = Desk::new();
    std::fs::copy(cases().join("tables/diffuser.csv"), desk.path("air.csv")).unwrap();
    let case = std::fs::read_to_string(cases().join("profile.toml")).unwrap();
    let case = case.replace("tables/diffuser.csv", "air.csv").replace("\"1 s\"", "\"20 ms\"");
    std::fs::write(desk.path("case.toml"), case).unwrap();
    let study = "case = 'case.toml'\ndesign = 'grid'\nreplicates = 2\n[vary]\n'fibre.diameter' = ['20 µm', '50 µm']\n";
    std::fs::write(desk.path("study.toml"), study).unwrap();
    let sweep = || {
        let mut command = desk.spunlaid("sweep");
        command.arg(desk.path("study.toml")).args(["--out", "out"]);
        command
    };
    success(&mut sweep());
    let table = std::fs::read_to_string(desk.path("air.csv")).unwrap();
    std::fs::write(desk.path("air.csv"), table.replace("10.2", "10.3")).unwrap();
    // An unfinished study is not replaced.
    std::fs::remove_file(desk.path("out/report.html")).unwrap();
    let said = refusal(&mut sweep(), 1);
    assert!(said.contains("another study"), "{said}");
}

#[test]
fn a_fibre_out_of_its_field_is_reported() {
    let desk = Desk::new();
    let case = cases().join("openfoam_diffuser.toml");
    let out = desk
        .spunlaid("run")
        .arg(case)
        .args(SHORT)
        .args(["--set", "air.field_root=[\"-0.2 m\", \"0.3 m\", \"0 m\"]", "--out", "out"])
        .output()
        .unwrap();
    assert!(out.status.success());
    let said = String::from_utf8_lossy(&out.stderr);
    assert!(
        said.contains("air.field_root") && said.contains("is outside of the box around the field"),
        "{said}"
    );
    assert!(said.contains("is known for 100 % of the time"), "{said}");
    let share = desk.summary("out")["fibre"]["share_outside_flow"]["mean"].as_f64().unwrap();
    assert_eq!(share, 1.0);
}
