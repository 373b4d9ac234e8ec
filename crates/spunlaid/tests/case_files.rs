//! Case files that are read: those of the repository, the starter, and what `write_case` makes of a case.
#![allow(clippy::unwrap_used, clippy::panic)]

use proptest::prelude::*;
use spunlaid::air::{Air, EddyModel};
use spunlaid::case::{Case, Run};
use spunlaid::chain::schemes::Scheme;
use spunlaid::drag::{Drag, FrictionLaw, NormalLaw};
use spunlaid::fibre::{Fibre, Root};
use spunlaid::input::{parse_case, read_case, starter_case, write_case};
use spunlaid::line::{Contact, Line};
use spunlaid::record::{Layout, Settings, analyse, read_record};
use spunlaid::vec3::Vec3;
use std::fs;
use std::path::Path;

/// Equal texts mean equal bits: numbers are shown by their shortest text that reads back, `-0.0` apart from `0.0`.
fn bits(case: &Case) -> String {
    format!("{case:?}")
}

fn read_again(case: &Case) -> Case {
    let text = write_case(case);
    let (again, _) = parse_case(&text, "case.toml", &[]).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(write_case(&again), text);
    again
}

/// Whether a file of the repository is a web, and not a case.
fn is_web(path: &Path) -> bool {
    fs::read_to_string(path).unwrap().contains("\n[web]\n")
}

fn remarks(text: &str) -> Vec<String> {
    let (_, notes) = parse_case(text, "case.toml", &[]).unwrap();
    notes.iter().map(ToString::to_string).collect()
}

#[test]
fn identical_every_case_of_the_repository() {
    let mut seen = 0;
    for entry in fs::read_dir("../../cases").unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() || is_web(&path) {
            continue;
        }
        let (case, notes) = read_case(&path, &[]).unwrap();
        assert!(!notes.iter().any(|note| note.what.is_warning()), "{}: {notes:?}", path.display());
        assert_eq!(bits(&read_again(&case)), bits(&case));
        seen += 1;
    }
    assert!(seen >= 4);
}

#[test]
fn identical_starter_table_1_and_the_starter_with_its_defaults_spelt_out() {
    let (starter, notes) = parse_case(starter_case(), "starter.toml", &[]).unwrap();
    assert_eq!(notes, []);
    let (table1, _) = read_case(Path::new("../../cases/table1.toml"), &[]).unwrap();
    // The starter has the law across that measurements support, Table 1 the paper's.
    let papers = Case { drag: Drag { across: NormalLaw::JuShambaugh, ..starter.drag }, ..starter.clone() };
    assert_eq!(starter.drag.across, NormalLaw::MarheinekeWegener);
    assert_eq!(bits(&papers), bits(&table1));

    let spelt_out: String = (starter_case().lines())
        .map(|line| match line.strip_prefix("# ") {
            Some(key) if key.starts_with('[') || key.split(' ').nth(1) == Some("=") => {
                format!("{key}\n")
            }
            _ => format!("{line}\n"),
        })
        .collect();
    let (case, _) = parse_case(&spelt_out, "starter.toml", &[]).unwrap();
    assert_eq!(bits(&case), bits(&starter));
    // Every key there is, is in the starter; the tolerance besides, which a time step leaves without effect.
    let keys = |text: &str| {
        let mut keys: Vec<_> =
            (text.lines().filter_map(|line| line.split_once(" = "))).map(|(key, _)| key.to_owned()).collect();
        keys.sort();
        keys
    };
    let mut spelt_out = keys(&spelt_out);
    spelt_out.retain(|key| key != "error_tolerance");
    assert_eq!(spelt_out, keys(&write_case(&starter)));
}

#[test]
fn table_1_is_read_in_si_units() {
    let (case, _) = read_case(Path::new("../../cases/table1.toml"), &[]).unwrap();
    let meant = Case {
        fibre: Fibre {
            length: 1.0,
            diameter: 5e-5,
            density: 950.0,
            youngs_modulus: 2e9,
            bending_viscosity_time: 0.0,
            elements: 20,
            root: Root::Pinned,
            direction: Vec3::new(1.0, 0.0, 0.0),
        },
        air: Air::uniform(10.0, 0.1, 0.05, 100.0),
        drag: Drag { along: FrictionLaw::Matsui { factor: 0.9 }, across: NormalLaw::JuShambaugh },
        line: None,
        run: Run {
            time_step: 1e-6,
            steps: 1_000_000,
            spin_up_steps: 0,
            output_steps: 1000,
            replicates: 10,
            seed: 1,
            scheme: Scheme::SemiImplicitEuler,
            gravity: 9.81,
            damping: 0.0,
            shapes: None,
        },
    };
    assert_eq!(bits(&case), bits(&meant));
}

