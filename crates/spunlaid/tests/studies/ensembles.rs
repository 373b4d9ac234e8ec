//! Whole ensembles: the paper's Table 1 case, and bits that no thread or neighbour changes.

use crate::common;
use crate::common::*;
use spunlaid::case::Case;
use spunlaid::chain::schemes::Scheme;
use spunlaid::drag::NormalLaw;
use spunlaid::ensemble::{
    Computing, FinerCheck, FinerPlans, Keep, Number, Recorder, Refined, Results, Sample, Trajectory, fly,
    fly_and_check, fly_together,
};
use spunlaid::error::Error;
use spunlaid::flight::{Job, LaidPoint};
use spunlaid::input::{parse_case, read_case};
use spunlaid::lanes::Isa;
use spunlaid::statistics::Estimate;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// By the paper's scheme.
fn table1(time_step: f64, duration: f64, replicates: u64) -> Case {
    common::table1(Scheme::SemiImplicitEuler, time_step, duration, replicates)
}

fn flights(case: &Case, threads: usize) -> Vec<Trajectory> {
    let (stop, fibre_steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let computing =
        Computing { threads, isa: Isa::detect(), stop: &stop, fibre_steps: &fibre_steps, recorder: None };
    let mut flights = Vec::new();
    let done: Result<(), Error> = fly(case, Keep::SAMPLES, computing, |flight| {
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
    let (fine, coarse) = (results(&table1(1e-6, 1.0, 8)), results(&table1(2e-5, 1.0, 8)));
    // "Far below 1 %", and in proportion to the step.
    let (e1, e20) = (
        fine.number("work_error").map_or(f64::NAN, Number::value),
        coarse.number("work_error").map_or(f64::NAN, Number::value),
    );
    assert!(e1 < 0.1, "work error {e1} %");
    assert!((e20 / e1 / 20.0 - 1.0).abs() < 0.2, "work error grows by {}", e20 / e1);
    // Same phases: the amplitude moves by less than 0.1 %.
    let (a1, a20) = (fine.estimate("amplitude_y").mean, coarse.estimate("amplitude_y").mean);
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
            Estimate::of(all)
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

fn assert_same(a: &Trajectory, b: &Trajectory) {
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
    let computing =
        Computing { threads: 1, isa: Isa::detect(), stop: &stop, fibre_steps: &fibre_steps, recorder: None };
    let done: Result<(), Error> = fly(&case, Keep::SAMPLES, computing, |_| Ok(()));
    let message = done.expect_err("must blow up").to_string();
    assert!(
        message.contains("which no fibre can have") && message.contains("lower run.time_step"),
        "{message}"
    );
}

/// What a recorder is told: how often each replicate began to fly, and its instants since it began last.
#[derive(Debug, Default)]
struct RecordedSamples(Mutex<BTreeMap<u64, (u32, Vec<Sample>)>>);

impl Recorder for RecordedSamples {
    fn begin(&self, replicate: u64) {
        let mut told = self.0.lock().unwrap();
        let begun = told.get(&replicate).map_or(0, |(begun, _)| *begun);
        told.insert(replicate, (begun + 1, Vec::new()));
    }

    fn sample(&self, replicate: u64, sample: &Sample) -> Result<(), Error> {
        self.0.lock().unwrap().get_mut(&replicate).unwrap().1.push(*sample);
        Ok(())
    }

    fn lay(&self, _: u64, _: &[LaidPoint]) -> Result<(), Error> {
        Ok(())
    }
}

/// Fibres in a record with a gust of 90 km/s are lost where the gust is in their stretch of it. The others fly again
/// without them, to the bits that they have alone, and the recorder forgets what it was told before.
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
    let (case, _) = parse_case(&text, "case.toml", &[]).unwrap();
    for threads in [1, 2] {
        let (stop, fibre_steps, told) =
            (AtomicBool::new(false), AtomicU64::new(0), RecordedSamples::default());
        let computing = Computing {
            threads,
            isa: Isa::detect(),
            stop: &stop,
            fibre_steps: &fibre_steps,
            recorder: Some(&told),
        };
        let (mut flown, mut lost, mut order) = (Vec::new(), Vec::new(), Vec::new());
        fly_and_check(&case, &FinerPlans::none("it was not asked for"), Keep::SAMPLES, computing, |landed| {
            match landed {
                Ok(trajectory) => {
                    order.push(trajectory.replicate);
                    flown.push(trajectory);
                }
                Err(fibre) => {
                    order.push(fibre.replicate);
                    lost.push(fibre);
                }
            }
            Ok::<(), Error>(())
        })
        .unwrap();
        assert_eq!(order, (0..12).collect::<Vec<_>>(), "each in its turn");
        assert!(!lost.is_empty() && flown.len() > 2, "{lost:?}");
        // What the flights that were given up have done is not counted.
        assert_eq!(fibre_steps.load(Ordering::Relaxed), case.run.steps * flown.len() as u64);
        for fibre in lost {
            assert!(fibre.reason.starts_with(&format!("replicate {}: ", fibre.replicate + 1)), "{fibre:?}");
            assert!(fibre.time >= 0.0 && fibre.time <= case.run.duration());
        }
        let told = told.0.lock().unwrap();
        assert!(told.values().any(|(begun, _)| *begun > 1));
        for flight in flown {
            let jobs = [Job { case: &case, replicate: flight.replicate }];
            let alone = fly_together(
                &jobs,
                Keep::SAMPLES,
                Computing { recorder: None, fibre_steps: &AtomicU64::new(0), ..computing },
            );
            assert_same(&alone.unwrap()[0], &flight);
            assert!(told[&flight.replicate].1 == flight.samples);
        }
    }
}

/// The trajectories of a case, and one of its checks.
fn checked_by(
    refined: Refined,
    case: &Case,
    threads: usize,
    isa: Isa,
    stop: bool,
) -> Result<(Vec<Trajectory>, Result<FinerCheck, String>), Error> {
    let (stop, fibre_steps) = (AtomicBool::new(stop), AtomicU64::new(0));
    let computing = Computing { threads, isa, stop: &stop, fibre_steps: &fibre_steps, recorder: None };
    let none = || Err("it was not asked for".to_owned());
    let plans = match (refined, FinerPlans::of(case)) {
        (Refined::TimeStep, FinerPlans { step, .. }) => FinerPlans { step, mesh: none() },
        (Refined::Elements, FinerPlans { mesh, .. }) => FinerPlans { step: none(), mesh },
    };
    let mut flown = Vec::new();
    let checks = fly_and_check(case, &plans, Keep::SAMPLES, computing, |trajectory| {
        flown.push(trajectory.expect("no fibre is lost"));
        Ok::<(), Error>(())
    })?;
    assert_eq!(fibre_steps.into_inner(), case.run.steps * case.run.replicates + plans.fibre_steps());
    Ok((flown, if refined == Refined::TimeStep { checks.step } else { checks.mesh }))
}

/// The trajectories of a case, and what a finer step changes.
fn checked(
    case: &Case,
    threads: usize,
    isa: Isa,
    stop: bool,
) -> Result<(Vec<Trajectory>, Option<FinerCheck>), Error> {
    checked_by(Refined::TimeStep, case, threads, isa, stop).map(|(flown, check)| (flown, check.ok()))
}

/// What elements of half the length change.
fn mesh_checked(case: &Case) -> FinerCheck {
    let (_, check) = checked_by(Refined::Elements, case, 2, Isa::detect(), false).expect("the case flies");
    check.expect("long enough")
}

/// The relative change of a statistic that a check found.
fn change<'a>(check: &'a FinerCheck, name: &str) -> &'a Estimate {
    let found = check.changes.iter().find(|change| change.statistic.name == name);
    &found.expect("the statistic is compared").estimate
}

/// Ratio of the means of a mean of measures, minus one.
fn off(own: &[Trajectory], fine: &[Trajectory], measures: [&str; 2]) -> f64 {
    let sum = |all: &[Trajectory]| {
        all.iter().flat_map(|one| measures.map(|measure| one.number(measure))).sum::<f64>()
    };
    sum(own) / sum(fine) - 1.0
}

/// Rms distance of two fibres' ends across the flow, as a share of the amplitude of the second; the mean over the fibres.
fn apart(fibres: &[Trajectory], exact: &[Trajectory], instants: std::ops::RangeInclusive<usize>) -> f64 {
    let path = |fibre: &Trajectory| -> Vec<V> {
        fibre.samples[instants.clone()].iter().map(|sample| V { x: 0.0, ..sample.end }).collect()
    };
    let squares = |of: Vec<V>| of.iter().map(|p| p.dot(*p)).sum::<f64>();
    let off = |(fibre, exact): (&Trajectory, &Trajectory)| {
        let (fibre, exact) = (path(fibre), path(exact));
        let mean = exact.iter().fold(V::default(), |sum, &p| sum + p) * (1.0 / exact.len() as f64);
        let error = squares(fibre.iter().zip(&exact).map(|(&a, &b)| a - b).collect());
        (error / squares(exact.iter().map(|&p| p - mean).collect())).sqrt()
    };
    fibres.iter().zip(exact).map(off).sum::<f64>() / fibres.len() as f64
}

fn checked_at(scheme: Scheme, step: f64, damping: f64) -> (Vec<Trajectory>, FinerCheck) {
    let mut case = table1(step, 0.5, 8);
    (case.run.scheme, case.run.damping) = (scheme, damping);
    let (flown, check) = checked(&case, 1, Isa::detect(), false).expect("the case flies");
    (flown, check.expect("500 instants"))
}

/// The fibre starts without tension, and the axial waves of the start run on for long. Implicit tension damps them at a rate
/// that hardly depends on the step, so that half the step shows little of what they do to the path: 3 parts in 10 000
/// of the amplitude were found.
const START: f64 = 4e-4;

/// Half of a long step of implicit tension says nothing about its limit: axial waves are damped at both. The check flies
/// leapfrog, with steps that resolve these waves, and tells the whole difference.
#[test]
fn invariant_the_step_check_of_a_fed_fibre_compares_it_with_resolved_axial_waves() {
    // As long as the check, so that its flights are those below: a way of 10 ms takes twice that to come down.
    let mut case = common::laying::spunbond(&[("run.duration", "40 ms"), ("run.spin_up", "20 ms")]);
    case.run.replicates = 8;
    let (flown, check) = checked(&case, 2, Isa::detect(), false).unwrap();
    let check = check.expect("long enough");
    assert_eq!(check.scheme, Scheme::Leapfrog);
    assert_eq!((check.replicates, check.error_over_change()), (8, Some(1.0)));
    assert!(check.time_step <= 0.5 * case.fibre.axial_step_limit(), "{}", check.time_step);

    let mut fine = case.clone();
    fine.run.scheme = Scheme::Leapfrog;
    fine.set_time_step(check.time_step);
    let jobs: Vec<Job<'_>> = (0..8).map(|replicate| Job { case: &fine, replicate }).collect();
    let (stop, fibre_steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let computing =
        Computing { threads: 1, isa: Isa::detect(), stop: &stop, fibre_steps: &fibre_steps, recorder: None };
    let resolved = fly_together(&jobs, Keep::SAMPLES, computing).unwrap();
    let spread = off(&flown, &resolved, ["sigma_md", "sigma_cd"]);
    let found = change(&check, "spread");
    // A touch-down more or less at the ends of the compared time, of 250 elements.
    assert!((found.mean - spread).abs() < 0.1 * spread.abs() + 1e-4, "{spread}, {found:?}");
    let chord = off(&flown, &resolved, ["chord_over_arc"; 2]);
    assert!((change(&check, "chord_over_arc").mean - chord).abs() < 0.1 * chord.abs() + 1e-4, "{chord}");
    // Eight fibres of one metre are enough, because a pair stays together.
    assert!(found.standard_error.unwrap() < 0.01, "{found:?}");
}

/// Elements of 12.5 mm, a quarter of an eddy. The check sees elements of half their length only, and tells the error to
/// elements of a quarter of it, which is nearly all of it.
#[test]
fn order_of_the_error_of_the_mesh_is_what_half_the_elements_show() {
    let mut case = common::table1(Scheme::ImplicitTension, 1e-4, 0.8, 8);
    case.drag.across = NormalLaw::MarheinekeWegener;
    let meshed = |elements| {
        let mut case = case.clone();
        case.fibre.elements = elements;
        case
    };
    let coarse = meshed(80);
    let check = mesh_checked(&coarse);
    assert_eq!((check.element_length, check.duration), (6.25e-3, 0.8));
    let (coarse, fine) = (flights(&coarse, 2), flights(&meshed(320), 2));
    let factor = check.error_over_change().expect("a fibre of fixed length");
    for (name, measures, least) in [
        ("frequency", ["frequency_y", "frequency_z"], 0.1),
        ("amplitude", ["amplitude_y", "amplitude_z"], -1.0),
    ] {
        let (found, error) = (change(&check, name), off(&coarse, &fine, measures));
        let told = factor * found.mean;
        // Standard errors of both, and the sixteenth of the error that is left at a quarter of the length.
        let allowed = 2.0 * 2.0 * factor * found.standard_error.unwrap() + error.abs() / 16.0;
        assert!((told - error).abs() < allowed, "{name}: {told} for {error}");
        assert!(error > least, "{name}: {error}");
    }
}

/// In turbulence of its own for each mesh, eight fibres would differ by 6 % in a quarter of a second. Carried eddies are
/// tied to elements; the two meshes feel the same.
#[test]
fn identical_air_on_both_meshes_of_a_check() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    for name in ["convected", "measured_spectrum", "profile"] {
        let changes = [("run.duration", "0.25 s"), ("run.time_step", "50 us"), ("run.replicates", "1")];
        let changes = changes.map(|(key, value)| (key.to_owned(), value.to_owned()));
        let (case, _) = read_case(&cases.join(format!("{name}.toml")), &changes).expect("the case is there");
        let check = mesh_checked(&case);
        // One fibre of the run, and eight of the check, which cost no more.
        let found = change(&check, "amplitude");
        assert_eq!(found.values.len(), 8);
        assert!(found.values.iter().all(|value| value.abs() < 0.06), "{name}: {found:?}");
    }
}

#[test]
fn invariant_the_step_check_tells_the_error_of_the_step() {
    let (converged, _) = checked_at(Scheme::Leapfrog, 2e-6, 0.0);
    for (scheme, h, start) in [
        (Scheme::SemiImplicitEuler, 2e-5, 0.0),
        (Scheme::Leapfrog, 2e-5, 0.0),
        (Scheme::ImplicitTension, 5e-4, 0.0),
        (Scheme::ImplicitTension, 1e-4, START),
        (Scheme::ImplicitTension, 5e-5, START),
        (Scheme::ImplicitTension, 2e-5, START),
    ] {
        let (flown, check) = checked_at(scheme, h, 0.0);
        let instants = 1..=(check.duration / 1e-3).round() as usize;
        let (error, change) = (apart(&flown, &converged, instants), check.path.as_ref().expect("paths").mean);
        // The program takes the error to be at most 2.5 times the change.
        assert!(error < 2.5 * change + start, "{} at {h} s: {change:e} of {error:e}", scheme.name());
        assert!(change < 0.85 * error, "{} at {h} s: {change:e} of {error:e}", scheme.name());
        assert!(check.changes[0].estimate.mean.abs() < change, "{} at {h} s", scheme.name());
    }
}

/// The error of a scheme of order `p` is `C hᵖ`, so half the step changes the path by `1 − 2⁻ᵖ` of it: by a half or three
/// quarters. Damped, and seen after 0.4 s, the fibres have forgotten the waves of the start.
#[test]
fn order_of_the_error_is_what_half_the_step_shows() {
    let flown = |scheme, step| checked_at(scheme, step, 20.0).0;
    let converged = flown(Scheme::Leapfrog, 2e-6);
    // Found: 0.501, 0.758, and 0.719 and 0.690, where a little of the waves is left and steps are long.
    for (scheme, step, order, allowed) in [
        (Scheme::SemiImplicitEuler, 2e-5, 1, 0.02),
        (Scheme::Leapfrog, 2e-5, 2, 0.02),
        (Scheme::ImplicitTension, 5e-4, 2, 0.08),
        (Scheme::ImplicitTension, 2.5e-4, 2, 0.08),
    ] {
        let [own, half] = [step, step / 2.0].map(|step| flown(scheme, step));
        let share = apart(&own, &half, 400..=500) / apart(&own, &converged, 400..=500);
        let expected = 1.0 - 0.5f64.powi(order);
        assert!((share - expected).abs() < allowed, "{} at {step} s: {share}, not {expected}", scheme.name());
    }
}

#[test]
fn identical_air_at_half_the_step_from_every_source() {
    // In other turbulence the paths would differ by 1.4 amplitudes; stretches of a record and looks at a field
    // depend on the run's times. A tenth of the step that the program would choose leaves next to nothing.
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    for (name, step) in [
        ("record", "20 us"),
        ("convected", "20 us"),
        ("openfoam_diffuser", "10 us"),
        ("measured_spectrum", "20 us"),
    ] {
        let changes = [("run.time_step", step), ("run.duration", "0.25 s"), ("run.replicates", "3")];
        // Shorter elements have axial waves at the start that no such step damps; they are not what is tested here.
        let coarse = match name {
            "record" => Some(("fibre.element_length", "25 mm")),
            "measured_spectrum" => Some(("fibre.element_length", "50 mm")),
            _ => None,
        };
        let changes =
            changes.into_iter().chain(coarse).map(|(key, value)| (key.to_owned(), value.to_owned()));
        let changes: Vec<_> = changes.collect();
        let (case, _) = read_case(&cases.join(format!("{name}.toml")), &changes).expect("the case is there");
        let (_, check) = checked(&case, 2, Isa::detect(), false).expect("the case flies");
        let path = check.expect("25 instants and more").path.expect("paths");
        assert_eq!(path.values.len(), 3);
        assert!(path.values.iter().all(|&path| path < 2e-3), "{name}: {:?}", path.values);
    }
}

#[test]
fn identical_step_checks_for_any_number_of_threads_and_any_instruction_set() {
    let case = table1(2e-5, 0.1, 11);
    let (expected, check) = checked(&case, 1, Isa::Baseline, false).expect("the case flies");
    let check = format!("{:?}", check.expect("100 instants"));
    for (a, b) in expected.iter().zip(&flights(&case, 1)) {
        assert_same(a, b);
    }
    for isa in Isa::available() {
        for threads in [1, 2, 5] {
            let (found, again) = checked(&case, threads, isa, false).expect("the case flies");
            assert_eq!(format!("{:?}", again.expect("as before")), check, "{} {threads}", isa.name());
            expected.iter().zip(&found).for_each(|(a, b)| assert_same(a, b));
        }
    }
    assert!(matches!(checked(&case, 2, Isa::detect(), true), Err(Error::Interrupted)));
}

#[test]
fn step_checks_take_a_tenth_of_long_runs_and_leave_out_what_is_too_short_or_still() {
    // One flight of 20 million steps times elements, and ten such flights.
    let plan = |case: &Case| FinerPlans::of(case).step;
    for (replicates, seconds) in [(1, 0.05), (8, 0.05), (73, 0.5), (800, 1.0)] {
        let plan = plan(&table1(1e-6, 1.0, replicates)).expect("long enough");
        assert_eq!(plan.replicates, replicates.min(8));
        // Eight fibres at most, two steps for one.
        assert_eq!(plan.fibre_steps(), (2e6 * seconds) as u64 * plan.replicates);
        assert!(plan.share_of_run <= 0.1 && (replicates == 800 || plan.share_of_run > 0.099));
    }
    // All of a run that takes no time anyway.
    let half = plan(&table1(1e-4, 0.5, 8)).expect("500 instants");
    assert_eq!((half.fibre_steps(), half.share_of_run), (2 * 5000 * 8, 2.0));
    assert!(plan(&table1(1e-4, 0.019, 8)).is_err());
    let mut still = table1(1e-4, 0.1, 2);
    (still.run.scheme, still.air.turbulence_intensity) = (Scheme::ImplicitTension, 0.0);
    assert!(plan(&still).is_ok());
    assert!(checked(&still, 1, Isa::detect(), false).expect("the case flies").1.is_none());
    let (_, mesh) = checked_by(Refined::Elements, &still, 1, Isa::detect(), false).expect("the case flies");
    assert!(mesh.is_err_and(|why| why.contains("does not move")));
    // The mesh of the paper's case takes implicit tension and no more than a hundredth of the run.
    let mesh = FinerPlans::of(&table1(1e-6, 1.0, 10)).mesh.expect("long enough");
    assert!(mesh.replicates == 8 && mesh.share_of_run < 0.01, "{}", mesh.share_of_run);
    // A second of fed fibre would take many times the run.
    let slow = common::laying::spunbond(&[
        ("feed.speed", "0.5 m/s"),
        ("belt.speed", "0.03 m/s"),
        ("run.duration", "20 s"),
    ]);
    assert!(FinerPlans::of(&slow).step.is_err_and(|why| why.contains("times the run's computing time")));
}
