//! The page holds what it should, safely and small.

use super::run_report;
use crate::files::origin::Performance;
use crate::reports::run::figures::run_figures;
use crate::reports::run::sample;
use crate::reports::spinline::figures::{SPINLINE, spinline_figures};
use crate::reports::spinline::files::SpinResults;
use crate::reports::spinline::report::spinline_report;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use spunlaid_fibre::{Case, FrictionLaw};
use spunlaid_input::read_spinline;
use spunlaid_simulation::{FinerChecks, Results, Unchecked};

/// What a run cost.
const PERFORMANCE: Performance = Performance {
    wall_s: 1.0,
    threads: 2,
    element_steps: Some(370_000_000),
    ns_per_element_step: Some(5.4),
    instruction_set: "AVX-512",
    flights_s: None,
    flights_in_parallel_s: None,
};

/// Largest size of a page [bytes].
const MOST: usize = 6_000_000;

fn page(case: &Case, results: &Results, name: &str, notes: &[String], case_toml: &str) -> String {
    let figures = run_figures(case, results, &sample::turbulence());
    let checks = FinerChecks::none(Unchecked::TooShort);
    let report = run_report(case, case_toml, results, &checks, &figures, None, PERFORMANCE);
    report.expect("shapes in memory").named(name).noting(notes).html()
}

/// Fails unless every element that is opened is closed, in order.
fn check_well_formed(html: &str) {
    let mut open: Vec<String> = Vec::new();
    let mut rest = html.strip_prefix("<!doctype html>").expect("a doctype");
    while let Some(start) = rest.find('<') {
        let end = start + rest[start..].find('>').expect("a closed tag");
        let tag = &rest[start + 1..end];
        rest = &rest[end + 1..];
        let name = tag.trim_start_matches('/').split([' ', '\n', '/']).next().unwrap_or_default().to_owned();
        let void = matches!(name.as_str(), "br" | "meta" | "input" | "rect" | "path" | "circle");
        if tag.starts_with('/') {
            assert_eq!(open.pop().as_deref(), Some(name.as_str()), "before {:.80}", rest);
        } else if name == "script" || name == "style" {
            let close = format!("</{name}>");
            rest = &rest[rest.find(&close).expect("an end") + close.len()..];
        } else if !tag.ends_with('/') && !void {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "{open:?} are not closed");
}

/// What stands between two pieces of a text.
fn between<'a>(text: &'a str, before: &str, after: &str) -> &'a str {
    text.split_once(before).unwrap().1.split_once(after).unwrap().0
}

