//! Scanned webs: a simulated web, rendered as the scan of it, is found again.

#![allow(clippy::expect_used)]

#[path = "common/scans.rs"]
mod scans;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use spunlaid::lanes::Isa;
use spunlaid::scan::{Findings, Light, Picture, Settings, analyse, parse};
use spunlaid::surrogate::Surrogate;
use spunlaid::web::uniformity::unevenness;
use spunlaid::web::{Edges, Fibres, Filaments, Layer, Laying, Map, Sheet, Web, lay};
use std::f64::consts::PI;
use std::sync::atomic::{AtomicBool, AtomicU64};

/// Side of a cell of the web and of a pixel of its scan [m].
const PIXEL: f64 = 0.5e-3;
/// Mean optical density of the web.
const DENSITY: f64 = 0.3;

/// A spunbond web of 300 by 400 mm and about 19 g/m².
fn laid(seed: u64) -> Map {
    let fibres = Fibres::Surrogate(Surrogate { sigma_md: 18.4e-3, sigma_cd: 18.3e-3, noise: 12.4 });
    let layer = Layer {
        linear_density: 910.0 * PI * 18e-6 * 18e-6 / 4.0,
        feed_speed: 50.0,
        belt_speed: 3.0,
        filaments: Filaments::AtRandom { per_metre: 5000.0 },
        fibres,
        compared: None,
    };
    let (width, length) = (0.3, 0.4);
    let sheet = Sheet { width, length, cell: PIXEL, patches: Vec::new(), edges: Edges::Periodic };
    let web = Web { sheet, layers: vec![layer], seed };
    let (stop, pieces) = (AtomicBool::new(false), AtomicU64::new(0));
    let map = lay(&web, Laying { threads: 2, isa: Isa::detect(), stop: &stop, laid: &pieces });
    // A piece that is cut out of the web, as a scan is.
    Map { closed: [false; 2], ..map.expect("a web that can be laid").map }
}

/// Light that comes through each cell, of a lamp of strength one.
fn light(map: &Map) -> Vec<f64> {
    let mean = map.total() as f64 / map.cells.len() as f64;
    map.cells.iter().map(|quanta| (-DENSITY * f64::from(*quanta) / mean).exp()).collect()
}

/// The lamp at a place, from −1 to 1 both ways.
type Lamp = fn(f64, f64) -> f64;

/// An even lamp behind a lens: light falls with the fourth power of the cosine towards the corners. From 0.85 to 1.15.
fn lens(u: f64, v: f64) -> f64 {
    let tangent = 0.075 * ((u - 0.1).powi(2) + (v + 0.15).powi(2));
    1.15 * (1.0 + 0.02 * u) / (1.0 + tangent).powi(2)
}

/// A lamp with a dark side and a bright spot, which no polynomial of second order follows. From 0.85 to 1.15.
fn spotted(u: f64, v: f64) -> f64 {
    0.88 + 0.23 * (1.3 * (u - 0.2)).cos() * (1.1 * (v + 0.1)).cos() + 0.04 * (3.0 * u).sin()
}

/// A blur by a Gaussian with a standard deviation of one pixel.
fn blurred(light: &[f64], columns: usize) -> Vec<f64> {
    let weights: Vec<f64> = (-4..=4).map(|i: i32| (-0.5 * f64::from(i * i)).exp()).collect();
    let whole: f64 = weights.iter().sum();
    let rows = light.len() / columns;
    let along = |light: &[f64], [right, down]: [i64; 2]| -> Vec<f64> {
        let at = |i: usize| {
            let parts = weights.iter().zip(-4i64..).map(|(weight, by)| {
                let column = ((i % columns) as i64 + by * right).clamp(0, columns as i64 - 1) as usize;
                let row = ((i / columns) as i64 + by * down).clamp(0, rows as i64 - 1) as usize;
                weight * light[row * columns + column]
            });
            parts.sum::<f64>() / whole
        };
        (0..light.len()).map(at).collect()
    };
    along(&along(light, [1, 0]), [0, 1])
}

