//! `spunlaid compare`: differences of runs, and what is refused.

use crate::desk::{Desk, names, success};
use serde_json::{Value, json};

const LONGER: [&str; 4] =
    ["run.duration=80 ms", "run.output_interval=0.2 ms", "run.replicates=8", "run.spin_up=10 ms"];

fn simulated(desk: &Desk, name: &str, more: &[&str]) {
    let changes: Vec<&str> = LONGER.iter().chain(more).copied().collect();
    success(&mut desk.with(&format!("run brief.toml --out {name}"), &changes));
}

fn json(desk: &Desk, arguments: &str) -> Value {
    serde_json::from_str(&success(&mut desk.spunlaid(&format!("compare {arguments} --json")))).unwrap()
}

/// The values of the replicates of a measure.
fn values(desk: &Desk, run: &str, group: &str, column: &str) -> Vec<f64> {
    let summary = desk.summary(run);
    summary[group][column]["values"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

#[test]
fn runs_in_the_same_turbulence_are_compared_pair_by_pair() {
    let desk = Desk::new();
    simulated(&desk, "a", &[]);
    simulated(&desk, "b", &["air.density=1.5 kg/m³"]);
    let said = success(&mut desk.spunlaid("compare a b --out c"));
    assert!(
        said.contains("b against a\nCompared paired by replicate") && said.contains("(8 pairs)"),
        "{said}"
    );
    assert!(said.contains("differ significantly"), "{said}");
    assert_eq!(desk.entries("c"), names(&["comparison.json", "figures", "origin.toml", "report.html"]));
    let found = json(&desk, "a b");
    let one = &found["comparisons"][0];
    assert_eq!((one["paired"].as_bool(), one["pairs"].as_u64()), (Some(true), Some(8)));
    // By hand: mean and standard error of the differences.
    let a = values(&desk, "a", "end_node", "amplitude_y_m");
    let b = values(&desk, "b", "end_node", "amplitude_y_m");
    let d: Vec<f64> = a.iter().zip(&b).map(|(a, b)| b - a).collect();
    let mean = d.iter().sum::<f64>() / 8.0;
    let error = (d.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 56.0).sqrt();
    let amplitude = &one["measures"]["amplitude_y_m"];
    let close = |found: &Value, wanted: f64| (found.as_f64().unwrap() / wanted - 1.0).abs() < 1e-9;
    assert!(
        close(&amplitude["difference"], mean) && close(&amplitude["standard_error"], error),
        "{amplitude}"
    );
    // Student's t for seven degrees of freedom.
    assert!(close(&amplitude["half_width"], 2.36462 * error), "{amplitude}");
    assert_eq!(amplitude["significant"].as_bool(), Some(mean.abs() > 2.36462 * error));
    // The curves of both stand in one picture.
    let numbers = String::from_utf8(desk.read("c/figures/motion_spectrum.csv")).unwrap();
    assert!(numbers.contains("\"a, y\",") && numbers.contains("\"b, z\","), "{numbers}");
    // Only the means are drawn of the energy errors, not the area up to the largest.
    let page = String::from_utf8(desk.read("c/report.html")).unwrap();
    assert!(page.contains("Errors of the energy checks over time.") && !page.contains("shaded area"));
    // The title says how much differs, as the table does.
    let all =
        one["measures"].as_object().unwrap().values().filter(|measure| !measure["significant"].is_null());
    let all: Vec<bool> = all.map(|measure| measure["significant"].as_bool().unwrap()).collect();
    let (beyond, all) = (all.iter().filter(|is| **is).count(), all.len());
    let title = format!("<h1>b against a: {beyond} of {all} measures differ, most clearly “");
    assert!(beyond > 0 && page.contains(&title), "{title}");
    let page = String::from_utf8(desk.read("a/report.html")).unwrap();
    assert!(page.contains("the shaded area reaches to the largest of any replicate"));
}

#[test]
fn runs_in_different_turbulence_are_compared_by_welch() {
    let desk = Desk::new();
    simulated(&desk, "a", &[]);
    simulated(&desk, "b", &["run.seed=8"]);
    simulated(&desk, "c", &["air.length_scale=100 mm"]);
    simulated(&desk, "d", &["air.lateral=von-karman", "air.lateral_cutoff=5"]);
    let found = json(&desk, "a b c d");
    let comparisons = found["comparisons"].as_array().unwrap();
    let reason = |i: usize| comparisons[i]["reason"].as_str().unwrap();
    for (run, what) in ["run.seed", "air.length_scale", "air.lateral"].into_iter().enumerate() {
        assert!(
            reason(run).contains("because the turbulence differs in ") && reason(run).contains(what),
            "{}",
            reason(run)
        );
        assert_eq!(comparisons[run]["paired"].as_bool(), Some(false));
    }
    let amplitude = &comparisons[0]["measures"]["amplitude_y_m"];
    let square = |name: &str| {
        let summary = desk.summary(name);
        summary["end_node"]["amplitude_y_m"]["standard_error"].as_f64().unwrap().powi(2)
    };
    let wanted = (square("a") + square("b")).sqrt();
    assert!((amplitude["standard_error"].as_f64().unwrap() / wanted - 1.0).abs() < 1e-9, "{amplitude}");
    // Seven to fourteen degrees of freedom.
    let t = amplitude["half_width"].as_f64().unwrap() / wanted;
    assert!((2.1447..=2.3647).contains(&t), "{t}");
    // Without --out, --json writes no files.
    assert!(!desk.path("results").exists());
}

#[test]
fn a_run_does_not_differ_from_itself() {
    let desk = Desk::new();
    simulated(&desk, "a", &[]);
    simulated(&desk, "again", &[]);
    let said = success(&mut desk.spunlaid("compare a again --out c"));
    assert!(said.contains("the same") && said.contains(" 0 of "), "{said}");
    success(&mut desk.spunlaid("compare a again --out c --force --quiet"));
}

/// The CV of a web over patches of 10 mm, and its formation number, which goes with the square. One web has few waves,
/// so that its interval reaches up to the other one; the errors by chance alone would say the contrary.
#[test]
fn invariant_a_cv_and_the_formation_number_have_one_verdict() {
    let desk = Desk::new();
    let write = |name: &str, cv: f64, error: f64, interval: [f64; 2]| {
        let formation = cv * cv / 1e-4;
        let patch = |side: f64, part: f64| {
            json!({
                "patch_m": side, "cv": part * cv, "cv_standard_error": part * error, "cv_total_error": part * error,
                "cv_interval": interval.map(|end| part * end),
            })
        };
        let number = json!({ "value": formation, "standard_error": 2.0 * formation * error / cv });
        let summary = json!({
            "web": { "patches": [patch(0.01, 1.0), patch(0.02, 0.6)] },
            "fabric": { "patches": [{ "patch_m": 0.01, "formation": number }] },
        });
        std::fs::create_dir(desk.path(name)).unwrap();
        std::fs::write(desk.path(&format!("{name}/summary.json")), summary.to_string()).unwrap();
    };
    write("a", 0.198, 0.013, [0.174, 0.226]);
    write("few", 0.086, 0.012, [0.0745, 0.238]);
    write("many", 0.086, 0.012, [0.0745, 0.114]);
    for (other, is_beyond) in [("few", false), ("many", true)] {
        let found = json(&desk, &format!("a {other}"));
        let measures = &found["comparisons"][0]["measures"];
        let [cv, formation] = ["cv_10_mm", "formation_10_mm"].map(|name| &measures[name]);
        assert_eq!((&cv["significant"], &formation["significant"]), (&json!(is_beyond), &json!(is_beyond)));
        let distance =
            |of: &Value| of["difference"].as_f64().unwrap().abs() / of["half_width"].as_f64().unwrap();
        assert!((distance(cv) / distance(formation) - 1.0).abs() < 1e-9, "{cv} {formation}");
        let why = cv["remark"].as_str().unwrap_or_default();
        assert_eq!(why.contains("has the 95 % interval 7.45 to 23.8"), !is_beyond, "{cv}");
    }
}
