//! Studies: points equal single runs, bits do not depend on packing, replicates by need, effects of synthetic models.

use crate::short;
use crate::short::{SHORT, case_of};
use spunlaid_experiment::study::{fly_batches, measured, results_of_point, run};
use spunlaid_experiment::{
    Batch, Journal, PointResults, Progress, Record, ReplicateOutcome, Replicates, Study,
};
use spunlaid_fibre::Case;
use spunlaid_fibre::case::keys::{self, Value};
use spunlaid_ground::{Error, Estimate, Isa, RunContext};
use spunlaid_input::{StudyFile, parse_study, read_case, starter_case, write_case};
use spunlaid_simulation::ensemble::fly;
use spunlaid_simulation::{Recorded, Results, Trajectory};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

fn study(text: &str) -> StudyFile {
    short::study(SHORT, text)
}

fn computing<'a>(threads: usize, stop: &'a AtomicBool, steps: &'a AtomicU64) -> RunContext<'a> {
    RunContext { threads, isa: Isa::detect(), stop, done: steps }
}

fn simulated(study: &Study, threads: usize) -> Journal {
    let journal = Mutex::new(Journal::in_memory());
    let stop = AtomicBool::new(false);
    let steps = AtomicU64::new(0);
    let progress = Progress::default();
    run(study, &journal, computing(threads, &stop, &steps), &progress).unwrap();
    let mut journal = journal.into_inner().unwrap();
    let fibres: u64 = (0..study.points.len()).map(|point| journal.held(point)).sum();
    assert_eq!(progress.fibres_done.load(Ordering::Relaxed), fibres);
    assert_eq!(progress.points_done.load(Ordering::Relaxed), study.points.len() as u64);
    // A lost fibre ends early, and its neighbours fly twice.
    if (0..study.points.len()).all(|point| results_of_point(study, &mut journal, point).unwrap().lost == 0) {
        assert_eq!(steps.into_inner(), progress.steps.into_inner());
    }
    journal
}

