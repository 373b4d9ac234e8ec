//! All filaments of a beam, flown together: limits that hold exactly, and nothing that depends on the threads.

#[path = "../common/laying.rs"]
mod laying;

use laying::spunbond;
use spunlaid::beam::{Airs, Beam, Flown, Flying};
use spunlaid::case::Case;
use spunlaid::fibre::Place;
use spunlaid::lanes::Isa;
use spunlaid::web::uniformity::unevenness;
use spunlaid::web::{Edges, LaidWeb, Map, Sheet, Window};
use std::sync::atomic::{AtomicBool, AtomicU64};

const CELL: f64 = 1e-3;

/// A short line, so that little has to be flown.
fn case() -> Case {
    spunbond(&[("belt.distance", "0.1 m"), ("run.duration", "0.1 s"), ("run.spin_up", "10 ms")])
}

fn sheet(columns: usize, rows: usize) -> Sheet {
    let [width, length] = [columns, rows].map(|cells| cells as f64 * CELL);
    Sheet { width, length, cell: CELL, patches: Vec::new(), edges: Edges::Periodic }
}

/// Filaments at an even pitch over the width.
fn row(sheet: &Sheet, count: usize) -> Vec<Place> {
    let pitch = sheet.width / count as f64;
    (0..count).map(|i| Place { y: 0.0, z: (i as f64 + 0.5) * pitch }).collect()
}

fn lay_by(sheet: &Sheet, places: &[Place], airs: Airs, isa: Isa, threads: usize) -> (LaidWeb, Flown) {
    let (stop, steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let window = Window { corner: [10e-3, 20e-3], sides: [10e-3; 2] };
    let case = case();
    let beam = Beam { case: &case, places, airs };
    let laid = beam.lay(sheet, window, Flying { threads, isa, stop: &stop, steps: &steps }).unwrap();
    assert!(steps.into_inner() > 0);
    laid
}

fn lay(sheet: &Sheet, places: &[Place], airs: Airs) -> (LaidWeb, Flown) {
    lay_by(sheet, places, airs, Isa::detect(), 2)
}

fn cv(map: &Map, side: usize) -> f64 {
    unevenness(map, side).unwrap().cv
}

/// In an air that is the same for all, a row at even pitch has no variation across, only bars along the belt.
#[test]
fn analytic_filaments_in_the_same_air_lay_the_same_curve() {
    let sheet = sheet(24, 64);
    let (laid, _) = lay(&sheet, &row(&sheet, 24), Airs::Shared);
    let (mut different, mut bars) = (0.0_f64, 0.0_f64);
    let mean = laid.map.total() as f64 / laid.map.cells.len() as f64;
    for row in 0..laid.map.rows {
        let quanta = laid.map.row(row);
        for cell in quanta {
            different = different.max((f64::from(*cell) - f64::from(quanta[0])).abs() / mean);
            bars = bars.max((f64::from(*cell) / mean - 1.0).abs());
        }
    }
    // Places are off by a rounding, which moves some quanta of a million to the next cell.
    assert!(different < 1e-4, "{different}");
    assert!(bars > 0.1, "{bars}");
}

/// N filaments at one place in one air are N times one curve, with the unevenness of one.
#[test]
fn analytic_filaments_at_one_place_have_the_unevenness_of_one() {
    let sheet = sheet(32, 64);
    let place = Place { y: 0.0, z: 13.3e-3 };
    let maps = [1, 3, 11].map(|count| lay(&sheet, &vec![place; count], Airs::Shared).0.map);
    for side in [1, 4, 10] {
        let one = cv(&maps[0], side);
        assert!(one > 0.5, "{one}");
        for map in &maps {
            // The quanta are a millionth of an element, or up to eight times that.
            assert!((cv(map, side) / one - 1.0).abs() < 1e-5, "{side}: {} {one}", cv(map, side));
        }
    }
}

/// `CV² = [Σ var(m_k) + Σ cov(m_k, m_l)]/(Σ⟨m⟩)²` for any filaments, and without the covariances for filaments in airs of their own.
#[test]
fn stat_filaments_in_airs_of_their_own_are_independent() {
    let sheet = sheet(32, 2000);
    let places = row(&sheet, 16);
    let (together, flown) = lay(&sheet, &places, Airs::Own);
    assert_eq!((flown.kept.len(), flown.lost.len()), (16, 0));
    // Each curve by itself, on the same cells.
    let side = 8;
    let mean = together.map.total() as f64 / together.map.cells.len() as f64 * (side * side) as f64;
    let variance = (cv(&together.map, side) * mean).powi(2);
    let mut own = 0.0;
    for (number, points) in &flown.kept {
        own += variance_alone(points, places[*number], &sheet, &together.map, side);
    }
    // 2 m of belt are some two hundred correlation lengths, of filaments 16 of which overlap.
    assert!((variance / own - 1.0).abs() < 0.1, "{variance} {own}");
}

#[test]
fn invariant_the_mass_of_the_sheet_is_that_of_the_fed_fibre() {
    let sheet = sheet(32, 1000);
    let places = row(&sheet, 16);
    let (laid, _) = lay(&sheet, &places, Airs::Own);
    let case = case();
    let line = case.line.unwrap();
    let per_length = case.fibre.element_mass() / case.fibre.rest_length();
    let wanted = 16.0 * per_length * line.feed_speed / line.belt_speed / sheet.width;
    // The ends of the sheet cut the curves: of 1 m some millimetres for each of 16 filaments, either way.
    let found = laid.map.basis_weight();
    assert!((found / wanted - 1.0).abs() < 0.005, "{found} {wanted}");
    assert_eq!(laid.cut, 0.0);
}

#[test]
fn identical_on_any_threads_and_instruction_sets() {
    let sheet = sheet(24, 32);
    let places = row(&sheet, 12);
    let (one, flown) = lay_by(&sheet, &places, Airs::Own, Isa::detect(), 1);
    assert!(!flown.strands.is_empty());
    for (isa, threads) in Isa::available().into_iter().zip([2, 3, 1].into_iter().cycle()) {
        let (other, again) = lay_by(&sheet, &places, Airs::Own, isa, threads);
        assert_eq!(other.map, one.map, "{} on {threads} threads", isa.name());
        assert_eq!(again.strands, flown.strands, "{}", isa.name());
        assert_eq!(again.kept, flown.kept, "{}", isa.name());
    }
}
