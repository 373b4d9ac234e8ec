//! Files of webs: what is read is what was written, and nothing that is written makes the reader fail in
//! another way than by saying what is wrong.

use proptest::prelude::*;
use spunlaid_fibre::case::keys::Value;
use spunlaid_input::{LaydownSource, WEB_KEYS, WEB_TABLES, WebFile, WebSpec, read_web};
use spunlaid_simulation::Flown;
use spunlaid_web::map::Filaments;
use spunlaid_web::{Defect, Edges, Fibres, Row, Surrogate};
use std::fs;

pub(super) const KNOWN: &str = "../../cases/web_known.toml";
const FLOWN: &str = "../../cases/web.toml";

/// Two layers, with rows and at random.
const LAYERS: &str = r#"
version = 1
[web]
width = "1 m"
length = "2 m"
edges = "cut"
patches = ["5 mm", "1 mm", "5 mm"]
seed = 7
window = "1 cm"
[[layer]]
name = "first \"beam\""
[layer.fibre]
diameter = "18 µm"
density = "910 kg/m³"
[layer.laydown]
sigma_md = "18 mm"
sigma_cd = "18 mm"
noise = "12.4 1/√m"
[layer.line]
feed_speed = "50 m/s"
rows = [{ pitch = "0.5 mm", filaments = 2100 }, { offset = "-0.25 mm", pitch = "0.5 mm", filaments = 2100 }]
[[layer]]
[layer.fibre]
linear_density = "1.1 dtex"
density = "910 kg/m³"
[layer.laydown]
sigma_md = "30 mm"
sigma_cd = "12 mm"
noise = "7.95 1/√m"
[layer.line]
feed_speed = "60 m/s"
belt_speed = "3 m/s"
filaments_per_metre = 1200
"#;

pub(super) fn set(key: &str, value: &str) -> Vec<(String, String)> {
    vec![(key.to_owned(), value.to_owned())]
}

/// Equal texts mean equal bits. The path of a case is left out: a web that is written has it in its own file.
pub(super) fn bits(spec: &WebSpec) -> String {
    let mut spec = spec.clone();
    for layer in &mut spec.layers {
        if let LaydownSource::Case { path, .. } = &mut layer.source {
            path.clear();
        }
    }
    format!("{spec:?}")
}

pub(super) fn assert_reads_back(file: &WebFile) {
    let again =
        read_web((&file.text, "web.toml"), &[]).unwrap_or_else(|error| panic!("{error}\n{}", file.text));
    assert_eq!(bits(&again.spec), bits(&file.spec), "{}", file.text);
    assert_eq!(again.text, file.text);
}

#[test]
fn every_row_of_the_table_of_keys_is_whole() {
    let mut names: Vec<&str> = WEB_KEYS.iter().map(|key| key.name).collect();
    let keys_of_table =
        |table: &'static str| WEB_KEYS.iter().filter(move |key| key.name.starts_with(&format!("{table}.")));
    assert!(
        WEB_TABLES.into_iter().flat_map(keys_of_table).map(|key| key.name).eq(names.iter().copied()),
        "in the tables' order"
    );
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), WEB_KEYS.len());
    for key in WEB_KEYS {
        assert!(key.meaning.ends_with('.') && key.meaning.len() > 20, "{}", key.name);
    }
}

#[test]
fn identical_after_writing_and_reading() {
    assert_reads_back(&read_web(KNOWN, &[]).unwrap());
    assert_reads_back(&read_web(FLOWN, &[]).unwrap());
    assert_reads_back(&read_web((LAYERS, "layers.toml"), &[]).unwrap());
}

