//! What is kept comes back to the bit, from fibres of fixed length and fed ones, and nothing that is damaged does.

use super::*;
use crate::Failure;
use crate::output::folder::ENTRIES;
use crate::output::tables::{TableRecorder, Tables};
use spunlaid::ensemble::{KeepShapes, RunControl, Trajectory, fly};
use spunlaid::input::parse_case;
use spunlaid::lanes::{Isa, WIDTH};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64};

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
    tables: BTreeMap<&'static str, Vec<u8>>,
    found: usize,
    recalled: bool,
}

fn process(desk: &Path, case: &Case, until: u64) -> Process {
    let staging = Staging::new(&desk.join("r"), ENTRIES, true, &STOP).unwrap();
    let fed = case.line.is_some();
    let keep = Keep { shapes: KeepShapes::within(case, 100_000), ..Keep::CURVES };
    let recorder = TableRecorder::new(&staging, fed);
    let mut tables = Tables::create(&staging, &recorder).unwrap();
    let mut kept = KeptFlights::open(&staging, case, keep);
    let (earlier, keeping) = (&kept.earlier, &mut kept.keeping);
    let mut trajectories = Vec::new();
    let mut take = |trajectory: Trajectory| {
        if trajectory.replicate < until {
            let before = tables.rows();
            tables.add(trajectory.replicate)?;
            keeping.land(&trajectory, &before, &tables);
            trajectories.push(trajectory);
        }
        Ok::<(), Failure>(())
    };
    let (found, replicates) = (earlier.fibres(), case.run.replicates);
    let flights = (0..replicates).step_by(WIDTH).map(|first| first..replicates.min(first + WIDTH as u64));
    let recalled = flights.map(|flight| earlier.recall(flight, &recorder).unwrap());
    let recalled: Option<Vec<_>> = recalled.collect();
    let is_recalled = recalled.is_some();
    match recalled {
        Some(all) => all.into_iter().flatten().try_for_each(&mut take).unwrap(),
        None => {
            let steps = AtomicU64::new(0);
            let computing = RunControl {
                threads: 1,
                isa: Isa::detect(),
                stop: &STOP,
                fibre_steps: &steps,
                recorder: Some(&recorder),
            };
            fly(case, keep, computing, take).unwrap();
        }
    }
    kept.keeping.settle(&tables);
    kept.interrupted = true;
    tables.finish().unwrap();
    let bytes = |name| (name, std::fs::read(staging.place(name).0).unwrap());
    Process {
        tables: table_names(fed).into_iter().map(bytes).collect(),
        // The shapes of fed and fixed fibres are in files of the staging folder, which goes now.
        trajectories: trajectories.into_iter().map(in_memory).collect(),
        found,
        recalled: is_recalled,
    }
}

fn in_memory(trajectory: Trajectory) -> Trajectory {
    let shapes = trajectory.shapes.iter().map(Result::unwrap).collect();
    Trajectory { shapes, ..trajectory }
}

fn text(process: &Process) -> String {
    process.trajectories.iter().map(|trajectory| format!("{trajectory:?}\n")).collect()
}

fn case(text: &str) -> Case {
    parse_case(text, "case.toml", &[]).unwrap().0
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
        // Rows of whole groups, and those after them.
        assert!(rows == 0 || rows > 1 << 15);
        for _ in 0..2 {
            let again = process(desk.path(), &case, replicates);
            assert!(again.found == first.trajectories.len() && again.recalled);
            assert!(again.tables == first.tables && text(&again) == text(&first));
        }
        // Who has found more is read, not who was there last.
        let few = process(desk.path(), &case, 1);
        assert!(few.recalled && few.trajectories.len() == 1);
        let again = process(desk.path(), &case, replicates);
        assert!(again.recalled && again.tables == first.tables);
    }
}

#[test]
fn rejects_what_is_damaged_or_of_another_case() {
    let case = case(FIXED);
    let replicates = case.run.replicates;
    let whole = tempfile::tempdir().unwrap();
    let first = process(whole.path(), &case, replicates);
    // In a group of rows, at the end of what has landed, and in the middle of it.
    for (name, part, found) in
        [("energy.parquet", 0.5, replicates), (LANDED, 1.0, replicates - 1), (LANDED, 0.5, replicates - 1)]
    {
        let desk = tempfile::tempdir().unwrap();
        process(desk.path(), &case, replicates);
        let path = desk.path().join(".r.flown/1").join(name);
        let mut bytes = std::fs::read(&path).unwrap();
        let at = (part * (bytes.len() - 1) as f64) as usize;
        bytes[at] ^= 1;
        std::fs::write(&path, bytes).unwrap();
        let again = process(desk.path(), &case, replicates);
        assert!(again.found as u64 <= found && !again.recalled, "{name} at {at}: {}", again.found);
        assert!(again.tables == first.tables && text(&again) == text(&first), "{name} at {at}");
    }
    let mut other = case;
    other.run.seed += 1;
    assert_eq!(process(whole.path(), &other, replicates).found, 0);
}
