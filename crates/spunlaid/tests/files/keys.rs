//! The table of keys: what is said of each holds, and a case can be read and set through it.

use spunlaid_fibre::case::keys::{self, Kind, Omission, Value};
use spunlaid_fibre::{Case, ERROR_TOLERANCE, Melt, Polymer};
use spunlaid_input::{read_case, starter_case};
use std::fs;

fn starter() -> Case {
    read_case((starter_case(), "starter.toml"), &[]).unwrap().0
}

fn refusal(case: &Case, key: &str, value: impl Into<Value>) -> String {
    keys::find(key).unwrap().set(&mut case.clone(), value).unwrap_err().to_string()
}

#[test]
fn every_row_is_whole() {
    let mut names: Vec<&str> = keys::all().iter().map(|key| key.name).collect();
    let by_table = keys::TABLES.iter().flat_map(|table| keys::keys_of_table(table)).map(|key| key.name);
    assert!(by_table.eq(keys::all().iter().map(|key| key.name)), "in the order of the tables");
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), keys::all().len());
    for key in keys::all() {
        assert!(key.meaning.ends_with('.') && key.meaning.len() > 20, "{}", key.name);
        assert!(!key.varies || key.label != key.name, "{} varies and has no label", key.name);
        let (Omission::Required(words) | Omission::Value(words) | Omission::Follows(words)) = key.omission;
        assert!(!words.is_empty(), "{}", key.name);
        if let (Some((least, greatest)), Kind::Quantity(..)) = (key.slider, key.kind) {
            assert!(least < greatest, "{}", key.name);
            // Both ends are allowed.
            let mut case = read_case("../../cases/profile.toml", &[]).unwrap().0;
            let set = [least, greatest].map(|end| key.set(&mut case, end));
            let is_reported = |problem: &spunlaid_ground::Diagnostic| {
                let text = problem.to_string();
                text.contains("has no effect") || text.contains("is read from a file")
            };
            assert!(
                set.iter().all(|set| set.as_ref().err().is_none_or(|problem| is_reported(problem))),
                "{}: {set:?}",
                key.name
            );
        }
    }
}

/// What a case says of a key can be set again and changes nothing, in every case of the repository.
#[test]
fn identical_after_getting_and_setting() {
    let mut seen = std::collections::BTreeSet::new();
    let mut cases: Vec<_> =
        fs::read_dir("../../cases").unwrap().map(|entry| (entry.unwrap().path(), Vec::new())).collect();
    // Webs and spinlines alone are no cases.
    cases.retain(|(path, _)| path.is_file() && fs::read_to_string(path).unwrap().contains("\n[run]\n"));
    let line = "../../cases/whole_line_fibre.toml";
    let of_line = |set: &[(&str, &str)]| {
        (line.into(), set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect())
    };
    cases.push(of_line(&[("spinline.profile", "auto"), ("spinline.velocity", "70 m/s")]));
    cases.push(of_line(&[("spinline.melt_flow_rate", "auto"), ("spinline.material.viscosity", "220 Pa s")]));
    cases.push(of_line(&[("spinline.material.stress_optical_temperature", "400 K")]));
    cases.push(of_line(&[("spinline.end", "take-up"), ("spinline.take_up_speed", "60 m/s")]));
    cases.push(of_line(&[
        ("spinline.break_stress", "1 GPa"),
        ("spinline.rows", "3"),
        ("spinline.filaments_per_metre_and_row", "200"),
        ("spinline.material.source", "my data sheet"),
    ]));
    let of_record = [
        ("rate", "2 kHz"),
        ("skip", "2"),
        ("columns", "u,v"),
        ("time", "time_s"),
        ("velocity_unit", "m/s"),
        ("max_gap", "20"),
    ];
    let set = of_record.map(|(key, value)| (format!("air.record_{key}"), value.to_owned()));
    cases.push(("../../cases/record.toml".into(), set.to_vec()));
    let arrays = |dissipation: &str| {
        let velocity = [("air.field_velocity", "u_m_s, v_m_s, w_m_s"), ("air.field_k", "k_m2_s2")];
        let set = velocity.into_iter().chain([(dissipation, "epsilon_m2_s3")]);
        set.map(|(key, value)| (key.to_owned(), value.to_owned())).collect()
    };
    cases.push(("../../cases/point_table.toml".into(), arrays("air.field_epsilon")));
    cases.push(("../../cases/point_table.toml".into(), arrays("air.field_omega")));
    cases.push((
        "../../cases/table1.toml".into(),
        vec![("air.cabin_pressure".to_owned(), "300 Pa".to_owned())],
    ));
    let slides = ("belt.contact".to_owned(), "friction".to_owned());
    let shared = ("air.lateral".to_owned(), "von-karman".to_owned());
    let shapes = ("run.shapes".to_owned(), "20".to_owned());
    cases.push(("../../cases/spunbond.toml".into(), vec![slides, shared, shapes]));
    for (path, set) in cases {
        let (case, _) = read_case(&path, &set).unwrap();
        let mut again = case.clone();
        for key in keys::all() {
            // The flow reports it, so that it cannot be set.
            let is_derived = key.name == "air.velocity" && !case.air.is_uniform()
                || case.spinline.is_some() && key.is_derived(&case);
            if let Some(value) = key.get(&case).filter(|_| !is_derived) {
                key.set(&mut again, value).unwrap();
                seen.insert(key.name);
            }
        }
        again.air.from_flow = case.air.from_flow;
        assert_eq!(format!("{again:?}"), format!("{case:?}"), "{}", path.display());
    }
    let mut never: Vec<_> =
        keys::all().iter().map(|key| key.name).filter(|name| !seen.contains(name)).collect();
    // A case has what these stand for: a diameter, the properties of the air and a time step.
    never.retain(|name| !["fibre.linear_density", "air.temperature", "run.error_tolerance"].contains(name));
    assert!(never.is_empty(), "{never:?}");
}