#[test]
fn the_known_web_is_what_its_file_says() {
    let WebFile { spec, notes, text } = read_web(KNOWN, &[]).unwrap();
    assert!(notes.is_empty());
    let [layer] = &spec.layers[..] else { panic!("{text}") };
    let LaydownSource::Surrogate(surrogate) = layer.source else { panic!("{text}") };
    assert_eq!(surrogate, Surrogate { sigma_md: 18.4e-3, sigma_cd: 18.3e-3, noise: 12.4 });
    // The defaults.
    assert_eq!(spec.sheet.patches, [1e-3, 2e-3, 5e-3, 10e-3, 20e-3, 50e-3]);
    assert_eq!((spec.sheet.cell, spec.sheet.edges, spec.flies()), (0.5e-3, Edges::Periodic, false));
    assert_eq!((spec.seed, spec.window, spec.sheet.cells()), (1, 20e-3, [2000, 2000]));
    // 5000 filaments of π/4 (18 µm)² 910 kg/m³ a metre, fed at 50 m/s, on a belt for 15 g/m².
    let web = spec.web([Fibres::Surrogate(surrogate)]);
    assert!((web.basis_weight() / 15e-3 - 1.0).abs() < 1e-4, "{}", web.basis_weight());
    for key in ["patches = [\"1e-3 m\", ", "cell = \"5e-4 m\"", "edges = \"periodic\"", "window = \"0.02 m\""]
    {
        assert!(text.contains(key), "{key}: {text}");
    }
}

#[test]
fn a_case_gives_the_fibre_and_the_speeds() {
    let spec = read_web(FLOWN, &[]).unwrap().spec;
    let [layer] = &spec.layers[..] else { panic!("one layer") };
    assert_eq!((layer.filament.diameter(), layer.filament.density), (18e-6, 910.0));
    assert_eq!((layer.filament.feed_speed(), spec.belt_speed), (50.0, 3.0));
    assert!(
        matches!(&layer.source, LaydownSource::Case { path, .. } if path.ends_with("cases/spunbond.toml"))
    );
    // The same numbers may be written again, also in other units.
    let text = fs::read_to_string(FLOWN).unwrap().replace("[line]", "[line]\nbelt_speed = \"180 m/min\"");
    let again = read_web((&text, FLOWN), &[]).unwrap().spec;
    assert_eq!(bits(&again), bits(&spec));
}

#[test]
fn rows_and_layers_are_read_in_their_order() {
    let spec = read_web((LAYERS, "layers.toml"), &[]).unwrap().spec;
    let [first, second] = &spec.layers[..] else { panic!("two layers") };
    assert_eq!(first.name.as_deref(), Some("first \"beam\""));
    let row = |offset: f64| Row::new(offset, 0.5e-3, 2100);
    assert_eq!(first.filaments, Filaments::Rows(vec![row(0.0), row(-0.25e-3)]));
    assert_eq!(second.filaments, Filaments::AtRandom { per_metre: 1200.0 });
    assert!(
        (second.filament.linear_density() / 1.1e-7 - 1.0).abs() < 1e-12,
        "{}",
        second.filament.linear_density()
    );
    // Patches come sorted, each once.
    assert_eq!((spec.sheet.patches, spec.sheet.edges), (vec![1e-3, 5e-3], Edges::Cut));
}

/// The air of a web in shared turbulence differs across the flow whether its case says so or not, so that the cut-off
/// alone can be set.
#[test]
fn identical_the_cutoff_of_one_air_is_set_with_or_without_its_turbulence_across() {
    let read = |values: &[(&str, &str)]| {
        let values: Vec<_> = values.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
        read_web(FLOWN, &values)
    };
    let cutoff = ("air.lateral_cutoff", "12");
    let lateral = ("air.lateral", "von-karman");
    let [alone, both] = [&[cutoff][..], &[lateral, cutoff]].map(|set| read(set).unwrap().spec);
    assert_eq!(alone.lateral_cutoff(0), Some(12.0));
    assert_eq!(alone, both);
    // What is written says what is simulated, whether the case does or not, and is the same web when it is read.
    let plain = read(&[]).unwrap();
    assert!(plain.text.contains("lateral = \"von-karman\"\nlateral_cutoff = "), "{}", plain.text);
    let uniform = read(&[("air.lateral", "uniform")]).unwrap();
    assert_eq!((uniform.text.contains("uniform"), &uniform.text), (false, &plain.text));
    [plain, uniform].iter().for_each(assert_reads_back);
    // Nobody overrules what is set.
    let said = read(&[("air.lateral", "uniform"), cutoff]).unwrap_err().to_string();
    assert!(said.contains("air.lateral_cutoff = 12 has no effect without air.lateral"), "{said}");
}

