//! Whole ensembles: the paper's Table 1 case, and bits that no thread or neighbour changes.

use crate::common;
use crate::common::*;
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{Case, Job, LaidPoint};
use spunlaid_ground::{Error, Estimate, Isa, RunContext};
use spunlaid_input::read_case;
use spunlaid_simulation::ensemble::{Sample, fly, fly_for_checks, fly_together};
use spunlaid_simulation::{FinerPlans, Number, Recorded, Recorder, Results, Trajectory, Unchecked};
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// By the paper's scheme.
pub fn table1(time_step: f64, duration: f64, replicates: u64) -> Case {
    common::table1(Scheme::SemiImplicitEuler, time_step, duration, replicates)
}

pub fn flights(case: &Case, threads: usize) -> Vec<Trajectory> {
    let (stop, fibre_steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let computing = RunContext { threads, isa: Isa::detect(), stop: &stop, done: &fibre_steps };
    let mut flights = Vec::new();
    let done: Result<(), Error> = fly(case, Recorded::SAMPLES, computing, |flight| {
        flights.push(flight);
        Ok(())
    });
    done.expect("the ensemble flies");
    assert_eq!(fibre_steps.into_inner(), case.run.steps * case.run.replicates);
    flights
}

fn results(case: &Case) -> Results {
    let mut collector = Results::collector(0);
    for flight in flights(case, 2) {
        collector.take(flight);
    }
    collector.finish()
}

#[test]
fn published_table1_amplitude_and_frequency() {
    // At 20 µs, where the amplitude is that of 1 µs to 0.1 % (next test).
    let r = results(&table1(2e-5, 1.0, 40));
    // 9.8 mm, itself known to a standard error of 0.2 mm; 17 to 18 Hz.
    for (name, found, expected, known) in [
        ("amplitude y", r.estimate("amplitude_y"), 9.8e-3, 0.2e-3),
        ("amplitude z", r.estimate("amplitude_z"), 9.8e-3, 0.2e-3),
        ("frequency y", r.estimate("frequency_y"), 17.5, 0.5),
        ("frequency z", r.estimate("frequency_z"), 17.5, 0.5),
    ] {
        let error = found.standard_error.expect("40 replicates").hypot(known);
        assert!((found.mean - expected).abs() < 4.0 * error, "{name}: {} ± {error}", found.mean);
    }
}

#[test]
fn published_table1_at_the_papers_step() {
    let fine = results(&table1(1e-6, 1.0, 8));
    let coarse = results(&table1(2e-5, 1.0, 8));
    // "Far below 1 %", and in proportion to the step.
    let e1 = fine.number("work_error").map_or(f64::NAN, Number::value);
    let e20 = coarse.number("work_error").map_or(f64::NAN, Number::value);
    assert!(e1 < 0.1, "work error {e1} %");
    assert!((e20 / e1 / 20.0 - 1.0).abs() < 0.2, "work error grows by {}", e20 / e1);
    // Same phases: the amplitude moves by less than 0.1 %.
    let a1 = fine.estimate("amplitude_y").mean;
    let a20 = coarse.estimate("amplitude_y").mean;
    assert!((a20 / a1 - 1.0).abs() < 1e-3, "{a1} m at 1 µs, {a20} m at 20 µs");
}

#[test]
fn analytic_crossing_frequency_of_a_pendulum() {
    // A hanging chain set off a little aside swings in its first mode, crossing once every half period.
    let mut case = table1(2e-4, 12.0, 1);
    case.run.scheme = Scheme::ImplicitTension;
    (case.air.velocity, case.air.density) = (0.0, 0.0);
    case.fibre.diameter = 10e-6;
    case.fibre.direction = V::new(1.0, 1e-3, 0.0) * (1.0 / V::new(1.0, 1e-3, 0.0).norm());
    let r = results(&case);
    // All modes are set off, but the first rules the free end: a crossing more or less than its own.
    let exact = 0.59894;
    let found = r.estimate("frequency_y").mean;
    assert!((found - exact).abs() <= 2.0 / (2.0 * 12.0), "{found} Hz, expected {exact} Hz");
    assert_eq!(r.estimate("frequency_z").mean, 0.0);
    assert!(r.estimate("frequency_z").standard_error.is_none());
}

#[test]
fn published_trends_of_the_paper() {
    let fly = |change: &dyn Fn(&mut Case)| {
        let mut case = table1(2e-4, 1.0, 32);
        case.run.scheme = Scheme::ImplicitTension;
        change(&mut case);
        let r = results(&case);
        let both = |a: &Estimate, b: &Estimate| {
            let all: Vec<f64> = a.values.iter().zip(&b.values).map(|(a, b)| 0.5 * (a + b)).collect();
            Estimate::new(all)
        };
        let e = |name: &str| r.estimate(name);
        (both(&e("amplitude_y"), &e("amplitude_z")), both(&e("frequency_y"), &e("frequency_z")))
    };
    // Rises by more than four standard errors of the difference, of independent phases or not.
    let rises = |name: &str, low: &Estimate, high: &Estimate| {
        let error = |e: &Estimate| e.standard_error.expect("32 replicates");
        let bound = 4.0 * error(low).hypot(error(high));
        assert!(high.mean - low.mean > bound, "{name}: {} to {}, {bound}", low.mean, high.mean);
    };
    let base = fly(&|_| ());
    let slow = fly(&|c| c.air.velocity = 5.0);
    rises("amplitude with velocity", &slow.0, &base.0);
    rises("frequency with velocity", &slow.1, &base.1);
    let calm = fly(&|c| c.air.turbulence_intensity = 0.05);
    rises("amplitude with intensity", &calm.0, &base.0);
    rises("frequency with intensity", &calm.1, &base.1);
    let thin = fly(&|c| c.fibre.diameter = 18e-6);
    let thick = fly(&|c| c.fibre.diameter = 200e-6);
    rises("amplitude with diameter, 18 to 200 µm", &thin.0, &thick.0);
    let small = fly(&|c| {
        (c.air.length_scale, c.fibre.elements) = (0.02, 50);
    });
    rises("amplitude with length scale", &small.0, &base.0);
    let quick = fly(&|c| (c.air.cutoff_frequency, c.air.harmonics) = (200.0, 512));
    rises("amplitude with a lower cut-off", &quick.0, &base.0);
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
        let mut fewer = case.clone();
        fewer.run.replicates = replicates;
        let found = flights(&fewer, 1);
        assert_same(&expected[replicates as usize - 1], &found[replicates as usize - 1]);
    }
}

