//! Filaments that are filled in between simulated ones, against the same filaments as they are simulated.

use super::one_air::{case_in, cv, lay_by, row, sheet as sheet_of};
use spunlaid_ground::{Isa, Workers};
use spunlaid_web::curtain::lay;
use spunlaid_web::{Belt, Curtain, FlownCurves, Map, Window};
use std::sync::atomic::AtomicBool;

/// Correlation of the basis weights of two maps, in cells of a size.
fn correlation(maps: [&Map; 2], cell: f64) -> f64 {
    let [a, b] = maps.map(|map| {
        let map = map.in_cells(cell);
        let cells: Vec<f64> = map.cells.iter().map(|quanta| f64::from(*quanta)).collect();
        let mean = cells.iter().sum::<f64>() / cells.len() as f64;
        cells.into_iter().map(|cell| cell - mean).collect::<Vec<f64>>()
    });
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    product(&a, &b) / (product(&a, &a) * product(&b, &b)).sqrt()
}

/// Every second filament of a row gives where the others lie. On so short a way each does a part for itself, in folds.
#[test]
fn stat_filaments_between_flown_ones_lie_as_they_are_flown() {
    let (case, sheet) = (case_in("von-karman"), sheet_of(32, 64));
    let places = row(&sheet, 64);
    let (_, simulated) = lay_by(&case, &sheet, &places, Isa::detect(), 2);
    let line = case.line.unwrap();
    let start = line.feed_speed * case.run.spin_up();
    let curves = simulated.kept.iter().map(|(_, points)| {
        let points = points.iter().filter(|point| point.fed >= start);
        points.map(|point| [point.md + line.belt_ratio() * point.fed, point.cd]).collect()
    });
    let curves: Vec<Vec<[f64; 2]>> = curves.collect();
    let spacing = case.fibre.rest_length();
    let all = FlownCurves::new(places, Some(sheet.width), spacing, line.belt_ratio(), &curves).unwrap();
    let few = all.every_second().unwrap();
    assert_eq!(few.places().len(), 32);
    let filling = few.fill(all.places().to_vec(), 2);
    assert!(filling.missing().iter().all(|missing| (0.0..0.1).contains(missing)), "{:?}", filling.missing());
    let window = Window { corner: [10e-3, 20e-3], sides: [10e-3; 2] };
    // The start of the curves is left out, and so the sheet is a little shorter than that of the beam.
    let shorter = sheet_of(32, 56);
    let belt = Belt::within(&all, &shorter, window).unwrap();
    let laid = |curtain: &dyn Curtain| {
        let workers = Workers { threads: 2, stop: &AtomicBool::new(false) };
        lay(curtain, belt, case.fibre.element_mass(), workers).unwrap()
    };
    let [(simulated, strands), (filled, filled_strands)] = [laid(&all), laid(&filling)];
    let maps = [&simulated.map, &filled.map];
    let alike = [2e-3, 8e-3].map(|cell| correlation(maps, cell));
    assert!(alike[0] > 0.93 && alike[1] > 0.985, "{alike:?}");
    for (side, most) in [(5, 0.06), (10, 0.05)] {
        let change = cv(&filled.map, side) / cv(&simulated.map, side) - 1.0;
        assert!(change.abs() < most, "{side}: {change}");
    }
    assert!(!strands.is_empty() && filled_strands.len() > strands.len() / 2);
}