/// The trajectories of `spunlaid run`.
fn single(case: &Case) -> Vec<Trajectory> {
    let (stop, steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let mut flights = Vec::new();
    let done: Result<(), Error> = fly(case, Recorded::NUMBERS, computing(2, &stop, &steps), |flight| {
        flights.push(flight);
        Ok(())
    });
    done.unwrap();
    flights
}

const MIXED: &str = "case = 'case.toml'
design = 'grid'
replicates = 5
seed = 7
[vary]
'air.velocity' = ['5 m/s', '10 m/s', '20 m/s']
'air.length_scale' = ['50 mm', '100 mm']
'run.damping' = ['0 1/s', '3 1/s']
";

#[test]
fn identical_to_single_runs_whether_phases_are_common_or_not() {
    for common in [true, false] {
        let study = study(&format!("common_phases = {common}\n{MIXED}")).study;
        assert_eq!(study.points.len(), 12);
        let mut journal = simulated(&study, 2);
        for (index, point) in study.points.iter().enumerate() {
            // `--print-point` prints exactly the point.
            let (case, _) = read_case((&write_case(case_of(point)), "point.toml"), &[]).unwrap();
            assert_eq!(&case, case_of(point));
            assert_eq!(case.run.seed == 7, common);
            let flights = single(&case);
            let records = journal.records(index, 99).unwrap();
            assert_eq!(records.len(), 5);
            for (flight, record) in flights.iter().zip(&records) {
                assert_eq!(record.replicate, flight.replicate);
                // Text, because NaN differs from NaN.
                let expected = ReplicateOutcome::Measured(measured(flight));
                assert_eq!(format!("{:?}", record.outcome), format!("{expected:?}"), "point {index}");
            }
            // The means have the same bits, too.
            let mut collector = Results::collector(0);
            flights.into_iter().for_each(|flight| collector.take(flight));
            let all = collector.finish();
            let of_point = results_of_point(&study, &mut journal, index).unwrap();
            for number in &all.numbers {
                let i = study.quantity(number.measure.name).unwrap();
                // A number that is defined for no fibre has no mean.
                let known = |mean: f64| Some(mean).filter(|mean| !mean.is_nan());
                assert_eq!(known(of_point.mean(i)), known(number.estimate.mean));
                assert_eq!(of_point.standard_error(i), number.estimate.standard_error);
            }
        }
    }
}

#[test]
fn seeds_of_points_differ_and_do_not_depend_on_other_points() {
    let seeds = |text: &str| -> Vec<u64> {
        study(text).study.points.iter().map(|point| case_of(point).run.seed).collect()
    };
    let some = seeds(&format!("common_phases = false\n{MIXED}"));
    let mut different = some.clone();
    different.sort_unstable();
    different.dedup();
    assert_eq!(different.len(), 12);
    assert!(some.iter().all(|seed| *seed < 1 << 53));
    let fewer = seeds(&format!("common_phases = false\n{}", MIXED.replace(", '20 m/s'", "")));
    assert_eq!(fewer, some[..8]);
}

#[test]
fn identical_for_any_threads_and_any_packing() {
    let study = study(MIXED).study;
    let mut whole = simulated(&study, 1);
    let all = |journal: &mut Journal| -> Vec<Record> {
        (0..study.points.len()).flat_map(|point| journal.records(point, 99).unwrap()).collect()
    };
    let expected = all(&mut whole);
    assert_eq!(all(&mut simulated(&study, 3)), expected);
    // Some fibres exist already, so the others are packed differently.
    for (offset, stride) in [(0, 2), (1, 3), (4, 7), (0, 60)] {
        let mut journal = Journal::in_memory();
        let there: Vec<Record> = expected.iter().skip(offset).step_by(stride).cloned().collect();
        journal.add(&there).unwrap();
        let journal = Mutex::new(journal);
        let stop = AtomicBool::new(false);
        let steps = AtomicU64::new(0);
        let progress = Progress::default();
        run(&study, &journal, computing(2, &stop, &steps), &progress).unwrap();
        assert_eq!(all(&mut journal.into_inner().unwrap()), expected);
        let steps_per_fibre = case_of(&study.points[0]).run.steps;
        assert_eq!(
            steps.into_inner(),
            (60 - there.len() as u64) * steps_per_fibre,
            "nothing is simulated twice"
        );
    }
}

#[test]
fn flights_of_points_come_in_the_order_of_replicates() {
    let study = study(MIXED).study;
    let batches: Vec<Batch> = (0..12).map(|point| Batch { point, replicates: 1..4 }).collect();
    let (stop, steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let mut taken = vec![Vec::new(); 12];
    let done: Result<(), Error> = fly_batches(
        &study.points,
        &batches,
        Recorded::NUMBERS,
        computing(2, &stop, &steps),
        |point, flight| {
            taken[point].push(flight.replicate);
            Ok(())
        },
    );
    done.unwrap();
    assert!(taken.iter().all(|replicates| *replicates == [1, 2, 3]));
}

#[test]
fn replicates_are_flown_until_the_error_is_small_the_same_however_interrupted() {
    let text = "case = 'case.toml'
design = 'grid'
[replicates]
at_least = 3
at_most = 40
until = { amplitude_y = '10 %', frequency_y = 0.5 }
[vary]
'air.velocity' = ['5 m/s', '20 m/s']
";
    let study = study(text).study;
    let mut journal = simulated(&study, 2);
    let counts: Vec<u64> = (0..2).map(|point| journal.held(point)).collect();
    for (point, count) in counts.iter().enumerate() {
        let results = results_of_point(&study, &mut journal, point).unwrap();
        let is_small =
            |i: usize, fraction: f64| results.standard_error(i).unwrap() <= fraction * results.mean(i);
        assert!(*count == 40 || is_small(0, 0.1) && is_small(2, 0.5), "{count} of point {point}");
        assert!(*count > 3);
    }
    // The study is stopped again and again, after about one flight each time.
    let mut kept = Mutex::new(Journal::in_memory());
    for _ in 0..100 {
        let (stop, steps) = (AtomicBool::new(false), AtomicU64::new(0));
        let progress = Progress::default();
        let done = std::thread::scope(|scope| {
            scope.spawn(|| {
                while steps.load(Ordering::Relaxed) < 4000 && !stop.load(Ordering::Relaxed) {
                    std::thread::yield_now();
                }
                stop.store(true, Ordering::Relaxed);
            });
            let done = run(&study, &kept, computing(1, &stop, &steps), &progress);
            stop.store(true, Ordering::Relaxed);
            done
        });
        match done {
            Ok(()) => break,
            Err(Error::Interrupted) => {}
            Err(other) => panic!("{other}"),
        }
    }
    let kept = kept.get_mut().unwrap();
    for point in 0..2 {
        assert_eq!(kept.records(point, 99).unwrap(), journal.records(point, 99).unwrap());
    }
}

#[test]
fn a_lost_fibre_costs_its_neighbours_nothing() {
    // The drag changes the velocity by more than its value in one step, which no check foresees.
    let (mut good, _) = read_case((SHORT, "case.toml"), &[]).unwrap();
    good.run.steps = 5000;
    let mut bad = good.clone();
    (bad.fibre.diameter, bad.air.velocity) = (2e-6, 3000.0);
    let study = Study::from_cases([good.clone(), bad, good.clone()], Replicates::fixed(3));
    let mut journal = simulated(&study, 1);
    let alone = simulated(&Study::from_cases([good], Replicates::fixed(3)), 1).records(0, 9).unwrap();
    for point in [0, 2] {
        let records = journal.records(point, 9).unwrap();
        assert!(records.iter().zip(&alone).all(|(a, b)| a.outcome == b.outcome));
    }
    let lost = journal.records(1, 9).unwrap();
    assert!(lost.iter().all(|record| matches!(record.outcome, ReplicateOutcome::Lost { .. })), "{lost:?}");
    let results: PointResults = results_of_point(&study, &mut journal, 1).unwrap();
    assert_eq!((results.n, results.lost), (0, 3));
    assert!(results.mean(0).is_nan() && results.standard_error(0).is_none());
}

#[test]
fn published_students_t() {
    for (degrees, t) in [
        (1, 12.7062),
        (2, 4.30265),
        (9, 2.26216),
        (30, 2.04227),
        (31, 2.03951),
        (63, 1.99834),
        (100_000, 1.95999),
    ] {
        assert!((spunlaid_ground::statistics::student_t_95(degrees) / t - 1.0).abs() < 4e-6, "{degrees}");
    }
    let estimate = Estimate::new(vec![1.0, 2.0]);
    assert_eq!(estimate.standard_error, Some(0.5));
}

#[test]
fn a_study_written_out_is_the_same_study() {
    for text in [
        MIXED.to_owned(),
        format!("common_phases = false\n{MIXED}"),
        "case = 'case.toml'\ndesign = 'latin-hypercube'\npoints = 9\nseed = 12345678901234567890\n\
        [replicates]\nat_most = 50\nuntil = { frequency_z = '7 %' }\n[vary]\n\
        air.velocity = { from = '5 m/s', to = '7 m/s', spacing = 'log' }\nair.harmonics = [128, 256]\n\
        [link]\n'air.cutoff_frequency' = 'taylor'\n"
            .to_owned(),
        "case = 'case.toml'\ndesign = 'one-at-a-time'\n[vary]\n\
        'fibre.diameter' = { from = '20 um', to = '60 um', steps = 5 }\n[link]\n\
        'fibre.density' = '= 950 kg/m^3 * (50 µm / fibre.diameter) ^ 0.5'\nrun.spin_up = 'run.duration / 4'\n"
            .to_owned(),
    ] {
        let (first, again) = (study(&text), study(&study(&text).text));
        assert_eq!(first.text, again.text);
        assert_eq!(first.study.points, again.study.points);
        assert_eq!(first.study.identity(), again.study.identity());
    }
    let mut other = study(MIXED).study;
    let before = other.identity();
    let mut denser = case_of(&other.points[3]).clone();
    denser.fibre.density += 1e-9;
    other.points[3].experiment = denser.into();
    assert_ne!(other.identity(), before);
}

#[test]
fn the_identity_of_a_study_is_that_of_the_keys_of_its_points() {
    let grid = study(MIXED).study;
    // The same points, said in other words.
    let mut again =
        Study::from_cases(grid.points.iter().map(|point| case_of(point).clone()), Replicates::fixed(9));
    assert_eq!(again.identity(), grid.identity());
    // Every key of a point counts, to the last bit.
    let mut counted = 0;
    // What a run is checked for does not change it.
    for key in keys::all().iter().filter(|key| !["run.replicates", "run.checks"].contains(&key.name)) {
        let mut case = case_of(&grid.points[5]).clone();
        let other: Value = match key.get(&case) {
            Some(Value::Number(number)) => number.next_up().into(),
            Some(Value::Whole(number)) => (number + 1).into(),
            Some(Value::Text(word)) => match key.kind.words().into_iter().find(|other| *other != word) {
                Some(other) => other.into(),
                None => continue,
            },
            _ => continue,
        };
        let before = key.get(&case);
        // Times are whole steps, so the next number may be the same time.
        if key.set(&mut case, other).is_ok() && key.get(&case) != before {
            again.points[5].experiment = case.into();
            assert_ne!(again.identity(), grid.identity(), "{}", key.name);
            counted += 1;
        }
    }
    assert!(counted > 20, "{counted}");
}

#[test]
fn links_follow_what_varies() {
    let text = "case = 'case.toml'\ndesign = 'grid'\n[vary]\nair.velocity = ['5 m/s', '10 m/s']\n[link]\n\
                'air.cutoff_frequency' = 'taylor'\n'run.spin_up' = '0.1 / air.cutoff_frequency'\n";
    let study = study(text).study;
    let values: Vec<Vec<f64>> = study.points.iter().map(|point| point.values.clone()).collect();
    assert_eq!(values, [[5.0, 25.0, 0.004], [10.0, 50.0, 0.002]]);
    assert_eq!(
        study.points.iter().map(|point| case_of(point).air.cutoff_frequency).collect::<Vec<_>>(),
        [25.0, 50.0]
    );
    assert_eq!(
        study.points.iter().map(|point| case_of(point).run.spin_up_steps).collect::<Vec<_>>(),
        [200, 100]
    );
}

#[test]
fn defaults_follow_what_varies() {
    // Without an element length in the case, every point takes the length of its eddies.
    let lines = starter_case().lines().filter(|line| !line.starts_with("element_length"));
    let without = lines.collect::<Vec<_>>().join("\n");
    let (case, _) = read_case((&without, "starter.toml"), &[]).unwrap();
    let text = "case = 'c'\ndesign = 'grid'\n[vary]\nair.length_scale = ['50 mm', '25 mm']\n";
    let starter = |_: &str, _| Ok((without.clone(), "starter.toml".to_owned()));
    let study = parse_study(text, "study.toml", None, starter).unwrap().study;
    let elements: Vec<usize> = study.points.iter().map(|point| case_of(point).fibre.elements).collect();
    assert_eq!(elements, [20, 40]);
    assert_eq!(case_of(&study.points[0]), &case);
}

#[test]
fn remarks_are_merged_over_points() {
    let text = "case = 'c'\ndesign = 'grid'\n[vary]\nfibre.diameter = ['50 µm', '5 µm', '6 µm', '7 µm']\n";
    let notes: Vec<String> = study(text).notes.iter().map(ToString::to_string).collect();
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert!(
        notes[0].starts_with(
            "study.toml: point 2 (fibre.diameter = 5 µm): fibre.diameter = 5 µm is outside 13 µm"
        ) && notes[0].ends_with("(this applies to 2 more points)"),
        "{notes:?}"
    );
}

#[test]
fn few_replicates_before_a_stop_are_warned_of() {
    let notes = |at_least: u64| {
        let text = format!(
            "case = 'c'\ndesign = 'grid'\n[replicates]\nat_least = {at_least}\nuntil = {{ amplitude_y = '5 %' }}\n\
             [vary]\nair.velocity = ['5 m/s', '10 m/s']\n"
        );
        study(&text).notes.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    assert!(notes(6).is_empty(), "{:?}", notes(6));
    let few = notes(5);
    assert!(
        few.len() == 1 && few[0].starts_with("study.toml: replicates.at_least = 5 is too few"),
        "{few:?}"
    );
}

/// Every kind of word that a study may vary, with numbers beside them.
const WORDS: &str = "case = 'case.toml'
design = 'one-at-a-time'
replicates = 3
[vary]
'drag.along' = ['matsui', 'sakiadis', 'glauert-lighthill']
'drag.across' = ['ju-shambaugh', 'marheineke-wegener']
'air.spectrum' = ['flat', 'von-karman']
'air.eddies' = ['independent', 'convected']
'fibre.root' = ['clamped', 'free']
'run.scheme' = ['leapfrog', 'implicit-tension']
'air.velocity' = ['5 m/s', '20 m/s']
";

#[test]
fn identical_to_single_runs_where_words_vary() {
    let study = study(WORDS).study;
    // The base case, and every value that differs from its own.
    assert_eq!(study.points.len(), 1 + 2 + 1 + 1 + 1 + 2 + 2 + 2);
    let mut journal = simulated(&study, 2);
    let mut different = std::collections::BTreeSet::new();
    for (index, point) in study.points.iter().enumerate() {
        let (case, _) = read_case((&write_case(case_of(point)), "point.toml"), &[]).unwrap();
        assert_eq!(&case, case_of(point));
        let records = journal.records(index, 99).unwrap();
        assert_eq!(records.len(), 3);
        for (flight, record) in single(&case).iter().zip(&records) {
            assert_eq!(record.outcome, ReplicateOutcome::Measured(measured(flight)), "point {index}");
        }
        different.insert(format!("{:?}", records[0].outcome));
    }
    assert_eq!(different.len(), study.points.len(), "every word changes the flight");
}

#[test]
fn identical_to_single_runs_where_elements_of_equal_number_differ_in_length() {
    let text = "case = 'c'\ndesign = 'paired'\nreplicates = 2\n[vary]\nfibre.length = ['1 m', '2 m']\n\
                fibre.element_length = ['50 mm', '100 mm']\nair.length_scale = ['50 mm', '100 mm']\n";
    let study = study(text).study;
    let mut journal = simulated(&study, 1);
    for (index, point) in study.points.iter().enumerate() {
        let records = journal.records(index, 9).unwrap();
        let landings: Vec<ReplicateOutcome> = records.iter().map(|record| record.outcome.clone()).collect();
        let alone: Vec<ReplicateOutcome> = single(case_of(point))
            .iter()
            .map(|flight| ReplicateOutcome::Measured(measured(flight)))
            .collect();
        assert_eq!(landings, alone, "point {index}");
    }
}

#[test]
fn words_may_be_drawn_and_are_written_out_again() {
    for design in ["latin-hypercube"] {
        let text = format!(
            "case = 'case.toml'\ndesign = '{design}'\npoints = 16\n[vary]\n'drag.along' = ['sakiadis', 'matsui']\n\
             'air.velocity' = {{ from = '5 m/s', to = '20 m/s' }}\n"
        );
        let (first, again) = (study(&text), study(&study(&text).text));
        assert_eq!(first.study.points, again.study.points);
        assert!(first.text.contains("\"drag.along\" = [\"sakiadis\", \"matsui\"]"), "{}", first.text);
        let laws: Vec<&str> =
            first.study.points.iter().map(|point| case_of(point).drag.along.name()).collect();
        assert_eq!(laws.iter().filter(|law| **law == "matsui").count(), 8, "{laws:?}");
        for (point, law) in first.study.points.iter().zip(laws) {
            assert_eq!(first.study.inputs().next().unwrap().word(point.values[0]), Some(law));
        }
    }
}

#[test]
fn keys_of_another_word_are_left_out_where_they_mean_nothing() {
    let case = format!("{SHORT}[drag]\nfriction_coefficient = 0.5\n");
    let text = "case = 'c'\ndesign = 'grid'\n[vary]\ndrag.along = ['matsui', 'sakiadis']\n";
    let file = parse_study(text, "study.toml", None, |_, _| Ok((case, "case.toml".to_owned()))).unwrap();
    let factors: Vec<Option<f64>> =
        file.study.points.iter().map(|point| case_of(point).drag.along.factor()).collect();
    assert_eq!(factors, [Some(0.5), None]);
    let notes: Vec<String> = file.notes.iter().map(ToString::to_string).collect();
    assert_eq!(
        notes,
        ["study.toml: point 2 (drag.along = \"sakiadis\"): drag.friction_coefficient = 0.5 is left out, \
            because it needs drag.along = \"matsui\""]
    );
}
