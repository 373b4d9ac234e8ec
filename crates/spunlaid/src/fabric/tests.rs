//! Fabrics of which the answers are known.

#![allow(clippy::unwrap_used, clippy::indexing_slicing)]

use super::*;
use crate::scan::{Format, Light, Picture, Settings, analyse};
use crate::statistics::{Estimate, NORMAL_95};
use crate::web::uniformity::unevenness;
use crate::web::{Canvas, Edges, Map, Sheet, straight_fibres};
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use std::f64::consts::PI;

const DIAMETER: f64 = 18e-6;

struct Random(SplitMix64);

impl Random {
    fn new(seed: u64) -> Self {
        Self(SplitMix64::seed_from_u64(seed))
    }

    /// From above 0 to 1.
    fn uniform(&mut self) -> f64 {
        ((self.0.next_u64() >> 11) as f64 + 1.0) / 9_007_199_254_740_992.0
    }

    fn exponential(&mut self) -> f64 {
        -libm::log(self.uniform())
    }

    fn normal(&mut self) -> f64 {
        (2.0 * self.exponential()).sqrt() * libm::cos(2.0 * PI * self.uniform())
    }

    /// Of mean 1, with the coefficient of variation 1/√shape.
    fn gamma(&mut self, shape: usize) -> f64 {
        (0..shape).map(|_| self.exponential()).sum::<f64>() / shape as f64
    }

    /// Straight lines at random, as they cross a square about which they go on, with this length per area.
    fn lines(&mut self, side: f64, length: f64) -> Vec<[[f64; 2]; 2]> {
        let radius = side * std::f64::consts::FRAC_1_SQRT_2;
        // Of a Poisson process: the gaps between lines are exponential.
        let mut sum = self.exponential();
        let mut lines = Vec::new();
        while sum < 2.0 * length * radius {
            let (angle, off) = (PI * self.uniform(), radius * (2.0 * self.uniform() - 1.0));
            let half = (radius * radius - off * off).max(0.0).sqrt();
            let [x, y] = [libm::cos(angle), libm::sin(angle)];
            let end = |along: f64| [0.5 * side - y * off + x * along, 0.5 * side + x * off + y * along];
            lines.push([end(-half), end(half)]);
            sum += self.exponential();
        }
        lines
    }

    /// The holes of a square of straight fibres at random.
    fn holes(&mut self, side: f64, length: f64) -> WindowHoles {
        let margin = 0.25e-3;
        let lines = self.lines(side + 2.0 * margin, length);
        let piece = |[from, to]: [[f64; 2]; 2]| {
            let [from, to] = [from, to].map(|end| end.map(|at| at - margin));
            Piece { from, to, half_width: 0.5 * DIAMETER }
        };
        count_holes(side, margin, &lines.into_iter().map(piece).collect::<Vec<_>>())
    }
}

fn map(sides: [usize; 2], cell: f64, weight: impl FnMut(usize) -> f64) -> Map {
    let weights: Vec<f64> = (0..sides[0] * sides[1]).map(weight).collect();
    let cells = weights.into_iter().map(|weight| (1e6 * weight).max(0.0).round() as u32).collect();
    Map { columns: sides[0], rows: sides[1], cell, quantum: 1e-12, closed: [false; 2], cells }
}

/// Straight fibres at random, each of so many that lie one upon the other.
fn random_fibres(seed: u64, bundle: u32) -> (Map, f64) {
    let (side, length) = (0.15, 20e3);
    let sheet = Sheet { edges: Edges::Cut, ..Sheet::new(side, side, 0.5e-3) };
    let canvas = Canvas::new(&sheet, &[1e-6], 1e-2).unwrap();
    let quanta = canvas.quanta(1e-6);
    // A piece has its quanta whatever its length, so each line is cut into pieces of one length.
    let step = 1e-3;
    for [from, to] in Random::new(seed).lines(side, length / f64::from(bundle)) {
        let whole = libm::hypot(to[0] - from[0], to[1] - from[1]);
        let at = |along: f64| [0, 1].map(|axis| from[axis] + along / whole * (to[axis] - from[axis]));
        for i in 0..(whole / step) as usize {
            (0..bundle).for_each(|_| canvas.draw(at(i as f64 * step), at((i + 1) as f64 * step), quanta));
        }
    }
    (canvas.finish().unwrap().map, length)
}

/// Distance of a number with an error from what is expected, in errors.
fn off(known: Known, expected: f64) -> f64 {
    match known {
        Known::Value(value, Some(error)) => (value - expected).abs() / error,
        other => panic!("{other:?} has no error"),
    }
}

