//! The fibres of a web: flown, and read back from the folder of a run.

use crate::Failure;
use crate::output::folder::{ENTRIES, Staging};
use crate::output::tables::{TableRecorder, Tables};
use spunlaid::case::Case;
use spunlaid::ensemble::{Keep, Results, RunControl, fly};
use spunlaid::input::{parse_web, read_case};
use spunlaid::lanes::Isa;
use spunlaid::layers::{Flyer, LaydownSource, Method, WebSpec, read_laid};
use spunlaid::web::Fibres;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64};

/// The web of the spunbond line, with a case for a short flight.
fn web(element_length: &str, method: &str) -> (WebSpec, Case) {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let set = [
        ("fibre.element_length", element_length),
        ("run.duration", "0.1 s"),
        ("run.replicates", "3"),
        ("belt.distance", "0.1 m"),
    ];
    let set = set.map(|(key, value)| (key.to_owned(), value.to_owned()));
    let case = read_case(&cases.join("spunbond.toml"), &set).unwrap().0;
    let text = std::fs::read_to_string(cases.join("web.toml")).unwrap();
    let path = cases.join("web.toml").display().to_string();
    let method = [("web.method".to_owned(), method.to_owned())];
    let mut spec = parse_web(&text, &path, &method).unwrap().spec;
    let path = PathBuf::from("short.toml");
    spec.layers[0].source = LaydownSource::Case { path, case: Arc::new(case.clone()) };
    (spec, case)
}

#[test]
fn identical_surrogate_in_a_flight_its_results_and_the_measures_of_a_run() {
    static STOP: AtomicBool = AtomicBool::new(false);
    let (mut spec, case) = web("4 mm", "surrogate");
    let mut flyer = Flyer::new(2, &STOP, &|_, work| work());
    let of_case = flyer.fibres(&spec, &spec.layers[0]).unwrap();
    let Fibres::Surrogate(surrogate) = of_case.fibres else { panic!("{of_case:?}") };

    // A run of the same case: its measures, and its table.
    let desk = tempfile::tempdir().unwrap();
    let folder = desk.path().join("r");
    let staging = Staging::new(&folder, ENTRIES, false, &STOP).unwrap();
    let recorder = TableRecorder::new(&staging, true);
    let mut tables = Tables::create(&staging, &recorder).unwrap();
    let (steps, isa) = (AtomicU64::new(0), Isa::detect());
    let computing =
        RunControl { threads: 2, isa, stop: &STOP, fibre_steps: &steps, recorder: Some(&recorder) };
    let mut results = Results::collector(0);
    fly(&case, Keep::NUMBERS, computing, |trajectory| {
        tables.add(trajectory.replicate)?;
        results.take(trajectory);
        Ok::<(), Failure>(())
    })
    .unwrap();
    tables.finish().unwrap();
    staging.publish().unwrap();
    let results = results.finish();
    let measured = ["sigma_1", "sigma_2", "noise"].map(|name| results.estimate(name));
    assert_eq!(
        [surrogate.sigma_md, surrogate.sigma_cd, surrogate.noise],
        measured.clone().map(|estimate| estimate.mean)
    );
    assert_eq!(
        of_case.flown.clone().unwrap().numbers.clone().map(|estimate| estimate.standard_error),
        measured.map(|estimate| estimate.standard_error)
    );

    spec.layers[0].source = LaydownSource::Results { folder, case: Arc::new(case) };
    let of_results = flyer.fibres(&spec, &spec.layers[0]).unwrap();
    let Fibres::Surrogate(again) = of_results.fibres else { panic!("{of_results:?}") };
    assert_eq!(again, surrogate);
    // The curves too.
    assert_eq!(of_case.flown.unwrap().curves, of_results.flown.unwrap().curves);
    spec.method = Method::Dynamics;
    let fibres = flyer.fibres(&spec, &spec.layers[0]).unwrap().fibres;
    assert!(matches!(fibres, Fibres::Curves(_)), "{fibres:?}");
}

#[test]
fn rejects_fibres_that_make_no_web() {
    static STOP: AtomicBool = AtomicBool::new(false);
    let mut flyer = Flyer::new(1, &STOP, &|_, work| work());
    // So long elements show too little of the autocorrelation to see a surrogate in it.
    let (spec, _) = web("25 mm", "surrogate");
    let message = flyer.fibres(&spec, &spec.layers[0]).unwrap_err();
    assert_eq!(message.exit_code(), 1);
    let message = message.to_string();
    assert!(
        message.starts_with("short.toml: no surrogate was identified in what its fibres lay: "),
        "{message}"
    );
    assert!(
        message.contains("with points closer together") && message.contains("web.method = \"dynamics\""),
        "{message}"
    );
    // A sheet on which these filaments would meet themselves.
    let (mut small, _) = web("4 mm", "dynamics");
    small.sheet.length = 1e-3;
    let message = flyer.fibres(&small, &small.layers[0]).unwrap_err().to_string();
    assert!(
        message.starts_with("web.length = 1 mm is shorter than 8 times laydown.sigma_md = "),
        "{message}"
    );
    // A folder without a table.
    let desk = tempfile::tempdir().unwrap();
    let message = read_laid(desk.path()).unwrap_err().to_string();
    assert!(message.contains("laid.parquet: "), "{message}");
    std::fs::write(desk.path().join("laid.parquet"), "PAR1 not at all PAR1").unwrap();
    assert!(read_laid(desk.path()).unwrap_err().to_string().contains("laid.parquet: "));
}
