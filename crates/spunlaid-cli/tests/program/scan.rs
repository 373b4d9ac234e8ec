//! `spunlaid analyse` of a scanned web, and `spunlaid compare` of it with a laid one.

use crate::desk::{Desk, names, success};
use serde_json::Value;
use std::fs;
use std::fs::File;
use std::io::BufWriter;

/// A web of 100 by 150 mm that is laid in an instant.
const WEB: &str = r#"
[fibre]
diameter = "18 µm"
density = "910 kg/m³"

[laydown]
sigma_md = "5 mm"
sigma_cd = "5 mm"
noise = "20 m^-0.5"

[line]
feed_speed = "50 m/s"
belt_speed = "5 m/s"
filaments_per_metre = 5000

[web]
width = "100 mm"
length = "150 mm"
cell = "0.5 mm"
patches = ["2 mm", "4 mm", "10 mm"]
"#;

pub(crate) fn desk() -> Desk {
    let desk = Desk::new();
    fs::write(desk.path("web.toml"), WEB).unwrap();
    desk
}

/// The numbers of a map, a row after the other, from `map.npy`.
pub(crate) fn map(desk: &Desk, folder: &str) -> Vec<f64> {
    let bytes = desk.read(&format!("{folder}/map.npy"));
    let start = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    bytes[start..].chunks_exact(4).map(|x| f64::from(f32::from_le_bytes(x.try_into().unwrap()))).collect()
}