#[test]
fn stat_straight_fibres_at_random_have_a_formation_number_of_one() {
    for bundle in [1, 4] {
        let (map, length) = random_fibres(3, bundle);
        for side in [2, 4, 10, 20] {
            let found = unevenness(&map, side).unwrap();
            let number = formation(&found, straight_fibres(length, found.patch));
            assert!(off(number, f64::from(bundle)) < 3.0, "{bundle} of {side}: {number:?}");
        }
    }
}

/// The map of a web, read as that of a gauge: what follows from a map is the same.
#[test]
fn identical_a_map_that_is_laid_and_one_that_is_measured() {
    let (map, length) = random_fibres(3, 1);
    let titre = 0.25 * PI * DIAMETER * DIAMETER * 910.0;
    let picture = Picture {
        file: "gauge.npy".to_owned(),
        format: Format::Npy,
        values: map.cells.iter().map(|quanta| f64::from(*quanta)).collect(),
        columns: map.columns,
        rows: map.rows,
        pixel: map.cell,
        pixel_of_file: None,
        full_scale: None,
        fewer_bits: None,
        weight_of_black: None,
        colour: false,
        more: false,
        numbered: [false; 2],
    };
    let light = Light::Weight { mean: Some(length * titre) };
    let found = |titre| of_scan(&analyse(&picture, &Settings { titre, ..Settings::new(light) }).unwrap());
    let [known, unknown] = [Some(titre), None].map(found);
    for scanned in [&known, &unknown] {
        assert!(scanned.holes.is_none() && scanned.stiffness_ratio.is_none() && scanned.air.is_none());
        assert_eq!(scanned.notes.len(), 1, "{:?}", scanned.notes);
        for (patch, side) in scanned.patches.iter().zip([2, 4, 10, 20]) {
            let laid = thin_places(&map, side).unwrap();
            let values = |thin: &ThinPlaces| thin.quantiles.map(Known::value);
            for (one, other) in values(&laid).into_iter().zip(values(&patch.thin)) {
                // A pixel is a whole number of millionths of the mean weight.
                assert!((one / other - 1.0).abs() < 1e-5, "{side}: {one} {other}");
            }
        }
    }
    assert!(unknown.patches.iter().all(|patch| patch.formation.is_none()));
    assert!(unknown.notes[0].contains("titre") && !known.notes[0].contains("titre"));
    // Where blur may have lowered a CV, it has no error; the tests beside this one ask for it within errors.
    for patch in &known.patches {
        let number = patch.formation.unwrap().value();
        assert!((number - 1.0).abs() < 0.1, "{}: {number}", patch.thin.patch);
    }
}

/// Holes per area, and their error.
fn per_area(windows: &[WindowHoles], radius: f64) -> Known {
    let number = |window: &WindowHoles| {
        window.holes.iter().filter(|hole| hole.radius >= radius).count() as f64 / window.area
    };
    Known::of(&Estimate::new(windows.iter().map(number).collect()))
}

#[test]
fn stat_holes_between_straight_fibres_at_random() {
    let (mut random, length) = (Random::new(1), 20e3);
    let windows: Vec<WindowHoles> = (0..60).map(|_| random.holes(2e-3, length)).collect();
    for (radius, expected) in [(30e-6, 26.8e6), (60e-6, 8.06e6), (90e-6, 2.43e6)] {
        let formula = expected_holes(length, DIAMETER, radius);
        assert!((formula / expected - 1.0).abs() < 3e-3, "{formula}");
        let found = per_area(&windows, radius);
        assert!(off(found, formula) < 3.0, "{radius}: {found:?} {formula}");
    }
    let bare = Known::of(&Estimate::new(windows.iter().map(|window| window.bare).collect()));
    assert!(off(bare, libm::exp(-length * DIAMETER)) < 3.0, "{bare:?}");
}

/// Of fibres whose length per area has a Gamma distribution of the coefficient of variation c.
#[test]
fn stat_holes_of_a_cloudy_fabric() {
    let (mut random, length, shape) = (Random::new(2), 20e3, 4);
    let windows: Vec<WindowHoles> = (0..160)
        .map(|_| {
            let local = length * random.gamma(shape);
            random.holes(1e-3, local)
        })
        .collect();
    let squared = 1.0 / shape as f64;
    for radius in [30e-6, 60e-6, 90e-6] {
        let load = length * (2.0 * radius + DIAMETER) * squared;
        let power = -(shape as f64) - 2.0;
        let formula = length * length / PI * (1.0 + squared) * libm::pow(1.0 + load, power);
        let found = per_area(&windows, radius);
        assert!(off(found, formula) < 3.0, "{radius}: {found:?} {formula}");
    }
}

