//! Webs whose positions, weights and defects follow by hand.

#![allow(clippy::unwrap_used)]

use super::defects::{Depositor, LayerFilaments, Titres, sorted_holes};
use super::*;
use std::f64::consts::PI;

const SURROGATE: Surrogate = Surrogate { sigma_md: 9e-3, sigma_cd: 8e-3, noise: 15.0 };

/// A layer of 50 m/s on a belt of 4 m/s: 5 m of each filament on a sheet of 0.4 m.
pub(super) fn layer(filaments: Filaments) -> Layer {
    Layer {
        linear_density: 2e-7,
        feed_speed: 50.0,
        belt_speed: 4.0,
        filaments,
        defects: Vec::new(),
        fibres: Fibres::Surrogate(SURROGATE),
    }
}

/// 300 mm wide.
fn web(layers: Vec<Layer>) -> Web {
    Web { sheet: Sheet::new(0.3, 0.4, 1e-3), layers, seed: 5 }
}

fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1e-9), "{found} {expected}");
}

/// Two rows of ten holes, by turns across the web, 1 mm apart.
fn rows() -> Filaments {
    Filaments::Rows(vec![
        Row { md: -3e-3, ..Row::new(1e-3, 2e-3, 10) },
        Row { md: 5e-3, ..Row::new(2e-3, 2e-3, 10) },
    ])
}

#[test]
fn analytic_what_layers_of_a_web_weigh_and_where_they_are_fed() {
    let slot = |depth: f64| Filaments::Slot { per_metre: 1000.0, depth };
    let at_random = Filaments::AtRandom { per_metre: 3333.4 };
    for (filaments, count, slot, depths) in [
        (at_random.clone(), 1000, None, [0.0; 2]),
        (slot(10e-3), 300, Some(10e-3), [-5e-3, 5e-3]),
        (slot(0.0), 300, None, [0.0; 2]),
        (rows(), 20, None, [-3e-3, 5e-3]),
    ] {
        let web = web(vec![layer(filaments.clone())]);
        assert_eq!((filaments.count(&web.sheet), filaments.slot()), (count, slot));
        assert_eq!(filaments.depths(), depths);
        close(filaments.depth(), depths[1] - depths[0]);
        close(web.basis_weight(), 2e-7 * count as f64 * 5.0 / 0.12);
        close(web.fibre_length(), 5.0 * count as f64);
    }
    let both = web(vec![layer(at_random), layer(rows())]);
    close(both.basis_weight(), 2e-7 * 1020.0 * 5.0 / 0.12);
    close(both.fibre_length(), 5100.0);
}

/// On a third of the width lie a third of the filaments, a Poisson number, whose streaks are as wide as a filament
/// lies: `e^(−k²σ²)` of the wave k.
#[test]
fn analytic_streaks_of_filaments_at_random_positions() {
    let at_random = |per_metre: f64, linear_density: f64| Layer {
        linear_density,
        ..layer(Filaments::AtRandom { per_metre })
    };
    let wide = Fibres::Surrogate(Surrogate { sigma_cd: 20e-3, ..SURROGATE });
    let layers =
        vec![at_random(1000.0, 2e-7), layer(rows()), Layer { fibres: wide, ..at_random(500.0, 6e-7) }];
    // Masses of 300, 20 and 3 × 150 filaments.
    let each = [(300.0 / 770.0_f64).powi(2) / 100.0, (450.0 / 770.0_f64).powi(2) / 50.0];
    let Places::Known(streaks) = web(layers).places(0.1) else { panic!("unknown places") };
    close(streaks.variance_of_mean, each[0] + each[1]);
    let power = |number: usize| {
        let part = |sigma: f64| (-(2.0 * PI * number as f64 / 0.1 * sigma).powi(2)).exp();
        each[0] * part(8e-3) + each[1] * part(20e-3)
    };
    let count = (1..).take_while(|number| power(*number) > 1e-6 * streaks.variance_of_mean).count();
    assert_eq!(streaks.powers.len(), count);
    streaks.powers.iter().enumerate().for_each(|(i, found)| close(*found, power(i + 1)));
    assert!(streaks.has_rows);
    let even = Streaks { variance_of_mean: 0.0, powers: Vec::new(), has_rows: true };
    assert_eq!(web(vec![layer(rows())]).places(0.1), Places::Known(even));
}

