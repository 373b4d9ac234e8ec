//! All filaments of a beam, simulated together: limits that hold exactly, and nothing that depends on the threads.

use spunlaid_air::Lateral;
use spunlaid_fibre::Case;
use spunlaid_ground::place::Inlet;
use spunlaid_ground::{Error, Isa, RunContext};
use spunlaid_input::read_case;
use spunlaid_simulation::{Beam, BeamFindings};
use spunlaid_web::map::uniformity::patch_cv;
use spunlaid_web::{LaidWeb, Map, Sheet, Window};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64};

const CELL: f64 = 1e-3;

/// A short line, so that little has to be simulated.
fn case() -> Case {
    case_in("uniform")
}

/// The same in air whose turbulence is the same across the flow or not.
pub(super) fn case_in(lateral: &str) -> Case {
    let set = [
        ("belt.distance", "0.1 m"),
        ("run.duration", "0.1 s"),
        ("run.spin_up", "10 ms"),
        ("air.lateral", lateral),
    ];
    let set = set.map(|(key, value)| (key.to_owned(), value.to_owned()));
    read_case(Path::new("../../cases/spunbond.toml"), &set).unwrap().0
}

pub(super) fn sheet(columns: usize, rows: usize) -> Sheet {
    let [width, length] = [columns, rows].map(|cells| cells as f64 * CELL);
    Sheet::new(width, length, CELL)
}

/// Filaments at an even pitch over the width.
pub(super) fn row(sheet: &Sheet, count: usize) -> Vec<Inlet> {
    let pitch = sheet.width / count as f64;
    (0..count).map(|i| Inlet { y: 0.0, z: (i as f64 + 0.5) * pitch }).collect()
}

