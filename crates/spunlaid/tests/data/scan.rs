//! Scanned webs: a simulated web, rendered as the scan of it, is found again.

use crate::scans;
use crate::scans::{DENSITY, Lamp, PIXEL, beside, exposed, file, lens, light, piece, spoiled, spotted, web};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use spunlaid_web::map::uniformity::patch_cv;
use spunlaid_web::scan::{Findings, ScanWarning, analyse, parse};
use spunlaid_web::{Light, Map, Picture, Settings};
use std::ops::RangeInclusive;

/// A spunbond web of 300 by 400 mm and about 19 g/m².
fn laid(seed: u64) -> Map {
    piece(&web([0.3, 0.4], PIXEL, 18.3e-3, 5000.0, false, seed), [0, 0], [600, 800])
}

/// What is found on a map itself.
fn unscanned(map: &Map) -> Vec<f64> {
    let weights: Vec<f64> = map.cells.iter().map(|quanta| f64::from(*quanta)).collect();
    let patches = SIDES.map(|side| side as f64 * PIXEL).to_vec();
    let settings = Settings { patches, ..Settings::new(Light::Weight { mean: None }) };
    let found = scanned(&scans::npy_f64(map.columns, &weights), &settings);
    found.patches.iter().map(|patch| patch.patch_cv.cv).collect()
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

/// Renders webs as scans under a lamp, reads them back, and checks every CV against the true one. A sharp
/// patch must have it within its interval and to the last tolerance; of others, no more than reported is lost.
///
/// * `webs` – the seeds of the webs
/// * `pictured` – whether there is a picture of the lamp, or else only its level
/// * `truth` – the true CVs of a web
fn rendered_and_found(
    webs: RangeInclusive<u64>,
    lamp: Lamp,
    pictured: bool,
    truth: impl Fn(&Map) -> Vec<f64>,
    tolerance: f64,
) {
    const WEIGHT: f64 = 19.2e-3;
    let mut sharp = 0;
    let least = 4 * webs.clone().count();
    for seed in webs {
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
            let found = scanned(&scan, &Settings { patches, lamp, ..Settings::new(light) });
            assert!((found.map.basis_weight() / WEIGHT - 1.0).abs() < 1e-12);
            assert!(found.aside.spots.is_empty() && found.aside.cut_off == 0.0, "{:?}", found.notes);
            // The light of a pixel is a mean of light, not of densities, so thin spots count more.
            let density = found.density.expect("a density");
            assert!((density / DENSITY - 1.0).abs() < 0.01, "{density}");
            for ((side, patch), truth) in SIDES.into_iter().zip(&found.patches).zip(&truth) {
                let ratio = patch.patch_cv.cv / truth;
                if patch.is_sharp() {
                    sharp += 1;
                    let [low, high] = match patch.interval {
                        Ok(interval) => interval,
                        Err(doubt) => {
                            assert!(!pictured && doubt == ScanWarning::Shading, "{doubt}");
                            [0.0, f64::INFINITY]
                        }
                    };
                    assert!((low..=high).contains(truth), "{truth} is not in {low} to {high}");
                    assert!((ratio - 1.0).abs() < tolerance, "{ratio} at {side} pixels");
                } else {
                    assert!(
                        (1.0 - 2.0 * patch.blur.expect("a blur")..1.0 + tolerance).contains(&ratio),
                        "{ratio} at {side} pixels"
                    );
                }
            }
        }
    }
    assert!(sharp >= least, "{sharp}");
}

fn pictures_of_the_lamp(webs: RangeInclusive<u64>) {
    // What a patch may lose by blur and still be sharp.
    rendered_and_found(webs, spotted, true, unscanned, 0.01);
}

fn shadings_of_a_lens(webs: RangeInclusive<u64>) {
    // The web without its own polynomial.
    let truth = |map: &Map| {
        let file = scans::npy_f64(map.columns, &light(map));
        let transmitted = Light::Transmitted { mean: None, white: Some(1.0) };
        let patches = SIDES.map(|side| side as f64 * PIXEL).to_vec();
        let found = scanned(&file, &Settings { patches, ..Settings::new(transmitted) });
        found.patches.iter().map(|patch| patch.patch_cv.cv).collect()
    };
    // The rest of a lens that is no polynomial.
    rendered_and_found(webs, lens, false, truth, 0.03);
}

