//! What a changed web says at each look, in the turbulence of a pinned one: its time as a share of that of the whole
//! web, and whether the changes are off by as much as their errors say.

use crate::title;
use spunlaid::experiment::Change;
use spunlaid::experiment::advice::{LOOKS, PinnedWeb, Seen};
use spunlaid::ground::{Difference, Isa, RunContext};
use spunlaid::input::{Changes, Overrides, WebSpec, read_changes, read_web};
use spunlaid::simulation::Flyer;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64};

/// Side of the patches that are looked at [m].
const SIDE: f64 = 10e-3;

/// One flight: times since it began [s], and what was seen.
#[derive(Default)]
struct Flown {
    /// The first point, and each look.
    first: f64,
    times: Vec<f64>,
    /// The CV of a pinned web with its error, or the change, at each look.
    found: Vec<Difference>,
}

/// `cargo run --release --example validation looks [AIRS] FILE`: times, and the scatter of changes over their errors.
pub fn shares() {
    let words: Vec<String> = std::env::args().skip(2).collect();
    let airs: u64 = words.iter().find_map(|word| word.parse().ok()).unwrap_or(6);
    let file = words.iter().find(|word| word.ends_with(".toml")).expect("the file of a line");
    let file = Path::new(file);
    let spec = read_web(file, &[]).expect("it is read").spec;
    let changes = read_changes(file, Overrides::from(&[]), Changes::OfLine).expect("it is read");
    let larger: Vec<&Change> =
        changes.iter().filter(|change| change.refusal.is_none()).skip(1).step_by(2).collect();
    title("looks at changed webs in the turbulence of the pinned one");
    let begun = processor_time();
    let stop = AtomicBool::new(false);
    let mut web = Flyer::new(1, &stop, &|_, work| work()).web(&spec).expect("it flies");
    let done = AtomicU64::new(0);
    web.find(RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &done }).expect("it is laid");
    let whole = processor_time() - begun;
    println!("the whole web: {whole:.1} s");
    let mut pinned = Vec::new();
    let mut changed: Vec<Vec<Flown>> = larger.iter().map(|_| Vec::new()).collect();
    for seed in 1..=airs {
        let in_air = |spec: &WebSpec| WebSpec { seed, ..spec.clone() };
        let (simulated, web) = watch(|see, by| PinnedWeb::fly(&in_air(&spec), see, by));
        pinned.push(simulated);
        let Some(web) = web else { continue };
        for (change, all) in larger.iter().zip(&mut changed) {
            let spec = in_air(&change.experiment.spec);
            all.push(watch(|see, by| web.compare(&spec, see, by)).0);
        }
    }
    show("pinned", &pinned, whole);
    for (change, all) in larger.iter().zip(&changed) {
        show(change.setting.name, all, whole);
    }
}

/// Processor time of this thread, in which everything flies [s]: the machine may be busy.
fn processor_time() -> f64 {
    let counted = std::fs::read_to_string("/proc/thread-self/schedstat").expect("Linux counts it");
    counted.split(' ').next().and_then(|first| first.parse::<f64>().ok()).expect("a number") * 1e-9
}

/// Flies once and keeps what is seen.
fn watch<T>(
    fly: impl FnOnce(&mut dyn FnMut(Seen), RunContext<'_>) -> Result<T, spunlaid::ground::Error>,
) -> (Flown, Option<T>) {
    let (begun, mut simulated) = (processor_time(), Flown::default());
    let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
    let mut see = |seen: Seen| match seen {
        Seen::Laid(stretch)
            if simulated.first == 0.0 && stretch.filaments.iter().any(|points| !points.is_empty()) =>
        {
            simulated.first = processor_time() - begun;
        }
        Seen::Laid(_) => {}
        Seen::Look(look) => {
            simulated.times.push(processor_time() - begun);
            let is_side = |patch: f64| (patch / SIDE - 1.0).abs() < 1e-6;
            let cv = look.cvs.iter().find(|cv| is_side(cv.patch));
            let cv = cv.map(|cv| Difference {
                value: cv.cv,
                standard_error: cv.standard_error.unwrap_or(f64::NAN),
                degrees: f64::INFINITY,
            });
            let change =
                look.changes.iter().find(|change| is_side(change.of)).map(|change| change.difference);
            simulated.found.extend(cv.or(change));
        }
    };
    let by = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &done };
    let found = fly(&mut see, by);
    if let Err(error) = &found {
        println!("{error}");
    }
    (simulated, found.ok())
}

/// Times as shares of the whole web's, means with their errors, and how far off the airs are from the mean of all.
fn show(name: &str, all: &[Flown], whole: f64) {
    let mean_of = |numbers: Vec<f64>| numbers.iter().sum::<f64>() / numbers.len() as f64;
    let first = mean_of(all.iter().map(|simulated| simulated.first).collect());
    print!("{name}: first point {:.1} %", 100.0 * first / whole);
    let last = |simulated: &Flown| simulated.found.get(LOOKS.len() - 1).map(|found| found.value);
    let best = mean_of(all.iter().filter_map(last).collect());
    for (look, area) in LOOKS.iter().enumerate() {
        let found: Vec<Difference> =
            all.iter().filter_map(|simulated| simulated.found.get(look).copied()).collect();
        let time = mean_of(all.iter().filter_map(|simulated| simulated.times.get(look).copied()).collect());
        let value = mean_of(found.iter().map(|found| found.value).collect());
        let error = mean_of(found.iter().map(|found| found.standard_error.powi(2)).collect());
        let off = |found: &Difference| ((found.value - best) / found.standard_error).powi(2);
        let z = mean_of(found.iter().map(off).collect());
        print!(
            " | {area} m²: {:.1} %, {:+.2} ± {:.2} %, z {:.2} ({} airs)",
            100.0 * time / whole,
            100.0 * value,
            100.0 * error.sqrt(),
            z.sqrt(),
            found.len()
        );
    }
    println!();
}
