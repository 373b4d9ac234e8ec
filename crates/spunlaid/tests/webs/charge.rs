//! Charged filaments of a web in shared turbulence: nothing without charge, and the square of the charge with it.

use super::one_air::{case_in, sheet};
use spunlaid_fibre::{Case, Charge};
use spunlaid_ground::place::Inlet;
use spunlaid_ground::{Isa, RunContext};
use spunlaid_input::read_case;
use spunlaid_simulation::{Beam, BeamCharge, BeamFindings};
use spunlaid_web::{LaidWeb, Window};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64};

const COLUMNS: usize = 24;

/// Filaments in a slot 20 mm deep, half of them behind its middle and as many before it.
fn slot(count: usize) -> Vec<Inlet> {
    let place = |i: usize| {
        let turn = (i / 2) as f64 * 0.618_033_988_749_894_9;
        let side = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        Inlet { y: side * 10e-3 * turn.fract(), z: (i as f64 + 0.5) * 1e-3 * COLUMNS as f64 / count as f64 }
    };
    (0..count).map(place).collect()
}

fn charge(per_mass: f64, places: &[Inlet]) -> BeamCharge {
    let charge = Charge { per_mass, walls: None };
    BeamCharge { charge, per_metre: 5000.0, weights: vec![1; places.len()] }
}

fn lay(
    case: &Case,
    places: &[Inlet],
    charge: Option<&BeamCharge>,
    isa: Isa,
    threads: usize,
) -> (LaidWeb, BeamFindings) {
    let (stop, steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let window = Window { corner: [5e-3, 5e-3], sides: [10e-3; 2] };
    let beam = Beam { charge, ..Beam::new(case, places) };
    beam.lay(&sheet(COLUMNS, 32), window, RunContext { threads, isa, stop: &stop, done: &steps }).unwrap()
}

#[test]
fn identical_without_charge_and_with_none_of_it() {
    let (case, places) = (case_in("von-karman"), slot(12));
    let isa = Isa::detect();
    let (plain, of_plain) = lay(&case, &places, None, isa, 2);
    let (none, of_none) = lay(&case, &places, Some(&charge(0.0, &places)), isa, 2);
    assert_eq!(plain.map.cells, none.map.cells);
    assert_eq!(of_plain.kept, of_none.kept);
    assert!(plain.simulated[0].charged.is_none() && none.simulated[0].charged.is_none());
    let (charged, of_charged) = lay(&case, &places, Some(&charge(2e-3, &places)), isa, 2);
    assert_ne!(plain.map.cells, charged.map.cells);
    assert_ne!(of_plain.kept, of_charged.kept);
}

#[test]
fn identical_charged_webs_for_any_number_of_threads_and_any_registers() {
    let (case, places) = (case_in("von-karman"), slot(12));
    let charge = charge(3e-3, &places);
    let (one, of_one) = lay(&case, &places, Some(&charge), Isa::detect(), 1);
    for (isa, threads) in Isa::available().into_iter().map(|isa| (isa, 2)) {
        let (other, of_other) = lay(&case, &places, Some(&charge), isa, threads);
        assert_eq!(one.map.cells, other.map.cells, "{isa:?}");
        assert_eq!(of_one.kept, of_other.kept, "{isa:?}");
        assert_eq!(one.simulated[0].charged, other.simulated[0].charged, "{isa:?}");
    }
}

/// A short way through calm air.
fn calm() -> Case {
    let set = [("belt.distance", "0.1 m"), ("run.duration", "0.1 s"), ("run.spin_up", "10 ms")];
    let set = set.iter().chain(&[("air.intensity_factor", "0")]);
    let set: Vec<_> = set.map(|(key, value)| (key.to_string(), value.to_string())).collect();
    read_case(Path::new("../../cases/spunbond.toml"), &set).unwrap().0
}

/// The sign of the charge does not matter, and by what it moves filaments aside goes with its square. A few
/// filaments that stand for many do the same to each other as these.
#[test]
fn analytic_the_curtain_opens_with_the_square_of_the_charge() {
    let case = calm();
    let opened = |per_mass: f64, count: usize| {
        let places = slot(count);
        let charge = charge(per_mass, &places);
        let (_, simulated) = lay(&case, &places, Some(&charge), Isa::detect(), 2);
        let belt = case.line.unwrap().belt_speed;
        let of_filament = |(filament, points): &(usize, Vec<spunlaid_fibre::LaidPoint>)| {
            let points: Vec<f64> = points.iter().map(|point| point.md + belt * point.time).collect();
            let mean = points.iter().sum::<f64>() / points.len() as f64;
            mean * places[*filament].y.signum()
        };
        simulated.kept.iter().map(of_filament).sum::<f64>() / simulated.kept.len() as f64
    };
    let none = opened(0.0, 32);
    let [once, twice, minus, few] = [(6e-3, 32), (12e-3, 32), (-6e-3, 32), (12e-3, 16)]
        .map(|(charge, count)| opened(charge, count) - none);
    assert!(once > 1e-3, "{none} {once} {twice}");
    assert!((twice / once / 4.0 - 1.0).abs() < 0.1, "{none} {once} {twice}");
    assert_eq!(once, minus);
    assert!((few / twice - 1.0).abs() < 0.1, "{few} {twice}");
}

/// Charged beams advance by blocks of 16 steps, fewer than there are from one look at the momentum to the next.
#[test]
fn limit_a_charge_of_next_to_nothing_keeps_the_load_on_the_air() {
    let (case, places) = (case_in("uniform"), slot(6));
    let way = |charge| lay(&case, &places, charge, Isa::detect(), 2).1.way;
    let (plain, charged) = (way(None), way(Some(&charge(1e-12, &places))));
    assert!(plain.len() > 10 && plain.len() == charged.len(), "{} {}", plain.len(), charged.len());
    for (plain, charged) in plain.iter().zip(&charged) {
        // The flight of charged ones ends at another step, so one has some looks more.
        let error = plain.standard_error.unwrap().hypot(charged.standard_error.unwrap());
        assert!((plain.force - charged.force).abs() < 2.0 * error, "{plain:?} {charged:?}");
    }
}

/// The load is known however many steps an element takes, also where it takes more than are simulated at a time.
#[test]
fn limit_the_load_on_the_air_does_not_depend_on_the_steps_of_an_element() {
    let (case, places) = (case_in("uniform"), slot(3));
    let [coarse, fine] = [20.0, 260.0].map(|steps| {
        let mut case = case.clone();
        case.set_time_step(case.run.time_step * case.line.unwrap().steps_per_element as f64 / steps);
        assert_eq!(case.line.unwrap().steps_per_element as f64, steps);
        lay(&case, &places, None, Isa::detect(), 2).1.way.last().unwrap().force
    });
    assert!((fine / coarse - 1.0).abs() < 0.2, "{fine} {coarse}");
}
