//! Studies of webs: what they vary, and what they refuse.

use spunlaid_experiment::Point;
use spunlaid_ground::Error;
use spunlaid_input::{LaydownSource, Overrides, StudyFile, WebFile, parse_study, read_web, write_experiment};
use spunlaid_web::map::Filaments;
use std::path::Path;

const WEB: &str = r#"
[fibre]
diameter = "18 µm"
density = "910 kg/m³"
[laydown]
sigma_md = "9 mm"
sigma_cd = "8 mm"
noise = "15 m^-0.5"
[line]
feed_speed = "50 m/s"
belt_speed = "5 m/s"
filaments_per_metre = 200
[web]
width = "250 mm"
length = "250 mm"
seed = 3
"#;

fn study_of(web: &str, study: &str, set: &[(String, String)]) -> Result<StudyFile, Error> {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/web.toml");
    parse_study(study, "study.toml", Overrides::new(set, "--set"), |_, _| {
        Ok((web.to_owned(), cases.display().to_string()))
    })
}

/// A study of a web whose cases are beside those of the bad webs.
pub fn study_beside_cases(web: &str, study: &str, set: &[(String, String)]) -> Result<StudyFile, Error> {
    parse_study(study, "study.toml", Overrides::new(set, "--set"), |_, _| {
        Ok((web.to_owned(), BESIDE_CASES.to_owned()))
    })
}

/// A web beside these cases.
pub fn web_beside_cases(web: &str, set: &[(String, String)]) -> Result<WebFile, Error> {
    read_web((web, BESIDE_CASES), set)
}

const BESIDE_CASES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/bad_webs/web.toml");

fn web_of(point: &Point) -> &spunlaid_input::WebSpec {
    point.experiment.web().unwrap()
}

/// The only layer of a point's web.
fn layer(point: &Point) -> &spunlaid_input::LayerSpec {
    &web_of(point).layers[0]
}

fn study(text: &str) -> Result<StudyFile, Error> {
    study_of(WEB, text, &[])
}

#[test]
fn what_is_asked_for_replaces_what_a_study_sets_in_other_words() {
    let study = "web = 'web.toml'\ndesign = 'grid'\n[set]\n'line.basis_weight' = '20 g/m²'\n[vary]\n'web.seed' = [3]\n";
    let belt =
        |set: &[(String, String)]| web_of(&study_of(WEB, study, set).unwrap().study.points[0]).belt_speed;
    let asked = ("line.belt_speed".to_owned(), "4 m/s".to_owned());
    assert_ne!(belt(&[]), 4.0);
    assert_eq!(belt(&[asked]), 4.0);
}

#[test]
fn points_are_webs_with_these_values() {
    let file = study(
        "web = 'web.toml'\ndesign = 'grid'\nreplicates = 3\n[set]\nweb.cell = '5 mm'\n[vary]\n\
         line.belt_speed = ['4 m/s', '5 m/s']\n'line.filaments_per_metre' = [100, 200, 300]\n",
    )
    .unwrap();
    assert_eq!((file.study.replicates.at_most, file.study.points.len()), (3, 6));
    for point in &file.study.points {
        // The same file with the values written in it.
        let set = [
            ("line.belt_speed", format!("{} m/s", point.values[0])),
            ("line.filaments_per_metre", format!("{}", point.values[1])),
            ("web.cell", "5 mm".to_owned()),
        ];
        let set = set.map(|(key, value)| (key.to_owned(), value));
        let alone = read_web((WEB, "web.toml"), &set).unwrap();
        assert_eq!(write_experiment(&point.experiment), alone.text);
    }
    // The study as it was run gives the same points.
    let again = study_of(&file.base_text, &file.text, &[]).unwrap();
    assert_eq!(again.study.identity(), file.study.identity());
    assert_eq!(again.text, file.text);
    // More webs of each point are the same study; another seed is not.
    let set = [("web.seed".to_owned(), "4".to_owned())];
    let other = study_of(&file.base_text, &file.text, &set).unwrap();
    assert_ne!(other.study.identity(), file.study.identity());
}

