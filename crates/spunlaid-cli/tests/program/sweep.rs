//! `spunlaid sweep`: what it writes, and what it refuses before anything is simulated. What it does with a folder in
//! which a study is already stands in `sweep_again.rs`.

use crate::common::{StudyFolder, assert_same, case, results, said};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::RowAccessor;
use spunlaid_simulation::{LAYDOWN, MEASURES, SURROGATE};
use std::fs;

pub(super) const STUDY: &str = "case = 'case.toml'
design = 'grid'
replicates = 3
[vary]
'air.velocity' = ['5 m/s', '10 m/s', '20 m/s']
'fibre.diameter' = ['20 µm', '50 µm']
";

pub(super) fn place() -> StudyFolder {
    StudyFolder::new(&case(0.02), STUDY)
}

fn csv(place: &StudyFolder, out: &str) -> Vec<Vec<String>> {
    let text = fs::read_to_string(place.path(out).join("results.csv")).unwrap();
    text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

#[test]
fn writes_what_it_says() {
    let place = place();
    let output = said(&place.swept("out", &[]));
    assert!(output.contains("the study has 18 fibres in total") && output.contains("open out"), "{output}");
    let names: Vec<String> =
        results(&place.path("out")).keys().map(|path| path.to_string_lossy().into_owned()).collect();
    for name in [
        "report.html",
        "results.csv",
        "results.parquet",
        "replicates.parquet",
        "study.toml",
        "case.toml",
        "figures/amplitude_over_air_velocity.svg",
        "figures/amplitude_over_air_velocity.png",
        "figures/amplitude_over_air_velocity.csv",
        "figures/amplitude_ranking.svg",
        "figures/amplitude_ranking.csv",
    ] {
        assert!(names.contains(&name.replace('/', std::path::MAIN_SEPARATOR_STR)), "{name} of {names:?}");
    }
    let rows = csv(&place, "out");
    assert_eq!(rows.len(), 7);
    assert_eq!(
        rows[0][..8],
        [
            "point",
            "seed",
            "air.velocity_m_s",
            "fibre.diameter_m",
            "n",
            "lost",
            "amplitude_y_m",
            "amplitude_y_m_se"
        ]
    );
    assert_eq!(rows[4][..6], ["4", "1", "10", "5e-5", "3", "0"]);
    // Empty where a measure does not apply: there is no flow to leave, an explicit scheme takes nothing out,
    // and nothing is laid.
    let of_laid = MEASURES.iter().filter(|measure| [LAYDOWN, SURROGATE].contains(&measure.group));
    let others =
        ["share_outside", "tension_dissipation"].into_iter().chain(of_laid.map(|measure| measure.column));
    let others: Vec<&str> = others.collect();
    let applies = |head: &str| !others.iter().any(|other| head.starts_with(other));
    for row in &rows[1..] {
        for (head, cell) in rows[0].iter().zip(row) {
            let known = cell.parse::<f64>().is_ok_and(f64::is_finite);
            assert_eq!(known, applies(head), "{head}: {cell:?}");
        }
    }
    assert_eq!(place.swept("quiet", &["--quiet"]).stdout, b"");
    assert_eq!(place.swept("quiet", &["--quiet"]).stderr, b"");
}

#[test]
fn the_numbers_of_a_figure_are_those_of_the_results() {
    let place = StudyFolder::new(&case(0.02), &STUDY.replace("'fibre.diameter' = ['20 µm', '50 µm']\n", ""));
    place.swept("out", &[]);
    let points = csv(&place, "out");
    let column = |name: &str| points[0].iter().position(|head| head == name).unwrap();
    let text = fs::read_to_string(place.path("out/figures/amplitude_over_air_velocity.csv")).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("series,mean_velocity_m_s,amplitude_mm,error"));
    for axis in ["y", "z"] {
        let mean = column(&format!("amplitude_{axis}_m"));
        let error = column(&format!("amplitude_{axis}_m_se"));
        for point in &points[1..] {
            let number = |cell: &str| cell.parse::<f64>().unwrap();
            let row: Vec<&str> = lines.next().unwrap().split(',').collect();
            let wanted = [number(&point[2]), number(&point[mean]) * 1e3, number(&point[error]) * 1e3];
            assert_eq!((row[0], [1, 2, 3].map(|i| number(row[i]))), (axis, wanted), "{text}");
        }
    }
    assert_eq!(lines.next(), None);
}

