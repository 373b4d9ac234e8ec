//! The load of filaments on their air, against numbers by hand.

use spunlaid_fibre::{Case, Load, Station, WayPlace, ZERO_CELSIUS};
use spunlaid_input::read_case;
use std::path::Path;

fn case(name: &str) -> Case {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(name);
    read_case(&path, &[]).unwrap().0
}

/// Places in the middles of classes at which the force is given.
fn way(classes: usize, distance: f64, force: impl Fn(f64) -> f64) -> Vec<WayPlace> {
    let place = |i: usize| {
        let distance = (i as f64 + 0.5) / classes as f64 * distance;
        WayPlace { distance, force: force(distance), standard_error: Some(1e-6), fibre: 2.0 }
    };
    (0..classes).map(place).collect()
}

fn close(found: f64, expected: f64, to: f64) {
    assert!((found / expected - 1.0).abs() < to, "{found}, not {expected}");
}

/// Air that slows down from 60 to 10 m/s over half a metre, from a slot of 20 mm; 5000 filaments of 18 µm.
#[test]
fn analytic_load_of_a_force_that_grows_evenly() {
    let case = case("spunbond.toml");
    let load = Load::new(&case, 5000.0, Some(0.02), &way(50, 0.5, |x| 6e-4 * x), None).unwrap();
    close(load.mass_loading().unwrap(), 5000.0 * 910.0 * 2.54469e-10 * 50.0 / (1.204 * 60.0 * 0.02), 1e-4);
    close(load.momentum_loading().unwrap(), load.mass_loading().unwrap() * 50.0 / 60.0, 1e-12);
    let belt = load.at_belt().unwrap();
    close(belt.force, 5000.0 * 6e-4 * 0.5, 1e-12);
    close(belt.standard_error.unwrap(), 5e-3, 1e-12);
    close(belt.share_of_momentum().unwrap(), 1.5 / (1.204 * 60.0 * 0.02 * 10.0), 1e-9);
    close(belt.change_of_velocity().unwrap(), (1.0 + 1.5 / 14.448_f64).sqrt() - 1.0, 1e-9);
    // The stream is 0.02 · 60/U wide, and U falls evenly, so that the mean of 1/width is that of U.
    close(belt.pressure.unwrap(), 3.0 * 0.5 * 35.0 / (0.02 * 60.0), 2e-3);
    close(load.places[4].pressure.unwrap(), 3.0 * 0.25 * 47.5 / (0.02 * 60.0), 2e-3);
    // The same drag all the way would be that at one rms; rms falls from 6 to 1 m/s.
    let k = |rms: f64| case.strand().drag.across.force(rms, 1.0) / rms / case.fibre.rest_length();
    let damping = load.damping.unwrap() / (5000.0 / (1.204 * 60.0 * 0.02) * 0.5 * 2.0);
    assert!(k(1.0) < damping && damping < k(6.0), "{damping}");
}

#[test]
fn without_a_slot_or_a_flight_only_what_is_known_is_reported() {
    let spunbond = case("spunbond.toml");
    let load = Load::new(&spunbond, 5000.0, None, &way(50, 0.5, |x| x), None).unwrap();
    assert!(load.mass_loading().is_none() && load.damping.is_none() && load.heat.is_none());
    let belt = load.at_belt().unwrap();
    assert!(belt.force > 0.0 && belt.share_of_momentum().is_none() && belt.pressure.is_none());
    let load = Load::new(&spunbond, 5000.0, Some(0.02), &[], None).unwrap();
    assert!(load.mass_loading().is_some() && load.places.is_empty() && load.damping.is_none());
    assert!(Load::new(&case("table1.toml"), 5000.0, Some(0.02), &[], None).is_none());
}

/// 230 °C to the end of the line: the integral of 2100 J/(kg K) + 3.35 J/(kg K²) times the temperature in °C.
#[test]
fn analytic_heat_of_polypropylene() {
    let case = case("whole_line.toml");
    let line = case.spinline.as_ref().unwrap();
    let end = Station { temperature: ZERO_CELSIUS + 40.0, ..Default::default() };
    let friction = case.drag.along;
    let mut spun = line.solve(friction).unwrap();
    spun.stations.push(end);
    let load = Load::new(&case, 5000.0, Some(0.02), &[], Some(&spun)).unwrap();
    let heat = load.heat.unwrap();
    let per_mass = 2100.0 * 190.0 + 0.5 * 3.35 * (230.0_f64.powi(2) - 40.0_f64.powi(2));
    close(heat.given, load.mass_flow * per_mass, 1e-9);
    close(heat.of_crystals.unwrap(), load.mass_flow * 165e3 * line.material.crystals.crystallinity, 1e-9);
    close(heat.warming.unwrap(), heat.given / load.air.unwrap().mass_flow / 1006.0, 1e-9);
}
