//! `spunlaid sweep` with a study of webs.

use crate::desk;
use crate::desk::{BRIEF, Desk, refusal, success};
use serde_json::Value;
use std::fs;
use std::process::Stdio;
use std::thread::sleep;
use std::time::Duration;

/// A small web of known numbers.
const WEB: &str = r#"
[fibre]
diameter = "18 µm"
density = "910 kg/m³"
[laydown]
sigma_md = "9 mm"
sigma_cd = "8 mm"
noise = "15 m^-0.5"
[line]
feed_speed = "50 m/s"
belt_speed = "5 m/s"
filaments_per_metre = 400
[web]
width = "250 mm"
length = "250 mm"
cell = "1 mm"
"#;
const STUDY: &str = "web = 'web.toml'\ndesign = 'grid'\nreplicates = 2\n[vary]\n\
                     'line.belt_speed' = ['4 m/s', '8 m/s']\n'laydown.noise' = ['10 m^-0.5', '20 m^-0.5']\n";

fn desk() -> Desk {
    let desk = Desk::with_case(BRIEF);
    fs::write(desk.path("web.toml"), WEB).unwrap();
    fs::write(desk.path("study.toml"), STUDY).unwrap();
    desk
}

fn results(desk: &Desk, folder: &str) -> Value {
    serde_json::from_slice(&desk.read(&format!("{folder}/results.json"))).unwrap()
}

#[test]
fn identical_web_of_a_point_alone() {
    let desk = desk();
    success(&mut desk.spunlaid("sweep study.toml --replicates 1 --out r --quiet"));
    let point = success(&mut desk.spunlaid("sweep study.toml --print-point 3"));
    fs::write(desk.path("point.toml"), point).unwrap();
    success(&mut desk.spunlaid("web point.toml --no-advice --out w --quiet"));
    let (study, web) = (results(&desk, "r"), desk.summary("w"));
    let of_point = &study["points"][2];
    assert_eq!(of_point["inputs"]["line.belt_speed_m_s"], 8.0);
    let mean = |column: &str| &of_point["results"][column]["mean"];
    for patch in web["web"]["patches"].as_array().unwrap() {
        let side = patch["patch_m"].as_f64().unwrap() * 1e3;
        for (column, key) in [("", "cv"), ("_chance", "cv_standard_error"), ("_one_fibre", "cv_one_fibre")] {
            assert_eq!(*mean(&format!("cv_{}_mm{column}", side.round())), patch[key], "{side} {key}");
        }
        // Of a single web, its parts give the error.
        let cv = &of_point["results"][format!("cv_{}_mm", side.round())];
        assert_eq!(cv["standard_error"], patch["cv_standard_error"], "{side}");
    }
    assert_eq!(*mean("basis_weight_kg_m2"), web["web"]["basis_weight_kg_m2"]);
    let folder = [
        "figures",
        "journal",
        "origin.toml",
        "replicates.parquet",
        "report.html",
        "results.csv",
        "results.json",
        "results.parquet",
        "study.toml",
        "web.toml",
    ];
    assert_eq!(desk.entries("r"), desk::names(&folder));
    let table = String::from_utf8(desk.read("r/results.csv")).unwrap();
    assert_eq!(table.lines().count(), 5);
    let head =
        "point,seed,line.belt_speed_m_s,laydown.noise_m-0.5,n,lost,cv_1_mm,cv_1_mm_se,cv_1_mm_whole_error,";
    assert!(table.starts_with(head), "{table}");
}

#[test]
fn invariant_uneven_where_less_is_laid() {
    let desk = desk();
    success(&mut desk.spunlaid("sweep study.toml --out r --quiet"));
    let study = results(&desk, "r");
    let cv = |point: usize| study["points"][point]["results"]["cv_1_mm_one_fibre"]["mean"].as_f64().unwrap();
    // With half the mass CV would be √2 times as large if the curves were the same; the faster belt carries
    // the loops apart, so that a fibre meets itself less often.
    for point in [0, 1] {
        let ratio = cv(point + 2) / cv(point);
        assert!(ratio > 1.1 && ratio < 2.0_f64.sqrt(), "{} {}", cv(point + 2), cv(point));
    }
    // Two keys with two values each: what matters more is reported.
    let ranking = &study["ranking"]["cv_1_mm_one_fibre"]["effects"];
    assert_eq!(ranking[0]["factor"], "line.belt_speed", "{ranking}");
    assert!(desk.path("r/figures/cv_ranking.svg").is_file());
    assert!(study["points"].as_array().unwrap().iter().all(|point| point["n"] == 2));
}

