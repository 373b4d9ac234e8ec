//! Memory of a flight that goes on: Table 1, eight fibres, for as many seconds as are asked for.
//!
//! `cargo run --release -p spunlaid --example endless -- 1000`
#![allow(clippy::expect_used, clippy::print_stdout)]

use spunlaid::fibre::{Flight, Job};
use spunlaid::ground::Isa;
use spunlaid::input::read_case;
use std::path::Path;

fn main() {
    let seconds: f64 = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(1.0);
    let changes = [("run.scheme", "implicit-tension"), ("run.time_step", "500 µs")];
    let changes = changes.map(|(key, value)| (key.to_owned(), value.to_owned()));
    let (case, _) = read_case(Path::new("cases/table1.toml"), &changes).expect("the case of the repository");
    let jobs: Vec<Job<'_>> = (0..8).map(|replicate| Job::new(&case, replicate)).collect();
    let mut flight = Flight::new(&jobs, Isa::detect()).expect("cases that fly together");
    flight.step_to(seconds).expect("a flight that stays finite");
    let amplitude = (0..8).map(|lane| flight.end_node().motion(lane, seconds).amplitude_y).sum::<f64>() / 8.0;
    println!("{seconds} s: amplitude {:.3} mm; peak memory {}", amplitude * 1e3, peak_memory());
}

/// What the system says of this process.
fn peak_memory() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    peak.map_or_else(|| "not reported by this system".to_owned(), |peak| peak.trim().to_owned())
}
