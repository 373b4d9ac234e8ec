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
    let desk = Desk::of(BRIEF);
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
    success(&mut desk.spunlaid("web point.toml --out w --quiet"));
    let (study, web) = (results(&desk, "r"), desk.summary("w"));
    let of_point = &study["points"][2];
    assert_eq!(of_point["line.belt_speed_m_s"], 8.0);
    for patch in web["web"]["patches"].as_array().unwrap() {
        let side = patch["patch_m"].as_f64().unwrap() * 1e3;
        for (column, key) in
            [("", "cv"), ("_standard_error", "cv_standard_error"), ("_one_fibre", "cv_one_fibre")]
        {
            assert_eq!(of_point[format!("cv_{}_mm{column}", side.round())], patch[key], "{side} {key}");
        }
    }
    assert_eq!(of_point["basis_weight_kg_m2"], web["web"]["basis_weight_kg_m2"]);
    let folder =
        ["figures", "report.html", "results.csv", "results.json", "study.toml", "web.toml", "webs.jsonl"];
    assert_eq!(desk.entries("r"), desk::names(&folder));
    let table = String::from_utf8(desk.read("r/results.csv")).unwrap();
    assert_eq!(table.lines().count(), 5);
    assert!(table.starts_with("point,line.belt_speed_m_s,laydown.noise_m-0.5,webs,cv_1_mm,"), "{table}");
}

#[test]
fn invariant_uneven_where_less_is_laid() {
    let desk = desk();
    success(&mut desk.spunlaid("sweep study.toml --out r --quiet"));
    let study = results(&desk, "r");
    let cv = |point: usize| study["points"][point]["cv_1_mm_one_fibre"].as_f64().unwrap();
    // With half the mass CV would be √2 times as large if the curves were the same; the faster belt carries the loops apart, so
    // that a fibre meets itself less often.
    for point in [0, 1] {
        let ratio = cv(point + 2) / cv(point);
        assert!(ratio > 1.1 && ratio < 2.0_f64.sqrt(), "{} {}", cv(point + 2), cv(point));
    }
    assert!(study["points"].as_array().unwrap().iter().all(|point| point["webs"] == 2.0));
}

#[test]
fn identical_after_a_kill_and_with_more_webs() {
    let desk = desk();
    success(&mut desk.spunlaid("sweep study.toml --out whole --quiet --threads 1"));
    let mut child =
        desk.spunlaid("sweep study.toml --out killed --quiet").stderr(Stdio::null()).spawn().unwrap();
    let journal = desk.path("killed/webs.jsonl");
    // Until some webs are there.
    while fs::read_to_string(&journal).unwrap_or_default().lines().count() < 3 {
        assert!(child.try_wait().unwrap().is_none_or(|status| status.success()));
        sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    // A torn line is laid again.
    let mut text = fs::read_to_string(&journal).unwrap();
    text.truncate(text.trim_end().len() - 5);
    fs::write(&journal, text).unwrap();
    success(&mut desk.spunlaid("sweep study.toml --out killed --quiet"));
    for name in ["results.csv", "results.json", "report.html", "study.toml"] {
        assert!(desk.read(&format!("whole/{name}")) == desk.read(&format!("killed/{name}")), "{name}");
    }
    // More webs are added to those that are there.
    let before = fs::read_to_string(&journal).unwrap();
    success(&mut desk.spunlaid("sweep study.toml --replicates 3 --out killed --quiet"));
    let after = fs::read_to_string(&journal).unwrap();
    assert!(after.starts_with(&before) && after.lines().count() == 1 + 4 * 3);
}

#[test]
fn rejects_folders_of_other_results() {
    let desk = desk();
    success(&mut desk.spunlaid("sweep study.toml --out r --quiet --replicates 1"));
    let said = refusal(&mut desk.spunlaid("sweep study.toml --out r --set line.feed_speed=40m/s"), 1);
    assert!(said.contains("r: holds results of"), "{said}");
    let said = refusal(&mut desk.spunlaid("sweep study.toml --out r --print-point 5"), 1);
    assert!(said.contains("the study has 4 points"), "{said}");
    // A journal of a build that knew its study in another way; it did not say of which format it was.
    let journal = desk.path("r/webs.jsonl");
    let text = fs::read_to_string(&journal).unwrap();
    fs::write(&journal, text.replacen("\"format\":2,", "", 1)).unwrap();
    let said = refusal(&mut desk.spunlaid("sweep study.toml --out r --replicates 1"), 1);
    assert!(said.contains("is a journal of format 1, but this spunlaid reads format 2"), "{said}");
    success(&mut desk.spunlaid("run brief.toml --out run --quiet"));
    let said = refusal(&mut desk.spunlaid("sweep study.toml --out run"), 1);
    assert!(said.contains("run: holds results already (summary.json)"), "{said}");
}
