//! The errors of webs, against the scatter of many webs of each kind.

use spunlaid_ground::statistics::difference_of_logarithms;
use spunlaid_ground::{Error, Isa, NORMAL_95, RunContext};
use spunlaid_web::map::uniformity::{PatchCv, unevenness_at};
use spunlaid_web::map::{Defect, Filaments, Findings, find, lay};
use spunlaid_web::{Clouds, Edges, Fibres, Layer, Row, Sheet, Surrogate, Web};
use std::sync::atomic::{AtomicBool, AtomicU64};

const WEBS: u64 = 80;
/// Sides of patches [cells].
const SIDES: [usize; 3] = [1, 5, 20];
const CELL: f64 = 2e-3;
/// Waves of the cloudiness [m].
const BAND: [f64; 2] = [16e-3, 80e-3];

fn web(filaments: Filaments, edges: Edges, [width, length]: [f64; 2]) -> Web {
    let patches = SIDES.map(|side| side as f64 * CELL).to_vec();
    Web {
        sheet: Sheet { width, length, cell: CELL, patches, edges },
        layers: vec![Layer {
            linear_density: 2.3e-7,
            feed_speed: 50.0,
            belt_speed: 10.0,
            filaments,
            fibres: Fibres::Surrogate(Surrogate { sigma_md: 18e-3, sigma_cd: 16e-3, noise: 12.0 }),
            defects: Vec::new(),
        }],
        seed: 1,
    }
}

fn rows(pitch: f64, filaments: u64) -> Filaments {
    Filaments::Rows(vec![Row::new(0.5 * pitch, pitch, filaments)])
}

