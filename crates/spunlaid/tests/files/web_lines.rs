//! Webs in the words of a line: throughput, titre, holes and basis weight, and the speeds that follow.

use crate::web_files::{KNOWN, assert_reads_back, bits, set};
use spunlaid_air::Lateral;
use spunlaid_ground::{Dimension, Severity};
use spunlaid_input::{LaydownSource, Overrides, WebFile, WebSpec, read_case, read_fit, read_web};
use spunlaid_web::Fibres;
use spunlaid_web::map::Filaments;
use std::fs;
use std::path::Path;

/// A line in its own words: 2 dtex, half a gram per minute and hole, 20 g/m².
const LINE: &str = r#"
[fibre]
linear_density = "2 dtex"
density = "910 kg/m³"
[laydown]
sigma_md = "18.4 mm"
sigma_cd = "18.3 mm"
noise = "12.4 m^-0.5"
[line]
throughput = "0.5 g/min"
basis_weight = "20 g/m²"
rows = [{ pitch = "even", filaments = 5000 }]
[web]
width = "1 m"
length = "1 m"
"#;

fn read_line(values: &[(&str, &str)]) -> WebFile {
    let values: Vec<_> = values.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    read_web((LINE, "../../cases/line.toml"), &values).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn analytic_speeds_follow_from_throughput_and_basis_weight() {
    let file = read_line(&[]);
    assert_reads_back(&file);
    for line in [
        "linear_density = \"2e-7 kg/m\"",
        "basis_weight = \"0.02 kg/m²\"",
        "pitch = \"even\"",
        "throughput = ",
    ] {
        assert!(file.text.contains(line), "{line}: {}", file.text);
    }
    let layer = &file.spec.layers[0];
    // 0.5 g/min over 2 dtex; 5000 of them over 20 g/m².
    let near = |found: f64, wanted: f64| assert!((found / wanted - 1.0).abs() < 1e-12, "{found} {wanted}");
    near(layer.filament.feed_speed(), 0.5e-3 / 60.0 / 2e-7);
    near(file.spec.belt_speed, 5000.0 * 0.5e-3 / 60.0 / 20e-3);
    let LaydownSource::Surrogate(surrogate) = layer.source else { panic!("numbers") };
    near(file.spec.web([Fibres::Surrogate(surrogate)]).basis_weight(), 20e-3);
    // The holes of a row stay even when their number or the width changes.
    for (key, value, pitch) in [("line.rows.1.filaments", "4000", 0.25e-3), ("web.width", "2 m", 0.4e-3)] {
        let Filaments::Rows(rows) = &read_line(&[(key, value)]).spec.layers[0].filaments else {
            panic!("rows")
        };
        near(rows[0].pitch, pitch);
    }
}

/// What is written in other words comes to the same.
#[test]
fn any_complete_set_of_numbers_is_read() {
    let [feed, belt] = [0.5e-3 / 60.0 / 2e-7, 5000.0 * 0.5e-3 / 60.0 / 20e-3];
    let speeds = |file: &WebFile| [file.spec.layers[0].filament.feed_speed(), file.spec.belt_speed];
    let of_text = |text: &str| read_web((text, "line.toml"), &[]).unwrap_or_else(|error| panic!("{error}"));
    for (line, wanted) in [
        ("throughput = \"0.5 g/min\"\nbasis_weight = \"20 gsm\"", [feed, belt]),
        ("feed_speed = \"2500 m/min\"\nbasis_weight = \"20 g/m²\"", [feed, belt]),
        ("throughput = \"0.03 kg/h\"\nbelt_speed = \"125 m/min\"", [feed, belt]),
    ] {
        let text = LINE.replace("throughput = \"0.5 g/min\"\nbasis_weight = \"20 g/m²\"", line);
        let file = of_text(&text);
        assert_reads_back(&file);
        for (found, wanted) in speeds(&file).into_iter().zip(wanted) {
            assert!((found / wanted - 1.0).abs() < 1e-12 * wanted.max(1.0), "{line}: {found} {wanted}");
        }
    }
}

/// An override stands in place of what the file says in other words.
#[test]
fn an_override_replaces_the_other_key() {
    let line = |key: &str, value: &str| {
        let file = read_line(&[(key, value)]);
        assert_reads_back(&file);
        file.spec
    };
    assert_eq!(line("line.feed_speed", "50 m/s").layers[0].filament.feed_speed(), 50.0);
    assert_eq!(line("line.belt_speed", "3 m/s").belt_speed, 3.0);
    assert_eq!(line("fibre.diameter", "18 µm").layers[0].filament.diameter(), 18e-6);
    let known = |key: &str, value: &str| read_web(KNOWN, &set(key, value)).unwrap().spec;
    let filament = |key: &str, value: &str| known(key, value).layers[0].filament;
    assert!((filament("line.throughput", "0.5 g/min").feed_speed() - 35.99).abs() < 0.01);
    assert!((known("line.basis_weight", "30 g/m²").belt_speed - 0.5 * 3.8594).abs() < 1e-4);
    assert!((filament("fibre.linear_density", "2 dtex").diameter() - 16.73e-6).abs() < 1e-8);
    let rows = known("line.rows", "[{ pitch = 'even', filaments = 1000 }]").layers.remove(0).filaments;
    assert!(matches!(&rows, Filaments::Rows(rows) if rows[0].filaments == 1000), "{rows:?}");
    assert_eq!(
        line("line.filaments_per_metre", "4000").layers[0].filaments,
        Filaments::AtRandom { per_metre: 4000.0 }
    );
    // Nothing is said twice.
    let both = [("line.feed_speed", "50 m/s"), ("line.throughput", "0.5 g/min")];
    let both = both.map(|(key, value)| (key.to_owned(), value.to_owned()));
    let said = read_web((LINE, "line.toml"), &both).unwrap_err().to_string();
    assert!(
        said.contains("line.throughput = \"0.5 g/min\" cannot be combined with line.feed_speed"),
        "{said}"
    );
}

/// The basis weight is that of all layers: one belt carries them.
#[test]
fn analytic_several_layers_make_up_the_basis_weight() {
    let second = |line: &str| {
        format!(
            "[[layer]]\n[layer.fibre]\nlinear_density = \"1 dtex\"\ndensity = \"910 kg/m³\"\n\
            [layer.laydown]\nsigma_md = \"20 mm\"\nsigma_cd = \"20 mm\"\nnoise = \"10 m^-0.5\"\n\
            [layer.line]\nfilaments_per_metre = 3000\nfeed_speed = \"40 m/s\"\n{line}"
        )
    };
    let first = LINE
        .replace("[fibre]", "[[layer]]\n[layer.fibre]")
        .replace("[laydown]", "[layer.laydown]")
        .replace("[line]", "[layer.line]")
        .replace("basis_weight = \"20 g/m²\"\n", "");
    let weight = "basis_weight = \"20 g/m²\"\n";
    for text in [
        format!("{}{}", first.replace("rows = ", &format!("{weight}rows = ")), second("")),
        format!("{first}{}", second(weight)),
        format!("{}{}", first.replace("rows = ", &format!("{weight}rows = ")), second(weight)),
    ] {
        let file = read_web((&text, "layers.toml"), &[]).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_reads_back(&file);
        let belt = (5000.0 * 0.5e-3 / 60.0 + 3000.0 * 1e-7 * 40.0) / 20e-3;
        assert!((file.spec.belt_speed / belt - 1.0).abs() < 1e-12, "{}", file.spec.belt_speed);
        // Whichever layer is named, the belt is that of both.
        let faster = read_web((&text, "layers.toml"), &set("layer.2.line.belt_speed", "5 m/s")).unwrap().spec;
        assert_eq!(faster.belt_speed, 5.0);
    }
}

/// The numbers of the line hold for the case that is simulated.
#[test]
fn a_case_is_flown_with_the_throughput_and_the_belt_of_its_web() {
    let read = |case: &str, values: &[(&str, &str)]| {
        let text = format!(
            "[laydown]\ncase = \"{case}.toml\"\n[line]\nfilaments_per_metre = 5000\n[web]\nwidth = \"1 m\"\n\
            length = \"1 m\"\n"
        );
        let values: Vec<_> = values.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
        read_web((&text, "../../cases/line.toml"), &values).unwrap_or_else(|error| panic!("{error}"))
    };
    let case = |file: &WebFile| file.spec.layers[0].source.case().unwrap().clone();
    let near = |found: f64, wanted: f64| assert!((found / wanted - 1.0).abs() < 1e-9, "{found} {wanted}");
    let line = [("line.throughput", "0.5 g/min"), ("line.basis_weight", "20 g/m²")];
    let file = read("spunbond", &line);
    assert_reads_back_beside_cases(&file);
    let (layer, simulated) = (&file.spec.layers[0], case(&file));
    near(simulated.throughput().unwrap(), 0.5e-3 / 60.0);
    near(simulated.line.unwrap().belt_speed, 5000.0 * 0.5e-3 / 60.0 / 20e-3);
    let Some(speeds) = simulated.line.map(|line| [line.feed_speed, line.belt_speed]) else {
        panic!("no line")
    };
    assert_eq!([layer.fed_filament().feed_speed(), file.spec.belt_speed], speeds);
    // The throughput is written as it is given, and holds for a filament of another size.
    assert!(file.text.contains("throughput = ") && !file.text.contains("\nspeed = "), "{}", file.text);
    let thicker = read_web((&file.text, "web.toml"), &set("fibre.diameter", "20 µm")).unwrap().spec;
    near(thicker.layers[0].fed_filament().throughput(), 0.5e-3 / 60.0);
    let said: Vec<String> = file.notes.iter().map(ToString::to_string).collect();
    for note in [
        "line.throughput = \"0.5 g/min\" is laid with feed.speed = 35.99 m/s instead of the 50 m/s of ",
        "line.basis_weight = \"20 g/m²\" is laid with belt.speed = 2.083 m/s instead of the 3 m/s of ",
    ] {
        assert!(said.iter().any(|said| said.contains(note)), "{said:?}");
    }
    // The same case with these speeds written into it.
    let alone =
        [("feed.speed", format!("{:e} m/s", speeds[0])), ("belt.speed", format!("{:e} m/s", speeds[1]))];
    let alone = alone.map(|(key, value)| (key.to_owned(), value));
    let mut alone = read_case("../../cases/spunbond.toml", &alone).unwrap().0;
    alone.air.lateral = Lateral::VonKarman { cutoff: 10.0 };
    assert_eq!(alone, simulated);
    // A spinline is solved with the throughput.
    let file = read("whole_line_fibre", &[("line.throughput", "0.4 g/min")]);
    let simulated = case(&file);
    near(simulated.throughput().unwrap(), 0.4e-3 / 60.0);
    assert_eq!(simulated.spinline.as_ref().unwrap().throughput, 0.4e-3 / 60.0);
    assert!(simulated.fibre.diameter < case(&read("whole_line_fibre", &[])).fibre.diameter);
    // What the case has itself is no change.
    let file =
        read("whole_line_fibre", &[("line.throughput", "0.5 g/min"), ("line.basis_weight", "13.9 g/m²")]);
    assert!(!file.notes.iter().any(|note| note.to_string().contains("instead of")), "{:?}", file.notes);
}

/// A note reports which number of the named case is replaced, and by what: 19 µm stand in this file, and are no case's.
#[test]
fn a_note_names_the_layer_that_replaces_a_number_of_its_case() {
    let text = "[fibre]\ndiameter = \"19 µm\"\n[[layer]]\nlaydown.case = \"spunbond.toml\"\n\
        fibre.diameter = \"17 µm\"\nline.filaments_per_metre = 5000\n[web]\nwidth = \"1 m\"\nlength = \"1 m\"\n";
    let file = read_web((text, "../../cases/line.toml"), &[]).unwrap_or_else(|error| panic!("{error}"));
    let said = file.notes.iter().map(ToString::to_string).filter(|note| note.contains("instead of the"));
    let said: Vec<String> = said.collect();
    let wanted =
        "layer.1.fibre.diameter = \"17 µm\" is laid with fibre.diameter = 17 µm instead of the 18 µm of ";
    assert!(matches!(&said[..], [said] if said.contains(wanted)), "{said:?}");
}

fn assert_reads_back_beside_cases(file: &WebFile) {
    let again = read_web((&file.text, "web.toml"), &[]).unwrap();
    assert_eq!(bits(&again.spec), bits(&file.spec), "{}", file.text);
}

/// What is doubted of the numbers of a line.
fn doubted(file: &WebFile) -> Vec<&'static str> {
    let words =
        ["basis weight", "spinning speed", "speed of the belt", "throughput of a hole", "titre", "filament"];
    let all = file
        .notes
        .iter()
        .filter(|note| note.severity == Severity::Implausible)
        .map(|note| note.cause.to_string());
    let word = |text: String| {
        words.into_iter().find(|word| text.starts_with(&format!("is outside the usual range: a {word} of ")))
    };
    all.map(|text| word(text).unwrap()).collect()
}