/// Holes that have a defect at random make streaks of the power that filaments at random positions have, each with the
/// missing mass, over the square of what is left. Their number is in `variance_by_defects`.
#[test]
fn analytic_streaks_of_holes_with_a_defect_at_random() {
    let defect = Defect { share: 0.2, titre: 0.25, ..Defect::USUAL };
    let with = |filaments: Filaments| Layer { defects: vec![defect], ..layer(filaments) };
    let at_random = Filaments::AtRandom { per_metre: 500.0 };
    for (layer, by_number) in [(with(rows()), 0.0), (with(at_random), 1.0 / 150.0)] {
        let count = layer.count(&web(Vec::new()).sheet) as f64;
        let by_defects = 0.2 * 0.8 * 0.75 * 0.75 / count;
        // On a third of the width a third of the holes, with three times the variance.
        let [whole, third] = [0.3, 0.1].map(|width| web(vec![layer.clone()]).streaks(width));
        let expected = by_number + by_defects / 0.85_f64.powi(2);
        for (streaks, width, times) in [(whole, 0.3, 1.0), (third, 0.1, 3.0)] {
            close(streaks.variance_of_mean, times * by_number);
            let width_of_one = (-(2.0 * PI / width * 8e-3_f64).powi(2)).exp();
            close(streaks.powers[0], times * expected * width_of_one);
            assert_eq!(streaks.has_rows, by_number == 0.0);
        }
    }
    let at_random = web(vec![with(Filaments::AtRandom { per_metre: 500.0 })]);
    let Places::Known(in_one_air) = at_random.places_in_one_air(0.3) else { panic!("unknown places") };
    assert!(in_one_air.has_rows && in_one_air.variance_of_mean == 0.0);
    assert_eq!(in_one_air.powers, at_random.streaks(0.3).powers);
}

/// Of holes with a defect at random the number is binomial, each with its missing mass. So is, of filaments at random
/// positions, the number of those that lie where the defect is.
#[test]
fn analytic_the_mean_weight_varies_with_the_holes_that_have_a_defect() {
    let defect = Defect { share: 0.2, titre: 0.25, ..Defect::USUAL };
    let of = |filaments: Filaments, defect: Defect| Layer { defects: vec![defect], ..layer(filaments) };
    let at_random = Filaments::AtRandom { per_metre: 500.0 };
    let alone = |layer: Layer| web(vec![layer]).variance_by_defects();
    // Over the square of what is left of the weight.
    let of_holes = |holes: f64, of: f64, part: f64, missing: f64| {
        holes * part * (1.0 - part) * (missing / of / (1.0 - holes / of * part * missing)).powi(2)
    };
    close(alone(of(rows(), defect)), of_holes(20.0, 20.0, 0.2, 0.75));
    close(alone(of(rows(), Defect { row: Some(2), ..defect })), of_holes(10.0, 20.0, 0.2, 0.75));
    // After 25 ms it is so on the first 300 of 400 mm; after 0.2 s on none.
    close(alone(of(rows(), Defect { after: 0.025, ..defect })), of_holes(20.0, 20.0, 0.2, 0.75 * 0.75));
    close(alone(of(rows(), Defect { after: 0.2, ..defect })), 0.0);
    // One hole, or all of some, are the same in each web.
    close(alone(of(rows(), Defect { from: Some(3e-3), share: 1.0, ..defect })), 0.0);
    close(alone(of(at_random.clone(), Defect { from: Some(3e-3), share: 1.0, ..defect })), 0.0);
    let of_half = Defect { from: Some(0.0), to: Some(0.15), share: 1.0, ..defect };
    close(alone(of(rows(), of_half)), 0.0);
    let inlets = inlets(&web(Vec::new()).sheet, 5, 0, &at_random);
    let part = inlets.iter().filter(|inlet| inlet.z <= 0.15).count() as f64 / 150.0;
    assert!((0.3..0.7).contains(&part));
    close(alone(of(at_random.clone(), of_half)), of_holes(150.0, 150.0, part, 0.75));
    // Layers add up, by the squares of their fractions of the mass, and so do defects.
    let both = web(vec![of(rows(), defect), layer(at_random)]).variance_by_defects();
    close(both, 20.0 * 0.2 * 0.8 * (0.75_f64 / (170.0 - 20.0 * 0.2 * 0.75)).powi(2));
    let twice = Layer { defects: vec![defect; 2], ..layer(rows()) };
    // Titres of holes with both defects multiply: their means are 0.85, and their mean squares 0.8125.
    close(alone(twice), (0.8125_f64.powi(2) - 0.85_f64.powi(4)) / 20.0 / 0.85_f64.powi(4));
    // A row is dead, and half of all holes are blocked.
    let dead = Defect { row: Some(2), ..Defect::USUAL };
    let blocked = Defect { share: 0.5, ..Defect::USUAL };
    let left = web(vec![Layer { defects: vec![dead, blocked], ..layer(rows()) }]);
    close(left.weight_of(&left.with_defects()) / left.basis_weight(), 0.25);
    close(left.variance_by_defects(), 10.0 * 0.25 / (20.0 * 0.25_f64).powi(2));
    // Nothing is left.
    let none = web(vec![Layer { defects: vec![Defect::USUAL], ..layer(rows()) }]);
    assert_eq!((none.variance_by_defects(), none.streaks(0.3).powers.len()), (0.0, 0));
}