#[test]
fn the_methods_have_program_models_and_what_to_cite() {
    let mut case = sample::case(20, 1001, 10);
    case.run.seed = 4711;
    case.drag.along = FrictionLaw::Sakiadis;
    let results = sample::results(&case, 0.01);
    let page = page(&case, &results, "case", &[], "version = 1");
    let plain = |text: &str| text.replace(['\u{202f}', '\u{a0}'], " ");
    let text = plain(between(&page, "<div id=\"methods-text\">", "</div>"));
    for part in [
        "spunlaid 0.1.0 (spunlaid run)",
        "by the models of Battocchio, Sutcliffe and Teschner 2015; Sakiadis 1961",
        "The complete input is case.toml of the results",
        "Battocchio, M. P. F. Sutcliffe, F. Teschner: Fibre behaviour in the spunbonding process. Part II",
        "B. C. Sakiadis: Boundary-layer behavior",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert!(!text.contains("Matsui") && text.matches("Part II").count() == 1, "{text}");
}

#[test]
fn is_well_formed_and_small_for_runs_of_any_size() {
    for (elements, instants, replicates) in
        [(1, 1, 1), (1, 2, 1), (20, 10_001, 8), (20_000, 30, 1), (300, 500, 2)]
    {
        let case = sample::case(elements, instants, replicates);
        let page = page(&case, &sample::results(&case, 0.01), "case", &[], "version = 1");
        assert!(page.len() < MOST, "{elements} elements, {instants} instants: {} bytes", page.len());
        let positions = page.find("\"positions\":\"").expect("shapes");
        let after = positions + page[positions..].find("\"}").expect("their end");
        assert!(
            !page[..positions].contains("NaN") && !page[after..].contains("NaN"),
            "{elements}, {instants}"
        );
        check_well_formed(&page);
    }
}

#[test]
fn shows_any_motion() {
    for amplitude in [0.0, 1e-300, f64::NAN] {
        let case = sample::case(4, 50, 2);
        check_well_formed(&page(&case, &sample::results(&case, amplitude), "case", &[], ""));
    }
    let case = sample::case(4, 50, 2);
    let mut results = sample::results(&case, 0.01);
    results.trajectories.clear();
    let page = page(&case, &results, "case", &[], "");
    check_well_formed(&page);
    assert!(page.contains("No shapes of the fibre were kept"));
}

#[test]
fn escapes_what_the_user_wrote() {
    let evil = "</pre><script>alert('x')</script>&\"{{ name }}";
    let case = sample::case(4, 50, 2);
    let page = page(&case, &sample::results(&case, 0.01), evil, &[evil.to_owned()], evil);
    assert!(!page.contains("<script>alert") && !page.contains("</pre><script"));
    assert!(page.contains("&lt;script&gt;alert") || page.contains("&#60;script&#62;alert"));
    check_well_formed(&page);
}

#[test]
fn asks_nothing_of_the_network() {
    let case = sample::case(4, 50, 2);
    let page = page(&case, &sample::results(&case, 0.01), "case", &[], "");
    for word in ["src=\"", "href=\"", "@import", "url(http", "fetch(", "XMLHttpRequest", "import("] {
        assert!(!page.contains(word), "{word}");
    }
    // The name of SVG itself is the only address.
    assert_eq!(page.matches("http").count(), page.matches("http://www.w3.org/2000/svg").count());
}

#[test]
fn says_the_result_first() {
    let case = sample::case(4, 50, 3);
    let page = page(&case, &sample::results(&case, 0.01), "case", &[], "");
    assert!(page.contains(
        "<h1>Amplitude of the free end: 10\u{202f}mm in y and 10.100\u{a0}±\u{a0}0.058\u{202f}mm in z"
    ));
}

#[test]
fn holds_the_shapes() {
    let case = sample::case(4, 50, 2);
    let results = sample::results(&case, 0.01);
    let frames = super::frames::pack(&case, &results).expect("shapes in memory").expect("shapes were kept");
    let packed =
        frames.json.split("\"positions\":\"").nth(1).and_then(|t| t.strip_suffix("\"}")).expect("positions");
    let bytes = STANDARD.decode(packed).expect("base64");
    assert_eq!(bytes.len(), 2 * 50 * 5 * 3 * 2);
    let list = |key: &str| -> Vec<f64> {
        let start = frames.json.split(&format!("\"{key}\":[")).nth(1).expect("the key");
        start.split(']').next().unwrap_or_default().split(',').map(|v| v.parse().expect("a number")).collect()
    };
    let (origin, step) = (list("origin_mm"), list("step_mm"));
    let end = results.trajectories[1].shapes.last().expect("a shape").position[4];
    for (k, expected) in [end.x, end.y, end.z].into_iter().enumerate() {
        let at = bytes.len() - 6 + 2 * k;
        let level = f64::from(u16::from_le_bytes([bytes[at], bytes[at + 1]]));
        // To half a level, and the rounding of the written numbers.
        assert!((origin[k] + level * step[k] - expected * 1e3).abs() <= 0.5 * step[k] + 1e-6);
    }
    assert_eq!(list("times").len(), 50);
}

#[test]
fn shows_a_stretch_of_a_run_too_long_to_follow() {
    // 20 s of 17 Hz: at 1/16 of a swing per instant more than fit.
    let case = sample::case(200, 20_001, 1);
    let frames = super::frames::pack(&case, &sample::results(&case, 0.01))
        .expect("shapes in memory")
        .expect("shapes were kept");
    assert!(
        frames.remarks.iter().any(|r| r.starts_with("The animation shows the last ")),
        "{:?}",
        frames.remarks
    );
    assert!(frames.remarks.iter().any(|r| r.starts_with("101 of 201 nodes")), "{:?}", frames.remarks);
}

#[test]
fn a_fed_fibre_is_shown_above_its_belt() {
    for (instants, replicates) in [(1, 1), (20, 2), (300, 8), (5000, 1)] {
        let case = sample::fed_case(instants, replicates);
        let page = page(&case, &sample::fed_results(&case, 8), "case", &[], "");
        assert!(page.len() < MOST, "{instants} instants: {} bytes", page.len());
        check_well_formed(&page);
        assert!(page.contains("<h1>The fibre lies ") && page.contains("is fed at 50\u{202f}m/s"));
        // 50 µm at 50 m/s: d √(E/ρ)/(4v).
        assert!(
            page.contains("the fibre itself folds at a scale of 0.36\u{202f}mm")
                || page.contains("360\u{202f}µm")
        );
        assert!(page.contains("depends on the mesh"));
    }
}

#[test]
fn nodes_of_a_fed_fibre_keep_their_numbers() {
    let case = sample::fed_case(300, 2);
    let results = sample::fed_results(&case, 8);
    let frames = super::frames::pack(&case, &results).expect("shapes in memory").expect("shapes were kept");
    let data: serde_json::Value = serde_json::from_str(&frames.json).expect("JSON");
    let list = |value: &serde_json::Value| -> Vec<f64> {
        value.as_array().expect("a list").iter().map(|v| v.as_f64().expect("a number")).collect()
    };
    let belt = &data["belt"];
    let (newest, times) = (list(&belt["newest"]), list(&data["times"]));
    let counts: Vec<Vec<f64>> = belt["counts"].as_array().expect("counts").iter().map(list).collect();
    let decode = |value: &serde_json::Value| STANDARD.decode(value.as_str().expect("text")).expect("base64");
    let bytes = decode(&data["positions"]);
    let all: f64 = counts.iter().flatten().sum();
    assert_eq!(bytes.len(), 6 * all as usize);
    let (origin, step) = (list(&data["origin_mm"]), list(&data["step_mm"]));
    let last = times.len() - 1;
    // The newest node of the last instant of the second replicate was fed two elements ago and is numbered so.
    assert_eq!(newest[last], (times[last] * 50.0 / 0.005).round() + 2.0);
    // What was laid last goes on where the oldest node is, one element further down the belt.
    let points = decode(&belt["laid"][1]["points"]);
    let oldest = newest[last] - counts[1][last] + 1.0;
    let index = oldest - 1.0 - belt["laid"][1]["first"].as_f64().expect("a number");
    let number = |i: usize| f32::from_le_bytes(points[4 * i..4 * i + 4].try_into().expect("four bytes"));
    let level = |k: usize| {
        let at = bytes.len() - 6 + 2 * k;
        origin[k] + step[k] * f64::from(u16::from_le_bytes([bytes[at], bytes[at + 1]]))
    };
    let run = 3.0 * times[last] * 1e3;
    let dy = level(1) - (f64::from(number(2 * index as usize)) + run);
    let dz = level(2) - f64::from(number(2 * index as usize + 1));
    // An element of 5 mm on a circle, and the 0.3 mm that the belt runs meanwhile.
    assert!(dy.hypot(dz) < 5.4 && dy.hypot(dz) > 4.0, "{dy}, {dz}");
}

/// The page of a spinline of polypropylene, with these lines more.
fn spin_page(lines: &str, name: &str) -> String {
    let text = format!(
        "[spinline]\npolymer = \"pp\"\nmelt_flow_rate = 35\ndie_temperature = \"230 °C\"\nhole_diameter = \"0.6 mm\"\n\
         throughput = \"0.5 g/min\"\nlength = \"1.2 m\"\nvelocity = \"50 m/s\"\ncross_velocity = \"0.5 m/s\"\n{lines}"
    );
    let file = read_spinline((&text, "line.toml"), &[]).unwrap();
    let results = SpinResults::new(&file).unwrap();
    let figures = spinline_figures(SPINLINE, &results.rows, &results.influences);
    let report = spinline_report(&file.spec, &results, &figures, name);
    report.named(name).noting(&[name.to_owned()]).html()
}

#[test]
fn the_page_of_any_spinline_is_well_formed_and_says_what_is_not_known() {
    for lines in [
        "",
        "crystallisation = true\n",
        "rows = 3\nfilaments_per_metre_and_row = 100\n",
        "law = \"giesekus\"\n",
        "end = \"take-up\"\ntake_up_speed = \"30 m/s\"\nlaw = \"ptt\"\n",
    ] {
        let page = spin_page(lines, "line");
        check_well_formed(&page);
        assert!(page.len() < 1_000_000, "{} bytes", page.len());
        assert!(!page.contains("NaN"), "{lines}");
        assert!(page.contains("<h1>A filament of "), "{lines}");
        for sentence in [
            "no diameter that it gives has been compared with a measured one",
            "The birefringence of polypropylene is 3 to 5 times too low",
        ] {
            assert!(page.contains(sentence), "{lines}: {sentence}");
        }
        assert_eq!(page.matches("http").count(), page.matches("http://www.w3.org/2000/svg").count());
    }
    assert!(spin_page("crystallisation = true\n", "line").contains("figure-spinline_transformed"));
    let evil = "</pre><script>alert('x')</script>&\"{{ name }}";
    let page = spin_page("", evil);
    assert!(!page.contains("<script>alert") && !page.contains("</pre><script"));
    check_well_formed(&page);
}

#[test]
fn the_report_of_a_run_shows_its_spinline() {
    let file = read_spinline(
        (
            "[spinline]\npolymer = \"pet\"\ndie_temperature = \"290 °C\"\nhole_diameter = \"0.3 mm\"\n\
        throughput = \"1.5 g/min\"\nlength = \"2 m\"\ncross_velocity = \"0.3 m/s\"\nend = \"take-up\"\n\
        take_up_speed = \"50 m/s\"\n",
            "line.toml",
        ),
        &[],
    )
    .unwrap();
    let results = SpinResults::new(&file).unwrap();
    let figures = spinline_figures(SPINLINE, &results.rows, &results.influences);
    let mut case = sample::case(4, 50, 2);
    let simulated = sample::results(&case, 0.01);
    let shown = |case: &Case| {
        let checks = FinerChecks::none(Unchecked::TooShort);
        let spinline = Some((&results, &figures[..]));
        run_report(case, "", &simulated, &checks, &[], spinline, PERFORMANCE).unwrap().html()
    };
    let page = shown(&case);
    check_well_formed(&page);
    assert!(
        page.contains("figure-spinline_temperature")
            && page.contains("A filament of 21.8\u{202f}µm, 5\u{202f}dtex")
    );
    assert!(!page.contains("estimate of its Young"));
    case.fibre.youngs_modulus = results.rows[0].modulus_estimate;
    assert!(shown(&case).contains("an estimate of its Young"));
}
