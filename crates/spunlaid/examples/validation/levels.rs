//! What two levels save: errors of webs in shared turbulence with and without coarse sheets, against the scatter of
//! seeds.

use crate::title;
use cpu_time::ProcessTime;
use spunlaid::ground::{Isa, RunContext};
use spunlaid::input::read_web;
use spunlaid::simulation::{Flyer, WantedError, WebSpec};
use spunlaid_simulation::Flown;
use spunlaid_web::Sheet;
use std::sync::atomic::{AtomicBool, AtomicU64};

/// Sides of the patches that are looked at [m].
const SIDES: [f64; 4] = [5e-3, 10e-3, 20e-3, 50e-3];
/// The error that is wanted.
const WANTED: f64 = 0.025;

/// A filament of 2 dtex in air that slows down, on a way of half a metre.
const FILAMENT: &str = r#"version = 1
[fibre]
diameter = "16.8 µm"
density = "905 kg/m³"
youngs_modulus = "1.9 GPa"
element_length = "4 mm"
root = "clamped"
[feed]
speed = "41.7 m/s"
[belt]
distance = "300 mm"
speed = "2.08 m/s"
[air]
velocity = "50 m/s"
turbulence_intensity = 0.1
length_scale = "16 mm"
cutoff_frequency = "700 Hz"
[drag]
across = "marheineke-wegener"
[run]
duration = "1 s"
[web]
width = "1 m"
length = "1 m"
cell = "1 mm"
"#;

/// Lines of several kinds, by what they have beside the filament.
const LINES: [(&str, &str); 4] = [
    ("a slot of 20 mm", "[line]\nfilaments_per_metre = 5000\nslot_gap = \"20 mm\"\n"),
    ("a slot of 60 mm", "[line]\nfilaments_per_metre = 5000\nslot_gap = \"60 mm\"\n"),
    ("a row", "[line]\nrows = [{ pitch = \"0.5 mm\", filaments = 2000 }]\n"),
    (
        "two layers",
        "[[layer]]\n[layer.line]\nfilaments_per_metre = 3000\nslot_gap = \"20 mm\"\n\
         [[layer]]\n[layer.line]\nfilaments_per_metre = 3000\nslot_gap = \"20 mm\"\n",
    ),
];

/// The CV and its whole error over each of [`SIDES`], and the processor time that they took [s].
struct Found {
    cvs: Vec<[f64; 2]>,
    time: f64,
}

impl Found {
    fn row(&self) -> String {
        let of_side = |[cv, error]: &[f64; 2]| format!("{:.2} ± {:.2}", 100.0 * cv, 100.0 * error);
        format!("{} %, {:.1} s", self.cvs.iter().map(of_side).collect::<Vec<_>>().join(", "), self.time)
    }
}

fn find(spec: &WebSpec) -> Found {
    let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
    let by = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &done };
    let begun = ProcessTime::now();
    let mut web = Flyer::new(1, &stop, &|_, work| work()).web(spec).expect("it flies");
    let found = web.find(by).expect("it is laid");
    let time = begun.elapsed().as_secs_f64();
    let of_side = |side: &f64| {
        let patch = found.patches.iter().find(|patch| (patch.map.patch / side - 1.0).abs() < 1e-6);
        patch
            .and_then(|patch| Some([patch.reported()?.cv, patch.total_error().whole()?]))
            .unwrap_or([f64::NAN; 2])
    };
    Found { cvs: SIDES.iter().map(of_side).collect(), time }
}

