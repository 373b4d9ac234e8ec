//! Advice: what settings of a line do to the CV of its web at the same basis weight.

use spunlaid_experiment::advice::{advise, judged_by};
use spunlaid_experiment::{Advice, Change, SensitivityRun, setting};
use spunlaid_ground::{Error, Isa, RunContext, Setting, Turned};
use spunlaid_input::{Changes, LaydownSource, Overrides, WebFile, WebSpec, read_changes, read_web};
use spunlaid_simulation::{Flights, Flyer};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64};

/// Filaments that hardly bend within the patch of 2 mm, and lie far from themselves.
const STRAIGHT: &str = "
[fibre]
linear_density = \"2 dtex\"
density = \"910 kg/m³\"
[laydown]
sigma_md = \"30 mm\"
sigma_cd = \"30 mm\"
noise = \"4 m^-0.5\"
[line]
throughput = \"0.6 g/min\"
belt_speed = \"10 m/s\"
filaments_per_metre = 2000
[web]
width = \"250 mm\"
length = \"250 mm\"
cell = \"1 mm\"
patches = [\"2 mm\"]
";

/// Two beams: the second one is in rows.
const BEAMS: &str = "
[[layer]]
[layer.laydown]
case = \"spunbond.toml\"
[layer.line]
filaments_per_metre = 3000
[[layer]]
name = \"M\"
[layer.laydown]
case = \"spunbond.toml\"
[layer.line]
feed_speed = \"40 m/s\"
rows = [{ pitch = \"0.5 mm\", filaments = 500 }, { pitch = \"1 mm\", filaments = 250, md = \"4 mm\" }]
[web]
width = \"250 mm\"
length = \"250 mm\"
";

/// The name of a file beside the cases.
pub fn cases() -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/web.toml").display().to_string()
}

fn read(text: &str, set: &[(&str, &str)]) -> (WebFile, Vec<Change>) {
    let set: Vec<(String, String)> =
        set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let set = Overrides::new(&set, "--set");
    (read_web((text, &cases()), set).unwrap(), read_changes((text, &cases()), set, Changes::OfLine).unwrap())
}

fn advice(text: &str, threads: usize, stop: &AtomicBool) -> Result<Advice, Error> {
    let (file, changes) = read(text, &[]);
    let (laid, on) = (AtomicU64::new(0), AtomicBool::new(false));
    let by = RunContext { threads, isa: Isa::detect(), stop: &on, done: &laid };
    let follow = |_: Flights<'_>, work: &mut (dyn FnMut() + Send)| work();
    let mut simulated = Flyer::new(threads, &on, &follow).web(&file.spec).unwrap();
    let findings = simulated.find(by).unwrap();
    advise(&file.spec, &simulated.web, &findings, changes, None, None, RunContext { stop, ..by })
}

fn weight(spec: &WebSpec) -> f64 {
    spec.mass_flow() / spec.belt_speed
}

/// The settings that are changed, each with its layer.
fn settings(changes: &[Change]) -> Vec<(Setting, Option<usize>)> {
    let of = |change: &Change| (change.setting, change.layers.first().copied());
    let mut settings: Vec<_> = changes.iter().map(of).collect();
    settings.dedup();
    settings
}

#[test]
fn no_change_makes_a_filament_faster_than_its_air() {
    let file = std::fs::read_to_string(Path::new(&cases()).with_file_name("web_shared.toml")).unwrap();
    let fastest = |set: &[(&str, &str)]| {
        let (_, changes) = read(&file, set);
        let tried = changes.iter().filter(|change| change.refusal.is_none());
        let feeds = tried.map(|change| change.experiment.spec.layers[0].fed_filament().feed_speed());
        let why = changes.iter().find_map(|change| change.refusal.clone());
        (feeds.fold(0.0, f64::max), why.unwrap_or_default())
    };
    // In air of 60 m/s at most, a filament of 40 m/s may become a fifth faster, and one of 50 m/s may not. One that
    // is faster already becomes no faster.
    for (feed, least, most) in [("40 m/s", 47.0, 51.0), ("50 m/s", 49.9, 50.1), ("66 m/s", 65.9, 66.1)] {
        let (found, _) = fastest(&[("feed.speed", feed)]);
        assert!((least..=most).contains(&found), "{feed}: {found}");
    }
    // What is not tried says why.
    let (_, why) = fastest(&[("feed.speed", "50 m/s")]);
    let words =
        "it makes a filament of 1 times the speed of its fastest air, where spunbond lines have 0.9 at most";
    assert_eq!(why, words);
}

#[test]
fn invariant_every_changed_web_has_the_same_basis_weight() {
    let file = |name: &str| std::fs::read_to_string(Path::new(&cases()).with_file_name(name)).unwrap();
    let alone = |all: &[Setting]| all.iter().map(|setting| (*setting, None)).collect::<Vec<_>>();
    let simulated = alone(&[
        setting::THROUGHPUT,
        setting::HOLES,
        setting::TITRE,
        setting::DISTANCE,
        setting::AIR_SPEED,
        setting::TURBULENCE,
    ]);
    let spun = alone(&[
        setting::THROUGHPUT,
        setting::HOLES,
        setting::DRAWING_AIR,
        setting::DIE_TEMPERATURE,
        setting::QUENCH,
        setting::DISTANCE,
        setting::AIR_SPEED,
        setting::TURBULENCE,
    ]);
    let beams = [
        (setting::THROUGHPUT, Some(1)),
        (setting::HOLES, Some(1)),
        (setting::THROUGHPUT, Some(2)),
        (setting::HOLES, Some(2)),
    ];
    let beams = [&beams[..], &simulated[2..], &alone(&[setting::ROW_PLACES])].concat();
    let weight_written: &[(&str, &str)] = &[("line.basis_weight", "15 g/m²")];
    // With a fifth more throughput, a fifth finer, or in air a fifth slower, a filament of 50 m/s is too fast for its
    // air of 60 m/s.
    for (text, set, wanted, too_fast) in [
        (STRAIGHT, &[][..], alone(&[setting::THROUGHPUT, setting::HOLES, setting::TITRE]), 0),
        (STRAIGHT, weight_written, alone(&[setting::THROUGHPUT, setting::HOLES, setting::TITRE]), 0),
        (BEAMS, &[], beams, 3),
        (&file("web.toml"), &[], simulated.clone(), 3),
        (&file("web.toml"), weight_written, simulated.clone(), 3),
        (&file("web_shared.toml"), &[], [&simulated[..], &alone(&[setting::DEPTH])].concat(), 3),
        (&file("whole_line.toml"), &[], spun, 0),
    ] {
        let (base, changes) = read(text, set);
        assert_eq!(settings(&changes), wanted, "{set:?}");
        let refused = changes.iter().filter(|change| change.refusal.is_some()).count();
        assert_eq!((changes.len(), refused), (2 * wanted.len(), too_fast), "{set:?}");
        let tolerance = if base.spec.basis_weight.is_some() { 1e-9 } else { 5e-5 };
        for change in &changes {
            let name = format!("{:?} {:?}", change.setting, change.keys);
            // All have one weight: that of the web, or if no file says it, its five digits that can be pasted.
            let common = weight(&change.experiment.spec);
            assert!((common / weight(&changes[0].experiment.spec) - 1.0).abs() < 1e-9, "{name}");
            assert!((common / weight(&base.spec) - 1.0).abs() < tolerance, "{name}");
            for (before, after) in base.spec.layers.iter().zip(&change.experiment.spec.layers) {
                // All lie on one belt, above which the cases are simulated.
                if let LaydownSource::Case { case, .. } = &after.source {
                    assert_eq!(case.line.unwrap().belt_speed, change.experiment.spec.belt_speed, "{name}");
                }
                let throughput = |of: &spunlaid_input::LayerSpec| {
                    let filament = of.fed_filament();
                    filament.linear_density() * filament.feed_speed()
                };
                if change.setting != setting::THROUGHPUT {
                    // Five digits, where the file does not give it.
                    let is_given =
                        matches!(before.filament.feed, spunlaid_fibre::FilamentFeed::Throughput(_));
                    let tolerance = if is_given { 1e-9 } else { 5e-5 };
                    assert!((throughput(after) / throughput(before) - 1.0).abs() < tolerance, "{name}");
                }
            }
        }
    }
}

/// Two equal beams beside a third one.
const EQUAL_BEAMS: &str = "
[[layer]]
name = \"first\"
[layer.laydown]
case = \"spunbond.toml\"
[layer.line]
filaments_per_metre = 3000
[[layer]]
name = \"second\"
[layer.laydown]
case = \"spunbond.toml\"
[layer.line]
filaments_per_metre = 3000
[[layer]]
[layer.laydown]
case = \"spunbond.toml\"
[layer.line]
filaments_per_metre = 1000
[web]
width = \"250 mm\"
length = \"250 mm\"
";

/// Every kind of advice can be pasted: what it says to set makes the changed web of the file, also beside
/// what was set before.
#[test]
fn invariant_what_advice_says_to_set_makes_the_changed_web() {
    let file = |name: &str| std::fs::read_to_string(Path::new(&cases()).with_file_name(name)).unwrap();
    let weight: &[(&str, &str)] = &[("line.basis_weight", "15 g/m²")];
    let in_other_words: &[(&str, &str)] =
        &[("feed.speed", "45 m/s"), ("belt.speed", "2.7 m/s"), ("fibre.diameter", "17 µm")];
    let mut kinds = Vec::new();
    for (text, set) in [
        (STRAIGHT, &[][..]),
        (STRAIGHT, weight),
        (BEAMS, &[]),
        (EQUAL_BEAMS, &[]),
        (&file("web.toml"), &[]),
        (&file("web.toml"), weight),
        (&file("web.toml"), in_other_words),
        (&file("web_shared.toml"), &[("air.turbulence_intensity", "12 %")]),
        (&file("web_shared.toml"), &[("belt.distance", "0.4 m")]),
        (&file("whole_line.toml"), &[]),
    ] {
        let (_, changes) = read(text, set);
        assert!(!changes.is_empty(), "{set:?}");
        for change in changes {
            // A row stays as wide as its web, to the last digit of the pitch.
            for (key, value) in change.experiment.set.iter().filter(|(key, _)| !key.ends_with(".pitch")) {
                let digits = value.split(' ').next().unwrap().chars().filter(char::is_ascii_digit);
                // Zeros in front give the size only.
                let digits = digits.skip_while(|digit| *digit == '0').count();
                assert!(digits <= 5, "{key} = {value} is no number that a person would write");
            }
            let set = Overrides::new(&change.experiment.set, "--set");
            let name = format!("{:?}: {:?}", change.setting, change.experiment.set);
            let pasted =
                read_web((text, &cases()), set).unwrap_or_else(|error| panic!("{name}: {error}")).spec;
            let wanted = &change.experiment.spec;
            assert!((pasted.belt_speed / wanted.belt_speed - 1.0).abs() < 1e-9, "{name}");
            for (found, wanted) in pasted.layers.iter().zip(&wanted.layers) {
                let numbers = |of: &spunlaid_input::LayerSpec| {
                    let distance = of.source.case().map_or(1.0, |case| case.line.unwrap().distance);
                    let filaments = of.filaments.count(&pasted.sheet) as f64;
                    [of.fed_filament().linear_density(), of.fed_filament().feed_speed(), distance, filaments]
                };
                for (found, wanted) in numbers(found).iter().zip(numbers(wanted)) {
                    assert!((found / wanted - 1.0).abs() < 1e-9, "{name}: {found} {wanted}");
                }
                if let (Some(found), Some(wanted)) = (found.source.case(), wanted.source.case()) {
                    let air = |case: &spunlaid_fibre::Case| {
                        let key = |name| spunlaid_fibre::case::keys::find(name).unwrap().get(case);
                        let number = |name| key(name).and_then(|value| value.number());
                        [
                            "air.speed_factor",
                            "air.turbulence_intensity",
                            "spinline.velocity_factor",
                            "spinline.die_temperature",
                        ]
                        .map(number)
                    };
                    assert_eq!(air(found), air(wanted), "{name}");
                }
            }
            kinds.push(change.setting);
        }
    }
    kinds.sort_by_key(|kind| kind.name);
    kinds.dedup();
    assert_eq!(kinds.len(), 11, "{kinds:?}");
}

/// What is turned while the line runs is named by its file, or is what is usual.
#[test]
fn a_web_says_which_settings_are_turned_while_it_runs() {
    let turned = |set: &[(&str, &str)]| {
        let (_, changes) = read(EQUAL_BEAMS, set);
        [setting::THROUGHPUT, setting::DISTANCE, setting::HOLES]
            .map(|of| changes.iter().find(|change| change.setting.name == of.name).unwrap().setting.turned)
    };
    assert_eq!(turned(&[]), [Turned::Running, Turned::Stopped, Turned::Rebuilt]);
    let named = [("web.turnable", "distance, air_speed")];
    assert_eq!(turned(&named), [Turned::Stopped, Turned::Running, Turned::Rebuilt]);
    let set = [("web.turnable".to_owned(), "distanse".to_owned())];
    let error = read_web((EQUAL_BEAMS, &*cases()), &set).unwrap_err().to_string();
    assert!(error.contains("names distanse, which is not a setting; did you mean distance?"), "{error}");
}

#[test]
fn equal_beams_are_changed_together() {
    let (base, changes) = read(EQUAL_BEAMS, &[]);
    let holes: Vec<&Change> = changes.iter().filter(|change| change.setting == setting::HOLES).collect();
    let layers: Vec<&[usize]> = holes.iter().map(|change| &change.layers[..]).collect();
    assert_eq!(layers, [&[1, 2][..], &[1, 2], &[3], &[3]]);
    let counts = |spec: &WebSpec| -> Vec<u64> {
        spec.layers.iter().map(|layer| layer.filaments.count(&spec.sheet)).collect()
    };
    assert_eq!(counts(&base.spec), [750, 750, 250]);
    assert_eq!(counts(&holes[0].experiment.spec), [600, 600, 250]);
    assert_eq!(counts(&holes[3].experiment.spec), [750, 750, 300]);
    // Beams that are all equal need no numbers.
    let two = EQUAL_BEAMS.replace("filaments_per_metre = 1000", "filaments_per_metre = 3000");
    let (_, changes) = read(&two, &[]);
    let holes: Vec<&Change> = changes.iter().filter(|change| change.setting == setting::HOLES).collect();
    assert_eq!((holes.len(), &holes[0].layers[..]), (2, &[][..]));
    assert_eq!(counts(&holes[1].experiment.spec), [900, 900, 900]);
}

#[test]
fn a_change_of_one_beam_leaves_the_other_one_as_it_is() {
    let (base, changes) = read(BEAMS, &[]);
    let of = |setting: Setting, layer| {
        changes
            .iter()
            .find(|change| (change.setting, change.layers.first().copied()) == (setting, layer))
            .unwrap()
    };
    let holes = of(setting::HOLES, Some(2));
    assert_eq!(holes.experiment.spec.layers[0].filaments, base.spec.layers[0].filaments);
    assert_eq!(holes.experiment.spec.layers[1].filaments.count(&base.spec.sheet), 600);
    let keys: Vec<(&str, f64)> = holes.keys.iter().map(|key| (&*key.key, key.to)).collect();
    // The rows stay as wide as they are.
    assert_eq!(
        keys,
        [
            ("layer.2.line.rows.1.filaments", 400.0),
            ("layer.2.line.rows.1.pitch", 0.5e-3 / 0.8),
            ("layer.2.line.rows.2.filaments", 200.0),
            ("layer.2.line.rows.2.pitch", 1e-3 / 0.8),
        ]
    );
}

/// CV² of straight independent filaments goes with their mass per length at the same weight, theory.md (72).
/// The number of holes, on a faster belt, and the throughput do not change it.
#[test]
fn analytic_titre_of_straight_filaments() {
    let advice = advice(STRAIGHT, 2, &AtomicBool::new(false)).unwrap();
    assert_eq!(advice.failed, []);
    let change = |setting: Setting, more: bool| {
        let found = advice.tried.iter().find(|SensitivityRun { change, .. }| {
            change.setting == setting && (change.keys[0].to > change.keys[0].from) == more
        });
        found.unwrap().effects[0].difference
    };
    for (more, titre) in [(false, 0.8_f64), (true, 1.2)] {
        let cv = change(setting::TITRE, more);
        println!("{more}: {} ± {}, {}", cv.value, cv.standard_error, titre.sqrt() - 1.0);
        // Four standard errors of few paths, and a per cent for where a filament meets itself.
        let tolerance = 4.0 * cv.standard_error + 0.01;
        assert!((cv.value - (titre.sqrt() - 1.0)).abs() < tolerance, "{cv:?}");
        assert!(tolerance < 0.04, "{cv:?}");
        // With more throughput the belt is as much faster, and the same paths lie on it.
        let held = change(setting::THROUGHPUT, more);
        assert!(held.value.abs() < 1e-9, "{held:?}");
    }
    let [(tried, effect), ..] = advice.improvements(2e-3)[..] else { panic!("nothing lowers it") };
    assert_eq!((tried.change.setting, effect.difference.value < -0.05), (setting::TITRE, true));
    let [before, after] = tried.change.experiment.mass_flow;
    assert!((after / before - 1.0).abs() < 1e-9);
}

#[test]
fn identical_advice_from_any_number_of_threads() {
    let run = AtomicBool::new(false);
    assert_eq!(advice(STRAIGHT, 1, &run).unwrap(), advice(STRAIGHT, 3, &run).unwrap());
}

#[test]
fn advice_ends_when_it_is_stopped() {
    let stopped = advice(STRAIGHT, 2, &AtomicBool::new(true));
    assert!(matches!(stopped, Err(Error::Interrupted)), "{stopped:?}");
}

/// The charge of a line is a setting of it, where there is one.
#[test]
fn a_charge_is_changed_where_it_is_given() {
    let web = "[laydown]\ncase = \"spunbond_slot.toml\"\n[line]\nfilaments_per_metre = 5000\n\
        slot_gap = \"20 mm\"\n[web]\nwidth = \"0.5 m\"\nlength = \"0.5 m\"\n";
    let of_charge = |set: &[(&str, &str)]| -> Vec<(f64, f64)> {
        let (_, changes) = read(web, set);
        assert!(changes.iter().any(|change| change.setting == setting::DEPTH));
        let changes = changes.iter().filter(|change| change.setting == setting::CHARGE);
        changes.map(|change| (change.keys[0].to, change.experiment.spec.layers[0].charge.unwrap())).collect()
    };
    assert!(of_charge(&[]).is_empty() && of_charge(&[("line.charge", "0 µC/g")]).is_empty());
    let changed = of_charge(&[("line.charge", "2 µC/g")]);
    assert_eq!(changed, [(1.6e-3, 1.6e-3), (2.4e-3, 2.4e-3)]);
}

#[test]
fn a_web_is_judged_by_the_patches_of_what_is_asked_for() {
    let mut spec = read_web((STRAIGHT, "web.toml"), &[]).unwrap().spec;
    spec.sheet.patches = vec![1e-3, 2e-3, 5e-3, 10e-3, 20e-3, 50e-3];
    // A section of a strip is 50 × 5 mm, as large as a patch of 15.8 mm.
    for (text, side) in [("thin-places", 10e-3), ("strips", 20e-3), ("5mm", 5e-3)] {
        assert_eq!(judged_by(&spec, text).unwrap(), side, "{text}");
    }
    for (text, said) in [("strength", "one of thin-places, strips"), ("7mm", "not of 7 mm")] {
        let message = judged_by(&spec, text).unwrap_err().to_string();
        assert!(message.contains(said), "{message}");
    }
}
