//! Pictures of the lamp that cannot be believed, and grey levels that pass for weights.

use crate::scans::{lens, npy, npy_f64, png, png8, png16, spotted, tiff_f32, waves};
use png::{BitDepth, ColorType};
use spunlaid_web::scan::{Findings, ScanWarning, analyse, parse};
use spunlaid_web::{Light, Picture, Settings};

const COLUMNS: usize = 150;
const ROWS: usize = 180;
const PIXEL: f64 = 0.1e-3;

fn parsed(file: &[u8]) -> Picture {
    parse(file, "a", PIXEL).unwrap()
}

/// A lamp at each pixel, 1 at its brightest.
fn lamp(of: fn(f64, f64) -> f64) -> Vec<f64> {
    let place = |at: usize, side: usize| 2.0 * at as f64 / side as f64 - 1.0;
    let levels: Vec<f64> =
        (0..COLUMNS * ROWS).map(|at| of(place(at % COLUMNS, COLUMNS), place(at / COLUMNS, ROWS))).collect();
    let most = levels.iter().copied().fold(0.0, f64::max);
    levels.iter().map(|level| level / most).collect()
}

/// Brighter in the middle, with a broad top: half of the light at the sides.
fn broad(u: f64, _: f64) -> f64 {
    1.0 - 0.4 * u.powi(4)
}

fn even(_: f64, _: f64) -> f64 {
    1.0
}

/// What comes through a web of the density 0.85.
fn behind(lamp: &[f64]) -> Vec<f64> {
    let web = waves(COLUMNS, ROWS, 3);
    lamp.iter().zip(web).map(|(lamp, weight)| lamp * (-0.85 * weight).exp()).collect()
}

fn levels16(light: &[f64], most: f64, clip: f64) -> Vec<u16> {
    light.iter().map(|light| (light * most).round().min(clip) as u16).collect()
}

fn found(scan: &[u8], lamp: &[u8]) -> Findings {
    let settings = Settings { patches: vec![2e-3], lamp: Some(parsed(lamp)), ..Settings::new(light()) };
    analyse(&parsed(scan), &settings).unwrap()
}

fn light() -> Light {
    Light::Transmitted { mean: Some(20e-3), white: None }
}

fn cv(found: &Findings) -> f64 {
    found.patches[0].patch_cv.cv
}

fn truth() -> f64 {
    let settings = Settings { patches: vec![2e-3], ..Settings::new(Light::Weight { mean: None }) };
    cv(&analyse(&parsed(&npy_f64(COLUMNS, &waves(COLUMNS, ROWS, 3))), &settings).unwrap())
}

#[test]
fn a_clipped_picture_of_the_lamp_leaves_no_interval() {
    let bright = lamp(broad);
    let truth = truth();
    // The lamp is brighter than the file can hold; the web is not.
    for (name, most, clip) in [
        ("16 bits", 1.15 * 65_535.0, 65_535.0),
        ("12 bits, raised", 1.3 * 65_520.0, 65_520.0),
        ("14 bits", 1.2 * 16_383.0, 16_383.0),
        ("where the sensor is full", 1.2 * 60_000.0, 60_000.0),
    ] {
        let scan = png16(COLUMNS, &levels16(&behind(&bright), most, clip));
        let found = found(&scan, &png16(COLUMNS, &levels16(&bright, most, clip)));
        assert_eq!(found.assumption, Some(ScanWarning::ClippedLamp), "{name}");
        assert_eq!(found.patches[0].interval, Err(ScanWarning::ClippedLamp), "{name}");
        assert!(found.patches[0].patch_cv.standard_error.is_none());
        let reported = found.notes.iter().find(|note| note.message.contains("the lamp is clipped")).unwrap();
        assert!(reported.remedy.contains("no pixel of the lamp has the largest level"), "{reported}");
        assert!(cv(&found) > 1.05 * truth, "{name}: {} {truth}", cv(&found));
    }
    // One channel of colours is clipped, and the luminance lies below the largest level.
    let colours = |light: &[f64]| -> Vec<u8> {
        let level = |light: &f64, gain: f64| (light * gain * 255.0).round().min(255.0) as u8;
        light.iter().flat_map(|light| [level(light, 0.7), level(light, 1.2), level(light, 0.6)]).collect()
    };
    let [scan, lamp] = [&behind(&bright), &bright]
        .map(|light| png(COLUMNS, ColorType::Rgb, BitDepth::Eight, &colours(light)));
    assert_eq!(found(&scan, &lamp).assumption, Some(ScanWarning::ClippedLamp));
}

