//! Scans whose files give how they are to be read: bits of the camera, orientation, pages.
//!
//! The fixture is a web of 180 × 240 pixels of 0.1 mm. Its values, of the file and of its picture turned by Pillow, are
//! CV 0.15381 over patches of 0.5 mm, and a share of the texture along the machine of 0.841, turned 0.168.

use crate::scans::{Page, png_of_resolution, png16, tiff_of_pages, with_chunk};
use spunlaid_web::scan::{Findings, analyse, parse};
use spunlaid_web::{Light, Settings};
use tiff::tags::Tag;

const COLUMNS: usize = 180;

/// Levels of 8 bits.
fn web() -> Vec<u16> {
    let picture = parse(include_bytes!("../scan_fixtures/web.png"), "a", None).unwrap();
    picture.values.iter().map(|level| *level as u16).collect()
}

fn page<'a>(columns: usize, levels: &'a [u16], bits: u32, tags: &'a [(Tag, u16)]) -> Page<'a> {
    Page { columns, levels, bits, tags }
}

fn found(file: &[u8]) -> Findings {
    let picture = parse(file, "a", 0.1e-3).unwrap();
    let settings = Settings::new(Light::Transmitted { mean: None, white: None });
    analyse(&picture, &Settings { patches: vec![0.5e-3], ..settings }).unwrap()
}

fn cv(found: &Findings) -> f64 {
    found.patches[0].patch_cv.cv
}

fn says(found: &Findings, words: &str) -> bool {
    found.notes.iter().any(|note| note.to_string().contains(words))
}

/// The levels of a camera of some bits.
fn of_bits(bits: u32) -> Vec<u16> {
    let largest = f64::from((1u32 << bits) - 1);
    web().iter().map(|level| (f64::from(*level) * largest / 255.0).round() as u16).collect()
}

#[test]
fn a_camera_of_few_bits_is_known_by_the_tag_of_its_file() {
    let levels = of_bits(12);
    let shifted: Vec<u16> = levels.iter().map(|level| level << 4).collect();
    let filled: Vec<u16> = levels.iter().map(|level| level << 4 | level >> 8).collect();
    let tiff = |levels: &[u16], tags: &[(Tag, u16)]| tiff_of_pages(&[page(COLUMNS, levels, 16, tags)]);
    let of_white_zero: Vec<u16> = levels.iter().map(|level| 4095 - level).collect();
    let negative = tiff(&of_white_zero, &[(Tag::MaxSampleValue, 4095), (Tag::PhotometricInterpretation, 0)]);
    let png = |levels: &[u16]| with_chunk(&png16(COLUMNS, levels), b"sBIT", &[12]);
    for (name, file, largest) in [
        ("MaxSampleValue", tiff(&levels, &[(Tag::MaxSampleValue, 4095)]), 4095.0),
        ("SMaxSampleValue", tiff(&levels, &[(Tag::SMaxSampleValue, 4095)]), 4095.0),
        ("10 bits", tiff(&of_bits(10), &[(Tag::MaxSampleValue, 1023)]), 1023.0),
        ("white is zero", negative, 4095.0),
        ("sBIT", png(&levels), 4095.0),
        ("sBIT, shifted", png(&shifted), 65520.0),
        ("sBIT, filled", png(&filled), 65535.0),
    ] {
        assert_eq!(parse(&file, "a", 0.1e-3).unwrap().full_scale, Some(largest), "{name}");
        let found = found(&file);
        assert!((cv(&found) - 0.154).abs() < 5e-4, "{name}: {}", cv(&found));
        assert!(!says(&found, "no level lies above"), "{name}");
    }
    // A tag of the largest level that was found, of fewer bits than the levels have, and none.
    let [most, some] = [levels.iter().max().unwrap(), &1023];
    for tags in [&[(Tag::MaxSampleValue, *most)][..], &[(Tag::MaxSampleValue, *some)], &[]] {
        let file = tiff(&levels, tags);
        let picture = parse(&file, "a", 0.1e-3).unwrap();
        let settings = |white| Settings {
            patches: vec![1e-3],
            ..Settings::new(Light::Transmitted { mean: None, white })
        };
        let said = analyse(&picture, &settings(None)).unwrap_err().to_string();
        assert!(said.contains("no level above 4095, though the file has 16 bits"), "{tags:?}: {said}");
        assert!(said.contains("4095 if the camera has 12 bits, otherwise 65535"), "{tags:?}: {said}");
        assert!(analyse(&picture, &settings(Some(4095.0))).is_ok());
    }
    let of_16_bits: Vec<u16> = web().iter().map(|level| level * 257).collect();
    assert!(!says(&found(&tiff(&of_16_bits, &[])), "no level lies above"));
}

/// Exif data with an orientation.
fn exif(orientation: u16, big: bool) -> Vec<u8> {
    let two = |number: u16| if big { number.to_be_bytes() } else { number.to_le_bytes() };
    let four = |number: u32| if big { number.to_be_bytes() } else { number.to_le_bytes() };
    let start: &[u8] = if big { b"MM\0*" } else { b"II*\0" };
    let entry = [&two(274)[..], &two(3), &four(1), &two(orientation), &[0; 2]].concat();
    [start, &four(8), &two(1), &entry, &[0; 4]].concat()
}

