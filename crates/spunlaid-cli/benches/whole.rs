//! What a whole run costs, as a multiple of its kernel: the program from its start to its end, with its
//! records, tables, figures and report.
//!
//!     cargo bench -p spunlaid-cli                   # two minutes
//!
//! Table 1 with implicit tension and steps of 500 µs on one thread: of all usual runs the one whose flights
//! cost least beside what is recorded. Processor time, the least of some runs taken in turn; ratios hold on a
//! busy machine. What was found is in `docs/validation.md`.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use cpu_time::ThreadTime;
use spunlaid_fibre::{Flight, Job};
use spunlaid_ground::{Isa, WIDTH};
use spunlaid_input::read_case;
use std::hint::black_box;
use std::path::PathBuf;
use std::process::Command;

const SET: [(&str, &str); 2] = [("run.scheme", "implicit-tension"), ("run.time_step", "500 us")];
/// Number of fibres and time between recorded instants.
const RUNS: [(u64, &str); 4] = [(8, "1 ms"), (1000, "100 ms"), (1000, "1 ms"), (4000, "1 ms")];
const ROUNDS: usize = 5;
/// Flights of eight fibres from which the cost of the kernel is found.
const FLIGHTS: u64 = 20;

fn main() {
    let (mut kernel, mut whole) = (f64::INFINITY, [f64::INFINITY; RUNS.len()]);
    for _ in 0..ROUNDS {
        kernel = kernel.min(kernel_of_a_fibre());
        for (least, (fibres, interval)) in whole.iter_mut().zip(RUNS) {
            *least = least.min(run(fibres, interval) / fibres as f64);
        }
    }
    println!("\nwhole runs of Table 1 at 500 µs, one thread, processor time of a fibre's second");
    println!("  the kernel with its turbulence: {:.3} ms", kernel * 1e3);
    println!("  {:>7} {:>8} {:>11} {:>16}", "fibres", "records", "a fibre", "over the kernel");
    for ((fibres, interval), time) in RUNS.iter().zip(whole) {
        println!("  {fibres:>7} {interval:>8} {:>8.3} ms {:>16.2}", time * 1e3, time / kernel);
    }
}

fn table1() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../cases/table1.toml")
}

/// Processor time of a fibre that flies for its second without any record [s].
fn kernel_of_a_fibre() -> f64 {
    let set = SET.map(|(key, value)| (key.to_owned(), value.to_owned()));
    let case = read_case(&table1(), &set).unwrap().0;
    let started = ThreadTime::now();
    for first in 0..FLIGHTS {
        let replicates = first * WIDTH as u64..(first + 1) * WIDTH as u64;
        let jobs: Vec<_> = replicates.map(|replicate| Job::new(&case, replicate)).collect();
        let mut flight = Flight::new(&jobs, Isa::detect()).unwrap();
        flight.advance(case.run.steps);
        black_box(flight.snapshot());
    }
    started.elapsed().as_secs_f64() / (FLIGHTS * WIDTH as u64) as f64
}

/// Processor time of a run of the program, that of the system included [s].
fn run(fibres: u64, interval: &str) -> f64 {
    let desk = tempfile::tempdir().unwrap();
    let [scheme, step] = SET.map(|(key, value)| format!("--set '{key}={value}'"));
    let program = env!("CARGO_BIN_EXE_spunlaid");
    let command = format!(
        "{program} run '{}' --threads 1 --replicates {fibres} {scheme} {step} --set 'run.output_interval={interval}' \
         --out r --quiet && times",
        table1().display()
    );
    let output = Command::new("sh").current_dir(&desk).args(["-c", &command]).output().unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
    // The last line has what the children took: 1m2.345s 0m0.678s
    let of_children = said.lines().last().unwrap_or_else(|| panic!("no times in {said}"));
    let seconds = |time: &str| {
        let (minutes, seconds) = time.trim_end_matches('s').split_once('m')?;
        Some(60.0 * minutes.parse::<f64>().ok()? + seconds.parse::<f64>().ok()?)
    };
    of_children
        .split_whitespace()
        .map(|time| seconds(time).unwrap_or_else(|| panic!("no times in {said}")))
        .sum()
}
