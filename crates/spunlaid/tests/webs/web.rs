//! The web: nothing is lost, and its CV is that of the laws.

use proptest::prelude::*;
use spunlaid_ground::{Isa, RunContext};
use spunlaid_web::map::uniformity::patch_cv;
use spunlaid_web::map::{Filaments, find, lay, one_fibre, orientation, pieces, straight_fibres, strands};
use spunlaid_web::{
    Edges, Fibres, LaidWeb, Layer, Map, OneFibre, Row, Sheet, Surrogate, Web, Window, WindowCurve,
};
use std::f64::consts::PI;
use std::sync::atomic::{AtomicBool, AtomicU64};

const SPUNBOND: Surrogate = Surrogate { sigma_md: 18.4e-3, sigma_cd: 18.3e-3, noise: 12.4 };
/// 18 µm at 910 kg/m³ [kg/m].
const LINEAR_DENSITY: f64 = 910.0 * PI * 18e-6 * 18e-6 / 4.0;

fn layer(fibres: Fibres, per_metre: f64) -> Layer {
    let filaments = Filaments::AtRandom { per_metre };
    Layer {
        linear_density: LINEAR_DENSITY,
        feed_speed: 50.0,
        belt_speed: 3.0,
        filaments,
        fibres,
        defects: Vec::new(),
    }
}

fn laid_by(web: &Web, isa: Isa, threads: usize) -> LaidWeb {
    let (stop, laid) = (AtomicBool::new(false), AtomicU64::new(0));
    lay(web, RunContext { threads, isa, stop: &stop, done: &laid }).expect("a web that can be laid")
}

fn laid(web: &Web) -> LaidWeb {
    laid_by(web, Isa::detect(), 2)
}

fn close(found: f64, wanted: f64, relative: f64) {
    assert!((found / wanted - 1.0).abs() <= relative, "{found} where {wanted} is wanted");
}

/// Fibres that are straight over a patch: they turn by some degrees in a metre, and come back hardly ever.
#[test]
fn straight_fibres_at_random_have_the_unevenness_of_the_law() {
    let fibres = Fibres::Surrogate(Surrogate { sigma_md: 1.0, sigma_cd: 1.0, noise: 0.1 });
    let straight = Layer { feed_speed: 1.0, belt_speed: 0.1, ..layer(fibres, 4000.0) };
    let web = Web { sheet: Sheet::new(1.0, 1.0, 1e-3), layers: vec![straight], seed: 7 };
    let thrown = web.at_random([400, 600], 1e-3).expect("a piece");
    close(thrown.basis_weight(), web.basis_weight(), 1e-3);
    let tau = web.basis_weight() / LINEAR_DENSITY;
    for (map, side) in [laid(&web).map, thrown].iter().flat_map(|map| [1, 2, 5, 10].map(|side| (map, side))) {
        let found = patch_cv(map, side).expect("an patch_cv");
        let law = straight_fibres(tau, found.patch);
        let error = found.standard_error.expect("an error");
        assert!((found.cv - law).abs() < 4.0 * error, "{found:?} where {law} is wanted");
    }
}

#[test]
fn one_fibre_says_how_uneven_the_web_is() {
    let by_surrogate = layer(Fibres::Surrogate(SPUNBOND), 5000.0);
    let web = Web { sheet: Sheet::new(1.0, 1.0, 1e-3), layers: vec![by_surrogate.clone()], seed: 3 };
    let map = laid(&web).map;
    close(map.basis_weight(), web.basis_weight(), 1e-9);
    let tau = web.basis_weight() / LINEAR_DENSITY;
    let sides = [1, 2, 5, 10, 20, 50];
    let (stop, pieces) = (AtomicBool::new(false), AtomicU64::new(0));
    let by = RunContext { threads: 2, isa: Isa::detect(), stop: &stop, done: &pieces };
    let of = OneFibre { cell: 1e-3, fibres: 64, seed: 1 };
    let alone = one_fibre(&by_surrogate, &sides, of, by).expect("single fibres");
    for (side, alone) in sides.into_iter().zip(alone.into_iter().map(|alone| alone.at_random)) {
        let found = patch_cv(&map, side).expect("an patch_cv");
        let wanted = (alone.mean / tau).sqrt();
        let own = alone.standard_error.expect("an error") / alone.mean / 2.0 * wanted;
        let error = found.standard_error.expect("an error");
        assert!((found.cv - wanted).abs() < 4.0 * error.hypot(own), "{found:?} where {wanted} is wanted");
    }
}