#[test]
fn a_value_may_be_a_change_of_the_one_before() {
    let value = |file: &WebFile, key: &str| {
        let line = file.text.lines().find_map(|line| line.trim().strip_prefix(&format!("{key} = ")));
        line.map(|value| value.trim_matches('"').to_owned()).unwrap()
    };
    for (key, change, written) in [
        ("line.throughput", "+20 %", "1e-5 kg/s"),
        ("line.throughput", "-0.1 g/min", "0.4 g/min"),
        ("line.throughput", "−40%", "0.3 g/min"),
        ("fibre.linear_density", "-0.2 dtex", "1.8e-7 kg/m"),
        ("line.basis_weight", "+2 g/m²", "22 g/m²"),
    ] {
        let found = value(&read_line(&[(key, change)]), key.split_once('.').unwrap().1);
        let kind = [Dimension::MassFlow, Dimension::LinearDensity, Dimension::BasisWeight];
        let si = |text: &str| kind.iter().find_map(|dimension| dimension.parse(text).ok()).unwrap();
        assert!((si(&found) / si(written) - 1.0).abs() < 1e-12, "{key} {change}: {found}");
    }
    // One change after the other.
    let twice = read_line(&[("line.throughput", "+20 %"), ("line.throughput", "+50 %")]);
    assert_eq!(value(&twice, "throughput"), "1.5e-5 kg/s");
    for (key, change, message) in [
        ("line.feed_speed", "+20 %", "is a change of a value that is not given; write the value itself"),
        ("line.throughput", "-100 %", "is not positive"),
        ("line.throughput", "+x %", "is not a relative change; write one like \"+20 %\" or \"-5 %\""),
        ("line.throughput", "+1 m/s", "is a velocity"),
    ] {
        let values = set(key, change);
        let said = read_web((LINE, "../../cases/line.toml"), &values).unwrap_err().to_string();
        assert!(said.contains(message), "{key} {change}: {said}");
    }
}