#[test]
fn analytic_a_fair_picture_of_the_lamp_gives_the_cv_with_an_interval() {
    let truth = truth();
    for (name, of, most) in [
        ("broad", broad as fn(f64, f64) -> f64, 0.9 * 65_535.0),
        ("a lens", lens, 0.95 * 65_535.0),
        ("spotted", spotted, 0.7 * 65_535.0),
        ("even", even, 0.8 * 65_535.0),
        ("12 bits", broad, 3900.0),
    ] {
        let light = lamp(of);
        let scan = png16(COLUMNS, &levels16(&behind(&light), most, 65_535.0));
        let found = found(&scan, &png16(COLUMNS, &levels16(&light, most, 65_535.0)));
        assert_eq!(found.assumption, None, "{name}: {:?}", found.notes);
        let [low, high] = found.patches[0].interval.unwrap();
        assert!(
            (low..high).contains(&truth) && (cv(&found) / truth - 1.0).abs() < 0.01,
            "{name}: {}",
            cv(&found)
        );
        // Eight bits without any noise have broad plateaus.
        let eight = |light: &[f64]| -> Vec<u8> {
            light.iter().map(|light| (light * most / 65_535.0 * 255.0).round() as u8).collect()
        };
        if most > 4000.0 {
            let of_8_bits =
                self::found(&png8(COLUMNS, &eight(&behind(&light))), &png8(COLUMNS, &eight(&light)));
            assert_eq!(of_8_bits.assumption, None, "{name}, 8 bits: {:?}", of_8_bits.notes);
        }
    }
    // A few hot pixels do not count.
    let light = lamp(broad);
    let mut hot = levels16(&light, 50_000.0, 65_535.0);
    (hot[77], hot[9000]) = (65_535, 65_535);
    let scan = png16(COLUMNS, &levels16(&behind(&light), 50_000.0, 65_535.0));
    assert_eq!(found(&scan, &png16(COLUMNS, &hot)).assumption, None);
}

#[test]
fn a_lamp_that_is_darker_than_the_web_leaves_no_interval() {
    let light = lamp(broad);
    let scan = png16(COLUMNS, &levels16(&behind(&light), 60_000.0, 65_535.0));
    // A third of the exposure.
    let found = found(&scan, &png16(COLUMNS, &levels16(&light, 26_000.0, 65_535.0)));
    assert_eq!(
        (found.assumption, found.patches[0].interval),
        (Some(ScanWarning::DarkLamp), Err(ScanWarning::DarkLamp))
    );
    assert!(found.notes.iter().any(|note| note.message.contains("more light than the lamp gives")));
}

/// The numbers of a picture, as text, bytes and floats.
fn grey() -> [(&'static str, Vec<u8>); 5] {
    let light: Vec<f64> = behind(&lamp(even)).iter().map(|light| (light * 250.0).round()).collect();
    let shape = format!("({ROWS}, {COLUMNS})");
    let bytes: Vec<u8> = light.iter().map(|level| *level as u8).collect();
    let wide: Vec<u8> = light.iter().flat_map(|level| (*level as u16 * 257).to_le_bytes()).collect();
    let parts: Vec<u8> = light.iter().flat_map(|level| (*level as f32 / 255.0).to_le_bytes()).collect();
    let rows = light.chunks(COLUMNS).map(|row| row.iter().map(f64::to_string).collect::<Vec<_>>().join(","));
    let csv: String = rows.map(|row| row + "\n").collect();
    [
        ("bytes", npy("|u1", "False", &shape, &bytes)),
        ("16 bits", npy("<u2", "False", &shape, &wide)),
        ("parts of one", npy("<f4", "False", &shape, &parts)),
        ("whole floats", npy_f64(COLUMNS, &light)),
        ("CSV", csv.into_bytes()),
    ]
}

#[test]
fn grey_levels_that_pass_for_weights_are_doubted() {
    let reported = |file: &[u8], mean: Option<f64>, light_is_assumed: bool| {
        let light = Light::Weight { mean };
        let settings = Settings { patches: vec![2e-3], light_is_assumed, ..Settings::new(light) };
        analyse(&parsed(file), &settings).unwrap()
    };
    let says =
        |found: &Findings| found.notes.iter().any(|note| note.message.contains("as those of an image"));
    for (name, file) in grey() {
        let assumed = reported(&file, Some(20e-3), true);
        assert_eq!(assumed.assumption, Some(ScanWarning::GreyLevels), "{name}");
        assert_eq!(assumed.patches[0].interval, Err(ScanWarning::GreyLevels), "{name}");
        assert!(says(&assumed), "{name}");
        // Who says that they are weights is believed, and reported.
        let stated = reported(&file, Some(20e-3), false);
        assert!(stated.assumption.is_none() && says(&stated) && stated.patches[0].interval.is_ok(), "{name}");
    }
    // As light they have the CV of the web.
    let light = Light::Transmitted { mean: Some(20e-3), white: Some(250.0) };
    let settings = Settings { patches: vec![2e-3], keep_shading: true, ..Settings::new(light) };
    let found = analyse(&parsed(&grey()[0].1), &settings).unwrap();
    assert!((cv(&found) / truth() - 1.0).abs() < 0.01, "{}", cv(&found));

    // Weights, also whole ones in grams and in milligrams, are none.
    let web = waves(COLUMNS, ROWS, 5);
    let of = |unit: f64, digits: f64| -> Vec<f64> {
        web.iter().map(|weight| (weight * unit * digits).round() / digits).collect()
    };
    for (name, file) in [
        ("kg/m²", npy_f64(COLUMNS, &of(0.11, 1e5))),
        ("g/m² with a digit", npy_f64(COLUMNS, &of(110.0, 10.0))),
        ("whole g/m²", npy_f64(COLUMNS, &of(110.0, 1.0))),
        ("whole tenths of a gram", npy_f64(COLUMNS, &of(1100.0, 1.0))),
        ("whole milligrams", npy_f64(COLUMNS, &of(110_000.0, 1.0))),
        ("floats", tiff_f32(COLUMNS, &of(0.11, 1e9).iter().map(|x| *x as f32).collect::<Vec<_>>())),
    ] {
        let found = reported(&file, Some(0.11), true);
        assert!(found.assumption.is_none() && !says(&found), "{name}: {:?}", found.notes);
    }
}
