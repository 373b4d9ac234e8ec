//! `spunlaid web`: what it writes and says of webs of independent filaments, and what it refuses.

use crate::desk;
use crate::desk::{Desk, FED, refusal, success};
use std::fs;

pub(super) const WEB: &str = "[laydown]\ncase = \"brief.toml\"\n[line]\nfilaments_per_metre = 500\n[web]\n\
    width = \"1 m\"\nlength = \"1 m\"\n";

pub(super) fn desk() -> Desk {
    // So long elements show too little of the autocorrelation to see a surrogate in it.
    let desk = Desk::with_case(&FED.replace("element_length = \"4 mm\"", "element_length = \"25 mm\""));
    fs::write(desk.path("web.toml"), WEB).unwrap();
    desk
}

/// Two beams, one above the other, in numbers.
pub(super) const BEAMS: &str = r#"
version = 1

[[layer]]
name = "S1"
fibre = { diameter = "18 µm", density = "910 kg/m³" }
laydown = { sigma_md = "9 mm", sigma_cd = "8 mm", noise = "15 m^-0.5" }
line = { feed_speed = "50 m/s", belt_speed = "5 m/s", rows = [{ offset = "0 mm", pitch = "2 mm", filaments = 100 }] }

[[layer]]
name = "S2"
fibre = { linear_density = "2 dtex", density = "910 kg/m³" }
laydown = { sigma_md = "6 mm", sigma_cd = "6 mm", noise = "20 m^-0.5" }
line = { feed_speed = "40 m/s", belt_speed = "5 m/s", filaments_per_metre = 400 }

[web]
width = "0.2 m"
length = "0.3 m"
cell = "1 mm"
patches = ["1 mm", "5 mm", "20 mm"]
"#;

#[test]
fn a_web_is_written_whole_and_laid_again_to_the_same_bits() {
    let desk = desk();
    fs::write(desk.path("beams.toml"), BEAMS).unwrap();
    desk::success(&mut desk.spunlaid("web beams.toml --out w --quiet"));
    let files = [
        "fibres.vtp",
        "figures",
        "map.npy",
        "map.png",
        "origin.toml",
        "report.html",
        "summary.json",
        "web.toml",
    ];
    assert_eq!(desk.entries("w"), desk::names(&files));
    desk::success(&mut desk.spunlaid("web w/web.toml --out again --threads 1 --quiet --sheet sheet.pdf"));
    // The sheet is one page, and is not written over; it is no part of the folder.
    let sheet = desk.read("sheet.pdf");
    let holds = |part: &[u8]| sheet.windows(part.len()).any(|window| window == part);
    assert!(sheet.starts_with(b"%PDF") && holds(b"/Count 1"));
    assert_eq!(desk.entries("again"), desk::names(&files));
    let said = refusal(&mut desk.spunlaid("web beams.toml --out third --sheet sheet.pdf"), 1);
    assert!(
        said.contains("sheet.pdf: is there already; name another file, or replace it (--sheet, --force)"),
        "{said}"
    );
    assert_eq!(desk.read("sheet.pdf"), sheet);
    let said = refusal(&mut desk.spunlaid("web beams.toml --out third --sheet nowhere/sheet.pdf"), 1);
    assert!(
        said.contains("nowhere/sheet.pdf: lies in a folder that is not there; name another file"),
        "{said}"
    );
    assert!(!desk.path("third").exists());
    for file in ["map.npy", "map.png", "fibres.vtp", "web.toml", "figures/web_cv.csv"] {
        let [one, other] = ["w", "again"].map(|folder| desk.read(&format!("{folder}/{file}")));
        assert!(one == other, "{file}");
    }

    let summary = desk.summary("w");
    let number = |path: &str| summary.pointer(path).and_then(serde_json::Value::as_f64).unwrap();
    // Line density times filaments per metre times feed speed over belt speed, of both beams.
    let first = 910.0 * std::f64::consts::PI * 18e-6_f64.powi(2) / 4.0 * 500.0 * 10.0;
    let weight = first + 2e-7 * 400.0 * 8.0;
    assert!((number("/web/basis_weight_kg_m2") / weight - 1.0).abs() < 1e-5, "{weight}");
    assert!((number("/layers/1/basis_weight_kg_m2") / 6.4e-4 - 1.0).abs() < 1e-9);
    assert!((number("/web/fibre_length_m") / (0.3 * (100.0 * 10.0 + 80.0 * 8.0)) - 1.0).abs() < 1e-9);
    for patch in 0..3 {
        let value = |name: &str| number(&format!("/web/patches/{patch}/{name}"));
        assert!(
            value("cv") > value("cv_straight_fibres") * 0.5
                && value("cv") < 4.0 * value("cv_straight_fibres")
        );
        let apart = (value("cv") - value("cv_one_fibre")).abs();
        assert!(
            apart < 5.0 * value("cv_standard_error").hypot(value("cv_one_fibre_standard_error")),
            "{summary}"
        );
    }

    // The array: a head that says its shape, then as many 32-bit numbers, whose mean is the basis weight.
    let array = desk.read("w/map.npy");
    let head = String::from_utf8_lossy(&array[10..128]).into_owned();
    assert!(array.starts_with(b"\x93NUMPY\x01\x00") && head.contains("'shape': (300, 200)"), "{head}");
    let start = array.len() - 4 * 300 * 200;
    assert!(start.is_multiple_of(64));
    let numbers =
        array[start..].chunks_exact(4).map(|bytes| f64::from(f32::from_le_bytes(bytes.try_into().unwrap())));
    assert!((numbers.sum::<f64>() / 6e4 / weight - 1.0).abs() < 1e-4);

    // Results of another command are not replaced unless this is asked for, and asking for the summary alone
    // writes nothing.
    let said = refusal(&mut desk.spunlaid("web beams.toml --out w --set web.seed=9"), 1);
    assert!(said.contains("--force"), "{said}");
    let json = desk::success(&mut desk.spunlaid("web beams.toml --json --quiet"));
    assert!(json.contains("\"cv_one_fibre\""), "{json}");
    assert!(!desk.path("results").exists());
}