#[test]
fn a_range_of_a_fit_may_be_changes_of_the_value_in_the_file() {
    let fit = |vary: &str, values: &[(String, String)]| {
        let set = Overrides::new(values, "--set");
        let file = read_fit((LINE, "../../cases/line.toml"), set, &[vary.to_owned()], "--vary");
        file.map(|file| file.parameters[0].range).map_err(|error| error.to_string())
    };
    let g_min = 1e-3 / 60.0;
    for (vary, expected) in [
        ("line.throughput=-20 %..+0.1 g/min", [0.4, 0.6]),
        ("line.throughput=\"−40%\"..\"1 g/min\"", [0.3, 1.0]),
    ] {
        let range = fit(vary, &[]).unwrap();
        for (found, expected) in range.iter().zip(expected) {
            assert!((found / (expected * g_min) - 1.0).abs() < 1e-12, "{vary}: {range:?}");
        }
    }
    // The value is that of the start, which is a change too.
    let start = fit("line.throughput=-50 %..+50 %", &set("line.throughput", "+20 %")).unwrap();
    assert!((start[0] / (0.3 * g_min) - 1.0).abs() < 1e-12, "{start:?}");
    for (vary, message) in [
        (
            "line.slot_gap=-20 %..+20 %",
            "is a change of a value that is not given; write line.slot_gap=FROM..TO with values",
        ),
        ("line.throughput=-100 %..+20 %", "is not positive"),
        ("line.throughput=+20 %..-20 %", "write the smaller value first"),
        ("line.throughput=-x %..+20 %", "is not a relative change; write one like \"+20 %\" or \"-5 %\""),
    ] {
        let said = fit(vary, &[]).unwrap_err();
        assert!(said.contains(message), "{vary}: {said}");
    }
}