#[test]
fn a_picture_of_the_lamp_takes_out_any_shading() {
    pictures_of_the_lamp(1..=2);
}

#[test]
fn the_shading_of_a_lens_is_taken_out_with_what_the_web_varies_as_smoothly() {
    shadings_of_a_lens(1..=2);
}

#[test]
#[ignore = "slow: four more webs under two lamps"]
fn stat_shading_is_taken_out_of_many_webs() {
    pictures_of_the_lamp(3..=6);
    shadings_of_a_lens(3..=6);
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
        let settings =
            Settings { patches: patches.clone(), keep_shading: true, ..Settings::new(transmitted) };
        let found = scanned(&scans::npy_f64(map.columns, &levels), &settings);
        assert!(!found.mean_known && found.shading.is_none() && found.map.closed == [false; 2]);
        for ((side, patch), truth) in SIDES.into_iter().zip(&found.patches).zip(unscanned(&map)) {
            let ratio = patch.patch_cv.cv / truth;
            // A quantum is a millionth of the mean.
            assert!((ratio - 1.0).abs() < 1e-5, "{ratio}");
            assert!((patch.patch_cv.patch / (side as f64 * PIXEL) - 1.0).abs() < 1e-12);
        }
    }
    // A map of basis weight, as `spunlaid web` writes it.
    let weights: Vec<f64> =
        map.cells.iter().map(|quanta| f64::from(*quanta) * map.weight_of_quantum()).collect();
    let found = scanned(&scans::npy_f64(map.columns, &weights), &Settings::new(Light::Weight { mean: None }));
    assert!(found.mean_known && (found.map.basis_weight() / map.basis_weight() - 1.0).abs() < 1e-12);
}

#[test]
fn stat_given_noise_is_taken_out_and_other_noise_is_at_most_what_is_reported() {
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
    let plain = Settings { patches, ..Settings::new(Light::Weight { mean: None }) };
    let [with, without] =
        [None, Some(NOISE)].map(|noise| scanned(&file, &Settings { noise, ..plain.clone() }));
    let unscanned = unscanned(&map);
    for (i, side) in SIDES.into_iter().enumerate() {
        // The mean is three times that of the web alone.
        let truth = unscanned[i] / 3.0;
        let noise = NOISE / 3.0 / side as f64;
        let found = without.patches[i].patch_cv.cv;
        assert!((found / truth - 1.0).abs() < 0.01, "{found} where {truth} is wanted");
        // The mean of the noise is not exactly zero.
        assert!((without.patches[i].noise / noise - 1.0).abs() < 1e-3);
        assert!((0.99 * noise..1.5 * noise).contains(&with.patches[i].noise), "{:?}", with.patches[i]);
    }
}

