//! `spunlaid air --sources`: what filaments do to the cells of their field, as a CFD program reads it.

use crate::desk::{Desk, refusal, success};
use spunlaid_air::{Field, FieldLayout};
use std::fmt::Write;
use std::fs;

const CELLS: [usize; 2] = [12, 5];
const SIZE: [f64; 3] = [0.2, 0.1, 0.01];

const LINE: &str = "version = 1
[fibre]
diameter = '20 µm'
density = '910 kg/m³'
youngs_modulus = '2 GPa'
element_length = '8 mm'
[feed]
speed = '20 m/s'
[belt]
distance = '0.2 m'
speed = '3 m/s'
[air]
field = 'air.vtk'
turbulence_intensity = 0.1
length_scale = '16 mm'
cutoff_frequency = '500 Hz'
[run]
duration = '60 ms'
spin_up = '20 ms'
replicates = 2
";
/// A spinline in place of what is known of the filament.
const SPINLINE: &str = "version = 1
[spinline]
polymer = 'pp'
melt_flow_rate = 35
die_temperature = '230 °C'
hole_diameter = '0.6 mm'
throughput = '0.35 g/min'
length = '0.25 m'
end = 'take-up'
take_up_speed = '20 m/s'
[fibre]
element_length = '8 mm'
";
const FILAMENTS: &str =
    "[line]\nfilaments_per_metre = 4000\nslot_gap = '10 mm'\n[web]\nwidth = '0.1 m'\nlength = '0.1 m'\n";

/// Air that slows from 20 to 10 m/s.
fn velocity(x: f64, y: f64) -> [f64; 3] {
    [20.0 - 50.0 * x, 50.0 * y, 0.0]
}

/// Hexahedra in rows along x, one cell thick, as legacy VTK.
fn field() -> String {
    let [nx, ny] = CELLS;
    let mut points = String::new();
    let mut velocities = String::new();
    let mut cells = String::new();
    for (k, j, i) in (0..2).flat_map(|k| (0..=ny).flat_map(move |j| (0..=nx).map(move |i| (k, j, i)))) {
        let x = i as f64 / nx as f64 * SIZE[0];
        let y = (j as f64 / ny as f64 - 0.5) * SIZE[1];
        let [u, v, w] = velocity(x, y);
        writeln!(points, "{x} {y} {}", f64::from(k) * SIZE[2]).unwrap();
        writeln!(velocities, "{u} {v} {w}").unwrap();
    }
    let (up, layer) = (nx + 1, (nx + 1) * (ny + 1));
    for first in (0..ny).flat_map(|j| (0..nx).map(move |i| i + up * j)) {
        let face = [first, first + 1, first + 1 + up, first + up];
        let corners = [face, face.map(|corner| corner + layer)].concat();
        let corners: Vec<String> = corners.iter().map(ToString::to_string).collect();
        writeln!(cells, "8 {}", corners.join(" ")).unwrap();
    }
    let (count, points_count) = (nx * ny, 2 * layer);
    format!(
        "# vtk DataFile Version 2.0\nair\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {points_count} double\n{points}\
         CELLS {count} {}\n{cells}CELL_TYPES {count}\n{}POINT_DATA {points_count}\nVECTORS U double\n{velocities}",
        9 * count,
        "12\n".repeat(count)
    )
}

/// A line in this field, `line.toml`.
pub(super) fn desk() -> Desk {
    let desk = Desk::new();
    fs::write(desk.path("air.vtk"), field()).unwrap();
    fs::write(desk.path("line.toml"), format!("{LINE}{FILAMENTS}")).unwrap();
    desk
}

/// The numbers of a field of OpenFOAM: its class, dimensions and values.
fn openfoam(text: &str) -> (String, String, Vec<Vec<f64>>) {
    let after = |word: &str| text.split_once(word).unwrap().1.split_once(';').unwrap().0.trim().to_owned();
    let list = text.split_once("internalField").unwrap().1.split_once("\n)\n;").unwrap().0;
    let (head, values) = list.split_once("\n(\n").unwrap();
    let numbers = |line: &str| {
        let line = line.trim_matches(['(', ')']);
        line.split_whitespace().map(|number| number.parse().unwrap()).collect::<Vec<f64>>()
    };
    let values: Vec<Vec<f64>> = values.lines().map(numbers).collect();
    assert_eq!(head.lines().last().unwrap().parse(), Ok(values.len()));
    (after("class "), after("dimensions "), values)
}