#[test]
fn analytic_holes_that_a_defect_names() {
    let sheet = web(Vec::new()).sheet;
    let (filaments, mut defect) = (rows(), Defect::USUAL);
    let layer = LayerFilaments { sheet: &sheet, seed: 5, number: 1, filaments: &filaments };
    let numbers =
        |defect: &Defect| -> Vec<usize> { holes(layer, 0, defect).iter().map(|hole| hole.0).collect() };
    assert_eq!(numbers(&defect), (0..20).collect::<Vec<_>>());
    holes(layer, 0, &defect).iter().for_each(|(number, at)| close(*at, 1e-3 * (number + 1) as f64));
    let of_rows: Vec<_> =
        sorted_holes(&sheet, 5, 1, &filaments).iter().map(|hole| (hole.row, hole.at[1])).collect();
    assert_eq!(of_rows, [(1, -3e-3), (2, 5e-3)].repeat(10));
    for (row, from, to, expected) in [
        (Some(2), None, None, (0..10).map(|i| 2 * i + 1).collect()),
        (None, Some(3.2e-3), None, vec![2]),
        (Some(2), Some(3.2e-3), None, vec![3]),
        (None, Some(2.9e-3), Some(5.1e-3), vec![2, 3, 4]),
        (Some(1), None, Some(4.1e-3), vec![0, 2]),
        (Some(3), None, None, vec![]),
    ] {
        (defect.row, defect.from, defect.to) = (row, from, to);
        assert_eq!(numbers(&defect), expected, "{defect:?}");
    }
    // Defects of a hole multiply, each as far as it reaches along the sheet: the second one up to 280 mm.
    let defects = [
        Defect { from: Some(3e-3), titre: 0.5, ..Defect::USUAL },
        Defect { from: Some(3e-3), titre: 0.3, after: 0.03, ..Defect::USUAL },
    ];
    let titres = Titres::new(layer, &defects, 4.0);
    let titre = titres.of(2).unwrap();
    close(titre.at(0.2799), 0.15);
    close(titre.at(0.2801), 0.5);
    assert_eq!(titres.of(3), None);
    let canvas = DepositionGrid::new(&sheet, &[1e-9], 1e-3).unwrap();
    let depositor = Depositor::new(&canvas, 1e-9, titres.clone());
    let whole = canvas.quanta(1e-9);
    assert_eq!(depositor.quanta_at(None, 0.1), (whole, 1.0));
    assert_eq!(depositor.quanta_at(Some(titre), 0.35), (whole / 2, 0.5));
}

/// Holes that have a defect, positions and depths are drawn apart for each seed, layer and defect.
#[test]
fn stat_holes_positions_and_depths_at_random() {
    const COUNT: f64 = 3000.0;
    let sheet = web(Vec::new()).sheet;
    let [at_random, slot] =
        [Filaments::AtRandom { per_metre: 10_000.0 }, Filaments::Slot { per_metre: 10_000.0, depth: 20e-3 }];
    let defect = Defect { share: 0.3, ..Defect::USUAL };
    let with_defect = |seed: u64, number: usize, of: usize| {
        let layer = LayerFilaments { sheet: &sheet, seed, number, filaments: &slot };
        let numbers: Vec<f64> = holes(layer, of, &defect).iter().map(|hole| hole.0 as f64 / COUNT).collect();
        numbers
    };
    let inlets = |seed: u64, number: usize, filaments: &Filaments| inlets(&sheet, seed, number, filaments);
    let across =
        |seed, number| inlets(seed, number, &at_random).iter().map(|of| of.z / 0.3).collect::<Vec<f64>>();
    let depths =
        |seed, number| inlets(seed, number, &slot).iter().map(|of| of.y / 20e-3 + 0.5).collect::<Vec<f64>>();
    // Numbers evenly between 0 and 1: 4.5 standard errors of their mean, and of their mean square.
    let are_even = |numbers: &[f64]| {
        let (count, mean) = (numbers.len() as f64, |of: &dyn Fn(f64) -> f64| {
            numbers.iter().map(|number| of(*number)).sum::<f64>() / numbers.len() as f64
        });
        numbers.iter().all(|number| (0.0..1.0).contains(number))
            && (mean(&|x| x) - 0.5).abs() < 4.5 / (12.0 * count).sqrt()
            && (mean(&|x| x * x) - 1.0 / 3.0).abs() < 4.5 * (4.0 / 45.0 / count).sqrt()
    };
    let all = [(1, 0), (1, 1), (2, 0)];
    let sets: Vec<Vec<f64>> =
        all.iter().flat_map(|(seed, number)| [across(*seed, *number), depths(*seed, *number)]).collect();
    let chosen = [with_defect(1, 0, 0), with_defect(1, 1, 0), with_defect(2, 0, 0), with_defect(1, 0, 1)];
    for numbers in sets.iter().chain(&chosen) {
        assert!(are_even(numbers));
    }
    for numbers in &chosen {
        assert!(
            (numbers.len() as f64 / COUNT - 0.3).abs() < 4.5 * (0.21 / COUNT).sqrt(),
            "{}",
            numbers.len()
        );
    }
    assert!(sets[0].is_sorted());
    for sets in [&sets[..], &chosen] {
        // No set is another one.
        assert!(sets.iter().enumerate().all(|(i, set)| sets[..i].iter().all(|other| other != set)));
    }
    for (i, inlet) in inlets(1, 0, &slot).iter().enumerate() {
        close(inlet.z, (i as f64 + 0.5) * 0.3 / COUNT);
    }
}