/// Writes a scan in transmitted light of 16 bits, with an optical density of 0.4 on average and a lamp of 60000.
pub(crate) fn scan(desk: &Desk, name: &str, columns: usize, weights: &[f64]) {
    let mean = weights.iter().sum::<f64>() / weights.len() as f64;
    let level = |weight: &f64| (60_000.0 * (-0.4 * weight / mean).exp()).round() as u16;
    let bytes: Vec<u8> = weights.iter().flat_map(|weight| level(weight).to_be_bytes()).collect();
    let file = BufWriter::new(File::create(desk.path(name)).unwrap());
    let mut encoder = png::Encoder::new(file, columns as u32, (weights.len() / columns) as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    encoder.write_header().unwrap().write_image_data(&bytes).unwrap();
}

pub(crate) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

#[test]
fn a_laid_web_and_its_scan_have_the_same_unevenness() {
    let desk = desk();
    success(&mut desk.spunlaid("web web.toml --no-advice --out laid"));
    let laid = map(&desk, "laid");
    scan(&desk, "scan.png", 200, &laid);
    let command = "analyse scan.png --pixel 0.5mm --white 60000 --keep-shading --patches 2mm,4mm,10mm";
    let said = success(&mut desk.spunlaid(&format!("{command} --weight 18gsm --out scan")));
    assert!(said.contains("along the web, of 18 g/m².") && said.contains("95 % interval"), "{said}");
    assert!(said.contains("open scan/report.html"), "{said}");
    assert_eq!(
        desk.entries("scan"),
        names(&["figures", "map.npy", "origin.toml", "report.html", "summary.json"])
    );
    let [web, found] = ["laid", "scan"].map(|folder| desk.summary(folder)["web"].take());
    assert!((number(&found["basis_weight_kg_m2"]) / 18e-3 - 1.0).abs() < 1e-12);
    assert_eq!((&found["cells"], &found["cell_m"]), (&web["cells"], &web["cell_m"]));
    for i in 0..3 {
        let [a, b] = [&web, &found].map(|summary| &summary["patches"][i]);
        assert_eq!(a["patch_m"], b["patch_m"]);
        // The laid web is closed to a ring; the scan is cut out of it, and its mean is known from itself only.
        let (one, other) = (number(&a["cv"]), number(&b["cv"]));
        let error = number(&found["patches"][2]["cv_standard_error"]) / number(&found["patches"][2]["cv"]);
        assert!((one - other).abs() < error * other, "{a} {b}");
        assert!(b.get("cv_one_fibre").is_none() && number(&b["blur_of_a_pixel"]) > 0.0, "{b}");
    }
    // Four pixels are not above the blur of whatever camera; twenty are.
    let [small, large] = [&found["patches"][0], &found["patches"][2]];
    assert_eq!(small["no_interval"], "below the blur of the scan");
    assert!(small["cv_standard_error"].is_null() && small.get("cv_interval").is_none(), "{small}");
    assert!(
        number(&large["cv_interval"][0]) < number(&large["cv"]) && large.get("no_interval").is_none(),
        "{large}"
    );
    // The map is the laid one, but for its mean and the 16 bits of the picture.
    let mean = laid.iter().sum::<f64>() / laid.len() as f64;
    let far =
        map(&desk, "scan").iter().zip(&laid).map(|(a, b)| (a / 18e-3 - b / mean).abs()).fold(0.0, f64::max);
    assert!(far < 1e-3, "{far}");
    let page = String::from_utf8(desk.read("scan/report.html")).unwrap();
    for part in [
        "along the web, of 18",
        "spunlaid analyse · scan",
        "The scan",
        "Lost by one more pixel of blur",
        "Texture along",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("id=\"fibres\""));

    // Its fabric, as far as a map reports it.
    let fabric = desk.summary("scan")["fabric"].take();
    assert!(fabric["patches"][2]["lighter_than_80_percent_per_m2"].is_object(), "{fabric}");
    assert!(fabric.get("bare_area").is_none() && fabric["patches"][2].get("formation").is_none());
    assert_eq!(fabric["notes"].as_array().unwrap().len(), 1, "{fabric}");
    assert!(said.contains("Defects per area\n") && said.contains("a scan does not show"), "{said}");
    success(&mut desk.spunlaid(&format!("{command} --weight 15gsm --titre 2.3dtex --out known")));
    let of_10_mm = |folder: &str| desk.summary(folder)["fabric"]["patches"][3]["formation"].take();
    let [one, other] = [of_10_mm("laid"), of_10_mm("known")];
    // The same web, of nearly this weight and titre.
    assert!((number(&one["value"]) / number(&other["value"]) - 1.0).abs() < 0.3, "{one} {other}");

    // A picture that lies on its side, without its weight.
    let turned: Vec<f64> = (0..laid.len()).map(|i| laid[i % 300 * 200 + i / 300]).collect();
    scan(&desk, "turned.png", 300, &turned);
    let json =
        success(&mut desk.spunlaid(&format!("{command} --md rows --json").replace("scan.png", "turned.png")));
    let json: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["web"]["patches"], found["patches"]);
    assert!(json["web"]["basis_weight_kg_m2"].is_null());
    let is_reported = |what: &str| {
        json["notes"].as_array().unwrap().iter().any(|note| note.as_str().unwrap().contains(what))
    };
    assert!(
        is_reported("mean basis weight is not known") && is_reported("taken as light that has come through"),
        "{json}"
    );
    assert!(desk.path("results/turned/report.html").exists());

    // Both beside each other.
    let said = success(&mut desk.spunlaid("compare laid scan --out both"));
    assert!(
        said.contains(
            "scan against laid\nCompared as independent pieces of web; basis weight 18 g/m² against "
        ),
        "{said}"
    );
    assert!(said.contains("CV over patches of 10 mm") && said.contains(" 0 of "), "{said}");
    assert_eq!(desk.entries("both"), names(&["comparison.json", "figures", "origin.toml", "report.html"]));
    let both: Value = serde_json::from_slice(&desk.read("both/comparison.json")).unwrap();
    let measure = &both["comparisons"][0]["measures"]["cv_10_mm"];
    let [a, b] = [&web, &found].map(|summary| &summary["patches"][2]);
    // The scan's end that faces the laid web.
    let end = usize::from(number(&a["cv"]) > number(&b["cv"]));
    // The logarithms of a CV and of its square have one verdict.
    let log = |a: &Value, b: &Value| (number(a) / number(b)).ln();
    let towards = |patch: &Value, end: usize| log(&patch["cv_interval"][end], &patch["cv"]);
    let scale = (number(&a["cv"]) - number(&b["cv"])) / log(&a["cv"], &b["cv"]);
    let half_width = scale * towards(a, 1 - end).hypot(towards(b, end));
    assert!((number(&measure["half_width"]) / half_width - 1.0).abs() < 1e-4, "{measure}");
    let measure = &both["comparisons"][0]["measures"]["weight_of_5_percent_5_mm"];
    assert!(measure["difference"].is_number() && said.contains("Lightest 5 %, patches of 5 mm"), "{measure}");
    // Nothing is said about a number that is not to be had, and the reason stands there.
    let measure = &both["comparisons"][0]["measures"]["cv_2_mm"];
    assert_eq!(measure["no_verdict"], "below the blur of the scan (scan)");
    assert!(
        measure["significant"].is_null() && said.contains("below the blur of the scan (scan)"),
        "{measure} {said}"
    );
    // The lamp is not known.
    let command = command.replace(" --white 60000 --keep-shading", "");
    let output = success(&mut desk.spunlaid(&format!("{command} --weight 18gsm --out assumed")));
    assert!(output.contains("none: the level of the lamp is an assumed value"), "{output}");
    let headline = output.lines().next().unwrap();
    assert!(headline.ends_with(" mm patches: the level of the lamp is an assumed value."), "{headline}");
    assert!(headline.starts_with("CV at least ") && !headline.contains('±'), "{headline}");
    let notes = desk.summary("assumed")["notes"].to_string();
    assert!(notes.contains("so no interval is given; take an image of the lamp"), "{notes}");
    let output = success(&mut desk.spunlaid("compare laid assumed --out assumed_values"));
    assert!(
        output.contains(" 0 of 1 measures differ")
            && output.contains("the level of the lamp is an assumed value (assumed)"),
        "{output}"
    );
    let curves = String::from_utf8(desk.read("both/figures/web_cv.csv")).unwrap();
    assert!(curves.contains("laid") && curves.contains("scan"), "{curves}");
}

