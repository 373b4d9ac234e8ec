//! Case files that are read: those of the repository, the starter, and what is written in other words.

use crate::cases;
use crate::cases::{bits, changed, read_again};
use spunlaid_air::record::{analyse, read_record};
use spunlaid_air::{Air, Flow, Layout, Settings};
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{Case, Drag, Fibre, FrictionLaw, NormalLaw, Root, Run};
use spunlaid_ground::Severity;
use spunlaid_input::{read_case, starter_case, write_case};
use std::fs;
use std::path::Path;

/// Whether a file of the repository is a case, and not a web or a spinline alone.
fn is_case(path: &Path) -> bool {
    fs::read_to_string(path).unwrap().contains("\n[run]\n")
}

#[test]
fn identical_every_case_of_the_repository() {
    let mut seen = 0;
    for entry in fs::read_dir("../../cases").unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() || !is_case(&path) {
            continue;
        }
        let (case, notes) = read_case(&path, &[]).unwrap();
        assert!(!notes.iter().any(|note| note.is_warning()), "{}: {notes:?}", path.display());
        assert_eq!(bits(&read_again(&case)), bits(&case));
        seen += 1;
    }
    assert!(seen >= 4);
}

#[test]
fn identical_starter_table_1_and_the_starter_with_its_defaults_spelt_out() {
    let (starter, notes) = read_case((starter_case(), "starter.toml"), &[]).unwrap();
    assert!(notes.iter().all(|note| note.severity == Severity::Choice), "{notes:?}");
    let (table1, _) = read_case(Path::new("../../cases/table1.toml"), &[]).unwrap();
    // The starter has the law across that measurements support, and elements and a scheme that resolve the
    // motion; Table 1 those of the paper.
    assert_eq!(starter.drag.across, NormalLaw::MarheinekeWegener);
    let set = [("drag.across".to_owned(), "ju-shambaugh".to_owned())];
    let (papers, _) = read_case((cases::papers_starter(), "starter.toml"), &set).unwrap();
    assert_eq!(bits(&papers), bits(&table1));

    let spelt_out: String = (starter_case().lines())
        .map(|line| match line.strip_prefix("# ") {
            Some(key) if key.starts_with('[') || key.split(' ').nth(1) == Some("=") => {
                format!("{key}\n")
            }
            _ => format!("{line}\n"),
        })
        .collect();
    let (case, _) = read_case((&spelt_out, "starter.toml"), &[]).unwrap();
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
            ..Fibre::UNKNOWN
        },
        air: Air::uniform(10.0, 0.1, 0.05, 100.0),
        drag: Drag { along: FrictionLaw::Matsui { factor: 0.9 }, across: NormalLaw::JuShambaugh },
        line: None,
        spinline: None,
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
            checks: spunlaid_fibre::Checks::default(),
            ..Run::UNKNOWN
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
        ("run.time_step", "1 µs"),
        ("run.seed", "7"),
    ]
    .map(|(key, value)| (key.to_owned(), value.to_owned()));
    let (case, _) = read_case((starter_case(), "starter.toml"), &set).unwrap();
    assert_eq!((case.air.velocity, case.fibre.diameter), (20.0, 18e-6));
    assert_eq!((case.run.scheme, case.run.seed), (Scheme::Leapfrog, 7));
}

#[test]
fn linear_density_and_taylors_cutoff_give_what_they_stand_for() {
    // 18.65 dtex of 950 kg/m³: d² = 4 · 18.65e-7/(π · 950).
    let (case, _) = changed(&[("fibre.diameter", "auto"), ("fibre.linear_density", "18.65 dtex")]);
    assert!((case.fibre.diameter / 4.9996e-5 - 1.0).abs() < 1e-4, "{}", case.fibre.diameter);
    let (denier, _) = changed(&[("fibre.diameter", "auto"), ("fibre.linear_density", "16.785 den")]);
    assert!((denier.fibre.diameter / case.fibre.diameter - 1.0).abs() < 1e-12);
    // An override stands in place of what the case says in other words.
    let (replaced, _) = changed(&[("fibre.linear_density", "16.785 den")]);
    assert_eq!(replaced.fibre.diameter, denier.fibre.diameter);
    // 20 m/s over four eddies of 50 mm.
    let (case, _) = changed(&[("air.cutoff_frequency", "taylor"), ("air.velocity", "20 m/s")]);
    assert_eq!(case.air.cutoff_frequency, 100.0);
    assert_eq!(bits(&read_again(&case)), bits(&case));
}