#[test]
fn the_page_shows_how_wide_the_web_is_and_where_it_ends() {
    let desk = desk();
    for (edges, pitch, label, ends) in [
        ("cut", "1 mm", "edge of the web", [76.0, 1123.0]),
        ("periodic", "1.2 mm", "edge of the sheet", [0.0, 1200.0]),
    ] {
        let web = format!(
            "[fibre]\ndiameter = \"18 µm\"\ndensity = \"910 kg/m³\"\n[laydown]\nsigma_md = \"9 mm\"\n\
            sigma_cd = \"8 mm\"\nnoise = \"15 m^-0.5\"\n[line]\nfeed_speed = \"50 m/s\"\n\
            belt_speed = \"5 m/s\"\nrows = [{{ offset = \"100 mm\", pitch = \"{pitch}\", filaments = 1000 \
            }}]\n[web]\nwidth = \"1.2 m\"\nlength = \"300 mm\"\ncell = \"2 mm\"\npatches = [\"10 mm\"]\n\
            edges = \"{edges}\"\n"
        );
        fs::write(desk.path("wide.toml"), web).unwrap();
        success(&mut desk.spunlaid("web wide.toml --no-advice --out w --force --quiet"));
        let page = String::from_utf8(desk.read("w/report.html")).unwrap();
        assert!(page.contains("The web is 1,200 mm wide and 300 mm long."));
        // Without scripts the picture stands there, and buttons that would do nothing do not.
        assert!(page.contains("<img id=\"sheet\" src=\"data:image/png;base64,iVBOR"));
        assert!(page.contains("<canvas id=\"table\" hidden") && page.contains("id=\"moves\" hidden"));
        // 3 σ_CD beyond the first and the last filament.
        let profile = String::from_utf8(desk.read("w/figures/web_profiles.csv")).unwrap();
        let lines =
            profile.lines().filter_map(|line| line.strip_prefix(label)?.split(',').nth(1)?.parse().ok());
        let found: Vec<f64> = lines.collect();
        assert!(
            found.len() == 2 && found.iter().zip(ends).all(|(a, b)| (a - b).abs() < 1e-6),
            "{edges}: {found:?}"
        );
        assert_eq!(page.contains("thinner, not counted"), edges == "cut");
    }
}

/// One file is the line: its web is laid, its filament is simulated, and its air is looked at, as from two files.
#[test]
fn identical_web_and_filament_of_one_file_and_of_two() {
    let desk = desk();
    let case = String::from_utf8(desk.read("brief.toml")).unwrap();
    let web = WEB.split_once("[line]").unwrap().1;
    fs::write(desk.path("one.toml"), format!("{case}\n[line]{web}")).unwrap();
    let small = ["--set", "run.duration=0.3 s", "--set", "web.width=0.2 m", "--set", "web.length=0.1 m"];
    for (file, out) in [("one.toml", "one"), ("web.toml", "two")] {
        let command = format!("web {file} --no-advice --quiet --out {out}");
        success(desk.spunlaid(&command).args(small));
    }
    for file in ["web.toml", "map.npy"] {
        assert_eq!(desk.read(&format!("one/{file}")), desk.read(&format!("two/{file}")), "{file}");
    }
    assert!(!desk.path("one/cases").exists());
    let flight = ["--set", "run.duration=0.1 s", "--set", "run.replicates=1", "--set", "run.checks=none"];
    for (file, out) in [("one.toml", "flown_one"), ("brief.toml", "flown_two")] {
        success(desk.spunlaid(&format!("run {file} --quiet --out {out}")).args(flight));
    }
    assert_eq!(desk.read("flown_one/case.toml"), desk.read("flown_two/case.toml"));
    assert_eq!(desk.summary("flown_one")["laydown"], desk.summary("flown_two")["laydown"]);
    let said = success(&mut desk.spunlaid("check one.toml"));
    assert!(said.contains("#   one.toml: its eddies lie in space"), "{said}");
}