#[test]
fn a_key_without_the_number_of_a_layer_is_set_in_all_that_have_it() {
    let layer = |throughput: f64, belt: &str| {
        format!(
            "[[layer]]\nlaydown = {{sigma_md = \"18 mm\", sigma_cd = \"18 mm\", noise = \"12 m^-0.5\"}}\n\
             fibre = {{linear_density = \"2 dtex\", density = \"900 kg/m³\"}}\n\
             line = {{throughput = \"{throughput} g/min\", filaments_per_metre = 3000{belt}}}\n"
        )
    };
    let text = [
        &layer(0.6, ", belt_speed = \"4 m/s\""),
        &layer(0.5, ""),
        "[web]\nwidth = \"1 m\"\nlength = \"1 m\"\n",
    ];
    let read =
        |key: &str, change: &str| read_web((&text.concat(), "two.toml"), &set(key, change)).unwrap().spec;
    let speeds = |spec: &WebSpec| {
        let g_min = 1e-3 / 60.0;
        [0, 1].map(|layer| (spec.layers[layer].filament.feed_speed() * 2e-7 / g_min * 1e6).round() / 1e6)
    };
    assert_eq!(speeds(&read("line.throughput", "+20 %")), [0.72, 0.6]);
    assert_eq!(speeds(&read("line.throughput", "0.4 g/min")), [0.4, 0.4]);
    assert_eq!(speeds(&read("layer.2.line.throughput", "-0.1 g/min")), [0.6, 0.4]);
    // Only one of them has the speed of the belt.
    assert_eq!(read("line.belt_speed", "+1 m/s").belt_speed, 5.0);
}

