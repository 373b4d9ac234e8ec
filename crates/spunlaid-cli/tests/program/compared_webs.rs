//! `spunlaid compare` of webs: their pictures, curves and spectra beside each other, and what stands where a
//! verdict is missing.

use crate::desk::{Desk, names, success};
use crate::scan::{desk, map, number, scan};
use serde_json::Value;
use std::fs;
use std::fs::File;

/// A laid web of 100 by 150 mm in cells of 0.5 mm, and the scan of a piece of it, 60 by 80 mm, in pixels of 0.25 mm.
fn laid_and_scanned() -> Desk {
    let desk = desk();
    success(&mut desk.spunlaid("web web.toml --no-advice --out laid --quiet"));
    let laid = map(&desk, "laid");
    let piece: Vec<f64> = (0..320)
        .flat_map(|row| (0..240).map(move |column| row / 2 * 200 + column / 2))
        .map(|cell| laid[cell])
        .collect();
    scan(&desk, "scan.png", 240, &piece);
    let command =
        "analyse scan.png --pixel 0.25mm --white 60000 --keep-shading --patches 0.25mm,2mm,4mm,10mm,30mm";
    success(&mut desk.spunlaid(&format!("{command} --out scan --quiet")));
    desk
}

fn compared(desk: &Desk, arguments: &str) -> Value {
    success(&mut desk.spunlaid(&format!("compare {arguments} --out both --force --quiet")));
    serde_json::from_slice(&desk.read("both/comparison.json")).unwrap()
}

/// Width, height and grey levels of a picture of the comparison.
fn picture(desk: &Desk, number: usize) -> (u32, u32, Vec<u8>) {
    let file = File::open(desk.path(&format!("both/figures/web_picture_{number}.png"))).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut levels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut levels).unwrap();
    let (width, height) = reader.info().size();
    (width, height, levels)
}

fn page(desk: &Desk) -> String {
    String::from_utf8(desk.read("both/report.html")).unwrap()
}

#[test]
fn a_scan_and_a_web_are_seen_at_one_scale_and_in_one_chart_in_either_order() {
    let desk = laid_and_scanned();
    for order in ["scan laid", "laid scan"] {
        let found = compared(&desk, order);
        // The smaller sheet in the larger cells.
        let pictures = [1, 2].map(|number| picture(&desk, number));
        assert!(pictures.iter().all(|(width, height, _)| (*width, *height) == (120, 160)), "{order}");
        // The means are the same grey, and no shade is used up.
        for (.., levels) in &pictures {
            let mean = levels.iter().map(|level| f64::from(*level)).sum::<f64>() / levels.len() as f64;
            assert!((mean - 128.0).abs() < 3.0, "{order}: {mean}");
        }
        let page = page(&desk);
        assert_eq!(page.matches("<img src=\"data:image/png;base64,").count(), 2);
        for part in
            ["60\u{202f}mm across and 80\u{202f}mm along", "A pixel is 0.5\u{202f}mm wide", "width: 33.33"]
        {
            assert!(page.contains(part), "{order}: {part}");
        }
        let spectra = String::from_utf8(desk.read("both/figures/web_spectrum.csv")).unwrap();
        for series in ["\"scan, machine direction\"", "\"laid, cross direction\""] {
            assert!(spectra.contains(series), "{spectra}");
        }
        assert!(page.contains("below the blur of the scan"));
        // Intervals in the table, where there are some.
        let curves = String::from_utf8(desk.read("both/figures/web_cv.csv")).unwrap();
        assert!(curves.starts_with("series,patch_mm,") && curves.contains("lower,upper"), "{curves}");
        let patch = desk.summary("scan")["web"]["patches"][3].take();
        let high = format!("{}", 100.0 * number(&patch["cv_interval"][1]));
        assert!(curves.contains(&high[..8]), "{high}: {curves}");
        // No verdict, and why.
        let measures = &found["comparisons"][0]["measures"];
        for (column, reason) in [
            ("cv_0.25_mm", "smaller than a cell of the map (laid)"),
            ("cv_2_mm", "below the blur of the scan (scan)"),
            ("cv_30_mm", "the sheet holds too few such patches (scan)"),
            ("cloudiness", "waves of 5 mm are below the blur of the scan (scan)"),
            ("texture_md", "in waves of 4 to 16 cells, and the cells are"),
        ] {
            let measure = &measures[column];
            let expected = measure["no_verdict"].as_str().unwrap();
            assert!(
                expected.contains(reason) && measure["significant"].is_null(),
                "{order}, {column}: {expected}"
            );
            assert!(page.contains(reason), "{column}");
        }
        assert!(
            measures["cv_10_mm"]["significant"].is_boolean()
                && measures["cv_10_mm"].get("no_verdict").is_none()
        );
        assert!(found.get("notes").is_none(), "{found}");
    }
}

