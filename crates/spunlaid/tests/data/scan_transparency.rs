//! Transparent pixels of pictures, in all ways in which a file may give them.

use crate::scans::{npy_f64, png, png8, tiff_of_channels, waves, with_chunk};
use png::{BitDepth, ColorType};
use spunlaid_web::scan::{Findings, analyse, parse};
use spunlaid_web::{Light, Settings};
use tiff::encoder::colortype::{RGBA8, RGBA16};

const COLUMNS: usize = 120;
const ROWS: usize = 150;
/// Transparent columns at the left.
const STRIP: usize = 15;

/// Grey levels of a web, up to 240.
fn levels() -> Vec<u8> {
    waves(COLUMNS, ROWS, 8).iter().map(|weight| (240.0 * (-0.8 * weight).exp()).round() as u8).collect()
}

fn is_clear(at: usize) -> bool {
    at % COLUMNS < STRIP
}

fn found(file: &[u8]) -> Result<Findings, String> {
    let picture = parse(file, "a", 0.1e-3).map_err(|error| error.to_string())?;
    let white = picture.full_scale.map(|full| full * 250.0 / 255.0);
    let light = Light::Transmitted { mean: Some(20e-3), white };
    let settings = Settings { patches: vec![2e-3], keep_shading: true, ..Settings::new(light) };
    analyse(&picture, &settings).map_err(|error| error.to_string())
}

/// Levels and opacity of all pixels, of so many colours.
fn channels(colours: usize, clear_level: u8, opacity: impl Fn(usize) -> u8) -> Vec<u8> {
    let pixel = |(at, level): (usize, &u8)| {
        let level = if opacity(at) == 0 { clear_level } else { *level };
        [vec![level; colours], vec![opacity(at)]].concat()
    };
    levels().iter().enumerate().flat_map(pixel).collect()
}

/// A picture of places in a palette of greys, of which the last one is transparent.
fn with_palette() -> Vec<u8> {
    let places: Vec<u8> =
        levels().iter().enumerate().map(|(at, level)| if is_clear(at) { 255 } else { *level }).collect();
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, COLUMNS as u32, ROWS as u32);
    encoder.set_color(ColorType::Indexed);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_palette(
        (0..=255).flat_map(|level| [if level == 255 { 180 } else { level }; 3]).collect::<Vec<u8>>(),
    );
    encoder.set_trns((0..=255).map(|level| if level == 255 { 0 } else { 255 }).collect::<Vec<u8>>());
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&places).unwrap();
    writer.finish().unwrap();
    file
}

#[test]
fn transparent_pixels_are_no_web() {
    let opacity = |at: usize| if is_clear(at) { 0 } else { 255 };
    let rest: Vec<u8> =
        levels().iter().enumerate().filter(|(at, _)| !is_clear(*at)).map(|(_, level)| *level).collect();
    let truth = found(&png8(COLUMNS - STRIP, &rest)).unwrap();
    let keyed: Vec<u8> =
        levels().iter().enumerate().map(|(at, level)| if is_clear(at) { 251 } else { *level }).collect();
    let deep = |bytes: &[u8]| bytes.iter().map(|level| u16::from(*level) * 257).collect::<Vec<u16>>();
    let deep_bytes =
        |bytes: &[u8]| deep(bytes).iter().flat_map(|level| level.to_be_bytes()).collect::<Vec<u8>>();
    // What is transparent is black in such files.
    let multiplied: Vec<u8> = levels()
        .iter()
        .enumerate()
        .flat_map(|(at, level)| if is_clear(at) { [0; 4] } else { [*level, *level, *level, 255] })
        .collect();
    for (name, file) in [
        ("grey", png(COLUMNS, ColorType::GrayscaleAlpha, BitDepth::Eight, &channels(1, 110, opacity))),
        ("grey, dark", png(COLUMNS, ColorType::GrayscaleAlpha, BitDepth::Eight, &channels(1, 0, opacity))),
        (
            "grey of 16 bits",
            png(
                COLUMNS,
                ColorType::GrayscaleAlpha,
                BitDepth::Sixteen,
                &deep_bytes(&channels(1, 200, opacity)),
            ),
        ),
        ("colours", png(COLUMNS, ColorType::Rgba, BitDepth::Eight, &channels(3, 180, opacity))),
        (
            "half opaque",
            png(
                COLUMNS,
                ColorType::Rgba,
                BitDepth::Eight,
                &channels(3, 180, |at| if is_clear(at) { 120 } else { 255 }),
            ),
        ),
        ("a colour", with_chunk(&png8(COLUMNS, &keyed), b"tRNS", &[0, 251])),
        ("a palette", with_palette()),
        ("TIFF", tiff_of_channels::<RGBA8>(COLUMNS, &channels(3, 200, opacity), &[2])),
        ("TIFF, multiplied", tiff_of_channels::<RGBA8>(COLUMNS, &multiplied, &[1])),
        ("TIFF of 16 bits", tiff_of_channels::<RGBA16>(COLUMNS, &deep(&channels(3, 200, opacity)), &[2])),
    ] {
        let found = found(&file).unwrap_or_else(|error| panic!("{name}: {error}"));
        let [cv, wanted] = [&found, &truth].map(|found| found.patches[0].patch_cv.cv);
        assert_eq!((found.aside.corner, found.map.columns), ([STRIP, 0], COLUMNS - STRIP), "{name}");
        assert!((cv / wanted - 1.0).abs() < 1e-6, "{name}: {cv} {wanted}");
        let notes: Vec<String> = found.notes.iter().map(ToString::to_string).collect();
        let count = STRIP * ROWS;
        let words = format!("pixels that are transparent: {count} (12 %)");
        assert!(notes.iter().any(|note| note.starts_with(&words)), "{name}: {notes:?}");
        assert!(
            notes.iter().any(|note| note.contains("strips were cut off: 1.5 mm at the left")),
            "{notes:?}"
        );
    }
}

