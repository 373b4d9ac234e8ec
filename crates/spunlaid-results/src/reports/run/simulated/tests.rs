//! What is kept comes back to the bit, from fibres of fixed length and fed ones, and nothing that is damaged does.

use super::*;
use crate::files::folder::ENTRIES;
use spunlaid_ground::{Isa, RunContext, WIDTH};
use spunlaid_input::read_case;
use spunlaid_simulation::KeepShapes;
use spunlaid_simulation::ensemble::fly;
use std::path::Path;

const FIXED: &str = "version = 1
[fibre]
length = '0.2 m'
diameter = '50 µm'
density = '950 kg/m³'
youngs_modulus = '2 GPa'
[air]
velocity = '10 m/s'
turbulence_intensity = 0.1
length_scale = '50 mm'
cutoff_frequency = '100 Hz'
[run]
duration = '80 ms'
time_step = '20 µs'
output_interval = '20 µs'
replicates = 10
shapes = 5
";
const FED: &str = "version = 1
[fibre]
diameter = '18 µm'
density = '910 kg/m³'
youngs_modulus = '2 GPa'
element_length = '4 mm'
root = 'clamped'
[feed]
speed = '50 m/s'
[belt]
distance = '0.1 m'
speed = '3 m/s'
[air]
velocity = '45 m/s'
turbulence_intensity = 0.1
length_scale = '16 mm'
cutoff_frequency = '700 Hz'
[drag]
across = 'marheineke-wegener'
[run]
duration = '40 ms'
replicates = 3
";

static STOP: AtomicBool = AtomicBool::new(false);

/// Some process that writes the tables of a case to `r`: its trajectories, the bytes of its tables, and how
/// many fibres it has found.
struct Process {
    trajectories: Vec<Trajectory>,
    tables: Vec<Vec<u8>>,
    found: u64,
    recalled: bool,
}

fn process(desk: &Path, case: &Case, until: u64) -> Process {
    let staging = Staging::new(&desk.join("r"), ENTRIES, true, &STOP).unwrap();
    let keep = Recorded { shapes: KeepShapes::within(case, 100_000), ..Recorded::CURVES };
    let simulated = FlightRecords::open(&staging, case, Some(keep)).unwrap();
    let mut tables = Tables::create(&staging, &simulated).unwrap();
    let mut trajectories = Vec::new();
    let mut take = |trajectory: Trajectory| {
        if trajectory.replicate < until {
            tables.add(trajectory.replicate)?;
            simulated.land(&trajectory);
            trajectories.push(trajectory);
        }
        Ok::<(), Failure>(())
    };
    let (found, replicates) = (simulated.earlier(), case.run.replicates);
    let flights = (0..replicates).step_by(WIDTH).map(|first| first..replicates.min(first + WIDTH as u64));
    let recalled: Option<Vec<_>> =
        flights.map(|flight| simulated.recall(flight, &simulated).unwrap()).collect();
    let is_recalled = recalled.is_some();
    match recalled {
        Some(all) => all.into_iter().flatten().try_for_each(&mut take).unwrap(),
        None => {
            let steps = AtomicU64::new(0);
            let computing = RunContext { threads: 1, isa: Isa::detect(), stop: &STOP, done: &steps };
            fly(case, Recorded { recorder: Some(&simulated), ..keep }, computing, take).unwrap();
        }
    }
    simulated.interrupted.store(true, Ordering::Relaxed);
    tables.finish().unwrap();
    let names = tables_of(case);
    Process {
        tables: names.map(|name| fs::read(staging.place(name).0).unwrap()).collect(),
        // The shapes of fed and fixed fibres are in files of the staging folder, which goes now.
        trajectories: trajectories.into_iter().map(in_memory).collect(),
        found,
        recalled: is_recalled,
    }
}

fn tables_of(case: &Case) -> impl Iterator<Item = &'static str> {
    let fed = case.line.is_some();
    tables(fed).into_iter().map(|(name, _)| name).chain(fed.then_some(LAID))
}

