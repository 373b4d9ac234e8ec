//! The checks of a run against finer steps and finer elements.

use crate::common;
use crate::common::*;
use crate::ensembles::{assert_same, flights, table1};
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{Case, Checks, Job, NormalLaw, Run};
use spunlaid_ground::{Error, Estimate, Isa, RunContext};
use spunlaid_input::read_case;
use spunlaid_simulation::ensemble::{fly_for_checks, fly_together};
use spunlaid_simulation::{FinerCheck, FinerPlans, Recorded, Refinement, Trajectory, Unchecked};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64};

/// The trajectories of a case, and one of its checks.
fn checked_by(
    refined: Refinement,
    case: &Case,
    threads: usize,
    isa: Isa,
    stop: bool,
) -> Result<(Vec<Trajectory>, Result<FinerCheck, Unchecked>), Error> {
    let (stop, fibre_steps) = (AtomicBool::new(stop), AtomicU64::new(0));
    let computing = RunContext { threads, isa, stop: &stop, done: &fibre_steps };
    let none = || Err(Unchecked::NotAsked);
    // Short runs are not worth a check; here all of them are checked.
    let whole = Case { run: Run { checks: Checks::Full, ..case.run }, ..case.clone() };
    let plans = match (refined, FinerPlans::for_case(&whole)) {
        (Refinement::TimeStep, FinerPlans { step, .. }) => FinerPlans { step, mesh: none() },
        (Refinement::Elements, FinerPlans { mesh, .. }) => FinerPlans { step: none(), mesh },
    };
    let mut simulated = Vec::new();
    let paths = fly_for_checks(
        case,
        &plans,
        Recorded::SAMPLES,
        computing,
        |_, _| Ok(None),
        |trajectory| {
            simulated.push(trajectory.expect("no fibre is lost"));
            Ok::<(), Error>(())
        },
    )?;
    let checks = plans.check(&paths, computing);
    assert_eq!(fibre_steps.into_inner(), case.run.steps * case.run.replicates + plans.fibre_steps());
    Ok((simulated, if refined == Refinement::TimeStep { checks.step } else { checks.mesh }))
}

/// The trajectories of a case, and what a finer step changes.
fn checked(
    case: &Case,
    threads: usize,
    isa: Isa,
    stop: bool,
) -> Result<(Vec<Trajectory>, Option<FinerCheck>), Error> {
    checked_by(Refinement::TimeStep, case, threads, isa, stop)
        .map(|(simulated, check)| (simulated, check.ok()))
}

/// What elements of half the length change.
fn mesh_checked(case: &Case) -> FinerCheck {
    let (_, check) = checked_by(Refinement::Elements, case, 2, Isa::detect(), false).expect("the case flies");
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

/// Rms distance of two fibres' ends across the flow, as a share of the amplitude of the second; the mean over
/// the fibres.
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
    let (simulated, check) = checked(&case, 1, Isa::detect(), false).expect("the case flies");
    (simulated, check.expect("500 instants"))
}

/// The fibre starts without tension, and the axial waves of the start run on for long. Implicit tension damps
/// them at a rate that hardly depends on the step, so that half the step shows little of what they do to the
/// path: 3 parts in 10 000 of the amplitude were found.
const START: f64 = 4e-4;

