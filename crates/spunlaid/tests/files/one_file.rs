//! A web and the case of its filament in one file, against the same in two.

use crate::web_files::bits;
use spunlaid_air::Lateral;
use spunlaid_fibre::Case;
use spunlaid_input::{WebFile, read_case, read_spinline, read_web};

const WHOLE: &str = "../../cases/whole_line.toml";
const FIBRE: &str = "../../cases/whole_line_fibre.toml";

/// A line whose filament is fed at the slot, in the words of a line.
const LINE: &str = r#"
version = 1
[line]
throughput = "0.5 g/min"
basis_weight = "20 g/m²"
filaments_per_metre = 5000
[web]
width = "1 m"
length = "1 m"
[fibre]
linear_density = "2 dtex"
density = "905 kg/m³"
youngs_modulus = "1.9 GPa"
[belt]
distance = "0.5 m"
[air]
profile = "tables/spunbond.csv"
widening = "md"
[run]
duration = "1 s"
"#;

/// Two layers of this filament; what stands above them is that of both.
const BEAMS: &str = r#"
[web]
width = "1 m"
length = "1 m"
[fibre]
linear_density = "2 dtex"
density = "905 kg/m³"
youngs_modulus = "1.9 GPa"
[belt]
distance = "0.5 m"
[air]
profile = "tables/spunbond.csv"
widening = "md"
[run]
duration = "1 s"
[[layer]]
name = "first"
[layer.line]
throughput = "0.5 g/min"
basis_weight = "20 g/m²"
filaments_per_metre = 3000
[[layer]]
[layer.line]
throughput = "0.4 g/min"
filaments_per_metre = 2000
"#;

const PLACE: &str = "../../cases/line.toml";

fn set(values: &[(&str, &str)]) -> Vec<(String, String)> {
    values.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect()
}

