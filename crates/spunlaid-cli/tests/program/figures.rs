//! Figures in the formats and at the width of a paper.

use crate::desk::{Desk, names, success};
use png::{Decoder, Unit};
use std::collections::BTreeSet;
use std::path::Path;

const SHORT: [&str; 4] = ["--set", "run.duration=50 ms", "--replicates", "2"];

fn case(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(name).to_string_lossy().into_owned()
}

/// The endings of the files of one figure.
fn endings(desk: &Desk, folder: &str, figure: &str) -> BTreeSet<String> {
    let ending = |file: String| Some(file.strip_prefix(figure)?.strip_prefix('.')?.to_owned());
    desk.entries(&format!("{folder}/figures")).into_iter().filter_map(ending).collect()
}

/// Width [px] and pixels per metre of a picture.
fn size_of_png(desk: &Desk, path: &str) -> (u32, u32) {
    let reader = Decoder::new(std::io::Cursor::new(desk.read(path))).read_info().unwrap();
    let dims = reader.info().pixel_dims.unwrap();
    assert_eq!(dims.unit, Unit::Meter);
    let software = &reader.info().utf8_text[1];
    assert_eq!(software.keyword, "Software");
    assert!(software.get_text().unwrap().starts_with("spunlaid "));
    (reader.info().width, dims.xppu)
}

#[test]
fn figures_have_the_formats_and_the_width_that_are_asked_for() {
    let desk = Desk::new();
    let run = |options: &[&str]| {
        success(desk.spunlaid("run").arg(case("table1.toml")).args(SHORT).args(options));
    };
    run(&["--out", "usual"]);
    assert_eq!(endings(&desk, "usual", "end_node_path"), names(&["svg", "png", "csv"]));
    // Two pixels for each pixel of the screen, of which an inch has 96.
    assert_eq!(size_of_png(&desk, "usual/figures/end_node_path.png"), (1040, 7559));

    run(&["--out", "paper", "--figures", "pdf,svg,png", "--figure-width", "one-column"]);
    assert_eq!(endings(&desk, "paper", "end_node_path"), names(&["pdf", "svg", "png", "csv"]));
    // 84 mm at 300 dpi.
    assert_eq!(size_of_png(&desk, "paper/figures/end_node_path.png"), (992, 11_811));
    let svg = String::from_utf8(desk.read("paper/figures/end_node_path.svg")).unwrap();
    assert!(svg.contains(" width=\"84mm\" "), "{svg}");
    let pdf = desk.read("paper/figures/end_node_path.pdf");
    // 84 mm are 238.11 points.
    let text = String::from_utf8_lossy(&pdf);
    assert!(text.starts_with("%PDF-") && text.contains("/MediaBox [0 0 238.11"), "{text}");
    // The report is for the screen, whatever the files are.
    let report = |folder: &str| String::from_utf8(desk.read(&format!("{folder}/report.html"))).unwrap();
    let figure = |html: &str| html.split("id=\"figure-end_node_path\"").nth(1).unwrap()[..2000].to_owned();
    assert_eq!(figure(&report("usual")), figure(&report("paper")));

    run(&["--out", "again", "--figures", "pdf,svg,png", "--figure-width", "84 mm"]);
    for ending in ["pdf", "svg", "png"] {
        let file = |folder: &str| desk.read(&format!("{folder}/figures/end_node_history.{ending}"));
        assert_eq!(file("paper"), file("again"), "{ending}");
    }
}

#[test]
#[ignore = "slow: every command that draws figures"]
fn every_command_that_draws_figures_writes_pdf_and_a_paragraph_of_methods() {
    let desk = Desk::new();
    let pdf = ["--figures", "pdf", "--figure-width", "two-columns"];
    let run = |command: &str, arguments: &[&str]| {
        success(desk.spunlaid(command).args(arguments).args(pdf));
    };
    for (seed, name) in [("1", "a"), ("2", "b")] {
        let table1 = case("table1.toml");
        run("run", &[&[table1.as_str()], &SHORT[..], &["--seed", seed, "--out", name]].concat());
    }
    run("compare", &["a", "b", "--out", "compare"]);
    run("spin", &[&case("spinline.toml"), "--out", "spin"]);
    run("sweep", &[&case("studies/throughput.toml"), "--out", "sweep"]);
    let small = ["--set", "web.width=250 mm", "--set", "web.length=250 mm", "--out", "web"];
    run("web", &[&[case("web_known.toml").as_str()], &small[..]].concat());
    run("air", &[&case("spunbond_slot.toml"), "--frames", "2", "--out", "air"]);
    run("analyse", &[&case("records/probe.csv"), "--out", "analyse"]);
    run("analyse", &["web/map.npy", "--pixel", "1 mm", "--out", "scan"]);
    for folder in ["a", "compare", "spin", "sweep", "web", "air", "analyse", "scan"] {
        let files = desk.entries(&format!("{folder}/figures"));
        let of = |ending: &str| files.iter().filter(|file| file.ends_with(ending)).count();
        let html = String::from_utf8(desk.read(&format!("{folder}/report.html"))).unwrap();
        let methods = html.split("<div id=\"methods-text\">").nth(1).unwrap().split("</div>").next().unwrap();
        assert!(html.contains("data-copy=\"methods-text\""), "{folder}");
        for words in
            [concat!("spunlaid ", env!("CARGO_PKG_VERSION")), "The spunlaid authors: spunlaid: a simulator"]
        {
            assert!(methods.contains(words), "{folder}: {methods}");
        }
        assert!(!methods.contains("NaN") && !methods.contains("  "), "{folder}: {methods}");
        // The picture of a web is one of pixels.
        let pictures = usize::from(files.contains("web_picture.png"));
        assert!(
            of(".pdf") > 0 && of(".pdf") == of(".csv") && of(".svg") == 0 && of(".png") == pictures,
            "{folder}: {files:?}"
        );
    }
    let reproduce = "reproduce --scheme implicit-tension --replicates 2 --figures 2,pdf --out paper";
    success(&mut desk.spunlaid(reproduce));
    assert_eq!(desk.entries("paper/figures"), names(&["figure_2.csv", "figure_2.pdf"]));
}

#[test]
fn tables_have_the_formats_that_are_asked_for_besides_the_usual_one() {
    let desk = Desk::new();
    let spin = |options: &[&str]| {
        success(desk.spunlaid("spin").arg(case("spinline.toml")).args(["--out", "r"]).args(options));
    };
    spin(&["--tables", "tsv,csv"]);
    assert_eq!(desk.entries("r/tables"), names(&["spinline.tsv", "spinline.csv"]));
    let text = |ending: &str| String::from_utf8(desk.read(&format!("r/tables/spinline.{ending}"))).unwrap();
    assert!(text("csv").starts_with("z_m,speed_m_s,diameter_m,") && text("csv").lines().count() > 100);
    assert_eq!(text("tsv").replace('\t', ","), text("csv"));
    // They go with the results that are replaced.
    spin(&[]);
    assert!(!desk.path("r/tables").exists() && desk.path("r/spinline.parquet").exists());
}