/// Half of a long step of implicit tension says nothing about its limit: axial waves are damped at both. The
/// check flies leapfrog, with steps that resolve these waves, and reports the whole difference.
#[test]
fn invariant_the_step_check_of_a_fed_fibre_compares_it_with_resolved_axial_waves() {
    // As long as the check, so that its flights are those below: a way of 10 ms takes twice that to come
    // down. What is kept on the belt is short, so that most of what comes down is compared.
    let mut case = common::laying::spunbond(&[
        ("run.duration", "40 ms"),
        ("run.spin_up", "20 ms"),
        ("belt.kept_length", "30 mm"),
    ]);
    case.run.replicates = 8;
    let (simulated, check) = checked(&case, 2, Isa::detect(), false).unwrap();
    let check = check.expect("long enough");
    assert_eq!(check.scheme, Scheme::Leapfrog);
    assert_eq!((check.replicates, check.error_of_step()), (8, Some(1.0)));
    assert!(check.time_step <= 0.5 * case.fibre.axial_step_limit(), "{}", check.time_step);

    let mut fine = case.clone();
    fine.run.scheme = Scheme::Leapfrog;
    fine.set_time_step(check.time_step);
    let jobs: Vec<Job<'_>> = (0..8).map(|replicate| Job::new(&fine, replicate)).collect();
    let (stop, fibre_steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let computing = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &fibre_steps };
    let resolved = fly_together(&jobs, Recorded::SAMPLES, computing).unwrap();
    let spread = off(&simulated, &resolved, ["sigma_md", "sigma_cd"]);
    let found = change(&check, "spread");
    // A touch-down more or less at the ends of the compared time, of 250 elements.
    assert!((found.mean - spread).abs() < 0.1 * spread.abs() + 1e-4, "{spread}, {found:?}");
    let chord = off(&simulated, &resolved, ["chord_over_arc"; 2]);
    assert!((change(&check, "chord_over_arc").mean - chord).abs() < 0.1 * chord.abs() + 1e-4, "{chord}");
    // Eight fibres of one metre are enough, because a pair stays together.
    assert!(found.standard_error.unwrap() < 0.01, "{found:?}");
}

/// The check of the mesh flies the same line with elements of half the length: it finds what anybody finds who
/// halves them by hand. An element that is half as long is fed in half as many steps.
#[test]
fn invariant_the_mesh_check_of_a_fed_fibre_gives_what_manual_halving_does() {
    let line = |element: &str| {
        let mut case = common::laying::spunbond(&[
            ("run.duration", "60 ms"),
            ("run.spin_up", "20 ms"),
            ("belt.kept_length", "30 mm"),
            ("fibre.element_length", element),
            ("run.time_step", "20 us"),
        ]);
        case.run.replicates = 8;
        case
    };
    let [coarse, fine] = ["4 mm", "2 mm"].map(line);
    let check = mesh_checked(&coarse);
    let [own, halved] = [&coarse, &fine].map(|case| flights(case, 2));
    for (name, measures) in [
        ("spread", ["sigma_md", "sigma_cd"]),
        ("half_correlation_length", ["half_correlation_length_md", "half_correlation_length_cd"]),
        ("chord_over_arc", ["chord_over_arc"; 2]),
    ] {
        let (found, by_hand) = (change(&check, name), off(&own, &halved, measures));
        // Both fly in the same turbulence with steps of 20 µs or a little less.
        let allowed = 3.0 * found.standard_error.unwrap() + 0.01;
        assert!((found.mean - by_hand).abs() < allowed, "{name}: {by_hand}, {found:?}");
        assert!(found.mean.abs() < 0.3, "{name}: {found:?}");
    }
    // Each measure alone has its own change, for its own error.
    let alone = check.change_of("sigma_md").expect("compared").estimate.mean;
    assert!((alone - off(&own, &halved, ["sigma_md"; 2])).abs() < 0.05, "{alone}");
    assert!(check.change_of("nodes_in_air").is_none() && check.change_of("noise").is_some());
}

/// Twice the elements of a case that was made for long ones: the fibre would be fed at half its speed.
#[test]
fn rejects_elements_that_are_not_fed_in_their_steps() {
    let mut case = common::laying::spunbond(&[]);
    // Of two steps for each element; one step alone is too long for half an element.
    case.set_time_step(0.5 * case.run.time_step);
    assert!(case.check().is_ok());
    case.fibre.elements *= 2;
    let problems = case.check().unwrap_err();
    assert!(problems[0].to_string().contains("set the time step after the element length"), "{problems:?}");
}

/// Table 1 with so many elements.
fn with_elements(number: usize, law: NormalLaw) -> Case {
    let mut case = common::table1(Scheme::ImplicitTension, 1e-4, 3.0, 8);
    (case.drag.across, case.fibre.elements) = (law, number);
    case
}

/// Elements of 3.125 mm.
const FINE: usize = 320;