#[test]
fn keys_of_the_case_that_is_flown_vary_too() {
    let web = "[laydown]\ncase = 'spunbond.toml'\n[line]\nfilaments_per_metre = 5000\n\
               [web]\nwidth = '1 m'\nlength = '1 m'\n";
    let text = "web = 'web.toml'\ndesign = 'one-at-a-time'\n[vary]\n'belt.speed' = ['2 m/s', '4 m/s']\n";
    let file = study_of(web, text, &[]).unwrap();
    let belts: Vec<f64> = (file.study.points.iter())
        .map(|point| {
            let LaydownSource::Case { case, .. } = &layer(point).source else { panic!("no case") };
            assert_eq!(case.line.unwrap().belt_speed, web_of(point).belt_speed);
            web_of(point).belt_speed
        })
        .collect();
    // The first point is the web as it stands.
    assert_eq!(belts, [3.0, 2.0, 4.0]);
}

/// A study goes on from its own folder, where the web is written with every default, to the same points: what
/// follows from what varies must not be written as a number of its own.
#[test]
fn identical_points_again_where_numbers_follow_from_others() {
    let known = WEB
        .replace("diameter = \"18 µm\"", "linear_density = \"2 dtex\"")
        .replace(
            "feed_speed = \"50 m/s\"\nbelt_speed = \"5 m/s\"",
            "throughput = \"0.5 g/min\"\nbasis_weight = \"2 g/m²\"",
        )
        .replace("filaments_per_metre = 200", "rows = [{ pitch = \"even\", filaments = 50 }]");
    let simulated = "[laydown]\ncase = 'spunbond.toml'\n[line]\nfilaments_per_metre = 5000\nbasis_weight = '20 g/m²'\n\
                 [web]\nwidth = '1 m'\nlength = '1 m'\n";
    for (web, key, values) in [
        (&*known, "line.throughput", "['0.4 g/min', '0.6 g/min']"),
        (&known, "line.feed_speed", "['40 m/s', '60 m/s']"),
        (&known, "line.basis_weight", "['1 g/m²', '4 g/m²']"),
        (&known, "line.belt_speed", "['3 m/s', '4 m/s']"),
        (&known, "fibre.linear_density", "['1 dtex', '4 dtex']"),
        (&known, "fibre.density", "['905 kg/m³', '1340 kg/m³']"),
        (&known, "line.rows.1.filaments", "[40, 80]"),
        (&known, "web.width", "['250 mm', '500 mm']"),
        (simulated, "line.throughput", "['0.4 g/min', '0.6 g/min']"),
        (simulated, "line.basis_weight", "['15 g/m²', '30 g/m²']"),
        (simulated, "belt.speed", "['3 m/s', '5 m/s']"),
        (simulated, "fibre.linear_density", "['1 dtex', '4 dtex']"),
        (simulated, "feed.speed", "['40 m/s', '60 m/s']"),
    ] {
        let text = format!("web = 'web.toml'\ndesign = 'grid'\n[vary]\n'{key}' = {values}\n");
        let file = study_of(web, &text, &[]).unwrap_or_else(|error| panic!("{key}: {error}"));
        let [a, b] = &file.study.points[..] else { panic!("two points") };
        assert_ne!(a.experiment, b.experiment, "{key}");
        let again =
            study_of(&file.base_text, &file.text, &[]).unwrap_or_else(|error| panic!("{key}: {error}"));
        for (point, again) in file.study.points.iter().zip(&again.study.points) {
            assert_eq!(write_experiment(&again.experiment), write_experiment(&point.experiment), "{key}");
        }
        assert_eq!(again.study.identity(), file.study.identity(), "{key}");
    }
    // A basis weight that the study varies decides the belt of the case, and a belt that it varies the basis weight.
    let belts = |key: &str, values: &str| -> Vec<f64> {
        let text = format!("web = 'web.toml'\ndesign = 'grid'\n[vary]\n'{key}' = {values}\n");
        let points = study_of(simulated, &text, &[]).unwrap().study.points;
        points.iter().map(|point| layer(point).source.case().unwrap().line.unwrap().belt_speed).collect()
    };
    let [thin, thick] = belts("line.basis_weight", "['15 g/m²', '30 g/m²']")[..] else {
        panic!("two points")
    };
    assert!((thin / thick - 2.0).abs() < 1e-12, "{thin} {thick}");
    assert_eq!(belts("belt.speed", "['3 m/s', '5 m/s']"), [3.0, 5.0]);
    let set = "web = 'web.toml'\ndesign = 'grid'\n[set]\n'line.basis_weight' = '20 g/m²'\n[vary]\n";
    let said = |vary: &str| study_of(simulated, &format!("{set}{vary}\n"), &[]).unwrap_err().to_string();
    let said = said("'belt.speed' = ['3 m/s']");
    let twice = "belt.speed is set to one value for all points by line.basis_weight, and varied";
    assert!(said.contains(twice), "{said}");
    let said = study(&format!("{set}'line.belt_speed' = ['3 m/s']\n")).unwrap_err().to_string();
    let set = "line.belt_speed is set to one value for all points by line.basis_weight, and varied";
    assert!(said.contains(set), "{said}");
}

