//! Scans: pieces of simulated webs, rendered as scans and read back.

use super::pictures::{PIXEL, beside, exposed, file, light, piece, spoiled, spotted, web};
use super::title;
use spunlaid::web::map::uniformity::patch_cv;
use spunlaid::web::scan::{Findings, analyse, parse};
use spunlaid::web::{Light, Map, Picture, Settings};

/// Columns and rows of a piece.
const SIZE: [usize; 2] = [400, 500];

fn picture(light: &[f64], seed: u64) -> Picture {
    parse(&file(SIZE[0], &exposed(SIZE, light, spotted, 65535.0, seed), 16), "scan", PIXEL)
        .expect("a picture")
}

/// What is found on a scan with a picture of the lamp.
fn found(light: &[f64], sides: &[usize], keep_spots: bool, seed: u64) -> Findings {
    let lamp = Some(picture(&vec![1.0; light.len()], seed + 50));
    let patches = sides.iter().map(|side| *side as f64 * PIXEL).collect();
    let settings = Settings {
        lamp,
        patches,
        keep_spots,
        ..Settings::new(Light::Transmitted { mean: None, white: None })
    };
    analyse(&picture(light, seed), &settings).expect("a web")
}

/// How many of the 95 % intervals of 72 pieces hold the CV of their web.
pub(crate) fn intervals() {
    title("scans with a picture of the lamp: pieces of 200 × 250 mm of 12 webs, spread 10 mm");
    for in_rows in [false, true] {
        let sides = [20, 40, 60, 100];
        let webs: Vec<Map> =
            (1..=12).map(|seed| web([1.2, 0.3], PIXEL, 10e-3, 5000.0, in_rows, seed)).collect();
        let truth = |side: usize| {
            let variance = |web: &Map| patch_cv(web, side).expect("an patch_cv").cv.powi(2);
            (webs.iter().map(variance).sum::<f64>() / webs.len() as f64).sqrt()
        };
        let pieces = webs.iter().zip(1..).flat_map(|(web, seed)| {
            (0..6).map(move |part| (piece(web, [SIZE[0] * part, 0], SIZE), 100 * seed + part as u64))
        });
        let all: Vec<Findings> = pieces.map(|(map, seed)| found(&light(&map), &sides, false, seed)).collect();
        for (i, side) in sides.into_iter().enumerate() {
            let truth = truth(side);
            let of = || all.iter().filter_map(|found| found.patches[i].interval.ok());
            let [below, above] =
                [of().filter(|ends| ends[1] < truth).count(), of().filter(|ends| ends[0] > truth).count()];
            let mean =
                all.iter().map(|found| found.patches[i].patch_cv.cv.powi(2)).sum::<f64>() / all.len() as f64;
            let ends = [0, 1].map(|end| {
                spunlaid::ground::statistics::median(&of().map(|ends| 100.0 * ends[end]).collect::<Vec<_>>())
            });
            println!(
                "  {} {:>2} mm: true {:.2} %, found {:.2} %, usual interval {:.2} to {:.2} %, {} of {} hold \
                it, {below} are below, {above} above",
                if in_rows { "rows" } else { "random places" },
                side as f64 * PIXEL * 1e3,
                100.0 * truth,
                100.0 * mean.sqrt(),
                ends[0],
                ends[1],
                of().count() - below - above,
                of().count()
            );
        }
    }
}

/// What bare lamp, blots and dust do to the CV, and what is left of it.
pub(crate) fn spots() {
    title("CV of a scan with what is no web, over that without it: kept, left out");
    let map = piece(&web([0.2, 0.25], PIXEL, 10e-3, 5000.0, true, 4), [0, 0], SIZE);
    let (clean, sides) = (light(&map), [10, 20, 40]);
    let truth = found(&clean, &sides, true, 4);
    for kind in ["edges", "blots", "dust"] {
        let spoiled = spoiled(kind, &clean, &beside(kind, SIZE));
        let [kept, left] = [true, false].map(|keep_spots| found(&spoiled, &sides, keep_spots, 4));
        for ((kept_patch, patch), truth) in kept.patches.iter().zip(&left.patches).zip(&truth.patches) {
            let ratio = |of: f64| of / truth.patch_cv.cv;
            println!(
                "  {kind}, {:>2} mm: {:.3}, {:.3}",
                patch.patch_cv.patch * 1e3,
                ratio(kept_patch.patch_cv.cv),
                ratio(patch.patch_cv.cv)
            );
        }
        println!(
            "  {kind}: {:.0} mm² cut off, {} spots of {:.0} mm²",
            left.aside.cut_off * 1e6,
            left.aside.spots.len(),
            left.aside.masked * 1e6
        );
    }
}
