//! Maps with bare strips beside the web, and maps whose edge is only thinner.

use crate::scans::{light, npy_f64, piece, tiff_f32, waves, web};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use spunlaid_web::scan::{Findings, analyse, parse};
use spunlaid_web::{Light, Picture, Settings};

const COLUMNS: usize = 160;
const ROWS: usize = 180;
const PIXEL: f64 = 0.1e-3;

/// Whether a place is bare.
type IsBare = Box<dyn Fn(usize, usize) -> bool>;

/// A map of 20 g/m², changed at each place.
fn map(change: impl Fn(usize, usize, f64) -> f64) -> Vec<f64> {
    let web = waves(COLUMNS, ROWS, 4);
    web.iter().enumerate().map(|(at, weight)| change(at % COLUMNS, at / COLUMNS, 20e-3 * weight)).collect()
}

fn found_in(picture: &Picture, keep_spots: bool) -> Findings {
    let settings =
        Settings { patches: vec![2e-3], keep_spots, ..Settings::new(Light::Weight { mean: None }) };
    analyse(picture, &settings).unwrap()
}

fn found(values: &[f64]) -> Findings {
    found_in(&parse(&npy_f64(COLUMNS, values), "a", PIXEL).unwrap(), false)
}

/// Mean [g/m²] and CV [%].
fn numbers(found: &Findings) -> [f64; 2] {
    [1e3 * found.map.basis_weight(), 100.0 * found.patches[0].patch_cv.cv]
}

fn says(found: &Findings) -> bool {
    found.notes.iter().any(|note| note.message.contains("is bare along its edges"))
}

