//! Closed loops: webs of known values are laid, scanned, and fitted.
#![allow(dead_code)]

use spunlaid_experiment::fit::{errors_of_model, fit};
use spunlaid_experiment::{Fit, Journal, MeasuredWeb, Question, Target};
use spunlaid_ground::{Error, Isa, RunContext};
use spunlaid_input::{FitFile, Overrides, Resources, read_fit};
use spunlaid_simulation::{Flights, Flyer};
use spunlaid_web::scan::analyse;
use spunlaid_web::{Format, Light, Map, Picture, Settings};
use std::sync::atomic::{AtomicBool, AtomicU64};

/// A small web that is laid in a tenth of a second.
pub const SMALL: &str = "version = 1
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

pub fn read(text: &str, vary: &[&str]) -> FitFile {
    let none = Overrides::new(&[], "--set");
    let vary: Vec<String> = vary.iter().map(|key| (*key).to_owned()).collect();
    read_fit((text, "web.toml"), none, &vary, "--vary").unwrap()
}

static STOP: AtomicBool = AtomicBool::new(false);

/// The map of a web of these values.
pub fn laid(file: &FitFile, values: &[f64], seed: u64) -> Map {
    let mut spec = file.web(values, &Resources::default()).unwrap().spec;
    spec.seed = seed;
    let follow = |_: Flights<'_>, work: &mut (dyn FnMut() + Send)| work();
    let laid = AtomicU64::new(0);
    let by = RunContext { threads: 1, isa: Isa::detect(), stop: &STOP, done: &laid };
    Flyer::new(1, &STOP, &follow).web(&spec).unwrap().map(by).unwrap()
}

/// A map as a scanner of 16 bits sees it, with a lamp whose level is known. So thin a web lets light through
/// even where fibres cross.
pub fn scanned(map: &Map) -> MeasuredWeb {
    let mean = map.total() as f64 / map.cells.len() as f64;
    let level = |cell: &u32| (50_000.0 * (-0.1 * f64::from(*cell) / mean).exp()).round();
    let picture = Picture {
        file: "scan.tif".to_owned(),
        format: Format::Tiff,
        values: map.cells.iter().map(level).collect(),
        columns: map.columns,
        rows: map.rows,
        pixel: map.cell,
        pixel_of_file: Some(map.cell),
        full_scale: Some(65535.0),
        fewer_bits: None,
        weight_of_black: None,
        colour: false,
        coding: None,
        more: false,
        transparent: 0,
        clipped: 0,
        numbered: [false; 2],
    };
    let light = Light::Transmitted { mean: None, white: Some(50_000.0) };
    let settings = Settings { keep_shading: true, keep_spots: true, ..Settings::new(light) };
    MeasuredWeb::from_scan(&analyse(&picture, &settings).unwrap())
}

pub fn fitted(
    file: &FitFile,
    scan: &MeasuredWeb,
    spectrum: bool,
    webs: u64,
    journal: &mut Journal,
) -> Result<Fit, Error> {
    asked(file, scan, spectrum, webs, |question, flyer, by| fit(question, flyer, by, journal, &|_| {}))
}

/// How far the numbers of simulated webs are off by causes other than chance.
pub fn model_errors(file: &FitFile, scan: &MeasuredWeb) -> Result<Vec<Vec<f64>>, Error> {
    asked(file, scan, false, 8, errors_of_model)
}

/// Asks a question about a scan.
fn asked<T>(
    file: &FitFile,
    scan: &MeasuredWeb,
    spectrum: bool,
    webs: u64,
    ask: impl FnOnce(Question<'_>, Flyer<'_>, RunContext<'_>) -> Result<T, Error>,
) -> Result<T, Error> {
    let target = Target::new(scan, &file.start.spec.sheet, spectrum)?;
    let make = |values: &[f64]| Ok(file.web(values, &Resources::default())?.spec);
    let question = Question { parameters: &file.parameters, target: &target, make: &make, webs };
    let follow = |_: Flights<'_>, work: &mut (dyn FnMut() + Send)| work();
    let laid = AtomicU64::new(0);
    let by = RunContext { threads: 1, isa: Isa::detect(), stop: &STOP, done: &laid };
    ask(question, Flyer::new(1, &STOP, &follow), by)
}

/// Webs of known values, each scanned and fitted.
///
/// * `webs` – in each trial
pub fn closed_loops(vary: &[&str], truth: &[f64], spectrum: bool, loops: u64, webs: u64) -> Vec<Fit> {
    let file = read(SMALL, vary);
    let one = |seed: u64| {
        let scan = scanned(&laid(&file, truth, seed));
        fitted(&file, &scan, spectrum, webs, &mut Journal::in_memory()).unwrap()
    };
    (1000..1000 + loops).map(one).collect()
}

/// How many intervals lie below the truth, hold it, lie above it; by key.
pub fn coverage(fits: &[Fit], truth: &[f64]) -> Vec<[usize; 3]> {
    let of_key = |(key, truth): (usize, &f64)| {
        let mut counts = [0; 3];
        for fit in fits {
            let [low, high] = fit.keys[key].interval.clone().unwrap();
            let place = usize::from(*truth <= high) + usize::from(*truth < low);
            counts[place] += 1;
        }
        counts
    };
    truth.iter().enumerate().map(of_key).collect()
}
