//! Every key of a web that can vary, varied in a study, gives what single webs give, in every measure.

use crate::web_studies::{study_beside_cases, web_beside_cases};
use spunlaid_experiment::study::fly_bundle;
use spunlaid_experiment::{Batch, Study};
use spunlaid_ground::{Dimension, Isa, Known, Measure, RunContext, Value, measure};
use spunlaid_input::{LaydownSource, WEB_KEYS, WebFile, WebKey, WebSpec};
use spunlaid_simulation::layers::web_key;
use spunlaid_simulation::{Flights, Flyer};
use spunlaid_web::map::PatchFindings;
use spunlaid_web::{FABRIC_MEASURES, FABRIC_PATCH_MEASURES, PATCH_MEASURES, STRIP_MEASURES, WEB_MEASURES};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::{AtomicBool, AtomicU64};

/// Webs that together have every key. Their cells are small: single fibres, which say what CV to expect, are
/// laid on as many cells in any web, and so on the shorter belt.
const WEBS: [(&str, &str); 4] = [
    (
        "rows",
        r#"
[fibre]
linear_density = "2 dtex"
density = "910 kg/m³"
[laydown]
sigma_md = "9 mm"
sigma_cd = "8 mm"
noise = "15 m^-0.5"
[line]
feed_speed = "50 m/s"
belt_speed = "5 m/s"
rows = [{ offset = "10 mm", pitch = "5 mm", filaments = 30 }, { offset = "20 mm", pitch = "5 mm", filaments = 34 }]
defects = [{ from = "20 mm", to = "60 mm", row = 1, share = 0.5, titre = 0.5, after = "1 ms" }]
[web]
width = "200 mm"
length = "150 mm"
cell = "1 mm"
patches = ["20 mm"]
edges = "cut"
seed = 3
[fabric]
thickness = "0.3 mm"
saleable_width = "60 mm"
strip_width = "20 mm"
strip_length = "50 mm"
section = "4 mm"
measured_opacity = 0.3
opacity_weight = "15 g/m²"
"#,
    ),
    (
        "layers",
        r#"
[web]
width = "200 mm"
length = "200 mm"
cell = "1 mm"
patches = ["20 mm"]
[[layer]]
name = "S1"
[layer.fibre]
diameter = "18 µm"
density = "910 kg/m³"
[layer.laydown]
sigma_md = "9 mm"
sigma_cd = "8 mm"
noise = "15 m^-0.5"
[layer.line]
feed_speed = "50 m/s"
belt_speed = "5 m/s"
filaments_per_metre = 200
[[layer]]
name = "M"
[layer.fibre]
diameter = "4 µm"
density = "910 kg/m³"
[layer.laydown]
sigma_md = "12 mm"
sigma_cd = "12 mm"
noise = "10 m^-0.5"
[layer.line]
feed_speed = "60 m/s"
filaments_per_metre = 300
"#,
    ),
    (
        "simulated with charge",
        r#"
[laydown]
case = "short.case"
[line]
filaments_per_metre = 40
charge = "1 µC/g"
walls = "0.1 m"
[web]
width = "300 mm"
length = "100 mm"
simulated = "all"
cell = "2 mm"
patches = ["20 mm"]
"#,
    ),
    (
        "simulated",
        r#"
[laydown]
case = "short.case"
[line]
filaments_per_metre = 40
[web]
width = "300 mm"
length = "300 mm"
cell = "2 mm"
patches = ["20 mm"]
"#,
    ),
];

/// The full name of a key in the last layer, the last row and the only defect of a web.
fn full_name(web: &WebSpec, key: &WebKey) -> String {
    let layer = match web.layers.len() {
        last if last > 1 && key.table() != "web" => format!("layer.{last}."),
        _ => String::new(),
    };
    let name = match key.table() {
        "line.rows" => key.name.replace("rows.", "rows.2."),
        "line.defects" => key.name.replace("defects.", "defects.1."),
        _ => key.name.to_owned(),
    };
    format!("{layer}{name}")
}

/// Two values of a key as they are written: its first two words, or the number that is there and its double.
fn pair(key: &WebKey, web: &WebSpec) -> [String; 2] {
    let words = key.kind.words();
    if let [first, other, ..] = &words[..] {
        return [first, other].map(|word| format!("'{word}'"));
    }
    let there = key.get(web).and_then(|value| value.number()).filter(|number| *number != 0.0);
    let there = there.unwrap_or(match key.name {
        "fibre.diameter" => 2e-5,
        "fibre.linear_density" => 2e-7,
        "line.throughput" => 5e-6,
        "line.charge" => 1e-3,
        "line.basis_weight" => 5e-4,
        _ => 2.0,
    });
    let written = |value: f64| match key.dimension() {
        Some(Dimension::Ratio) => format!("{value}"),
        None => format!("{value:.0}"),
        Some(dimension) => format!("'{}'", dimension.exact(value)),
    };
    [there, 2.0 * there].map(written)
}

