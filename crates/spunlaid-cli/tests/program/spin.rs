//! `spunlaid spin`, and runs and webs that begin at the die.

use crate::desk::{Desk, FED, names, refusal, success};
use parquet::file::reader::{FileReader, SerializedFileReader};
use std::fs;
use std::path::Path;

/// A spinline of polypropylene with a free end, in air that is the same along the whole line.
const LINE: &str = r#"
[spinline]
polymer = "pp"
melt_flow_rate = 35
die_temperature = "230 °C"
hole_diameter = "0.6 mm"
throughput = "0.5 g/min"
length = "1.2 m"
velocity = "50 m/s"
cross_velocity = "0.5 m/s"
"#;

/// What the folder of a spinline holds, if it names no files.
const FOLDER: [&str; 6] =
    ["figures", "origin.toml", "report.html", "spinline.parquet", "spinline.toml", "summary.json"];

fn desk() -> Desk {
    let desk = Desk::new();
    fs::write(desk.path("line.toml"), LINE).unwrap();
    desk
}

/// A case that is fed from the same spinline.
fn fed() -> String {
    FED.replace("diameter = \"18 µm\"\ndensity = \"910 kg/m³\"\n", "")
        .replace("[feed]\nspeed = \"50 m/s\"\n", LINE)
}

/// Number of rows and names of the columns of a table.
fn table(desk: &Desk, name: &str) -> (i64, Vec<String>) {
    let reader = SerializedFileReader::new(fs::File::open(desk.path(name)).unwrap()).unwrap();
    let about = reader.metadata().file_metadata();
    (about.num_rows(), about.schema().get_fields().iter().map(|field| field.name().to_owned()).collect())
}

#[test]
fn a_spinline_of_the_repository_is_solved_in_one_command() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let desk = Desk::new();
    let command = format!("spin {} --out a", cases.join("spinline.toml").display());
    let said = success(&mut desk.spunlaid(&command));
    for part in [
        "Diameter, cold                           24.89  µm",
        "Linear density (titre)                   4.405  dtex",
        "Speed at the end                         18.92  m/s",
        "Temperature at solidification              110  °C    (it solidifies by cooling)",
        "Young’s modulus, an estimate",
        "What decides the diameter",
        "% finer",
        "the balance of momentum holds to",
        "no diameter that it gives has been compared with a measured one",
        "(3 to 5 times too low for polypropylene)",
        "The modulus that follows from it is too low",
        "open a/report.html",
    ] {
        assert!(said.contains(part), "{part}\n{said}");
    }
    let spinline = &desk.summary("a")["spinline"];
    let near = |value: &serde_json::Value, wanted: f64| {
        let value = value.as_f64().unwrap();
        assert!((value / wanted - 1.0).abs() < 1e-5, "{value} in place of {wanted}");
    };
    // Another program gave these numbers.
    near(&spinline["final_speed_m_s"], 18.91997);
    near(&spinline["final_diameter_m"], 24.89315e-6);
    near(&spinline["linear_density_kg_m"], 4.40452e-7);
    near(&spinline["force_at_die_n"], 1.345_110e-3);
    near(&spinline["solidification"]["distance_m"], 0.144_147_1);
    near(&spinline["solidification"]["temperature_c"], 110.0);
    near(&spinline["solidification"]["stress_pa"], 2.761_168e6);
    near(&spinline["largest_strain_rate_per_s"], 188.694);
    assert_eq!(spinline["solidification"]["by"], "temperature");
    assert_eq!(spinline["second_steady_state"], false);
    for residual in ["momentum_residual", "energy_residual"] {
        assert!(spinline[residual].as_f64().unwrap().abs() < 1e-5, "{residual}");
    }
    assert!(spinline.get("rows").is_none());
    // The table of the air lies with the results.
    assert_eq!(desk.entries("a"), names(&[&FOLDER[..], &["case_files"]].concat()));
    assert_eq!(desk.entries("a/case_files"), names(&["spinline.csv"]));
    let figures = desk.entries("a/figures");
    for name in ["speed_and_diameter", "temperature", "tension_and_stress", "strain_rate", "influences"] {
        for ending in ["svg", "png", "csv"] {
            assert!(figures.contains(&format!("spinline_{name}.{ending}")), "{name}.{ending} of {figures:?}");
        }
    }
    // The spinline as resolved gives the same bits, and the same again.
    success(&mut desk.spunlaid("spin a/spinline.toml --out b --quiet"));
    for name in ["summary.json", "spinline.parquet", "figures/spinline_temperature.csv"] {
        assert!(desk.read(&format!("a/{name}")) == desk.read(&format!("b/{name}")), "{name}");
    }
    success(&mut desk.spunlaid("spin b/spinline.toml --out c --quiet"));
    assert!(desk.read("b/spinline.toml") == desk.read("c/spinline.toml"));
}