pub fn assert_same(a: &Trajectory, b: &Trajectory) {
    assert_eq!(a.replicate, b.replicate);
    // As text, which holds every bit and where NaN is like NaN.
    assert_eq!(format!("{:?}", a.values), format!("{:?}", b.values), "replicate {}", a.replicate);
    assert!(a.samples == b.samples, "replicate {}: samples differ", a.replicate);
}

#[test]
fn invariant_spin_up_leaves_the_flight_and_changes_the_statistics() {
    let whole = table1(2e-5, 0.1, 1);
    let mut late = whole.clone();
    late.run.spin_up_steps = late.run.steps / 2;
    let (whole, late) = (&flights(&whole, 1)[0], &flights(&late, 1)[0]);
    assert!(whole.samples == late.samples);
    let second_half: Vec<f64> = whole.samples.iter().filter(|s| s.time > 0.05).map(|s| s.end.y).collect();
    let n = second_half.len() as f64;
    let mean = second_half.iter().sum::<f64>() / n;
    let deviation = (second_half.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / n).sqrt();
    // The program sees every step, the samples every fiftieth.
    assert!((late.number("amplitude_y") / deviation - 1.0).abs() < 0.1);
    assert!((late.number("amplitude_y") / whole.number("amplitude_y") - 1.0).abs() > 0.01);
}

#[test]
fn rejects_a_flight_that_diverges() {
    // A fibre of 2 µm in air of 3000 m/s: the drag changes its velocity by more than itself in a step.
    let mut case = table1(3e-5, 0.5, 3);
    (case.fibre.diameter, case.air.velocity) = (2e-6, 3000.0);
    let (stop, fibre_steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let computing = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &fibre_steps };
    let done: Result<(), Error> = fly(&case, Recorded::SAMPLES, computing, |_| Ok(()));
    let message = done.expect_err("must blow up").to_string();
    assert!(
        message.contains("which no fibre can have") && message.contains("lower run.time_step"),
        "{message}"
    );
}

