//! The tension at the end of a spinline that flights find: a reader says what has to be simulated, and whoever
//! settles the file flies it.

use spunlaid_air::Lateral;
use spunlaid_fibre::Case;
use spunlaid_fibre::case::keys;
use spunlaid_ground::{Diagnostic, Dimension, Error, Isa, RunContext};
use spunlaid_input::{
    CaseWithNotes, Overrides, Resources, StudyFile, parse_study, read_case, read_spinline, read_web,
};
use spunlaid_simulation::Recorded;
use spunlaid_simulation::ensemble::fly;
use std::sync::atomic::{AtomicBool, AtomicU64};

/// The filament of the whole line, coarse and short.
fn case() -> String {
    let text = include_str!("../../../../cases/whole_line_fibre.toml");
    [
        ("die_temperature", "end_tension = 'simulated'\ndie_temperature"),
        ("\"4 mm\"", "'20 mm'"),
        ("duration = \"1 s\"", "duration = '30 ms'\nspin_up = '12 ms'\nchecks = 'none'"),
        ("replicates = 8", "replicates = 2"),
    ]
    .into_iter()
    .fold(text.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    })
}

/// What messages call it; the tables that it names are there.
const NAME: &str = "../../cases/case.toml";

fn read(set: &[(&str, &str)]) -> Result<CaseWithNotes, Error> {
    read_case((&case(), NAME), &owned(set))
}

fn owned(set: &[(&str, &str)]) -> Vec<(String, String)> {
    set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect()
}

fn by<'a>(threads: usize, stop: &'a AtomicBool, steps: &'a AtomicU64) -> RunContext<'a> {
    RunContext { threads, isa: Isa::detect(), stop, done: steps }
}

