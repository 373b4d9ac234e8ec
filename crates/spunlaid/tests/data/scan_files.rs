//! Files of scans: what is read, what is refused and how, and that broken bytes do no harm.

use crate::scans::{
    Page, npy, npy_f64, png, png_of_resolution, png8, png16, tiff, tiff_f32, tiff_of_pages,
    tiff_of_resolution, tiff8, tiff16, with_chunk,
};
use png::Unit;
use proptest::prelude::*;
use spunlaid_ground::{Dimension, FileError};
use spunlaid_web::scan::{analyse, parse, read};
use spunlaid_web::{Light, Picture, Settings};
use std::path::Path;
use tiff::encoder::colortype::{Gray32, GrayI16, RGB8};
use tiff::tags::{ResolutionUnit, Tag};

pub(crate) const SIDE: usize = 24;

/// Levels of a small picture, all different from their neighbours.
fn level(i: usize) -> u8 {
    (100 + (i * i + 7 * i) % 97) as u8
}

pub(crate) fn levels<T>(change: impl Fn(u8) -> T) -> Vec<T> {
    (0..SIDE * (SIDE + 8)).map(|i| change(level(i))).collect()
}

fn parsed(bytes: &[u8]) -> Picture {
    parse(bytes, "a", 1e-3).unwrap()
}

#[test]
fn every_format_gives_the_same_picture() {
    let numbers = levels(f64::from);
    let rows = numbers.chunks(SIDE).map(|row| row.iter().map(f64::to_string).collect::<Vec<_>>());
    let csv: String = rows.map(|row| row.join(";") + "\n").collect();
    let shape = format!("({}, {SIDE})", SIDE + 8);
    let bytes = |encoded: fn(u8) -> Vec<u8>| levels(encoded).concat();
    let rgb: Vec<u8> = levels(|x| [x, x, x]).concat();
    for (name, file, full_scale) in [
        ("PNG", png8(SIDE, &levels(|x| x)), Some(255.0)),
        ("PNG of 16 bits", png16(SIDE, &levels(u16::from)), Some(65535.0)),
        ("PNG in colours", png(SIDE, png::ColorType::Rgb, png::BitDepth::Eight, &rgb), Some(255.0)),
        ("TIFF", tiff8(SIDE, &levels(|x| x)), Some(255.0)),
        ("TIFF of 16 bits", tiff16(SIDE, &levels(u16::from)), Some(65535.0)),
        ("TIFF of 32 bits", tiff::<Gray32>(SIDE, &levels(u32::from)), Some(4_294_967_295.0)),
        ("TIFF of floats", tiff_f32(SIDE, &levels(f32::from)), None),
        ("TIFF in colours", tiff::<RGB8>(SIDE, &rgb), Some(255.0)),
        ("NumPy", npy_f64(SIDE, &numbers), None),
        ("NumPy f4", npy("<f4", "False", &shape, &bytes(|x| f32::from(x).to_le_bytes().into())), None),
        ("NumPy >f8", npy(">f8", "False", &shape, &bytes(|x| f64::from(x).to_be_bytes().into())), None),
        ("NumPy u1", npy("|u1", "False", &shape, &levels(|x| x)), Some(255.0)),
        (
            "NumPy >u2",
            npy(">u2", "False", &shape, &bytes(|x| u16::from(x).to_be_bytes().into())),
            Some(65535.0),
        ),
        ("NumPy i8", npy("<i8", "False", &shape, &bytes(|x| i64::from(x).to_le_bytes().into())), None),
        ("CSV", csv.clone().into_bytes(), None),
        ("CSV with commas", csv.replace(';', ",").into_bytes(), None),
    ] {
        let picture = parsed(&file);
        assert_eq!(
            (picture.columns, picture.rows, picture.full_scale),
            (SIDE, SIDE + 8, full_scale),
            "{name}"
        );
        let far = picture.values.iter().zip(&numbers).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(far < 1e-9, "{name}: {far}");
        assert_eq!(picture.colour, name.contains("colours"), "{name}");
    }
    let picture = parsed(&npy_f64(SIDE, &numbers));
    let turned = picture.clone().turned();
    assert_eq!((turned.columns, turned.rows, turned.values[3]), (SIDE + 8, SIDE, picture.values[3 * SIDE]));
    assert_eq!(turned.turned(), picture);
}

