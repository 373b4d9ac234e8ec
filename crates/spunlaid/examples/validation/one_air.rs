//! The numbers of webs in one air and of their fabrics: the errors that are told, against the scatter of many webs.

use crate::title;
use spunlaid::ground::threads::each;
use spunlaid::ground::{Control, Isa, Measure, measure};
use spunlaid::input::read_web;
use spunlaid::simulation::Flyer;
use spunlaid::web::map::{Findings, PatchFindings};
use spunlaid::web::{Fabric, OF_FABRIC_PATCHES, OF_FABRICS, OF_WEBS};
use std::sync::atomic::{AtomicBool, AtomicU64};

const SEEDS: usize = 24;

/// The air of spunbond.toml.
const AIR: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/tables/spunbond.csv");
/// A small sheet in coarse elements, so that 72 webs take a quarter of an hour of a processor.
const LINE: &str = r#"
version = 1
[fibre]
diameter = "18 µm"
density = "910 kg/m³"
youngs_modulus = "2 GPa"
element_length = "8 mm"
root = "clamped"
[feed]
speed = "50 m/s"
[belt]
distance = "0.5 m"
speed = "3 m/s"
[air]
lateral = "von-karman"
lateral_cutoff = 10
profile = "AIR"
widening = "WIDENING"
[drag]
across = "marheineke-wegener"
[run]
duration = "1 s"
[web]
width = "0.2 m"
length = "0.2 m"
[line]
"#;

/// A number of a web with the error that is told of it.
type Told = (String, f64, Option<f64>);