/// By hand, with γ = 1.4, 101,325 Pa and 1.204 kg/m³: 0.9 × 343.25 m/s × √(5 (1.034542^0.285714 − 1)) = 68.21 m/s.
#[test]
fn analytic_the_pressure_of_the_cabin_is_a_velocity_of_the_air() {
    let air = |set: &[(&str, &str)]| {
        let set: Vec<_> = set.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
        let file = read_web(Path::new("../../cases/web_shared.toml"), &set).unwrap();
        assert_reads_back_beside_cases(&file);
        file.spec.layers[0].source.case().unwrap().air.clone()
    };
    let near = |found: Option<f64>, wanted: f64| (found.unwrap() / wanted - 1.0).abs() < 1e-4;
    for (key, value) in [
        ("air.cabin_pressure", "3500 Pa"),
        ("line.cabin_pressure", "35 mbar"),
        ("air.cabin_pressure", "14.0512 inH2O"),
    ] {
        let found = air(&[(key, value)]);
        assert!(near(found.velocity_at_slot(), 68.208), "{key} = {value}: {:?}", found.velocity_at_slot());
    }
    let pressure = ("air.cabin_pressure", "3500 Pa");
    let measured = air(&[pressure, ("air.speed_coefficient", "0.8"), ("air.cabin_pressure", "+0 %")]);
    assert!(near(measured.velocity_at_slot(), 68.208 / 9.0 * 8.0));
    let more = air(&[("line.cabin_pressure", "3500 Pa"), ("line.cabin_pressure", "+20 %")]).cabin_pressure;
    assert!(near(more, 4200.0), "{more:?}");
    for (set, message) in [
        ("100 kPa", "makes air of Mach 0.94, and the flow is known up to 0.9"),
        ("3500 m/s", "is a velocity; write a pressure"),
        ("-1 Pa", "is a change of a value that is not given"),
    ] {
        let set = [("air.cabin_pressure".to_owned(), set.to_owned())];
        let said = read_web(Path::new("../../cases/web_shared.toml"), &set).unwrap_err().to_string();
        assert!(said.contains(message), "{said}");
    }
    // What is set takes the place of what is written in other words.
    let written =
        fs::read_to_string("../../cases/web_shared.toml").unwrap() + "[air]\ncabin_pressure = \"3500 Pa\"\n";
    let faster = read_web((&written, "../../cases/faster.toml"), &set("air.speed_factor", "1.5")).unwrap();
    assert_eq!(faster.spec.layers[0].source.case().unwrap().air.speed_factor, 1.5);
    let more = read_web((&written, "../../cases/more.toml"), &set("line.cabin_pressure", "+20 %")).unwrap();
    assert!(near(more.spec.layers[0].source.case().unwrap().air.cabin_pressure, 4200.0));
    let of_line = written.replace("[line]\n", "[line]\ncabin_pressure = \"3500 Pa\"\n");
    let of_line = of_line.replace("[air]\ncabin_pressure = \"3500 Pa\"\n", "");
    let faster = read_web((&of_line, "../../cases/faster.toml"), &set("air.speed_factor", "1.5")).unwrap();
    assert_eq!(faster.spec.layers[0].source.case().unwrap().air.speed_factor, 1.5);
    // A share of a factor that is not written would be one of the table, not of the air that the pressure makes.
    for text in [&written, &of_line] {
        let set = set("air.speed_factor", "+20 %");
        let said = read_web((text, "../../cases/faster.toml"), &set).unwrap_err().to_string();
        assert!(said.contains("is a change of a value that is not given"), "{said}");
    }
    let set = set("line.cabin_pressure", "3500 Pa");
    let said = read_web((LINE, "../../cases/line.toml"), &set).unwrap_err().to_string();
    assert!(said.contains("has no effect without a simulated filament; leave it out"), "{said}");
}