#[test]
fn analytic_a_bare_strip_beside_the_web_is_cut_off() {
    let whole = found(&map(|_, _, weight| weight));
    let mut random = ChaCha8Rng::seed_from_u64(1);
    // Noise of a gauge that sees nothing: a normal number of one per cent of the web, none below zero.
    let noise: Vec<f64> = (0..COLUMNS * ROWS)
        .map(|_| {
            let sum: f64 = (0..12).map(|_| (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64).sum();
            (0.2e-3 * (sum - 6.0)).max(0.0)
        })
        .collect();
    let wide = |left: usize, right: usize, top: usize, bottom: usize| {
        move |x: usize, y: usize| x < left || x + right >= COLUMNS || y < top || y + bottom >= ROWS
    };
    // Turned by two degrees.
    let skewed = |x: usize, y: usize| (x as f64) < 3.0 + 0.035 * y as f64;
    let strips: [(&str, IsBare); 9] = [
        ("left", Box::new(wide(10, 0, 0, 0))),
        ("one column", Box::new(wide(1, 0, 0, 0))),
        ("two columns at the right", Box::new(wide(0, 2, 0, 0))),
        ("both", Box::new(wide(10, 10, 0, 0))),
        ("top", Box::new(wide(0, 0, 14, 0))),
        ("bottom", Box::new(wide(0, 0, 0, 25))),
        ("all around", Box::new(wide(8, 11, 6, 9))),
        ("a third", Box::new(wide(52, 0, 0, 0))),
        ("skewed", Box::new(skewed)),
    ];
    for (name, is_bare) in &strips {
        for (kind, level) in [("zero", None), ("noise", Some(&noise))] {
            let at = |x: usize, y: usize| level.map_or(0.0, |noise| noise[y * COLUMNS + x]);
            let values = map(|x, y, weight| if is_bare(x, y) { at(x, y) } else { weight });
            let found = found(&values);
            let [left, top] = found.aside.corner;
            let [columns, rows] = [found.map.columns, found.map.rows];
            // The same piece of the web, cut out by hand.
            let plain = map(|_, _, weight| weight);
            let piece = plain.chunks(COLUMNS).skip(top).take(rows).flat_map(|row| &row[left..left + columns]);
            let piece = npy_f64(columns, &piece.copied().collect::<Vec<_>>());
            let truth = numbers(&found_in(&parse(&piece, "a", PIXEL).unwrap(), false));
            let ([mean, cv], [of_piece, cv_of_piece]) = (numbers(&found), truth);
            assert!((mean / of_piece - 1.0).abs() < 1e-9, "{name}, {kind}: {mean} for {of_piece}");
            assert!((cv / cv_of_piece - 1.0).abs() < 1e-9, "{name}, {kind}: {cv} for {cv_of_piece}");
            assert!(says(&found), "{name}, {kind}: {:?}", found.notes);
            // No bare cell is left, and no more than a few lines of web are lost.
            assert!(
                (top..top + rows).all(|y| (left..left + columns).all(|x| !is_bare(x, y))),
                "{name}, {kind}"
            );
            let bare = (0..COLUMNS * ROWS).filter(|at| is_bare(at % COLUMNS, at / COLUMNS)).count();
            let most = if *name == "skewed" { 12 } else { 5 };
            let lost = COLUMNS * ROWS - bare - columns * rows;
            assert!(lost <= most * (COLUMNS + ROWS), "{name}, {kind}: {lost} pixels are lost");
        }
    }
    // In a floating-point TIFF alike; who says that the strip is web keeps it.
    let values = map(|x, _, weight| if x < 20 { 0.0 } else { weight });
    let of_tiff =
        parse(&tiff_f32(COLUMNS, &values.iter().map(|x| *x as f32).collect::<Vec<_>>()), "a", PIXEL).unwrap();
    assert!(says(&found_in(&of_tiff, false)));
    let kept = found_in(&of_tiff, true);
    assert!(!says(&kept) && kept.aside.cut_off == 0.0 && numbers(&kept)[1] > 2.0 * numbers(&whole)[1]);
}

#[test]
fn a_thin_edge_a_hole_and_an_open_web_are_web() {
    let edge = |x: usize| x.min(COLUMNS - 1 - x) as f64;
    let maps: [(&str, Vec<f64>); 6] = [
        ("even", map(|_, _, weight| weight)),
        ("neck-in", map(|x, _, weight| weight * (0.4 + 0.6 * (edge(x) / 20.0).min(1.0)))),
        ("a cut edge", map(|x, _, weight| weight * (1.0 - 0.88 * (-edge(x) / 6.0).exp()))),
        ("heavy edges", map(|x, _, weight| weight * (1.0 + (-edge(x) / 6.0).exp()))),
        ("a hole", map(|x, y, weight| if x < 12 && y.abs_diff(60) < 25 { 0.0 } else { weight })),
        ("a hole in the middle", map(|x, y, w| if x.abs_diff(80) + y.abs_diff(80) < 20 { 0.0 } else { w })),
    ];
    for (name, values) in &maps {
        let found = found(values);
        assert!(!says(&found) && found.aside.cut_off == 0.0, "{name}: {:?}", found.notes);
    }
    // Webs whose cells are smaller than their holes, from a few fibres to many.
    for (filaments, cell) in [(40.0, 0.5e-3), (150.0, 0.5e-3), (600.0, 0.25e-3), (3000.0, 0.25e-3)] {
        let open = piece(&web([0.1, 0.1], cell, 5e-3, filaments, false, 2), [0, 0], [180, 160]);
        let empty = open.cells.iter().filter(|cell| **cell == 0).count();
        let weights: Vec<f64> =
            open.cells.iter().map(|cell| f64::from(*cell) * open.weight_of_quantum()).collect();
        let found = found_in(&parse(&npy_f64(180, &weights), "a", cell).unwrap(), false);
        assert!(!says(&found) && found.aside.cut_off == 0.0, "{filaments}, {empty} empty: {:?}", found.notes);
    }
}

/// Light that a web on a black ground throws back: the ground beside it is bare too.
#[test]
fn the_black_ground_beside_the_web_is_cut_off() {
    let level = |x: usize, weight: f64| if x < 15 { 2e-4 } else { 0.6 * weight / (0.02 + weight) };
    let values = map(|x, _, weight| level(x, weight));
    let picture = parse(&npy_f64(COLUMNS, &values), "a", PIXEL).unwrap();
    let light = Light::Reflected { mean: None, white: Some(0.6) };
    let settings = Settings { patches: vec![2e-3], keep_shading: true, ..Settings::new(light) };
    let found = analyse(&picture, &settings).unwrap();
    assert!(says(&found) && (15..20).contains(&found.aside.corner[0]), "{:?}", found.notes);
}

/// A scan that was turned is black around it.
#[test]
fn a_black_frame_of_a_scan_is_cut_off() {
    let frame = |x: usize, y: usize| x < 9 || y >= ROWS - 12;
    let level = |x: usize, y: usize, weight: f64| if frame(x, y) { 0.0 } else { (-40.0 * weight).exp() };
    let picture = parse(&npy_f64(COLUMNS, &map(level)), "a", PIXEL).unwrap();
    let light = Light::Transmitted { mean: None, white: Some(1.0) };
    let settings = Settings { patches: vec![2e-3], keep_shading: true, ..Settings::new(light) };
    let found = analyse(&picture, &settings).unwrap();
    assert_eq!([found.map.columns, found.map.rows], [COLUMNS - 10, ROWS - 13]);
    assert!(
        found.notes.iter().any(|note| note.message.contains("is black along its edges")),
        "{:?}",
        found.notes
    );
}

/// A map has no blur of a camera, so patches of few cells have an interval.
#[test]
fn a_map_is_not_blurred_by_a_camera() {
    let map = piece(&web([0.2, 0.25], 1e-3, 10e-3, 3000.0, false, 6), [0, 0], [200, 250]);
    let patches = vec![1e-3, 3e-3];
    let of = |light: Light, values: &[f64]| {
        let settings = Settings { patches: patches.clone(), keep_shading: true, ..Settings::new(light) };
        analyse(&parse(&npy_f64(200, values), "a", 1e-3).unwrap(), &settings).unwrap()
    };
    let weights: Vec<f64> = map.cells.iter().map(|cell| f64::from(*cell) * map.weight_of_quantum()).collect();
    let of_weights = of(Light::Weight { mean: None }, &weights);
    let of_light = of(Light::Transmitted { mean: None, white: Some(1.0) }, &light(&map));
    for (weighed, seen) in of_weights.patches.iter().zip(&of_light.patches) {
        assert!(
            weighed.blur.is_none() && weighed.interval.is_ok() && weighed.patch_cv.standard_error.is_some()
        );
        assert!(seen.blur.is_some() && seen.interval.is_err(), "{seen:?}");
    }
    assert!(!of_weights.notes.iter().any(|note| note.message.contains("blur")), "{:?}", of_weights.notes);
}

/// Light through a web of the density one, or thrown back by it, in levels of 16 bits, with an even lid around it.
struct Lid {
    light: Light,
    level: f64,
    noise: f64,
    /// Columns and rows of the lid on each side.
    wide: [usize; 2],
    /// By how many columns the web is turned from its first to its last row.
    skew: f64,
}

impl Lid {
    fn is_beside(&self, x: usize, y: usize) -> bool {
        let [across, along] = self.wide;
        let shift = self.skew * y as f64 / ROWS as f64;
        let x = x as f64 - shift;
        x < across as f64 || x >= (COLUMNS - across) as f64 || y < along || y >= ROWS - along
    }

    fn levels(&self) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut normal =
            || (0..12).map(|_| (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64).sum::<f64>() - 6.0;
        let level = |x: usize, y: usize, weight: f64| {
            let web = match self.light {
                Light::Transmitted { .. } => 50e3 * (-50.0 * weight).exp(),
                _ => 60e3 * weight / (0.02 + weight),
            };
            let noise = self.noise * normal();
            if self.is_beside(x, y) { (self.level + noise).max(0.0) } else { web }
        };
        let mut level = level;
        let web = waves(COLUMNS, ROWS, 4);
        (0..web.len()).map(|at| level(at % COLUMNS, at / COLUMNS, 20e-3 * web[at]).round()).collect()
    }
}

/// A lid of any level, with or without noise, on all sides or above and below, turned or not: it is cut off, and what
/// is left is what the same rectangle alone gives with the level of the lamp that is known by construction.
#[test]
fn analytic_a_lid_of_one_level_around_the_web_is_cut_off() {
    let through = Light::Transmitted { mean: None, white: None };
    let back = Light::Reflected { mean: None, white: Some(60e3) };
    let lids = [
        ("bare lamp", Lid { light: through, level: 50e3, noise: 150.0, wide: [16, 20], skew: 0.0 }),
        ("bare lamp, turned", Lid { light: through, level: 50e3, noise: 150.0, wide: [12, 12], skew: 6.0 }),
        ("without noise", Lid { light: through, level: 50e3, noise: 0.0, wide: [16, 20], skew: 0.0 }),
        ("black lid", Lid { light: through, level: 900.0, noise: 90.0, wide: [16, 20], skew: 0.0 }),
        ("white lid", Lid { light: back, level: 58e3, noise: 200.0, wide: [16, 20], skew: 0.0 }),
        ("white lid, turned", Lid { light: back, level: 58e3, noise: 200.0, wide: [12, 12], skew: -5.0 }),
        ("above and below", Lid { light: back, level: 58e3, noise: 200.0, wide: [0, 20], skew: 0.0 }),
        ("black ground", Lid { light: back, level: 700.0, noise: 200.0, wide: [16, 20], skew: 0.0 }),
    ];
    for (name, lid) in lids {
        let levels = lid.levels();
        let read = |columns: usize, levels: &[f64]| parse(&npy_f64(columns, levels), "a", PIXEL).unwrap();
        let is_lamp = lid.light == through && lid.level > 20e3;
        // A black lid does not show the level of the lamp.
        let light = if is_lamp { through } else { known(lid.light) };
        let settings = Settings { patches: vec![1e-3], ..Settings::new(light) };
        let found =
            analyse(&read(COLUMNS, &levels), &settings).unwrap_or_else(|error| panic!("{name}: {error}"));
        let [left, top] = found.aside.corner;
        let [columns, rows] = [found.map.columns, found.map.rows];
        assert!((top..top + rows).all(|y| (left..left + columns).all(|x| !lid.is_beside(x, y))), "{name}");
        let kept = (columns * rows) as f64
            / (0..levels.len()).filter(|at| !lid.is_beside(at % COLUMNS, at / COLUMNS)).count() as f64;
        assert!(kept > 0.8, "{name}: {kept} of the web is left");
        let part: Vec<f64> =
            (top..top + rows).flat_map(|y| levels[y * COLUMNS + left..][..columns].to_vec()).collect();
        let is_even = lid.level > 20e3 && lid.wide[0] > 0;
        let alone =
            Settings { keep_shading: is_even, patches: vec![1e-3], ..Settings::new(known(lid.light)) };
        let alone = analyse(&read(columns, &part), &alone).unwrap();
        let [cv, wanted] = [&found, &alone].map(|found| found.patches[0].patch_cv.cv);
        assert!((cv / wanted - 1.0).abs() < 0.01, "{name}: {cv} for {wanted}");
        assert_eq!(found.assumption, alone.assumption, "{name}");
    }
}

/// The same light with the level of the lamp that the scans here have.
fn known(light: Light) -> Light {
    match light {
        Light::Transmitted { mean, .. } => Light::Transmitted { mean, white: Some(50e3) },
        other => other,
    }
}

/// A scan that was broken off: what is missing is of one grey, or repeats the last line, at the bottom or at a side.
#[test]
fn analytic_the_rest_of_a_scan_that_was_not_finished_is_cut_off() {
    let scanned = 130;
    let web = map(|_, _, weight| (50e3 * (-50.0 * weight).exp()).round());
    let light = Light::Transmitted { mean: None, white: Some(50e3) };
    let settings = Settings { patches: vec![1e-3], keep_shading: true, ..Settings::new(light) };
    let numbers_of = |columns: usize, levels: &[f64]| {
        let found = analyse(&parse(&npy_f64(columns, levels), "a", PIXEL).unwrap(), &settings).unwrap();
        (found.patches[0].patch_cv.cv, found)
    };
    let grey = |at: usize| if at / COLUMNS < scanned { web[at] } else { 32_768.0 };
    let last_line = |at: usize| web[(at / COLUMNS).min(scanned - 1) * COLUMNS + at % COLUMNS];
    let last_column = |at: usize| web[at / COLUMNS * COLUMNS + (at % COLUMNS).min(scanned - 1)];
    let scan = |level: &dyn Fn(usize) -> f64| (0..web.len()).map(level).collect::<Vec<f64>>();
    let cases = [
        ("grey", scan(&grey), true),
        ("last line", scan(&last_line), true),
        ("last column", scan(&last_column), false),
    ];
    for (name, levels, is_row) in cases {
        let (cv, found) = numbers_of(COLUMNS, &levels);
        let (columns, rows) = if is_row { (COLUMNS, scanned) } else { (scanned, ROWS) };
        let lost = columns * rows - found.map.columns * found.map.rows;
        let of_line = if is_row { columns } else { rows };
        assert!(lost == 0 || lost == of_line, "{name}: {lost} pixels are lost");
        let [columns, rows] = [found.map.columns, found.map.rows];
        let part: Vec<f64> = (0..columns * rows).map(|i| web[i / columns * COLUMNS + i % columns]).collect();
        assert_eq!(cv, numbers_of(columns, &part).0, "{name}");
        assert!(found.notes.iter().any(|note| note.message.contains("not finished")), "{name}");
    }
}