/// Elements of 12.5 mm, a quarter of an eddy. The check sees elements of a half and of a quarter of their length; they
/// show the second order, and it reports the error to elements of no length, of which a quarter leaves a sixteenth.
#[test]
fn order_of_the_error_of_the_mesh_is_what_two_halvings_show() {
    let meshed = |elements| with_elements(elements, NormalLaw::MarheinekeWegener);
    let check = mesh_checked(&meshed(80));
    let [coarse, fine] = [80, FINE].map(|elements| flights(&meshed(elements), 2));
    assert_eq!((check.element_length, check.duration), (6.25e-3, 3.0));
    let frequency =
        check.changes.iter().find(|change| change.statistic.name == "frequency").expect("compared");
    let factor = check.error_over(frequency).expect("two halvings show it");
    let error = off(&coarse, &fine, ["frequency_y", "frequency_z"]);
    let (estimated, found) = (factor * frequency.estimate.mean, &frequency.estimate);
    // Standard errors of both, and the sixteenth of the error that is left at a quarter of the length.
    let allowed = 2.0 * 2.0 * factor * found.standard_error.unwrap() + error.abs() / 16.0;
    assert!((estimated - error).abs() < allowed && error > 0.1, "{estimated} for {error}");
    // Steps of other lengths, so that few crossings of the axis differ.
    let (length, whole) = frequency.from_quarter.as_ref().expect("simulated too");
    let near = 2.0 * whole.standard_error.unwrap();
    assert!((whole.mean - error).abs() < near && *length == 3.125e-3, "{whole:?} {error}");
}

/// Elements as long as an eddy, and half as long. The frequency goes up with the first two halvings and down with the
/// next ones, so that four thirds of the difference are −42 % for −27 %, and −12 % for +7 %.
#[test]
fn rejects_an_error_of_the_mesh_where_no_order_is_shown() {
    let meshed = |elements| with_elements(elements, NormalLaw::JuShambaugh);
    let fine = flights(&meshed(FINE), 2);
    for (elements, truth) in [(20, -0.27), (40, 0.07)] {
        let check = mesh_checked(&meshed(elements));
        let coarse = flights(&meshed(elements), 2);
        let frequency =
            check.changes.iter().find(|change| change.statistic.name == "frequency").expect("there");
        let error = off(&coarse, &fine, ["frequency_y", "frequency_z"]);
        assert!((error - truth).abs() < 0.06, "{elements}: {error}");
        assert_eq!(check.error_over(frequency), None, "{elements}");
        // What is reported instead contains it.
        let most = frequency.estimates().map(|change| change.mean.abs()).fold(0.0, f64::max);
        assert!(error.abs() < most, "{elements}: {error} {most}");
    }
}