#[test]
fn identical_for_any_number_of_threads() {
    let place = place();
    place.swept("one", &["--threads", "1"]);
    place.swept("three", &["--threads", "3"]);
    assert_same(&results(&place.path("one")), &results(&place.path("three")));
}

/// A number of `summary.json`, to the last bit.
fn of_run(summary: &str, name: &str, key: &str) -> f64 {
    let after = |text: &str, key: &str| text.split_once(&format!("\"{key}\": ")).unwrap().1.to_owned();
    let rest = after(&after(summary, name), key);
    rest[..rest.find([',', '\n']).unwrap()].parse().unwrap()
}

#[test]
fn identical_to_single_runs_of_its_points() {
    for common in ["true", "false"] {
        let place = StudyFolder::new(&case(0.02), &format!("common_phases = {common}\n{STUDY}"));
        place.swept("out", &[]);
        let rows = csv(&place, "out");
        for number in [1, 6] {
            let point = place
                .spunlaid(&["sweep", "study.toml", "--print-point", &number.to_string()])
                .output()
                .unwrap();
            fs::write(place.path("point.toml"), &point.stdout).unwrap();
            let ran = place
                .spunlaid(&["run", "point.toml", "--out", "point", "--json", "--force"])
                .output()
                .unwrap();
            assert!(ran.status.success(), "{}", said(&ran));
            let summary = String::from_utf8(ran.stdout).unwrap();
            for name in ["amplitude_y_m", "amplitude_z_m", "frequency_y_hz", "frequency_z_hz", "mean_x_m"] {
                let column = rows[0].iter().position(|head| head == name).unwrap();
                for (key, cell) in
                    [("mean", &rows[number][column]), ("standard_error", &rows[number][column + 1])]
                {
                    assert_eq!(of_run(&summary, name, key), cell.parse::<f64>().unwrap(), "{name} {key}");
                }
            }
        }
    }
}

#[test]
fn words_are_words_in_every_result() {
    let study = "case = 'case.toml'\ndesign = 'grid'\nreplicates = 2\n[vary]\n'air.velocity' = ['5 m/s', '10 m/s']\n\
                 'drag.along' = ['sakiadis', 'matsui']\n'air.spectrum' = ['flat', 'von-karman']\n";
    let place = StudyFolder::new(&case(0.02), study);
    let output = said(&place.swept("out", &[]));
    assert!(output.contains("  sakiadis  von-karman  "), "{output}");
    let rows = csv(&place, "out");
    assert_eq!(rows[0][2..5], ["air.velocity_m_s", "drag.along", "air.spectrum"]);
    let words: Vec<[&str; 2]> = rows[1..].iter().map(|row| [row[3].as_str(), row[4].as_str()]).collect();
    assert_eq!(
        words[..4],
        [["sakiadis", "flat"], ["sakiadis", "von-karman"], ["matsui", "flat"], ["matsui", "von-karman"]]
    );
    let file = fs::File::open(place.path("out/results.parquet")).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let of_parquet: Vec<[String; 2]> = reader
        .get_row_iter(None)
        .unwrap()
        .map(|row| [3, 4].map(|column| row.as_ref().unwrap().get_string(column).unwrap().clone()))
        .collect();
    assert_eq!(of_parquet, words);
    let figure = |name: &str| fs::read_to_string(place.path("out/figures").join(name)).unwrap();
    let numbers = figure("amplitude_over_drag_along.csv");
    assert!(
        numbers.contains("law_of_the_friction_along_the_fibre,") && numbers.contains("y,sakiadis,"),
        "{numbers}"
    );
    assert!(figure("amplitude_over_drag_along.svg").contains(">matsui</text>"));
    let ranking = figure("amplitude_ranking.csv");
    assert!(ranking.contains("y over drag.along: matsui instead of sakiadis,"), "{ranking}");
    let report = fs::read_to_string(place.path("out/report.html")).unwrap();
    assert!(report.contains("matsui instead of sakiadis") && report.contains("<td>von-karman</td>"));
    // The study as it was written out gives the same bits.
    let again = place.spunlaid(&["sweep", "out/study.toml", "--out", "again"]).output().unwrap();
    assert!(again.status.success(), "{}", said(&again));
    assert_eq!(csv(&place, "again"), rows);
}