#[test]
fn a_picture_is_turned_as_its_orientation_says() {
    // Numbers in a picture of 17 × 19 pixels, from its four corners.
    let levels: Vec<u16> = (0..17 * 19).map(|i| i % 251).collect();
    let bytes: Vec<u8> = levels.iter().map(|level| *level as u8).collect();
    let [a, b, c, d] = [0, 16, 18 * 17, 18 * 17 + 16].map(|at: usize| f64::from(levels[at]));
    // By ImageOps.exif_transpose of Pillow 12: upper left and right, lower left and right.
    for (orientation, corners) in (1..).zip([
        [a, b, c, d],
        [b, a, d, c],
        [d, c, b, a],
        [c, d, a, b],
        [a, c, b, d],
        [c, a, d, b],
        [d, b, c, a],
        [b, d, a, c],
    ]) {
        let png = png_of_resolution(17, &bytes, [10_000; 2], png::Unit::Meter);
        for file in [
            tiff_of_pages(&[page(17, &levels, 8, &[(Tag::Orientation, orientation)])]),
            with_chunk(&png, b"eXIf", &exif(orientation, false)),
            with_chunk(&png, b"eXIf", &exif(orientation, true)),
        ] {
            let picture = parse(&file, "a", None).unwrap();
            let (columns, rows) = (picture.columns, picture.rows);
            assert_eq!([columns, rows], if orientation > 4 { [19, 17] } else { [17, 19] }, "{orientation}");
            let ends = [0, columns - 1, columns * (rows - 1), columns * rows - 1];
            assert_eq!(ends.map(|at| picture.values[at]), corners, "{orientation}");
        }
    }
    let turned = found(&tiff_of_pages(&[page(COLUMNS, &web(), 8, &[(Tag::Orientation, 6)])]));
    assert_eq!([turned.map.columns, turned.map.rows], [240, 180]);
    let texture = turned.clouds.as_ref().unwrap().texture_md();
    assert!((texture.mean - 0.168).abs() < 5e-4, "{}", texture.mean);
}

#[test]
fn levels_that_are_coded_for_a_screen_are_warned_of() {
    let plain = png16(COLUMNS, &of_bits(16));
    // A profile with a name, without compression of its content.
    let profile = [b"sRGB\0\0".as_slice(), b"x\x9c\x03\0\0\0\0\x01"].concat();
    let gamma = |gamma: u32| with_chunk(&plain, b"gAMA", &gamma.to_be_bytes());
    let with_profile = tiff_of_pages(&[page(COLUMNS, &web(), 8, &[(Tag::Unknown(34675), 1)])]);
    for (name, file, coding) in [
        ("none", plain.clone(), None),
        ("sRGB", with_chunk(&plain, b"sRGB", &[0]), Some("sRGB")),
        ("gamma 0.45455", gamma(45_455), Some("a gamma")),
        ("gamma 1", gamma(100_000), None),
        ("profile", with_chunk(&plain, b"iCCP", &profile), Some("a colour profile")),
        ("TIFF with a profile", with_profile, Some("a colour profile")),
    ] {
        let found = found(&file);
        assert_eq!(says(&found, "are coded for a screen"), coding.is_some(), "{name}: {:?}", found.notes);
        assert!(coding.is_none_or(|coding| says(&found, coding)), "{name}: {:?}", found.notes);
    }
}

#[test]
fn exif_data_that_are_broken_do_no_harm() {
    let png = png_of_resolution(17, &[7; 17 * 19], [10_000; 2], png::Unit::Meter);
    let whole = exif(6, true);
    let far = [&b"II*\0"[..], &[0xff; 4]].concat();
    for data in (0..24).map(|end| whole[..end].to_vec()).chain([far, b"Exif".to_vec()]) {
        let picture = parse(&with_chunk(&png, b"eXIf", &data), "a", None).unwrap();
        assert!([17, 19].contains(&picture.columns));
    }
}

#[test]
fn the_page_of_full_size_is_the_scan() {
    let web = web();
    let small: Vec<u16> =
        web.chunks(COLUMNS).step_by(4).flat_map(|row| row.iter().copied().step_by(4)).collect();
    let copy: &[(Tag, u16)] = &[(Tag::NewSubfileType, 1)];
    let larger = web.iter().flat_map(|level| [*level; 2]).collect::<Vec<_>>();
    let full = || page(COLUMNS, &web, 8, &[]);
    let several = "the file has several images, and only the first of the largest is used";
    for (name, pages, more) in [
        ("a thumbnail in front", vec![page(45, &small, 8, copy), full()], false),
        ("a thumbnail behind", vec![full(), page(45, &small, 8, copy)], false),
        ("a thumbnail of the older kind", vec![page(45, &small, 8, &[(Tag::SubfileType, 2)]), full()], false),
        ("a mask as large", vec![page(COLUMNS, &web, 8, &[(Tag::NewSubfileType, 4)]), full()], false),
        ("an enlarged copy", vec![page(2 * COLUMNS, &larger, 8, copy), full()], false),
        ("a small page in front", vec![page(45, &small, 8, &[]), full()], true),
        ("a stack", vec![full(), page(COLUMNS, &vec![200; web.len()], 8, &[])], true),
        ("one page that says it is a copy", vec![page(COLUMNS, &web, 8, copy)], false),
    ] {
        let found = found(&tiff_of_pages(&pages));
        assert_eq!([found.map.columns, found.map.rows], [180, 240], "{name}");
        let texture = found.clouds.as_ref().unwrap().texture_md().mean;
        assert!((cv(&found) - 0.15381).abs() < 5e-6, "{name}: {}", cv(&found));
        assert!((texture - 0.841).abs() < 5e-4, "{name}: {texture}");
        assert_eq!(says(&found, several), more, "{name}: {:?}", found.notes);
    }
}
