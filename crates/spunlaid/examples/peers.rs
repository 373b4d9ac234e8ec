//! This program's side of `bench/peers/run`: what other programs are compared with, and checked by.
//!
//!     cargo run --release --example peers -- FOLDER      # writes forces.csv, path.csv and wind.f64 there
//!     cargo run --release --example peers                # only measures
//!
//! Prints one line of JSON for each scheme and step: nanoseconds per element and step, processor time of a
//! second of a Table 1 fibre, how far its path is off.

// The tests' shared models come with the licences of tests.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../benches/speed/flights.rs"]
mod flights;
#[path = "../benches/speed/measure.rs"]
mod measure;

use common::*;
use flights::{Difference, compare, trajectories_of};
use measure::{Trial, in_rounds, processor_time};
use spunlaid::air::{Air, Eddies, StreamKey, Wind};
use spunlaid::fibre::chain::Scheme;
use spunlaid::fibre::{Case, Fibre, FibreParameters, Flight, Root};
use spunlaid::ground::{Isa, WIDTH};
use spunlaid::simulation::Trajectory;
use std::fmt::Write as _;
use std::fs;
use std::hint::black_box;
use std::path::Path;

/// Spacing of the table of the wind [s]: linear interpolation in it is off by 4e-5 of the turbulence.
const WIND_SPACING: f64 = 5e-5;
/// Steps that are timed and compared.
const STEPS: [(Scheme, f64); 8] = [
    (Scheme::SemiImplicitEuler, 1e-6),
    (Scheme::SemiImplicitEuler, 2e-5),
    (Scheme::Leapfrog, 2e-5),
    (Scheme::ImplicitTension, 1e-4),
    (Scheme::ImplicitTension, 2e-4),
    (Scheme::ImplicitTension, 5e-4),
    (Scheme::ImplicitTension, 8e-4),
    (Scheme::ImplicitTension, 1e-3),
];

fn main() {
    if let Some(folder) = std::env::args().nth(1) {
        let folder = Path::new(&folder);
        fs::write(folder.join("forces.csv"), forces()).expect("forces.csv is written");
        fs::write(folder.join("wind.f64"), wind()).expect("wind.f64 is written");
        fs::write(folder.join("path.csv"), path()).expect("path.csv is written");
    }
    measure();
}

/// Forces on crooked fibres, thin and thick, in a steady wind of 7 m/s along x.
fn forces() -> String {
    let mut rows = "state,diameter,length,elements,youngs_modulus,node,x,y,z,vx,vy,vz,fx,fy,fz\n".to_owned();
    let thick = Fibre { length: 0.05, diameter: 300e-6, youngs_modulus: 1e6, elements: 10, ..table1_fibre() };
    for (state, (fibre, angle)) in
        [(table1_fibre(), 0.01), (table1_fibre(), 0.3), (thick, 0.01), (thick, 0.3), (thick, 0.8)]
            .into_iter()
            .enumerate()
    {
        let fibre = Fibre { root: Root::Free, ..fibre };
        let drag = paper_drag().element_drag(&fibre, 1.204, 1.51e-5);
        let strand = FibreParameters { fibre, drag, gravity: 9.81, damping: 0.0 };
        let (mut at, mut heading) = (V::default(), X);
        let mut position = vec![at];
        for j in 0..fibre.elements {
            let turned = heading + scattered_vector(100 * state + j) * angle;
            heading = turned * (1.0 / turned.norm());
            at += heading * (fibre.rest_length() * (1.0 + 1e-4 * scatter(100 * state + j)));
            position.push(at);
        }
        let velocity: Vec<V> = (0..position.len()).map(|i| scattered_vector(1000 + i)).collect();
        let force = kernel_forces(&strand, 7.0, &position, &velocity);
        for (i, ((r, v), f)) in position.iter().zip(&velocity).zip(&force).enumerate() {
            let Fibre { diameter, length, elements, youngs_modulus, .. } = fibre;
            write!(rows, "{state},{diameter:e},{length:e},{elements},{youngs_modulus:e},{i}").expect("text");
            for value in [r.x, r.y, r.z, v.x, v.y, v.z, f.x, f.y, f.z] {
                write!(rows, ",{value:e}").expect("text");
            }
            rows.push('\n');
        }
    }
    rows
}

/// The wind of eight Table 1 fibres over a second: `[instant][eddy][component][fibre]`, little-endian `f64`.
fn wind() -> Vec<u8> {
    let turbulence = turbulence(1.0 + WIND_SPACING);
    let mut wind = turbulence.clone();
    let instants = (1.0 / WIND_SPACING).round() as usize + 1;
    (0..instants)
        .flat_map(|i| wind.at(i as f64 * WIND_SPACING))
        .flat_map(|v| [v.x, v.y, v.z])
        .flat_map(|lanes| lanes.0)
        .flat_map(f64::to_le_bytes)
        .collect()
}

fn turbulence(duration: f64) -> Wind {
    let streams: Vec<(Air, StreamKey)> =
        (0..WIDTH as u64).map(|replicate| (table1_air(), StreamKey { seed: 1, replicate })).collect();
    Wind::uniform(Isa::detect(), &streams, 20, duration).expect("fibres that agree")
}

/// The converged path of the end nodes of the eight, every millisecond.
fn path() -> String {
    let mut rows = "fibre,time,y,z\n".to_owned();
    for flight in converged() {
        for s in &flight.samples {
            writeln!(rows, "{},{},{:e},{:e}", flight.replicate, s.time, s.end.y, s.end.z).expect("text");
        }
    }
    rows
}

fn converged() -> Vec<Trajectory> {
    trajectories_of(&second(Scheme::Leapfrog, 2e-6))
}

fn second(scheme: Scheme, h: f64) -> Case {
    table1(scheme, h, 1.0, WIDTH as u64)
}

fn measure() {
    let turbulence = &turbulence(1.1);
    let eddies = &Eddies::along(1.0, 20, 0.05);
    let cases = STEPS.map(|(scheme, h)| second(scheme, h));
    let mut trials: Vec<Trial<'_>> = Vec::new();
    for case in &cases {
        let strands = [case.strand(); WIDTH];
        let (scheme, h) = (case.run.scheme, case.run.time_step);
        let steps = case.run.steps.min(2_000);
        let start = Flight::assembled(Isa::detect(), &strands, (eddies, turbulence), scheme, h)
            .expect("fibres that agree");
        trials.push(Trial::new((steps * 20) as f64, move || {
            let mut flight = start.clone();
            processor_time(|| flight.advance(steps))
        }));
        trials.push(Trial::new(WIDTH as f64, move || {
            processor_time(|| drop(black_box(trajectories_of(case))))
        }));
    }
    in_rounds(&mut trials, 0.5);
    let exact = converged();
    for (case, times) in cases.iter().zip(trials.chunks(2)) {
        let Difference { path, amplitude } = compare(&trajectories_of(case), &exact);
        let row = |fibres: usize| {
            let share = 1.0 / fibres as f64;
            println!(
                "{{\"program\": \"spunlaid, {}\", \"fibres\": {fibres}, \"step_s\": {:e}, \"ns\": {:.4}, \
                \"second_s\": {:.6e}, \"path_error\": {path:.3e}, \"amplitude_error\": {amplitude:.3e}}}",
                case.run.scheme.name(),
                case.run.time_step,
                times[0].each() * share * 1e9,
                // One fibre takes its flight's time; what is kept of the others counts little.
                times[1].each() * WIDTH as f64 * share,
            );
        };
        row(WIDTH);
        row(1);
    }
}