#[test]
fn a_list_of_files_is_varied_and_kept_with_the_study() {
    let rows = |factor: f64| -> String {
        let row = |i: i32| 10f64.powf(0.2 * f64::from(i));
        let lines = (-10..=20).map(|i| format!("{},{}\n", row(i), factor * row(i).powf(-0.61)));
        std::iter::once("reynolds,coefficient\n".to_owned()).chain(lines).collect()
    };
    let study = "case = 'case.toml'\ndesign = 'grid'\nreplicates = 2\n[vary]\n\
                 'drag.along' = ['majumdar-shambaugh', 'mine.csv', 'other.csv']\n";
    let place = StudyFolder::new(&case(0.02), study);
    for (name, factor) in [("mine.csv", 0.78), ("other.csv", 0.37)] {
        fs::write(place.path(name), rows(factor)).unwrap();
    }
    let output = said(&place.swept("out", &[]));
    assert!(
        output.contains("(drag.along = \"mine.csv\"): drag.along = \"mine.csv\" is interpolated"),
        "{output}"
    );
    let found = csv(&place, "out");
    let words: Vec<&str> = found[1..].iter().map(|row| &*row[2]).collect();
    assert_eq!(words, ["majumdar-shambaugh", "mine.csv", "other.csv"]);
    // The law as a table of itself, and another.
    let amplitude = |row: usize| found[row][5].parse::<f64>().unwrap();
    assert_eq!(found[0][5], "amplitude_y_m");
    assert!((amplitude(2) / amplitude(1) - 1.0).abs() < 1e-3, "{found:?}");
    assert!((amplitude(3) / amplitude(1) - 1.0).abs() > 1e-3, "{found:?}");
    let written = fs::read_to_string(place.path("out/study.toml")).unwrap();
    assert!(
        written.contains("[\"majumdar-shambaugh\", \"case_files/mine.csv\", \"case_files/other.csv\"]"),
        "{written}"
    );
    // What is kept gives the same bits, and the study goes on from where it was.
    let again = place.spunlaid(&["sweep", "out/study.toml", "--out", "again"]).output().unwrap();
    assert!(again.status.success(), "{}", said(&again));
    let numbers = |rows: &[Vec<String>]| rows.iter().map(|row| row[3..].to_vec()).collect::<Vec<_>>();
    assert_eq!(numbers(&csv(&place, "again")), numbers(&found));
    let complete = said(&place.spunlaid(&["sweep", "study.toml", "--out", "out"]).output().unwrap());
    assert!(complete.contains("the study was already complete"), "{complete}");
    // A file that is not there.
    fs::remove_file(place.path("other.csv")).unwrap();
    assert!(place.refused("none", &[]).contains("other.csv"));
}

#[test]
fn words_of_two_factors_are_distinguished_by_the_legend() {
    let study = "case = 'case.toml'\ndesign = 'grid'\nreplicates = 2\n[vary]\n'drag.along' = ['sakiadis', 'matsui']\n\
                 'drag.across' = ['ju-shambaugh', 'marheineke-wegener']\n";
    let place = StudyFolder::new(&case(0.02), study);
    place.swept("out", &[]);
    let name = "out/figures/amplitude_over_drag_across";
    let picture = fs::read_to_string(place.path(&format!("{name}.svg"))).unwrap();
    for word in ["sakiadis", "matsui", "ju-shambaugh", "marheineke-wegener"] {
        assert!(picture.contains(&format!(">{word}</text>")), "{word}: {picture}");
    }
    let numbers = fs::read_to_string(place.path(&format!("{name}.csv"))).unwrap();
    assert!(numbers.contains("y at sakiadis,ju-shambaugh,"), "{numbers}");
}

