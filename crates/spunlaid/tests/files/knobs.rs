//! The knobs of a line: what they set, what follows, and what is refused.

use spunlaid_experiment::{Change, plant_numbers};
use spunlaid_ground::Dimension;
use spunlaid_input::{
    Changes, Knob, LineFile, Overrides, Resources, Turn, TurnedLine, WebSpec, read_changes, read_line,
    read_web,
};
use std::fs;
use std::path::Path;

/// A line from the die to the belt, as `spunlaid new --web` writes it.
const SPUN: &str = r#"
[line]
throughput = "0.5 g/min"   # of each hole
basis_weight = "20 g/m²"
filaments_per_metre = 5000   # 250 kg/h
slot_gap = "20 mm"
cabin_pressure = "3200 Pa"   # of the plant
[web]
width = "0.2 m"
length = "0.2 m"
[spinline]
polymer = "pp"
melt_flow_rate = 35
die_temperature = "230 °C"   # of the melt
hole_diameter = "0.6 mm"
length = "1.6 m"
profile = "tables/whole_line.csv"
follows_air = true
[fibre]
element_length = "4 mm"
root = "clamped"
[belt]
distance = "0.5 m"
[air]
profile = "tables/spunbond.csv"
widening = "md"
[drag]
across = "marheineke-wegener"
[run]
duration = "1 s"
"#;

/// Three beams in one air, of which two are equal. The belt stands in the file twice: by the weight, and by what it
/// takes the place of.
const BEAMS: &str = r#"
[air]
velocity = "60 m/s"   # of all
turbulence_intensity = 0.1
length_scale = "10 mm"
cutoff_frequency = "1 kHz"
[drag]
across = "marheineke-wegener"
[belt]
distance = "60 mm"
[run]
duration = "20 ms"
[web]
width = "0.12 m"
length = "0.12 m"
[[layer]]
[layer.fibre]
diameter = "18 µm"
density = "910 kg/m³"
youngs_modulus = "2 GPa"
[layer.line]
throughput = "0.6 g/min"   # of the first
belt_speed = "4 m/s"
rows = [{ pitch = "even", filaments = 300 }, { pitch = "0.6 mm", filaments = 200, md = "4 mm" }]   # two rows
[[layer]]
name = "M"
[layer.fibre]
linear_density = "2 dtex"
density = "910 kg/m³"
youngs_modulus = "2 GPa"
[layer.line]
feed_speed = "45 m/s"   # the second
filaments_per_metre = 3000
[[layer]]
[layer.fibre]
diameter = "18 µm"
density = "910 kg/m³"
youngs_modulus = "2 GPa"
[layer.line]
throughput = "0.6 g/min"   # of the third
rows = [{ pitch = "even", filaments = 300 }, { pitch = "0.6 mm", filaments = 200, md = "4 mm" }]
"#;