/// What a web alone gives: its measures by the side of its patches, and those of the whole.
///
/// * `known` – what webs have given, by their files
fn alone(text: &str, key: &str, value: &str, known: &mut BTreeMap<String, Vec<u64>>) -> Vec<u64> {
    let set = [(key.to_owned(), value.trim_matches('\'').to_owned())];
    let WebFile { spec, text, .. } = web_beside_cases(text, &set).unwrap();
    known.entry(text).or_insert_with(|| measured(&spec)).clone()
}

fn measured(spec: &WebSpec) -> Vec<u64> {
    let (stop, laid) = (AtomicBool::new(false), AtomicU64::new(0));
    let follow = |_: Flights<'_>, work: &mut (dyn FnMut() + Send)| work();
    let mut simulated = Flyer::new(1, &stop, &follow).web(spec).unwrap();
    let found =
        simulated.find(RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &laid }).unwrap();
    // The strips that are cut off at the edges may leave no room for large patches.
    let patch = |side: f64| found.patches.iter().find(|patch| (patch.map.patch / side - 1.0).abs() < 1e-9);
    let patches = spec.sheet.patches.iter().flat_map(|side| {
        let patch = patch(*side);
        patch_columns().map(move |of| patch.map_or(f64::NAN, |patch| of.number(patch)))
    });
    let of_web = WEB_MEASURES.iter().map(|of| of.number(&found));
    let fabric = spec.fabric(&simulated.web, &found, 1);
    let mut all: Vec<f64> = patches.chain(of_web).collect();
    all.extend(reported(FABRIC_MEASURES, Some(&fabric)));
    for side in [1e-3, 2e-3, 5e-3, 10e-3, 20e-3] {
        let patch = fabric.patches.iter().find(|patch| (patch.thin.patch / side - 1.0).abs() < 0.05);
        all.extend(reported(FABRIC_PATCH_MEASURES, patch));
    }
    all.extend(fabric.strips.iter().flat_map(|strips| reported(STRIP_MEASURES, strips.as_ref())));
    all.into_iter().map(f64::to_bits).collect()
}

/// What studies keep of a part of a fabric: each number and its error.
fn reported<T>(measures: &'static [Measure<T>], found: Option<&T>) -> Vec<f64> {
    let kept = measures.iter().filter(|of| !of.name.is_empty());
    let number = |of: &Measure<T>| match found.and_then(|found| of.value(found)) {
        Some(Value::Reported(Known::Value(value, error))) => [value, error.unwrap_or(f64::NAN)],
        // None were found: zero, as likely as one on the sheet.
        Some(Value::Reported(Known::AtMost(bound))) if of.column.ends_with("_per_m2") => [0.0, bound / 3.0],
        Some(Value::Reported(Known::Exact(value))) => [value, f64::NAN],
        Some(Value::Reported(known @ Known::Between(_))) => [known.value(), f64::NAN],
        _ => [f64::NAN; 2],
    };
    kept.flat_map(number).collect()
}

/// The measures of patches that studies keep, in the order of their columns.
fn patch_columns() -> impl Iterator<Item = &'static Measure<PatchFindings>> {
    measure::with_errors(PATCH_MEASURES).filter(|of| !of.name.is_empty())
}

/// A study of two values of a key, or why it is refused.
///
/// # Panics
/// If its points do not differ.
fn study_of(text: &str, key: &str, values: &[String; 2]) -> Result<Study, String> {
    let [a, b] = values;
    let study = format!("web = 'web.toml'\ndesign = 'grid'\n[vary]\n{key} = [{a}, {b}]\n");
    let study = study_beside_cases(text, &study, &[]).map_err(|error| error.to_string())?.study;
    assert_ne!(study.points[0].experiment, study.points[1].experiment, "{key} is not set");
    Ok(study)
}

