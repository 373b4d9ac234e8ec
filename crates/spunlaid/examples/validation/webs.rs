//! Errors of small webs of each kind, against the scatter of many webs.

use crate::title;
use spunlaid::ground::statistics::interval_of_deviation;
use spunlaid::ground::{Isa, RunContext};
use spunlaid::web::map::uniformity::{PatchCv, unevenness_at};
use spunlaid::web::map::{Filaments, find, lay};
use spunlaid::web::{Clouds, Edges, Fibres, Layer, Map, Row, Sheet, Surrogate, Web};
use std::f64::consts::TAU;
use std::sync::atomic::{AtomicBool, AtomicU64};

/// Webs whose intervals are looked at; all of them give the truth.
const SEEDS: u64 = 80;
const WEBS: u64 = 240;
const CELL: f64 = 1e-3;
const SIDES: [usize; 6] = [1, 2, 5, 10, 20, 50];

fn web(filaments: Filaments, sizes: [f64; 2], edges: Edges) -> Web {
    let spunbond = Surrogate { sigma_md: 18.4e-3, sigma_cd: 18.3e-3, noise: 12.4 };
    Web {
        sheet: Sheet { edges, ..Sheet::new(sizes[0], sizes[1], CELL) },
        layers: vec![Layer {
            linear_density: 2.3e-7,
            feed_speed: 50.0,
            belt_speed: 3.86,
            filaments,
            fibres: Fibres::Surrogate(spunbond),
            defects: Vec::new(),
        }],
        seed: 0,
    }
}

fn rows(pitch: f64, filaments: u64) -> Filaments {
    Filaments::Rows(vec![Row::new(0.5 * pitch, pitch, filaments)])
}

/// The relative variance in waves of some lengths, by the definition: a plain Fourier sum over the whole closed sheet.
fn octaves(map: &Map, bands: &[[f64; 2]]) -> Vec<f64> {
    let mean = map.total() as f64 / map.cells.len() as f64;
    let [columns, rows] = [map.columns, map.rows];
    let turn = |size: usize| (0..size).map(|i| (TAU * i as f64 / size as f64).sin_cos()).collect::<Vec<_>>();
    let (across, along) = (turn(columns), turn(rows));
    let most = (1.0 / bands[0][0]).min(0.5 / map.cell);
    let reach = |size: usize| ((most * size as f64 * map.cell).ceil() as usize).min(size / 2);
    let mut sums = vec![0.0; bands.len()];
    for k in 0..=reach(columns) {
        let of_rows: Vec<[f64; 2]> = (0..rows)
            .map(|row| {
                let (mut re, mut im) = (0.0, 0.0);
                for (column, quanta) in map.row(row).iter().enumerate() {
                    let (sin, cos) = across[k * column % columns];
                    let value = f64::from(*quanta) / mean - 1.0;
                    (re, im) = (re + value * cos, im + value * sin);
                }
                [re, im]
            })
            .collect();
        for l in -(reach(rows) as i64)..=reach(rows) as i64 {
            let number = (k as f64 / columns as f64).hypot(l as f64 / rows as f64) / map.cell;
            let Some(band) = bands.iter().position(|of| (of[0]..of[1]).contains(&(1.0 / number))) else {
                continue;
            };
            let (mut re, mut im) = (0.0, 0.0);
            for (row, z) in of_rows.iter().enumerate() {
                let (sin, cos) = along[(l * row as i64).rem_euclid(rows as i64) as usize];
                (re, im) = (re + z[0] * cos - z[1] * sin, im + z[0] * sin + z[1] * cos);
            }
            let both = if k == 0 || 2 * k == columns { 1.0 } else { 2.0 };
            sums[band] += both * (re * re + im * im) / (map.cells.len() as f64).powi(2);
        }
    }
    sums
}

struct WebKind {
    name: &'static str,
    web: Web,
}

pub fn intervals() {
    let wide = [0.5, 0.5];
    let kinds = [
        WebKind {
            name: "random places",
            web: web(Filaments::AtRandom { per_metre: 2000.0 }, wide, Edges::Periodic),
        },
        WebKind {
            name: "random places, wide",
            web: web(Filaments::AtRandom { per_metre: 2000.0 }, [1.0, 0.25], Edges::Periodic),
        },
        WebKind { name: "rows, even", web: web(rows(0.5e-3, 1000), wide, Edges::Periodic) },
        WebKind { name: "rows, 50 mm apart", web: web(rows(50e-3, 10), wide, Edges::Periodic) },
        WebKind {
            name: "random places, cut",
            web: web(Filaments::AtRandom { per_metre: 2000.0 }, wide, Edges::Cut),
        },
        WebKind { name: "rows, cut", web: web(rows(0.5e-3, 1000), wide, Edges::Cut) },
    ];
    for kind in &kinds {
        title(&format!("Errors of webs: {}, {} webs", kind.name, SEEDS));
        of_kind(&kind.web);
    }
}