#[test]
fn what_is_set_replaces_what_a_case_says_in_other_words() {
    let table1 = fs::read_to_string("../../cases/table1.toml").unwrap();
    let read = |lines: &str, set: &[(&str, &str)]| {
        let set: Vec<_> = set.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
        read_case((&table1.replace("[air]\n", &format!("[air]\n{lines}\n")), "a.toml"), &set)
    };
    let air = |lines: &str, set: &[(&str, &str)]| {
        let air = read(lines, set).unwrap().0.air;
        [air.density, air.kinematic_viscosity]
    };
    let warm = "temperature = '60 °C'";
    let numbers = "density = '1 kg/m³'\nkinematic_viscosity = '2e-5 m²/s'";
    assert_eq!(air(numbers, &[("air.temperature", "60 °C")]), air(warm, &[]));
    let both = [("air.density", "1 kg/m³"), ("air.kinematic_viscosity", "2e-5 m²/s")];
    assert_eq!(air(warm, &both), [1.0, 2e-5]);
    // The density says nothing of the viscosity, which is that of no temperature then.
    let said = read(warm, &both[..1]).unwrap_err().to_string();
    let refused = "air.temperature = '60 °C' cannot be combined with air.density; the temperature gives \
        density and viscosity";
    assert!(said.contains(refused), "{said}");
    let field = [("air.field".to_owned(), "../../cases/fields/diffuser_core.csv".to_owned())];
    let (case, _) = read_case("../../cases/profile.toml", &field).unwrap();
    assert!(matches!(case.air.flow, Flow::Field(_)), "{:?}", case.air.flow);
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
    let (case, _) = read_case((starter_case(), "starter.toml"), &set).unwrap();
    assert_eq!(case.air.velocity, analysis.mean_velocity.value);
    assert_eq!(case.air.length_scale, analysis.length_scale.value);
    assert_eq!(case.air.records[0].components.len(), 2);
    // 10 km/h: the probe has 10 m/s.
    assert!((case.air.velocity * 3.6 / 10.0 - 1.0).abs() < 0.05, "{}", case.air.velocity);
    assert_eq!(bits(&read_again(&case)), bits(&case));
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_case_says_how_long_a_gap_of_its_record_may_be() {
    let probe = std::fs::read_to_string("../../cases/records/probe.csv").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("gap.csv");
    // Twelve rows are missing.
    let rows: Vec<&str> =
        probe.lines().enumerate().filter(|(i, _)| !(500..512).contains(i)).map(|(_, row)| row).collect();
    std::fs::write(&record, rows.join("\n")).unwrap();
    let set = |gap: Option<&str>| -> Vec<(String, String)> {
        let record = ("air.record".to_owned(), record.display().to_string());
        std::iter::once(record)
            .chain(gap.map(|gap| ("air.record_max_gap".to_owned(), gap.to_owned())))
            .collect()
    };
    for gap in [None, Some("11")] {
        let refused = read_case((starter_case(), "starter.toml"), &set(gap)).unwrap_err().to_string();
        let most = gap.unwrap_or("10");
        let wanted = format!(
            "gap.csv:501: column time_s: 12 samples in a row are missing up to here, more than the {most} \
            that are filled in"
        );
        assert!(refused.contains(&wanted) && refused.contains("air.record_max_gap"), "{refused}");
    }
    let (case, _) = read_case((starter_case(), "starter.toml"), &set(Some("12"))).unwrap();
    assert_eq!(bits(&read_again(&case)), bits(&case));
    let refused =
        read_case((starter_case(), "starter.toml"), &set(Some("12"))[1..].to_vec()).unwrap_err().to_string();
    assert!(refused.contains("air.record_max_gap = 12 has no effect without air.record"), "{refused}");
}