/// Of each line the words that differ, and the filaments.
fn lines() -> [(&'static str, String); 3] {
    let line = |widening: &str| LINE.replace("AIR", AIR).replace("WIDENING", widening);
    let slot = |depth: &str| format!("{}filaments_per_metre = 5000\ndepth = \"{depth}\"\n", line("md"));
    let row = format!("{}rows = [{{ pitch = \"0.2 mm\", filaments = 1000 }}]\n", line("none"));
    [("row", row), ("slot", slot("20 mm")), ("wide slot", slot("60 mm"))]
}

/// Prints a row of the table for each number of three lines.
pub fn errors() {
    for (name, file) in lines() {
        title(&format!("Errors of webs in one air: {name}, {SEEDS} webs"));
        let webs = each(processors(), SEEDS, |web| numbers(&file, &[("web.seed", &(web + 1).to_string())]));
        println!("  number                                    mean   scatter      told  ratio  within one");
        for (name, _, _) in &webs[0] {
            let of_all: Vec<(f64, Option<f64>)> = (webs.iter().flatten())
                .filter(|(other, _, _)| other == name)
                .map(|(_, value, error)| (*value, *error))
                .collect();
            print_row(name, &of_all);
        }
    }
}

fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// What is told of a web with some keys set.
fn numbers(file: &str, set: &[(&str, &str)]) -> Vec<Told> {
    let (found, fabric) = web(file, set);
    let of_patch = |patch: &PatchFindings| {
        let told = patch.told()?;
        Some((format!("CV over {} mm", 1e3 * told.patch), told.cv, patch.whole_error().whole()))
    };
    let mut all: Vec<Told> = found.patches.iter().filter_map(of_patch).collect();
    add(&mut all, OF_WEBS, &found, "");
    add(&mut all, OF_FABRICS, &fabric, "");
    for patch in &fabric.patches {
        add(&mut all, OF_FABRIC_PATCHES, patch, &format!(", {} mm", 1e3 * patch.thin.patch));
    }
    all
}

fn web(file: &str, set: &[(&str, &str)]) -> (Findings, Fabric) {
    let set: Vec<_> = set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let spec = read_web((file, "web.toml"), &set).unwrap_or_else(|_| panic!("a web")).spec;
    let (stop, laid) = (AtomicBool::new(false), AtomicU64::new(0));
    let by = Control { threads: 1, isa: Isa::detect(), stop: &stop, done: &laid };
    let mut flown = Flyer::new(1, &stop, &|_, work| work()).web(&spec).expect("a flight");
    let found = flown.find(by).expect("findings");
    let fabric = spec.fabric(&flown.web, &found, 1);
    (found, fabric)
}

/// What sets one line of twelve apart: its filaments, one of [`lines`], and its keys.
type OneOfTwelve = (&'static str, usize, &'static [(&'static str, &'static str)]);
const TWELVE: [OneOfTwelve; 12] = [
    ("row", 0, &[]),
    ("slot of 20 mm", 1, &[]),
    ("slot of 60 mm", 2, &[]),
    ("slot of 10 mm", 1, &[("line.depth", "10 mm")]),
    ("row, small eddies", 0, &[("air.length_factor", "0.5")]),
    ("slot of 20 mm, small eddies", 1, &[("air.length_factor", "0.5")]),
    ("row, thick filaments", 0, &[("fibre.diameter", "30 µm"), ("feed.speed", "25 m/s")]),
    ("slot of 20 mm, thick filaments", 1, &[("fibre.diameter", "30 µm"), ("feed.speed", "25 m/s")]),
    ("slot of 20 mm, fast belt", 1, &[("belt.speed", "8 m/s")]),
    ("slot of 60 mm, fast belt", 2, &[("belt.speed", "8 m/s")]),
    ("slot of 20 mm, near belt", 1, &[("belt.distance", "0.3 m")]),
    ("slot of 20 mm, strong turbulence", 1, &[("air.intensity_factor", "1.5")]),
];

/// Webs of each of the twelve lines, unless another number is asked for.
const AIRS: usize = 6;

/// Prints for twelve lines how far a few filaments are off all of them in the same air.
pub fn few_and_all() {
    let airs = std::env::args().find_map(|word| word.parse().ok()).unwrap_or(AIRS);
    title(&format!(
        "A few filaments less all of them in the same air, {airs} webs of each line [points of CV]"
    ));
    println!("  line                            patch       all     told    (rms)    error  untold");
    let webs = each(processors(), airs * TWELVE.len(), |number| {
        let (_, line, set) = TWELVE[number / airs];
        let seed = (1 + number % airs).to_string();
        ["\"all\"", "\"auto\""].map(|flown| {
            let set = [set, &[("web.flown", flown), ("web.seed", &seed)]].concat();
            web(&lines()[line].1, &set).0.patches
        })
    });
    for ((name, ..), webs) in TWELVE.iter().zip(webs.chunks(airs)) {
        for patch in 0..webs[0][0].len() {
            let mean = |of: &dyn Fn(&PatchFindings, &PatchFindings) -> f64| {
                webs.iter().map(|[all, few]| of(&all[patch], &few[patch])).sum::<f64>() / webs.len() as f64
            };
            let error = |few: &PatchFindings| few.few.map_or(0.0, |few| few.by_pitch);
            let root = |of: &dyn Fn(&PatchFindings, &PatchFindings) -> f64| {
                100.0 * mean(&|all, few| of(all, few).powi(2)).sqrt()
            };
            println!(
                "  {name:32} {:2.0} mm  {:8.2} {:+8.2} {:8.2} {:8.2}  {}",
                1e3 * webs[0][0][patch].map.patch,
                100.0 * mean(&|all, _| all.map.cv),
                100.0 * mean(&|all, few| few.map.cv - all.map.cv),
                root(&|all, few| few.map.cv - all.map.cv),
                root(&|_, few| error(few)),
                webs.iter().filter(|[_, few]| few[patch].doubt.is_some()).count(),
            );
        }
    }
}

fn add<T>(all: &mut Vec<Told>, measures: &'static [Measure<T>], found: &T, of: &str) {
    let rows = measure::measured(measures, found).filter_map(|row| {
        let name = format!("{}{of}", row.measure.entry());
        Some((name, row.value.as_ref()?.number(), row.error))
    });
    all.extend(rows.filter(|(_, _, error)| error.is_some()));
}

fn print_row(name: &str, webs: &[(f64, Option<f64>)]) {
    let count = webs.len() as f64;
    let mean = webs.iter().map(|of| of.0).sum::<f64>() / count;
    let scatter = (webs.iter().map(|of| (of.0 - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt();
    let told: Vec<(f64, f64)> = webs.iter().filter_map(|(value, error)| Some((*value, (*error)?))).collect();
    let error = (told.iter().map(|of| of.1 * of.1).sum::<f64>() / told.len() as f64).sqrt();
    let held = told.iter().filter(|(value, error)| (value - mean).abs() < *error).count();
    println!(
        "  {name:38} {mean:9.4} {scatter:9.4} {error:9.4}  {:5.2}  {held}/{}",
        error / scatter,
        told.len()
    );
}