#[test]
fn an_opaque_picture_stays_whole() {
    let plain = found(&png8(COLUMNS, &levels())).unwrap();
    for (name, file) in [
        ("opaque", png(COLUMNS, ColorType::GrayscaleAlpha, BitDepth::Eight, &channels(1, 0, |_| 255))),
        ("evenly half opaque", png(COLUMNS, ColorType::Rgba, BitDepth::Eight, &channels(3, 0, |_| 128))),
        ("no mask", tiff_of_channels::<RGBA8>(COLUMNS, &channels(3, 0, |at| (at % 251) as u8 | 1), &[0])),
    ] {
        let found = found(&file).unwrap();
        let [one, other] = [&found, &plain].map(|found| found.patches[0].patch_cv.cv);
        assert!((one / other - 1.0).abs() < 1e-6 && found.aside.cut_off == 0.0, "{name}: {one} {other}");
        assert!(!found.notes.iter().any(|note| note.message.contains("transparent")), "{name}");
    }
}

#[test]
fn rejects_pictures_whose_web_is_mostly_transparent() {
    let grey = |opacity: &dyn Fn(usize) -> u8| {
        found(&png(COLUMNS, ColorType::GrayscaleAlpha, BitDepth::Eight, &channels(1, 90, opacity)))
            .unwrap_err()
    };
    let all = grey(&|_| 0);
    assert!(all.contains("has no pixel that is not transparent; save the scan without"), "{all}");
    let scattered = grey(&|at| if (at * 7919) % 20 == 0 { 0 } else { 255 });
    assert!(scattered.contains("without transparent pixels"), "{scattered}");
    let diamond = grey(&|at| {
        let (x, y) = (at % COLUMNS, at / COLUMNS);
        if x.abs_diff(60) + y.abs_diff(75) > 70 { 0 } else { 255 }
    });
    assert!(diamond.contains("no large rectangle of web can be cut out"), "{diamond}");
    // Of a map, what has no value along its edges is cut off alike.
    let rows = waves(COLUMNS, ROWS, 8);
    let framed: Vec<f64> = rows
        .iter()
        .enumerate()
        .map(|(at, weight)| {
            let (x, y) = (at % COLUMNS, at / COLUMNS);
            let is_frame = !(4..COLUMNS - 7).contains(&x) || !(3..ROWS - 5).contains(&y);
            if is_frame { f64::NAN } else { 20e-3 * weight }
        })
        .collect();
    let picture = parse(&npy_f64(COLUMNS, &framed), "a", 0.1e-3).unwrap();
    let settings = Settings { patches: vec![2e-3], ..Settings::new(Light::Weight { mean: None }) };
    let found = analyse(&picture, &settings).unwrap();
    assert_eq!(found.aside.corner, [4, 3]);
    assert_eq!([found.map.columns, found.map.rows], [COLUMNS - 11, ROWS - 8]);
    assert_eq!(found.pixels.filled, 0);
}