/// The text of a part of a page from one heading to another, as one reads it.
fn read_between(page: &str, from: &str, to: &str) -> String {
    let part =
        page.split(&format!(">{from}</h2>")).nth(1).unwrap().split(&format!(">{to}</h2>")).next().unwrap();
    let words = part.split('<').map(|piece| piece.split_once('>').map_or("", |(_, words)| words));
    let words: Vec<&str> = words.flat_map(str::split_whitespace).collect();
    words.join(" ").replace(['\u{202f}', '\u{a0}'], " ")
}

/// Equal beams are shown once, and a change says what becomes of titre, mass and belt, as `summary.json` does. The
/// picture for a slide has the web and what chance makes of it.
#[test]
fn the_first_screen_says_what_changes_do_to_the_line_and_equal_beams_once() {
    let desk = desk();
    let [head, first] = BEAMS.split_once("[[layer]]").map(|(head, rest)| [head, rest]).unwrap();
    let [beam, _] = first.split_once("[[layer]]").map(|(beam, rest)| [beam, rest]).unwrap();
    let web = BEAMS.split_once("[web]").unwrap().1;
    let equal = format!("{head}[[layer]]{beam}[[layer]]{}[web]{web}", beam.replace("S1", "S2"));
    for (file, text) in [("equal.toml", equal.as_str()), ("beams.toml", BEAMS)] {
        fs::write(desk.path(file), text).unwrap();
    }
    success(&mut desk.spunlaid("web equal.toml --out w --advice --quiet"));
    success(&mut desk.spunlaid("web beams.toml --out other --no-advice --quiet"));
    let page = |folder: &str| String::from_utf8(desk.read(&format!("{folder}/report.html"))).unwrap();
    let [line, other] =
        ["w", "other"].map(|folder| read_between(&page(folder), "The line", "Defects per area"));
    assert!(line.contains("Beams 2, identical") && !line.contains("of layer"), "{line}");
    assert_eq!(line.matches("Holes per metre").count(), 1, "{line}");
    assert!(other.contains("Filament of layer S1") && other.contains("Filament of layer S2"), "{other}");

    let change = read_between(&page("w"), "Change first", "The line");
    // `20 % more holes, 500 to 600 −6 ± 1 % Copy 2.3 dtex, 120 to 144 kg/h per metre, belt 300 to 360 m/min`: the last
    // number before each unit is that of the changed web.
    let first = change.split_once("m/min").unwrap().0;
    let last = |unit: &str| -> f64 {
        let before = first.rsplit_once(unit).map_or(first, |(before, _)| before);
        before.split_whitespace().last().unwrap().parse().unwrap()
    };
    let shown = [last("dtex") * 1e-7, last("kg/h"), last("no other unit") / 60.0];
    let summary = desk.summary("w");
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let is_reported = |one: &&serde_json::Value| {
        let of_change =
            [&one["linear_density_kg_m"][0], &one["throughput_kg_h_m"], &one["belt_speed_m_s"]].map(number);
        shown.iter().zip(of_change).all(|(shown, number)| (shown / number - 1.0).abs() < 1e-3)
    };
    assert!(summary["advice"]["changes"].as_array().unwrap().iter().any(|one| is_reported(&one)), "{change}");
    // Where the titre is not one of the running line, the card says that none of its settings helps.
    let still = "web equal.toml --out still --advice --quiet --set web.turnable=air_speed";
    success(&mut desk.spunlaid(still));
    let still = read_between(&page("still"), "Change first", "The line");
    let nothing = "No setting of the running line lowers the expected CV over patches of ";
    assert!(still.contains(nothing) && !change.contains(nothing), "{still}");
    let picture = desk.read("w/figures/web_picture.png");
    let side = |at: usize| u32::from_be_bytes(picture[at..at + 4].try_into().unwrap());
    // 200 mm × 300 mm in pixels of 1 mm, three times as large, with a third of that beside it.
    assert_eq!((side(16), side(20)), (3 * (200 + 67) + 3 * 24, 3 * 300 + 84 + 64));
}