#[test]
fn a_slot_rows_at_places_along_and_one_air_are_read_and_written() {
    let read = |values: &[(&str, &str)]| {
        let values: Vec<_> = values.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
        read_web(FLOWN, &values).unwrap()
    };
    let in_slot = [
        ("line.rows", "auto"),
        ("line.filaments_per_metre", "500"),
        ("line.slot_gap", "20 mm"),
        ("web.memory_limit", "20 GB"),
    ];
    let file = read(&in_slot);
    assert_reads_back(&file);
    let mut spec = file.spec;
    assert_eq!(spec.layers[0].filaments, Filaments::Slot { per_metre: 500.0, depth: 20e-3 });
    assert_eq!((spec.flies(), spec.memory_limit), (true, 20e9));
    assert_eq!(spec.lateral_cutoff(0), Some(10.0));
    // A study varies the number of filaments and keeps the slot.
    let key = |name: &str| WEB_KEYS.iter().find(|key| key.name == name).unwrap();
    key("line.filaments_per_metre").set(&mut spec, 700_u64).unwrap();
    key("line.slot_gap").set(&mut spec, 0.0).unwrap();
    assert_eq!(spec.layers[0].filaments, Filaments::Slot { per_metre: 700.0, depth: 0.0 });

    let rows =
        "[{ pitch = \"1 mm\", filaments = 1000 }, { pitch = \"1 mm\", filaments = 1000, md = \"-5 mm\" }]";
    let file = read(&[("line.rows", rows)]);
    assert_reads_back(&file);
    let Filaments::Rows(rows) = &file.spec.layers[0].filaments else { panic!("rows") };
    assert_eq!(rows.iter().map(|row| row.md).collect::<Vec<_>>(), [0.0, -5e-3]);

    let defects =
        "[{ from = \"0.2 m\", titre = 0.5 }, { row = 1, to = \"0.1 m\", share = 0.25, after = \"1 s\" }]";
    let file = read(&[("line.defects", defects)]);
    assert_reads_back(&file);
    let half = Defect { from: Some(0.2), titre: 0.5, ..Defect::USUAL };
    let later = Defect { row: Some(1), to: Some(0.1), share: 0.25, after: 1.0, ..Defect::USUAL };
    assert_eq!(file.spec.layers[0].defects, [half, later]);
}

/// Filaments of cases hang in shared turbulence, and those of known numbers are independent: the source decides.
#[test]
fn a_web_hangs_in_one_air_where_its_filaments_fly() {
    let read = |text: &str| read_web((text, "web.toml"), &[]).unwrap();
    let simulated = "[laydown]\ncase = \"tests/bad_webs/short.case\"\n[line]\nfilaments_per_metre = 5000\n[web]\n\
        width = \"0.5 m\"\nlength = \"0.5 m\"\n";
    let known = fs::read_to_string(KNOWN).unwrap();
    for (text, flies) in [(simulated, true), (LAYERS, false), (&known, false)] {
        let file = read(text);
        assert_eq!(file.spec.flies(), flies, "{text}");
        assert_eq!(read(&file.text).spec.flies(), flies, "{}", file.text);
        // For a usual web there is no note that its air is a field in space.
        assert!(!file.notes.iter().any(|note| note.to_string().contains("von-karman")));
    }
}

#[test]
fn few_filaments_are_flown_as_a_web_says() {
    let read = |value: &str| read_web(FLOWN, &set("web.simulated", value)).unwrap();
    for (value, simulated, written) in [
        ("auto", Flown::Auto, None),
        ("all", Flown::All, Some("simulated = \"all\"")),
        ("200", Flown::PerMetre(200), Some("simulated = 200")),
    ] {
        let file = read(value);
        assert_eq!(file.spec.simulated, simulated);
        assert_reads_back(&file);
        assert_eq!(file.text.lines().find(|line| line.starts_with("simulated")), written, "{}", file.text);
    }
    let key = WEB_KEYS.iter().find(|key| key.name == "web.simulated").unwrap();
    let mut spec = read("auto").spec;
    for (value, simulated) in [
        (Value::from(300_u64), Flown::PerMetre(300)),
        ("all".into(), Flown::All),
        ("auto".into(), Flown::Auto),
    ] {
        key.set(&mut spec, value).unwrap();
        assert_eq!(spec.simulated, simulated);
    }
    assert!(key.set(&mut spec, 0_u64).is_err() && key.set(&mut spec, "some").is_err());
    assert_eq!(spec.simulated, Flown::Auto, "what is refused changes nothing");
}