#[test]
fn invariant_the_fields_for_openfoam_have_the_force_of_the_summary() {
    let desk = desk();
    let said = success(&mut desk.spunlaid("air line.toml --sources --out out"));
    assert!(said.contains("4000 per metre of width") && said.contains("N/m along their way"), "{said}");
    let read = |name: &str| fs::read_to_string(desk.path(&format!("out/openfoam/{name}"))).unwrap();
    let (class, dimensions, su) = openfoam(&read("Su"));
    assert_eq!((&*class, &*dimensions), ("volVectorField", "[1 -2 -2 0 0 0 0]"));
    let (class, dimensions, sp) = openfoam(&read("Sp"));
    assert_eq!((&*class, &*dimensions), ("volScalarField", "[1 -3 -1 0 0 0 0]"));
    let [nx, ny] = CELLS;
    assert_eq!((su.len(), sp.len()), (nx * ny, nx * ny));

    // Per metre of width, in the order of the cells of the file.
    let area = SIZE[0] * SIZE[1] / (nx * ny) as f64;
    let mut force = [0.0; 3];
    for (cell, (su, sp)) in su.iter().zip(&sp).enumerate() {
        let x = ((cell % nx) as f64 + 0.5) / nx as f64 * SIZE[0];
        let y = (((cell / nx) as f64 + 0.5) / ny as f64 - 0.5) * SIZE[1];
        assert!(sp[0] <= 0.0 && (sp[0] < 0.0) == (su[0] != 0.0));
        (0..3).for_each(|i| force[i] += (su[i] + sp[0] * velocity(x, y)[i]) * area);
    }
    let summary = desk.summary("out");
    for (i, force) in force.iter().enumerate() {
        let reported = summary["force_n_per_m"][i]["mean"].as_f64().unwrap();
        assert!((force - reported).abs() < 1e-5 * force.abs().max(0.1), "{force} {reported}");
    }
    assert!(force[0].abs() > 0.05 && summary["openfoam"] == true, "{force:?}");
    let met = summary["cells_met"].as_u64().unwrap() as usize;
    assert_eq!(met, sp.iter().filter(|sp| sp[0] < 0.0).count());

    // The cells for ParaView are VTK that the program reads itself.
    let layout = FieldLayout { velocity: Some("Su".to_owned()), ..FieldLayout::default() };
    let cells = fs::read(desk.path("out/sources.vtu")).unwrap();
    let (cells, _) = Field::parse_as(&cells, "sources.vtu", &layout).unwrap();
    let (low, high) = cells.bounds();
    assert!((high.x - SIZE[0]).abs() < 1e-12 && (low.y + 0.5 * SIZE[1]).abs() < 1e-12, "{low:?} {high:?}");

    // The kept input gives the same again.
    success(&mut desk.spunlaid("air out/web.toml --sources --threads 1 --out again"));
    for name in ["sources.vtu", "openfoam/Su", "openfoam/Sp", "openfoam/SuStandardError"] {
        assert!(desk.read(&format!("out/{name}")) == desk.read(&format!("again/{name}")), "{name}");
    }
}

#[test]
fn invariant_the_heat_for_openfoam_is_what_the_filaments_lose() {
    let desk = Desk::new();
    fs::write(desk.path("air.vtk"), field()).unwrap();
    let cold = format!("{LINE}{FILAMENTS}");
    fs::write(desk.path("cold.toml"), &cold).unwrap();
    let said = success(&mut desk.spunlaid("air cold.toml --sources --out cold"));
    assert!(said.contains("Heat is left out: the filaments come from no spinline"), "{said}");
    // The report has all that the terminal says.
    let page = fs::read_to_string(desk.path("cold/report.html")).unwrap();
    for row in ["Along the way, from the inlet to", "The same by the balance of momentum"] {
        assert!(page.contains(row), "no {row}");
    }
    let summary = desk.summary("cold");
    assert!(summary["heat_w_per_m"].is_null() && summary["lost"] == 0, "{summary}");
    assert!(!desk.path("cold/openfoam/Sh").exists() && desk.path("cold/openfoam/Sp").exists());

    let hot = format!("{SPINLINE}{}", &cold[cold.find("[belt]").unwrap()..]);
    fs::write(desk.path("hot.toml"), hot).unwrap();
    let said = success(&mut desk.spunlaid("air hot.toml --sources --out hot"));
    assert!(said.contains("kW/m") && !said.contains("left out"), "{said}");
    let summary = desk.summary("hot");
    let number = |name: &str| summary[name]["mean"].as_f64().unwrap();
    let read = |name: &str| fs::read_to_string(desk.path(&format!("hot/openfoam/{name}"))).unwrap();
    let (class, dimensions, sh) = openfoam(&read("Sh"));
    assert_eq!((&*class, &*dimensions), ("volScalarField", "[1 -1 -3 0 0 0 0]"));
    let (class, dimensions, per_kelvin) = openfoam(&read("ShT"));
    assert_eq!((&*class, &*dimensions), ("volScalarField", "[1 -1 -3 -1 0 0 0]"));

    // Air of 20 °C, as its usual density has it, takes what the melt's heat capacity says.
    let of_air = summary["air_temperature_c"].as_f64().unwrap();
    assert!((of_air - 20.0).abs() < 0.1, "{of_air}");
    let area = SIZE[0] * SIZE[1] / (CELLS[0] * CELLS[1]) as f64;
    let heat = |(sh, per_kelvin): (&Vec<f64>, &Vec<f64>)| (sh[0] + per_kelvin[0] * (of_air + 273.15)) * area;
    let given: f64 = sh.iter().zip(&per_kelvin).map(heat).sum();
    assert!((given / number("heat_w_per_m") - 1.0).abs() < 1e-6, "{given}");
    let inlet = summary["inlet_temperature_c"].as_f64().unwrap();
    let belt = number("belt_temperature_c");
    let content = |celsius: f64| (2100.0 + 0.5 * 3.35 * celsius) * celsius;
    let lost = 4000.0 * 0.35e-3 / 60.0 * (content(inlet) - content(belt));
    // The heat content of the mean temperature is not quite the mean of the heat contents.
    let all = given + number("heat_outside_w_per_m");
    assert!((all / lost - 1.0).abs() < 1e-3 && lost > 50.0, "{all} {lost}");
    assert!(desk.path("hot/openfoam/ShTStandardError").exists());
    let text = String::from_utf8_lossy(&fs::read(desk.path("hot/sources.vtu")).unwrap()).into_owned();
    assert!(
        ["Sh", "ShT", "heat", "ShT_standard_error"]
            .iter()
            .all(|name| text.contains(&format!("Name=\"{name}\"")))
    );
}