/// Of each line: the mean of CV over the seeds, its scatter over the error, and error² × time, of one sheet and of two
/// levels. `cargo run --release --example validation levels [SEEDS] [FILE | LINE]`
///
/// With the word `bias`: [`print_bias`].
pub fn savings() {
    let mut words: Vec<String> = std::env::args().skip(2).collect();
    let is_bias = words.iter().any(|word| word == "bias");
    words.retain(|word| word != "bias");
    let seeds: u64 = words.iter().find_map(|word| word.parse().ok()).unwrap_or(6);
    words.retain(|word| word.parse::<u64>().is_err());
    let file = words.iter().find(|word| word.ends_with(".toml"));
    let lines: Vec<(String, WebSpec)> = match file {
        Some(file) => {
            let spec = read_web(std::path::Path::new(file), &[]).expect("it is read").spec;
            vec![(file.clone(), spec)]
        }
        None => LINES
            .iter()
            .filter(|(name, _)| words.iter().all(|word| name.contains(word)))
            .map(|(name, line)| {
                let text = format!("{FILAMENT}{line}");
                (name.to_string(), read_web((text.as_str(), "line.toml"), &[]).expect("it is read").spec)
            })
            .collect(),
    };
    if is_bias {
        return lines.iter().for_each(|(name, spec)| print_bias(name, spec, seeds));
    }
    title("webs in one air: one sheet | two levels (mean CV, scatter over error, error² × time as a ratio)");
    for (name, spec) in lines {
        let (mut one, mut two) = (Vec::new(), Vec::new());
        // One after the other for each seed, so that both meet the same load of the machine.
        for seed in 1..=seeds {
            let of = |error| find(&WebSpec { seed, error, ..spec.clone() });
            one.push(of(WantedError::OfOneSheet));
            two.push(of(WantedError::Of(WANTED)));
            // Each seed at once, because all of them take long.
            let last = [&one, &two].map(|found| found.last().map(Found::row).unwrap_or_default());
            println!("  seed {seed}: {}", last.join(" | "));
        }
        let times = [&one, &two].map(|found| found.iter().map(|of| of.time).sum::<f64>() / seeds as f64);
        println!("{name}: {:.1} s | {:.1} s", times[0], times[1]);
        for (number, side) in SIDES.iter().enumerate() {
            let numbers = [&one, &two].map(|found| {
                let count = found.len() as f64;
                let mean = found.iter().map(|of| of.cvs[number][0]).sum::<f64>() / count;
                let scatter =
                    found.iter().map(|of| (of.cvs[number][0] - mean).powi(2)).sum::<f64>() / (count - 1.0);
                let error = found.iter().map(|of| of.cvs[number][1].powi(2)).sum::<f64>() / count;
                [mean, scatter, error]
            });
            let [[mean, scatter, error], [of_two, scatter_of_two, error_of_two]] = numbers;
            println!(
                "  {:2.0} mm: {:.2} % ± {:.2}, {:.2} | {:.2} % ± {:.2}, {:.2} | {:.1}",
                1e3 * side,
                100.0 * mean,
                100.0 * error.sqrt(),
                (scatter / error).sqrt(),
                100.0 * of_two,
                100.0 * error_of_two.sqrt(),
                (scatter_of_two / error_of_two).sqrt(),
                error * times[0] / (error_of_two * times[1])
            );
        }
    }
}

/// Filaments per metre that are simulated of all.
const SOME: [u64; 3] = [250, 500, 1000];
/// A web that is one sheet.
const SHEET: [f64; 2] = [0.4, 0.5];

/// The CV over patches of a side, from the simulated filaments.
#[derive(Clone, Copy)]
struct OfSide {
    cv: f64,
    /// Its error by the number of filaments.
    by_pitch: f64,
    /// What CV has where those between them are filled in.
    of_map: f64,
}

/// Of one sheet, how far the CV from some of its filaments is from that of all in the same air, and the error that it
/// has for that; then how far the map is in which the others are filled in. In per cent of the CV of all.
fn print_bias(name: &str, spec: &WebSpec, seeds: u64) {
    let of = |seed: u64, simulated: Flown| {
        let sheet = Sheet { width: SHEET[0], length: SHEET[1], ..spec.sheet.clone() };
        let web = WebSpec { seed, error: WantedError::OfOneSheet, simulated, sheet, ..spec.clone() };
        let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
        let by = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &done };
        let mut found = Flyer::new(1, &stop, &|_, work| work()).web(&web).expect("it is simulated");
        let found = found.find(by).expect("it is laid");
        SIDES.map(|side| {
            let is_side = |patch: f64| (patch / side - 1.0).abs() < 1e-6;
            let patch = found.patches.iter().find(|found| is_side(found.map.patch)).expect("a patch");
            match patch.few {
                Some(few) => OfSide { cv: few.cv, by_pitch: few.by_pitch, of_map: patch.of_map },
                None => OfSide { cv: patch.of_map, by_pitch: 0.0, of_map: patch.of_map },
            }
        })
    };
    println!("{name}: {SIDES:?} m");
    for seed in 1..=seeds {
        let all = of(seed, Flown::All);
        println!("  seed {seed}, all filaments: {:.2?} %", all.map(|of| 100.0 * of.cv));
        for some in SOME {
            let off = of(seed, Flown::PerMetre(some)).into_iter().zip(&all).map(|(some, all)| {
                let [cv, by_pitch, of_map] =
                    [some.cv - all.cv, some.by_pitch, some.of_map - all.cv].map(|off| 100.0 * off / all.cv);
                format!("{cv:+.1} ± {by_pitch:.1} ({of_map:+.1})")
            });
            println!("    {some:4} per metre: {}", off.collect::<Vec<_>>().join(", "));
        }
    }
}
