//! The statistics of a spunbond line's laydown: what must not move them, and what must not move a bit.

use crate::common::laying::{flight, laid_until, spunbond};
use spunlaid_fibre::{Case, Flight, Job, LaidPoint};
use spunlaid_ground::{Error, Isa, RunContext};
use spunlaid_simulation::ensemble::fly;
use spunlaid_simulation::{LaidCurves, Recorded};
use spunlaid_web::{Trace, TraceSettings};
use std::sync::atomic::{AtomicBool, AtomicU64};

/// Mean and standard error over replicates.
type Number = (f64, f64);

const NAMES: [&str; 4] = ["spread in MD", "spread in CD", "half length in MD", "half length in CD"];

/// Of eight replicates of a case [m].
fn statistics(case: &Case, duration: f64) -> [Number; 4] {
    let line = case.line.unwrap();
    let spacing = case.fibre.rest_length();
    let skip = (2.0 * line.distance / spacing) as u64;
    let tracing = TraceSettings { spacing, belt_ratio: line.belt_ratio(), skip, reach: 0.4 };
    let traced = laid_until(&mut flight(case, 0..8), duration).into_iter().map(|laid| {
        let mut trace = Trace::new(tracing);
        laid.iter().for_each(|point| trace.add(point.md, point.cd));
        let laid = trace.finish();
        [laid.sigma_md, laid.sigma_cd, laid.half_correlation_length_md, laid.half_correlation_length_cd]
    });
    let values: Vec<[f64; 4]> = traced.collect();
    let n = values.len() as f64;
    std::array::from_fn(|i| {
        let mean = values.iter().map(|value| value[i]).sum::<f64>() / n;
        let scatter = values.iter().map(|value| (value[i] - mean).powi(2)).sum::<f64>() / (n - 1.0);
        (mean, (scatter / n).sqrt())
    })
}

/// Four standard errors of the difference.
fn assert_same(what: &str, a: [Number; 4], b: [Number; 4]) {
    for ((name, a), b) in NAMES.iter().zip(a).zip(b) {
        assert!((a.0 - b.0).abs() < 4.0 * a.1.hypot(b.1), "{what}, {name}: {a:?} and {b:?}");
        assert!(a.1 < 0.1 * a.0 && b.1 < 0.1 * b.0, "{what}, {name}: {a:?} and {b:?} say little");
    }
}

#[test]
#[ignore = "slow: six meshes, steps and schemes of eight fibres"]
fn stat_the_lay_down_depends_on_neither_mesh_nor_step_nor_scheme_nor_where_the_chain_ends() {
    let duration = 0.8;
    let run = |set: &[(&str, &str)]| {
        let set: Vec<_> = set.iter().copied().chain([("run.duration", "0.8 s")]).collect();
        statistics(&spunbond(&set), duration)
    };
    let usual = run(&[]);
    assert_same("2 mm", usual, run(&[("fibre.element_length", "2 mm")]));
    assert_same("an eighth of a birth", usual, run(&[("run.time_step", "10 µs")]));
    let fine = spunbond(&[("run.duration", "0.4 s"), ("fibre.element_length", "1 mm")]);
    assert_same("1 mm", usual, statistics(&fine, 0.4));
    assert_same("twice the length on the belt", usual, run(&[("belt.kept_length", "250 mm")]));
    let leapfrog = spunbond(&[("run.duration", "0.3 s"), ("run.scheme", "leapfrog")]);
    assert_same("leapfrog", usual, statistics(&leapfrog, 0.3));
}

#[test]
fn invariant_elements_keep_their_length_on_the_belt() {
    // With the chosen step, an element a step, and at twice the intensity, where two steps are chosen.
    for intensity in ["10 %", "20 %"] {
        let case = spunbond(&[("run.duration", "0.5 s"), ("air.turbulence_intensity", intensity)]);
        let (length, mut stretches) = (case.fibre.rest_length(), Vec::new());
        for laid in laid_until(&mut flight(&case, 0..8), 0.5) {
            let chord = |pair: &[LaidPoint]| (pair[1].md - pair[0].md).hypot(pair[1].cd - pair[0].cd);
            stretches.extend(laid.windows(2).map(|pair| (chord(pair) / length - 1.0).max(0.0)));
        }
        let rms = (stretches.iter().map(|s| s * s).sum::<f64>() / stretches.len() as f64).sqrt();
        assert!(rms < 0.01, "{intensity}: {rms}");
        let far = stretches.iter().filter(|&&s| s > 0.05).count() as f64 / stretches.len() as f64;
        assert!(far < 0.002, "{intensity}: {far}");
    }
}

