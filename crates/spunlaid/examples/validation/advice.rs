//! Effects of changes and assumed values on the CV of three lines, as `spunlaid web` reports them, against long webs.
//!
//! All cores fly; a line takes some minutes of sixteen. `validation advice slot 4` looks at one of them, against four
//! long webs of each change.

use crate::title;
use spunlaid::experiment::advice::advise;
use spunlaid::experiment::{Change, SensitivityRun};
use spunlaid::ground::threads::par_map;
use spunlaid::ground::{Difference, Isa, RunContext};
use spunlaid::input::{Changes, Overrides, WebSpec, read_changes, read_web};
use spunlaid::simulation::Flyer;
use spunlaid::web::Web;
use spunlaid::web::map::{Findings, nearest_to_seen};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

/// Long webs of each change, unless a number is given.
const SEEDS: usize = 8;
/// One of them. It is wide enough for the filaments that spread most.
const LONG: [(&str, &str); 2] = [("web.width", "0.3 m"), ("web.length", "1 m")];

/// The air of spunbond.toml, and where the files of the lines are looked for.
const CASES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/web.toml");
const REST: &str =
    "[web]\nwidth = \"0.2 m\"\nlength = \"1 m\"\nassumed = \"none\"\n[run]\nduration = \"1 s\"\n";
/// The line of `docs/line.md`.
const SLOT: &str = r#"
version = 1
[line]
throughput = "0.5 g/min"
basis_weight = "20 g/m²"
filaments_per_metre = 5000
slot_gap = "20 mm"
[fibre]
linear_density = "2 dtex"
density = "905 kg/m³"
youngs_modulus = "1.9 GPa"
root = "clamped"
[belt]
distance = "500 mm"
[air]
profile = "tables/spunbond.csv"
widening = "md"
[drag]
across = "marheineke-wegener"
"#;
/// The row of `cases/web.toml`.
const ROW: &str = r#"
version = 1
[laydown]
case = "spunbond.toml"
[line]
rows = [{ pitch = "0.2 mm", filaments = 1000 }]
"#;
/// Thick and slow filaments from a slot in a shorter way of air with smaller eddies.
const THICK: &str = r#"
version = 1
[line]
filaments_per_metre = 3300
slot_gap = "15 mm"
[fibre]
diameter = "30 µm"
density = "1380 kg/m³"
youngs_modulus = "4 GPa"
root = "clamped"
[feed]
speed = "25 m/s"
[belt]
distance = "0.4 m"
speed = "2.5 m/s"
[air]
velocity = "20 m/s"
turbulence_intensity = 0.15
length_scale = "12 mm"
cutoff_frequency = "420 Hz"
[drag]
across = "marheineke-wegener"
"#;

/// What is reported of a change: its name, the CV over patches of 10 mm as a share of the web's, and whether it
/// is one of the best two.
struct Estimate {
    name: String,
    spec: WebSpec,
    change: Difference,
    is_named: bool,
}

/// Compares what is reported of the lines that are asked for with long webs.
pub fn changes() {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let asked = |name: &str| std::env::args().any(|word| word == name);
    let lines = [
        ("slot", SLOT, "line.slot_gap, air.intensity_factor, air.length_factor", "500"),
        ("row", ROW, "air.intensity_factor, air.length_factor", "500"),
        // Half of its filaments do not give the CV of all.
        ("thick", THICK, "line.slot_gap, air.turbulence_intensity", "990"),
    ];
    let all = !lines.iter().any(|(name, ..)| asked(name));
    let seeds = std::env::args().find_map(|word| word.parse().ok()).unwrap_or(SEEDS);
    let (mut within, mut count) = (0, 0);
    for (name, text, assumed_values, simulated) in lines.into_iter().filter(|(name, ..)| all || asked(name)) {
        title(&format!("Changes of a line: {name}, against {seeds} webs of 0.3 m × 1 m each"));
        let text = format!("{text}{}", REST.replace("none", assumed_values));
        let (base, estimated) = estimated(&text, threads);
        if asked("estimated") {
            continue;
        }
        let like = read(&format!("{SLOT}{REST}"), &[&LONG[..], &[("web.simulated", simulated)]].concat());
        let [held, compared] = compare(&base, &estimated, &like, seeds, threads);
        within += held;
        count += compared;
        println!(
            "  within two estimated errors: {held} of {compared}; of all lines so far {within} of {count}"
        );
    }
}

fn set(changed: &[(&str, &str)]) -> Vec<(String, String)> {
    changed.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect()
}

fn read(text: &str, changed: &[(&str, &str)]) -> WebSpec {
    read_web((text, CASES), &set(changed)[..]).unwrap_or_else(|why| panic!("a web: {why}")).spec
}

fn lay(spec: &WebSpec, threads: usize) -> (Web, Findings) {
    let (stop, laid) = (AtomicBool::new(false), AtomicU64::new(0));
    let by = RunContext { threads, isa: Isa::detect(), stop: &stop, done: &laid };
    let mut simulated = Flyer::new(threads, &stop, &|_, work| work()).web(spec).expect("a flight");
    let findings = simulated.find(by).expect("findings");
    (simulated.web, findings)
}

