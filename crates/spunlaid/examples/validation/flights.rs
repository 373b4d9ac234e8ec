//! Whole flights of the Table 1 fibre.

use crate::common::*;
use crate::title;
use spunlaid::air::{Air, Eddies, StreamKey, Wind};
use spunlaid::fibre::chain::Scheme;
use spunlaid::fibre::{Case, FibreParameters, Flight, FrictionLaw, Snapshot};
use spunlaid::ground::{Error, Estimate, Isa, RunContext, WIDTH};
use spunlaid::simulation::ensemble::fly;
use spunlaid::simulation::{Number, Recorded, Results};
use std::sync::atomic::{AtomicBool, AtomicU64};
use std::time::Instant;

const SCHEMES: [Scheme; 2] = [Scheme::SemiImplicitEuler, Scheme::Leapfrog];

fn case(h: f64, replicates: u64) -> Case {
    crate::common::table1(Scheme::SemiImplicitEuler, h, 1.0, replicates)
}

fn results(case: &Case) -> Results {
    let (stop, fibre_steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let computing = RunContext { threads, isa: Isa::detect(), stop: &stop, done: &fibre_steps };
    let mut collector = Results::collector(0);
    let done: Result<(), Error> = fly(case, Recorded::NUMBERS, computing, |flight| {
        collector.take(flight);
        Ok(())
    });
    done.expect("the case flies");
    collector.finish()
}

/// Eight replicates of Table 1 after `duration`.
fn simulated(scheme: Scheme, h: f64, duration: f64) -> (Snapshot, Snapshot) {
    let (fibre, air) = (table1_fibre(), table1_air());
    let eddies = Eddies::along(1.0, 20, 0.05);
    let streams: Vec<(Air, StreamKey)> =
        (0..WIDTH as u64).map(|replicate| (air.clone(), StreamKey { seed: 4, replicate })).collect();
    let turbulence = Wind::uniform(Isa::detect(), &streams, eddies.count(), duration + 2.0 * h)
        .expect("fibres that agree");
    let drag = paper_drag().element_drag(&fibre, air.density, air.kinematic_viscosity);
    let strands = [FibreParameters { fibre, drag, gravity: 9.81, damping: 0.0 }; WIDTH];
    let mut flight = Flight::assembled(Isa::detect(), &strands, (&eddies, &turbulence), scheme, h)
        .expect("fibres that agree");
    flight.advance((duration / h).round() as u64);
    let now = flight.snapshot();
    flight.advance(1);
    (now, flight.snapshot())
}

pub fn orders() {
    title("observed order of convergence, Table 1, end nodes after 4 ms at 2, 1 and 0.5 µs");
    for scheme in SCHEMES {
        let at = |h| -> Vec<V> {
            let (s, _) = simulated(scheme, h, 4e-3);
            (0..WIDTH).map(|i| s.position[20].lane(i)).collect()
        };
        let distance =
            |a: &[V], b: &[V]| a.iter().zip(b).map(|(&a, &b)| (a - b).dot(a - b)).sum::<f64>().sqrt();
        let coarse = at(2e-6);
        let middle = at(1e-6);
        let fine = at(0.5e-6);
        println!(
            "  {}: {:.3}",
            scheme.name(),
            (distance(&coarse, &middle) / distance(&middle, &fine)).log2()
        );
    }
}

pub fn work_identity() {
    title("work check of semi-implicit Euler against the identity W − T = ½h F·v, 64 ms at 8 µs");
    let h = 8e-6;
    let (now, next) = simulated(Scheme::SemiImplicitEuler, h, 0.064);
    let fibre = table1_fibre();
    for lane in 0..3 {
        // F from the velocities before and after the step; the held root moves nowhere.
        let power: f64 = (1..=20)
            .map(|i| {
                let v = now.velocity[i].lane(lane);
                let after = next.velocity[i].lane(lane);
                (after - v).dot(v) * fibre.node_mass(i) / h
            })
            .sum();
        let found = now.energy.work.0[lane] - now.energy.kinetic.0[lane];
        println!("  W − T = {found:.9e} J, ½h F·v = {:.9e} J", 0.5 * h * power);
    }
}

pub fn errors_by_step() {
    title("energy errors by the time step, Table 1, 8 replicates of 1 s: median over time [%]");
    for scheme in SCHEMES {
        for h in [1e-6, 2e-6, 5e-6, 1e-5, 2e-5] {
            let mut case = case(h, 8);
            case.run.scheme = scheme;
            let r = results(&case);
            println!(
                "  {:<20} {:>4} µs: work {:.2e}, balance {:.2e}; amplitude y {:.4} mm",
                scheme.name(),
                (h * 1e6).round(),
                r.number("work_error").map_or(f64::NAN, Number::value),
                r.number("balance_error").map_or(f64::NAN, Number::value),
                r.estimate("amplitude_y").mean * 1e3
            );
        }
    }
}

fn shown(e: &Estimate, factor: f64) -> String {
    format!("{:.2} ± {:.2}", e.mean * factor, e.standard_error.unwrap_or(0.0) * factor)
}

pub fn table1() {
    title("Table 1 at 1 µs");
    for replicates in [10, 40] {
        let started = Instant::now();
        let r = results(&case(1e-6, replicates));
        let e = |name: &str| r.estimate(name);
        println!(
            "  {replicates} replicates in {:.1} s: amplitude y {} mm, z {} mm; frequency y {} Hz, z {} Hz",
            started.elapsed().as_secs_f64(),
            shown(&e("amplitude_y"), 1e3),
            shown(&e("amplitude_z"), 1e3),
            shown(&e("frequency_y"), 1.0),
            shown(&e("frequency_z"), 1.0)
        );
        println!(
            "     work check {:.1e} % at the end, {:.1e} % median; balance {:.1e} %, {:.1e} %; strain {:.1e}",
            r.estimate("work_error_at_end").mean,
            r.number("work_error").map_or(f64::NAN, Number::value),
            r.estimate("balance_error_at_end").mean,
            r.number("balance_error").map_or(f64::NAN, Number::value),
            r.estimate("strain_99").mean
        );
    }
}

/// One changed value of the Table 1 case.
type Change = fn(&mut Case, f64);

pub fn trends() {
    title(
        "one number of Table 1 changed at a time, leapfrog, 40 replicates: amplitude [mm], frequency [Hz], \
        mean of y and z",
    );
    let changes: [(&str, Change, &[f64]); 6] = [
        ("velocity [m/s]", |c, x| c.air.velocity = x, &[5.0, 10.0, 15.0, 20.0]),
        ("turbulence intensity", |c, x| c.air.turbulence_intensity = x, &[0.05, 0.1, 0.15, 0.2, 0.3]),
        ("diameter [µm]", |c, x| c.fibre.diameter = x * 1e-6, &[15.0, 25.0, 50.0, 100.0, 200.0, 350.0]),
        ("eddy length [mm]", |c, x| c.air.length_scale = x * 1e-3, &[12.5, 25.0, 50.0, 100.0]),
        ("cut-off [Hz]", |c, x| c.air.cutoff_frequency = x, &[25.0, 50.0, 100.0, 200.0]),
        ("β", |c, x| c.drag.along = FrictionLaw::Matsui { factor: x }, &[0.37, 0.78, 0.9]),
    ];
    for (name, change, values) in changes {
        for &value in values {
            let mut case = case(1e-5, 40);
            case.run.scheme = Scheme::Leapfrog;
            change(&mut case, value);
            case.fibre.elements = (case.fibre.length / case.air.length_scale).round() as usize;
            let h = if case.fibre.axial_step_limit() < 2e-5 { 5e-6 } else { 1e-5 };
            case.run.time_step = h;
            case.run.steps = (1.0 / h).round() as u64;
            case.run.output_steps = (1e-3 / h).round() as u64;
            case.air.harmonics = case.air.default_harmonics(1.0);
            case.check().expect("the changed case can be run");
            let r = results(&case);
            let e = |name: &str| r.estimate(name);
            let both = |a: &Estimate, b: &Estimate| {
                Estimate::new(a.values.iter().zip(&b.values).map(|(a, b)| 0.5 * (a + b)).collect())
            };
            println!(
                "  {name} {value}: {} mm, {} Hz",
                shown(&both(&e("amplitude_y"), &e("amplitude_z")), 1e3),
                shown(&both(&e("frequency_y"), &e("frequency_z")), 1.0)
            );
        }
    }
}