/// Other seeds have other fibres: two that follow each other once had half of them in common.
#[test]
fn single_fibres_of_two_seeds_have_none_in_common() {
    let by_surrogate = layer(Fibres::Surrogate(SPUNBOND), 5000.0);
    let (stop, pieces) = (AtomicBool::new(false), AtomicU64::new(0));
    let by = RunContext { threads: 2, isa: Isa::detect(), stop: &stop, done: &pieces };
    let values = |seed| {
        let of = OneFibre { cell: 1e-3, fibres: 16, seed };
        one_fibre(&by_surrogate, &[10], of, by).expect("single fibres").remove(0).at_random.values
    };
    let (first, second) = (values(1), values(2));
    assert_eq!((first.len(), second.len()), (16, 16));
    assert!(!first.iter().any(|value| second.contains(value)), "{first:?} {second:?}");
}

/// Holes at an even pitch leave no streaks, and the expected CV accounts for it; so do holes that stand far apart.
#[test]
fn rows_of_nozzles_have_the_unevenness_that_is_expected_of_them() {
    for (pitch, count) in [(0.25e-3, 2000), (50e-3, 10)] {
        let rows = Filaments::Rows(vec![Row::new(0.1e-3, pitch, count)]);
        let narrow = Surrogate { sigma_cd: 12e-3, ..SPUNBOND };
        let layer = Layer { filaments: rows, ..layer(Fibres::Surrogate(narrow), 0.0) };
        let sheet = Sheet { patches: [2e-3, 10e-3, 40e-3].to_vec(), ..Sheet::new(0.5, 1.0, 1e-3) };
        let web = Web { sheet, layers: vec![layer], seed: 4 };
        let (stop, pieces) = (AtomicBool::new(false), AtomicU64::new(0));
        let by = RunContext { threads: 2, isa: Isa::detect(), stop: &stop, done: &pieces };
        for patch in find(&web, by).expect("findings").patches {
            let (wanted, own) = patch.single_fibres.expect("known numbers");
            let error = patch.map.standard_error.expect("an error");
            assert!(
                (patch.map.cv - wanted).abs() < 4.0 * error.hypot(own.unwrap()) && error < 0.1 * wanted,
                "{patch:?}, pitch {pitch}"
            );
        }
    }
}

#[test]
fn a_web_has_the_same_bits_on_all_machines_and_threads() {
    let rows = Filaments::Rows(vec![Row::new(1e-3, 2e-3, 50)]);
    let one = Layer { filaments: rows, ..layer(Fibres::Surrogate(SPUNBOND), 0.0) };
    let two = layer(Fibres::Surrogate(Surrogate { sigma_cd: 30e-3, ..SPUNBOND }), 700.0);
    let web = Web { sheet: Sheet::new(0.1, 0.2, 0.5e-3), layers: vec![one, two], seed: 5 };
    let first = laid_by(&web, Isa::Baseline, 1).map;
    close(first.basis_weight(), web.basis_weight(), 1e-5);
    for isa in Isa::available() {
        for threads in [1, 3] {
            assert!(laid_by(&web, isa, threads).map == first, "{isa:?}, {threads} threads");
        }
    }
    let other = laid(&Web { seed: 6, ..web }).map;
    assert!(other != first);
}

/// A window some cells off the edges.
fn inside(web: &Web, off: usize) -> Window {
    let off = off as f64 * web.sheet.cell;
    Window { corner: [off; 2], sides: [web.sheet.width - 2.0 * off, web.sheet.length - 2.0 * off] }
}

fn fibres(web: &Web, window: Window) -> Vec<WindowCurve> {
    let (stop, laid) = (AtomicBool::new(false), AtomicU64::new(0));
    strands(web, window, RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &laid })
        .expect("fibres")
}

/// Mass of a straight piece in each cell, by Liang and Barsky's clipping [kg].
fn clipped(map: &Map, from: [f64; 2], to: [f64; 2], mass: f64, into: &mut [f64]) {
    let range = |of: usize, size: usize| {
        let [low, high] = [from[of].min(to[of]), from[of].max(to[of])].map(|x| (x / map.cell).floor());
        (low.max(0.0) as usize)..=(high.clamp(0.0, size as f64 - 1.0) as usize)
    };
    for row in range(1, map.rows) {
        for column in range(0, map.columns) {
            let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
            for (of, number) in [column, row].into_iter().enumerate() {
                let by = to[of] - from[of];
                let ends = [number, number + 1].map(|edge| (edge as f64 * map.cell - from[of]) / by);
                enters = enters.max(ends[0].min(ends[1]));
                leaves = leaves.min(ends[0].max(ends[1]));
            }
            into[row * map.columns + column] += mass * (leaves - enters).max(0.0);
        }
    }
}

