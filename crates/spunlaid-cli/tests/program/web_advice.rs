//! `spunlaid web`: what it says would make a web more even, and that each piece of advice can be pasted.

use super::web::{BEAMS, desk};
use crate::desk::{self, success};
use std::fs;

/// The best change, as the terminal says it: a row below the last heading.
fn first_change(said: &str) -> &str {
    let (_, rows) = said.rsplit_once("\nChange first\n").unwrap_or_else(|| panic!("{said}"));
    rows.lines().next().unwrap()
}

/// The same numbers, whatever the folder of the web is called.
fn without_commands(mut advice: serde_json::Value) -> serde_json::Value {
    for change in advice["changes"].as_array_mut().unwrap() {
        change.as_object_mut().unwrap().remove("command").unwrap();
    }
    advice
}

/// What is reported is that of the terminal and of the report; a setting that costs throughput says so.
#[test]
fn a_web_says_which_settings_of_the_line_would_make_it_more_even() {
    let desk = desk();
    fs::write(desk.path("beams.toml"), BEAMS).unwrap();
    let said = desk::success(&mut desk.spunlaid("web beams.toml --out w"));
    let named = first_change(&said);
    assert!(said.contains("\ntrying 12 changes of the line took "), "{said}");
    let page = String::from_utf8(desk.read("w/report.html")).unwrap();
    // The terminal has plain blanks.
    let (name, _) = named.trim().split_once("  ").unwrap();
    assert!(page.replace(['\u{202f}', '\u{a0}'], " ").contains(name), "{name}");
    let advice = desk.summary("w")["advice"].clone();
    let changes = advice["changes"].as_array().unwrap();
    assert_eq!(changes.len(), 12);
    let place = |change: &serde_json::Value| {
        change["patches"].as_array().unwrap().iter().find(|patch| patch["patch_m"] == 0.005).unwrap().clone()
    };
    let number = |of: &serde_json::Value| of.as_f64().unwrap();
    // 5 mm is nearest to what the eye judges first: the first setting that is named is the one that lowers
    // this CV most.
    let lowers = |change: &&serde_json::Value| place(change)["significant"] == true;
    let by = |change: &&serde_json::Value| number(&place(change)["cv_change"]);
    let best = changes.iter().filter(lowers).min_by(|a, b| by(a).total_cmp(&by(b))).unwrap();
    let layer = format!(" of layer S{}", best["layer"]);
    let setting = best["setting"].as_str().unwrap().replace("throughput", "throughput per hole");
    assert!(named.contains(&format!("{setting}{layer}, ")), "{named} {best}");
    let cost = number(&best["throughput_change"]);
    assert_eq!(named.contains("the same throughput"), cost.abs() < 1e-4, "{named} {best}");
    for change in changes {
        let key = &change["keys"][0];
        let command = change["command"].as_str().unwrap();
        let escaped = [("&", "&#38;"), ("'", "&#39;"), ("\"", "&#34;"), ("<", "&#60;"), (">", "&#62;")]
            .iter()
            .fold(command.to_owned(), |text, (sign, escaped)| text.replace(sign, escaped));
        assert!(page.contains(&format!("<code>{escaped}</code>")), "{command}");
        // A fifth less or more, of what can be written in the file.
        assert!(((number(&key["to"]) / number(&key["from"]) - 1.0).abs() - 0.2).abs() < 1e-3, "{change}");
        // The same weight on the belt, of which advice gives five digits.
        let belt = number(&change["belt_speed_m_s"]) / 5.0;
        assert!((belt / (1.0 + number(&change["throughput_change"])) - 1.0).abs() < 5e-5, "{change}");
    }

    desk::success(&mut desk.spunlaid("web beams.toml --out one --threads 1 --quiet"));
    // Commands lay each web beside the one that they change.
    let advice = without_commands(advice);
    assert_eq!(without_commands(desk.summary("one")["advice"].take()), advice);
    let said = desk::success(&mut desk.spunlaid("web beams.toml --out without --no-advice"));
    assert!(said.contains("more uniform was not computed") && !said.contains("trying"), "{said}");
    assert!(desk.summary("without").get("advice").is_none());

    // Judged by other patches, the numbers are the same.
    let said = desk::success(&mut desk.spunlaid("web beams.toml --out other --for 20mm"));
    let (_, change) = said.rsplit_once("\nChange first\n").unwrap();
    assert!(change.contains("over patches of 20 mm, of 12 changes"), "{change}");
    let other = without_commands(desk.summary("other")["advice"].take());
    assert_eq!((&other["judged_by_patch_m"], &advice["judged_by_patch_m"]), (&0.02.into(), &0.005.into()));
    assert_eq!(other["changes"], advice["changes"]);
    let figure =
        |folder: &str| String::from_utf8(desk.read(&format!("{folder}/figures/web_advice.svg"))).unwrap();
    assert!(
        figure("w").contains("over patches of 5 mm") && figure("other").contains("over patches of 20 mm")
    );
}