/// What a file is when everything has been simulated, and how many tensions that took.
fn settled<T>(threads: usize, read: impl Fn(Overrides<'_>) -> Result<T, Error>) -> (T, usize) {
    let stop = AtomicBool::new(false);
    let steps = AtomicU64::new(0);
    let mut wanted = 0;
    let read = Resources::default().resolve_tension(
        |resources| read(Overrides::from(&[][..]).with(resources)),
        |resources| {
            wanted += resources.wanted();
            resources.fly(by(threads, &stop, &steps))
        },
    );
    (read.unwrap_or_else(|error| panic!("{error}")), wanted)
}

/// The case with such a value when everything has been simulated.
fn settled_case(threads: usize, set: &[(&str, &str)]) -> CaseWithNotes {
    let set = owned(set);
    settled(threads, |known| read_case((&case(), NAME), Overrides { values: &set, ..known })).0
}

fn number(case: &Case, key: &str) -> f64 {
    keys::find(key).unwrap().get(case).unwrap().number().unwrap()
}

/// Mean tension at the root of the fibres of a case.
fn tension_of(case: &Case) -> f64 {
    let (stop, steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let mut tensions = Vec::new();
    fly::<Error>(case, Recorded::NUMBERS, by(2, &stop, &steps), |one| {
        tensions.push(one.number("root_tension"));
        Ok(())
    })
    .unwrap();
    tensions.iter().sum::<f64>() / tensions.len() as f64
}

#[test]
fn identical_tension_when_the_rounds_are_flown_by_hand_and_for_any_number_of_threads() {
    let (case, notes) = settled_case(1, &[]);
    let tension = number(&case, "spinline.end_tension");
    assert!(tension > 1e-6, "{tension}");
    assert_eq!(settled_case(3, &[]), (case.clone(), notes.clone()));
    let (file, _) = settled(2, |known| read_spinline((&self::case(), NAME), known));
    assert_eq!(Some(&file.spec.spinline), case.spinline.as_deref());
    let said = notes
        .iter()
        .map(Diagnostic::to_string)
        .find(|note| note.contains("was found by simulation"))
        .unwrap();
    assert!(
        said.starts_with("../../cases/case.toml:8: spinline.end_tension was found by simulation"),
        "{said}"
    );

    // Each round is a case with the tension of the round before.
    let (mut speed, mut by_hand) = (f64::NAN, 0.0);
    for _ in 0..8 {
        let written = Dimension::Force.exact(by_hand);
        let (round, _) = read(&[("spinline.end_tension", &written)]).unwrap();
        let change = (number(&round, "feed.speed") / speed - 1.0).abs();
        if change < 1e-3 {
            assert_eq!((round, by_hand), (case, tension));
            return;
        }
        speed = number(&round, "feed.speed");
        by_hand = tension_of(&round);
    }
    panic!("the speed does not settle");
}

#[test]
fn a_reader_simulates_nothing_and_reports_what_has_to_be_simulated() {
    let mut resources = Resources::default();
    let (case, notes) = read_case((&case(), NAME), Overrides::from(&[][..]).with(&resources)).unwrap();
    assert!(case.waits_for_flights() && resources.wanted() == 1);
    let (zero, _) = read(&[("spinline.end_tension", "0 N")]).unwrap();
    assert_eq!(number(&case, "feed.speed"), number(&zero, "feed.speed"));
    assert!(notes.iter().any(|note| note.to_string().contains("is found when the case is simulated")));
    // The bar ends where it should, whichever round was the last.
    let stop = AtomicBool::new(false);
    let steps = AtomicU64::new(0);
    let most = resources.most_steps();
    resources.fly(by(1, &stop, &steps)).unwrap();
    let done = steps.into_inner() as f64 / most as f64;
    assert!((done - 1.0).abs() < 0.05, "{done}");
    let (simulated, _) = read_case((&self::case(), NAME), Overrides::from(&[][..]).with(&resources)).unwrap();
    assert!(number(&simulated, "feed.speed") > number(&zero, "feed.speed") && !simulated.waits_for_flights());
}

#[test]
fn a_stop_ends_the_flights() {
    let stop = AtomicBool::new(true);
    let steps = AtomicU64::new(0);
    let mut resources = Resources::default();
    read_case((&case(), NAME), Overrides::from(&[][..]).with(&resources)).unwrap();
    let stopped = resources.fly(by(2, &stop, &steps));
    assert!(matches!(stopped, Err(Error::Interrupted)), "{stopped:?}");
}

#[test]
fn rejects_at_once_what_no_flight_mends() {
    for (set, said) in [
        (("run.duration", "20 hours"), "run.duration"),
        (("fibre.element_length", "0 mm"), "fibre.element_length"),
        (("spinline.die_temperature", "100 °C"), "spinline.die_temperature"),
    ] {
        let refused = read(&[set]).unwrap_err().to_string();
        assert!(refused.contains(said), "{refused}");
    }
    let none = Overrides::from(&[][..]);
    let refused = study("'fibre.element_length' = ['25 mm', '0 mm']", none).unwrap_err().to_string();
    assert!(refused.contains("fibre.element_length"), "{refused}");
}

fn study(vary: &str, set: Overrides<'_>) -> Result<StudyFile, Error> {
    let text = format!("case = 'case.toml'\ndesign = 'grid'\nreplicates = 2\n[vary]\n{vary}\n");
    parse_study(&text, "study.toml", set, |_, _| Ok((case(), NAME.to_owned())))
}

#[test]
fn identical_points_of_a_study_whose_tensions_are_flown_at_once() {
    let (whole, wanted) =
        settled(2, |known| study("'spinline.throughput' = ['0.45 g/min', '0.5 g/min']", known));
    assert_eq!(wanted, 2);
    // A point is the case with its values, found by flights of its own.
    for (point, throughput) in whole.study.points.iter().zip(["0.45 g/min", "0.5 g/min"]) {
        let (alone, _) = settled_case(1, &[("spinline.throughput", throughput)]);
        assert_eq!(point.experiment.case().unwrap(), &alone);
    }
    let note = whole.notes.iter().find(|note| note.to_string().contains("was found by simulation")).unwrap();
    assert_eq!(note.points, 2);
}

const WEB: &str = "
[[layer]]
[layer.line]
filaments_per_metre = 200
[[layer]]
[layer.line]
filaments_per_metre = 100
throughput = '0.45 g/min'
[web]
width = '0.4 m'
length = '0.4 m'
";

#[test]
fn identical_cases_of_layers_of_which_one_has_another_throughput() {
    // The filament stands above the layers, which have it in common.
    let text = format!("{}{WEB}", case());
    let (web, wanted) = settled(2, |known| read_web((&text, "../../cases/line.toml"), known));
    assert_eq!(wanted, 2);
    for (layer, throughput) in web.spec.layers.iter().zip(["0.5 g/min", "0.45 g/min"]) {
        let (mut alone, _) = settled_case(1, &[("spinline.throughput", throughput)]);
        // The tension is that of the filament alone; in a web it hangs in eddies of all directions.
        alone.air.lateral = Lateral::VonKarman { cutoff: 10.0 };
        assert_eq!(layer.source.case().unwrap(), &alone);
        assert_eq!(layer.fed_filament().feed_speed(), number(&alone, "feed.speed"));
    }
}

#[test]
fn rejects_flights_in_a_study_of_a_spinline_alone() {
    let text = "spinline = 'case.toml'\ndesign = 'grid'\n[vary]\n'spinline.throughput' = ['0.45 g/min', '0.5 g/min']\n";
    let read = parse_study(text, "study.toml", None, |_, _| Ok((case(), NAME.to_owned())));
    let said = read.unwrap_err().to_string();
    assert!(
        said.contains(
            "spinline.end_tension = \"simulated\" needs simulated fibres, and a study of a spinline"
        ),
        "{said}"
    );
}