#[test]
fn a_cell_holds_what_independent_clipping_gives_it() {
    for (edges, cell) in [(Edges::Cut, 2e-3), (Edges::Periodic, 2e-3), (Edges::Periodic, 0.4e-3)] {
        let sheet = Sheet { edges, ..Sheet::new(0.04, 0.06, cell) };
        let web = Web { sheet, layers: vec![layer(Fibres::Surrogate(SPUNBOND), 250.0)], seed: 11 };
        let map = laid(&web).map;
        // Further off than a piece is long.
        let off = (2e-3 / cell).round() as usize;
        let mut wanted = vec![0.0; map.cells.len()];
        // All pieces have the same mass; on the belt they are longer or shorter.
        let layer = &web.layers[0];
        let length = layer.fed_length(&web.sheet) * layer.count(&web.sheet) as f64;
        let mass = LINEAR_DENSITY * length / pieces(&web).expect("pieces") as f64;
        for strand in &fibres(&web, inside(&web, off)) {
            let place = |point: [f64; 2]| point.map(|x| x + off as f64 * cell);
            for pair in strand.points.windows(2) {
                clipped(&map, place(pair[0]), place(pair[1]), mass, &mut wanted);
            }
        }
        let largest = wanted.iter().copied().fold(0.0, f64::max);
        // A piece that only cuts a corner of the window is no strand, so the cells are a piece further inside.
        for row in 2 * off..map.rows - 2 * off {
            for column in 2 * off..map.columns - 2 * off {
                let found = f64::from(map.row(row)[column]) * map.quantum;
                let wanted = wanted[row * map.columns + column];
                // A part is rounded to a quantum, and a cell has some thousand parts at most.
                assert!(
                    (found - wanted).abs() < 1e-4 * largest,
                    "{found:e} where {wanted:e} is wanted, {edges:?}"
                );
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn no_fibre_is_lost_or_made(
        seed in 0u64..1000, columns in 20usize..120, rows in 10usize..120, cell in 0.2e-3f64..5e-3,
        filaments in 1u64..40, offset in -0.05f64..0.05, pitch in 0.0f64..0.01, ratio in 0.02f64..0.9,
        sigma in 2e-3f64..40e-3, noise in 5.0f64..20.0, cut in any::<bool>(),
    ) {
        let edges = if cut { Edges::Cut } else { Edges::Periodic };
        let (width, length) = (columns as f64 * cell, rows as f64 * cell);
        let filaments = Filaments::Rows(vec![Row::new(offset, pitch, filaments)]);
        let fibres = Fibres::Surrogate(Surrogate { sigma_md: sigma, sigma_cd: 0.7 * sigma, noise });
        let belt_speed = 50.0 * ratio;
        let (linear_density, defects) = (LINEAR_DENSITY, Vec::new());
    let layer = Layer { linear_density, feed_speed: 50.0, belt_speed, filaments, fibres, defects };
        let web = Web { sheet: Sheet { edges, ..Sheet::new(width, length, cell) }, layers: vec![layer], seed };
        let laid = laid(&web);
        let whole = LINEAR_DENSITY * web.fibre_length();
        let found = laid.map.total() as f64 * laid.map.quantum + laid.cut;
        prop_assert!((found / whole - 1.0).abs() < 1e-9, "{found:e} of {whole:e}");
        prop_assert!(cut || laid.cut == 0.0);
    }
}

/// By mass, directions on a moving belt are evenly spread about the machine direction: for a direction α
/// uniform in length of fibre, the mean of cos² of the direction of (cos α − r, sin α) is ½ for any belt
/// ratio r below one.
#[test]
fn half_of_the_mass_lies_along_the_machine_direction() {
    for belt_speed in [3.0, 25.0] {
        let layer = Layer { belt_speed, ..layer(Fibres::Surrogate(SPUNBOND), 640.0) };
        let web = Web { sheet: Sheet::new(0.1, belt_speed / 3.0, 1e-3), layers: vec![layer], seed: 2 };
        let (stop, laid) = (AtomicBool::new(false), AtomicU64::new(0));
        let by = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &laid };
        let found = orientation(&web, by).expect("an orientation");
        let error = found.cos_squared.standard_error.expect("an error");
        assert!(
            (found.cos_squared.mean - 0.5).abs() < 4.0 * error && error < 2e-3,
            "{:?}",
            found.cos_squared
        );
        close(found.directions.iter().sum(), 1.0, 1e-12);
    }
}

/// Without a flight beside it nothing is known of the error of a surrogate, and nothing is made up.
#[test]
fn the_whole_error_of_a_surrogate_alone_is_not_known() {
    let sheet = Sheet { patches: vec![5e-3], ..Sheet::new(0.2, 0.2, 1e-3) };
    let web = Web { sheet, layers: vec![layer(Fibres::Surrogate(SPUNBOND), 500.0)], seed: 1 };
    let (stop, pieces) = (AtomicBool::new(false), AtomicU64::new(0));
    let by = RunContext { threads: 2, isa: Isa::detect(), stop: &stop, done: &pieces };
    let found = find(&web, by).expect("findings");
    let patch = found.patches[0];
    let error = patch.total_error();
    assert!(error.chance.is_some() && error.flight.is_none() && error.whole().is_none(), "{error:?}");
    assert!(patch.single_fibres.is_some() && patch.independent().is_none());
}