#[test]
fn numbers_that_no_spunbond_line_has_are_doubted() {
    let (throughput, speed, belt) = ("throughput of a hole", "spinning speed", "speed of the belt");
    let none: &[&str] = &[];
    for (key, value, doubts) in [
        ("line.throughput", "0.5 g/min", none),
        ("line.throughput", "2 g/min", &[speed]),
        ("line.throughput", "17 g/min", &[speed, belt, throughput]),
        ("fibre.linear_density", "0.2 dtex", &[speed, "titre"]),
        ("line.basis_weight", "2 g/m²", &["basis weight"]),
        ("line.belt_speed", "30 m/s", &["basis weight", belt]),
    ] {
        let mut found = doubted(&read_line(&[(key, value)]));
        found.sort_unstable();
        let mut doubts = doubts.to_vec();
        doubts.sort_unstable();
        assert_eq!(found, doubts, "{key} = {value}");
    }
    // Two beams have one belt and lay one weight, and each has a speed of its own.
    let beam = |speed: u32, belt: &str| {
        let known = "laydown = {sigma_md = \"18 mm\", sigma_cd = \"18 mm\", noise = \"12 m^-0.5\"}";
        let line = format!("line = {{feed_speed = \"{speed} m/s\", filaments_per_metre = 5000{belt}}}");
        format!(
            "[[layer]]\n{known}\n{line}\nfibre = {{linear_density = \"2 dtex\", density = \"900 kg/m³\"}}\n"
        )
    };
    let web = "[web]\nwidth = \"1 m\"\nlength = \"1 m\"\n";
    let text = [&beam(160, ", belt_speed = \"30 m/s\""), &beam(180, ""), web].concat();
    let mut found = doubted(&read_web((&text, "beams.toml"), &[]).unwrap());
    found.sort_unstable();
    assert_eq!(found, [belt, speed, speed]);
    let note = |file: &WebFile| {
        file.notes.iter().find(|note| note.severity == Severity::Implausible).unwrap().to_string()
    };
    let said = note(&read_line(&[("line.throughput", "2 g/min")]));
    assert!(
        said.ends_with(
            "line.feed_speed is outside the usual range: a spinning speed of 10000 m/min, where spunbond \
            lines have 500 to 8000 m/min; it follows from throughput and titre, so check both"
        ),
        "{said}"
    );
    // The air of this line has 60 m/s where it is fastest.
    let shared = |speed: &str| {
        let set = set("feed.speed", speed);
        read_web(Path::new("../../cases/web_shared.toml"), &set).unwrap()
    };
    assert_eq!(doubted(&shared("53 m/s")), none);
    assert_eq!(doubted(&shared("55 m/s")), ["filament"]);
    assert_eq!(doubted(&shared("66 m/s")), ["filament"]);
    let said = note(&shared("66 m/s"));
    assert!(
        said.contains(
            "a filament of 1.1 times the speed of its fastest air, where spunbond lines have 0.9 at most"
        ),
        "{said}"
    );
}