#[test]
fn overrides_replace_and_add() {
    let set = [
        ("air.velocity", "20 m/s"),
        ("fibre.diameter", "\"18 um\""),
        ("run.scheme", "leapfrog"),
        ("run.seed", "7"),
    ]
    .map(|(key, value)| (key.to_owned(), value.to_owned()));
    let (case, _) = parse_case(starter_case(), "starter.toml", &set).unwrap();
    assert_eq!((case.air.velocity, case.fibre.diameter), (20.0, 18e-6));
    assert_eq!((case.run.scheme, case.run.seed), (Scheme::Leapfrog, 7));
}

#[test]
fn what_was_rounded_is_said() {
    let with = |line: &str| {
        let key = line.split(' ').next().unwrap();
        let kept = starter_case().lines().filter(|old| !old.starts_with(&format!("{key} =")));
        let mut text: String = kept.map(|line| format!("{line}\n")).collect();
        let table = if key == "element_length" || key == "diameter" { "[fibre]\n" } else { "[run]\n" };
        let at = text.find(table).unwrap() + table.len();
        text.insert_str(at, &format!("{line}\n"));
        text
    };
    for (line, said) in [
        (
            "element_length = \"30 mm\"",
            "case.toml:7: fibre.element_length = \"30 mm\" does not divide fibre.length into whole elements: 33 of 30.3 mm are used",
        ),
        (
            "element_length = \"3 m\"",
            "case.toml:7: fibre.element_length = \"3 m\" does not divide fibre.length into whole elements: 1 of 1 m is used\n\
             case.toml:20: air.length_scale = \"50 mm\" is shorter than the elements (1 m): each element only feels the eddy \
             at its centre. Shorten fibre.element_length so that every eddy acts on the fibre",
        ),
        (
            "time_step = \"3 µs\"",
            "case.toml:35: run.time_step = \"3 µs\" does not divide run.duration into whole steps: 333334 of 2.999994 µs are used",
        ),
        (
            "spin_up = \"1.4 µs\"",
            "case.toml:35: run.spin_up = \"1.4 µs\" is not a whole number of time steps: 1 µs is used",
        ),
        (
            "output_interval = \"0.1 µs\"",
            "case.toml:35: run.output_interval = \"0.1 µs\" is not a whole number of time steps: 1 µs is used",
        ),
    ] {
        assert_eq!(remarks(&with(line)).join("\n"), said);
    }
}