pub(super) fn lay_by(
    case: &Case,
    sheet: &Sheet,
    places: &[Inlet],
    isa: Isa,
    threads: usize,
) -> (LaidWeb, BeamFindings) {
    let (stop, steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let window = Window { corner: [10e-3, 20e-3], sides: [10e-3; 2] };
    let beam = Beam::new(case, places);
    let laid = beam.lay(sheet, window, RunContext { threads, isa, stop: &stop, done: &steps }).unwrap();
    assert!(steps.into_inner() > 0);
    laid
}

fn lay(sheet: &Sheet, places: &[Inlet]) -> (LaidWeb, BeamFindings) {
    lay_by(&case(), sheet, places, Isa::detect(), 2)
}

pub(super) fn cv(map: &Map, side: usize) -> f64 {
    patch_cv(map, side).unwrap().cv
}

/// In an air that is the same for all, a row at even pitch has no variation across, only bars along the belt.
#[test]
fn analytic_filaments_in_the_same_air_lay_the_same_curve() {
    // Places are off by a rounding, which moves some quanta of a million to the next cell.
    rows_lay_bars(&case(), 1e-4);
}

/// So is a field of eddies without a wave that fits across.
#[test]
fn limit_filaments_in_a_field_without_waves_across_lay_the_same_curve() {
    let set = [("run.duration", "0.1 s"), ("run.spin_up", "40 ms"), ("air.lateral", "von-karman")];
    let set = set.map(|(key, value)| (key.to_owned(), value.to_owned()));
    let (mut case, _) = read_case(Path::new("../../cases/spunbond.toml"), &set).unwrap();
    case.air.lateral = Lateral::VonKarman { cutoff: 1e-3 };
    // The field is interpolated in single precision. On the way of half a metre this moves a filament by less
    // than a micrometre; on a short one, where fast air lays it, the folds make more of it.
    rows_lay_bars(&case, 0.02);
}

/// * `most` – that cells beside each other may differ by, over the mean
fn rows_lay_bars(case: &Case, most: f64) {
    let sheet = sheet(24, 64);
    let (laid, _) = lay_by(case, &sheet, &row(&sheet, 24), Isa::detect(), 2);
    let (mut different, mut bars) = (0.0_f64, 0.0_f64);
    let mean = laid.map.total() as f64 / laid.map.cells.len() as f64;
    for row in 0..laid.map.rows {
        let quanta = laid.map.row(row);
        for cell in quanta {
            different = different.max((f64::from(*cell) - f64::from(quanta[0])).abs() / mean);
            bars = bars.max((f64::from(*cell) / mean - 1.0).abs());
        }
    }
    assert!(different < most, "{different}");
    assert!(bars > 0.1, "{bars}");
}

/// N filaments at one place in one air are N times one curve, with the CV of one.
#[test]
fn analytic_filaments_at_one_place_have_the_unevenness_of_one() {
    let sheet = sheet(32, 64);
    let place = Inlet { y: 0.0, z: 13.3e-3 };
    let maps = [1, 3, 11].map(|count| lay(&sheet, &vec![place; count]).0.map);
    for side in [1, 4, 10] {
        let one = cv(&maps[0], side);
        assert!(one > 0.5, "{one}");
        for map in &maps {
            // The quanta are a millionth of an element, or up to eight times that.
            assert!((cv(map, side) / one - 1.0).abs() < 1e-5, "{side}: {} {one}", cv(map, side));
        }
    }
}

#[test]
fn invariant_the_mass_of_the_sheet_is_that_of_the_fed_fibre() {
    let sheet = sheet(32, 1000);
    let places = row(&sheet, 16);
    let (laid, _) = lay(&sheet, &places);
    let case = case();
    let line = case.line.unwrap();
    let per_length = case.fibre.element_mass() / case.fibre.rest_length();
    let wanted = 16.0 * per_length * line.feed_speed / line.belt_speed / sheet.width;
    // The ends of the sheet cut the curves: of 1 m some millimetres for each of 16 filaments, either way.
    let found = laid.map.basis_weight();
    assert!((found / wanted - 1.0).abs() < 0.005, "{found} {wanted}");
    assert_eq!(laid.cut, 0.0);
}

/// Filaments in a slot, in a field of eddies.
fn slot(sheet: &Sheet, count: usize) -> Vec<Inlet> {
    row(sheet, count).iter().enumerate().map(|(i, at)| Inlet { y: (i % 5) as f64 * 3e-3, ..*at }).collect()
}

#[test]
fn identical_on_any_threads_and_instruction_sets() {
    let sheet = sheet(24, 32);
    for lateral in ["uniform", "von-karman"] {
        let (case, places) = (case_in(lateral), slot(&sheet, 12));
        let lay = |isa, threads| lay_by(&case, &sheet, &places, isa, threads);
        let (one, simulated) = lay(Isa::detect(), 1);
        let strands = |laid: &LaidWeb| laid.simulated[0].strands.clone();
        assert!(!strands(&one).is_empty());
        for (isa, threads) in Isa::available().into_iter().zip([2, 3, 1].into_iter().cycle()) {
            let (other, again) = lay(isa, threads);
            assert_eq!(other.map, one.map, "{lateral}: {} on {threads} threads", isa.name());
            assert_eq!(strands(&other), strands(&one), "{lateral}: {}", isa.name());
            assert_eq!(again.kept, simulated.kept, "{lateral}: {}", isa.name());
        }
    }
}

/// The curves of filaments in one field: what they lay does not depend on which of them share a flight.
#[test]
fn identical_a_filament_whatever_flies_beside_it() {
    let sheet = sheet(24, 32);
    let (case, places) = (case_in("von-karman"), slot(&sheet, 12));
    let lay = |places: &[Inlet]| lay_by(&case, &sheet, places, Isa::detect(), 2).1.kept;
    let (all, some) = (lay(&places), lay(&places[2..7]));
    for (number, points) in &some {
        let beside = &all.iter().find(|(other, _)| *other == number + 2).unwrap().1;
        let both = points.len().min(beside.len());
        assert!(both > 100);
        assert_eq!(points[..both], beside[..both], "{number}");
    }
}

/// Neighbours in one field come down together: N of them at one place are one curve N times, at places far
/// apart they are independent, and between the two the web is in between.
#[test]
fn stat_a_row_in_one_field_lies_between_one_curve_and_independent_ones() {
    let (sheet, case) = (sheet(64, 400), case_in("von-karman"));
    let patch_cv = |places: &[Inlet]| cv(&lay_by(&case, &sheet, places, Isa::detect(), 2).0.map, 10);
    let place = Inlet { y: 0.0, z: 30e-3 };
    let (one, three) = (patch_cv(&[place]), patch_cv(&[place; 3]));
    assert!((three / one - 1.0).abs() < 1e-5, "{three} {one}");
    // The variances of independent ones add up, and at an even pitch even less is left.
    let (row, independent) = (patch_cv(&row(&sheet, 64)), one / 8.0);
    assert!(row > 1.1 * independent, "{row} {independent}");
    assert!(row < 0.5 * one, "{row} {one}");
}

/// Filaments that do not reach the belt are lost, and without them there is no web. What cannot be simulated says so.
#[test]
fn rejects_a_beam_that_loses_its_filaments() {
    let sheet = sheet(24, 32);
    let mut case = case();
    // Air of half a metre in a second does not carry the fibre that is fed to the belt.
    case.air.speed_factor = 0.01;
    let stop = AtomicBool::new(false);
    let steps = AtomicU64::new(0);
    let places = slot(&sheet, 12);
    let window = Window { corner: [10e-3, 20e-3], sides: [10e-3; 2] };
    let beam = Beam::new(&case, &places);
    let by = RunContext { threads: 2, isa: Isa::detect(), stop: &stop, done: &steps };
    let said = beam.lay(&sheet, window, by).unwrap_err().to_string();
    assert!(said.contains("of 12 filaments were lost"), "{said}");

    let fixed = Case { line: None, ..case.clone() };
    let beam = Beam { case: &fixed, ..beam };
    assert!(beam.lay(&sheet, window, by).unwrap_err().to_string().contains("moving belt"));
    stop.store(true, std::sync::atomic::Ordering::Relaxed);
    let case = case_in("uniform");
    let beam = Beam { case: &case, ..beam };
    assert!(matches!(beam.lay(&sheet, window, by), Err(Error::Interrupted)));
}
