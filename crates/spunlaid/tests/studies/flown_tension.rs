//! The tension at the end of a spinline that flights find: the reader says what has to be flown, and whoever
//! reads the file flies it.

use spunlaid::case::{Case, Note, keys};
use spunlaid::ensemble::{Keep, RunControl, fly};
use spunlaid::error::Error;
use spunlaid::input::{
    CaseWithNotes, FlownTension, KeptTensions, Overrides, StudyChanges, StudyFile, Unflown, Unread,
    parse_case, parse_changed_study, parse_spinline, parse_web,
};
use spunlaid::lanes::Isa;
use spunlaid::units::Dimension;
use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// The filament of the whole line, coarse and short.
fn case() -> String {
    let text = include_str!("../../../../cases/whole_line_fibre.toml");
    [
        ("die_temperature", "end_tension = 'flown'\ndie_temperature"),
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

fn read(set: &[(&str, &str)]) -> Result<CaseWithNotes, Unread<CaseWithNotes>> {
    parse_case(&case(), NAME, &owned(set))
}

fn owned(set: &[(&str, &str)]) -> Vec<(String, String)> {
    set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect()
}

fn by<'a>(threads: usize, stop: &'a AtomicBool, steps: &'a AtomicU64) -> RunControl<'a> {
    RunControl { threads, isa: Isa::detect(), stop, fibre_steps: steps, recorder: None }
}

/// What a file is when everything has been flown.
fn flown<T>(read: Result<T, Unread<T>>, threads: usize) -> T {
    let (stop, steps) = (AtomicBool::new(false), AtomicU64::new(0));
    read.or_else(|unread| unread.fly(by(threads, &stop, &steps))).unwrap_or_else(|error| panic!("{error}"))
}

fn unflown<T>(read: Result<T, Unread<T>>) -> Unflown<T> {
    match read {
        Ok(_) => panic!("nothing has to be flown"),
        Err(Unread::Faulty(error)) => panic!("{error}"),
        Err(Unread::Unflown(unflown)) => *unflown,
    }
}

fn number(case: &Case, key: &str) -> f64 {
    keys::find(key).unwrap().get(case).unwrap().number().unwrap()
}

/// Mean tension at the root of the fibres of a case.
fn tension_of(case: &Case) -> f64 {
    let (stop, steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let mut tensions = Vec::new();
    fly::<Error>(case, Keep::NUMBERS, by(2, &stop, &steps), |one| {
        tensions.push(one.number("root_tension"));
        Ok(())
    })
    .unwrap();
    tensions.iter().sum::<f64>() / tensions.len() as f64
}

#[test]
fn identical_tension_when_the_rounds_are_flown_by_hand_and_for_any_number_of_threads() {
    let (case, notes) = flown(read(&[]), 1);
    let tension = number(&case, "spinline.end_tension");
    assert!(tension > 1e-6, "{tension}");
    assert_eq!(flown(read(&[]), 3), (case.clone(), notes.clone()));
    let file = flown(parse_spinline(&self::case(), NAME, &[]), 2);
    assert_eq!(Some(&file.spec.spinline), case.spinline.as_deref());
    let said = notes.iter().map(Note::to_string).find(|note| note.contains("was found by flights")).unwrap();
    assert!(said.starts_with("../../cases/case.toml:8: spinline.end_tension was found by flights"), "{said}");

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
fn the_reader_flies_nothing_and_tells_what_has_to_be_flown() {
    let read_so_far = unflown(read(&[]));
    assert_eq!(read_so_far.tensions(), 1);
    let (case, notes) = read_so_far.without_flights().unwrap();
    let (zero, _) = read(&[("spinline.end_tension", "0 N")]).unwrap();
    assert_eq!(number(case, "feed.speed"), number(&zero, "feed.speed"));
    assert!(notes.iter().any(|note| note.to_string().contains("is found by flights when the case flies")));
    // The bar ends where it should, whichever round was the last.
    let (stop, steps, most) = (AtomicBool::new(false), AtomicU64::new(0), read_so_far.most_steps());
    let (flown, _) = read_so_far.fly(by(1, &stop, &steps)).unwrap();
    let done = steps.into_inner() as f64 / most as f64;
    assert!((done - 1.0).abs() < 0.05, "{done}");
    assert!(number(&flown, "feed.speed") > number(&zero, "feed.speed"));
}

#[test]
fn a_stop_ends_the_flights() {
    let (stop, steps) = (AtomicBool::new(true), AtomicU64::new(0));
    let stopped = unflown(read(&[])).fly(by(2, &stop, &steps));
    assert!(matches!(stopped, Err(Unread::Faulty(Error::Interrupted))), "{stopped:?}");
}

#[test]
fn rejects_at_once_what_no_flight_mends() {
    for (set, said) in [
        (("run.duration", "20 hours"), "run.duration"),
        (("fibre.element_length", "-2 mm"), "fibre.element_length"),
        (("spinline.die_temperature", "100 °C"), "spinline.die_temperature"),
    ] {
        let refused = read(&[set]).unwrap_err();
        assert!(matches!(&refused, Unread::Faulty(error) if error.to_string().contains(said)), "{refused}");
    }
    let refused = study("'fibre.element_length' = ['25 mm', '-2 mm']").unwrap_err();
    assert!(matches!(refused, Unread::Faulty(_)), "{refused}");
    let refused = read(&[]).unwrap_err().refuse().to_string();
    assert!(refused.contains("nothing flies here; write the tension"), "{refused}");
}

fn study(vary: &str) -> Result<StudyFile, Unread<StudyFile>> {
    let text = format!("case = 'case.toml'\ndesign = 'grid'\nreplicates = 2\n[vary]\n{vary}\n");
    let changes = StudyChanges { set: Overrides::from(&[][..]), ..StudyChanges::points(None) };
    parse_changed_study(&text, "study.toml", &changes, |_, _| Ok((case(), NAME.to_owned())))
}

/// Keeps tensions in memory, and stops the flights when it has got so many.
#[derive(Default)]
struct Store {
    kept: Mutex<BTreeMap<u64, FlownTension>>,
    recalled: AtomicU64,
    most: usize,
    stop: AtomicBool,
}

impl KeptTensions for Store {
    fn recall(&self, identity: u64) -> Option<FlownTension> {
        let found = self.kept.lock().unwrap().get(&identity).copied();
        self.recalled.fetch_add(u64::from(found.is_some()), Ordering::Relaxed);
        found
    }

    fn keep(&self, identity: u64, found: FlownTension) -> Result<(), Error> {
        let mut kept = self.kept.lock().unwrap();
        assert_eq!(kept.insert(identity, found), None, "it was flown before");
        self.stop.store(kept.len() == self.most, Ordering::Relaxed);
        Ok(())
    }
}

#[test]
fn identical_points_of_a_study_that_was_stopped_between_two_tensions() {
    let read_study = || study("'spinline.throughput' = ['0.45 g/min', '0.5 g/min']");
    let whole = flown(read_study(), 2);
    // A point is the case with its values, found by flights of its own.
    for (point, throughput) in whole.study.points.iter().zip(["0.45 g/min", "0.5 g/min"]) {
        let (alone, _) = flown(read(&[("spinline.throughput", throughput)]), 1);
        assert_eq!(point.experiment.case().unwrap(), &alone);
    }
    let note = whole.notes.iter().find(|note| note.to_string().contains("was found by flights")).unwrap();
    assert_eq!(note.points, 2);

    let (mut store, steps) = (Store { most: 1, ..Store::default() }, AtomicU64::new(0));
    let first = unflown(read_study());
    assert_eq!(first.tensions(), 2);
    let stopped = first.fly_and_keep(by(1, &store.stop, &steps), &store);
    assert!(matches!(stopped, Err(Unread::Faulty(Error::Interrupted))), "{stopped:?}");
    assert_eq!(store.kept.lock().unwrap().len(), 1);
    store.most = usize::MAX;
    store.stop.store(false, Ordering::Relaxed);
    let again = unflown(read_study()).fly_and_keep(by(1, &store.stop, &steps), &store).unwrap();
    assert_eq!((again.study.points, again.text), (whole.study.points, whole.text));
    assert_eq!(store.recalled.into_inner(), 1);
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
    let read_web = || {
        // The filament stands above the layers, which have it in common.
        parse_web(&format!("{}{WEB}", case()), "../../cases/line.toml", &[])
    };
    assert_eq!(unflown(read_web()).tensions(), 2);
    let web = flown(read_web(), 2);
    for (layer, throughput) in web.spec.layers.iter().zip(["0.5 g/min", "0.45 g/min"]) {
        let (alone, _) = flown(read(&[("spinline.throughput", throughput)]), 1);
        assert_eq!(layer.source.case().unwrap(), &alone);
        assert_eq!(layer.feed_speed, number(&alone, "feed.speed"));
    }
}

#[test]
fn rejects_flights_in_a_study_of_a_spinline_alone() {
    let text = "spinline = 'case.toml'\ndesign = 'grid'\n[vary]\n'spinline.throughput' = ['0.45 g/min', '0.5 g/min']\n";
    let changes = StudyChanges { set: Overrides::from(&[][..]), ..StudyChanges::points(None) };
    let read = parse_changed_study(text, "study.toml", &changes, |_, _| Ok((case(), NAME.to_owned())));
    let said = read.unwrap_err().to_string();
    assert!(
        said.contains("spinline.end_tension = \"flown\" takes flights, and a study of a spinline"),
        "{said}"
    );
}