#[test]
fn a_drag_law_says_once_where_it_ends() {
    let set = |pairs: &[(&str, &str)]| {
        let set: Vec<_> = pairs.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
        let (_, notes) = parse_case(starter_case(), "case.toml", &set).unwrap();
        notes.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let (law, thick) = (("drag.across", "marheineke-wegener"), ("fibre.diameter", "6 mm"));
    assert_eq!(set(&[law]), [""; 0]);
    let fitted = ("drag.across", "ju-shambaugh");
    assert_eq!(set(&[fitted]), [""; 0]);
    assert_eq!(
        set(&[fitted, ("fibre.diameter", "500 µm")]),
        [
            "override fibre.diameter = \"500 µm\" is outside 13 µm to 390 µm, the range of diameters that drag.across = \"ju-shambaugh\" \
             was fitted to; the drag across the fibre is extrapolated. \"marheineke-wegener\" is valid for any diameter"
        ]
    );
    // 10 % of 10 m/s over 18 µm; in still air and in air without turbulence nothing is known of the velocity across.
    let fine = [fitted, ("fibre.diameter", "18 µm")];
    assert_eq!(
        set(&fine),
        [
            "override fibre.diameter = \"18 µm\" has Reynolds numbers of about 1.2 across the fibre. There drag.across = \"ju-shambaugh\" \
             gives only 0.37 times the drag that was measured on fine fibres and cylinders; \"marheineke-wegener\" agrees with these \
             measurements"
        ]
    );
    assert_eq!(set(&[fine[0], fine[1], ("air.turbulence_intensity", "0")]), [""; 0]);
    assert_eq!(set(&[law, fine[1]]), [""; 0]);
    // Three times 10 % of 100 m/s, over 6 mm.
    let fast = set(&[law, thick, ("air.velocity", "100 m/s"), ("run.time_step", "0.1 µs")]);
    assert_eq!(
        fast,
        [
            "override run.time_step = \"0.1 µs\" is 100 times shorter than the step that run.scheme = \"semi-implicit-euler\" \
          needs (10 µs), so the run takes that much longer; leave the key out, or override it with the value auto",
            "override fibre.diameter = \"6 mm\" gives Reynolds numbers across the fibre up to 11900, and \
          drag.across = \"marheineke-wegener\" is valid up to 1e4; the drag across the fibre is extrapolated. No other \
          law covers so thick a fibre in so fast air"
        ]
    );
    let vacuum = set(&[law, thick, ("air.velocity", "100 m/s"), ("air.density", "0 kg/m^3")]);
    assert_eq!(vacuum, [""; 0]);
}

#[test]
fn a_fed_case_is_warned_of_low_drag_and_of_elements_shorter_than_the_fibre_is_thick() {
    let warnings = |set: &[(&str, &str)]| {
        let set: Vec<_> = set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
        let (_, notes) = read_case(Path::new("../../cases/spunbond.toml"), &set).unwrap();
        let warnings = notes.into_iter().filter(|note| note.what.is_warning());
        warnings.map(|note| format!("{} {}", note.key, note.what)).collect::<Vec<_>>()
    };
    // 10 % of 35.0 m/s, the mean of the table on the way to the belt, over 18 µm.
    let low = "fibre.diameter has Reynolds numbers of about 4.2 across the fibre. There drag.across = \"ju-shambaugh\" gives only \
               0.46 times the drag that was measured on fine fibres and cylinders; \"marheineke-wegener\" agrees with these \
               measurements";
    let law = ("drag.across", "ju-shambaugh");
    assert_eq!(warnings(&[law]), [low]);
    assert_eq!(warnings(&[law, ("air.density", "0 kg/m³")]), [""; 0]);
    // Of a thicker fibre the law gives more.
    assert_eq!(warnings(&[law, ("fibre.diameter", "60 µm")]), [""; 0]);
    let short = ("belt.distance", "10 mm");
    assert_eq!(
        warnings(&[short, ("fibre.element_length", "15 µm")]),
        ["fibre.diameter is larger than the element length, 15 µm; use longer elements"]
    );
    assert_eq!(warnings(&[short, ("fibre.element_length", "20 µm")]), [""; 0]);
}

/// A number between powers of ten, with all its digits.
fn between(low: i32, high: i32) -> impl Strategy<Value = f64> {
    (f64::from(low)..f64::from(high)).prop_map(|power| 10f64.powf(power))
}

prop_compose! {
    fn fibre()(
        length in between(-2, 2), diameter in between(-5, -3), density in between(2, 4), youngs_modulus in between(7, 11),
        elements in 1usize..3000, root in prop::sample::select(vec![Root::Pinned, Root::Clamped, Root::Free]),
        x in prop_oneof![-1f64..-1e-3, 1e-3f64..1.0], y in -1f64..1.0, z in prop::sample::select(vec![0.0, -0.0, 0.3]),
    ) -> Fibre {
        let v = Vec3::new(x, y, z);
        let direction = v * (1.0 / v.norm());
        let n = direction.norm();
        let direction = Vec3::new(direction.x / n, direction.y / n, direction.z / n);
        Fibre {
            length,
            diameter,
            density,
            youngs_modulus,
            bending_viscosity_time: 0.0,
            elements,
            root,
            direction,
        }
    }
}

fn friction_law() -> impl Strategy<Value = FrictionLaw> {
    let [_, others @ ..] = FrictionLaw::ALL;
    prop_oneof![
        (0f64..2.0).prop_map(|factor| FrictionLaw::Matsui { factor }),
        prop::sample::select(others.to_vec())
    ]
}

prop_compose! {
    fn case()(
        fibre in fibre(),
        (velocity, turbulence_intensity, length_scale, cutoff_frequency) in (-50f64..50.0, 0f64..1.0, between(-2, 1), between(0, 3)),
        (density, kinematic_viscosity, more_harmonics, along, across) in (
            0f64..2.0, between(-6, -4), 1usize..50, friction_law(), prop::sample::select(NormalLaw::ALL.to_vec()),
        ),
        (share, steps, spin_up, output, damping) in (0.01f64..0.99, 1u64..1_000_000_000, 0f64..1.0, 0f64..1.0, 0f64..100.0),
        (replicates, seed, leapfrog, gravity) in (1u64..100, any::<u64>(), any::<bool>(), -10f64..10.0),
    ) -> Case {
        let air = Air {
            velocity, turbulence_intensity, length_scale, cutoff_frequency, density, kinematic_viscosity, harmonics: 1,
            ..Air::uniform(1.0, 0.0, 1.0, 1.0)
        };
        let scheme = if leapfrog { Scheme::Leapfrog } else { Scheme::SemiImplicitEuler };
        let spin_up_steps = (spin_up * steps as f64) as u64;
        let output_steps = 1 + (output * (steps - 1) as f64) as u64;
        let run = Run {
            time_step: 1.0, steps, spin_up_steps, output_steps, replicates, seed, scheme, gravity, damping,
            shapes: leapfrog.then_some(seed % 20_001),
        };
        let drag = Drag { along, across };
        let mut case = Case { fibre, air, drag, line: None, run };
        let limit = case.stable_step_limits().iter().map(|limit| limit.limit).fold(f64::INFINITY, f64::min);
        case.run.time_step = share * limit;
        case.air.harmonics = (case.air.cutoff_frequency * case.run.duration()) as usize + more_harmonics;
        case
    }
}

fn contact() -> impl Strategy<Value = Contact> {
    let friction = (0f64..2.0, 0f64..1000.0)
        .prop_map(|(coefficient, suction)| Contact::Friction { coefficient, suction });
    prop_oneof![Just(Contact::Stick), friction]
}

prop_compose! {
    /// A case whose fibre is fed on to a belt. All of them are valid.
    fn fed_case()(
        case in case(),
        (distance, elements, feed_speed, belt_speed) in (between(-2, 1), 3usize..1000, between(-2, 2), 0f64..10.0),
        (kept_length, contact, share) in (between(-3, 0), contact(), 0.1f64..0.9),
        (decay_time, convected, implicit, pinned) in (between(-4, 0), any::<bool>(), any::<bool>(), any::<bool>()),
        viscosity in prop_oneof![Just(0.0), between(-3, 1)],
        (cycles, spin_up, output, more_harmonics) in (between(-1, 3), 0f64..1.0, 1e-3f64..1.0, 1usize..50),
    ) -> Case {
        let mut case = case;
        // Elements are at least as long as the fibre is thick.
        let element = (distance / elements as f64).max(case.fibre.diameter);
        case.fibre.span(distance, element);
        case.fibre.direction = case.fibre.direction * case.fibre.direction.x.signum();
        case.fibre.root = if pinned { Root::Pinned } else { Root::Clamped };
        case.air.length_scale = case.air.length_scale.max(0.05 * distance);
        if convected {
            case.air.eddies = EddyModel::Convected { decay_time };
        }
        // No other scheme computes how a fibre slides.
        if implicit || contact != Contact::Stick {
            case.run.scheme = Scheme::ImplicitTension;
        }
        let feeding = case.fibre.rest_length() / feed_speed;
        case.line = Some(Line { feed_speed, distance, belt_speed, contact, kept_length, steps_per_element: 2 });
        let limit = |case: &Case| {
            case.stable_step_limits().iter().map(|limit| limit.limit).fold(f64::INFINITY, f64::min)
        };
        // In times of the limit without it: up to a step ten times as short.
        case.fibre.bending_viscosity_time = viscosity * limit(&case);
        let limit = limit(&case);
        case.set_time_step(share * limit.min(0.5 * feeding));
        let run = &mut case.run;
        run.steps = (cycles / case.air.cutoff_frequency / run.time_step).ceil().min(1e9) as u64;
        run.spin_up_steps = (spin_up * run.steps as f64) as u64;
        run.output_steps = 1 + (output * (run.steps - 1) as f64) as u64;
        case.air.harmonics = cycles as usize + more_harmonics;
        case
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn identical_fed_cases_after_writing_and_reading(case in fed_case()) {
        prop_assert!(case.check().is_ok(), "{:?}", case.check());
        prop_assert_eq!(bits(&read_again(&case)), bits(&case));
    }

    #[test]
    fn identical_after_writing_and_reading(case in case()) {
        prop_assume!(case.check().is_ok());
        prop_assert_eq!(bits(&read_again(&case)), bits(&case));
    }

    #[test]
    fn identical_once_rounded(
        length in 0.1f64..3.0, element in 1e-2f64..0.2, step in 1e-8f64..5e-6, duration in 1e-4f64..2.0,
        output in 1e-7f64..1e-4,
    ) {
        let set = [
            ("fibre.length", format!("{length} m")), ("fibre.element_length", format!("{element} m")),
            ("run.time_step", format!("{step} s")), ("run.duration", format!("{duration} s")),
            ("run.output_interval", format!("{output} s")),
        ].map(|(key, value)| (key.to_owned(), value));
        let read = parse_case(starter_case(), "starter.toml", &set);
        prop_assume!(read.is_ok());
        let (case, _) = read.unwrap();
        prop_assert!((case.run.duration() / duration - 1.0).abs() < 1e-14);
        prop_assert!(case.run.time_step <= step * (1.0 + 1e-14));
        prop_assert_eq!(bits(&read_again(&case)), bits(&case));
        // What has been resolved leaves nothing to remark on rounding.
        let notes = remarks(&write_case(&case));
        prop_assert!(notes.iter().all(|note| !note.contains("whole number")), "{:?}", notes);
    }
}

#[test]
fn a_time_step_left_open_is_chosen_and_told() {
    let open = starter_case().replace("time_step = ", "# time_step = ");
    for (scheme, tolerance, expected) in [
        // 0.003/(0.2 · 2π 100 Hz) = 24 µs, over half the axial limit of 34.5 µs.
        ("semi-implicit-euler", None, 1e-5),
        ("semi-implicit-euler", Some("1e-4"), 5e-7),
        ("leapfrog", None, 1e-5),
        // √(0.003/0.12)/(2π 100 Hz) = 252 µs.
        ("implicit-tension", None, 2e-4),
        ("implicit-tension", Some("0.03"), 5e-4),
    ] {
        let mut overrides = vec![("run.scheme".to_owned(), scheme.to_owned())];
        overrides.extend(tolerance.map(|t| ("run.error_tolerance".to_owned(), t.to_owned())));
        let (case, notes) = parse_case(&open, "open.toml", &overrides).unwrap();
        assert_eq!(case.run.time_step, expected, "{scheme}, {tolerance:?}");
        assert!(notes[0].to_string().contains("run.time_step = "), "{:?}", notes[0].to_string());
        // The resolved case says which step, and means the same.
        assert_eq!(bits(&read_again(&case)), bits(&case));
    }
    let both = [("run.error_tolerance".to_owned(), "0.01".to_owned())];
    let (_, notes) = parse_case(starter_case(), "both.toml", &both).unwrap();
    assert!(notes[0].to_string().contains("has no effect"), "{}", notes[0]);
}

/// The starter with overrides: the case and the texts of its notes.
fn changed(set: &[(&str, &str)]) -> (Case, Vec<String>) {
    let set: Vec<_> = set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let (case, notes) = parse_case(starter_case(), "starter.toml", &set).unwrap();
    (case, notes.iter().map(ToString::to_string).collect())
}

#[test]
fn auto_undoes_a_key() {
    let scheme = ("run.scheme", "implicit-tension");
    let (pinned, notes) = changed(&[scheme]);
    assert_eq!(pinned.run.time_step, 1e-6);
    assert!(notes[0].contains("is 200 times shorter than the step that run.scheme"), "{notes:?}");
    let (free, notes) = changed(&[scheme, ("run.time_step", "auto")]);
    assert_eq!(free.run.time_step, 2e-4);
    assert!(!notes.iter().any(|note| note.contains("times shorter")), "{notes:?}");
}

#[test]
fn linear_density_and_taylors_cutoff_give_what_they_stand_for() {
    // 18.65 dtex of 950 kg/m³: d² = 4 · 18.65e-7/(π · 950).
    let (case, _) = changed(&[("fibre.diameter", "auto"), ("fibre.linear_density", "18.65 dtex")]);
    assert!((case.fibre.diameter / 4.9996e-5 - 1.0).abs() < 1e-4, "{}", case.fibre.diameter);
    let (denier, _) = changed(&[("fibre.diameter", "auto"), ("fibre.linear_density", "16.785 den")]);
    assert!((denier.fibre.diameter / case.fibre.diameter - 1.0).abs() < 1e-12);
    // 20 m/s over four eddies of 50 mm.
    let (case, _) = changed(&[("air.cutoff_frequency", "taylor"), ("air.velocity", "20 m/s")]);
    assert_eq!(case.air.cutoff_frequency, 100.0);
    assert_eq!(bits(&read_again(&case)), bits(&case));
}

#[test]
fn published_air_at_a_temperature() {
    // Çengel, Heat and Mass Transfer, Table A-15: 1.059 kg/m³ and 1.896e-5 m²/s at 60 °C. Its viscosities differ by up
    // to 1 % from those of other tables.
    let (case, _) = changed(&[("air.temperature", "60 °C")]);
    assert!((case.air.density / 1.059 - 1.0).abs() < 1e-3, "{}", case.air.density);
    assert!((case.air.kinematic_viscosity / 1.896e-5 - 1.0).abs() < 0.01, "{}", case.air.kinematic_viscosity);
    let (kelvin, _) = changed(&[("air.temperature", "333.15 K")]);
    assert_eq!(bits(&kelvin), bits(&case));
    // The written case has density and viscosity.
    assert_eq!(bits(&read_again(&case)), bits(&case));
}

#[test]
fn identical_records_however_a_case_says_how_to_read_them() {
    let folder = std::env::temp_dir().join(format!("spunlaid-record-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    // The columns of the probe behind two lines of numbers, without names that say what they are.
    let probe = std::fs::read_to_string("../../cases/records/probe.csv").unwrap();
    let rows: String = (probe.lines().skip(3))
        .map(|row| {
            let cells: Vec<&str> = row.split(',').collect();
            format!("{},{}\n", cells[2], cells[1])
        })
        .collect();
    let record = folder.join("logger.csv");
    std::fs::write(&record, format!("1,2\n3,4\nacross,along\n{rows}")).unwrap();
    let layout = Layout {
        rate: Some(1000.0),
        skip_lines: 2,
        columns: vec!["along".to_owned(), "across".to_owned()],
        velocity_unit: Some("km/h".to_owned()),
        ..Layout::default()
    };
    let analysis = analyse(&read_record(&record, &layout).unwrap(), &Settings::default()).unwrap();
    let auto = ["velocity", "turbulence_intensity", "length_scale", "cutoff_frequency"];
    let mut set: Vec<(String, String)> = auto.map(|key| (format!("air.{key}"), "auto".to_owned())).to_vec();
    set.extend(
        [
            ("record", record.to_str().unwrap()),
            ("record_rate", "1 kHz"),
            ("record_skip", "2"),
            ("record_columns", "along, across"),
            ("record_velocity_unit", "km/h"),
        ]
        .map(|(key, value)| (format!("air.{key}"), value.to_owned())),
    );
    let (case, _) = parse_case(starter_case(), "starter.toml", &set).unwrap();
    assert_eq!(case.air.velocity, analysis.mean_velocity.value);
    assert_eq!(case.air.length_scale, analysis.length_scale.value);
    assert_eq!(case.air.records[0].components.len(), 2);
    // 10 km/h: the probe has 10 m/s.
    assert!((case.air.velocity * 3.6 / 10.0 - 1.0).abs() < 0.05, "{}", case.air.velocity);
    assert_eq!(bits(&read_again(&case)), bits(&case));
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn warns_of_values_that_may_be_slips() {
    for (key, value, part) in [
        ("air.turbulence_intensity", "10", "if 10 % was meant, write \"10 %\""),
        ("air.length_scale", "5 m", "is 5 times fibre.length"),
        ("air.cutoff_frequency", "taylor", "is below velocity / length scale = 200 Hz"),
    ] {
        let (_, notes) = changed(&[("air.spectrum", "von-karman"), (key, value)]);
        assert!(notes.iter().any(|note| note.contains(part)), "{key}: {notes:?}");
    }
}
