//! The studies of the paper, which are compiled in.

use spunlaid_fibre::Root;
use spunlaid_fibre::chain::Scheme;
use spunlaid_input::paper::{Parameter, choices, table1, time_steps};
use std::fs;
use std::path::{Path, PathBuf};

/// The files in a folder and in those that it holds.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}

/// With `BLESS=1` it writes the copies.
#[test]
fn identical_to_the_files_of_the_repository() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR"));
    let copies = crates.join("../spunlaid-input/src/paper/cases");
    let originals = crates.join("../../cases");
    let copied = files(&copies);
    assert!(copied.len() >= 9, "{copied:?}");
    for copy in copied {
        let original = fs::read_to_string(originals.join(copy.strip_prefix(&copies).unwrap())).unwrap();
        if std::env::var_os("BLESS").is_some() {
            fs::write(&copy, &original).unwrap();
        }
        let same = fs::read_to_string(&copy).unwrap() == original;
        assert!(same, "{} is not up to date: the test writes it with BLESS=1", copy.display());
    }
}

#[test]
fn every_study_holds_table_1_and_varies_one_thing() {
    let table1 = table1(Scheme::SemiImplicitEuler).unwrap();
    for parameter in Parameter::ALL {
        let study = parameter.study().unwrap();
        assert_eq!(study.inputs().count(), 1, "{parameter:?}");
        assert!(study.points.iter().any(|point| point.experiment.case() == Some(&table1)), "{parameter:?}");
    }
    assert_eq!(time_steps().unwrap().points[0].experiment.case(), Some(&table1));
}

#[test]
fn every_choice_is_what_it_is_called() {
    let choices = choices().unwrap();
    let [here, majumdar, matsui, variance, taylor, clamped] = &choices[..] else {
        panic!("{} choices", choices.len());
    };
    assert_eq!(here.1, table1(Scheme::SemiImplicitEuler).unwrap());
    for (choice, value) in [(majumdar, 0.78), (matsui, 0.37)] {
        assert!(choice.0.contains(&value.to_string()));
        assert_eq!(choice.1.drag.along.factor(), Some(value));
    }
    let twice = (variance.1.air.turbulence_intensity / here.1.air.turbulence_intensity).powi(2);
    assert!((twice - 2.0).abs() < 1e-14);
    assert_eq!((taylor.1.air.length_scale, taylor.1.fibre.elements), (0.025, 40));
    let mut pinned = clamped.1.clone();
    assert_eq!(pinned.fibre.root, Root::Clamped);
    pinned.fibre.root = Root::Pinned;
    assert_eq!(pinned, here.1);
}

#[test]
fn another_scheme_keeps_the_times() {
    for scheme in [Scheme::Leapfrog, Scheme::ImplicitTension] {
        let by = table1(scheme).unwrap();
        assert!((by.run.duration() - 1.0).abs() < 1e-12);
        assert!((by.run.output_interval() - 1e-3).abs() < 1e-12);
        assert!(by.check().is_ok());
    }
}