#[test]
fn overrides_reach_every_layer_and_row() {
    let read = |key: &str, value: &str| read_web((LAYERS, "layers.toml"), &set(key, value)).unwrap().spec;
    assert_eq!(
        read("layer.2.line.filaments_per_metre", "7").layers[1].filaments,
        Filaments::AtRandom { per_metre: 7.0 }
    );
    for key in ["layer.1.line.rows.2.filaments", "layer.first \"beam\".line.rows.2.filaments"] {
        let Filaments::Rows(rows) = &read(key, "9").layers[0].filaments else { panic!("rows") };
        assert_eq!((rows[0].filaments, rows[1].filaments), (2100, 9));
    }
    let rows = "[{ pitch = \"1 mm\", filaments = 3 }]";
    let Filaments::Rows(rows) = &read("layer.1.line.rows", rows).layers[0].filaments else { panic!("rows") };
    assert_eq!((rows.len(), rows[0].filaments), (1, 3));
    let [patches, seed] =
        [("web.patches", "auto"), ("web.seed", "auto")].map(|(key, value)| read(key, value));
    assert_eq!((patches.sheet.patches.len(), seed.seed), (6, 1));
    // A list of rows can be undone to lay filaments at random.
    let mut undone = set("layer.1.line.rows", "auto");
    undone.extend(set("layer.1.line.filaments_per_metre", "5000"));
    let spec = read_web((LAYERS, "layers.toml"), &undone).unwrap().spec;
    assert_eq!(spec.layers[0].filaments, Filaments::AtRandom { per_metre: 5000.0 });
}

#[test]
fn cells_grow_with_the_web_and_divide_it() {
    let cell = |width: &str, length: &str| {
        let mut sizes = set("web.width", width);
        sizes.extend(set("web.length", length));
        read_web(KNOWN, &sizes).unwrap().spec.sheet.cell
    };
    assert_eq!(cell("2 m", "1 m"), 0.5e-3);
    assert_eq!(cell("3 m", "2 m"), 1e-3);
    // 100 m² at 2 mm are 25 million cells.
    assert_eq!(cell("10 m", "10 m"), 5e-3);
    // Twelve million cells of 0.5 mm are too many, and those of 1 mm do not divide it.
    assert_eq!(cell("1.602 m", "2.5 m"), 1e-3);
}

#[test]
fn spreads_that_are_known_only_after_the_flight_are_checked_too() {
    // A row as wide as the narrow web.
    let narrow = [("web.width", "140 mm"), ("line.rows.1.filaments", "700")];
    let narrow = narrow.map(|(key, value)| (key.to_owned(), value.to_owned()));
    let spec = read_web(FLOWN, &narrow).unwrap().spec;
    spec.check_spreads([18e-3, 17e-3]).unwrap();
    let said = spec.check_spreads([18e-3, 18e-3]).unwrap_err().to_string();
    assert!(
        said.starts_with("web.width = 140 mm is shorter than 8 times laydown.sigma_cd = 18 mm"),
        "{said}"
    );
    let mut cut = spec;
    cut.sheet.edges = Edges::Cut;
    cut.check_spreads([18e-3, 18e-3]).unwrap();
}