/// Filaments that have not come down when the means begin: their drag and the balance of their momentum differ by half,
/// and no CFD program shall read that.
#[test]
fn rejects_sources_of_flights_that_are_not_steady() {
    let desk = Desk::new();
    fs::write(desk.path("air.vtk"), field()).unwrap();
    fs::write(desk.path("line.toml"), format!("{LINE}{FILAMENTS}")).unwrap();
    for replicates in [1, 2, 8] {
        let arguments =
            format!("air line.toml --sources --set run.replicates={replicates} --out r{replicates}");
        let steady = format!("r{replicates}");
        success(&mut desk.spunlaid(&arguments));
        assert!(
            desk.summary(&steady)["steady"] == true && desk.path(&format!("{steady}/openfoam/Su")).exists()
        );

        let output = desk.spunlaid(&format!("{arguments}_short --set run.spin_up=2ms")).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(
            said.contains("not steady") && said.contains("write run.spin_up = \"30 ms\" or more"),
            "{said}"
        );
        let folder = format!("{steady}_short");
        let summary = desk.summary(&folder);
        assert!(summary["steady"] == false && summary["openfoam"] == false, "{summary}");
        assert!(summary["notes"].to_string().contains("No fields are written"), "{summary}");
        let [drag, balance] =
            ["above_belt_n_per_m", "by_momentum_n_per_m"].map(|of| summary[of]["mean"].as_f64());
        assert!(balance.unwrap() > 1.3 * drag.unwrap(), "{summary}");
        assert!(!desk.path(&format!("{folder}/openfoam")).exists());
        assert!(
            !desk.path(&format!("{folder}/sources.vtu")).exists()
                && desk.path(&format!("{folder}/report.html")).exists()
        );
    }
}

/// What the filaments of a web do to their air down to the belt is what its sources say. Without the drag on elements
/// that land in a step it was five errors less.
#[test]
fn stat_a_web_drives_its_air_as_its_sources_do() {
    const LINE: &str = "line.toml --json --set run.duration=100ms --set feed.speed=12m/s";
    let desk = desk();
    let summary = |arguments: &str| -> serde_json::Value {
        serde_json::from_str(&success(&mut desk.spunlaid(arguments))).unwrap()
    };
    let web = summary(&format!("web {LINE} --no-advice --set web.simulated=40"));
    let sources = summary(&format!("air {LINE} --sources --set run.replicates=16"));
    let places = web["layers"][0]["curtain"]["places"].as_array().unwrap();
    let [of_web, of_sources] = [&places.last().unwrap()["force_n_per_m"], &sources["force_along_n_per_m"]]
        .map(|force| ["mean", "standard_error"].map(|part| force[part].as_f64().unwrap()));
    let error = of_web[1].hypot(of_sources[1]);
    assert!(error < 0.02 * of_web[0].abs(), "{of_web:?} {of_sources:?}");
    assert!((of_web[0] - of_sources[0]).abs() < 3.5 * error, "{of_web:?} {of_sources:?}");
}

#[test]
fn rejects_lines_without_a_field_or_a_number_of_filaments() {
    let desk = Desk::new();
    fs::write(desk.path("air.vtk"), field()).unwrap();
    let refused = |text: &str, words: &str| {
        fs::write(desk.path("line.toml"), text).unwrap();
        let said = refusal(&mut desk.spunlaid("air line.toml --sources"), 1);
        assert!(said.contains("line.toml") && said.contains(words), "{said}");
    };
    refused(LINE, "filaments_per_metre = 5000");
    let uniform = LINE.replace("field = 'air.vtk'", "velocity = '20 m/s'");
    refused(&format!("{uniform}{FILAMENTS}"), "air.field");
    // A mistake of the web is reported as that, though the fibre could be read alone.
    let mistaken = FILAMENTS.replace("length = '0.1 m'", "length = '-1 m'");
    refused(&format!("{LINE}{mistaken}"), "length = ");
    let (head, tail) = LINE.split_once("[feed]").unwrap();
    let fixed = format!("{head}length = '0.1 m'\n{}", &tail[tail.find("[air]").unwrap()..]);
    refused(&fixed, "[feed] and [belt]");
}
