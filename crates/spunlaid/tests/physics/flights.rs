//! Flights that others step: owned, changed in flight, endless.

use crate::common;
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{Case, Flight, Job};
use spunlaid_ground::{Error, Isa};

/// In steps of 20 µs.
fn table1() -> Case {
    common::table1(Scheme::SemiImplicitEuler, 2e-5, 0.02, 10)
}

#[test]
fn rejects_jobs_that_cannot_fly_together() {
    let case = table1();
    let mut coarser = case.clone();
    let mut longer = case.clone();
    let mut damped = case.clone();
    let mut broken = case.clone();
    coarser.fibre.elements = 10;
    longer.run.steps = 2000;
    damped.run.damping = 1.0;
    broken.fibre.diameter = -1.0;
    let fault = |cases: &[&Case]| {
        let jobs: Vec<Job<'_>> = cases.iter().map(|&case| Job::new(case, 0)).collect();
        Flight::new(&jobs, Isa::detect()).map(|_| ()).unwrap_err()
    };
    for (cases, message) in [
        (&[][..], "a flight needs at least one fibre"),
        (&[&case; 9], "9 fibres cannot be simulated together; at most 8 are possible"),
    ] {
        let error = fault(cases);
        assert!(matches!(error, Error::Flight(_)));
        assert_eq!(error.to_string(), message);
    }
    for (other, what) in
        [(&coarser, "number of elements"), (&longer, "run.duration"), (&damped, "run.damping")]
    {
        let fault = fault(&[&case, &case, other]).to_string();
        assert!(fault.contains("fibre 3") && fault.contains(what), "{fault}");
    }
    assert!(matches!(fault(&[&case, &broken]), Error::Rejected(_)));
}

#[test]
fn identical_in_however_many_strides_it_is_stepped() {
    let case = table1();
    let flight = || Flight::new(&[Job::new(&case, 2)], Isa::detect()).unwrap();
    let (mut whole, mut strides) = (flight(), flight());
    // Beyond the case's own duration, into the third window of the turbulence.
    whole.step_to(4.0).unwrap();
    for stride in 1..=400 {
        strides.step_to(0.01 * f64::from(stride)).unwrap();
        if stride % 100 == 0 {
            strides.snapshot();
        }
    }
    assert_eq!(whole.snapshot().position, strides.snapshot().position);
    assert_eq!(whole.time(), 4.0);
}

/// Error of the energy balance after several changes in flight, as a share of the air's work: rms of eight fibres.
fn imbalance_after_changes(scheme: Scheme, time_step: f64) -> f64 {
    let case = common::table1(scheme, time_step, 0.06, 8);
    let jobs = [0, 1, 2, 3, 4, 5, 6, 7].map(|replicate| Job::new(&case, replicate));
    let mut flight = Flight::new(&jobs, Isa::detect()).unwrap();
    flight.step_to(0.02).unwrap();
    flight.set("run.gravity", "5 m/s²").unwrap();
    flight.step_to(0.03).unwrap();
    flight.set("fibre.youngs_modulus", 1e9).unwrap();
    flight.set("air.velocity", "20 m/s").unwrap();
    flight.step_to(0.04).unwrap();
    flight.set("fibre.diameter", "55 µm").unwrap();
    flight.step_to(0.06).unwrap();
    let energy = flight.snapshot().energy;
    let error = |lane: usize| energy.imbalance().0[lane] / energy.drag_work.0[lane];
    ((0..8).map(|lane| error(lane).powi(2)).sum::<f64>() / 8.0).sqrt()
}

/// What is left of the balance comes from the step and vanishes with it: an energy that is lost at a change would stay.
/// The forces jump at a change, which makes every scheme of first order there.
#[test]
fn order_of_the_energy_balance_across_changes() {
    for scheme in Scheme::ALL {
        let [coarse, fine] = [8e-6, 2e-6].map(|time_step| imbalance_after_changes(scheme, time_step));
        let order = (coarse / fine).log2() / 2.0;
        assert!(fine < 1e-3, "{}: {fine:e}", scheme.name());
        assert!(order > 0.65, "{}: order {order}, {coarse:e} {fine:e}", scheme.name());
    }
}

#[test]
fn identical_to_a_flight_that_began_so_when_set_at_the_start() {
    let slow = table1();
    let mut fast = slow.clone();
    fast.air.velocity = 20.0;
    let at_end = |case, change: bool| {
        let mut flight = Flight::new(&[Job::new(case, 3)], Isa::detect()).unwrap();
        if change {
            flight.set("air.velocity", "20 m/s").unwrap();
        }
        flight.step_to(0.01).unwrap();
        flight.snapshot().position
    };
    assert_eq!(at_end(&slow, true), at_end(&fast, false));
}

#[test]
fn rejects_what_cannot_change_and_flies_on() {
    let case = table1();
    let mut flight = Flight::new(&[Job::new(&case, 0)], Isa::detect()).unwrap();
    flight.step_to(0.01).unwrap();
    let before = flight.snapshot().position;
    for (key, value, expected) in [
        ("air.velocty", "20 m/s", "air.velocity"),
        ("air.velocity", "20 mm", "velocity"),
        ("air.velocity", "fast", "velocity"),
        ("fibre.diameter", "-60 µm", "positive"),
        ("fibre.length", "2 m", "cannot change in flight"),
        ("run.time_step", "1 µs", "cannot change in flight"),
        ("air.speed_factor", "2", "no meaning"),
        // Stiffer than the step can bear.
        ("fibre.youngs_modulus", "200 GPa", "stability limit"),
    ] {
        let message = flight.set(key, value).unwrap_err().to_string();
        assert!(message.contains(expected), "{key} = {value}: {message}");
        assert_eq!(flight.snapshot().position, before, "{key}");
    }
    flight.set("air.velocity", f64::NAN).unwrap_err();
    flight.step_to(0.005).unwrap_err();
    flight.step_to(f64::NAN).unwrap_err();
    flight.step_to(0.02).unwrap();
}

#[test]
fn a_flight_belongs_to_its_owner_and_may_go_to_another_thread() {
    fn is_free<T: Send + 'static>(_: &T) {}
    let flight = Flight::new(&[Job::new(&table1(), 0)], Isa::detect()).unwrap();
    is_free(&flight);
}