#[test]
fn keys_set_for_all_points_are_kept_with_the_study() {
    let place = place();
    let set = ["--set", "run.duration=30 ms", "--set", "drag.along=sakiadis"];
    place.swept("out", &set);
    let written = fs::read_to_string(place.path("out/study.toml")).unwrap();
    assert!(
        written.contains("[set]\n\"run.duration\" = \"30 ms\"\n\"drag.along\" = \"sakiadis\"\n"),
        "{written}"
    );
    let again = place.spunlaid(&["sweep", "out/study.toml", "--out", "again"]).output().unwrap();
    assert!(again.status.success(), "{}", said(&again));
    assert_same(&results(&place.path("out")), &results(&place.path("again")));
    // The same numbers as with the values in the case.
    let changed = case(0.03).replace("[drag]\n", "[drag]\nalong = 'sakiadis'\n");
    fs::write(place.path("case.toml"), changed).unwrap();
    place.swept("changed", &[]);
    assert_eq!(csv(&place, "out"), csv(&place, "changed"));
    let refusal = place.refused("no", &["--set", "air.velocity=3 m/s"]);
    assert!(refusal.contains("air.velocity is set to one value for all points, and varied"), "{refusal}");
    let refusal = place.refused("no", &["--set", "run.duration=3 m"]);
    assert!(refusal.contains("--set run.duration = \"3 m\" is a length"), "{refusal}");
    let refusal = place.refused("no", &["--set", "air.record=probe.csv"]);
    assert!(refusal.contains("names a file, which a study takes from its case"), "{refusal}");
    let refusal = place.refused("no", &["--set", "run.seed=3"]);
    assert!(refusal.contains("write seed = 1 in the study file"), "{refusal}");
}

#[test]
fn json_holds_what_the_table_holds() {
    let place = place();
    let output = place.swept("out", &["--json"]);
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(output.stdout, fs::read(place.path("out/results.json")).unwrap());
    let rows = csv(&place, "out");
    for (point, row) in json["points"].as_array().unwrap().iter().zip(&rows[1..]) {
        let inputs = &point["inputs"];
        for (head, cell) in rows[0].iter().zip(row) {
            let value = match head.strip_suffix("_se") {
                Some(name) => &point["results"][name]["standard_error"],
                None if inputs.get(head).is_some() => &inputs[head],
                None if point.get(head).is_some() => &point[head],
                None => &point["results"][head]["mean"],
            };
            // The reader of JSON rounds the last digit.
            let same = match (value.as_f64(), cell.parse::<f64>().ok()) {
                (Some(a), Some(b)) => (a - b).abs() <= 2.0 * f64::EPSILON * b.abs(),
                (a, b) => a == b,
            };
            assert!(same, "{head}: {value} {cell}");
        }
    }
    let effect = &json["ranking"]["amplitude_y_m"]["effects"][0];
    assert_eq!((effect["factor"].as_str(), effect["from"].as_f64()), (Some("air.velocity"), Some(5.0)));
}

#[test]
fn points_of_a_belt_at_several_speeds_are_those_of_runs_alone() {
    let case = "[fibre]\ndiameter = '18 µm'\ndensity = '910 kg/m³'\nyoungs_modulus = '2 GPa'\n\
        element_length = '4 mm'\n[feed]\nspeed = '50 m/s'\n[belt]\ndistance = '0.1 m'\nspeed = '3 m/s'\n\
        [air]\nvelocity = '45 m/s'\nturbulence_intensity = 0.1\nlength_scale = '16 mm'\n\
        cutoff_frequency = '700 Hz'\n[drag]\nacross = 'marheineke-wegener'\n[run]\nduration = '40 ms'\n";
    let study = "case = 'case.toml'\ndesign = 'grid'\nreplicates = 2\n[vary]\n\
        'belt.speed' = ['1 m/s', '3 m/s', '8 m/s']\n";
    let place = StudyFolder::new(case, study);
    let output = said(&place.swept("out", &[]));
    assert!(
        output.contains("Standard deviation in machine direction (mm)") && !output.contains("Amplitude"),
        "{output}"
    );
    let rows = csv(&place, "out");
    let column = |name: &str| rows[0].iter().position(|head| head == name).unwrap();
    for (number, row) in rows.iter().enumerate().skip(1) {
        let point = number.to_string();
        let output = place.spunlaid(&["sweep", "study.toml", "--print-point", &point]).output().unwrap();
        fs::write(place.path("point.toml"), &output.stdout).unwrap();
        let output = place.spunlaid(&["run", "point.toml", "--replicates", "2", "--json"]).output().unwrap();
        let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        for name in ["sigma_md_m", "belt_speed_ratio", "half_correlation_length_cd_m"] {
            let alone = summary["laydown"][name]["mean"].as_f64();
            assert_eq!(row[column(name)].parse().ok(), alone, "point {number}: {name}");
        }
    }
}