/// Names of knobs with their values.
type Turns<'a> = &'a [(&'a str, f64)];

/// A web in the folder of the cases.
fn beside_cases(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(name).display().to_string()
}

/// Every kind of line: text and path.
fn lines() -> Vec<(String, String)> {
    let cases = ["web.toml", "web_shared.toml", "web_known.toml", "whole_line.toml"].map(beside_cases);
    let prove = ["simulated", "places", "layers", "web"]
        .map(|name| beside_cases(&format!("../crates/spunlaid-cli/examples/prove/{name}.toml")));
    let files = cases.into_iter().chain(prove).map(|path| (fs::read_to_string(&path).unwrap(), path));
    let own = [SPUN, BEAMS].map(|text| (text.to_owned(), beside_cases("line.toml")));
    files.chain(own).collect()
}

fn opened(text: &str, name: &str) -> LineFile {
    read_line(text, name, &Resources::default()).unwrap_or_else(|why| panic!("{name}: {why}"))
}

fn spun() -> LineFile {
    opened(SPUN, &beside_cases("line.toml"))
}

fn turn(name: &str, value: f64) -> Turn {
    Turn { name: name.to_owned(), value }
}

fn turned(line: &LineFile, turns: Turns<'_>) -> TurnedLine {
    let turns: Vec<Turn> = turns.iter().map(|(name, value)| turn(name, *value)).collect();
    line.turned(&turns, &Resources::default()).unwrap_or_else(|why| panic!("{turns:?}: {why}"))
}

fn knob(line: &LineFile, name: &str) -> Knob {
    line.knobs().into_iter().find(|knob| knob.name == name).unwrap_or_else(|| panic!("{name}"))
}

/// Equal texts mean equal bits.
fn bits(spec: &WebSpec) -> String {
    format!("{spec:?}")
}

/// Asserts that two webs are the same but for what roundings make. How the belt is given is no part of it.
fn assert_near(a: &WebSpec, b: &WebSpec, within: f64, about: &str) {
    let shown = |spec: &WebSpec| format!("{:?}", WebSpec { basis_weight: None, ..spec.clone() });
    let (a, b) = (shown(a), shown(b));
    let words = |text: &str| {
        let is_apart = |c: char| c.is_whitespace() || "(){}[],:".contains(c);
        text.split(is_apart).map(ToOwned::to_owned).collect::<Vec<_>>()
    };
    let is_near = |(a, b): (&String, &String)| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= within * b.abs(),
        _ => a == b,
    };
    let is_near = |pair: (&String, &String)| pair.0 == pair.1 || is_near(pair);
    let (a, b) = (words(&a), words(&b));
    assert_eq!(a.len(), b.len(), "{about}");
    if let Some(at) = a.iter().zip(&b).position(|pair| !is_near(pair)) {
        let around = |words: &[String]| words[at.saturating_sub(12)..=at].join(" ");
        panic!("{about}\n{}\n{}", around(&a), around(&b));
    }
}

/// Asserts that what is set, and the text, make the same web to the last bit.
fn assert_reads_back(text: &str, name: &str, turned: &TurnedLine) {
    let set = read_web((text, name), &turned.set).unwrap().spec;
    assert_eq!(bits(&set), bits(&turned.spec), "{name}: {:?}", turned.set);
    let again = read_web((&turned.text, name), &[]).unwrap_or_else(|why| panic!("{why}\n{}", turned.text));
    assert_eq!(bits(&again.spec), bits(&turned.spec), "{name}: {:?}\n{}", turned.set, turned.text);
}

/// The lines of a text that are comments alone.
fn comments(text: &str) -> Vec<&str> {
    text.lines().filter(|line| line.starts_with('#')).collect()
}

#[test]
fn identical_a_knob_turned_by_a_fifth_is_the_change_of_advice() {
    for (text, name) in lines() {
        let line = opened(&text, &name);
        let changes = line.changes();
        let wanted = read_changes((&text, &name), Overrides::from(&[]), Changes::OfLine).unwrap();
        assert_eq!(changes, wanted, "{name}");
        assert!(changes.len() >= 4, "{name}: {}", changes.len());
        for Change { setting, layers, keys, experiment, .. } in &changes {
            let of_it = |knob: &Knob| (knob.setting, &knob.layers) == (*setting, layers);
            let knobs: Vec<Knob> = line.knobs().into_iter().filter(of_it).collect();
            let [knob] = &knobs[..] else { panic!("{name}: {setting:?}") };
            assert_eq!(knob.keys[0], keys[0].key, "{name}");
            // A factor on the air is shown as its speed at the slot.
            let size = if knob.keys[0] == "air.speed_factor" { knob.value / keys[0].from } else { 1.0 };
            assert_eq!(knob.value, size * keys[0].from, "{name}");
            // The less is as the more, and takes as long.
            if keys[0].to < keys[0].from {
                continue;
            }
            let turned = turned(&line, &[(&knob.name, size * keys[0].to)]);
            // Where layers differ, the factor is that of the first number, which has been rounded to four digits.
            let is_equal = keys.iter().all(|key| key.from == keys[0].from) || knob.setting.name == "holes";
            assert!(turned.set == experiment.set || !is_equal, "{name}: {:?}", turned.set);
            let about = format!("{name}: {}", knob.name);
            assert_near(&turned.spec, &experiment.spec, if is_equal { 1e-9 } else { 5e-4 }, &about);
            assert_eq!(comments(&turned.text), comments(&text));
            if turned.spec.cases().all(|case| case.spinline.is_none()) {
                assert_reads_back(&text, &name, &turned);
            }
        }
    }
}

#[test]
fn ranges_contain_their_values_and_are_those_of_spunbond_lines() {
    for (text, name) in lines() {
        let (line, mut names) = (opened(&text, &name), Vec::new());
        for Knob { name: knob, value, range: [least, greatest], is_whole, keys, .. } in line.knobs() {
            assert!(least <= value && value <= greatest && least < greatest, "{name}: {knob}");
            assert!(!is_whole || [least, greatest].iter().all(|end| end.fract() == 0.0), "{name}: {knob}");
            assert!(!keys.is_empty() && !names.contains(&knob), "{name}: {knob}");
            names.push(knob);
        }
        assert!(names.ends_with(&["belt_speed".to_owned(), "basis_weight".to_owned()]), "{name}: {names:?}");
    }
    // Half and twice of 0.5 g/min; of a weight of 2 g/m², no less than lines have, and its value; 25 K.
    let near = |found: [f64; 2], wanted: [f64; 2]| {
        let is_near = |(a, b): (f64, f64)| (a / b - 1.0).abs() < 1e-12;
        assert!(found.into_iter().zip(wanted).all(is_near), "{found:?} {wanted:?}");
    };
    let line = spun();
    near(knob(&line, "throughput").range, [0.25e-3 / 60.0, 1e-3 / 60.0]);
    near(knob(&line, "die_temperature").range, [478.15, 528.15]);
    let light = opened(&SPUN.replace("20 g/m²", "2 g/m²"), &beside_cases("line.toml"));
    near(knob(&light, "basis_weight").range, [2e-3, 4e-3]);
}

#[test]
fn knobs_turned_together_are_some_turned_after_the_others() {
    for (text, name) in lines() {
        let line = opened(&text, &name);
        let knobs = line.knobs().into_iter().filter(|knob| knob.name != "belt_speed");
        let turns: Vec<Turn> = knobs.map(|knob| turn(&knob.name, 1.03 * knob.value)).collect();
        let together =
            line.turned(&turns, &Resources::default()).unwrap_or_else(|why| panic!("{name}: {why}"));
        let (first, second) = turns.split_at(turns.len() / 2);
        let half = line.turned(first, &Resources::default()).unwrap();
        let opened = opened(&half.text, &name);
        let values =
            |knobs: Vec<Knob>| knobs.into_iter().map(|knob| (knob.name, knob.value)).collect::<Vec<_>>();
        assert_eq!(values(opened.knobs()), values(half.knobs), "{name}");
        let saved = opened.turned(second, &Resources::default()).unwrap();
        assert_near(&together.spec, &saved.spec, 1e-9, &format!("{name}: {turns:?}"));
        assert_reads_back(&text, &name, &together);
        // Back again: the file as it is.
        let back: Vec<Turn> = line.knobs().iter().map(|knob| turn(&knob.name, knob.value)).collect();
        let back = line.turned(&back[..back.len() - 2], &Resources::default()).unwrap();
        assert_eq!((bits(&back.spec), back.text, back.set), (bits(line.spec()), text, Vec::new()));
    }
}

#[test]
fn analytic_the_belt_follows_the_weight_unless_it_is_turned() {
    let line = spun();
    let of = |spec: &WebSpec| [spec.mass_flow(), spec.belt_speed, spec.weight()];
    let base = of(line.spec());
    let throughput = knob(&line, "throughput").value;
    let belt = knob(&line, "belt_speed").value;
    // Mass flow, belt and weight in shares of what they were.
    let all: [(Turns<'_>, [f64; 3]); 6] = [
        (&[("throughput", 1.2 * throughput)], [1.2, 1.2, 1.0]),
        (&[("belt_speed", 1.25 * belt)], [1.0, 1.25, 0.8]),
        (&[("basis_weight", 25e-3)], [1.0, 0.8, 1.25]),
        (&[("throughput", 1.2 * throughput), ("belt_speed", belt)], [1.2, 1.0, 1.2]),
        (&[("belt_speed", 1.1 * belt), ("basis_weight", 25e-3)], [1.0, 0.8, 1.25]),
        (&[("basis_weight", 25e-3), ("belt_speed", 1.25 * belt)], [1.0, 1.25, 0.8]),
    ];
    for (turns, wanted) in all {
        let turned = turned(&line, turns);
        let found = of(&turned.spec);
        // The knobs say what has become of them.
        let of_knob = |name: &str| turned.knobs.iter().find(|knob| knob.name == name).unwrap().value;
        assert_eq!([of_knob("belt_speed"), of_knob("basis_weight")], [found[1], found[2]]);
        let is_turned = turns.iter().any(|(name, _)| *name == "throughput");
        let throughput = throughput * if is_turned { 1.2 } else { 1.0 };
        assert!((of_knob("throughput") / throughput - 1.0).abs() < 1e-11);
        let is_near = |i: usize| (found[i] / base[i] / wanted[i] - 1.0).abs() < 1e-11;
        assert!((0..3).all(is_near), "{turns:?}: {found:?} of {base:?}");
    }
}

#[test]
fn a_saved_line_keeps_its_comments_and_says_each_number_once() {
    let line = spun();
    let kelvins = 240.0 + 273.15;
    let turns = [("throughput", 0.6e-3 / 60.0), ("air_speed", 4e3), ("die_temperature", kelvins)];
    let saved = turned(&line, &turns).text;
    let differ: Vec<&str> = saved.lines().filter(|line| !SPUN.lines().any(|old| old == *line)).collect();
    let wanted = [
        "throughput = \"0.6 g/min\"   # of each hole",
        "cabin_pressure = \"4 kPa\"   # of the plant",
        "die_temperature = \"240 °C\"   # of the melt",
    ];
    assert_eq!(differ, wanted, "{saved}");
    assert_eq!(saved.lines().count(), SPUN.lines().count());
    // Of layers, equal ones together; what the belt took the place of is gone.
    let line = opened(BEAMS, &beside_cases("line.toml"));
    let names: Vec<String> = line.knobs().into_iter().map(|knob| knob.name).collect();
    assert_eq!(names[..4], ["throughput.1", "holes.1", "throughput.2", "holes.2"]);
    let first = knob(&line, "throughput.1");
    assert_eq!((first.label.as_str(), &first.layers), ("throughput per hole, layers 1, 3", &vec![1, 3]));
    let saved = turned(&line, &[("throughput.1", 0.7e-3 / 60.0), ("air_speed", 70.0)]).text;
    for wanted in ["throughput = \"0.7 g/min\"   # of the first", "velocity = \"70 m/s\"   # of all"] {
        assert!(saved.contains(wanted), "{saved}");
    }
    assert!(saved.contains("throughput = \"0.7 g/min\"   # of the third"), "{saved}");
    assert!(!saved.contains("belt_speed") && saved.matches("basis_weight").count() == 1, "{saved}");
}

#[test]
fn analytic_the_air_of_a_table_is_turned_by_its_speed_at_the_slot() {
    let line = opened(
        &SPUN.replace("cabin_pressure = \"3200 Pa\"   # of the plant\n", ""),
        &beside_cases("line.toml"),
    );
    let Knob { label, value, dimension, range: [least, greatest], keys, .. } = knob(&line, "air_speed");
    let slot = |spec: &WebSpec| spec.cases().next().unwrap().air.velocity_at_slot().unwrap();
    assert_eq!((label.as_str(), dimension, value), ("air speed", Dimension::Velocity, slot(line.spec())));
    assert_eq!((keys[0].as_str(), [least, greatest]), ("air.speed_factor", [0.5 * value, 2.0 * value]));
    let turned = turned(&line, &[("air_speed", 72.0)]);
    assert!((slot(&turned.spec) / 72.0 - 1.0).abs() < 1e-11, "{:?}", turned.set);
    let now = turned.knobs.iter().find(|knob| knob.name == "air_speed").unwrap();
    assert!((now.value / 72.0 - 1.0).abs() < 1e-11);
    // Back where it was, nothing is set.
    assert_eq!(line.turned(&[turn("air_speed", value)], &Resources::default()).unwrap().set, Vec::new());
}

#[test]
fn a_case_in_a_file_of_its_own_is_changed_in_the_file_of_the_web() {
    let name = beside_cases("web_shared.toml");
    let text = fs::read_to_string(&name).unwrap();
    let line = opened(&text, &name);
    let saved = turned(&line, &[("distance", 0.6), ("titre", 1.9e-7)]);
    assert!(saved.text.contains("[belt]\ndistance = \"600 mm\"\n"), "{}", saved.text);
    assert!(saved.text.contains("case = \"spunbond_slot.toml\""), "{}", saved.text);
    assert_reads_back(&text, &name, &saved);
}

#[test]
fn rejects_what_no_line_can_be() {
    let line = spun();
    let rejected = |turns: Turns<'_>| {
        let turns: Vec<Turn> = turns.iter().map(|(name, value)| turn(name, *value)).collect();
        line.turned(&turns, &Resources::default()).unwrap_err().to_string()
    };
    let all: [(Turns<'_>, &[&str]); 6] = [
        (
            &[("titre", 2e-7)],
            &["knob titre is not a setting of this line", "change one of throughput, holes, "],
        ),
        (&[("throughput", f64::NAN)], &["line.throughput"]),
        (&[("throughput", -1e-5)], &["knob line.throughput = -0.6 g/min is not positive", "above zero"]),
        (&[("holes", 0.2)], &["knob line.filaments_per_metre = 0 "]),
        (
            &[("basis_weight", 1e-4)],
            &["knob line.basis_weight", "tear the fibre", "lay more, or feed faster"],
        ),
        (&[("throughput", 8e-3)], &["knob line.throughput = \"480 g/min\""]),
    ];
    for (turns, wanted) in all {
        let found = rejected(turns);
        assert!(wanted.iter().all(|words| found.contains(words)), "{turns:?}: {found}");
        assert!(found.starts_with("knob "), "what was turned comes first: {found}");
    }
    // A file that is as far outside itself is turned all the same.
    let light =
        opened(&SPUN.replace("20 g/m²", "0.25 g/m²").replace("5000", "500"), &beside_cases("line.toml"));
    assert!(
        turned(&light, &[("distance", 0.4)])
            .notes
            .iter()
            .any(|note| note.to_string().contains("is outside the usual range: a "))
    );
}

#[test]
fn a_tension_that_flights_have_to_find_is_said() {
    assert!(!turned(&spun(), &[("distance", 0.4)]).needs_flights);
    let simulated = SPUN.replace("follows_air = true", "follows_air = true\nend_tension = \"simulated\"");
    let line = opened(&simulated, &beside_cases("line.toml"));
    let resources = Resources::default();
    let turned = line.turned(&[turn("distance", 0.4)], &resources).unwrap();
    assert!(turned.needs_flights && resources.wanted() == 1);
    assert!(turned.notes.iter().any(|note| note.to_string().contains("is found when the case is simulated")));
}

#[test]
fn analytic_the_numbers_of_a_plant() {
    let numbers = plant_numbers(spun().spec());
    let text = |name: &str| numbers.iter().find(|number| number.name == name).unwrap().text.clone();
    let value = |name: &str| numbers.iter().find(|number| number.name == name).unwrap().value;
    // 5000 holes of 0.5 g/min on a metre make 150 kg/h, and 20 g/m² on a belt of 125 m/min.
    let wanted = [
        ("throughput", "0.5 g/min"),
        ("cabin_pressure", "3200 Pa"),
        ("mass_flow", "150 kg/h"),
        ("belt_speed", "125 m/min"),
        ("basis_weight", "20 g/m²"),
    ];
    wanted.iter().for_each(|(name, wanted)| assert_eq!(text(name), *wanted));
    let flow = value("titre") * value("spinning_speed");
    assert!((flow / value("throughput") - 1.0).abs() < 1e-12);
    assert!((value("filament_to_air") * value("air_at_slot") / value("spinning_speed") - 1.0).abs() < 1e-9);
    // Layers that differ say it each, and what they have in common once.
    let beams = plant_numbers(opened(BEAMS, &beside_cases("line.toml")).spec());
    let names: Vec<&str> = beams.iter().map(|number| number.name.as_str()).collect();
    assert_eq!(names[..3], ["throughput.1", "throughput.2", "throughput.3"]);
    assert!(names.ends_with(&["mass_flow", "belt_speed", "basis_weight"]), "{names:?}");
}

#[test]
fn identical_tables_may_be_written_in_any_way() {
    const INLINE: &str = r#"
web = { width = "0.2 m", length = "0.2 m" }
fibre.density = "910 kg/m³"   # of all
layer = [
  { fibre = { diameter = "18 µm" }, laydown = KNOWN, line = { FED, belt_speed = "4 m/s", HOLES = 3000 } },
  { fibre = { diameter = "15 µm" }, laydown = KNOWN, line = { FED, rows = [{ pitch = "even", filaments = 600 }] } },
]
"#;
    let known = r#"{ sigma_md = "18 mm", sigma_cd = "18 mm", noise = "12 m^-0.5" }"#;
    let text = INLINE.replace("KNOWN", known).replace("HOLES", "filaments_per_metre");
    let text = text.replace("FED", "feed_speed = \"50 m/s\"");
    let line = opened(&text, "inline.toml");
    let turns: Vec<Turn> = line.knobs().iter().map(|knob| turn(&knob.name, 1.1 * knob.value)).collect();
    let all = line.turned(&turns, &Resources::default()).unwrap();
    assert_reads_back(&text, "inline.toml", &all);
    assert!(all.text.contains("fibre.density = \"910 kg/m³\"   # of all"), "{}", all.text);
}