/// What a camera makes of light: a lamp, blur, the noise of 10,000 electrons at the largest level, whole levels.
fn exposed([columns, rows]: [usize; 2], light: &[f64], lamp: Lamp, full_scale: f64, seed: u64) -> Vec<u16> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut uniform = || (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let light = blurred(light, columns);
    let place = |of: usize, side: usize| 2.0 * of as f64 / side as f64 - 1.0;
    let level = |(i, light): (usize, &f64)| {
        let electrons = 8000.0 * light * lamp(place(i % columns, columns), place(i / columns, rows));
        // The sum of twelve is near enough to a normal number.
        let normal = (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
        let seen = electrons + electrons.sqrt() * normal;
        (seen / 1e4 * full_scale).round().clamp(0.0, full_scale) as u16
    };
    light.iter().enumerate().map(level).collect()
}

/// The file of a scan: PNG for 8 bits, TIFF for 16.
fn file(columns: usize, levels: &[u16], bits: u32) -> Vec<u8> {
    match bits {
        8 => scans::png8(columns, &levels.iter().map(|level| *level as u8).collect::<Vec<_>>()),
        _ => scans::tiff16(columns, levels),
    }
}

fn mean(levels: &[u16]) -> f64 {
    levels.iter().map(|level| f64::from(*level)).sum::<f64>() / levels.len() as f64
}

fn scanned(file: &[u8], settings: &Settings) -> Findings {
    let picture: Picture = parse(file, "scan", PIXEL).expect("a picture");
    analyse(&picture, settings).expect("a web")
}

/// Sides of the patches [pixels].
const SIDES: [usize; 5] = [4, 6, 10, 20, 40];

/// Renders webs as scans under a lamp, reads them back, and checks every CV against the true one. A sharp patch must have it
/// within its interval and to the last tolerance; of others, no more than told is lost.
///
/// * `pictured` – whether there is a picture of the lamp, or else only its level
/// * `truth` – the true CVs of a web
fn rendered_and_found(lamp: Lamp, pictured: bool, truth: impl Fn(&Map) -> Vec<f64>, tolerance: f64) {
    const WEIGHT: f64 = 19.2e-3;
    let mut sharp = 0;
    for seed in 1..=6 {
        let map = laid(seed);
        let size = [map.columns, map.rows];
        let (light, truth) = (light(&map), truth(&map));
        for bits in [8, 16] {
            let full_scale = f64::from((1u32 << bits) - 1);
            let scan = file(map.columns, &exposed(size, &light, lamp, full_scale, seed), bits);
            // The lamp without web at the same exposure.
            let empty = exposed(size, &vec![1.0; light.len()], lamp, full_scale, seed + 100);
            let white = (!pictured).then(|| mean(&empty));
            let light = Light::Transmitted { mean: Some(WEIGHT), white };
            let lamp =
                pictured.then(|| parse(&file(map.columns, &empty, bits), "lamp", PIXEL).expect("a lamp"));
            let patches = SIDES.map(|side| side as f64 * PIXEL).to_vec();
            let found = scanned(&scan, &Settings { patches, lamp, ..Settings::of(light) });
            assert!((found.map.basis_weight() / WEIGHT - 1.0).abs() < 1e-12);
            // The light of a pixel is a mean of light, not of densities, so thin places count more.
            let density = found.density.expect("a density");
            assert!((density / DENSITY - 1.0).abs() < 0.01, "{density}");
            for ((side, patch), truth) in SIDES.into_iter().zip(&found.patches).zip(&truth) {
                let [low, high] = patch.interval().expect("an interval");
                let ratio = patch.unevenness.cv / truth;
                if patch.is_sharp() {
                    sharp += 1;
                    assert!((low..=high).contains(truth), "{truth} is not in {low} to {high}");
                    assert!((ratio - 1.0).abs() < tolerance, "{ratio} at {side} pixels");
                } else {
                    assert!(
                        (1.0 - 2.0 * patch.blur..1.0 + tolerance).contains(&ratio),
                        "{ratio} at {side} pixels"
                    );
                }
            }
        }
    }
    assert!(sharp >= 24, "{sharp}");
}

#[test]
fn a_picture_of_the_lamp_takes_out_any_shading() {
    let truth = |map: &Map| SIDES.map(|side| unevenness(map, side).expect("an unevenness").cv).to_vec();
    // What a patch may lose by blur and still be sharp.
    rendered_and_found(spotted, true, truth, 0.01);
}

#[test]
fn the_shading_of_a_lens_is_taken_out_with_what_the_web_varies_as_smoothly() {
    // The web without its own polynomial.
    let truth = |map: &Map| {
        let file = scans::npy_f64(map.columns, &light(map));
        let transmitted = Light::Transmitted { mean: None, white: Some(1.0) };
        let patches = SIDES.map(|side| side as f64 * PIXEL).to_vec();
        let found = scanned(&file, &Settings { patches, ..Settings::of(transmitted) });
        found.patches.iter().map(|patch| patch.unevenness.cv).collect()
    };
    // The rest of a lens that is no polynomial.
    rendered_and_found(lens, false, truth, 0.03);
}

#[test]
fn analytic_densities_give_the_map_back() {
    let map = laid(7);
    let light = light(&map);
    let patches = SIDES.map(|side| side as f64 * PIXEL).to_vec();
    // A camera that raises levels to a power, another unit of light: only ratios of densities count.
    for (scale, power) in [(1.0, 1.0), (4000.0, 1.0), (1.0, 1.0 / 2.2)] {
        let levels: Vec<f64> = light.iter().map(|light| scale * light.powf(power)).collect();
        let transmitted = Light::Transmitted { mean: None, white: Some(scale) };
        let settings = Settings { patches: patches.clone(), keep_shading: true, ..Settings::of(transmitted) };
        let found = scanned(&scans::npy_f64(map.columns, &levels), &settings);
        assert!(!found.mean_known && found.shading.is_none() && found.map.closed == [false; 2]);
        for (side, patch) in SIDES.into_iter().zip(&found.patches) {
            let truth = unevenness(&map, side).expect("an unevenness");
            let ratio = patch.unevenness.cv / truth.cv;
            // A quantum is a millionth of the mean.
            assert!((ratio - 1.0).abs() < 1e-5, "{ratio}");
            assert!((patch.unevenness.patch / truth.patch - 1.0).abs() < 1e-12);
        }
    }
    // A map of basis weight, as `spunlaid web` writes it.
    let weights: Vec<f64> =
        map.cells.iter().map(|quanta| f64::from(*quanta) * map.weight_of_quantum()).collect();
    let found = scanned(&scans::npy_f64(map.columns, &weights), &Settings::of(Light::Weight { mean: None }));
    assert!(found.mean_known && (found.map.basis_weight() / map.basis_weight() - 1.0).abs() < 1e-12);
}

#[test]
fn stat_given_noise_is_taken_out_and_other_noise_is_at_most_what_is_told() {
    const NOISE: f64 = 0.3;
    let map = laid(8);
    let mut random = ChaCha8Rng::seed_from_u64(8);
    let mut uniform = || (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let mean = map.total() as f64 / map.cells.len() as f64;
    // Relative weights up to six standard deviations of the noise above zero.
    let noisy = map.cells.iter().map(|quanta| {
        let normal = (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
        2.0 + f64::from(*quanta) / mean + NOISE * normal
    });
    let file = scans::npy_f64(map.columns, &noisy.collect::<Vec<f64>>());
    let patches = SIDES.map(|side| side as f64 * PIXEL).to_vec();
    let plain = Settings { patches, ..Settings::of(Light::Weight { mean: None }) };
    let [with, without] =
        [None, Some(NOISE)].map(|noise| scanned(&file, &Settings { noise, ..plain.clone() }));
    for (i, side) in SIDES.into_iter().enumerate() {
        // The mean is three times that of the web alone.
        let truth = unevenness(&map, side).expect("an unevenness").cv / 3.0;
        let noise = NOISE / 3.0 / side as f64;
        let found = without.patches[i].unevenness.cv;
        assert!((found / truth - 1.0).abs() < 0.01, "{found} where {truth} is wanted");
        // The mean of the noise is not exactly zero.
        assert!((without.patches[i].noise / noise - 1.0).abs() < 1e-3);
        assert!((0.99 * noise..1.5 * noise).contains(&with.patches[i].noise), "{:?}", with.patches[i]);
    }
}