#[test]
fn the_table_of_the_thread_has_a_row_for_each_station() {
    let desk = desk();
    success(&mut desk.with("spin line.toml --out one", &[]));
    let (rows, columns) = table(&desk, "one/spinline.parquet");
    assert_eq!(
        columns,
        [
            "z_m",
            "speed_m_s",
            "diameter_m",
            "temperature_c",
            "tension_n",
            "stress_pa",
            "transformed",
            "strain_rate_per_s",
            "air_velocity_m_s",
            "air_cross_velocity_m_s",
            "air_temperature_c"
        ]
    );
    let curtain = ["spinline.rows=3", "spinline.filaments_per_metre_and_row=100"];
    let said = success(&mut desk.with("spin line.toml --out three", &curtain));
    assert!(said.contains("the first of 3 rows"), "{said}");
    let (of_three, columns) = table(&desk, "three/spinline.parquet");
    assert_eq!(columns[0], "row");
    assert!(of_three > 2 * rows, "{of_three} and {rows}");
    let spinline = &desk.summary("three")["spinline"];
    let measured = spinline["rows"].as_array().unwrap();
    assert_eq!(measured.len(), 3);
    // The first row meets the same air as a filament alone, and the table is its.
    assert_eq!(measured[0]["final_diameter_m"], spinline["final_diameter_m"]);
    assert_eq!(measured[0]["final_diameter_m"], desk.summary("one")["spinline"]["final_diameter_m"]);
    let diameters: Vec<f64> = measured.iter().map(|row| row["final_diameter_m"].as_f64().unwrap()).collect();
    assert!(diameters[0] != diameters[1] && diameters[1] != diameters[2], "{diameters:?}");
    assert!(desk.entries("three/figures").contains("spinline_rows.svg"));
}

#[test]
fn json_is_the_summary_and_writes_nothing_unless_asked() {
    let desk = desk();
    let said = success(&mut desk.spunlaid("spin line.toml --json"));
    assert_eq!(desk.entries("."), names(&["brief.toml", "line.toml"]));
    success(&mut desk.spunlaid("spin line.toml --quiet"));
    assert_eq!(desk.entries("results/line"), names(&FOLDER));
    assert!(desk.read("results/line/summary.json") == said.as_bytes());
    let summary = desk.summary("results/line");
    assert_eq!(summary["schema_version"], 1);
    let first = &summary["spinline"]["influences"][0];
    assert!(first["key"].as_str().unwrap().starts_with("spinline."), "{first}");
    assert!(first["diameter"].is_f64() && first["speed"].is_f64() && first["change"].is_string(), "{first}");
    assert!(summary["spinline"]["model_error"].as_str().unwrap().contains("not known"));
    let said = refusal(&mut desk.with("spin line.toml", &["spinline.throughput=0.4 g/min"]), 1);
    assert!(said.contains("holds results already"), "{said}");
    success(&mut desk.spunlaid("spin line.toml --quiet"));
    success(&mut desk.with("spin line.toml --quiet --force", &["spinline.throughput=0.4 g/min"]));
}

#[test]
fn check_reads_a_spinline_alone() {
    let desk = desk();
    let said = success(&mut desk.spunlaid("check line.toml"));
    for part in [
        "# the spinline with every default",
        "[spinline.material]",
        "Diameter, cold",
        "# ready: spunlaid spin line.toml",
    ] {
        assert!(said.contains(part), "{part}\n{said}");
    }
    // What it prints is a file that gives the same spinline.
    fs::write(desk.path("printed.toml"), &said).unwrap();
    let json = |name: &str| success(&mut desk.spunlaid(&format!("spin {name} --json")));
    assert_eq!(json("printed.toml"), json("line.toml"));
}

#[test]
fn check_reports_throughput_and_line_density_of_every_fed_fibre() {
    let desk = Desk::with_case(FED);
    let said = success(&mut desk.spunlaid("check brief.toml"));
    // π/4 (18 µm)² × 910 kg/m³, times 50 m/s.
    assert!(
        said.contains("filaments of 18 µm, 2.32 dtex, fed at 50 m/s: 0.695 g/min from each hole"),
        "{said}"
    );
    let desk = Desk::with_case(&fed());
    let said = success(&mut desk.spunlaid("check brief.toml"));
    assert!(said.contains(": 0.5 g/min from each hole"), "{said}");
    assert!(said.contains("from the spinline: The filament is drawn"), "{said}");
    // A fibre of fixed length has none.
    let desk = Desk::new();
    assert!(!success(&mut desk.spunlaid("check brief.toml")).contains("g/min"));
}