#[test]
#[ignore = "slow: two scans and two webs"]
fn two_scans_and_two_webs_are_seen_beside_each_other() {
    let desk = laid_and_scanned();
    success(&mut desk.spunlaid("analyse laid/map.png --patches 2mm,4mm,10mm --out gauge --quiet"));
    let web = fs::read_to_string(desk.path("web.toml")).unwrap();
    fs::write(desk.path("other.toml"), web.replace("noise = \"20", "noise = \"40")).unwrap();
    success(&mut desk.spunlaid("web other.toml --no-advice --out other --quiet"));
    for (order, size, count) in
        [("scan gauge", (120, 160), 2), ("laid other", (200, 300), 2), ("laid other scan", (120, 160), 3)]
    {
        compared(&desk, order);
        for number in 1..=count {
            let (width, height, _) = picture(&desk, number);
            assert_eq!((width, height), size, "{order}");
        }
        let spectra = String::from_utf8(desk.read("both/figures/web_spectrum.csv")).unwrap();
        for name in order.split(' ') {
            assert!(spectra.contains(&format!("\"{name}, cross direction\"")), "{order}: {spectra}");
        }
    }
    // A web beside its own map: the same picture, in the same shades.
    compared(&desk, "laid gauge");
    let [one, other] = [1, 2].map(|number| picture(&desk, number).2);
    assert!(one.iter().zip(&other).all(|(a, b)| a.abs_diff(*b) <= 1));
    assert!(one.iter().max() > one.iter().min());
}

#[test]
fn a_folder_without_its_map_is_compared_without_a_picture() {
    let desk = laid_and_scanned();
    fs::remove_file(desk.path("laid/map.npy")).unwrap();
    let said = success(&mut desk.spunlaid("compare laid scan --out both --force"));
    assert!(said.contains("CV over patches of 10 mm"), "{said}");
    let found: Value = serde_json::from_slice(&desk.read("both/comparison.json")).unwrap();
    let note = "laid has neither picture nor spectrum here: there is no map.npy";
    assert!(found["notes"][0].as_str().unwrap().starts_with(note), "{found}");
    assert!(page(&desk).contains(note));
    // That of the other is still there.
    let figures = ["web_cv", "web_spectrum"]
        .into_iter()
        .flat_map(|name| ["csv", "png", "svg"].map(|end| format!("{name}.{end}")));
    let figures: Vec<String> = figures.chain(["web_picture_1.png".to_owned()]).collect();
    assert_eq!(desk.entries("both/figures"), names(&figures.iter().map(String::as_str).collect::<Vec<_>>()));
    assert!(page(&desk).contains("alt=\"scan in transmitted light\""));
    // A map of other cells than the summary reports of.
    fs::copy(desk.path("scan/map.npy"), desk.path("laid/map.npy")).unwrap();
    let found = compared(&desk, "laid scan");
    let notes = found["notes"].to_string();
    assert!(notes.contains("laid: its map.npy is not the map of 200 × 300 cells"), "{notes}");
    // Without any map there are no pictures, and what the blur forbids stays forbidden.
    for folder in ["laid", "scan"] {
        fs::remove_file(desk.path(&format!("{folder}/map.npy"))).unwrap();
    }
    let found = compared(&desk, "laid scan");
    assert_eq!(desk.entries("both/figures"), names(&["web_cv.csv", "web_cv.png", "web_cv.svg"]));
    assert!(
        !page(&desk).contains("Pictures at the same scale") && found["notes"].as_array().unwrap().len() == 2
    );
    let cloudiness = &found["comparisons"][0]["measures"]["cloudiness"]["no_verdict"];
    assert_eq!(cloudiness, "waves of 5 mm are below the blur of the scan (scan)");
}

