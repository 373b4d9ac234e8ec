//! Whole ensembles: the paper's Table 1 case, and bits that no thread or neighbour changes.

mod common;

use common::*;
use spunlaid::case::{Case, Run};
use spunlaid::chain::schemes::Scheme;
use spunlaid::ensemble::{Computing, Flight, KeepShapes, Results, fly};
use spunlaid::error::Error;
use spunlaid::lanes::Isa;
use std::sync::atomic::{AtomicBool, AtomicU64};

fn table1(time_step: f64, duration: f64, replicates: u64) -> Case {
    Case {
        fibre: table1_fibre(),
        air: table1_air(),
        drag: paper_drag(),
        run: Run {
            time_step,
            steps: (duration / time_step).round() as u64,
            spin_up_steps: 0,
            output_steps: (1e-3 / time_step).round() as u64,
            replicates,
            seed: 1,
            scheme: Scheme::SemiImplicitEuler,
            gravity: 9.81,
            damping: 0.0,
        },
    }
}

fn flights(case: &Case, threads: usize) -> Vec<Flight> {
    let (stop, fibre_steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let computing = Computing { threads, isa: Isa::detect(), stop: &stop, fibre_steps: &fibre_steps };
    let mut flights = Vec::new();
    let done: Result<(), Error> = fly(case, KeepShapes::NONE, computing, |flight| {
        flights.push(flight);
        Ok(())
    });
    done.expect("the ensemble flies");
    assert_eq!(fibre_steps.into_inner(), case.run.steps * case.run.replicates);
    flights
}

fn results(case: &Case) -> Results {
    let mut collector = Results::collector(case, 0);
    for flight in flights(case, 2) {
        collector.take(&flight);
    }
    collector.finish()
}

#[test]
fn published_table1_amplitude_and_frequency() {
    // At 20 µs, where the amplitude is that of 1 µs to 0.1 % (next test).
    let r = results(&table1(2e-5, 1.0, 40));
    // 9.8 mm, itself known to a standard error of 0.2 mm; 17 to 18 Hz.
    for (name, found, expected, known) in [
        ("amplitude y", &r.end_node.amplitude_y, 9.8e-3, 0.2e-3),
        ("amplitude z", &r.end_node.amplitude_z, 9.8e-3, 0.2e-3),
        ("frequency y", &r.end_node.frequency_y, 17.5, 0.5),
        ("frequency z", &r.end_node.frequency_z, 17.5, 0.5),
    ] {
        let error = found.standard_error.expect("40 replicates").hypot(known);
        assert!((found.mean - expected).abs() < 4.0 * error, "{name}: {} ± {error}", found.mean);
    }
}

#[test]
fn published_table1_at_the_papers_step() {
    let (fine, coarse) = (results(&table1(1e-6, 1.0, 8)), results(&table1(2e-5, 1.0, 8)));
    // "Far below 1 %", and in proportion to the step.
    let (e1, e20) = (fine.work_error_percent.time_median, coarse.work_error_percent.time_median);
    assert!(e1 < 0.1, "work error {e1} %");
    assert!((e20 / e1 / 20.0 - 1.0).abs() < 0.2, "work error grows by {}", e20 / e1);
    // Same phases: the amplitude moves by less than 0.1 %.
    let (a1, a20) = (fine.end_node.amplitude_y.mean, coarse.end_node.amplitude_y.mean);
    assert!((a20 / a1 - 1.0).abs() < 1e-3, "{a1} m at 1 µs, {a20} m at 20 µs");
}

#[test]
fn identical_for_any_number_of_threads_and_any_packing() {
    let case = table1(2e-5, 0.02, 19);
    let expected = flights(&case, 1);
    for threads in [2, 4] {
        let found = flights(&case, threads);
        assert_eq!(found.len(), 19);
        for (a, b) in expected.iter().zip(&found) {
            assert_same(a, b);
        }
    }
    // Fewer replicates: others, or none, in the neighbouring lanes.
    for replicates in [1, 3, 11] {
        let mut fewer = case;
        fewer.run.replicates = replicates;
        let found = flights(&fewer, 1);
        assert_same(&expected[replicates as usize - 1], &found[replicates as usize - 1]);
    }
}

fn assert_same(a: &Flight, b: &Flight) {
    assert_eq!(a.replicate, b.replicate);
    assert_eq!(a.end_node, b.end_node, "replicate {}", a.replicate);
    assert_eq!(a.nodes, b.nodes);
    assert!(a.samples == b.samples, "replicate {}: samples differ", a.replicate);
}

#[test]
fn invariant_spin_up_leaves_the_flight_and_changes_the_statistics() {
    let whole = table1(2e-5, 0.1, 1);
    let mut late = whole;
    late.run.spin_up_steps = late.run.steps / 2;
    let (whole, late) = (&flights(&whole, 1)[0], &flights(&late, 1)[0]);
    assert!(whole.samples == late.samples);
    let second_half: Vec<f64> = whole.samples.iter().filter(|s| s.time > 0.05).map(|s| s.end.y).collect();
    let n = second_half.len() as f64;
    let mean = second_half.iter().sum::<f64>() / n;
    let deviation = (second_half.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / n).sqrt();
    // The program sees every step, the samples every fiftieth.
    assert!((late.end_node.amplitude_y / deviation - 1.0).abs() < 0.1);
    assert!((late.end_node.amplitude_y / whole.end_node.amplitude_y - 1.0).abs() > 0.01);
}

#[test]
fn rejects_a_flight_that_is_no_longer_finite() {
    // Twice the stability limit of the axial waves.
    let case = table1(7e-5, 0.5, 3);
    let (stop, fibre_steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let computing = Computing { threads: 1, isa: Isa::detect(), stop: &stop, fibre_steps: &fibre_steps };
    let done: Result<(), Error> = fly(&case, KeepShapes::NONE, computing, |_| Ok(()));
    let message = done.expect_err("must blow up").to_string();
    assert!(message.contains("no longer finite") && message.contains("axial waves"), "{message}");
}
