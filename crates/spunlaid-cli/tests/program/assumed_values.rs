//! `spunlaid web`: what it says of numbers that are assumed values.

use crate::desk::{Desk, FED, success};
use std::fs;

/// Fibres of known numbers on a belt that is faster than half of their feed.
const KNOWN: &str = "
[fibre]
linear_density = \"2 dtex\"
density = \"910 kg/m³\"
[laydown]
sigma_md = \"4 mm\"
sigma_cd = \"4 mm\"
noise = \"15 m^-0.5\"
[line]
throughput = \"0.6 g/min\"
belt_speed = \"30 m/s\"
filaments_per_metre = 2000
[web]
width = \"100 mm\"
length = \"100 mm\"
cell = \"1 mm\"
patches = [\"2 mm\", \"10 mm\"]
assumed = \"line.filaments_per_metre, line.throughput\"
";

/// The CV of half and twice as many filaments at random places is 1.41 and 0.71 times that of the web; half
/// of the throughput cannot be laid, which the terminal, the report and `summary.json` say with the reason.
#[test]
fn analytic_the_sentence_of_assumed_values_has_the_cv_of_each_and_why_one_cannot_be_laid() {
    let desk = Desk::with_case(FED);
    fs::write(desk.path("web.toml"), KNOWN).unwrap();
    let said = success(&mut desk.spunlaid("web web.toml --out w --no-advice"));
    let summary = desk.summary("w");
    let cv_over_10_mm = |patches: &serde_json::Value, cv: &str| {
        let patches = patches.as_array().unwrap();
        patches.iter().find(|patch| patch["patch_m"] == 0.01).unwrap()[cv].as_f64().unwrap()
    };
    let of_web = cv_over_10_mm(&summary["web"]["patches"], "cv");
    let assumed_values = &summary["assumed_values"];
    let values = assumed_values["values"].as_array().unwrap();
    let ratios: Vec<f64> =
        values.iter().map(|value| cv_over_10_mm(&value["patches"], "cv") / of_web).collect();
    let keys: Vec<(&str, f64)> =
        values.iter().map(|value| (value["key"].as_str().unwrap(), value["to"].as_f64().unwrap())).collect();
    assert_eq!(keys[..2], [("line.filaments_per_metre", 1000.0), ("line.filaments_per_metre", 4000.0)]);
    assert_eq!(keys[2..].iter().map(|(key, _)| *key).collect::<Vec<_>>(), ["line.throughput"]);
    assert!(
        (ratios[0] / 2.0_f64.sqrt() - 1.0).abs() < 1e-6 && (ratios[1] / 0.5_f64.sqrt() - 1.0).abs() < 1e-6
    );
    let ranges = &assumed_values["ranges"];
    assert_eq!(cv_over_10_mm(ranges, "cv_to"), ratios[0] * of_web);
    // What cannot be laid, and why.
    let failed = assumed_values["failed"].as_array().unwrap();
    assert_eq!(failed.len(), 1, "{failed:?}");
    let why = failed[0]["why"].as_str().unwrap();
    assert!(why.contains("would tear the fibre"), "{why}");
    let error = 100.0 * cv_over_10_mm(&summary["web"]["patches"], "cv_standard_error");
    let [from, to] = ["cv_from", "cv_to"].map(|end| (100.0 * cv_over_10_mm(ranges, end)).round());
    let patch = &summary["web"]["patches"].as_array().unwrap()[1];
    assert_eq!(
        [&patch["cv_assumed"][0], &patch["cv_assumed"][1]],
        ["cv_from", "cv_to"].map(|end| &ranges[1][end])
    );
    let report = fs::read_to_string(desk.path("w/report.html")).unwrap();
    for text in [said, report] {
        let text = text.replace(['\u{a0}', '\u{202f}', '\u{2009}'], " ");
        for part in [
            // The headline says both, and no basis weight, which is an input.
            &format!("CV at least {:.1} ± {error:.1} % over 10 mm patches", 100.0 * of_web),
            &format!(
                " patches; {from} to {to} % with the assumed values; the filaments are independent of each"
            ),
            "The error excludes these assumed values",
            &format!("the CV over patches of 10 mm lies between {from} and {to} %"),
            "Filaments per metre: 1000",
            "Half of the throughput of a hole, 0.3 g/min, cannot be laid: ",
            "would tear the fibre",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
    }
}
