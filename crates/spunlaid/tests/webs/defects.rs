//! Holes that are blocked or feed less, on the web.

use super::same_air::{read, unwatched};
use spunlaid_ground::{Estimate, Isa, RunContext};
use spunlaid_input::read_web;
use spunlaid_simulation::{Flyer, WebSpec};
use spunlaid_web::map::{lay, strands};
use spunlaid_web::{Defect, LaidWeb, Map};
use std::sync::atomic::{AtomicBool, AtomicU64};

const KNOWN: &str = "
[fibre]
diameter = \"18 µm\"
density = \"910 kg/m³\"
[laydown]
sigma_md = \"9 mm\"
sigma_cd = \"8 mm\"
noise = \"15 m^-0.5\"
[line]
feed_speed = \"50 m/s\"
belt_speed = \"5 m/s\"
rows = [{ pitch = \"1 mm\", filaments = 200 }, { offset = \"0.5 mm\", pitch = \"1 mm\", filaments = 200 }]
[web]
width = \"0.2 m\"
length = \"0.4 m\"
cell = \"1 mm\"
";

const BLOCKED: Defect = Defect { from: Some(0.075), ..Defect::USUAL };

fn with(spec: &WebSpec, defects: &[Defect]) -> WebSpec {
    let mut spec = spec.clone();
    spec.layers[0].defects = defects.to_vec();
    spec
}

/// Mass over the map that is missing beside another one [kg], and its mean place across the sheet [m].
fn missing(whole: &Map, other: &Map) -> (f64, f64) {
    assert_eq!(whole.quantum, other.quantum);
    let (mut sum, mut moment) = (0.0, 0.0);
    for (i, (a, b)) in whole.cells.iter().zip(&other.cells).enumerate() {
        assert!(a >= b, "a defect lays nothing");
        let less = f64::from(a - b);
        sum += less;
        moment += less * ((i % whole.columns) as f64 + 0.5) * whole.cell;
    }
    (sum * whole.quantum, moment / sum)
}

/// What is laid with defects is what is laid without them, less the filaments that are missing.
#[test]
fn invariant_a_blocked_hole_takes_one_filament_from_a_web_of_independent_ones() {
    let spec = read_web((KNOWN, "known.toml"), &[]).unwrap().spec;
    let (stop, laid) = (AtomicBool::new(false), AtomicU64::new(0));
    let by = |threads| RunContext { threads, isa: Isa::detect(), stop: &stop, done: &laid };
    let lay_with = |defects: &[Defect], threads: usize| {
        let spec = with(&spec, defects);
        let flyer = Flyer::new(threads, &stop, &unwatched);
        let web = flyer.web(&spec).unwrap().web;
        let kept = strands(&web, spec.window(), by(threads)).unwrap();
        (lay(&web, by(threads)).unwrap(), kept)
    };
    let (whole, kept) = lay_with(&[], 2);
    let layer = &spec.layers[0];
    let filament =
        layer.filament.linear_density() * layer.filament.feed_speed() / spec.belt_speed * spec.sheet.length;
    let (blocked, others) = lay_with(&[BLOCKED], 2);
    let (mass, place) = missing(&whole.map, &blocked.map);
    assert!((mass / filament - 1.0).abs() < 1e-6, "{mass} {filament}");
    // Of one filament on 40 cm of web, whose places scatter by 8 mm.
    assert!((place - 0.075).abs() < 4e-3, "{place}");
    // The hole of the first row at 75 mm, with a window in the middle of its filament.
    let all: Vec<_> = kept.iter().filter(|strand| strand.filament != 150).cloned().collect();
    assert!(all == others);
    // A thread more or less changes nothing, and neither does a filament like the others.
    for threads in [1, 7] {
        let again = lay_with(&[BLOCKED], threads);
        assert!(again.0.map == blocked.map && again.1 == others);
    }
    assert!(lay_with(&[Defect { titre: 1.0, ..BLOCKED }], 2).0.map == whole.map);
    for (defect, share) in [
        (Defect { titre: 0.25, ..BLOCKED }, 0.75),
        // From the middle of the 80 ms that the sheet takes on, to within a block of pieces.
        (Defect { after: 0.04, ..BLOCKED }, 0.5),
        (Defect { from: None, row: Some(2), ..BLOCKED }, 200.0),
        (Defect { to: Some(0.0949), ..BLOCKED }, 40.0),
    ] {
        let (mass, _) = missing(&whole.map, &lay_with(&[defect], 2).0.map);
        assert!((mass / (share * filament) - 1.0).abs() < 0.02, "{defect:?}: {}", mass / filament);
    }
    let (mass, _) = missing(&whole.map, &lay_with(&[Defect { from: None, share: 0.1, ..BLOCKED }], 2).0.map);
    // Binomial: 40 ± 6.
    assert!((24.0..56.0).contains(&(mass / filament)), "{}", mass / filament);
}

/// In one air too, filled in from a few filaments and where all of them fly; the others lie as they did.
#[test]
fn invariant_a_blocked_hole_takes_one_filament_from_a_web_in_one_air() {
    let (stop, laid) = (AtomicBool::new(false), AtomicU64::new(0));
    let by = |threads| RunContext { threads, isa: Isa::detect(), stop: &stop, done: &laid };
    let small = read(&[("web.length", "0.1 m"), ("web.window", "20 mm")]).spec;
    let blocked = Defect { from: Some(0.05), ..Defect::USUAL };
    let check = |spec: &WebSpec, lay: &dyn Fn(&WebSpec, usize) -> LaidWeb| {
        let layer = &spec.layers[0];
        let filament = layer.filament.linear_density() * layer.filament.feed_speed() / spec.belt_speed
            * spec.sheet.length;
        let whole = lay(spec, 2);
        let defect = with(spec, &[blocked]);
        let one = lay(&defect, 2);
        let (mass, place) = missing(&whole.map, &one.map);
        // A curve leaves the ends of the sheet and comes back, on a web of a few spreads.
        assert!((mass / filament - 1.0).abs() < 0.3, "{mass} {filament}");
        assert!((place - 0.05).abs() < 0.03, "{place}");
        assert!(lay(&defect, 1).map == one.map);
        let half = lay(&with(spec, &[Defect { titre: 0.5, ..blocked }]), 2);
        let (less, _) = missing(&whole.map, &half.map);
        assert!((less / mass - 0.5).abs() < 1e-3, "{less} {mass}");
    };
    let simulated = |spec: &WebSpec, threads| {
        Flyer::new(threads, &stop, &unwatched).web(spec).unwrap().find(by(threads)).unwrap().laid
    };
    check(&small, &simulated);
    let set = [("web.length", "0.1 m"), ("web.window", "20 mm"), ("web.simulated", "all")];
    let all = read(&[&set[..], &[("line.filaments_per_metre", "100")]].concat()).spec;
    check(&all, &simulated);
}

#[test]
fn rejects_defects_without_a_hole_and_filaments_that_are_too_thick() {
    let refused = |defects: &str| {
        let text = KNOWN.replace("[web]", &format!("defects = [{defects}]\n[web]"));
        read_web((&text, "known.toml"), &[]).unwrap_err().to_string()
    };
    for (defects, message) in [
        ("{ titre = 3 }", "line.defects.1.titre = 3 is more than 2 times the mass of the other filaments"),
        ("{ from = \"1 mm\" }, { from = \"80 mm\", to = \"70 mm\" }", "line.defects.2.from"),
        ("{ row = 3 }", "line.defects.1.row = 3 has no hole: none of this row lies between from and to"),
        ("{ form = \"1 mm\" }", "did you mean line.defects.1.from?"),
        ("{ share = 2 }", "line.defects.1.share"),
        ("5", "write a list of defects, like [{ from ="),
    ] {
        let found = refused(defects);
        assert!(found.contains(message), "{found}");
    }
}

/// The basis weight of webs, and the variance of their clouds of 2 to 4 mm, scatter by their reported errors: by the
/// random holes with a defect, between cut edges by the fibre that crosses these, and by the number of filaments at
/// random places that lie between them. The error of the weight of a slot was two to four times too large, random
/// defects had none, and clouds varied with the weight by up to four errors.
#[test]
#[ignore = "slow: forty webs of each kind"]
fn stat_the_errors_of_basis_weight_and_clouds() {
    const SEEDS: u64 = 40;
    let (stop, laid) = (AtomicBool::new(false), AtomicU64::new(0));
    let by = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &laid };
    let rows = KNOWN.lines().find(|line| line.starts_with("rows")).unwrap();
    let many = "filaments_per_metre = 2000\n";
    for (filaments, edges) in [
        (format!("{rows}\ndefects = [{{ share = 0.1, titre = 0.3 }}]"), "periodic"),
        (format!("{many}slot_gap = \"10 mm\""), "cut"),
        ("filaments_per_metre = 300\n".to_owned(), "cut"),
    ] {
        let text = format!("{}edges = \"{edges}\"\n", KNOWN.replace(rows, &filaments));
        let of_seed = |seed: u64| {
            let set =
                [("web.seed".to_owned(), seed.to_string()), ("web.length".to_owned(), "0.1 m".to_owned())];
            let spec = read_web((&text, "known.toml"), &set[..]).unwrap().spec;
            let found = Flyer::new(1, &stop, &unwatched).web(&spec).unwrap().find(by).unwrap();
            let (_, clouds) = found.clouds.as_ref().unwrap().octaves().swap_remove(2);
            [found.basis_weight(), (clouds.mean, clouds.standard_error)]
        };
        let found: Vec<_> = (0..SEEDS).map(of_seed).collect();
        let ratio_of = |number: usize| {
            let numbers = Estimate::new(found.iter().map(|found| found[number].0).collect());
            let scatter = numbers.standard_error.unwrap() * (SEEDS as f64).sqrt();
            let errors = found.iter().map(|found| found[number].1.unwrap_or(0.0));
            scatter / (errors.sum::<f64>() / SEEDS as f64)
        };
        let ratios = [0, 1].map(ratio_of);
        println!("{filaments}: {ratios:.2?}");
        // The scatter of 40 seeds is known to 11 %.
        assert!(ratios.iter().all(|ratio| (0.7..1.5).contains(ratio)), "{filaments}: {ratios:?}");
    }
}
