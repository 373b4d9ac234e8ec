//! Makes the missing replicates of a study: flies its fibres, lays its webs or solves its spinlines.

use super::batch::{Batch, LostReplicate, fly_and_land};
use super::journal::{Journal, unsynced};
use super::made::{lay_webs, solve_spinlines};
use super::measures::{Record, ReplicateOutcome, measured};
use super::rounds::Rounds;
use super::{Point, Study};
use spunlaid_ground::threads::{lock, look_while, unlock};
use spunlaid_ground::{Error, RunContext};
use spunlaid_simulation::{Recorded, Trajectory};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// Time between two flushes of the journal to the disk.
const SYNC: Duration = Duration::from_millis(500);

/// Progress of a study; another thread may read it.
#[derive(Debug, Default)]
pub struct Progress {
    /// Replicates planned so far; the number grows when a point needs more replicates.
    pub fibres: AtomicU64,
    /// Replicates finished.
    pub fibres_done: AtomicU64,
    /// Points with all replicates planned so far.
    pub points_done: AtomicU64,
    /// Total steps of the fibres to fly, and pieces of the webs to lay; [`RunContext::done`] counts up
    /// to this number.
    pub steps: AtomicU64,
}

/// Makes the replicates that the journal does not hold yet.
///
/// With [`Replicates::until`], more replicates follow in rounds. The decision for a point depends on its own
/// replicates only, never on threads or interruptions.
///
/// # Errors
/// When the computation is stopped, and when the journal cannot be written or read. A fibre whose positions become
/// infinite or NaN is not an error; it is recorded as lost.
pub fn run(
    study: &Study,
    journal: &Mutex<Journal>,
    computing: RunContext<'_>,
    progress: &Progress,
) -> Result<(), Error> {
    let mut rounds = Rounds::new(study);
    loop {
        fly_missing(study, journal, &rounds, computing, progress)?;
        if !rounds.next(study, &mut lock(journal))? {
            return Ok(());
        }
    }
}

/// Flies a bundle of a study, wherever that is; the records are what [`run`] would add to the journal.
///
/// * `points` – those to which the bundle's batches refer
/// * `sides` – [`Study::patch_sides`]
///
/// # Errors
/// When the computation is stopped, and when a case cannot be simulated. A lost fibre is a record.
pub fn fly_bundle(
    points: &[Point],
    sides: &[f64],
    bundle: &[Batch],
    computing: RunContext<'_>,
) -> Result<Vec<Record>, Error> {
    let (all, steps) = (Mutex::new(Vec::new()), AtomicU64::new(0));
    make(points, sides, bundle, computing, &steps, &|records: Vec<Record>| {
        lock(&all).extend(records);
        Ok(())
    })?;
    let mut all = unlock(all);
    all.sort_by_key(|record| (record.point, record.replicate));
    Ok(all)
}

/// Makes the replicates of some batches: lays webs, solves spinlines and flies fibres.
///
/// * `steps` – becomes larger by those of the webs
/// * `keep` – receives the records of each web, of each spinline and of each flight, from several threads
fn make(
    points: &[Point],
    sides: &[f64],
    batches: &[Batch],
    computing: RunContext<'_>,
    steps: &AtomicU64,
    keep: &(impl Fn(Vec<Record>) -> Result<(), Error> + Sync),
) -> Result<(), Error> {
    lay_webs(points, sides, batches, computing, steps, |record| keep(vec![record]))?;
    solve_spinlines(points, batches, computing, |record| keep(vec![record]))?;
    let flies = |batch: &&Batch| points[batch.point].experiment.case().is_some();
    let simulated: Vec<Batch> = batches.iter().filter(flies).cloned().collect();
    let land = |trajectories, lost| keep(records(trajectories, lost));
    fly_and_land(points, &simulated, Recorded::NUMBERS, computing, land, Ok)
}

fn fly_missing(
    study: &Study,
    journal: &Mutex<Journal>,
    rounds: &Rounds,
    computing: RunContext<'_>,
    progress: &Progress,
) -> Result<(), Error> {
    let batches = rounds.missing(&lock(journal));
    let lacking = MissingReplicates::new(study, rounds.required(), &batches, progress);
    if batches.is_empty() {
        return Ok(());
    }
    with_sync(journal, |failed| {
        let keep = |records: Vec<Record>| {
            failed().map_or(Ok(()), Err)?;
            lock(journal).add(&records)?;
            lacking.landed(&records, progress);
            Ok(())
        };
        make(&study.points, &study.patch_sides(), &batches, computing, &progress.steps, &keep)
    })?
}

/// Does `work` while another thread flushes the journal to the disk twice a second, and once more at the end.
/// `work` receives a function that returns the error of a failed flush.
fn with_sync<T>(
    journal: &Mutex<Journal>,
    work: impl FnOnce(&(dyn Fn() -> Option<Error> + Sync)) -> T,
) -> Result<T, Error> {
    let Some(file) = lock(journal).handle()? else {
        return Ok(work(&|| None));
    };
    let failure = Mutex::new(None);
    let sync = || {
        if let Err(error) = file.sync_data() {
            *lock(&failure) = Some(unsynced(&error));
        }
    };
    let failed = || lock(&failure).take();
    let outcome = look_while(SYNC, sync, || work(&failed));
    match failed() {
        Some(error) => Err(error),
        None => Ok(outcome),
    }
}

/// Number of replicates that each point still lacks.
struct MissingReplicates(Vec<AtomicU64>);

impl MissingReplicates {
    fn new(study: &Study, wanted: &[u64], batches: &[Batch], progress: &Progress) -> Self {
        let mut lacking = vec![0; wanted.len()];
        let mut steps = 0;
        for Batch { point, replicates } in batches {
            let count = replicates.end - replicates.start;
            lacking[*point] += count;
            steps += count * study.points[*point].experiment.case().map_or(0, |case| case.run.steps);
        }
        let total: u64 = wanted.iter().sum();
        progress.fibres.store(total, Ordering::Relaxed);
        progress.fibres_done.store(total - lacking.iter().sum::<u64>(), Ordering::Relaxed);
        let done = lacking.iter().filter(|lacking| **lacking == 0).count();
        progress.points_done.store(done as u64, Ordering::Relaxed);
        progress.steps.fetch_add(steps, Ordering::Relaxed);
        Self(lacking.into_iter().map(AtomicU64::new).collect())
    }

    fn landed(&self, records: &[Record], progress: &Progress) {
        progress.fibres_done.fetch_add(records.len() as u64, Ordering::Relaxed);
        for record in records {
            if self.0[record.point as usize].fetch_sub(1, Ordering::Relaxed) == 1 {
                progress.points_done.fetch_add(1, Ordering::Relaxed);
            }
        }
    }
}

fn records(trajectories: Vec<(usize, Trajectory)>, lost: Vec<LostReplicate>) -> Vec<Record> {
    let measured = trajectories.into_iter().map(|(point, trajectory)| Record {
        point: point as u64,
        replicate: trajectory.replicate,
        outcome: ReplicateOutcome::Measured(measured(&trajectory)),
    });
    let lost = lost.into_iter().filter_map(|(point, replicate, error)| {
        let (node, time) = error.lost_fibre()?;
        let outcome = ReplicateOutcome::Lost { node: node as u64, time };
        Some(Record { point: point as u64, replicate, outcome })
    });
    measured.chain(lost).collect()
}