#[test]
fn identical_after_a_kill_and_with_more_webs() {
    let desk = desk();
    success(&mut desk.spunlaid("sweep study.toml --out whole --quiet --threads 1"));
    let mut child =
        desk.spunlaid("sweep study.toml --out killed --quiet").stderr(Stdio::null()).spawn().unwrap();
    let journal = desk.path("killed/journal");
    let records = || {
        let bytes = fs::read(&journal).unwrap_or_default();
        let header = bytes.iter().position(|byte| *byte == b'\n').map_or(bytes.len(), |end| end + 1);
        (bytes.len() - header, bytes)
    };
    // Until some webs are there.
    while records().0 < 2 * 300 {
        assert!(child.try_wait().unwrap().is_none_or(|status| status.success()));
        sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    // A torn record is laid again.
    let bytes = records().1;
    fs::write(&journal, &bytes[..bytes.len() - 5]).unwrap();
    success(&mut desk.spunlaid("sweep study.toml --out killed --quiet"));
    for name in ["results.csv", "results.json", "results.parquet", "report.html", "study.toml"] {
        assert!(desk.read(&format!("whole/{name}")) == desk.read(&format!("killed/{name}")), "{name}");
    }
    // More webs are added to those that are there.
    let (before, text) = records();
    success(&mut desk.spunlaid("sweep study.toml --replicates 3 --out killed --quiet"));
    let (after, longer) = records();
    assert!(longer.starts_with(&text) && 2 * after == 3 * before, "{before} {after}");
}

/// What a study of fibres can, one of webs can: keys that follow from others, and as many webs as an error asks for.
#[test]
fn keys_follow_from_others_and_webs_are_added_until_they_suffice() {
    let desk = desk();
    let study = "web = 'web.toml'\ndesign = 'grid'\n[replicates]\nat_least = 2\nat_most = 5\n\
        until = { cv_1_mm = '0.0001 %' }\n[vary]\n'line.belt_speed' = ['4 m/s', '8 m/s']\n[link]\n\
        'line.feed_speed' = '10 * line.belt_speed'\n";
    fs::write(desk.path("study.toml"), study).unwrap();
    success(&mut desk.spunlaid("sweep study.toml --out r --quiet"));
    let found = results(&desk, "r");
    for (point, belt) in [(0, 4.0), (1, 8.0)] {
        let point = &found["points"][point];
        assert_eq!(point["inputs"]["line.feed_speed_m_s"], 10.0 * belt);
        assert_eq!(point["n"], 5, "so small an error is never reached");
        // As much is laid, because feed and belt go together.
        let same = point["results"]["basis_weight_kg_m2"]["mean"].as_f64().unwrap();
        let first = found["points"][0]["results"]["basis_weight_kg_m2"]["mean"].as_f64().unwrap();
        assert!((same / first - 1.0).abs() < 1e-4, "{same} {first}");
    }
    success(&mut desk.spunlaid("sweep r/study.toml --out again --quiet"));
    for name in ["results.csv", "results.json", "study.toml", "web.toml"] {
        assert!(desk.read(&format!("r/{name}")) == desk.read(&format!("again/{name}")), "{name}");
    }
}

#[test]
fn rejects_folders_of_other_results() {
    let desk = desk();
    success(&mut desk.spunlaid("sweep study.toml --out r --quiet --replicates 1"));
    let said = refusal(&mut desk.spunlaid("sweep study.toml --out r --set line.feed_speed=40m/s"), 1);
    assert!(said.contains("r: holds results of"), "{said}");
    let said = refusal(&mut desk.spunlaid("sweep study.toml --out r --print-point 5"), 1);
    assert!(said.contains("the study has 4 points"), "{said}");
    // The journal that earlier versions wrote for webs.
    fs::create_dir(desk.path("old")).unwrap();
    fs::write(desk.path("old/webs.jsonl"), "{}").unwrap();
    let said = refusal(&mut desk.spunlaid("sweep study.toml --out old"), 1);
    assert!(
        said.contains("old: holds results already (webs.jsonl); name another folder, or replace them"),
        "{said}"
    );
    success(&mut desk.spunlaid("run brief.toml --out run --quiet"));
    let said = refusal(&mut desk.spunlaid("sweep study.toml --out run"), 1);
    assert!(said.contains("run: holds results already (summary.json)"), "{said}");
}
