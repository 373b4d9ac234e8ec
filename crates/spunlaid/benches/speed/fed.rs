//! The fed chain: `cases/spunbond.toml` on its way to the belt, against a chain of fixed length.

use crate::measure::{Trial, in_rounds, processor_time};
use crate::title;
use spunlaid_fibre::{Case, Flight, Job};
use spunlaid_ground::{Isa, WIDTH};
use spunlaid_input::read_case;
use std::path::Path;

/// Time after which the fibre has come down [s], and time that is simulated for a figure [s].
const DOWN: f64 = 0.05;
const FLOWN: f64 = 0.21;

/// Fed chains of two meshes, each beside a chain of fixed length with as many elements and the same step.
pub fn against_fixed() {
    title(
        "fed: spunbond.toml, turbulence and laid points included, beside a chain of fixed length in uniform air",
    );
    println!("  mesh   elements   fed [ns]   fixed [ns]   ratio   core seconds per fibre-second");
    for mesh in ["4 mm", "2 mm"] {
        let fed = case("spunbond.toml", &[("fibre.element_length", mesh.to_owned())]);
        let h = fed.run.time_step;
        let start = flight(&fed);
        let elements = start.chain().elements();
        let length = elements as f64 * fed.fibre.rest_length();
        let fixed = case(
            "diffuser.toml",
            &[
                ("run.scheme", "implicit-tension".to_owned()),
                ("run.time_step", format!("{h:e} s")),
                ("fibre.element_length", mesh.to_owned()),
                ("fibre.length", format!("{length:e} m")),
            ],
        );
        let mut trials = [trial(start, h), trial(flight(&fixed), h)];
        in_rounds(&mut trials, 1.0);
        let [fed, fixed] = trials.each_ref().map(Trial::each);
        let whole = fed * elements as f64 / h;
        println!(
            "  {mesh}   {elements:>8}   {:>8.1}   {:>10.1}   {:>5.2}   {whole:.3}",
            fed * 1e9,
            fixed * 1e9,
            fed / fixed
        );
    }
}

fn case(name: &str, set: &[(&str, String)]) -> Case {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(name);
    let mut set: Vec<(String, String)> =
        set.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect();
    set.push(("run.duration".to_owned(), "1 s".to_owned()));
    read_case(&path, &set).expect("a case that can be read").0
}

/// Eight fibres after their start.
fn flight(case: &Case) -> Flight {
    let jobs: Vec<Job<'_>> = (0..WIDTH as u64).map(|replicate| Job::new(case, replicate)).collect();
    let mut flight = Flight::new(&jobs, Isa::detect()).expect("a case that flies");
    flight.advance((DOWN / case.run.time_step) as u64);
    flight
}

/// Flies on from a state, for as long as a window of turbulence lasts, so that its making counts too.
fn trial(start: Flight, h: f64) -> Trial<'static> {
    let steps = (FLOWN / h) as u64;
    let amount = (steps * start.chain().elements() as u64 * WIDTH as u64) as f64;
    Trial::new(amount, move || {
        let mut flight = start.clone();
        processor_time(|| flight.advance(steps))
    })
}