fn bits(laid: &[LaidPoint]) -> Vec<[u64; 4]> {
    laid.iter().map(|p| [p.fed, p.time, p.md, p.cd].map(f64::to_bits)).collect()
}

#[test]
fn identical_lay_down_for_any_packing_instruction_set_and_number_of_threads() {
    let mut case = spunbond(&[("run.duration", "0.06 s")]);
    case.run.replicates = 11;
    let together: Vec<_> = laid_until(&mut flight(&case, 0..8), 0.06).iter().map(|laid| bits(laid)).collect();
    assert!(together.iter().all(|laid| laid.len() > 200));
    for replicate in [0, 5] {
        let alone = laid_until(&mut flight(&case, replicate..replicate + 1), 0.06);
        assert_eq!(bits(&alone[0]), together[replicate as usize], "replicate {replicate} alone");
    }
    let jobs: Vec<Job> = (0..8).map(|replicate| Job::new(&case, replicate)).collect();
    for isa in Isa::available() {
        let mut flight = Flight::new(&jobs, isa).unwrap();
        for (laid, meant) in laid_until(&mut flight, 0.06).iter().zip(&together) {
            assert_eq!(bits(laid), *meant, "{}", isa.name());
        }
    }
    let ensemble = |threads| {
        let curves = LaidCurves::default();
        let (stop, fibre_steps) = (AtomicBool::new(false), AtomicU64::new(0));
        let computing = RunContext { threads, isa: Isa::detect(), stop: &stop, done: &fibre_steps };
        fly::<Error>(&case, Recorded { recorder: Some(&curves), ..Recorded::NUMBERS }, computing, |_| Ok(()))
            .unwrap();
        (0..11).map(|replicate| bits(&curves.take(replicate))).collect::<Vec<_>>()
    };
    let one = ensemble(1);
    assert_eq!(one, ensemble(3));
    for (laid, meant) in one.iter().zip(&together) {
        assert_eq!(laid[..meant.len().min(laid.len())], meant[..meant.len().min(laid.len())]);
    }
}

/// A hundred fibres of `cases/spunbond.toml` at a turbulence intensity.
fn fly_a_hundred(intensity: &str) {
    let case = spunbond(&[("run.duration", "0.1 s"), ("air.turbulence_intensity", intensity)]);
    for first in (0..104).step_by(8) {
        let laid = laid_until(&mut flight(&case, first..first + 8), 0.1);
        for (lane, laid) in laid.iter().enumerate() {
            let replicate = first + lane as u64;
            assert!(laid.len() > 500, "{intensity}, replicate {replicate}: {} points", laid.len());
            assert!(laid.iter().all(|p| (p.md + p.cd + p.time).is_finite()), "{intensity}, {replicate}");
        }
    }
}

#[test]
fn a_hundred_fibres_stay_finite() {
    fly_a_hundred("10 %");
}

#[test]
fn a_hundred_fibres_stay_finite_at_twice_the_intensity() {
    fly_a_hundred("20 %");
}

#[test]
#[ignore = "slow: a hundred fibres"]
fn a_hundred_fibres_stay_finite_at_four_times_the_intensity() {
    fly_a_hundred("40 %");
}

#[test]
fn rejects_a_belt_that_the_fibre_cannot_reach() {
    // Air that blows back to the inlet.
    let case =
        spunbond(&[("air.speed_factor", "0.001"), ("run.gravity", "-500 m/s²"), ("run.duration", "1 s")]);
    let said = flight(&case, 0..8).step_to(1.0).unwrap_err();
    assert!(matches!(said, Error::NotLanding { .. }), "{said}");
    assert_eq!(said.exit_code(), 1);
    let said = said.to_string();
    assert!(said.contains("does not reach the belt") && said.contains("belt.distance"), "{said}");
}