fn in_memory(trajectory: Trajectory) -> Trajectory {
    let shapes = trajectory.shapes.iter().map(Result::unwrap).collect();
    Trajectory { shapes, ..trajectory }
}

fn text(process: &Process) -> String {
    process.trajectories.iter().map(|trajectory| format!("{trajectory:?}\n")).collect()
}

fn case(text: &str) -> Case {
    read_case((text, "case.toml"), &[]).unwrap().0
}

#[test]
fn identical_flights_when_an_earlier_process_has_flown_them() {
    for (case, rows) in [(case(FIXED), 10 * 4001), (case(FED), 0)] {
        let desk = tempfile::tempdir().unwrap();
        let replicates = case.run.replicates;
        let first = process(desk.path(), &case, replicates);
        assert_eq!((first.found, first.trajectories.len()), (0, replicates as usize));
        let shapes = first.trajectories.iter().map(|trajectory| trajectory.shapes.len()).sum::<usize>();
        assert!(shapes > 0 && (case.line.is_none() || first.trajectories[0].laid.len() > 100));
        // More than a group of rows.
        assert!(rows == 0 || rows > ROWS);
        for _ in 0..2 {
            let again = process(desk.path(), &case, replicates);
            assert!(again.found == replicates && again.recalled);
            assert!(again.tables == first.tables && text(&again) == text(&first));
        }
        // Who has found more is not hindered by who has taken less.
        let few = process(desk.path(), &case, 1);
        assert!(few.recalled && few.trajectories.len() == 1);
        let again = process(desk.path(), &case, replicates);
        assert!(again.recalled && again.tables == first.tables);
    }
}

/// The file of flights in a folder.
fn kept(folder: &Path) -> PathBuf {
    let mut files = fs::read_dir(folder).unwrap().map(|file| file.unwrap().path());
    files.find(|file| file.extension().is_some_and(|ending| ending == "simulated")).unwrap()
}

#[test]
fn identical_flights_when_a_process_was_killed_anywhere() {
    let (case, whole) = (case(FIXED), tempfile::tempdir().unwrap());
    let first = process(whole.path(), &case, case.run.replicates);
    let file = kept(whole.path());
    let (name, bytes) = (file.file_name().unwrap(), fs::read(&file).unwrap());
    let mut found = Vec::new();
    for part in [0.02, 0.3, 0.5, 0.77, 0.999] {
        let desk = tempfile::tempdir().unwrap();
        fs::write(desk.path().join(name), &bytes[..(part * bytes.len() as f64) as usize]).unwrap();
        let again = process(desk.path(), &case, case.run.replicates);
        assert!(again.tables == first.tables && text(&again) == text(&first), "{part}");
        assert!(!again.recalled && process(desk.path(), &case, case.run.replicates).recalled, "{part}");
        found.push(again.found);
    }
    assert!(found.is_sorted() && found[0] == 0 && found[4] == case.run.replicates - 1, "{found:?}");
}

#[test]
fn rejects_what_is_damaged_or_of_another_case() {
    let (case, whole) = (case(FIXED), tempfile::tempdir().unwrap());
    let replicates = case.run.replicates;
    let first = process(whole.path(), &case, replicates);
    let file = kept(whole.path());
    let (name, bytes) = (file.file_name().unwrap(), fs::read(&file).unwrap());
    for part in [0.01, 0.4, 0.5, 1.0] {
        let (desk, mut bytes) = (tempfile::tempdir().unwrap(), bytes.clone());
        let at = (part * (bytes.len() - 1) as f64) as usize;
        bytes[at] ^= 1;
        fs::write(desk.path().join(name), bytes).unwrap();
        let again = process(desk.path(), &case, replicates);
        assert!(again.found == replicates - 1 && !again.recalled, "at {at}: {}", again.found);
        assert!(again.tables == first.tables && text(&again) == text(&first), "at {at}");
    }
    // Another seed finds nothing, and leaves what there is.
    let mut other = case.clone();
    other.run.seed += 1;
    assert_eq!(process(whole.path(), &other, replicates).found, 0);
    assert_eq!(process(whole.path(), &case, replicates).found, replicates);
}