#[test]
fn a_run_that_begins_at_the_die_shows_its_spinline() {
    let desk = Desk::with_case(&fed());
    fs::write(desk.path("line.toml"), LINE).unwrap();
    success(&mut desk.spunlaid("run brief.toml --out r --quiet"));
    success(&mut desk.spunlaid("spin line.toml --out s --quiet"));
    // With the same drag law, the run has the numbers of the spinline alone.
    assert_eq!(desk.summary("r")["spinline"], desk.summary("s")["spinline"]);
    assert!(desk.read("r/spinline.parquet") == desk.read("s/spinline.parquet"));
    assert!(desk.entries("r/figures").contains("spinline_temperature.svg"));
    let page = String::from_utf8(desk.read("r/report.html")).unwrap();
    for part in [
        "id=\"spinline\"",
        "id=\"figure-spinline_influences\"",
        "solidifies",
        "no diameter that it gives has been compared",
    ] {
        assert!(page.contains(part), "{part}");
    }
    // A case without one has no trace of it.
    let desk = Desk::with_case(FED);
    success(&mut desk.spunlaid("run brief.toml --out r --quiet"));
    assert!(desk.summary("r").get("spinline").is_none());
    assert!(!desk.entries("r").contains("spinline.parquet"));
}

#[test]
fn a_web_that_begins_at_the_die_shows_the_whole_way() {
    let desk = Desk::with_case(&fed());
    let web = "[laydown]\ncase = \"brief.toml\"\n[line]\nfilaments_per_metre = 500\n[web]\n\
        width = \"0.2 m\"\nlength = \"0.1 m\"\n";
    fs::write(desk.path("web.toml"), web).unwrap();
    success(&mut desk.spunlaid("web web.toml --out w --quiet"));
    let layer = &desk.summary("w")["layers"][0];
    assert!(layer["spinline"]["solidification"]["distance_m"].as_f64().unwrap() > 0.0, "{layer}");
    // 500 holes per metre × 0.5 g/min / 3 m/s.
    let weight = layer["basis_weight_kg_m2"].as_f64().unwrap();
    assert!((weight / (500.0 * 0.5e-3 / 60.0 / 3.0) - 1.0).abs() < 1e-9, "{weight}");
    let page = String::from_utf8(desk.read("w/report.html")).unwrap();
    for part in ["Die → diffuser → belt → web", "500 holes per metre", "1.39\u{202f}g/m²: the same"] {
        assert!(page.contains(part), "{part}");
    }
    assert!(desk.entries("w").contains("spinline.parquet"));
}

#[test]
fn a_study_of_a_spinline_continues_and_runs_again_to_the_same_bits() {
    let desk = desk();
    let study = "spinline = \"line.toml\"\ndesign = \"grid\"\n\
        [vary]\n\"spinline.throughput\" = [\"0.3 g/min\", \"0.5 g/min\"]\n\"spinline.die_temperature\" = \
        [\"220 °C\", \"240 °C\"]\n";
    fs::write(desk.path("study.toml"), study).unwrap();
    let said = success(&mut desk.spunlaid("sweep study.toml --out a"));
    for part in ["Diameter, cold (µm)", "0.3 g/min", "220 °C", "the study has 4 spinlines in total"] {
        assert!(said.contains(part), "{part}\n{said}");
    }
    assert!(desk.entries("a").contains("spinline.toml"));
    assert!(desk.entries("a/figures").contains("final_diameter_over_spinline_die_temperature.svg"));
    // A point is a spinline as it is solved alone.
    let single = success(&mut desk.with(
        "spin line.toml --json",
        &["spinline.throughput=0.3 g/min", "spinline.die_temperature=220 °C"],
    ));
    let single: serde_json::Value = serde_json::from_str(&single).unwrap();
    let results: serde_json::Value = serde_json::from_slice(&desk.read("a/results.json")).unwrap();
    assert_eq!(
        results["points"][0]["results"]["final_diameter_m"]["mean"],
        single["spinline"]["final_diameter_m"]
    );
    success(&mut desk.spunlaid("sweep a/study.toml --out b --quiet"));
    assert!(desk.read("a/results.csv") == desk.read("b/results.csv"));
    success(&mut desk.spunlaid("sweep study.toml --out a --quiet"));
}

#[test]
fn a_study_says_why_a_point_has_no_steady_state() {
    let desk = desk();
    let study =
        "spinline = \"line.toml\"\ndesign = \"grid\"\n[vary]\n\"spinline.length\" = [\"20 mm\", \"1 m\"]\n";
    fs::write(desk.path("study.toml"), study).unwrap();
    let said = refusal(&mut desk.spunlaid("sweep study.toml --out a --quiet"), 2);
    assert!(said.contains("1 of 2 spinlines has no steady state; all others are in the results"), "{said}");
    assert!(said.contains("point 1: spinline.length = 20 mm is too short"), "{said}");
}