#[test]
#[ignore = "slow: scans of many webs"]
fn stat_the_intervals_of_scanned_pieces_hold_the_cv_of_their_web() {
    // Five pieces of 160 by 180 mm out of each of eight webs.
    const PIECE: [usize; 2] = [320, 360];
    const SIDES: [usize; 2] = [20, 40];
    for in_rows in [false, true] {
        let webs: Vec<Map> =
            (1..=8).map(|seed| web([0.8, 0.2], PIXEL, 10e-3, 3000.0, in_rows, seed)).collect();
        // The webs are closed to rings, and their mean is exact.
        let truth = SIDES.map(|side| {
            let variance = |web: &Map| patch_cv(web, side).expect("an patch_cv").cv.powi(2);
            (webs.iter().map(variance).sum::<f64>() / webs.len() as f64).sqrt()
        });
        let mut inside = [0; 2];
        let mut pieces = 0;
        let mut widths = [Vec::new(), Vec::new()];
        for (seed, web) in (1..).zip(&webs) {
            for part in 0..5 {
                let map = piece(web, [PIECE[0] * part, 0], PIECE);
                let light = light(&map);
                let picture = |light: &[f64], seed: u64| {
                    parse(&file(PIECE[0], &exposed(PIECE, light, spotted, 65535.0, seed), 16), "scan", PIXEL)
                        .expect("a picture")
                };
                let seed = 100 * seed + part as u64;
                let lamp = Some(picture(&vec![1.0; light.len()], seed + 50));
                let patches = SIDES.map(|side| side as f64 * PIXEL).to_vec();
                let transmitted = Light::Transmitted { mean: None, white: None };
                let settings = Settings { lamp, patches, ..Settings::new(transmitted) };
                let found = analyse(&picture(&light, seed), &settings).expect("a web");
                pieces += 1;
                for (i, patch) in found.patches.iter().enumerate() {
                    let [low, high] = patch.interval.expect("an interval");
                    inside[i] += i32::from((low..=high).contains(&truth[i]));
                    widths[i].push(high / low);
                }
            }
        }
        // Of 40 independent intervals of 95 %, 38 hold the truth, with a standard deviation of 1.38: fewer
        // than 34 is beyond three of them.
        assert_eq!(pieces, 40);
        assert!(inside.iter().all(|inside| *inside >= 34), "{inside:?} of {pieces}, in rows: {in_rows}");
        // They say something all the same. Pieces of 150 mm have usual ends of 0.87 and 1.84 of the CV in
        // rows, 0.66 and 2.95 at random places: a factor of 2.1 and 4.5 (docs/validation.md), and a third
        // more is allowed here.
        let most = if in_rows { 2.8 } else { 6.0 };
        let middle = widths.map(|widths| spunlaid_ground::statistics::median(&widths));
        assert!(middle.iter().all(|width| *width < most), "{middle:?}, in rows: {in_rows}");
    }
}

#[test]
fn an_assumed_lamp_leaves_no_interval() {
    let map = laid(3);
    let levels = exposed([map.columns, map.rows], &light(&map), spotted, 65535.0, 3);
    let scan = file(map.columns, &levels, 16);
    let found = |white: Option<f64>, keep_shading: bool| {
        let light = Light::Transmitted { mean: None, white };
        scanned(&scan, &Settings { keep_shading, patches: vec![10e-3, 80e-3], ..Settings::new(light) })
    };
    for (white, keep_shading, doubt) in [
        (None, false, Some(ScanWarning::White)),
        (None, true, Some(ScanWarning::White)),
        (Some(52_000.0), false, Some(ScanWarning::Shading)),
        // Who says that the lamp is even, must know.
        (Some(52_000.0), true, None),
    ] {
        let found = found(white, keep_shading);
        let [small, large] = [found.patches[0], found.patches[1]];
        assert_eq!((found.assumption, small.interval.err()), (doubt, doubt));
        assert_eq!(small.patch_cv.standard_error.is_none(), doubt.is_some());
        // Three patches of 80 mm beside each other say nothing in any case.
        assert_eq!(large.interval, Err(doubt.unwrap_or(ScanWarning::Few)));
        let notes: Vec<String> = found.notes.iter().map(ToString::to_string).collect();
        assert_eq!(
            notes.iter().any(|note| note.contains("so no interval is given; take an image of the lamp")),
            doubt.is_some(),
            "{notes:?}"
        );
    }
}

/// Without a picture of the lamp, its level counts as the largest of the file.
#[test]
fn without_the_lamp_the_cv_is_a_lower_bound() {
    let map = laid(3);
    let size = [map.columns, map.rows];
    let light = light(&map);
    let truth = unscanned(&map);
    let even: Lamp = |_, _| 1.15;
    for (name, lamp) in [("lens", lens as Lamp), ("spotted", spotted), ("even", even)] {
        let scan = file(map.columns, &exposed(size, &light, lamp, 65535.0, 3), 16);
        let patches = SIDES.map(|side| side as f64 * PIXEL).to_vec();
        let light = Light::Transmitted { mean: None, white: None };
        let found = scanned(&scan, &Settings { patches, ..Settings::new(light) });
        assert_eq!(found.assumption, Some(ScanWarning::White));
        for (patch, truth) in found.patches.iter().zip(&truth) {
            let ratio = patch.patch_cv.cv / truth;
            println!("{name} {} {truth} {ratio}", patch.patch_cv.patch);
            assert!(ratio < 1.0, "{name}: {ratio} over {} m", patch.patch_cv.patch);
        }
    }
}

