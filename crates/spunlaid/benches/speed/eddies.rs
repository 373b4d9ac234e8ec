//! Looks at the field of eddies of a web in shared turbulence.

use crate::measure::{Trial, in_rounds, processor_time};
use crate::title;
use spunlaid_ground::{Isa, Vec3, WIDTH};
use spunlaid_input::read_case;
use std::hint::black_box;
use std::path::Path;

/// Places along a filament, and filaments beside each other.
const ALONG: usize = 128;
const BESIDE: usize = 64;
/// Instants of a trial, and the time between two [s].
const INSTANTS: usize = 8;
const APART: f64 = 160e-6;

/// Nanoseconds of a look: places along filaments of `cases/spunbond_slot.toml` that hang 0.2 mm beside each
/// other, as those of a web do.
pub fn looks() {
    title("a look at the field of eddies of spunbond_slot.toml, at places along 64 neighbours [ns]");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/spunbond_slot.toml");
    let case = read_case(&path, &[]).expect("a case that can be read").0;
    let place = |filament: usize, i: usize| {
        let swing = 10e-3 * (i as f64 / 20.0).sin();
        Vec3::new(4e-3 * i as f64, swing, 0.2e-3 * filament as f64 + swing)
    };
    // Eight neighbours at a time.
    let packs = (0..BESIDE).step_by(WIDTH);
    let places: Vec<Vec3<f64>> = packs
        .flat_map(|pack| {
            (0..ALONG).flat_map(move |i| (pack..pack + WIDTH).map(move |filament| place(filament, i)))
        })
        .collect();
    for isa in Isa::available() {
        let mut air = case.air_at_places(0, 2).expect("a field of eddies").with_instructions(isa);
        air.velocities(0.0, &places).expect("the field around the places");
        let mut trials = [
            Trial::new((INSTANTS * places.len()) as f64, || {
                processor_time(|| {
                    for instant in 0..INSTANTS {
                        black_box(air.velocities(APART * instant as f64, &places).expect("velocities"));
                    }
                })
            }),
            // The mean flow, which is looked up by itself.
            Trial::new((INSTANTS * places.len()) as f64, || {
                let mut hint = spunlaid_air::Hint::default();
                processor_time(|| {
                    for _ in 0..INSTANTS {
                        for place in &places {
                            black_box(case.air.local(*place, &mut hint));
                        }
                    }
                })
            }),
        ];
        in_rounds(&mut trials, 1.0);
        let [both, mean] = trials.each_ref().map(|trial| trial.each() * 1e9);
        println!("  {:<12}   {:>6.0}   ({mean:.0} for the mean flow not counted)", isa.name(), both - mean);
    }
}
