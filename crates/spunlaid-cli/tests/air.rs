//! Cases whose air comes from files: the files stay with the results, which run again wherever they are.
#![allow(clippy::unwrap_used)]

mod desk;

use desk::{Desk, ENTRIES, assert_identical, names, refusal, success};
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
    let said = refusal(&mut sweep(), 1);
    assert!(said.contains("another study"), "{said}");
}

#[test]
fn a_fibre_out_of_its_field_is_told_of() {
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
