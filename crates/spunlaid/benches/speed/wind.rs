//! The turbulence: making it, and asking for it.

use crate::common::*;
use crate::kernel::Setup;
use crate::measure::{Trial, in_rounds, processor_time};
use crate::title;
use spunlaid_air::{Air, StreamKey, Wind};
use spunlaid_fibre::chain::Scheme;
use spunlaid_ground::{Isa, WIDTH};
use std::hint::black_box;

/// Synthesis per second of a fibre, and what the wind adds to a step.
pub fn costs() {
    title("turbulence of Table 1: 20 eddies, 256 harmonics, one second");
    let air = table1_air();
    let streams: Vec<(Air, StreamKey)> =
        (0..WIDTH as u64).map(|replicate| (air.clone(), StreamKey { seed: 1, replicate })).collect();
    let streams = &streams;
    let isas = Isa::available();
    let mut trials: Vec<Trial<'_>> = isas
        .iter()
        .map(|&isa| {
            Trial::new(WIDTH as f64, move || {
                processor_time(|| {
                    black_box(Wind::uniform(isa, streams, 20, 1.0).expect("fibres that agree").at(0.0));
                })
            })
        })
        .collect();
    in_rounds(&mut trials, 0.3);
    for (isa, trial) in isas.iter().zip(&trials) {
        println!("  synthesis, {:<10} {:>8.1} µs per second of a fibre", isa.name(), trial.each() * 1e6);
    }

    title("wind within a step: 20 eddies less one for the whole fibre [ns per eddy and step of a fibre]");
    let steps = [1e-6, 2e-5, 1e-4, 2e-4, 5e-4];
    let many = steps.map(Setup::table1);
    let one = steps.map(|h| Setup::of(1.0, 20, 2.0, 0.0, h));
    let mut trials = Vec::new();
    for (many, one) in many.iter().zip(&one) {
        for setup in [many, one] {
            trials.push(setup.trial(Isa::detect(), Scheme::ImplicitTension));
        }
    }
    in_rounds(&mut trials, 0.3);
    for (h, pair) in steps.iter().zip(trials.chunks(2)) {
        let more = (pair[0].each() - pair[1].each()) * 20.0 / 19.0;
        println!("  steps of {:>3} µs {:>6.2}", (h * 1e6).round(), more * 1e9);
    }
}