/// What a recorder is reported: how often each replicate began to fly, and its instants since it began last.
#[derive(Debug, Default)]
struct RecordedSamples(Mutex<BTreeMap<u64, (u32, Vec<Sample>)>>);

impl Recorder for RecordedSamples {
    fn begin(&self, replicate: u64) {
        let mut recorder = self.0.lock().unwrap();
        let begun = recorder.get(&replicate).map_or(0, |(begun, _)| *begun);
        recorder.insert(replicate, (begun + 1, Vec::new()));
    }

    fn samples(&self, replicate: u64, samples: &[Sample]) -> Result<(), Error> {
        self.0.lock().unwrap().get_mut(&replicate).unwrap().1.extend_from_slice(samples);
        Ok(())
    }

    fn lay(&self, _: u64, _: &[LaidPoint]) -> Result<(), Error> {
        Ok(())
    }
}

/// Fibres in a record with a eddy of 90 km/s are lost where the eddy is in their stretch of it. The others fly again
/// without them, to the bits that they have alone, and the recorder forgets what it was reported before.
#[test]
fn fibres_that_are_lost_stop_no_others() {
    let folder = tempfile::tempdir().unwrap();
    let velocity = |i: u32| if (400..420).contains(&i) { 1e5 } else { 10.0 + f64::from(i * i % 101) * 0.01 };
    let rows = (0..2000).map(|i| format!("{},{}\n", f64::from(i) * 1e-3, velocity(i)));
    let record = folder.path().join("gust.csv");
    std::fs::write(&record, format!("time_s,u_m_s\n{}", rows.collect::<String>())).unwrap();
    let text = format!(
        "version = 1
[fibre]
length = '0.2 m'
diameter = '50 µm'
density = '950 kg/m³'
youngs_modulus = '2 GPa'
element_length = '50 mm'
[air]
record = '{}'
velocity = '10 m/s'
turbulence_intensity = 900
length_scale = '0.2 m'
[run]
duration = '50 ms'
time_step = '20 µs'
replicates = 12
",
        record.display()
    );
    let (case, _) = read_case((&text, "case.toml"), &[]).unwrap();
    for threads in [1, 2] {
        let stop = AtomicBool::new(false);
        let fibre_steps = AtomicU64::new(0);
        let recorder = RecordedSamples::default();
        let computing = RunContext { threads, isa: Isa::detect(), stop: &stop, done: &fibre_steps };
        let mut simulated = Vec::new();
        let mut lost = Vec::new();
        let mut order = Vec::new();
        fly_for_checks(
            &case,
            &FinerPlans::none(Unchecked::NotAsked),
            Recorded { recorder: Some(&recorder), ..Recorded::SAMPLES },
            computing,
            |_, _| Ok(None),
            |landed| {
                match landed {
                    Ok(trajectory) => {
                        order.push(trajectory.replicate);
                        simulated.push(trajectory);
                    }
                    Err(fibre) => {
                        order.push(fibre.replicate);
                        lost.push(fibre);
                    }
                }
                Ok::<(), Error>(())
            },
        )
        .unwrap();
        assert_eq!(order, (0..12).collect::<Vec<_>>(), "each in its turn");
        assert!(!lost.is_empty() && simulated.len() > 2, "{lost:?}");
        // What the flights that were given up have done is not counted.
        assert_eq!(fibre_steps.load(Ordering::Relaxed), case.run.steps * simulated.len() as u64);
        for fibre in lost {
            assert!(fibre.reason.starts_with(&format!("replicate {}: ", fibre.replicate + 1)), "{fibre:?}");
            assert!(fibre.time >= 0.0 && fibre.time <= case.run.duration());
        }
        let recorder = recorder.0.lock().unwrap();
        assert!(recorder.values().any(|(begun, _)| *begun > 1));
        for flight in simulated {
            let jobs = [Job::new(&case, flight.replicate)];
            let alone =
                fly_together(&jobs, Recorded::SAMPLES, RunContext { done: &AtomicU64::new(0), ..computing });
            assert_same(&alone.unwrap()[0], &flight);
            assert!(recorder[&flight.replicate].1 == flight.samples);
        }
    }
}