/// Windows in some places of a cloudy fabric tell the holes of all of it.
#[test]
fn stat_holes_carried_from_windows_to_the_sheet() {
    let (mut random, mean, cell) = (Random::new(4), 20e3, 10e-3);
    let sheet = map([10, 10], cell, |_| random.gamma(8));
    let lengths: Vec<f64> =
        sheet.cells.iter().map(|quanta| mean * f64::from(*quanta) * 1e2 / sheet.total() as f64).collect();
    let window = |i: usize| {
        let corner = [i % 10, i / 10].map(|number| (number as f64 + 0.4) * cell);
        (corner, random.holes(2e-3, lengths[i]))
    };
    let windows: Vec<([f64; 2], WindowHoles)> = (0..100).step_by(2).map(window).collect();
    let local = LocalLength::new(&sheet, mean);
    let found = carry(&windows, &local, DIAMETER, 1e-2).unwrap();
    let over = |of: &dyn Fn(f64) -> f64| lengths.iter().map(|length| of(*length)).sum::<f64>() / 100.0;
    let bare = over(&|length| libm::exp(-length * DIAMETER));
    assert!(off(found.bare, bare) < 3.5, "{:?} {bare}", found.bare);
    let mut carried = 0;
    for holes in &found.radii {
        let expected = over(&|length| expected_holes(length, DIAMETER, holes.radius));
        match holes.per_area {
            Known::Between([low, high]) => {
                carried += 1;
                // The chance of single fibres in patches of 10 mm is a part in two hundred.
                assert!(low < 1.1 * expected && expected < 1.1 * high, "{holes:?} {expected}");
            }
            number => assert!(off(number, expected) < 3.5, "{holes:?} {expected}"),
        }
    }
    assert!((1..RADII.len()).contains(&carried), "{found:?}");
    let number = |radius: f64| over(&|length| expected_holes(length, DIAMETER, radius));
    let Known::Between([low, high]) = found.largest else { panic!("{:?}", found.largest) };
    assert!(number(low) > 0.9 * std::f64::consts::LN_2 / 1e-2, "{low}");
    assert!(number(high) < 1.1 * std::f64::consts::LN_2 / 1e-2, "{high}");
    assert!(high < 2.0 * low, "{low} {high}");
}

/// A square between four fibres, and a long one whose largest disc lies beyond the window.
#[test]
fn analytic_the_holes_of_a_lattice() {
    let (half, pitch, side) = (0.5 * DIAMETER, 0.2e-3, 1e-3);
    // Not along the rows of pixels: both families of fibres meet each side of the window in the same way as
    // the one across from it.
    let directions = [[0.8, 0.6], [-0.6, 0.8]];
    let fibre = |i: i32, normal: [f64; 2], along: [f64; 2]| {
        let at = (f64::from(i) + 0.37) * pitch;
        let [from, to] = [-3e-3, 3e-3].map(|by| [0, 1].map(|axis| at * normal[axis] + by * along[axis]));
        Piece { from, to, half_width: half }
    };
    let [a, b] = directions;
    let pieces: Vec<Piece> = (-15..20).flat_map(|i| [fibre(i, a, b), fibre(i, b, a)]).collect();
    let found = count_holes(side, 0.5e-3, &pieces);
    assert!((found.bare - (1.0 - DIAMETER / pitch).powi(2)).abs() < 0.002, "{}", found.bare);
    assert_eq!(found.holes.len(), 25);
    for hole in &found.holes {
        assert!((hole.radius - (0.5 * pitch - half)).abs() < 0.2e-6, "{hole:?}");
    }
    let empty = count_holes(side, 0.5e-3, &[]);
    assert_eq!((empty.bare, empty.holes.len()), (1.0, 1));
}

#[test]
fn stat_thin_places_of_normal_weights() {
    let (mut random, cv) = (Random::new(5), 0.2);
    let sheet = map([400, 400], 1e-3, |_| 1.0 + cv * random.normal());
    let found = thin_places(&sheet, 1).unwrap();
    // Shares of a normal distribution below −2.5, −1.5 and −1 deviations.
    for (number, share) in found.lighter.iter().zip([0.006_210, 0.066_807, 0.158_655]) {
        assert!(off(*number, share * 1e6) < 3.5, "{number:?} {share}");
    }
    assert!(off(found.heavier, 0.066_807e6) < 3.5, "{:?}", found.heavier);
    for (quantile, deviations) in found.quantiles.iter().zip([-2.326_35, -1.644_85, 0.0, 1.644_85, 2.326_35])
    {
        assert!(off(*quantile, 1.0 + cv * deviations) < 3.5, "{quantile:?}");
    }
    let even = thin_places(&map([100, 100], 1e-3, |_| 1.0), 5).unwrap();
    assert_eq!(even.heavier, Known::AtMost(300.0));
    assert_eq!(even.lighter, [Known::AtMost(300.0); 3]);
}