/// The tables of fibres that land one after the other, or that all fly at once, so that few of their rows
/// stay in memory.
#[test]
fn identical_tables_whatever_stays_in_memory() {
    const FIBRES: u64 = 400;
    const INSTANTS: usize = 1101;
    let case = case(FIXED);
    let written = |at_once: bool| {
        let desk = tempfile::tempdir().unwrap();
        let staging = Staging::new(&desk.path().join("r"), ENTRIES, false, &STOP).unwrap();
        let simulated = FlightRecords::open(&staging, &case, None).unwrap();
        let mut tables = Tables::create(&staging, &simulated).unwrap();
        let sample = |replicate: u64, instant: usize| {
            let time = instant as f64 * 1e-3;
            let kinetic = (time + replicate as f64).sin();
            Sample { time, kinetic, gravity_work: time, ..Sample::default() }
        };
        let record = |replicate, instants: Range<usize>| {
            let samples: Vec<_> = instants.map(|instant| sample(replicate, instant)).collect();
            simulated.samples(replicate, &samples).unwrap();
        };
        if at_once {
            for first in (0..INSTANTS).step_by(77) {
                (0..FIBRES).for_each(|replicate| record(replicate, first..INSTANTS.min(first + 77)));
            }
            assert!(simulated.log.keys().len() > 100, "many have gone to the file");
        }
        for replicate in 0..FIBRES {
            if !at_once {
                record(replicate, 0..INSTANTS);
            }
            tables.add(replicate).unwrap();
        }
        tables.finish().unwrap();
        tables_of(&case).map(|name| fs::read(staging.place(name).0).unwrap()).collect::<Vec<_>>()
    };
    assert!(written(true) == written(false));
}

#[test]
fn what_is_forgotten_does_not_come_back() {
    let (desk, case) = (tempfile::tempdir().unwrap(), case(FED));
    let staging = Staging::new(&desk.path().join("r"), ENTRIES, false, &STOP).unwrap();
    let simulated = FlightRecords::open(&staging, &case, None).unwrap();
    let points = |count: usize| vec![LaidPoint { fed: 1.0, time: 2.0, md: 3.0, cd: 4.0 }; count];
    simulated.lay(0, &points(ROOM / size_of::<LaidPoint>() + 1)).unwrap();
    assert!(simulated.log.count([POINTS, 0]) > 0);
    simulated.begin(0);
    simulated.lay(0, &points(1)).unwrap();
    simulated.write_in_order(0, &simulated.take(0).points, |_| Ok(())).unwrap();
    assert_eq!(simulated.log.count([POINTS, 0]), 4);
}

/// The file is written only: what it had of flights that are in memory may be lost before their tables are made.
#[test]
fn identical_tables_when_the_file_has_lost_what_memory_has() {
    let (desk, case) = (tempfile::tempdir().unwrap(), case(FIXED));
    let samples: Vec<_> =
        (0..5000).map(|i| Sample { time: f64::from(i), kinetic: 1.0, ..Sample::default() }).collect();
    let written = |loses: bool| {
        let staging = Staging::new(&desk.path().join("r"), ENTRIES, true, &STOP).unwrap();
        let simulated = FlightRecords::open(&staging, &case, None).unwrap();
        let mut tables = Tables::create(&staging, &simulated).unwrap();
        samples.chunks(64).for_each(|some| simulated.samples(0, some).unwrap());
        if loses {
            File::options().write(true).open(&simulated.places[0]).unwrap().set_len(0).unwrap();
        }
        tables.add(0).unwrap();
        tables.finish().unwrap();
        tables_of(&case).map(|name| fs::read(staging.place(name).0).unwrap()).collect::<Vec<_>>()
    };
    assert!(written(true) == written(false));
}