/// A web of two layers, in which the belt speed is written once.
const LAYERS: &str = r#"
[web]
width = "250 mm"
length = "250 mm"
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
belt_speed = "4 m/s"
filaments_per_metre = 5000
[[layer]]
name = "M"
[layer.fibre]
diameter = "4 µm"
density = "910 kg/m³"
[layer.laydown]
sigma_md = "9 mm"
sigma_cd = "8 mm"
noise = "15 m^-0.5"
[layer.line]
feed_speed = "50 m/s"
filaments_per_metre = 200
"#;

#[test]
fn keys_of_one_layer_vary_by_its_number_and_by_its_name() {
    let study = |layer: &str| {
        let text = format!(
            "web = 'web.toml'\ndesign = 'grid'\n[vary]\nlayer.{layer}.line.filaments_per_metre = [100, 300]\n[link]\n\
             layer.1.line.belt_speed = 'layer.1.line.feed_speed / 10'\n'layer.{layer}.laydown.sigma_md' = '1000 * \
             layer.2.fibre.diameter'\n"
        );
        study_beside_cases(LAYERS, &text, &[]).unwrap_or_else(|error| panic!("{error}"))
    };
    let (by_number, by_name) = (study("2"), study("M"));
    assert_eq!(by_number.study.identity(), by_name.study.identity());
    assert_eq!(by_number.text, by_name.text);
    assert_eq!(by_number.study.factors[0].key.name, "layer.2.line.filaments_per_metre");
    for (point, wanted) in by_number.study.points.iter().zip([100.0, 300.0]) {
        let [first, second] = &web_of(point).layers[..] else { panic!("two layers") };
        assert_eq!(first.filaments, Filaments::AtRandom { per_metre: 5000.0 });
        assert_eq!(second.filaments, Filaments::AtRandom { per_metre: wanted });
        let LaydownSource::Surrogate(surrogate) = second.source else { panic!("numbers") };
        assert_eq!(surrogate.sigma_md, 1000.0 * 4e-6);
        // All layers lie on the belt of the first one.
        assert_eq!(web_of(point).belt_speed, 5.0);
    }
    // The study as it was run gives the same points.
    let again = study_beside_cases(&by_number.base_text, &by_number.text, &[]).unwrap();
    assert_eq!(again.study.identity(), by_number.study.identity());
}

