//! A record in a case: whatever `analyse` says of the file is said of the case too, wherever notes are reported.

use crate::desk::Desk;
use std::fs;
use std::process::Command;

/// A case that is simulated in an instant, in air out of a record.
const CASE: &str = r#"
version = 1

[fibre]
length = "0.2 m"
diameter = "50 µm"
density = "950 kg/m³"
youngs_modulus = "2 GPa"
element_length = "50 mm"

[air]
record = "wire.csv"

[run]
duration = "2 ms"
time_step = "20 µs"
scheme = "implicit-tension"
replicates = 1
"#;

/// Steady turbulence, sampled at 1 kHz: a first-order process driven by a generator of random numbers [m/s].
fn velocities(count: usize) -> Vec<f64> {
    let (mut state, mut u) = (1u64, 0.0);
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / f64::from(1 << 24) - 0.5
    };
    let next = |_| {
        u = 0.8 * u + random();
        10.0 + u
    };
    (0..count).map(next).collect()
}

/// A table with times; a row without a value is none where `value` gives none.
fn table(header: &str, rows: impl Iterator<Item = Option<String>>) -> String {
    let rows = rows.enumerate().filter_map(|(i, row)| Some(format!("{},{}\n", i, row?)));
    format!("{header}\n{}", rows.collect::<String>())
}

/// The remarks on standard error: the word before the colon, and the sentence without the place in a case.
fn remarks(command: &mut Command) -> Vec<(String, String)> {
    let output = command.output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{said}");
    let words = ["note", "warning"];
    let parted = said.lines().filter_map(|line| line.split_once(": "));
    parted
        .filter(|(word, _)| words.contains(word))
        .map(|(word, text)| {
            let text = text.split_once("air.record = \"wire.csv\" ").map_or(text, |(_, text)| text);
            (word.to_owned(), text.to_owned())
        })
        .collect()
}

#[test]
fn a_case_says_of_its_record_what_analyse_says_on_the_terminal_in_the_report_and_in_the_summary() {
    let u = velocities(1500);
    let plain = |i: usize| Some(format!("{:.3}", u[i]));
    let rows = |value: &dyn Fn(usize) -> Option<String>| table("t_ms,u_m_s", (0..1500).map(value));
    let records = [
        // Three of ten samples, but for the last three, which no sample follows.
        (
            rows(&|i| if i % 10 < 7 { plain(i) } else { Some(String::new()) }),
            vec![
                ("warning", "447 missing samples (29.9 % of all) were interpolated linearly"),
                ("note", "3 incomplete rows at the end were dropped"),
            ],
        ),
        (
            rows(&|i| plain(i).filter(|_| i != 700)),
            vec![(
                "note",
                "1 missing sample (0.0667 % of all) was interpolated linearly; the file lacks 1 row by its times",
            )],
        ),
        (
            rows(&|i| if i == 700 { Some(String::new()) } else { plain(i) }),
            vec![("note", "1 missing sample (0.0667 % of all) was interpolated linearly")],
        ),
        (
            rows(&|i| if i < 2 || i == 1499 { Some(String::new()) } else { plain(i) }),
            vec![("note", "3 incomplete rows at the start and the end were dropped")],
        ),
        (
            table("t_ms,u_m_s,p_Pa", u.iter().map(|u| Some(format!("{u:.3},101325")))),
            vec![("note", "not used: p_Pa")],
        ),
        (
            rows(&|i| Some(format!("{:.3}", u[i].min(10.3)))),
            vec![(
                "warning",
                "samples are all 10.3 m/s, the extreme of the record: the instrument seems to clip",
            )],
        ),
        (
            rows(&|i| if i == 700 { Some("-2000".to_owned()) } else { plain(i) }),
            vec![
                ("warning", "u: -2e3 m/s in data row 701 (at 700 ms) is "),
                ("warning", "without this sample the analysis gives a turbulence intensity of "),
            ],
        ),
    ];
    for (record, wanted) in records {
        let desk = Desk::new();
        fs::write(desk.path("case.toml"), CASE).unwrap();
        fs::write(desk.path("wire.csv"), record).unwrap();
        let analysed = remarks(&mut desk.spunlaid("analyse wire.csv"));
        for (word, text) in &wanted {
            assert!(analysed.iter().any(|(w, t)| w == word && t.contains(text)), "{text}: {analysed:?}");
        }
        let checked = remarks(&mut desk.spunlaid("check case.toml"));
        let run = remarks(&mut desk.spunlaid("run case.toml --out out"));
        let summary = desk.summary("out");
        let notes: Vec<&str> =
            summary["notes"].as_array().unwrap().iter().filter_map(|n| n.as_str()).collect();
        let report = String::from_utf8(desk.read("out/report.html")).unwrap();
        for remark in analysed {
            assert!(checked.contains(&remark), "check: {remark:?}: {checked:?}");
            assert!(run.contains(&remark), "run: {remark:?}: {run:?}");
            let text = remark.1;
            assert!(notes.iter().any(|note| note.contains(&text)), "summary.json: {text}: {notes:?}");
            assert!(report.contains(&text), "report.html: {text}");
        }
    }
}