/// The keys of the case that a web flies are set by the same names as in a study; the folder holds the case
/// as it was simulated, so that the web can be laid again from there, to the same map. Each piece of advice is a
/// command that the program takes.
#[test]
#[ignore = "slow: advice on a web in shared turbulence"]
fn keys_of_the_flown_case_are_set_and_advice_can_be_pasted() {
    let desk = desk();
    let small = ["--set", "web.width=0.2 m", "--set", "web.length=0.05 m", "--set", "web.simulated=250"];
    let of_case =
        ["--set", "belt.distance=0.3 m", "--set", "fibre.linear_density=2 dtex", "--set", "run.replicates=2"];
    let of_case = [&of_case[..], &["--set", "run.duration=0.1 s"]].concat();
    success(desk.spunlaid("web web.toml --out w --advice --quiet").args(small).args(of_case));
    let summary = desk.summary("w");
    let titre = summary["layers"][0]["linear_density_kg_m"].as_f64().unwrap();
    assert!((titre / 2e-7 - 1.0).abs() < 1e-9, "{titre}");
    let case = String::from_utf8(desk.read("w/web.toml")).unwrap();
    assert!(case.contains("distance = \"0.3 m\"") && case.contains("replicates = 2"), "{case}");
    success(&mut desk.spunlaid("web w/web.toml --out again --no-advice --quiet"));
    assert_eq!(desk.read("w/map.npy"), desk.read("again/map.npy"));
    let changes = summary["advice"]["changes"].as_array().unwrap();
    assert!(changes.len() >= 8, "{changes:?}");
    for change in changes {
        let command = change["command"].as_str().unwrap();
        let (pasted, _) = command.strip_prefix("spunlaid web ").unwrap().split_once(" --out ").unwrap();
        // The words between single quotes are one.
        let words = pasted.split('\'').enumerate().flat_map(|(i, part)| match i % 2 {
            0 => part.split_whitespace().map(str::to_owned).collect::<Vec<_>>(),
            _ => vec![part.to_owned()],
        });
        let words: Vec<String> = words.collect();
        // `20 g/m² on a belt of 2.083 m/s: 150 kg/h from each metre of width`.
        let said = success(desk.spunlaid("check").args(words));
        let number = |after: &str| -> f64 {
            let found = said.split(after).next().and_then(|before| before.rsplit(' ').next());
            found.and_then(|number| number.parse().ok()).unwrap()
        };
        let wanted = 1e3 * summary["layers"][0]["basis_weight_kg_m2"].as_f64().unwrap();
        assert!((number(" g/m² on a belt") / wanted - 1.0).abs() < 1e-3, "{command}: {said}");
        let wanted = change["throughput_kg_h_m"].as_f64().unwrap();
        assert!((number(" kg/h from each metre") / wanted - 1.0).abs() < 1e-3, "{command}: {said}");
    }
}