#[test]
fn a_map_is_read_as_basis_weights() {
    let desk = desk();
    success(&mut desk.spunlaid("web web.toml --no-advice --out laid"));
    let said = success(&mut desk.spunlaid("analyse laid/map.npy --pixel 0.5mm --out again --quiet"));
    assert_eq!(said, "");
    let [web, found] = ["laid", "again"].map(|folder| desk.summary(folder)["web"].take());
    assert!((number(&found["basis_weight_kg_m2"]) / number(&web["basis_weight_kg_m2"]) - 1.0).abs() < 1e-6);
    // The picture of the same reports its cells and its weights. A level is 1/65535 of the heaviest cell.
    let said = success(&mut desk.spunlaid("analyse laid/map.png --out drawn"));
    assert!(!said.contains("dots per inch") && !said.contains("lamp"), "{said}");
    let drawn = desk.summary("drawn")["web"].take();
    for name in ["basis_weight_kg_m2", "cell_m"] {
        assert!((number(&drawn[name]) / number(&web[name]) - 1.0).abs() < 1e-5, "{name}: {drawn}");
    }
    for (a, b) in found["patches"].as_array().unwrap().iter().zip(drawn["patches"].as_array().unwrap()) {
        assert!((number(&a["cv"]) / number(&b["cv"]) - 1.0).abs() < 1e-4, "{a} {b}");
    }
    // As a picture in transmitted light, its lightest cells are the lamp.
    success(&mut desk.spunlaid("analyse laid/map.png --light transmitted --keep-shading --out light"));
    // A table of the same, in g/m².
    let rows = map(&desk, "laid");
    let rows = rows.chunks(200).map(|row| row.iter().map(|x| format!("{:.4}", 1e3 * x)).collect::<Vec<_>>());
    fs::write(desk.path("gauge.csv"), rows.map(|row| row.join(";") + "\n").collect::<String>()).unwrap();
    success(&mut desk.spunlaid("analyse gauge.csv --pixel 0.5mm --weight 18g/m² --patches 4mm --out gauge"));
    let gauge = desk.summary("gauge")["web"].take();
    let [a, b] = [&gauge["patches"][0], &found["patches"][3]]
        .map(|patch| (number(&patch["patch_m"]), number(&patch["cv"])));
    assert!(a.0 == 0.004 && b.0 == 0.005 && a.1 > b.1 && a.1 < 1.3 * b.1, "{a:?} {b:?}");
}
