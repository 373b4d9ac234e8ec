//! `spunlaid sweep`: what it writes, what it goes on with and what it refuses.

use crate::common::{Place, assert_same, case, contents, results, said};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::RowAccessor;
use spunlaid::observe::{LAYDOWN, MEASURES, SURROGATE};
use std::fs;
use std::time::Duration;

const STUDY: &str = "case = 'case.toml'
design = 'grid'
replicates = 3
[vary]
'air.velocity' = ['5 m/s', '10 m/s', '20 m/s']
'fibre.diameter' = ['20 µm', '50 µm']
";

fn place() -> Place {
    Place::new(&case(0.02), STUDY)
}

fn csv(place: &Place, out: &str) -> Vec<Vec<String>> {
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
    let place = Place::new(&case(0.02), &STUDY.replace("'fibre.diameter' = ['20 µm', '50 µm']\n", ""));
    place.swept("out", &[]);
    let points = csv(&place, "out");
    let column = |name: &str| points[0].iter().position(|head| head == name).unwrap();
    let text = fs::read_to_string(place.path("out/figures/amplitude_over_air_velocity.csv")).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("series,mean_velocity_m_s,amplitude_mm,error"));
    for axis in ["y", "z"] {
        let (mean, error) =
            (column(&format!("amplitude_{axis}_m")), column(&format!("amplitude_{axis}_m_se")));
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
        let place = Place::new(&case(0.02), &format!("common_phases = {common}\n{STUDY}"));
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
fn a_finished_study_is_not_flown_again() {
    let place = place();
    place.swept("out", &[]);
    let before = contents(&place.path("out"));
    let output = said(&place.swept("out", &[]));
    assert!(output.contains("already complete"), "{output}");
    assert_same(&before, &contents(&place.path("out")));
    // All files except the journal are restored.
    for name in ["results.csv", "report.html", "study.toml"] {
        fs::remove_file(place.path("out").join(name)).unwrap();
    }
    place.swept("out", &[]);
    assert_same(&before, &contents(&place.path("out")));
}

#[test]
fn its_results_folder_is_a_study() {
    let place = place();
    place.swept("out", &[]);
    let again = place.spunlaid(&["sweep", "out/study.toml", "--out", "again"]).output().unwrap();
    assert!(again.status.success(), "{}", said(&again));
    assert_same(&results(&place.path("out")), &results(&place.path("again")));
}

#[test]
fn rejects_another_study_in_the_folder_of_an_unfinished_one_showing_what_differs() {
    let place = place();
    place.swept("out", &[]);
    // As if it had been killed at the end.
    fs::remove_file(place.path("out").join("report.html")).unwrap();
    fs::write(place.path("study.toml"), STUDY.replace("replicates = 3", "common_phases = false")).unwrap();
    let refusal = place.refused("out", &[]);
    assert!(refusal.contains("study.toml: common_phases was true, is false"), "{refusal}");
    fs::write(place.path("study.toml"), STUDY.replace("'20 m/s'", "'25 m/s'")).unwrap();
    let refusal = place.refused("out", &[]);
    assert!(
        refusal.contains(
            r#"vary.air.velocity was ["5 m/s", "10 m/s", "20 m/s"], is ["5 m/s", "10 m/s", "25 m/s"]"#
        ),
        "{refusal}"
    );
    fs::write(place.path("study.toml"), STUDY).unwrap();
    fs::write(place.path("case.toml"), case(0.02).replace("950 kg", "951 kg")).unwrap();
    let refusal = place.refused("out", &[]);
    assert!(refusal.contains("case.toml: fibre.density was '950 kg/m³', is '951 kg/m³'"), "{refusal}");
    assert!(refusal.contains("--force") && refusal.contains("--out"), "{refusal}");
    place.swept("out", &["--force"]);
    place.swept("new", &[]);
    assert_same(&results(&place.path("out")), &results(&place.path("new")));
}

#[test]
fn a_changed_study_replaces_a_finished_one_and_says_so() {
    let place = place();
    place.swept("out", &[]);
    fs::write(place.path("out").join("thesis.tex"), "mine").unwrap();
    let changed = STUDY.replace("'20 m/s'", "'25 m/s'");
    fs::write(place.path("study.toml"), &changed).unwrap();
    // Another command made it, or it has been worked on since its results were written.
    let refusal = place.refused("out", &["--set", "fibre.density=940 kg/m³"]);
    assert!(refusal.contains("out: holds results of another study"), "{refusal}");
    let journal = fs::File::options().append(true).open(place.path("out").join("journal")).unwrap();
    let written = journal.metadata().unwrap().modified().unwrap();
    journal.set_modified(written + Duration::from_secs(60)).unwrap();
    let refusal = place.refused("out", &[]);
    assert!(refusal.contains("out: holds results of another study"), "{refusal}");
    journal.set_modified(written).unwrap();
    drop(journal);
    let output = said(&place.swept("out", &["--replicates", "4"]));
    assert!(
        output.contains("note: out: holds earlier results of this command, which are replaced"),
        "{output}"
    );
    assert_eq!(fs::read(place.path("out").join("thesis.tex")).unwrap(), b"mine");
    fs::remove_file(place.path("out").join("thesis.tex")).unwrap();
    place.swept("new", &["--replicates", "4"]);
    assert_same(&results(&place.path("out")), &results(&place.path("new")));
    let output = said(&place.swept("out", &["--replicates", "4"]));
    assert!(output.contains("already complete") && !output.contains("replaced"), "{output}");
}

#[test]
fn a_study_written_otherwise_is_the_same() {
    let place = place();
    place.swept("out", &[]);
    let otherwise =
        format!("# A comment.\nseed = 1\ncommon_phases = true\n{}", STUDY.replace("'50 µm'", "'0.05 mm'"));
    fs::write(place.path("study.toml"), otherwise).unwrap();
    fs::write(place.path("case.toml"), format!("# Another.\n{}", case(0.02))).unwrap();
    let output = said(&place.swept("out", &[]));
    assert!(output.contains("already complete"), "{output}");
}

#[test]
fn damage_to_the_journal_is_told_and_made_good() {
    let place = place();
    place.swept("out", &[]);
    let journal = place.path("out").join("journal");
    let (whole, before) = (fs::read(&journal).unwrap(), results(&place.path("out")));
    let mut damaged = whole.clone();
    damaged[whole.len() / 2] ^= 0x10;
    fs::write(&journal, &damaged).unwrap();
    let output = said(&place.swept("out", &[]));
    assert!(output.contains("damaged records (1 record)"), "{output}");
    assert_same(&before, &results(&place.path("out")));
    fs::write(&journal, &whole[..whole.len() - 5]).unwrap();
    let output = said(&place.swept("out", &[]));
    assert!(output.contains("last record of the journal was incomplete"), "{output}");
    assert_same(&before, &results(&place.path("out")));
    // Half a header with results: the results are not overwritten without --force.
    fs::write(&journal, &whole[..9]).unwrap();
    assert!(place.refused("out", &[]).contains("holds results already (results.csv)"));
    place.swept("out", &["--force"]);
    assert_same(&before, &results(&place.path("out")));
    // Without results it is a study that was killed at its start.
    for name in ["results.csv", "results.json", "results.parquet", "replicates.parquet", "report.html"] {
        fs::remove_file(place.path("out").join(name)).unwrap();
    }
    fs::remove_dir_all(place.path("out").join("figures")).unwrap();
    fs::write(&journal, &whole[..9]).unwrap();
    place.swept("out", &[]);
    assert_same(&before, &results(&place.path("out")));
}

#[test]
fn rejects_the_journals_of_others() {
    let place = place();
    place.swept("out", &[]);
    let journal = place.path("out").join("journal");
    let whole = fs::read(&journal).unwrap();
    let end = whole.iter().position(|byte| *byte == b'\n').unwrap();
    let header = String::from_utf8(whole[..end].to_vec()).unwrap();
    let version = format!("version={}", env!("CARGO_PKG_VERSION"));
    for (header, told) in [
        (header.replace(&version, "version=0.0.1"), "spunlaid 0.0.1"),
        (header.replace("format=4", "format=77"), "format 77"),
        (header.replace("spunlaid-journal", "something-else"), "is not the journal of a study"),
    ] {
        let mut other = header.into_bytes();
        other.extend(&whole[end..]);
        fs::write(&journal, &other).unwrap();
        let refusal = place.refused("out", &[]);
        assert!(
            refusal.contains(told) && refusal.contains("--out") && refusal.contains("--force"),
            "{refusal}"
        );
    }
    place.swept("out", &["--force"]);
}

#[test]
fn rejects_folders_with_other_results_and_files() {
    let place = place();
    let ran = place.spunlaid(&["run", "case.toml", "--out", "out", "--replicates", "1"]).output().unwrap();
    assert!(ran.status.success(), "{}", said(&ran));
    assert!(place.refused("out", &[]).contains("holds results already"));
    assert!(place.refused("case.toml", &[]).contains("is a file"));
    // A run refuses the folder of a study as well.
    place.swept("study", &[]);
    let ran = place.spunlaid(&["run", "case.toml", "--out", "study"]).output().unwrap();
    assert_eq!(ran.status.code(), Some(1), "{}", said(&ran));
}

#[test]
fn rejects_points_that_are_not_there() {
    let place = place();
    for number in ["0", "7"] {
        let output = place.spunlaid(&["sweep", "study.toml", "--print-point", number]).output().unwrap();
        assert_eq!(output.status.code(), Some(1));
        assert!(said(&output).contains("the study has 6 points, counted from 1"), "{}", said(&output));
    }
    assert!(!place.path("results").exists());
}

#[test]
fn rejects_bad_studies_before_anything_is_written() {
    let place = Place::new(&case(0.02), &STUDY.replace("'20 m/s'", "'20 m'"));
    assert!(place.refused("out", &[]).contains("study.toml:5: air.velocity = '20 m' is a length"));
    assert!(!place.path("out").exists());
}

#[test]
fn words_are_words_in_every_result() {
    let study = "case = 'case.toml'\ndesign = 'grid'\nreplicates = 2\n[vary]\n'air.velocity' = ['5 m/s', '10 m/s']\n\
                 'drag.along' = ['sakiadis', 'matsui']\n'air.spectrum' = ['flat', 'von-karman']\n";
    let place = Place::new(&case(0.02), study);
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
fn words_of_two_factors_are_told_apart_by_the_legend() {
    let study = "case = 'case.toml'\ndesign = 'grid'\nreplicates = 2\n[vary]\n'drag.along' = ['sakiadis', 'matsui']\n\
                 'drag.across' = ['ju-shambaugh', 'marheineke-wegener']\n";
    let place = Place::new(&case(0.02), study);
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
fn identical_when_replicates_are_added_to_a_finished_study() {
    let place = place();
    place.swept("grown", &["--replicates", "3"]);
    let output = said(&place.swept("grown", &["--replicates", "11"]));
    assert!(output.contains("continuing: 18 fibres of 66 already done"), "{output}");
    place.swept("once", &["--replicates", "11"]);
    assert_same(&results(&place.path("grown")), &results(&place.path("once")));
    assert!(fs::read_to_string(place.path("grown/study.toml")).unwrap().contains("replicates = 11"));
    let refusal = place.refused("grown", &[]);
    assert!(
        refusal.contains("holds 11 replicates of a point, more than the 3")
            && refusal.contains("--replicates 11"),
        "{refusal}"
    );
    // A study by need goes on to more at most, but not to another rule.
    let by_need = |at_most: u64, share: &str| {
        let rule =
            format!("[replicates]\nat_least = 2\nat_most = {at_most}\nuntil = {{ amplitude_y = '{share}' }}");
        fs::write(place.path("study.toml"), format!("{}{rule}\n", STUDY.replace("replicates = 3\n", "")))
            .unwrap();
    };
    by_need(4, "5 %");
    place.swept("need", &[]);
    by_need(9, "5 %");
    place.swept("need", &[]);
    place.swept("need_once", &[]);
    assert_same(&results(&place.path("need")), &results(&place.path("need_once")));
    by_need(9, "4 %");
    // As if it had been killed at the end; a finished one would be replaced.
    fs::remove_file(place.path("need/report.html")).unwrap();
    assert!(
        place.refused("need", &[]).contains("study.toml: replicates.until.amplitude_y was 0.05, is 0.04")
    );
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
    let place = Place::new(case, study);
    let output = said(&place.swept("out", &[]));
    assert!(output.contains("Spread in machine direction (mm)") && !output.contains("Amplitude"), "{output}");
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