#[test]
fn values_are_set_as_numbers_texts_and_names() {
    let mut case = starter();
    let mut set = |key: &str, value: Value| keys::named(key).unwrap().set(&mut case, value).unwrap();
    set("air.velocity", 20.0.into());
    set("fibre.diameter", "18 um".into());
    set("drag.along", "sakiadis".into());
    set("run.replicates", 7u64.into());
    set("run.seed", 8.0.into());
    set("fibre.direction", [0.0, 3.0, 0.0].into());
    set("fibre.element_length", "25 mm".into());
    set("run.time_step", "2 µs".into());
    assert_eq!((case.air.velocity, case.fibre.diameter, case.drag.along.name()), (20.0, 18e-6, "sakiadis"));
    assert_eq!((case.run.replicates, case.run.seed, case.fibre.direction.y), (7, 8, 1.0));
    // Times are kept when the step changes.
    assert_eq!((case.fibre.elements, case.run.steps, case.run.output_steps), (40, 500_000, 500));
}

#[test]
fn rejects_values_with_the_way_out() {
    let case = starter();
    for (key, value, message) in [
        (
            "air.velocity",
            Value::from("20"),
            "air.velocity = \"20\" has no unit; write a velocity with its unit: m/s, cm/s, mm/s, km/h or m/min",
        ),
        (
            "air.velocity",
            f64::NAN.into(),
            "air.velocity = NaN m/s is not a finite number; write a finite one",
        ),
        (
            "fibre.diameter",
            (-1.0).into(),
            "fibre.diameter = -1 m is not positive; a length above zero is needed",
        ),
        ("fibre.root", "clampd".into(), "fibre.root = \"clampd\" is unknown; did you mean \"clamped\"?"),
        ("run.seed", 1.5.into(), "run.seed = 1.5 is a number; write a whole number without quotes, like 10"),
        ("fibre.root", 1.0.into(), "fibre.root = 1 is a number; write \"pinned\", \"clamped\" or \"free\""),
        (
            "air.profile",
            "air.csv".into(),
            "air.profile = \"air.csv\" is read from a file together with the case; write it in the case file \
            and read the case again",
        ),
        (
            "air.speed_factor",
            2.0.into(),
            "air.speed_factor = 2 has no effect without air.profile or air.field; change air.velocity",
        ),
    ] {
        assert_eq!(refusal(&case, key, value), message);
    }
    let unknown = keys::named("air.velocty").unwrap_err().to_string();
    assert_eq!(unknown, "air.velocty is not a key of a case file; did you mean air.velocity?");
}

/// The table's default is the one that code takes.
#[test]
fn identical_default_of_the_tolerance() {
    let tolerance = keys::find("run.error_tolerance").unwrap();
    assert_eq!(tolerance.omission, Omission::Value("0.003"));
    assert_eq!("0.003".parse(), Ok(ERROR_TOLERANCE));
}

/// docs/theory.md has a row for each constant of a polymer, and its cells, read as a case file is read, are
/// the constants of the code to the bit.
#[test]
fn identical_constants_of_polymers_on_their_page() {
    const TABLE: &str = "spinline.material";
    // What the viscosity is of a polymer whose grade decides it.
    const NONE: &str = "–";
    let page = fs::read_to_string("../../docs/theory.md").unwrap();
    let section = page.split("\n## ").find(|section| section.starts_with("The constants of five polymers\n"));
    let mut rows = section.unwrap().lines().filter(|line| line.starts_with("| ")).map(|line| {
        let cells = line.trim_matches('|').split('|').map(str::trim);
        cells.collect::<Vec<_>>()
    });
    let heads = rows.next().unwrap();
    let polymers = Polymer::ALL.map(Polymer::name);
    assert_eq!(heads, [&["key"][..], &polymers, &["source"]].concat());
    let (case, _) = read_case("../../cases/whole_line_fibre.toml", &[]).unwrap();
    let (mut seen, mut compared) = (Vec::new(), 0);
    for row in rows {
        assert_eq!(row.len(), heads.len(), "{row:?}");
        assert!(!row[heads.len() - 1].is_empty(), "{row:?} has no source");
        let crystallises = row[0].ends_with("with `crystallisation = true`");
        let key = keys::named(&format!("{TABLE}.{}", row[0].split('`').nth(1).unwrap())).unwrap();
        for (polymer, written) in Polymer::ALL.into_iter().zip(&row[1..]) {
            let mut case = case.clone();
            let line = case.spinline.as_mut().unwrap();
            (line.material, line.melt) = (polymer.material(crystallises), Melt::Viscosity);
            let mut again = case.clone();
            match key.get(&case) {
                Some(constant) => {
                    key.set(&mut again, *written).unwrap_or_else(|problem| panic!("{problem}"));
                    assert_eq!(
                        key.get(&again),
                        Some(constant),
                        "{} of {}: {written}",
                        key.name,
                        polymer.name()
                    );
                    compared += 1;
                }
                None => assert_eq!(*written, NONE, "{} of {}", key.name, polymer.name()),
            }
        }
        seen.push(key.name);
    }
    for key in keys::keys_of_table(TABLE).filter(|key| key.dimension().is_some()) {
        assert!(seen.contains(&key.name), "{} has no row", key.name);
    }
    assert!(compared > 100, "{compared} constants are compared");
}
