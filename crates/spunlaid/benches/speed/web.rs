//! The web: paths of the surrogate, and paths drawn into the map of the basis weight.

use crate::measure::{Trial, in_rounds, processor_time};
use crate::title;
use spunlaid_ground::{Isa, Lanes, RunContext, WIDTH};
use spunlaid_web::map::{Filaments, lay};
use spunlaid_web::{Fibres, Layer, PathKey, Paths, Sheet, Surrogate, Web};
use std::sync::atomic::{AtomicBool, AtomicU64};

const SURROGATE: Surrogate = Surrogate { sigma_md: 18.4e-3, sigma_cd: 18.3e-3, noise: 12.4 };

/// Processor time for a metre of fibre.
pub fn costs() {
    title("web: sigma 18 mm, A 12.4, pieces of about a millimetre, one core");
    println!("  instructions   cell [mm]   paths [us/m]   paths and map [us/m]");
    for isa in Isa::available() {
        for cell in [1e-3, 0.5e-3] {
            let web = web(cell);
            let metres = web.fibre_length();
            let mut trials = [
                Trial::new(metres, move || processor_time(|| paths(isa, metres))),
                Trial::new(metres, move || {
                    let (stop, laid) = (AtomicBool::new(false), AtomicU64::new(0));
                    processor_time(|| {
                        let laying = RunContext { threads: 1, isa, stop: &stop, done: &laid };
                        lay(&web, laying).expect("a web that can be laid");
                    })
                }),
            ];
            in_rounds(&mut trials, 1.0);
            let [paths, both] = trials.each_ref().map(|trial| trial.each() * 1e6);
            println!("  {:<12}   {:>9.1}   {paths:>12.1}   {both:>20.1}", isa.name(), cell * 1e3);
        }
    }
}

fn web(cell: f64) -> Web {
    Web {
        sheet: Sheet::new(0.5, 0.6, cell),
        layers: vec![Layer {
            linear_density: 2.3e-7,
            feed_speed: 50.0,
            belt_speed: 3.0,
            filaments: Filaments::AtRandom { per_metre: 1024.0 },
            fibres: Fibres::Surrogate(SURROGATE),
            defects: Vec::new(),
        }],
        seed: 1,
    }
}

/// Paths that are only made.
fn paths(isa: Isa, metres: f64) {
    const PIECE: f64 = 1.1e-3;
    let keys: Vec<PathKey> = (0..WIDTH as u64).map(|fibre| PathKey { seed: 1, fibre }).collect();
    let mut paths = Paths::new(isa, SURROGATE, PIECE, &keys).expect("paths");
    let mut points = [[Lanes::ZERO; 2]; 256];
    for _ in 0..(metres / (PIECE * 256.0 * WIDTH as f64)) as usize {
        paths.fill(&mut points);
    }
}