#[test]
fn bare_lamp_blots_and_dust_are_found_and_left_out() {
    let map = piece(&web([0.3, 0.4], PIXEL, 10e-3, 5000.0, true, 4), [0, 0], [600, 800]);
    let (size, clean) = ([map.columns, map.rows], light(&map));
    let scan = |light: &[f64], bits: u32, seed: u64| {
        let full_scale = f64::from((1u32 << bits) - 1);
        file(map.columns, &exposed(size, light, spotted, full_scale, seed), bits)
    };
    for (bits, kind, factor) in
        [(16, "edges", 2.0), (8, "edges", 2.0), (16, "blots", 1.5), (8, "blots", 1.5), (16, "dust", 1.02)]
    {
        let aside = beside(kind, size);
        let spoiled = spoiled(kind, &clean, &aside);
        let lamp = parse(&scan(&vec![1.0; clean.len()], bits, 9), "lamp", PIXEL).expect("a lamp");
        let found = |light: &[f64], keep_spots: bool| {
            let lamp = Some(lamp.clone());
            let transmitted = Light::Transmitted { mean: None, white: None };
            let patches = vec![10e-3, 15e-3];
            scanned(
                &scan(light, bits, 4),
                &Settings { lamp, keep_spots, patches, ..Settings::new(transmitted) },
            )
        };
        let [truth, cleaned, spoiled] = [found(&clean, false), found(&spoiled, false), found(&spoiled, true)];
        let area = aside.iter().filter(|is| **is).count() as f64 * PIXEL * PIXEL;
        for i in 0..2 {
            let [truth, cleaned, spoiled] =
                [&truth, &cleaned, &spoiled].map(|found| found.patches[i].patch_cv);
            // The part that is left is most of the same web: it differs by less than chance.
            let error = cleaned.standard_error.expect("an error");
            assert!((cleaned.cv - truth.cv).abs() < error, "{kind}: {cleaned:?} for {truth:?}");
            assert!(spoiled.cv > factor * truth.cv, "{kind}: {spoiled:?} for {truth:?}");
        }
        let notes: Vec<String> = cleaned.notes.iter().map(ToString::to_string).collect();
        if kind == "edges" {
            // A rectangle cannot follow a skewed edge: the wedges are cut off with the lamp, and a margin of
            // two blocks of nine pixels at each side.
            let found = cleaned.aside.cut_off;
            let most = (2.0 * 0.026 * 800.0 + 4.0 + 26.0 + 36.0) * 800.0 * PIXEL * PIXEL;
            assert!((area..most).contains(&found) && cleaned.aside.spots.is_empty(), "{found} of {area}");
            assert!(
                notes.iter().any(|note| note.contains("there it is as bright as in its own image")),
                "{notes:?}"
            );
        } else {
            // Blur makes each wider by two or three pixels all around.
            let (spots, masked) = (&cleaned.aside.spots, cleaned.aside.masked);
            let most = if kind == "blots" { 3.0 } else { 14.0 };
            assert!((area..most * area).contains(&masked), "{masked} of {area}");
            assert!(
                cleaned.aside.cut_off == 0.0
                    && notes
                        .iter()
                        .any(|note| note.contains("dark spots such as dust or blots were left out: ")),
                "{notes:?}"
            );
            if kind == "blots" {
                let place = spots.iter().find(|spot| {
                    (spot.place[0] - 150.5 * PIXEL).hypot(spot.place[1] - 200.5 * PIXEL) < PIXEL
                });
                assert!(spots.len() == 3 && place.is_some(), "{spots:?}");
            } else {
                // Some of sixty lie side by side.
                assert!((50..=60).contains(&spots.len()), "{}", spots.len());
            }
        }
        assert!(truth.aside.spots.is_empty() && truth.aside.bare.is_none());
        let aside = |text: &str| text.contains("the bare lamp is") || text.contains("dark spots");
        assert!(!spoiled.notes.iter().any(|note| aside(&note.message)), "{:?}", spoiled.notes);
    }
}