#[test]
fn rejects_what_is_no_scan() {
    let wide = [vec!["1.0000000"; 9000].join(","), "\n".to_owned()].concat().repeat(20);
    // A picture of four thousand million pixels in a hundred bytes.
    let mut bomb = png8(SIDE, &levels(|x| x));
    bomb[16..24].copy_from_slice(&[0, 1, 0, 0, 0, 1, 0, 0]);
    let checksum = crc32fast::hash(&bomb[12..29]).to_be_bytes();
    bomb[29..33].copy_from_slice(&checksum);
    let data = [0; 8 * SIDE * SIDE];
    for (file, said) in [
        (
            b"\xff\xd8\xff\xe0 and so on".to_vec(),
            "is a JPEG image, which loses the fine structure; save the scan as PNG or TIFF",
        ),
        (b"PK\x03\x04".to_vec(), "is a ZIP archive"),
        (Vec::new(), "contains no rows of numbers; is it the right file?"),
        (png8(SIDE, &levels(|x| x))[..200].to_vec(), "cannot be decoded: "),
        (tiff16(SIDE, &levels(u16::from))[..200].to_vec(), "cannot be decoded: "),
        (bomb, "has 65536 × 65536 pixels; at most 67108864 are read, so cut out a part of the image"),
        (npy("<f8", "False", "(1000000, 1000000)", &data), "has 1000000 × 1000000 pixels"),
        (npy("<f8", "False", "(18446744073709551615, 3)", &data), "has 3 × 18446744073709551615 pixels"),
        (png8(9, &[7; 900]), "has 9 × 100 pixels; at least 16 are needed in each direction"),
        (
            npy("<f8", "False", "(24, 8, 3)", &data),
            "has the shape (24, 8, 3), which cannot be read; save a map of two dimensions",
        ),
        (
            npy("<f2", "False", "(24, 24)", &data),
            "has numbers of the kind <f2, which cannot be read; save map.astype(\"float32\")",
        ),
        (npy("<f8", "False", "(24, 25)", &data), "ends where the numbers of the array should follow"),
        (
            npy("<f8", "False", "(24, 24)", &data)[..40].to_vec(),
            "ends where the header of the array should follow",
        ),
        (tiff::<GrayI16>(SIDE, &levels(i16::from)), "has signed numbers, which cannot be read"),
        (
            wide.into_bytes(),
            "a:1: this row is longer than 65536 bytes, the limit for a table; save so wide a map as NumPy array (.npy)",
        ),
        (b"1,2,3\n4,5\n".to_vec(), "a:2: this row has 2 cells and needs 3"),
    ] {
        let error = parse(&file, "a", 1e-3).unwrap_err().to_string();
        assert!(error.starts_with("a:") && error.contains(said), "{error}\nwhere wanted: {said}");
    }
    let nowhere = read(Path::new("nowhere.png"), 1e-3).unwrap_err().to_string();
    assert_eq!(
        nowhere,
        "nowhere.png: there is no such file; name a scan of a web, an image (PNG or TIFF), a NumPy array \
        (.npy) or a table (.csv)"
    );
    let pixel = parse(&png8(SIDE, &levels(|x| x)), "a", 0.0).unwrap_err().to_string();
    assert_eq!(pixel, "a: cannot have pixels of 0 m; give the side of a pixel, a length above zero");
}

fn refused(file: &[u8], change: impl Fn(&mut Settings)) -> String {
    let light = Light::Transmitted { mean: None, white: None };
    let mut settings = Settings::new(light);
    change(&mut settings);
    let error: FileError = analyse(&parsed(file), &settings).unwrap_err();
    error.to_string()
}