/// What the two points of a study give.
fn together(study: &Study) -> [Vec<u64>; 2] {
    let (stop, steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let computing = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &steps };
    let bundle = [0, 1].map(|point| Batch { point, replicates: 0..1 });
    let records = fly_bundle(&study.points, &study.patch_sides(), &bundle, computing).unwrap();
    [0, 1].map(|point| {
        let measured = records[point].outcome.measured().unwrap();
        // A web has nothing of the patches of the other one.
        let sides = study.patch_sides();
        let own = &study.points[point].experiment.web().unwrap().sheet.patches;
        let has = |i: usize| sides.get(i / patch_columns().count()).is_none_or(|side| own.contains(side));
        (0..measured.len()).filter(|i| has(*i)).map(|i| measured[i].to_bits()).collect()
    })
}

/// What is found when every key of some webs varies.
#[derive(Default)]
struct Found {
    varied: BTreeSet<String>,
    wrong: Vec<String>,
    /// Why keys do not vary in some of the webs.
    refused: BTreeMap<String, String>,
}

/// Varies every key of all webs, and simulates some of them.
fn vary_every_key(is_simulated: impl Fn(&str) -> bool) -> Found {
    let mut found = Found::default();
    for (name, text) in WEBS {
        let web = web_beside_cases(text, &[]).unwrap().spec;
        let mut known = BTreeMap::new();
        // What is not of a layer varies once, and a simulated web, which takes long, varies only what the others
        // cannot.
        let done: BTreeSet<&str> = found.varied.iter().filter_map(|full| Some(web_key(full)?.name)).collect();
        let is_once =
            |key: &WebKey| name.starts_with("simulated") || ["web", "fabric"].contains(&key.table());
        let is_needed = |key: &&WebKey| key.varies && !(is_once(key) && done.contains(key.name));
        let needed: Vec<_> = WEB_KEYS.iter().filter(is_needed).collect();
        for key in needed {
            let full = full_name(&web, key);
            assert_eq!(web_key(&full).unwrap().name, key.name);
            let values = pair(key, &web);
            let study = match study_of(text, &full, &values) {
                Ok(study) => study,
                Err(why) => {
                    found.refused.insert(full, why);
                    continue;
                }
            };
            if is_simulated(name) {
                let single = [0, 1].map(|i: usize| alone(text, &full, &values[i], &mut known));
                if together(&study) != single {
                    found.wrong.push(format!("{name}: {full} = {values:?}"));
                }
            }
            found.varied.insert(full);
        }
    }
    found
}

/// Of webs in which no filament is simulated.
#[test]
fn identical_alone_and_in_a_study_for_every_key_of_a_known_web() {
    let found = vary_every_key(|name| !name.starts_with("simulated"));
    assert!(found.wrong.is_empty() && found.varied.len() > 40, "{} {:?}", found.varied.len(), found.wrong);
}

#[test]
#[ignore = "slow: every key of webs of simulated filaments"]
fn identical_alone_and_in_a_study_for_every_key_of_a_web() {
    let Found { varied, mut wrong, refused } = vary_every_key(|name| name.starts_with("simulated"));
    for key in WEB_KEYS.iter().filter(|key| key.varies) {
        if !varied.iter().any(|full| web_key(full).unwrap().name == key.name) {
            wrong.push(format!("no web of this test varies {}; add one", key.name));
        }
    }
    for full in [
        "layer.2.fibre.diameter",
        "layer.2.line.filaments_per_metre",
        "line.rows.2.offset",
        "line.charge",
        "line.throughput",
        "layer.2.line.basis_weight",
    ] {
        assert!(varied.contains(full), "{full}: {:?}", refused.get(full));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// What is set in the simulated case is set in a study of its web, and the belt is that of the case.
#[test]
fn keys_of_a_flown_case_are_set_in_a_study() {
    let (_, text) = WEBS[3];
    let study = "web = 'web.toml'\ndesign = 'grid'\n[set]\nrun.replicates = 3\nrun.seed = 9\n[vary]\n\
                 fibre.diameter = ['18 µm', '20 µm']\n[link]\nbelt.speed = 'feed.speed / 10'\n";
    let points = study_beside_cases(text, study, &[]).unwrap().study.points;
    for (point, diameter) in points.iter().zip([18e-6, 20e-6]) {
        let web = point.experiment.web().unwrap();
        let layer = &web.layers[0];
        let LaydownSource::Case { case, .. } = &layer.source else { panic!("no case") };
        assert_eq!((case.run.replicates, case.run.seed), (3, 9));
        assert_eq!((case.fibre.diameter, layer.filament.diameter()), (diameter, diameter));
        assert_eq!((web.belt_speed, case.line.unwrap().belt_speed), (5.0, 5.0));
    }
}
