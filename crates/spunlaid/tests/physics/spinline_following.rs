//! A steady state that is followed from a line nearby is the one that a search finds.

use spunlaid_fibre::{Failure, Law, Solution, Spinline};
use spunlaid_input::{SpinFile, read_spinline};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The lines of `tests/spinline_cases` that have a steady state, by name.
fn lines() -> Vec<(String, SpinFile)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/spinline_cases");
    let mut files: Vec<PathBuf> = folder.read_dir().unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    files.sort();
    let name = |path: &Path| path.file_stem().unwrap().to_string_lossy().into_owned();
    files.iter().filter_map(|path| Some((name(path), read_spinline(path, &[]).ok()?))).collect()
}

#[test]
fn identical_states_followed_and_sought() {
    let mut compared = 0;
    let mut laws = BTreeSet::new();
    let mut polymers = BTreeSet::new();
    let mut crystallise = 0;
    for (name, file) in lines() {
        let (line, friction) = (&file.spec.spinline, file.spec.drag.along);
        let Ok(base) = line.solve(friction) else { continue };
        let hotter = Spinline { die_temperature: line.die_temperature + 2.0, ..line.clone() };
        let slower = Spinline { throughput: line.throughput * 0.98, ..line.clone() };
        for (change, line) in [("2 K hotter", hotter), ("2 % slower", slower)] {
            let sought = line.solve(friction);
            let followed = line.solve_near(friction, &base);
            compare(&format!("{name}, {change}"), &base, &followed, &sought);
            compared += 1;
        }
        laws.insert(line.law.name());
        polymers.insert(format!("{:?}", line.polymer));
        crystallise += u32::from(line.crystallisation);
    }
    assert!(compared >= 90 && crystallise >= 9, "{compared} compared, {crystallise} crystallise");
    assert!(laws.len() == Law::ALL.len() && polymers.len() >= 4, "{laws:?}, {polymers:?}");
}

/// The tolerance of a step is 1e-8, and its effect on the speed a hundred times that at most.
fn compare(
    what: &str,
    base: &Solution,
    followed: &Result<Solution, Failure>,
    sought: &Result<Solution, Failure>,
) {
    match (followed, sought) {
        (Ok(followed), Ok(sought)) => {
            for (number, [a, b]) in [
                ("speed", [followed, sought].map(|state| state.final_speed)),
                ("force at the die", [followed, sought].map(|state| state.force_at_die)),
                ("solidification point", [followed, sought].map(|state| state.solidification.distance)),
                ("strain rate", [followed, sought].map(|state| state.largest_strain_rate)),
            ] {
                let from = base.final_speed;
                assert!((a / b - 1.0).abs() < 1e-6, "{what}: {number} {a}, sought {b}, from {from} m/s");
            }
        }
        (followed, sought) => assert_eq!(followed, sought, "{what}"),
    }
}