#[test]
fn rejects_pictures_of_no_web_and_settings_that_do_not_fit() {
    let scan = png8(SIDE, &levels(|x| x));
    let white = |white| {
        move |settings: &mut Settings| settings.light = Light::Transmitted { mean: None, white: Some(white) }
    };
    let weight = |settings: &mut Settings| settings.light = Light::Weight { mean: None };
    for (said, wanted) in [
        (
            refused(&png8(SIDE, &[200; 24 * 24]), |_| {}),
            "has the same value everywhere; is it the right file?",
        ),
        (
            refused(&png8(SIDE, &levels(|x| if x % 9 == 0 { 0 } else { x })), |_| {}),
            "pixels of 768 that are black or without a value; at most one in a hundred can be filled from \
            its neighbours; let more light",
        ),
        (refused(&scan, white(100.0)), "is no darker than the lamp without web: its mean grey level is "),
        (
            refused(&scan, white(-1.0)),
            "cannot be read with a level of the lamp = -1; give a number above zero",
        ),
        (refused(&scan, white(f64::NAN)), "cannot be read with a level of the lamp = NaN"),
        (refused(&scan, |settings| settings.noise = Some(0.0)), "cannot be read with a noise = 0"),
        (
            refused(&scan, |settings| settings.noise = Some(80.0)),
            "than the noise of the camera alone, 80 as you gave it,",
        ),
        (
            refused(&scan, |settings| settings.patches = vec![2e-3, 0.5]),
            "has no patches of 500 mm; they can have sides from a pixel, 1 mm, to the shorter side of the \
            image, 24 mm",
        ),
        (refused(&scan, |settings| settings.patches = vec![0.2e-3]), "has no patches of 200 µm"),
        (refused(&scan, |settings| settings.patches = vec![f64::NAN]), "has no patches of NaN m"),
        (
            refused(&scan, |settings| settings.lamp = Some(parsed(&png8(16, &[9; 320])))),
            "has 24 × 32 pixels, but the image of the lamp without web has 16 × 20; take both",
        ),
        (
            refused(&npy_f64(SIDE, &levels(|x| f64::from(x) - 150.0)), weight),
            "that are negative or without a value; at most one in a hundred can be filled from its neighbours; cut out",
        ),
        (
            refused(&scan, |settings| settings.light = Light::Weight { mean: Some(-1.0) }),
            "a mean basis weight [kg/m²] = -1",
        ),
    ] {
        assert!(said.starts_with("a: ") && said.contains(wanted), "{said}\nwhere wanted: {wanted}");
    }
}

fn light() -> Light {
    Light::Transmitted { mean: None, white: None }
}

#[test]
fn what_was_assumed_is_reported() {
    let mut levels = levels(|x| x);
    (levels[5], levels[77], levels[78]) = (0, 255, 255);
    let transmitted = |white| Settings::new(Light::Transmitted { mean: None, white });
    let notes = |settings: &Settings| analyse(&parsed(&png8(SIDE, &levels)), settings).unwrap().notes;
    let texts = |settings: &Settings| notes(settings).iter().map(ToString::to_string).collect::<Vec<_>>();
    let found = texts(&transmitted(None));
    let lamp =
        "the lamp without web is assumed to have the grey level 255, the largest that the file can hold. ";
    assert!(found[0].starts_with(lamp), "{}", found[0]);
    assert!(found[1].starts_with("the mean basis weight is not known, "), "{}", found[1]);
    for words in
        ["pixels that are black or have no value: 1; ", "pixels of the largest grey level: 2 (0.26 %); "]
    {
        assert!(found.iter().any(|note| note.starts_with(words)), "{words}: {found:#?}");
    }
    let lighter = "pixels lighter than the lamp without web: 2 (0.26 %); they count as empty; ";
    assert!(texts(&transmitted(Some(230.0))).iter().any(|note| note.starts_with(lighter)));
    assert!(found.iter().all(|note| !note.contains("  ") && !note.ends_with('.')), "{found:#?}");
    let heavy = analyse(
        &parsed(&npy_f64(SIDE, &[1.0, 2.0].repeat(300)[..576])),
        &Settings::new(Light::Weight { mean: None }),
    );
    let note = heavy.unwrap().notes[0].to_string();
    assert_eq!(note, "the values are taken as basis weights in kg/m², with a mean of 1.5 kg/m²");
}