/// A web of normal cells with the streak of one blocked hole.
fn streaked(random: &mut Random, depth: f64, noise: f64) -> (Map, [StreakSource; 1]) {
    let (cell, columns, spread) = (1e-3, 600, 9e-3);
    let place = 0.2503;
    let profile = |column: usize| {
        let off = ((column as f64 + 0.5) * cell - place) / spread;
        1.0 - depth * libm::exp(-0.5 * off * off)
    };
    let map = map([columns, 320], cell, |i| profile(i % columns) + noise * random.normal());
    // Of the mean weight of 1 kg/m² in these units.
    let weight = 1e6 * map.weight_of_quantum();
    let missing = depth * (2.0 * PI).sqrt() * spread * weight;
    (map, [StreakSource { missing: vec![(place, missing)], spread, until: f64::INFINITY }])
}

#[test]
fn analytic_the_dip_of_a_blocked_hole() {
    let (even, source) = streaked(&mut Random::new(8), 0.02, 0.0);
    let found = &streaks(&even, 0.0, &source)[0];
    // A band of 2.8 σ holds erf(1.4/√2) of a normal profile.
    let expected = 0.02 * (2.0 * PI).sqrt() * libm::erf(1.4 * std::f64::consts::FRAC_1_SQRT_2) / 2.8;
    assert!((found.dip / expected - 1.0).abs() < 0.01, "{} {expected}", found.dip);
    assert!((found.found.unwrap().value() / found.dip - 1.0).abs() < 0.01, "{found:?}");
    // The same where the hole is blocked in the second half of the sheet only, which lies at its beginning.
    let half = [StreakSource { until: 0.16, ..source[0].clone() }];
    let found = &streaks(&even, 0.0, &half)[0];
    assert!((found.found.unwrap().value() / found.dip - 1.0).abs() < 0.01, "{found:?}");
}

/// Even webs are beyond the bounds of 95 % once in twenty, and the length that is told makes a dip as large
/// as its bound.
#[test]
fn stat_streaks_of_even_webs_and_of_a_defect() {
    let mut random = Random::new(9);
    let (_, mut even) = streaked(&mut random, 0.01, 0.0);
    even[0].missing[0].1 = 0.0;
    let off_by = |map: &Map, source: &[StreakSource]| off(streaks(map, 0.0, source)[0].found.unwrap(), 0.0);
    let beyond = (0..200).filter(|_| off_by(&streaked(&mut random, 0.0, 0.3).0, &even) > NORMAL_95).count();
    // Binomial: 10 ± 3.1.
    assert!((2..20).contains(&beyond), "{beyond}");
    let (map, source) = streaked(&mut random, 0.01, 0.3);
    let found = &streaks(&map, 0.0, &source)[0];
    // The variance of the mean of a band of 25 mm over a length L, 0.09 mm²/(25 mm · L).
    let expected = NORMAL_95.powi(2) * 0.09 * 1e-6 / (25e-3 * found.dip.powi(2));
    let length = found.length.unwrap();
    assert!(off(length, expected) < 3.0, "{length:?} {expected}");
}

const STRIP: StripSize = StripSize { width: 50e-3, length: 200e-3, section: 5e-3 };

#[test]
fn analytic_the_weakest_sections_of_even_strips() {
    for strips in strips(&map([400, 400], 1e-3, |_| 1.0), STRIP) {
        let strips = strips.unwrap();
        assert_eq!((strips.count, strips.weakest), (16, Known::Value(1.0, Some(0.0))));
    }
    // Filaments that are one curve: rows differ, so strips along MD are all alike, and sections along CD.
    let waves = map([400, 400], 1e-3, |i| 1.0 + 0.3 * libm::sin((i / 400) as f64 * 2.0 * PI / 100.0));
    let [md, cd] = strips(&waves, STRIP).map(Option::unwrap);
    assert!(md.scatter.unwrap().value() < 1e-12, "{:?}", md.scatter);
    assert!(md.weakest.value() < 0.72 && (cd.weakest.value() - 1.0).abs() < 1e-12);
}

/// Of forty independent sections with a deviation σ, the lightest is 2.16 σ below the mean.
#[test]
fn stat_the_weakest_of_forty_sections() {
    let (mut random, sigma) = (Random::new(6), 0.05);
    let cells_of_section = 250.0_f64;
    let sheet = map([800, 800], 1e-3, |_| 1.0 + sigma * cells_of_section.sqrt() * 0.25 * random.normal());
    for strips in strips(&sheet, STRIP) {
        let strips = strips.unwrap();
        let found = (1.0 - strips.weakest.value()) / strips.sections.value();
        assert_eq!(strips.count, 64);
        assert!((found / 2.16 - 1.0).abs() < 0.1, "{found}");
        assert!(strips.low.unwrap().value() < strips.weakest.value());
    }
    assert!(strips(&map([100, 100], 1e-3, |_| 1.0), STRIP).iter().all(Option::is_none));
}
