//! Streaks of scans: webs of known numbers with a blocked hole, with a thick pack, and without any defect.

use crate::scans::{exposed, lens, light, npy_f64, png16, spotted};
use spunlaid_ground::{Isa, RunContext};
use spunlaid_web::map::{Filaments, lay};
use spunlaid_web::scan::{StreakSearch, analyse, parse};
use spunlaid_web::{Defect, Fibres, Layer, Light, Map, Row, Settings, Sheet, Surrogate, Web};
use std::f64::consts::PI;
use std::sync::atomic::{AtomicBool, AtomicU64};

const SIGMA: f64 = 5e-3;
const PER_METRE: f64 = 400.0;

/// A web of 0.4 m by 1.2 m whose holes stand in one row, 2.5 mm apart.
fn web(defects: &[Defect], seed: u64) -> Map {
    let surrogate = Surrogate { sigma_md: SIGMA, sigma_cd: SIGMA, noise: 1.68 / SIGMA.sqrt() };
    let layer = Layer {
        linear_density: 3e-6,
        feed_speed: 50.0,
        belt_speed: 3.0,
        filaments: Filaments::Rows(vec![Row::new(0.0, 1.0 / PER_METRE, 160)]),
        defects: defects.to_vec(),
        fibres: Fibres::Surrogate(surrogate),
    };
    let web = Web { sheet: Sheet::new(0.4, 1.2, 1e-3), layers: vec![layer], seed };
    let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
    lay(&web, RunContext { threads: 2, isa: Isa::detect(), stop: &stop, done: &done }).unwrap().map
}

/// The streaks of its map of basis weight.
fn searched(map: &Map) -> StreakSearch {
    let values: Vec<f64> = map.cells.iter().map(|cell| f64::from(*cell)).collect();
    let picture = parse(&npy_f64(map.columns, &values), "map.npy", map.cell).unwrap();
    let light = Light::Weight { mean: Some(20e-3) };
    analyse(&picture, &Settings::new(light)).unwrap().streaks.unwrap()
}

#[test]
fn analytic_a_blocked_hole_leaves_the_dip_of_one_filament() {
    let found = searched(&web(&[Defect { from: Some(0.15), ..Defect::USUAL }], 1));
    let dip = 1.0 / (PER_METRE * (2.0 * PI).sqrt() * SIGMA);
    let [streak] = found.streaks[..] else { panic!("{:?}", found.streaks) };
    assert!((streak.place - 0.15).abs() < 4e-3, "{streak:?}");
    assert!((streak.amplitude + dip).abs() < 3.0 * streak.standard_error, "{dip} {streak:?}");
    assert!((streak.sigma_range[0]..streak.sigma_range[1]).contains(&SIGMA), "{streak:?}");
    assert!(found.periods.is_empty() && streak.chance < 0.01);
}

#[test]
fn analytic_a_pack_that_is_a_tenth_thicker_is_a_wide_streak() {
    let pack = Defect { from: Some(0.2), to: Some(0.24), titre: 1.1, ..Defect::USUAL };
    let found = searched(&web(&[pack], 2));
    let streak = found.streaks.first().unwrap();
    assert!((streak.place - 0.22).abs() < 8e-3, "{streak:?}");
    assert!((streak.amplitude - 0.1).abs() < 3.0 * streak.standard_error, "{streak:?}");
    assert!(streak.sigma > 1.4 * SIGMA, "{streak:?}");
}

/// Neither the web itself nor a lamp that is taken out by an assumed shading is a streak.
#[test]
fn a_web_without_defects_has_no_streak_whatever_the_lamp() {
    let map = web(&[], 3);
    let found = searched(&map);
    assert!(found.streaks.is_empty() && found.periods.is_empty(), "{:?} {:?}", found.streaks, found.periods);
    for lamp in [lens as fn(f64, f64) -> f64, spotted] {
        let levels = exposed([map.columns, map.rows], &light(&map), lamp, 65_535.0, 7);
        let picture = parse(&png16(map.columns, &levels), "scan.png", map.cell).unwrap();
        let light = Light::Transmitted { mean: None, white: None };
        let found = analyse(&picture, &Settings::new(light)).unwrap().streaks.unwrap();
        assert!(found.streaks.is_empty() && found.periods.is_empty(), "{:?}", found.streaks);
    }
}