#[test]
fn a_pixel_is_as_large_as_the_file_says() {
    let levels = levels(|x| x);
    let png = |sides, unit| png_of_resolution(SIDE, &levels, sides, unit);
    let tiff = |unit, per| tiff_of_resolution(SIDE, &levels, unit, per);
    for (name, file, wanted) in [
        ("PNG", png([11811; 2], Unit::Meter), 25.4e-3 / 300.0),
        ("TIFF in inches", tiff(ResolutionUnit::Inch, [600, 1]), 25.4e-3 / 600.0),
        ("TIFF in centimetres", tiff(ResolutionUnit::Centimeter, [500, 2]), 10e-3 / 250.0),
    ] {
        let picture = parse(&file, "a", None).unwrap();
        assert!((picture.pixel / wanted - 1.0).abs() < 1e-4, "{name}: {} {wanted}", picture.pixel);
        let notes = |pixel: Option<f64>| {
            let found = analyse(&parse(&file, "a", pixel).unwrap(), &Settings::new(light()));
            found.unwrap().notes[0].to_string()
        };
        let side = Dimension::Length.pretty_to(picture.pixel, 4);
        let own = notes(None);
        assert!(own.starts_with(&format!("a pixel is {side} wide, as the file says (")), "{name}: {own}");
        assert!(notes(Some(1.005 * wanted)).starts_with("the lamp without web is assumed"), "{name}");
        let other = format!("a pixel is taken to be 100 µm wide, as you said, but the file says {side}");
        assert_eq!(notes(Some(0.1e-3)), other, "{name}");
    }
    let assumed = analyse(&parse(&png([3780; 2], Unit::Meter), "a", None).unwrap(), &Settings::new(light()));
    let note = assumed.unwrap().notes[0].to_string();
    let words = "a pixel is 264.6 µm wide, as the file says (96 dots per inch); many programs write this";
    assert!(note.starts_with(words), "{note}");

    for (name, file, wanted) in [
        ("no resolution", png8(SIDE, &levels), "a: does not say how large its pixels are"),
        ("no unit", png([3; 2], Unit::Unspecified), "a: does not say how large its pixels are"),
        ("none in TIFF", tiff(ResolutionUnit::None, [300, 1]), "a: does not say how large its pixels are"),
        (
            "nothing by nothing",
            tiff(ResolutionUnit::Inch, [0, 0]),
            "a: does not say how large its pixels are",
        ),
        ("no pixels to a metre", png([0; 2], Unit::Meter), "a: does not say how large its pixels are"),
        (
            "oblong",
            png([4000, 8000], Unit::Meter),
            "a: says that its pixels are 250 µm wide and 125 µm high; ",
        ),
    ] {
        let said = parse(&file, "a", None).unwrap_err().to_string();
        assert!(said.starts_with(wanted), "{name}: {said}");
        assert!(parse(&file, "a", 1e-3).is_ok(), "{name}");
    }
}

/// Files of all formats.
fn files() -> [Vec<u8>; 9] {
    let wide = levels(u16::from);
    let page = |tags| Page { columns: SIDE, levels: &wide, bits: 16, tags };
    let turned = [(Tag::Orientation, 6), (Tag::MaxSampleValue, 255)];
    // Exif data with an orientation of 6.
    let exif = b"II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0";
    [
        tiff_of_pages(&[page(&[(Tag::NewSubfileType, 1)]), page(&turned)]),
        with_chunk(&with_chunk(&png16(SIDE, &wide), b"eXIf", exif), b"sBIT", &[8]),
        (0..SIDE)
            .map(|row| {
                levels(|x| x)[..SIDE].iter().fold(row.to_string(), |line, x| format!("{line},{x}")) + "\n"
            })
            .collect::<String>()
            .into(),
        png8(SIDE, &levels(|x| x)),
        png16(SIDE, &levels(u16::from)),
        tiff16(SIDE, &levels(u16::from)),
        tiff_f32(SIDE, &levels(f32::from)),
        npy_f64(SIDE, &levels(f64::from)),
        levels(f64::from)
            .chunks(SIDE)
            .map(|row| format!("{row:?}\n").replace(['[', ']'], ""))
            .collect::<String>()
            .into(),
    ]
}

