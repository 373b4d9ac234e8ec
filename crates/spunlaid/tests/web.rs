//! The web: nothing is lost, and its unevenness is that of the laws.

#![allow(clippy::expect_used)]

use spunlaid::lanes::Isa;
use spunlaid::surrogate::Surrogate;
use spunlaid::web::uniformity::unevenness;
use spunlaid::web::{
    Curves, Edges, Fibres, Filaments, Laid, Layer, Laying, OneFibre, Row, Sheet, Web, lay, one_fibre,
    straight_fibres,
};
use std::f64::consts::PI;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64};

const SPUNBOND: Surrogate = Surrogate { sigma_md: 18.4e-3, sigma_cd: 18.3e-3, noise: 12.4 };
/// 18 µm at 910 kg/m³ [kg/m].
const LINEAR_DENSITY: f64 = 910.0 * PI * 18e-6 * 18e-6 / 4.0;

fn sheet(width: f64, length: f64, cell: f64) -> Sheet {
    Sheet { width, length, cell, patches: Vec::new(), edges: Edges::Periodic }
}

fn layer(fibres: Fibres, per_metre: f64) -> Layer {
    let filaments = Filaments::AtRandom { per_metre };
    Layer { linear_density: LINEAR_DENSITY, feed_speed: 50.0, belt_speed: 3.0, filaments, fibres }
}

fn laid_by(web: &Web, isa: Isa, threads: usize) -> Laid {
    let (stop, laid) = (AtomicBool::new(false), AtomicU64::new(0));
    lay(web, Laying { threads, isa, stop: &stop, laid: &laid }).expect("a web that can be laid")
}

fn laid(web: &Web) -> Laid {
    laid_by(web, Isa::detect(), 2)
}

fn close(found: f64, wanted: f64, relative: f64) {
    assert!((found / wanted - 1.0).abs() <= relative, "{found} where {wanted} is wanted");
}

/// Straight fibres, each thrown at random: one filament each.
fn straight(count: usize, length: f64, width: f64, cell: f64) -> Web {
    const PIECES: usize = 1000;
    let spacing = length / PIECES as f64;
    let curves = (0..4096).map(|i| {
        let (sin, cos) = (PI * (f64::from(i) + 0.5) / 2048.0).sin_cos();
        (0..=PIECES).map(|j| [cos, sin].map(|c| c * spacing * j as f64)).collect()
    });
    let ratio = width / length;
    let curves = Curves::new(spacing, ratio, curves.collect()).expect("curves");
    let filaments = Filaments::AtRandom { per_metre: count as f64 / width };
    let fibres = Fibres::Curves(Arc::new(curves));
    Web {
        sheet: sheet(width, width, cell),
        layers: vec![Layer {
            linear_density: LINEAR_DENSITY,
            feed_speed: 1.0,
            belt_speed: ratio,
            filaments,
            fibres,
        }],
        seed: 7,
    }
}

#[test]
fn straight_fibres_at_random_have_the_unevenness_of_the_law() {
    let web = straight(4000, 10.0, 1.0, 1e-3);
    let map = laid(&web).map;
    let tau = web.basis_weight() / LINEAR_DENSITY;
    for side in [1, 2, 5, 10, 20] {
        let found = unevenness(&map, side).expect("an unevenness");
        let law = straight_fibres(tau, found.patch);
        let error = found.standard_error.expect("an error");
        eprintln!("{side} {} {law} {error} {}", found.cv, (found.cv / law).powi(2) * 0.9464);
        assert!((found.cv - law).abs() < 4.0 * error, "{found:?} where {law} is wanted");
    }
}

#[test]
fn one_fibre_says_how_uneven_the_web_is() {
    let by_surrogate = layer(Fibres::Surrogate(SPUNBOND), 5000.0);
    let web = Web { sheet: sheet(1.0, 1.0, 1e-3), layers: vec![by_surrogate.clone()], seed: 3 };
    let start = std::time::Instant::now();
    let map = laid(&web).map;
    eprintln!("{:?} for {} km", start.elapsed(), web.fibre_length() / 1e3);
    close(map.basis_weight(), web.basis_weight(), 1e-9);
    let tau = web.basis_weight() / LINEAR_DENSITY;
    let sides = [1, 2, 5, 10, 20, 50];
    let (stop, pieces) = (AtomicBool::new(false), AtomicU64::new(0));
    let by = Laying { threads: 2, isa: Isa::detect(), stop: &stop, laid: &pieces };
    let of = OneFibre { cell: 1e-3, fibres: 64, seed: 1 };
    let alone = one_fibre(&by_surrogate, &sides, of, by).expect("single fibres");
    for (side, alone) in sides.into_iter().zip(alone) {
        let found = unevenness(&map, side).expect("an unevenness");
        let wanted = (alone.mean / tau).sqrt();
        let own = alone.standard_error.expect("an error") / alone.mean / 2.0 * wanted;
        let error = found.standard_error.expect("an error");
        eprintln!(
            "{side} map {:.5} ± {error:.5} one fibre {wanted:.5} ± {own:.5} straight {:.5}",
            found.cv,
            straight_fibres(tau, found.patch)
        );
        assert!((found.cv - wanted).abs() < 4.0 * error.hypot(own), "{found:?} where {wanted} is wanted");
    }
}

#[test]
fn a_web_has_the_same_bits_on_all_machines_and_threads() {
    let rows = Filaments::Rows(vec![Row { offset: 1e-3, pitch: 2e-3, filaments: 50 }]);
    let one = Layer { filaments: rows, ..layer(Fibres::Surrogate(SPUNBOND), 0.0) };
    let two = layer(Fibres::Surrogate(Surrogate { sigma_cd: 30e-3, ..SPUNBOND }), 700.0);
    let web = Web { sheet: sheet(0.1, 0.2, 0.5e-3), layers: vec![one, two], seed: 5 };
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