fn read(text: &str, values: &[(&str, &str)]) -> WebFile {
    read_web((text, PLACE), &set(values)).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn case(file: &WebFile, layer: usize) -> &Case {
    file.spec.layers[layer].source.case().unwrap()
}

fn refusal(text: &str, values: &[(&str, &str)]) -> String {
    read_web((text, PLACE), &set(values)).unwrap_err().to_string()
}

#[test]
fn identical_in_one_file_and_in_two() {
    let two = "[laydown]\ncase = \"whole_line_fibre.toml\"\n[line]\nfilaments_per_metre = 5000\n\
               [web]\nwidth = \"0.5 m\"\nlength = \"0.5 m\"\n";
    for values in [
        &[][..],
        &[("line.throughput", "0.4 g/min"), ("line.basis_weight", "20 g/m²")],
        &[("spinline.die_temperature", "240 °C"), ("belt.speed", "2 m/s"), ("web.width", "1 m")],
        &[("air.length_factor", "2"), ("run.replicates", "3"), ("web.assumed", "air.length_factor")],
    ] {
        let one = read_web(WHOLE, &set(values)).unwrap_or_else(|error| panic!("{error}"));
        let two = read(two, values);
        assert_eq!(bits(&one.spec), bits(&two.spec), "{values:?}");
        assert_eq!(one.text, two.text);
        // What is written is one file again.
        assert!(!one.text.contains("case = "), "{}", one.text);
        assert_eq!(bits(&read(&one.text.replace("../../cases/", ""), &[]).spec).len(), bits(&one.spec).len());
    }
}

/// A case as a web flies it.
fn in_one_air(mut case: Case) -> Case {
    case.air.lateral = Lateral::VonKarman { cutoff: 10.0 };
    case
}

#[test]
fn identical_filament_of_a_web_and_of_a_case() {
    let alone = read_case(FIBRE, &[]).unwrap().0;
    assert_eq!(read_case(WHOLE, &[]).unwrap().0, alone);
    assert_eq!(case(&read_web(WHOLE, &[]).unwrap(), 0), &in_one_air(alone));
    // In the words of a line too, and with what is set.
    for values in [&[][..], &[("air.speed_factor", "1.2"), ("line.basis_weight", "15 g/m²")]] {
        let (simulated, _) = read_case((LINE, PLACE), &set(values)).unwrap();
        assert_eq!(case(&read(LINE, values), 0), &in_one_air(simulated.clone()));
        assert!((simulated.throughput().unwrap() / (0.5e-3 / 60.0) - 1.0).abs() < 1e-12);
    }
    let whole = std::fs::read_to_string(WHOLE).unwrap();
    let solved = read_spinline((&whole, WHOLE), &set(&[("line.throughput", "0.4 g/min")])).unwrap();
    assert_eq!(solved.spec.spinline.throughput, 0.4e-3 / 60.0);
}

#[test]
fn a_speed_that_is_set_takes_the_place_of_what_gives_it() {
    let speeds = |values: &[(&str, &str)]| {
        let spec = read(LINE, values).spec;
        [spec.layers[0].filament.feed_speed(), spec.belt_speed]
    };
    let [feed, belt] = speeds(&[]);
    assert_eq!(speeds(&[("belt.speed", "3 m/s")]), [feed, 3.0]);
    assert_eq!(speeds(&[("line.belt_speed", "3 m/s")]), [feed, 3.0]);
    let slower = speeds(&[("feed.speed", "40 m/s")]);
    assert_eq!(slower[0], 40.0);
    assert!((slower[1] / belt - 40.0 / feed).abs() < 1e-12, "{slower:?}");
    // Half the titre at the same throughput is fed twice as fast, on the same belt.
    let fine = speeds(&[("fibre.linear_density", "1 dtex")]);
    assert!((fine[0] / feed - 2.0).abs() < 1e-12 && (fine[1] / belt - 1.0).abs() < 1e-12, "{fine:?}");
}

#[test]
fn layers_have_in_common_what_stands_above_them() {
    let file = read(BEAMS, &[]);
    let belt = (3000.0 * 0.5e-3 + 2000.0 * 0.4e-3) / 60.0 / 20e-3;
    for (number, throughput) in [0.5e-3 / 60.0, 0.4e-3 / 60.0].into_iter().enumerate() {
        let simulated = case(&file, number);
        assert!((simulated.throughput().unwrap() / throughput - 1.0).abs() < 1e-12);
        assert!((simulated.line.unwrap().belt_speed / belt - 1.0).abs() < 1e-12);
    }
    // What is written reads back, with what both have in common once.
    let again = read(&file.text.replace("../../cases/", ""), &[]);
    assert_eq!(file.text.matches("youngs_modulus").count(), 1, "{}", file.text);
    assert_eq!(again.text, file.text);
    // A key is that of all layers, or of the one that is named.
    let moduli = |key: &str| {
        let file = read(BEAMS, &[(key, "3 GPa")]);
        [0, 1].map(|layer| case(&file, layer).fibre.youngs_modulus)
    };
    assert_eq!(moduli("fibre.youngs_modulus"), [3e9, 3e9]);
    assert_eq!(moduli("layer.2.fibre.youngs_modulus"), [1.9e9, 3e9]);
    assert_eq!(moduli("layer.first.fibre.youngs_modulus"), [3e9, 1.9e9]);
    let own = format!("{BEAMS}[layer.fibre]\nyoungs_modulus = \"1 GPa\"\n");
    assert_eq!(case(&read(&own, &[]), 1).fibre.youngs_modulus, 1e9);
    assert_eq!(case(&read(&own, &[("fibre.youngs_modulus", "3 GPa")]), 1).fibre.youngs_modulus, 3e9);
    // One filament is simulated alone, so that it must be known which.
    let said = read_case((BEAMS, PLACE), &[]).unwrap_err().to_string();
    assert!(said.contains("have different filaments, and only one can be simulated"), "{said}");
    assert!(read_case((BEAMS, PLACE), &set(&[("layer.2.line.throughput", "0.5 g/min")])).is_ok());
}

#[test]
fn what_a_web_says_takes_the_place_of_what_its_case_says() {
    let text = "[laydown]\ncase = \"spunbond.toml\"\n[line]\nfilaments_per_metre = 5000\n[fibre]\n\
        linear_density = \"1 dtex\"\n[air]\nlength_factor = 2\n[web]\nwidth = \"1 m\"\nlength = \"1 m\"\n";
    let file = read(text, &[]);
    let values = [("fibre.linear_density", "1 dtex"), ("air.length_factor", "2")];
    let alone = read_case("../../cases/spunbond.toml", &set(&values)).unwrap().0;
    assert_eq!(case(&file, 0), &in_one_air(alone));
    let said: Vec<String> = file.notes.iter().map(ToString::to_string).collect();
    let note = "line.toml:6: fibre.linear_density = \"1 dtex\" is laid with fibre.diameter = 11.83 µm \
        instead of the 18 µm of ";
    assert!(said.iter().any(|said| said.contains(note)), "{said:?}");
}

#[test]
fn rejects_what_is_said_twice_or_is_missing() {
    let changed = |from: &str, to: &str| {
        assert!(LINE.contains(from), "{from}");
        LINE.replace(from, to)
    };
    for (text, message) in [
        (
            changed("[belt]", "[belt]\nspeed = \"3 m/s\""),
            "line.toml:5: line.basis_weight = \"20 g/m²\" cannot be combined with belt.speed; either gives the other",
        ),
        (
            changed("[belt]", "[feed]\nspeed = \"40 m/s\"\n[belt]"),
            "line.toml:4: line.throughput = \"0.5 g/min\" cannot be combined with feed.speed; either gives the other",
        ),
        (
            changed("basis_weight = \"20 g/m²\"\n", ""),
            "line.toml: belt.speed is missing; add speed = \"3 m/s\" to [belt]",
        ),
        (
            changed("throughput = \"0.5 g/min\"\n", ""),
            "line.toml: feed.speed is missing, and a case with [belt] needs it; add speed = \"50 m/s\" to [feed]",
        ),
        (changed("\"0.5 m\"", "\"0.5\""), "line.toml:15: belt.distance = \"0.5\" has no unit"),
        (
            changed("widening", "wideninng"),
            "line.toml:18: air.wideninng = \"md\" is not a key of a web file; did you mean air.widening?",
        ),
        (
            format!("{LINE}[laydown]\nsigma_md = \"10 mm\"\nsigma_cd = \"10 mm\"\nnoise = \"12 m^-0.5\"\n"),
            "cannot be combined with laydown.sigma_md; keep either the filament to be simulated or",
        ),
    ] {
        let said = refusal(&text, &[]);
        assert!(said.contains(message), "{message}\n{said}");
    }
    let said = refusal(LINE, &[("air.velocty", "3 m/s")]);
    assert!(
        said.contains(
            "override air.velocty = \"3 m/s\" is not a key of a web file; did you mean air.velocity?"
        ),
        "{said}"
    );
}
