//! Fits of webs to scans: the loop is closed with simulated webs, whose values are known.

use spunlaid::error::Error;
use spunlaid::fit::{Fit, MeasuredWeb, Question, Target, fit};
use spunlaid::input::{FitFile, Overrides, parse_fit};
use spunlaid::lanes::Isa;
use spunlaid::layers::{Flights, Flyer};
use spunlaid::scan::{Format, Light, Picture, Settings, analyse};
use spunlaid::study::Journal;
use spunlaid::web::{Laying, Map};
use std::sync::atomic::{AtomicBool, AtomicU64};

const SMALL: &str = "version = 1
[fibre]
diameter = \"18 µm\"
density = \"910 kg/m³\"
[laydown]
sigma_md = \"9 mm\"
sigma_cd = \"9 mm\"
noise = \"12 m^-0.5\"
[line]
feed_speed = \"50 m/s\"
belt_speed = \"5 m/s\"
filaments_per_metre = 250
[web]
width = \"200 mm\"
length = \"200 mm\"
cell = \"0.5 mm\"
";

fn read(text: &str, vary: &[&str]) -> FitFile {
    let none = Overrides { values: &[], word: "--set" };
    let vary: Vec<String> = vary.iter().map(|key| (*key).to_owned()).collect();
    parse_fit(text.to_owned(), "web.toml", none, &vary, "--vary").unwrap()
}

static STOP: AtomicBool = AtomicBool::new(false);

/// The map of a web of these values.
fn laid(file: &FitFile, values: &[f64], seed: u64) -> Map {
    let mut spec = file.web(values).unwrap().spec;
    spec.seed = seed;
    let follow = |_: Flights<'_>, work: &mut (dyn FnMut() + Send)| work();
    let laid = AtomicU64::new(0);
    let by = Laying { threads: 1, isa: Isa::detect(), stop: &STOP, laid: &laid };
    Flyer::new(1, &STOP, &follow).web(&spec).unwrap().map(by).unwrap()
}

/// A map as a scanner of 16 bits sees it, with a lamp whose level is known.
fn scanned(map: &Map) -> MeasuredWeb {
    let mean = map.total() as f64 / map.cells.len() as f64;
    let level = |cell: &u32| (50_000.0 * (-0.7 * f64::from(*cell) / mean).exp()).round();
    let picture = Picture {
        file: "scan.tif".to_owned(),
        format: Format::Tiff,
        values: map.cells.iter().map(level).collect(),
        columns: map.columns,
        rows: map.rows,
        pixel: map.cell,
        pixel_of_file: Some(map.cell),
        full_scale: Some(65535.0),
        weight_of_black: None,
        colour: false,
        more: false,
    };
    let light = Light::Transmitted { mean: None, white: Some(50_000.0) };
    let settings = Settings { keep_shading: true, keep_spots: true, ..Settings::new(light) };
    MeasuredWeb::of_scan(&analyse(&picture, &settings).unwrap())
}

fn fitted(
    file: &FitFile,
    scan: &MeasuredWeb,
    spectrum: bool,
    webs: u64,
    journal: &mut Journal,
) -> Result<Fit, Error> {
    let target = Target::new(scan, &file.start.spec.sheet, spectrum)?;
    let make = |values: &[f64]| Ok(file.web(values)?.spec);
    let question = Question { parameters: &file.parameters, target: &target, make: &make, webs };
    let follow = |_: Flights<'_>, work: &mut (dyn FnMut() + Send)| work();
    let laid = AtomicU64::new(0);
    let by = Laying { threads: 1, isa: Isa::detect(), stop: &STOP, laid: &laid };
    fit(question, Flyer::new(1, &STOP, &follow), by, journal, &|_| {})
}

/// How many intervals of so many closed loops hold the value with which the scanned web was laid; by key.
fn coverage(vary: &[&str], truth: &[f64], spectrum: bool, loops: u64) -> Vec<u64> {
    let file = read(SMALL, vary);
    let mut hits = vec![0; truth.len()];
    for seed in 1000..1000 + loops {
        let scan = scanned(&laid(&file, truth, seed));
        let found = fitted(&file, &scan, spectrum, 20, &mut Journal::in_memory(200)).unwrap();
        for ((key, truth), hits) in found.keys.iter().zip(truth).zip(&mut hits) {
            let [low, high] = key.interval.clone().unwrap();
            *hits += u64::from((low..=high).contains(truth));
        }
        let keys: Vec<_> =
            found.keys.iter().map(|key| (key.value, key.interval.clone().unwrap(), key.doubt)).collect();
        println!(
            "{keys:?} misfit {:?} worse {} trials {} {}",
            found.misfit,
            found.worse,
            found.trials.len(),
            found.settled
        );
    }
    hits
}

#[test]
fn the_values_of_a_scanned_simulated_web_lie_in_the_intervals() {
    let hits = coverage(&["laydown.noise", "line.filaments_per_metre"], &[16.0, 350.0], false, 20);
    println!("{hits:?}");
    assert!(hits.iter().all(|hits| *hits >= 15), "{hits:?} of 20");
}

/// 100 closed loops, for docs/validation.md.
#[test]
#[ignore = "takes minutes"]
fn coverage_of_a_hundred_loops() {
    for spectrum in [false, true] {
        let hits = coverage(&["laydown.noise", "line.filaments_per_metre"], &[16.0, 350.0], spectrum, 100);
        println!("spectrum {spectrum}: {hits:?} of 100");
    }
}
