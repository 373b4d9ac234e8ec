//! Whole ensembles: turbulence, flight, records and statistics.

use crate::common::*;
use crate::measure::{Trial, in_rounds, processor_time};
use crate::title;
use spunlaid::case::{Case, Run};
use spunlaid::chain::schemes::Scheme;
use spunlaid::ensemble::{Computing, Flight, KeepShapes, Results, fly, fly_together};
use spunlaid::ensemble::{Job, turbulence_spectrum};
use spunlaid::error::Error;
use spunlaid::lanes::{Isa, WIDTH};
use std::hint::black_box;
use std::sync::atomic::{AtomicBool, AtomicU64};
use std::time::Instant;

fn table1(scheme: Scheme, h: f64, duration: f64, replicates: u64) -> Case {
    let run = Run {
        time_step: h,
        steps: (duration / h).round() as u64,
        spin_up_steps: 0,
        output_steps: ((1e-3 / h).round() as u64).max(1),
        replicates,
        seed: 1,
        scheme,
        gravity: 9.81,
        damping: 0.0,
    };
    Case { fibre: table1_fibre(), air: table1_air(), drag: paper_drag(), run }
}

fn computing<'a>(threads: usize, stop: &'a AtomicBool, fibre_steps: &'a AtomicU64) -> Computing<'a> {
    Computing { threads, isa: Isa::detect(), stop, fibre_steps }
}

fn fly_all(case: &Case, threads: usize) {
    let (stop, fibre_steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let mut collector = Results::collector(case, 0);
    let done: Result<(), Error> =
        fly(case, KeepShapes::NONE, computing(threads, &stop, &fibre_steps), |flight| {
            collector.take(&flight);
            Ok(())
        });
    done.expect("the case flies");
    black_box(collector.finish());
}

fn bundle_of_flights(case: &Case) -> Vec<Flight> {
    let (stop, fibre_steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let jobs: Vec<Job<'_>> = (0..WIDTH as u64).map(|replicate| Job { case, replicate }).collect();
    fly_together(&jobs, KeepShapes::NONE, computing(1, &stop, &fibre_steps)).expect("the case flies")
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
    ];
    let cases = kinds.map(|(scheme, h, interval)| {
        let mut case = table1(scheme, h, 1.0, WIDTH as u64);
        case.run.output_steps = (interval / h).round() as u64;
        case
    });
    // Flown on one thread here, so that its processor time is all there is.
    let mut trials: Vec<Trial<'_>> = Vec::new();
    for case in &cases {
        trials.push(Trial::new(WIDTH as f64, || processor_time(|| drop(black_box(bundle_of_flights(case))))));
        let flights = bundle_of_flights(case);
        trials.push(Trial::new(WIDTH as f64, move || {
            let mut collector = Results::collector(case, 0);
            let time = processor_time(|| flights.iter().for_each(|flight| collector.take(flight)));
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

/// Two threads against one, by the clock on the wall: of use on a machine with nothing else to do.
pub fn threads() {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    title(&format!("threads: 128 fibres of Table 1 at 200 µs, wall time ({cores} cores)"));
    let case = &table1(Scheme::ImplicitTension, 2e-4, 1.0, 128);
    let mut trials: Vec<Trial<'_>> = [1, 2]
        .map(|threads| {
            Trial::new(1.0, move || {
                let started = Instant::now();
                fly_all(case, threads);
                started.elapsed()
            })
        })
        .into();
    in_rounds(&mut trials, 4.0);
    let (one, two) = (trials[0].each(), trials[1].each());
    println!("  one {:.1} ms, two {:.1} ms: {:.2} times as fast", one * 1e3, two * 1e3, one / two);
}