/// `numpy.save` of `numpy.asfortranarray(map)`: the numbers of a column stand one after the other.
#[test]
fn an_array_in_the_order_of_fortran_is_the_same_map() {
    let (columns, rows) = (SIDE, SIDE + 4);
    let number = |row: usize, column: usize| (row * columns + column) as f64 * 1e-3 + 1.0;
    let by_rows: Vec<f64> = (0..rows * columns).map(|i| number(i / columns, i % columns)).collect();
    let by_columns = (0..rows * columns).flat_map(|i| number(i % rows, i / rows).to_le_bytes());
    let fortran = npy("<f8", "True", &format!("({rows}, {columns})"), &by_columns.collect::<Vec<u8>>());
    let read = |file: &[u8]| parse(file, "map.npy", 1e-3).unwrap();
    let (found, wanted) = (read(&fortran), read(&npy_f64(columns, &by_rows)));
    assert_eq!((found.columns, found.rows), (columns, rows));
    assert_eq!(found.values, wanted.values);
}

/// Floating-point numbers have no largest level, and the brightest pixel is no lamp.
#[test]
fn rejects_light_of_floats_without_a_level_of_the_lamp() {
    let picture = parse(&tiff_f32(SIDE, &levels(f32::from)), "scan.tif", 0.1e-3).unwrap();
    for light in
        [Light::Transmitted { mean: None, white: None }, Light::Reflected { mean: None, white: None }]
    {
        let said = analyse(&picture, &Settings::new(light)).unwrap_err().to_string();
        assert!(
            said.contains("holds numbers without a largest grey level")
                && said.contains("give the level of the lamp"),
            "{said}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn broken_bytes_are_read_or_refused(
        which in 0..9usize,
        at_head in any::<bool>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..12),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let mut file = files()[which].clone();
        for (place, byte) in changes {
            // Most of what can break stands at the ends of a file.
            let among = if at_head { 120.min(file.len()) } else { file.len() };
            let at = place.index(among);
            file[at] = byte;
        }
        if let Some(cut) = cut {
            file.truncate(cut.index(file.len()));
        }
        let read = parse(&file, "a", 1e-3).and_then(|picture| {
            assert_eq!(picture.values.len(), picture.columns * picture.rows);
            for light in [Light::Transmitted { mean: None, white: None }, Light::Weight { mean: Some(0.02) }] {
                let found = analyse(&picture, &Settings { patches: vec![2e-3], ..Settings::new(light) })?;
                assert!(found.map.basis_weight() > 0.0 && found.patches[0].patch_cv.cv >= 0.0);
                assert!(found.notes.iter().all(|note| note.to_string().lines().count() == 1));
            }
            Ok(())
        });
        if let Err(error) = read {
            let said = error.to_string();
            prop_assert!(said.lines().count() == 1 && !said.contains(char::is_control), "{said:?}");
        }
    }
}

#[test]
fn a_lamp_lighter_than_the_file_can_hold_is_refused() {
    let file = tiff8(SIDE, &levels(|x| x));
    let said =
        refused(&file, |settings| settings.light = Light::Transmitted { mean: None, white: Some(300.0) });
    assert!(said.contains("255") && said.contains("300"), "{said}");
}

#[test]
fn a_picture_of_the_lamp_may_be_of_another_depth() {
    let light = Light::Transmitted { mean: None, white: None };
    let picture = parsed(&tiff8(SIDE, &levels(|x| x)));
    let found = |lamp: &[u8]| {
        let settings = Settings { lamp: Some(parsed(lamp)), keep_spots: true, ..Settings::new(light) };
        let settings = Settings { patches: vec![2e-3], ..settings };
        analyse(&picture, &settings).unwrap().patches[0].patch_cv.cv
    };
    let of_8_bits = found(&tiff8(SIDE, &levels(|_| 220)));
    let of_16_bits = found(&tiff16(SIDE, &levels(|_| 220 * 257)));
    assert!((of_16_bits / of_8_bits - 1.0).abs() < 1e-12, "{of_16_bits} for {of_8_bits}");
}
