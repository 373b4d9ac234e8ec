//! Slack fed fibres: in air about as fast as the feed a fibre folds and whips in flight. And the guard, which
//! finds the fibres whose computation has diverged.

use crate::common::laying::{flight, spunbond};
use spunlaid_fibre::{Case, Contact};
use spunlaid_ground::{Error, Lanes, Vec3};
use spunlaid_input::read_case;

/// The line of `spunbond.toml` in air whose velocity changes evenly on the way [m/s], with this intensity [-]
/// and other values.
fn in_air(velocities: [f64; 2], intensity: f64, set: &[(&str, &str)]) -> Case {
    let folder = tempfile::tempdir().unwrap();
    let rows = [0.0, 500.0].into_iter().zip(velocities).map(|(x, v)| {
        let cutoff = v / 4.0 / 0.016;
        format!("{x},{v},{intensity},16,{cutoff}\n")
    });
    let head = "x_mm,velocity_m_s,turbulence_intensity,length_scale_mm,cutoff_frequency_hz\n";
    std::fs::write(folder.path().join("air.csv"), head.to_owned() + &rows.collect::<String>()).unwrap();
    let text = std::fs::read_to_string("../../cases/spunbond.toml").unwrap();
    let file = folder.path().join("slack.toml");
    std::fs::write(&file, text.replace("tables/spunbond.csv", "air.csv")).unwrap();
    let set: Vec<_> = set.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    read_case(&file, &set).unwrap().0
}

/// No more than air, feed and a fold that opens can give: a fold of a fibre that comes with `v` and is held
/// on one side throws its other side with `2v`. The scheme once threw nodes with kilometres a second in one
/// of eight replicates, and called it a mean.
#[test]
fn invariant_a_slack_fibre_is_no_faster_than_what_drives_it() {
    for (velocities, intensity, seed) in [
        ([60.0, 40.0], 0.05, "1"),
        ([55.0, 45.0], 0.05, "2"),
        ([50.0, 50.0], 0.001, "1"),
        ([60.0, 60.0], 0.001, "1"),
    ] {
        let case = in_air(velocities, intensity, &[("run.seed", seed)]);
        let driven = 2.0 * velocities[0] * (1.0 + 3.0 * intensity);
        let mut flight = flight(&case, 0..8);
        for _ in 0..4000 {
            flight.advance(1);
            for (i, v) in flight.chain().velocity.iter().enumerate() {
                for lane in 0..8 {
                    let speed = v.lane(lane).norm();
                    assert!(speed < driven, "{velocities:?}, {intensity}: node {i} moves with {speed} m/s");
                }
            }
        }
        // It is not lost.
        flight.step_to(flight.time()).unwrap();
    }
}

/// Throws a node of the fibre in lane 3, and says how the flight goes on.
fn after_a_throw(case: &Case, speed: f64) -> Result<(), Error> {
    let mut flight = flight(case, 0..8);
    flight.step_to(0.02).unwrap();
    let throw =
        Vec3::new(Lanes::ZERO, Lanes::ZERO, Lanes::from_fn(|lane| if lane == 3 { speed } else { 0.0 }));
    flight.push(3, throw);
    flight.step_to(flight.time() + 4.0 * case.run.time_step)
}

#[test]
fn a_fibre_that_diverges_is_lost_with_its_replicate_and_the_reason() {
    for scheme in ["implicit-tension", "leapfrog", "semi-implicit-euler"] {
        let fed = spunbond(&[("run.scheme", scheme)]);
        let fixed = read_case(
            std::path::Path::new("../../cases/table1.toml"),
            &[("run.scheme".to_owned(), scheme.to_owned())],
        );
        for case in [fed, fixed.unwrap().0] {
            assert!(after_a_throw(&case, 0.0).is_ok());
            let lost = after_a_throw(&case, 1e5).unwrap_err();
            let Error::Diverged { replicate, sign, cause, .. } = &lost else { unreachable!("{lost}") };
            assert_eq!(*replicate, 4, "{lost}");
            assert!(!sign.contains("no longer finite"), "{lost}");
            assert!(cause.contains("run.time_step"), "{lost}");
        }
    }
}

/// A thick filament on a belt three times as fast, in still air.
fn on_a_fast_belt(kept_length: &str) -> Case {
    let text = format!(
        "version = 1\n[fibre]\ndiameter = \"200 um\"\ndensity = \"910 kg/m3\"\nyoungs_modulus = \"2 GPa\"\n\
         element_length = \"4 mm\"\nroot = \"clamped\"\n[feed]\nspeed = \"1 m/s\"\n[belt]\ndistance = \"5 cm\"\n\
         speed = \"3 m/s\"\ncontact = \"friction\"\nkept_length = \"{kept_length}\"\n[air]\nvelocity = \"0 m/s\"\n\
         turbulence_intensity = 0\nlength_scale = \"16 mm\"\ncutoff_frequency = \"800 Hz\"\n[drag]\n\
         across = \"marheineke-wegener\"\n[run]\nduration = \"0.8 s\"\nreplicates = 1\n"
    );
    read_case((&text, "fast.toml"), &[]).unwrap().0
}

/// What slides pulls with `μ(pd + w)` a length at most, so with 48 mN from all of 0.8 m. It once came out as 90 N.
#[test]
fn analytic_what_slides_pulls_no_more_than_its_friction() {
    let case = on_a_fast_belt("10 m");
    let mut flight = flight(&case, 0..1);
    let weight = case.fibre.density * case.fibre.cross_section() * case.run.gravity;
    let Contact::Friction { coefficient, suction } = case.line.unwrap().contact else { unreachable!() };
    let most = coefficient * (suction * case.fibre.diameter + weight) * case.run.duration();
    let tensions = (1..=800).map(|i| {
        flight.step_to(i as f64 * 1e-3).unwrap();
        flight.snapshot().tension[0].0[0]
    });
    let mean = tensions.sum::<f64>() / 800.0;
    assert!(mean < most, "{mean} N, where friction has {most} N");
}

#[test]
fn a_fibre_that_a_fast_belt_tears_names_the_belt() {
    let case = on_a_fast_belt("10 cm");
    let lost = flight(&case, 0..1).step_to(0.8).unwrap_err().to_string();
    assert!(lost.contains("the belt is faster than the feed (3 m/s and 1 m/s)"), "{lost}");
}
