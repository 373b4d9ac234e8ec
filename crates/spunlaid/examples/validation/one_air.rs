//! The numbers of webs in one air and of their fabrics: the errors that are told, against the scatter of many webs.

use crate::title;
use spunlaid::input::parse_web;
use spunlaid::lanes::Isa;
use spunlaid::layers::Flyer;
use spunlaid::observe::{Measure, OF_FABRIC_PATCHES, OF_FABRICS, OF_WEBS, measured};
use spunlaid::web::LayControl;
use std::sync::atomic::{AtomicBool, AtomicU64};

const SEEDS: u64 = 24;

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

/// Prints a row of the table for each number of three lines.
pub fn errors() {
    let line = |widening: &str| LINE.replace("AIR", AIR).replace("WIDENING", widening);
    let slot = |depth: &str| format!("{}filaments_per_metre = 5000\ndepth = \"{depth}\"\n", line("md"));
    let row = format!("{}rows = [{{ pitch = \"0.2 mm\", filaments = 1000 }}]\n", line("none"));
    for (name, file) in [("row", row), ("slot", slot("20 mm")), ("wide slot", slot("60 mm"))] {
        title(&format!("Errors of webs in one air: {name}, {SEEDS} webs"));
        let webs: Vec<Vec<Told>> = (1..=SEEDS).map(|seed| numbers(&file, seed)).collect();
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

/// What is told of the web of a seed.
fn numbers(file: &str, seed: u64) -> Vec<Told> {
    let seed = ("web.seed".to_owned(), seed.to_string());
    let spec = parse_web(file, "web.toml", &[seed]).unwrap_or_else(|_| panic!("a web")).spec;
    let (stop, laid) = (AtomicBool::new(false), AtomicU64::new(0));
    let by = LayControl { threads: 2, isa: Isa::detect(), stop: &stop, laid: &laid };
    let mut flown = Flyer::new(2, &stop, &|_, work| work()).web(&spec).expect("a flight");
    let found = flown.find(by).expect("findings");
    let fabric = spec.fabric(&flown.web, &found, 2);
    let of_patch = |patch: &spunlaid::web::PatchFindings| {
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

fn add<T>(all: &mut Vec<Told>, measures: &'static [Measure<T>], found: &T, of: &str) {
    let rows = measured(measures, found).filter_map(|row| {
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