#[test]
fn rejects_what_cannot_vary_of_a_layer() {
    for (line, wanted) in [
        (
            "line.filaments_per_metre = [100]",
            "write layer.1.line.filaments_per_metre, or the layer's name instead of 1",
        ),
        (
            "layer.3.line.filaments_per_metre = [100]",
            "is of a layer that the file does not have; it has layer.1 to layer.2",
        ),
        ("layer.M.line.filament_per_metre = [100]", "did you mean line.filaments_per_metre?"),
    ] {
        let text = format!("web = 'web.toml'\ndesign = 'grid'\n[vary]\n{line}\n");
        let said = study_beside_cases(LAYERS, &text, &[]).unwrap_err().to_string();
        assert!(said.contains(wanted), "{line}\n{said}\n{wanted}");
    }
    let simulated = "[laydown]\ncase = 'short.case'\n[line]\nfilaments_per_metre = 5000\n\
                 [web]\nwidth = '250 mm'\nlength = '250 mm'\n";
    let text = "web = 'web.toml'\ndesign = 'grid'\n[vary]\nrun.replicates = [4]\n";
    let said = study_beside_cases(simulated, text, &[]).unwrap_err().to_string();
    assert!(said.contains("the simulations of all points share it; write it under [set]"), "{said}");
}

#[test]
fn rejects_what_cannot_vary() {
    let vary = |line: &str| format!("web = 'web.toml'\ndesign = 'grid'\n[vary]\n{line}\n");
    for (text, wanted) in [
        (
            vary("'line.belt_sped' = ['4 m/s']"),
            "study.toml:4: line.belt_sped = ['4 m/s'] cannot be set by a study; did you mean line.belt_speed?",
        ),
        (vary("'laydown.case' = ['a.toml']"), "take a key whose value is a number or one of a few words"),
        (
            vary("'air.velocity' = ['4 m/s']"),
            "it is a key of a simulated filament, and this web simulates none",
        ),
        (
            vary("'line.belt_speed' = ['4 m/s']\n[set]\nrun.replicates = 4"),
            "study.toml: [set] run.replicates = 4 is a key of a simulated filament, and this web \
            simulates none; leave it out",
        ),
        (
            vary("layer.2.line.belt_speed = ['4 m/s']"),
            "is of a layer that the file does not have; it has no [[layer]], so write the key without layer",
        ),
        (vary("line.rows.pitch = ['4 mm']"), "write the number of the row, as in line.rows.1.pitch"),
        (
            vary("'line.belt_speed' = ['4 m/s', '60 m/s']"),
            "study.toml: point 2 (line.belt_speed = 60 m/s): line.belt_speed",
        ),
        (vary("'web.width' = ['250 mm', '10 mm']"), "study.toml: point 2 (web.width = 10 mm): web.width"),
        (vary("'line.belt_speed' = '4 m/s'"), "a list of values, or { from, to, steps }"),
        (vary("'line.belt_speed' = [4]"), "line.belt_speed"),
        (
            format!("case = 'c.toml'\n{}", vary("")),
            "cannot be combined with case; a study varies a case, a web or a spinline, so keep one of them",
        ),
        (
            "web = 3\ndesign = 'grid'\n".to_owned(),
            "web = 3 is a whole number; write a text like \"web.toml\"",
        ),
        (
            vary("'line.belt_speed' = ['4 m/s']\n[set]\n'line.belt_speed' = '5 m/s'"),
            "is set to one value for all points, and varied",
        ),
        (
            vary("'line.belt_speed' = ['4 m/s']\n[link]\n'line.feed_speed' = 'line.belt_sped'"),
            "did you mean line.belt_speed?",
        ),
        (
            vary("'line.belt_speed' = ['4 m/s']\n[link]\n'line.feed_speed' = 'web.width'"),
            "gives a value in m, but a velocity in m s^-1 is needed",
        ),
        (format!("replicates = 0\n{}", vary("'line.belt_speed' = ['4 m/s']")), "replicates = 0"),
        (vary(""), "vary is empty; add a key, like "),
    ] {
        let said = study(&text).unwrap_err().to_string();
        assert!(said.contains(wanted), "{text}\n{said}\n{wanted}");
    }
}