/// A scan and the file of a line, in one step: the one is analysed, the other laid, and what one cannot know of the
/// lamp stands in the first line.
#[test]
#[ignore = "slow: a scan and a web, twice, with the results of both"]
fn my_scan_is_compared_with_my_line_in_one_step() {
    let desk = desk();
    let picture = concat!(env!("CARGO_MANIFEST_DIR"), "/../spunlaid/tests/scan_fixtures/web.png");
    fs::copy(picture, desk.path("scan.png")).unwrap();
    let said = success(&mut desk.spunlaid("compare scan.png web.toml"));
    let expected = "web_simulated against scan_analysed: what differs is not known: the level of the lamp is an \
         assumed value";
    assert!(said.contains(expected), "{said}");
    for folder in
        ["results/scan_analysed", "results/web_simulated", "results/scan_analysed_against_web_simulated"]
    {
        assert!(desk.path(folder).join("report.html").is_file(), "{folder}");
    }
    // What stands in the folders is compared as well, and with the same words; a second time the same is made.
    let again = success(&mut desk.spunlaid("compare results/scan_analysed web.toml"));
    assert!(again.contains(expected), "{again}");
    let quiet = success(&mut desk.spunlaid("compare scan.png web.toml --json"));
    assert!(serde_json::from_str::<Value>(&quiet).is_ok(), "{quiet}");
}

/// A line whose holes stand in rows, with a hole that is blocked, with a pack a tenth thicker and with neither: its map
/// is analysed as a scan, and the line says which of its parts makes such a streak.
#[test]
fn the_line_says_where_the_streaks_of_a_scan_come_from() {
    let desk = desk();
    let web = fs::read_to_string(desk.path("web.toml")).unwrap();
    let rows = "rows = [{ pitch = \"2.5 mm\", filaments = 160 }]\n";
    let web =
        web.replace("filaments_per_metre = 5000\n", rows).replace("0.5 mm", "2 mm").replace("\"2 mm\", ", "");
    let web = web.replace("\"100 mm\"", "\"400 mm\"").replace("\"150 mm\"", "\"1.2 m\"");
    for (defect, cause) in [
        ("defects = [{ from = \"150 mm\" }]", Some("blocked_hole")),
        ("defects = [{ from = \"200 mm\", to = \"240 mm\", titre = 1.1 }]", Some("pack")),
        ("", None),
    ] {
        fs::write(desk.path("line.toml"), web.replace(rows, &format!("{rows}{defect}\n"))).unwrap();
        success(&mut desk.spunlaid("web line.toml --no-advice --out laid --force --quiet"));
        let said = success(&mut desk.spunlaid("analyse laid/map.png --patches 4mm,10mm --out gauge --force"));
        let scan = desk.summary("gauge")["scan"].take();
        let streaks = scan["streaks"].as_array().unwrap();
        assert_eq!(streaks.is_empty(), cause.is_none(), "{scan}");
        assert!(
            said.contains(if cause.is_some() { "streak is significant" } else { "no streak is" }),
            "{said}"
        );
        assert!(desk.path("gauge/figures/web_streaks.csv").is_file());
        for order in [&["laid gauge"][..], &["gauge laid", "laid gauge"]][usize::from(cause == Some("pack"))]
        {
            let found = compared(&desk, order)["comparisons"][0]["streaks"].take();
            let of = |key: &str| found.as_array().unwrap().iter().find(|one| one.get(key).is_some());
            // One hole of 400 in a metre, over the width of a filament.
            let hole = of("dip_of_one_hole").unwrap();
            let dip = number(&hole["dip_of_one_hole"]);
            assert!((dip * 400.0 * (2.0 * std::f64::consts::PI).sqrt() * 5e-3 - 1.0).abs() < 1e-9);
            assert!(number(&of("pitch_m").unwrap()["left"]) < 1e-30, "{found}");
            let Some(cause) = cause else {
                assert!(of("streak_at_m").is_none(), "{found}");
                continue;
            };
            let streak = &of("streak_at_m").unwrap()["layers"][0];
            assert_eq!(streak["cause"], cause, "{found}");
            assert_eq!(of("defect_at_m").unwrap()["like_streaks"], 1, "{found}");
            if cause == "pack" {
                // 17 holes that feed a tenth more each.
                let holes = number(&streak["holes"]);
                assert!((holes - 1.7).abs() < 0.4, "{found}");
            }
            if cause == "blocked_hole" {
                let [holes, off] = ["holes", "holes_standard_error"].map(|key| number(&streak[key]));
                assert!((holes + 1.0).abs() < 3.0 * off && off < 0.5, "{found}");
            }
            assert!(page(&desk).contains("Where the streaks may come from"));
        }
    }
}