fn with<T>(run: impl FnOnce(RunContext<'_>) -> T) -> T {
    let (stop, laid) = (AtomicBool::new(false), AtomicU64::new(0));
    run(RunContext { threads: 2, isa: Isa::detect(), stop: &stop, done: &laid })
}

/// Deviations of independent webs, each with its standard error: intervals cover the truth, errors are those
/// of the scatter, and equal webs do not differ.
fn hold(what: &str, found: &[(f64, f64)]) {
    let count = found.len() as f64;
    let truth = (found.iter().map(|of| of.0 * of.0).sum::<f64>() / count).sqrt();
    let interval = |(cv, error): (f64, f64)| {
        PatchCv { patch: 1.0, cv, standard_error: Some(error) }.interval().expect("an interval")
    };
    let covers = |[low, high]: [f64; 2]| (low..=high).contains(&truth);
    let held = found.iter().filter(|of| covers(interval(**of))).count() as f64;
    // 95 % of them, within four standard deviations of a binomial number.
    let least = 0.95 * count - 4.0 * (0.95 * 0.05 * count).sqrt();
    assert!(held >= least, "{what}: {held} of {count} intervals hold");
    // Errors too wide are found by the scatter: that of a standard deviation from so many values is 1/√(2n),
    // and four of them are allowed.
    let mean = found.iter().map(|of| of.0).sum::<f64>() / count;
    let scatter = (found.iter().map(|of| (of.0 - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt();
    let error = (found.iter().map(|of| of.1 * of.1).sum::<f64>() / count).sqrt();
    println!("{what}: {held} of {count} hold, error {error:.5}, scatter {scatter:.5}, truth {truth:.5}");
    let off = (error / scatter).ln().abs();
    assert!(off < 4.0 / (2.0 * count).sqrt(), "{what}: error {error}, scatter {scatter}");
    // As `spunlaid compare` does: the ends of the intervals that face each other make the error of the difference.
    let differ = |pair: &&[(f64, f64)]| {
        let (a, b) = (pair[0], pair[1]);
        let (less, more) = if a.0 < b.0 { (a, b) } else { (b, a) };
        let ends = [interval(less)[1] / less.0, more.0 / interval(more)[0]];
        difference_of_logarithms([less.0, more.0], ends.map(|end| end.ln() / NORMAL_95)).is_significant()
    };
    let alarms = found.chunks_exact(2).filter(differ);
    let most = 0.05 * count / 2.0 + 4.0 * (0.05 * 0.95 * count / 2.0).sqrt();
    assert!((alarms.count() as f64) < most, "{what}: equal webs differ");
}

#[test]
fn stat_intervals_of_cv_and_clouds_hold_for_webs_of_each_kind() {
    for (name, filaments) in [
        ("random places", Filaments::AtRandom { per_metre: 800.0 }),
        ("rows, even", rows(2e-3, 240)),
        ("rows far apart", rows(48e-3, 10)),
        ("some holes at random", rows(2e-3, 240)),
        ("some filaments at random", Filaments::AtRandom { per_metre: 800.0 }),
    ] {
        let mut web = web(filaments, Edges::Periodic, [0.48, 0.3]);
        if name.starts_with("some") {
            // On a slow belt there is little else than their streaks.
            web.layers[0].defects = vec![Defect { share: 0.2, titre: 0.5, ..Defect::USUAL }];
            web.layers[0].belt_speed = 1.0;
        }
        let mut found = vec![Vec::new(); SIDES.len() + 1];
        for seed in 1..=WEBS {
            let web = Web { seed, ..web.clone() };
            let map = with(|by| lay(&web, by)).expect("a web").map;
            let places = web.places(web.sheet.width);
            for (side, found) in SIDES.iter().zip(&mut found) {
                let of = unevenness_at(&map, *side, &places).expect("an patch_cv");
                found.extend(of.standard_error.map(|error| (of.cv, error)));
            }
            let (index, error) = Clouds::at(&map, &places, 1).expect("clouds").cloudiness(BAND[0], BAND[1]);
            found[SIDES.len()].extend(error.map(|error| (index, error)));
        }
        let names = SIDES.map(|side| format!("{name}, {side} cells")).into_iter();
        for (what, found) in names.chain([format!("{name}, cloudiness")]).zip(&found) {
            assert_eq!(found.len() as u64, WEBS, "{what}: a web without an error");
            hold(&what, found);
        }
    }
}

/// Nothing reports of streaks where the sheet holds only a few.
#[test]
fn a_sheet_of_few_streaks_has_no_error() {
    let mut web = web(Filaments::AtRandom { per_metre: 800.0 }, Edges::Periodic, [0.13, 0.3]);
    // On a slow belt there is little else than streaks.
    web.layers[0].belt_speed = 2.0;
    let map = with(|by| lay(&web, by)).expect("a web").map;
    let of = unevenness_at(&map, 20, &web.places(0.13)).expect("an patch_cv");
    assert_eq!((of.standard_error, of.interval()), (None, None));
}

fn measured(web: &Web) -> Result<Findings, Error> {
    with(|by| find(web, by))
}

/// A web whose edges are cut is as uneven as the same web without edges: what is thinner at the edges is no CV.
#[test]
fn stat_edges_that_cut_do_not_count() {
    // The same pitch without edges, and on a sheet as wide as the row.
    let sizes = [0.48, 0.6];
    let whole = measured(&web(rows(1e-3, 480), Edges::Periodic, sizes)).expect("findings");
    let cut = measured(&web(rows(1e-3, 480), Edges::Cut, sizes)).expect("findings");
    assert_eq!((whole.margins, whole.reach), ([0.0; 2], [0.0, sizes[0]]));
    // The first hole stands at the edge of the sheet, so the sheet cuts its reach.
    assert_eq!(cut.reach, [0.0, sizes[0]]);
    for margin in cut.margins {
        // 3 σ_CD inwards of the first hole, in whole cells.
        assert!((0.0..=CELL + 1e-9).contains(&(margin - 3.0 * 16e-3)), "{margin}");
    }
    for (whole, cut) in whole.patches.iter().zip(&cut.patches) {
        let [(expected, of_expected), (wanted, own)] =
            [whole, cut].map(|patch| patch.single_fibres.expect("known numbers"));
        let [error, own, of_expected] =
            [cut.map.standard_error, own, of_expected].map(|error| error.expect("an error"));
        assert!((cut.map.cv - wanted).abs() < 4.0 * error.hypot(own), "{cut:?}");
        // The edges add 0.14 % of the mean at most, to 2 % or more.
        let both = own.hypot(of_expected);
        assert!((wanted - expected).abs() < 4.0 * both + 0.01 * wanted, "{cut:?} {whole:?}");
    }
    let [sheet, between] = [&cut.laid.map, &*cut.within()].map(|map| map.basis_weight());
    let dense = web(rows(1e-3, 480), Edges::Periodic, sizes).basis_weight();
    assert!((between / dense - 1.0).abs() < 2e-3 && sheet < 0.99 * between, "{sheet} {between} {dense}");
}

/// On a sheet that is wider than its row, the web ends 3 σ_CD beyond the outermost holes.
#[test]
fn a_web_ends_where_the_reach_of_its_outermost_filaments_does() {
    let Filaments::Rows(mut row) = rows(1e-3, 200) else { panic!("a row") };
    row[0].offset = 0.1;
    let web = web(Filaments::Rows(row), Edges::Cut, [0.48, 0.3]);
    let found = measured(&web).expect("findings");
    let reach = 3.0 * 16e-3;
    for (found, wanted) in found.reach.into_iter().zip([0.1 - reach, 0.299 + reach]) {
        assert!((found - wanted).abs() < 1e-9, "{found} {wanted}");
    }
    // Hardly any fibre lies beyond, and there is some just within.
    let profile = found.laid.map.profile_cd();
    let whole: f64 = profile.iter().sum();
    let column = |place: f64| (place / CELL) as usize;
    let [first, last] = found.reach.map(column);
    let beyond: f64 = profile[..first].iter().chain(&profile[last + 1..]).sum();
    assert!(beyond < 2e-3 * whole, "{beyond} {whole}");
    assert!(profile[first + column(0.5 * reach)] > 0.0 && profile[last - column(0.5 * reach)] > 0.0);
}

#[test]
fn rejects_a_web_that_is_nothing_but_edges() {
    let fault = measured(&web(rows(1e-3, 100), Edges::Cut, [0.1, 0.3])).expect_err("only edges");
    assert!(fault.to_string().starts_with("the edges of the web, where it is thin, take"), "{fault}");
    assert!(fault.to_string().contains("write web.edges = \"periodic\""), "{fault}");
}
