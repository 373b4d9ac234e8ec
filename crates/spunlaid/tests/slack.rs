//! Slack fed fibres: in air about as fast as the feed a fibre folds and whips in flight. And the guard, which finds the fibres
//! whose computation has diverged.
#![allow(clippy::unwrap_used)]

mod common;

use common::laying::{flight, spunbond};
use spunlaid::case::Case;
use spunlaid::error::{DivergenceSign, Error};
use spunlaid::input::read_case;
use spunlaid::lanes::Lanes;
use spunlaid::vec3::Vec3;

/// The line of `spunbond.toml` in air whose velocity changes evenly on the way [m/s], with this intensity [-] and seed.
fn in_air(velocities: [f64; 2], intensity: f64, seed: u64) -> Case {
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
    let seed = ("run.seed".to_owned(), seed.to_string());
    read_case(&file, &[seed]).unwrap().0
}

/// No more than air, feed and a fold that opens can give: a fold of a fibre that comes with `v` and is held on one side throws
/// its other side with `2v`. The scheme once threw nodes with kilometres a second in one of eight replicates, and called it a
/// mean.
#[test]
fn invariant_a_slack_fibre_is_no_faster_than_what_drives_it() {
    for (velocities, intensity, seed) in
        [([60.0, 40.0], 0.05, 1), ([55.0, 45.0], 0.05, 2), ([50.0, 50.0], 0.001, 1), ([60.0, 60.0], 0.001, 1)]
    {
        let case = in_air(velocities, intensity, seed);
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
            assert_ne!(*sign, DivergenceSign::NotFinite, "{lost}");
            assert!(cause.contains("run.time_step"), "{lost}");
        }
    }
}