fn of_kind(web: &Web) {
    let (stop, laid) = (AtomicBool::new(false), AtomicU64::new(0));
    let by = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &laid };
    // The edges are as wide for every seed.
    let margins =
        find(&Web { sheet: Sheet { patches: vec![10.0 * CELL], ..web.sheet.clone() }, ..web.clone() }, by)
            .expect("a web")
            .margins;
    let [first, last] = margins.map(|margin| (margin / CELL).round() as usize);
    let mut found: Vec<Vec<PatchCv>> = vec![Vec::new(); SIDES.len()];
    let mut clouds: Vec<Vec<(f64, Option<f64>)>> = Vec::new();
    let mut truths: Vec<Vec<f64>> = Vec::new();
    let mut names: Vec<[f64; 2]> = Vec::new();
    for seed in 0..WEBS {
        let web = Web { seed, ..web.clone() };
        let whole = lay(&web, by).expect("a web").map;
        let map = whole.between(first..whole.columns - last);
        let places = web.places(map.columns as f64 * CELL);
        for (side, found) in SIDES.iter().zip(&mut found) {
            found.push(unevenness_at(&map, *side, &places).expect("an patch_cv"));
        }
        let of = Clouds::at(&map, &places, 2).expect("clouds");
        let octaves_of = of.octaves();
        names = vec![[5e-3, 50e-3]];
        names.extend(octaves_of.iter().map(|(band, _)| *band).filter(|band| band[0] > 7e-3));
        let mut values = vec![(of.cloudiness(5e-3, 50e-3))];
        values.extend(
            octaves_of.iter().filter(|(band, _)| band[0] > 7e-3).map(|(_, of)| (of.mean, of.standard_error)),
        );
        clouds.push(values);
        if seed < SEEDS && map.closed[0] {
            let mut bands = vec![[5e-3, 50e-3]];
            bands.extend(names[1..].iter().copied());
            let mut all = Vec::new();
            for band in bands {
                all.extend(octaves(&map, &[band]));
            }
            all[0] = all[0].sqrt();
            truths.push(all);
        }
    }
    println!("  patch     CV   scatter   mean s.e.  cover  skew");
    for (side, found) in SIDES.iter().zip(&found) {
        let count = found.len() as f64;
        let truth = (found.iter().map(|of| of.cv * of.cv).sum::<f64>() / count).sqrt();
        let mean = found.iter().map(|of| of.cv).sum::<f64>() / count;
        let scatter = (found.iter().map(|of| (of.cv - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt();
        let mut errors = 0.0;
        let mut held = 0;
        let mut known = 0;
        let mut correlation = [0.0; 3];
        for of in &found[..SEEDS as usize] {
            let Some(error) = of.standard_error else { continue };
            known += 1;
            errors += error;
            let [low, high] = of.interval().expect("an interval");
            held += u64::from((low..=high).contains(&truth));
        }
        let mean_error = errors / known as f64;
        for of in &found[..SEEDS as usize] {
            let Some(error) = of.standard_error else { continue };
            let (a, b) = (of.cv - mean, error - mean_error);
            correlation = [correlation[0] + a * b, correlation[1] + a * a, correlation[2] + b * b];
        }
        println!(
            "  {side:4}  {:7.3}  {:7.3}  {:7.3}  {held}/{known}  {:5.2}",
            100.0 * truth,
            100.0 * scatter,
            100.0 * mean_error,
            correlation[0] / (correlation[1] * correlation[2]).sqrt()
        );
    }
    println!("  waves (mm)   found   truth  scatter  mean s.e.  cover");
    for (i, name) in names.iter().enumerate() {
        let values: Vec<(f64, Option<f64>)> = clouds.iter().map(|of| of[i]).collect();
        let count = values.len() as f64;
        let mean = values.iter().map(|of| of.0).sum::<f64>() / count;
        let scatter = (values.iter().map(|of| (of.0 - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt();
        let truth = truths.iter().map(|of| of[i]).sum::<f64>() / truths.len() as f64;
        let mut errors = 0.0;
        let mut held = 0;
        let mut known = 0;
        for of in &values[..SEEDS as usize] {
            let Some(error) = of.1 else { continue };
            known += 1;
            errors += error;
            let power = if i == 0 { 1.0 } else { 0.5 };
            // A variance is the square of a deviation.
            let [low, high] = interval_of_deviation(of.0.powf(power), power * error * of.0.powf(power - 1.0));
            held += u64::from((low..=high).contains(&truth.powf(power)));
        }
        let scale = if i == 0 { 100.0 } else { 1e4 };
        println!(
            "  {:.0} to {:.0}  {:8.4} {:8.4}  {:8.4} {:8.4}  {held}/{known}",
            1e3 * name[0],
            1e3 * name[1],
            scale * mean,
            scale * truth,
            scale * scatter,
            scale * errors / known as f64
        );
    }
}