#[test]
fn rejects_pictures_that_are_mostly_dark_spots_or_askew() {
    let map = laid(5);
    let light = light(&map);
    let refused = |is_aside: &dyn Fn(usize, usize) -> bool, level: f64| {
        let spoiled = light
            .iter()
            .enumerate()
            .map(|(at, light)| if is_aside(at % map.columns, at / map.columns) { level } else { *light });
        let values: Vec<f64> = spoiled.collect();
        let picture = parse(&scans::npy_f64(map.columns, &values), "scan", PIXEL).expect("a picture");
        let settings = Settings {
            patches: vec![5e-3],
            ..Settings::new(Light::Transmitted { mean: None, white: Some(1.0) })
        };
        let [said, kept] = [false, true].map(|keep_spots| {
            analyse(&picture, &Settings { keep_spots, keep_shading: true, ..settings.clone() })
                .map(|_| ())
                .map_err(|error| error.to_string())
        });
        assert_eq!(kept, Ok(()));
        said.expect_err("a refusal")
    };
    let said = refused(&|x, y| x > 540 && y > 300, 0.05);
    assert!(
        said.contains("far darker than the rest of the web on ") && said.contains("clean the glass"),
        "{said}"
    );
    let said = refused(&|x, y| x.abs_diff(300) + y.abs_diff(400) > 330, 1.0);
    assert!(said.contains("shows the bare lamp on ") && said.contains("turn the scan straight"), "{said}");
}

/// A web on a black ground, by Kubelka's law for fibres that scatter light and absorb none.
#[test]
fn analytic_light_that_is_thrown_back() {
    let map = laid(6);
    let mean = map.total() as f64 / map.cells.len() as f64;
    let level = |quanta: &u32| {
        let scattering = 0.5 * f64::from(*quanta) / mean;
        0.8 * scattering / (1.0 + scattering)
    };
    let levels: Vec<f64> = map.cells.iter().map(level).collect();
    let patches = SIDES.map(|side| side as f64 * PIXEL).to_vec();
    let settings = |light| Settings {
        patches: patches.clone(),
        keep_shading: true,
        keep_spots: true,
        ..Settings::new(light)
    };
    let file = scans::npy_f64(map.columns, &levels);
    let reflected = scanned(&file, &settings(Light::Reflected { mean: None, white: Some(0.8) }));
    let transmitted = settings(Light::Transmitted { mean: None, white: Some(0.8) });
    let transmitted = scanned(&file, &Settings { light_is_assumed: true, ..transmitted });
    for (patch, (truth, wrong)) in
        reflected.patches.iter().zip(unscanned(&map).iter().zip(&transmitted.patches))
    {
        let cv = patch.patch_cv.cv;
        // The basis weights are kept in millionths of their mean.
        assert!((cv / truth - 1.0).abs() < 1e-5, "{cv} {truth}");
        assert!((wrong.patch_cv.cv / truth - 1.0).abs() > 0.1, "{} {truth}", wrong.patch_cv.cv);
    }
    let doubts =
        |found: &Findings| found.notes.iter().any(|note| note.message.contains("heavy places are light"));
    assert!(doubts(&transmitted) && !doubts(&reflected));
}

/// The bare lamp beside a skewed web, or a web that becomes thinner, bends the polynomial as no lamp does.
#[test]
fn rejects_a_shading_that_no_lamp_makes() {
    let map = laid(7);
    let slope =
        |(at, light): (usize, &f64)| light * (0.3 + 0.7 * (at % map.columns) as f64 / map.columns as f64);
    let levels: Vec<f64> = light(&map).iter().enumerate().map(slope).collect();
    let picture = parse(&scans::npy_f64(map.columns, &levels), "scan", PIXEL).expect("a picture");
    let settings = Settings::new(Light::Transmitted { mean: None, white: Some(1.0) });
    let refusal = analyse(&picture, &settings).expect_err("a refusal").to_string();
    assert!(refusal.contains("a lamp and a lens make 60 % at most"), "{refusal}");
    assert!(analyse(&picture, &Settings { keep_shading: true, ..settings }).is_ok());
}
