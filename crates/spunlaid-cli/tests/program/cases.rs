//! Every case of the repository can be run; long ones are cut short.

use crate::desk::{Desk, ENTRIES, entries_of_fed, names, success};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A file with some of its text written otherwise.
fn shortened(path: &Path, long: &str, short: &str) -> String {
    let text = fs::read_to_string(path).unwrap();
    assert!(text.contains(long), "{}", path.display());
    text.replace(long, short)
}

#[test]
fn flies_every_study_of_the_paper() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let desk = Desk::new();
    fs::create_dir(desk.path("paper")).unwrap();
    let table1 = shortened(&cases.join("table1.toml"), "duration = \"1 s\"", "duration = \"20 ms\"");
    fs::write(desk.path("table1.toml"), table1).unwrap();
    let mut points = BTreeMap::new();
    for entry in fs::read_dir(cases.join("paper")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let study = shortened(&path, "replicates = 10", "replicates = 2");
        fs::write(desk.path(&format!("paper/{name}.toml")), study).unwrap();
        success(&mut desk.spunlaid(&format!("sweep paper/{name}.toml --out {name}")));
        let table = fs::read_to_string(desk.path(&format!("{name}/results.csv"))).unwrap();
        points.insert(name, table.lines().count() - 1);
    }
    let wanted = [
        ("choices", 5),
        ("cutoff", 6),
        ("diameter", 7),
        ("intensity", 7),
        ("length_scale", 7),
        ("time_step", 3),
        ("velocity", 6),
    ];
    assert_eq!(points, wanted.map(|(name, points)| (name.to_owned(), points)).into());
}

/// The rows of a CSV file as text.
fn rows(text: &[u8]) -> Vec<Vec<String>> {
    let text = std::str::from_utf8(text).unwrap();
    text.lines().map(|line| line.split(',').map(ToOwned::to_owned).collect()).collect()
}

#[test]
fn identical_figure_9_reproduced_and_swept() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let desk = Desk::new();
    let said = success(&mut desk.spunlaid("reproduce --figures 9 --replicates 2 --out paper"));
    let claims = desk.summary("paper")["claims"].as_array().unwrap().clone();
    assert_eq!(claims.len(), 2);
    for claim in claims {
        assert_eq!(claim["figure"], "9");
        assert!(said.contains(claim["claim"].as_str().unwrap()), "{said}");
        assert!(said.contains(claim["evidence"].as_str().unwrap()), "{said}");
    }
    // The study's file alone, from another folder, gives the same bits.
    fs::create_dir(desk.path("there")).unwrap();
    fs::copy(cases.join("table1.toml"), desk.path("table1.toml")).unwrap();
    let study = shortened(&cases.join("paper/velocity.toml"), "replicates = 10", "replicates = 2");
    fs::write(desk.path("there/velocity.toml"), study).unwrap();
    success(&mut desk.spunlaid("sweep there/velocity.toml --out swept"));
    let swept = rows(&desk.read("swept/results.csv"));
    let number = |row: &[String], name: &str| -> f64 {
        row[swept[0].iter().position(|head| head == name).unwrap()].parse().unwrap()
    };
    let figure = rows(&desk.read("paper/figures/figure_9a.csv"));
    assert_eq!(figure[0], ["series", "mean_air_velocity_m_s", "amplitude_mm", "error"]);
    for axis in ["y", "z"] {
        let drawn: Vec<Vec<f64>> = (figure.iter().filter(|row| row[0] == axis))
            .map(|row| row[1..].iter().map(|cell| cell.parse().unwrap()).collect())
            .collect();
        let wanted: Vec<Vec<f64>> = (swept[1..].iter())
            .map(|row| {
                let column = format!("amplitude_{axis}_m");
                let amplitude = [number(row, &column), number(row, &format!("{column}_se"))];
                vec![number(row, "air.velocity_m_s"), amplitude[0] * 1e3, amplitude[1] * 1e3]
            })
            .collect();
        assert_eq!(drawn, wanted, "{axis}");
    }
}

#[test]
fn runs_every_case_of_the_repository() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let desk = Desk::new();
    let mut simulated = 0;
    for entry in fs::read_dir(cases).unwrap() {
        let path = entry.unwrap().path();
        let is_toml = path.extension().is_some_and(|extension| extension == "toml");
        let text = fs::read_to_string(&path).unwrap_or_default();
        // Webs are no cases.
        if !is_toml || text.contains("\n[web]\n") {
            continue;
        }
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let fed = text.contains("\n[belt]\n");
        if text.contains("[spinline]\n") && !fed {
            let said = success(desk.spunlaid("spin").arg(&path).args(["--out", &name]));
            assert!(said.contains("Diameter, cold"), "{name}: {said}");
            continue;
        }
        let mut command = desk.spunlaid("run");
        command.arg(&path).args(["--out", &name, "--replicates", "2"]);
        let short = ["run.duration=20 ms", "run.spin_up=5 ms", "run.output_interval=1 ms"];
        let said = success(command.args(short.iter().flat_map(|change| ["--set", change])));
        let measured = if fed { "Nodes in the air" } else { "Amplitude in y" };
        assert!(said.contains(measured), "{name}: {said}");
        let mut entries = desk.entries(&name);
        // Of cases whose air is in files.
        entries.remove("case_files");
        let mut meant = if fed { entries_of_fed() } else { names(&ENTRIES) };
        if text.contains("[spinline]\n") {
            meant.insert("spinline.parquet".to_owned());
        }
        // In so short a time a slow fibre has laid nothing.
        entries.remove("laid.vtp");
        meant.remove("laid.vtp");
        assert_eq!(entries, meant, "{name}");
        let summary = desk.summary(&name);
        if fed {
            let nodes = summary["laydown"]["nodes_in_air"]["mean"].as_f64().unwrap();
            assert!(nodes > 2.0, "{name}: {nodes}");
        } else {
            let strain = summary["fibre"]["max_strain"]["largest"].as_f64().unwrap();
            assert!(strain < 0.1, "{name}: {strain}");
        }
        simulated += 1;
    }
    assert!(simulated >= 4, "{simulated}");
}
