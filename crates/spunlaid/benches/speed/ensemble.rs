//! Whole ensembles: turbulence, flight, records and statistics.

use crate::common::table1;
use crate::flights::trajectories_of;
use crate::measure::{Trial, in_rounds, processor_time};
use crate::title;
use cpu_time::ProcessTime;
use spunlaid_fibre::Case;
use spunlaid_fibre::chain::Scheme;
use spunlaid_ground::{Error, Isa, RunContext, WIDTH};
use spunlaid_simulation::ensemble::{fly, turbulence_spectrum};
use spunlaid_simulation::{Recorded, Results};
use std::hint::black_box;
use std::sync::atomic::{AtomicBool, AtomicU64};
use std::time::Instant;

fn computing<'a>(threads: usize, stop: &'a AtomicBool, fibre_steps: &'a AtomicU64) -> RunContext<'a> {
    RunContext { threads, isa: Isa::detect(), stop, done: fibre_steps }
}

fn fly_all(case: &Case, threads: usize) {
    let (stop, fibre_steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let mut collector = Results::collector(0);
    let done: Result<(), Error> =
        fly(case, Recorded::NUMBERS, computing(threads, &stop, &fibre_steps), |flight| {
            collector.take(flight);
            Ok(())
        });
    done.expect("the case flies");
    black_box(collector.finish());
}

/// A second of a fibre of Table 1, all included, in a large ensemble.
pub fn costs() {
    title(
        "a second of a Table 1 fibre: turbulence, flight, a record each millisecond, statistics; one thread",
    );
    let kinds = [
        (Scheme::SemiImplicitEuler, 1e-6, 1e-3),
        (Scheme::SemiImplicitEuler, 2e-5, 1e-3),
        (Scheme::Leapfrog, 2e-5, 1e-3),
        (Scheme::ImplicitTension, 1e-4, 1e-3),
        (Scheme::ImplicitTension, 2e-4, 1e-3),
        (Scheme::ImplicitTension, 2e-4, 1e-2),
        (Scheme::ImplicitTension, 5e-4, 1e-3),
        (Scheme::ImplicitTension, 5e-4, 1e-2),
        (Scheme::ImplicitTension, 8e-4, 1e-3),
        (Scheme::ImplicitTension, 1e-3, 1e-3),
    ];
    let cases = kinds.map(|(scheme, h, interval)| {
        let mut case = table1(scheme, h, 1.0, WIDTH as u64);
        case.run.output_steps = ((interval / h).round() as u64).max(1);
        case
    });
    // Flown on one thread here, so that its processor time is all there is.
    let mut trials: Vec<Trial<'_>> = Vec::new();
    for case in &cases {
        trials.push(Trial::new(WIDTH as f64, || processor_time(|| drop(black_box(trajectories_of(case))))));
        let flights = trajectories_of(case);
        trials.push(Trial::new(WIDTH as f64, move || {
            let mut collector = Results::collector(0);
            let time = {
                let flights = flights.clone();
                processor_time(|| flights.into_iter().for_each(|flight| collector.take(flight)))
            };
            black_box(collector.finish());
            time
        }));
    }
    in_rounds(&mut trials, 0.5);
    println!(
        "  {:<22} {:>6} {:>8} {:>12} {:>12} {:>12}",
        "scheme", "step", "record", "flight", "statistics", "all"
    );
    for ((scheme, h, interval), pair) in kinds.iter().zip(trials.chunks(2)) {
        let (flight, statistics) = (pair[0].each() * 1e3, pair[1].each() * 1e3);
        println!(
            "  {:<22} {:>3} µs {:>5} ms {flight:>9.3} ms {statistics:>9.3} ms {:>9.3} ms",
            scheme.name(),
            (h * 1e6).round(),
            interval * 1e3,
            flight + statistics
        );
    }
    let case = &cases[4];
    let (stop, fibre_steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let once = computing(1, &stop, &fibre_steps);
    let mut trials =
        [Trial::new(1.0, || processor_time(|| drop(black_box(turbulence_spectrum(case, once)))))];
    in_rounds(&mut trials, 0.3);
    println!("  the spectrum of the turbulence, once per run: {:.1} ms", trials[0].each() * 1e3);
}

/// Two threads against one: by the clock on the wall, of use on a machine with nothing else to do, and by
/// the processor time of all threads, which reports what sharing the work out costs.
pub fn threads() {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    title(&format!("threads: 128 fibres of Table 1 at 200 µs ({cores} cores)"));
    let case = &table1(Scheme::ImplicitTension, 2e-4, 1.0, 128);
    let mut trials: Vec<Trial<'_>> = Vec::new();
    for threads in [1, 2] {
        trials.push(Trial::new(1.0, move || {
            let started = Instant::now();
            fly_all(case, threads);
            started.elapsed()
        }));
        trials.push(Trial::new(1.0, move || {
            let started = ProcessTime::now();
            fly_all(case, threads);
            started.elapsed()
        }));
    }
    in_rounds(&mut trials, 4.0);
    let time = |i: usize| trials[i].each() * 1e3;
    println!(
        "  wall time: one {:.1} ms, two {:.1} ms: {:.2} times as fast",
        time(0),
        time(2),
        time(0) / time(2)
    );
    println!("  processor time: one {:.1} ms, two {:.1} ms", time(1), time(3));
}