/// A web of text that is like a file: one of the files with some pieces replaced by others.
fn mutated() -> impl Strategy<Value = String> {
    let files = [fs::read_to_string(KNOWN).unwrap(), fs::read_to_string(FLOWN).unwrap(), LAYERS.to_owned()];
    let pieces = [
        "",
        "0",
        "-1",
        "1e400",
        "nan",
        "true",
        "\"",
        "[",
        "]",
        "{",
        "}",
        "=",
        "\n",
        "#",
        "[[layer]]\n",
        "[web]\n",
        "\"1e-300 m\"",
        "\"1e300 m\"",
        "\"3 m/s\"",
        "5000",
        "rows = [{}]\n",
        "rows = [[]]\n",
        "layer = 3\n",
        "name = \"\"\n",
        "case = \"spunbond.toml\"\n",
        "results = \".\"\n",
        "18446744073709551615",
        "line.rows = 1\n",
        "\u{7f}",
        "é",
    ];
    let cut = (0.0..1.0f64, 0usize..40, prop::sample::select(pieces.to_vec()));
    (prop::sample::select(files.to_vec()), prop::collection::vec(cut, 1..4)).prop_map(|(mut text, cuts)| {
        for (at, length, piece) in cuts {
            let near = |byte: usize| {
                (byte.min(text.len())..=text.len()).find(|i| text.is_char_boundary(*i)).unwrap()
            };
            let start = near((at * text.len() as f64) as usize);
            let end = near(start + length);
            text.replace_range(start..end, piece);
        }
        text
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn a_mutated_file_is_read_or_refused_in_words(text in mutated(), value in "[ -~]{0,12}", key in 0..WEB_KEYS.len()) {
        for overrides in [vec![], set(WEB_KEYS[key].name, &value)] {
            match read_web((&text, "../../cases/web.toml"), &overrides) {
                Ok(file) => assert_reads_back(&file),
                Err(error) => {
                    let said = error.to_string();
                    prop_assert!(!said.is_empty() && said.lines().count() <= 21);
                    prop_assert!(said.chars().all(|c| c == '\n' || !c.is_control()), "{:?}", said);
                }
            }
        }
    }
}

#[test]
fn rejects_assumed_values_that_have_no_half() {
    let two = LAYERS.replace("[web]", "[web]\nassumed = \"line.throughput\"");
    for (text, assumed, message) in [
        (
            KNOWN,
            "line.filaments_per_meter",
            "not a key of the web or of its cases; did you mean line.filaments_per_metre?",
        ),
        (KNOWN, "belt.distance", "it is a key of a simulated filament, and this web simulates none"),
        (KNOWN, "line.slot_gap", "names line.slot_gap, which is zero or not written here"),
        (KNOWN, "web.edges", "names web.edges, which cannot be halved or doubled"),
        (
            FLOWN,
            "air.length_scale",
            "names air.length_scale, which is given by a file; name air.length_factor",
        ),
        (FLOWN, "fibre.diameter, air.spectrum", "names air.spectrum, which cannot be halved"),
    ] {
        let refused = read_web(text, &set("web.assumed", assumed)[..]).unwrap_err().to_string();
        assert!(refused.contains("web.assumed") && refused.contains(message), "{assumed}: {refused}");
    }
    let refused = read_web((&two, "layers.toml"), &[]).unwrap_err().to_string();
    assert!(
        refused.contains("layers.toml:4: web.assumed") && refused.contains("line.throughput"),
        "{refused}"
    );
    // What can be halved is read, and written as it was.
    let file = read_web(FLOWN, &set("web.assumed", "belt.distance,line.rows.1.pitch")[..]).unwrap();
    assert_eq!(file.spec.assumed, ["belt.distance", "line.rows.1.pitch"]);
    assert!(file.text.contains("assumed = \"belt.distance, line.rows.1.pitch\""), "{}", file.text);
    assert_reads_back(&file);
    assert!(read_web(FLOWN, &set("web.assumed", "none")[..]).unwrap().spec.assumed.is_empty());
}

/// A list of names may be empty: it is written as the word `none`, which is no name in a longer list.
#[test]
fn an_empty_list_of_names_is_written_as_none() {
    let file = read_web(KNOWN, &set("web.turnable", "none")[..]).unwrap();
    assert_eq!(file.spec.turnable, Some(Vec::new()));
    assert!(file.text.contains("turnable = \"none\""), "{}", file.text);
    assert_reads_back(&file);
    for key in ["web.turnable", "web.assumed"] {
        let refused = read_web(KNOWN, &set(key, "none, fibre.diameter")[..]).unwrap_err().to_string();
        assert!(refused.contains("names none"), "{refused}");
        let refused = read_web(KNOWN, &set(key, ", ,")[..]).unwrap_err().to_string();
        assert!(refused.contains("is a text without a name") && refused.contains("\"none\""), "{refused}");
    }
}