/// What the program reports of a line, with what it takes.
fn estimated(text: &str, threads: usize) -> (WebSpec, Vec<Estimate>) {
    let (stop, laid) = (AtomicBool::new(false), AtomicU64::new(0));
    let by = RunContext { threads, isa: Isa::detect(), stop: &stop, done: &laid };
    let spec = read(text, &[]);
    let begun = Instant::now();
    let (web, findings) = match std::env::args().any(|word| word == "small") {
        true => lay(&read(text, &[("web.width", "0.2 m"), ("web.length", "0.1 m")]), threads),
        false => lay(&spec, threads),
    };
    let of_web = begun.elapsed().as_secs_f64();
    println!("  the web {of_web:.1} s");
    let mut estimated = Vec::new();
    for (which, name) in [(Changes::OfAssumedValues, "assumed_values"), (Changes::OfLine, "changes")] {
        let word = Overrides::new(&[], "--set");
        let changes = read_changes((text, CASES), word, which).unwrap_or_else(|why| panic!("{why}"));
        let begun = Instant::now();
        let advice = advise(&spec, &web, &findings, changes, None, None, by).expect("advice");
        let seconds = begun.elapsed().as_secs_f64();
        println!(
            "  {name} {seconds:.1} s, {:.2} times the web, {} steps",
            seconds / of_web,
            laid.swap(0, Ordering::Relaxed)
        );
        advice.failed.iter().for_each(|(change, why)| println!("  {}: {why}", label(change)));
        let Some(judged_by) = advice.judged_by else { continue };
        let best = advice.improvements(judged_by);
        let is_named = |tried: &SensitivityRun| {
            which != Changes::OfAssumedValues
                && best.iter().take(2).any(|(best, _)| best.change == tried.change)
        };
        estimated.extend(advice.tried.iter().filter_map(|tried| {
            let change = tried.on(judged_by)?.difference;
            let name = label(&tried.change);
            let spec = tried.change.experiment.spec.clone();
            println!(
                "  {name:44} {:7.2} ± {:5.2} %  {}{}",
                100.0 * change.value,
                100.0 * change.standard_error,
                tried.change.setting.turned.name(),
                if is_named(tried) { " *" } else { "" }
            );
            Some(Estimate { name, spec, change, is_named: is_named(tried) })
        }));
    }
    (spec, estimated)
}

fn label(change: &Change) -> String {
    let key = |key: &spunlaid::ground::ChangedKey| format!("{} {}", key.key, key.pretty(key.to));
    change.keys.first().map_or_else(String::new, key)
}

/// Prints each change from long webs next to the reported one; returns how many are within two reported errors, of all.
/// A long web whose few filaments do not give the CV of all is left out with its partner, and counted.
fn compare(
    base: &WebSpec,
    estimated: &[Estimate],
    like: &WebSpec,
    seeds: usize,
    threads: usize,
) -> [usize; 2] {
    let specs: Vec<&WebSpec> =
        std::iter::once(base).chain(estimated.iter().map(|estimated| &estimated.spec)).collect();
    let cvs = par_map(threads, specs.len() * seeds, |i| {
        let seed = 1000 + (i % seeds) as u64;
        let long = WebSpec {
            seed,
            sheet: like.sheet.clone(),
            simulated: like.simulated,
            ..specs[i / seeds].clone()
        };
        let (_, findings) = lay(&long, 1);
        let seen = nearest_to_seen(findings.patches.iter().map(|patch| patch.map.patch));
        seen.and_then(|seen| findings.patches[seen].reported()).map(|estimated| estimated.cv)
    });
    let of = |web: usize| &cvs[web * seeds..][..seeds];
    println!(
        "  change                                     estimated             long webs          pairs  in its errors"
    );
    let [mut held, mut compared] = [0, 0];
    for (web, Estimate { name, change, is_named, .. }) in (1..).zip(estimated) {
        let pair = |(cv, base): (&Option<f64>, &Option<f64>)| Some((*cv)? / (*base)? - 1.0);
        let ratios: Vec<f64> = of(web).iter().zip(of(0)).filter_map(pair).collect();
        let pairs = ratios.len() as f64;
        let mean = ratios.iter().sum::<f64>() / pairs;
        let scatter = ratios.iter().map(|ratio| (ratio - mean).powi(2)).sum::<f64>() / (pairs - 1.0);
        let off = (change.value - mean) / change.standard_error;
        let is_compared = ratios.len() > 1;
        held += usize::from(is_compared && off.abs() <= 2.0);
        compared += usize::from(is_compared);
        println!(
            "  {name:44} {:7.2} ± {:5.2} %  {:7.2} ± {:5.2} %  {pairs:2} of {seeds}  {off:6.2}{}",
            100.0 * change.value,
            100.0 * change.standard_error,
            100.0 * mean,
            100.0 * (scatter / pairs).sqrt(),
            if *is_named { " *" } else { "" }
        );
    }
    [held, compared]
}