/// In turbulence of its own for each mesh, eight fibres would differ by 6 % in a quarter of a second. Carried
/// eddies are tied to elements; the two meshes feel the same. Elements of 6.25 mm are fine enough for that: amplitudes
/// differ by up to 2.1 %.
#[test]
fn identical_air_on_both_meshes_of_a_check() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    for name in ["convected", "measured_spectrum", "profile"] {
        let changes = [
            ("run.duration", "0.25 s"),
            ("run.time_step", "100 us"),
            ("run.replicates", "1"),
            ("fibre.element_length", "6.25 mm"),
        ];
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
fn invariant_the_step_check_gives_the_error_of_the_step() {
    let (converged, _) = checked_at(Scheme::Leapfrog, 2e-6, 0.0);
    for (scheme, h, start) in [
        (Scheme::SemiImplicitEuler, 2e-5, 0.0),
        (Scheme::Leapfrog, 2e-5, 0.0),
        (Scheme::ImplicitTension, 5e-4, 0.0),
        (Scheme::ImplicitTension, 1e-4, START),
        (Scheme::ImplicitTension, 5e-5, START),
        (Scheme::ImplicitTension, 2e-5, START),
    ] {
        let (simulated, check) = checked_at(scheme, h, 0.0);
        let instants = 1..=(check.duration / 1e-3).round() as usize;
        let error = apart(&simulated, &converged, instants);
        let change = check.path.as_ref().expect("paths").mean;
        // The program takes the error to be at most 2.5 times the change.
        assert!(error < 2.5 * change + start, "{} at {h} s: {change:e} of {error:e}", scheme.name());
        assert!(change < 0.85 * error, "{} at {h} s: {change:e} of {error:e}", scheme.name());
        assert!(check.changes[0].estimate.mean.abs() < change, "{} at {h} s", scheme.name());
    }
}

/// The error of a scheme of order `p` is `C hᵖ`, so half the step changes the path by `1 − 2⁻ᵖ` of it: by a
/// half or three quarters. Damped, and seen after 0.4 s, the fibres have forgotten the waves of the start.
#[test]
fn order_of_the_error_is_what_half_the_step_shows() {
    let simulated = |scheme, step| checked_at(scheme, step, 20.0).0;
    let converged = simulated(Scheme::Leapfrog, 2e-6);
    // Found: 0.501, 0.758, and 0.719 and 0.690, where a little of the waves is left and steps are long.
    for (scheme, step, order, allowed) in [
        (Scheme::SemiImplicitEuler, 2e-5, 1, 0.02),
        (Scheme::Leapfrog, 2e-5, 2, 0.02),
        (Scheme::ImplicitTension, 5e-4, 2, 0.08),
        (Scheme::ImplicitTension, 2.5e-4, 2, 0.08),
    ] {
        let [own, half] = [step, step / 2.0].map(|step| simulated(scheme, step));
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
    let of_isa = Isa::available().into_iter().map(|isa| (isa, 2));
    for (isa, threads) in of_isa.chain([1, 5].map(|threads| (Isa::detect(), threads))) {
        let (found, again) = checked(&case, threads, isa, false).expect("the case flies");
        assert_eq!(format!("{:?}", again.expect("as before")), check, "{} {threads}", isa.name());
        expected.iter().zip(&found).for_each(|(a, b)| assert_same(a, b));
    }
    assert!(matches!(checked(&case, 2, Isa::detect(), true), Err(Error::Interrupted)));
}

#[test]
fn step_checks_take_a_tenth_of_long_runs_and_leave_out_what_is_too_short_or_still() {
    // One flight of 20 million steps times elements, and ten such flights.
    let plan = |case: &Case| FinerPlans::for_case(case).step;
    for (replicates, seconds) in [(1, 0.05), (8, 0.05), (73, 0.5), (800, 1.0)] {
        let plan = plan(&table1(1e-6, 1.0, replicates)).expect("long enough");
        assert_eq!(plan.replicates, replicates.min(8));
        // Eight fibres at most, two steps for one, less what their turbulence takes.
        let most = 2e6 * seconds * plan.replicates as f64;
        let part = plan.fibre_steps() as f64 / most;
        assert!(part <= 1.0 && (replicates == 800 || part > 0.95), "{replicates}: {part}");
        assert!(plan.share_of_run < 0.1 + 1e-12 && (replicates == 800 || plan.share_of_run > 0.097));
    }
    // As many instants as say something, if all checks together then take no more than a fifth of the run. A window of
    // turbulence has 3 · 20 signals of 256 harmonics, each of which counts 0.3 · log2(1024) steps of an element.
    let window = 3.0 * 20.0 * 256.0 * 3.0;
    let near = |found: f64, wanted: f64| (found / wanted - 1.0).abs() < 1e-9;
    let fewest = plan(&table1(1e-5, 0.5, 8)).expect("20 of 500 instants");
    assert!(fewest.share_of_run <= 0.2, "{}", fewest.share_of_run);
    let steps = fewest.fibre_steps() as f64 / 8.0;
    assert!(near(fewest.share_of_run, (20.0 * steps + window) / (20.0 * 50_000.0 + window)));
    let dear = plan(&table1(1e-4, 0.25, 8)).err();
    let times = (20.0 * 5000.0 + window) / (20.0 * 2500.0 + window);
    assert!(matches!(dear, Some(Unchecked::Dear { times: found }) if near(found, times)), "{dear:?} {times}");
    assert_eq!(plan(&table1(1e-4, 0.019, 8)).err(), Some(Unchecked::TooShort));
    // All of it if that is asked for, and nothing.
    let mut asked = table1(1e-4, 0.5, 8);
    asked.run.checks = Checks::Full;
    let half = plan(&asked).expect("500 instants");
    assert_eq!(half.fibre_steps(), 2 * 5000 * 8);
    assert!(near(half.share_of_run, (20.0 * 10_000.0 + window) / (20.0 * 5000.0 + window)));
    asked.run.checks = Checks::None;
    assert_eq!(plan(&asked).err(), Some(Unchecked::NotAsked));
    let mut still = table1(1e-4, 0.1, 2);
    still.run.checks = Checks::Full;
    (still.run.scheme, still.air.turbulence_intensity) = (Scheme::ImplicitTension, 0.0);
    assert!(plan(&still).is_ok());
    assert!(checked(&still, 1, Isa::detect(), false).expect("the case flies").1.is_none());
    let (_, mesh) =
        checked_by(Refinement::Elements, &still, 1, Isa::detect(), false).expect("the case flies");
    assert!(mesh.is_err_and(|why| why.to_string().contains("does not move")));
    // The mesh of the paper's case takes implicit tension, and with two halvings no more than a tenth of the run.
    let mesh = FinerPlans::for_case(&table1(1e-6, 1.0, 10)).mesh.expect("long enough");
    assert!(mesh.replicates == 8 && mesh.share_of_run < 0.1 + 1e-9, "{}", mesh.share_of_run);
    // Leapfrog at short steps takes many times a short run.
    let fed = |duration| {
        let case = common::laying::spunbond(&[("run.duration", duration)]);
        FinerPlans::for_case(&case)
    };
    assert!(matches!(fed("0.1 s").step, Err(Unchecked::Dear { times }) if times > 2.0));
    for duration in ["0.05 s", "0.5 s", "2 s", "20 s"] {
        let share = fed(duration).share_of_run();
        assert!(share <= 0.2, "{duration}: {share}");
    }
}

/// A run of many harmonics makes its turbulence for most of its time, and so does each flight of its checks.
/// Longer runs pay for it.
#[test]
fn checks_count_the_turbulence_that_they_make() {
    let of = |duration, harmonics| {
        let mut case = table1(1e-5, duration, 8);
        case.air.harmonics = harmonics;
        (FinerPlans::for_case(&case), case)
    };
    // Eight fibres for 100 s, as the program chooses them: 14 windows of 1024 harmonics are next to nothing.
    let (usual, _) = of(100.0, 1024);
    assert_eq!(table1(1e-5, 100.0, 8).default_harmonics(), 1024);
    assert!(usual.step.is_ok() && usual.mesh.is_ok());
    assert!(usual.share_of_run() <= 0.2, "{}", usual.share_of_run());
    // 65536 harmonics count 3 · 20 · 65536 · 0.6 · 18 steps of an element, beside 200 million of 100 s.
    let window = 3.0 * 20.0 * 65536.0 * 0.6 * 18.0;
    let (many, _) = of(100.0, 65536);
    assert!(many.share_of_run() <= 0.2, "{}", many.share_of_run());
    let all = 20.0 * 1e7 + window;
    let left_out = [&many.step, &many.mesh].into_iter().filter_map(|plan| plan.as_ref().err());
    assert!(
        left_out.clone().count() > 0 && left_out.clone().all(|why| matches!(why, Unchecked::Dear { .. }))
    );
    let whole = (20.0 * 2e5 + window) / all;
    assert!(whole > 0.1, "one flight of the check takes more than a tenth: {whole}");
    // With 1 s nothing of it is worth its time; asked for, all is simulated and its share reported.
    let (short, mut full) = of(1.0, 65536);
    assert!(short.step.is_err() && short.mesh.is_err(), "{short:?}");
    full.run.checks = Checks::Full;
    let step = FinerPlans::for_case(&full).step.expect("asked for").share_of_run;
    let wanted = (20.0 * 2e5 + window) / (20.0 * 1e5 + window);
    assert!((step / wanted - 1.0).abs() < 1e-9, "{step} {wanted}");
    // Windows that follow one another are counted: a quarter of each overlaps the next.
    let share = |duration: f64| {
        let (_, mut case) = of(duration, 128);
        case.run.checks = Checks::Full;
        FinerPlans::for_case(&case).step.expect("asked for").share_of_run
    };
    let counted = |duration: f64, windows: f64| {
        let steps = 20.0 * duration / 1e-5;
        let air = windows * 3.0 * 20.0 * 128.0 * 0.3 * 9.0;
        (2.0 * steps + air) / (steps + air)
    };
    // They begin every 0.96 s, and no more than one second is compared.
    for (duration, windows) in [(0.95, 1.0), (0.97, 2.0)] {
        assert!((share(duration) / counted(duration, windows) - 1.0).abs() < 1e-9, "{duration}");
    }
}
