//! Flies the missing fibres of a study, and computes the statistics of its points.

use super::journal::Journal;
use super::measures::{Landing, Record, measure, measured};
use super::pack::{Batch, Lost, fly_and_land};
use super::{Replicates, Study};
use crate::ensemble::{Computing, Keep, Trajectory};
use crate::error::{Error, JournalError};
use crate::observe::MEASURES;
use crate::statistics::Estimate;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Time between two flushes of the journal to the disk.
const SYNC: Duration = Duration::from_millis(500);

/// Progress of a study; another thread may read it.
#[derive(Debug, Default)]
pub struct Progress {
    /// Fibres planned so far; the number grows when a point needs more replicates.
    pub fibres: AtomicU64,
    /// Fibres finished.
    pub fibres_done: AtomicU64,
    /// Points with all replicates planned so far.
    pub points_done: AtomicU64,
    /// Total steps of the fibres to fly; [`Computing::fibre_steps`] counts up to this number.
    pub steps: AtomicU64,
}

/// Statistics of a point over its replicates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointResults {
    /// Fibres measured.
    pub n: u64,
    /// Fibres lost because their positions became infinite or NaN.
    pub lost: u64,
    /// Mean of each of the [`MEASURES`]; NaN without any fibre.
    pub mean: [f64; MEASURES.len()],
    /// Standard error of each mean; of no use from a single fibre. Kept without `Option`, which would take twice the
    /// memory: a study has many points.
    pub errors: [f64; MEASURES.len()],
}

impl PointResults {
    /// Mean and standard error of a measure. None without a measure of this name.
    pub fn of(&self, name: &str) -> Option<(f64, Option<f64>)> {
        measure(name).map(|(index, _)| (self.mean[index], self.standard_error(index)))
    }

    /// Standard error of the mean of a measure, by its index into the [`MEASURES`]; `None` from a single fibre.
    pub fn standard_error(&self, measure: usize) -> Option<f64> {
        (self.n > 1).then(|| self.errors[measure])
    }
}

/// Flies the fibres that the journal does not hold yet.
///
/// With [`Replicates::until`], more replicates are flown in rounds. The decision for a point depends on its own
/// replicates only, never on threads or interruptions.
///
/// # Errors
/// When the computation is stopped, and when the journal cannot be written or read. A fibre whose positions become
/// infinite or NaN is not an error; it is recorded as lost.
pub fn run(
    study: &Study,
    journal: &Mutex<Journal>,
    computing: Computing<'_>,
    progress: &Progress,
) -> Result<(), Error> {
    let mut wanted = vec![study.replicates.at_least; study.points.len()];
    let mut open = vec![!study.replicates.until.is_empty(); study.points.len()];
    loop {
        fly_missing(study, journal, &wanted, computing, progress)?;
        let mut more = false;
        for point in 0..study.points.len() {
            if open[point] {
                let results = results_of(&mut lock(journal), point, wanted[point])?;
                let next = more_replicates(&study.replicates, &results, wanted[point]);
                open[point] = next.is_some();
                wanted[point] = next.unwrap_or(wanted[point]);
                more |= open[point];
            }
        }
        if !more {
            return Ok(());
        }
    }
}

/// Statistics of a point over all its replicates.
///
/// # Errors
/// When the journal cannot be read.
pub fn results_of_point(journal: &mut Journal, point: usize) -> Result<PointResults, Error> {
    results_of(journal, point, u64::MAX)
}

fn results_of(journal: &mut Journal, point: usize, replicates: u64) -> Result<PointResults, Error> {
    let records = journal.records(point, replicates)?;
    let measured: Vec<_> = records.iter().filter_map(|record| record.landing.measured()).collect();
    let estimates: [Estimate; MEASURES.len()] =
        std::array::from_fn(|i| Estimate::of(measured.iter().map(|values| values[i]).collect()));
    Ok(PointResults {
        n: measured.len() as u64,
        lost: (records.len() - measured.len()) as u64,
        mean: std::array::from_fn(|i| estimates[i].mean),
        errors: std::array::from_fn(|i| estimates[i].standard_error.unwrap_or(f64::NAN)),
    })
}

/// The number of replicates that a point needs instead of `flown`; `None` if these are enough.
fn more_replicates(replicates: &Replicates, results: &PointResults, flown: u64) -> Option<u64> {
    // A point that loses its fibres would lose more of them.
    if flown >= replicates.at_most || results.lost > 0 && results.n < 2 {
        return None;
    }
    let needed = |&(measure, fraction): &(usize, f64)| {
        let error = results.standard_error(measure).unwrap_or(f64::INFINITY);
        let allowed = fraction * results.mean[measure].abs();
        if error <= allowed { 0.0 } else { results.n as f64 * (error / allowed).powi(2) }
    };
    let needed = replicates.until.iter().map(needed).fold(0.0, f64::max);
    // An estimate from few fibres is rough, so the number at most doubles in a round.
    (needed > 0.0).then(|| {
        let most = flown.saturating_mul(2).min(replicates.at_most);
        (needed.ceil() as u64).clamp((flown + 1).min(most), most)
    })
}

fn fly_missing(
    study: &Study,
    journal: &Mutex<Journal>,
    wanted: &[u64],
    computing: Computing<'_>,
    progress: &Progress,
) -> Result<(), Error> {
    let batches = missing(&lock(journal), wanted);
    let lacking = Lacking::new(study, wanted, &batches, progress);
    if batches.is_empty() {
        return Ok(());
    }
    let land = |trajectories: Vec<(usize, Trajectory)>, lost: Vec<Lost>| {
        let records = records(trajectories, lost);
        lock(journal).add(&records)?;
        lacking.landed(&records, progress);
        Ok(())
    };
    with_sync(journal, |failed| {
        fly_and_land(&study.points, &batches, Keep::NUMBERS, computing, land, |()| match failed() {
            Some(error) => Err(error),
            None => Ok(()),
        })
    })?
}

/// Does `work` while another thread flushes the journal to the disk twice a second, and once more at the end.
/// `work` receives a function that returns the error of a failed flush.
fn with_sync<T>(
    journal: &Mutex<Journal>,
    work: impl FnOnce(&dyn Fn() -> Option<Error>) -> T,
) -> Result<T, Error> {
    let Some(file) = lock(journal).handle()? else {
        return Ok(work(&|| None));
    };
    let (finished, failure) = (AtomicBool::new(false), Mutex::new(None));
    let sync = || {
        if let Err(error) = file.sync_data() {
            *failure.lock().unwrap_or_else(PoisonError::into_inner) =
                Some(JournalError::Unsynced(error).into());
        }
    };
    let failed = || failure.lock().unwrap_or_else(PoisonError::into_inner).take();
    let outcome = std::thread::scope(|scope| {
        let syncing = scope.spawn(|| {
            while !finished.load(Ordering::Acquire) {
                std::thread::park_timeout(SYNC);
                sync();
            }
        });
        // The other thread must end even if `work` panics.
        let _end = OnDrop(|| {
            finished.store(true, Ordering::Release);
            syncing.thread().unpark();
        });
        work(&failed)
    });
    sync();
    match failed() {
        Some(error) => Err(error),
        None => Ok(outcome),
    }
}

struct OnDrop<F: FnMut()>(F);

impl<F: FnMut()> Drop for OnDrop<F> {
    fn drop(&mut self) {
        (self.0)();
    }
}

/// The missing replicates of every point, as ranges.
fn missing(journal: &Journal, wanted: &[u64]) -> Vec<Batch> {
    let mut batches = Vec::new();
    for (point, &wanted) in wanted.iter().enumerate() {
        let mut start = None;
        for replicate in 0..=wanted {
            let lacks = replicate < wanted && !journal.holds(point, replicate);
            match (lacks, start) {
                (true, None) => start = Some(replicate),
                (false, Some(first)) => {
                    batches.push(Batch { point, replicates: first..replicate });
                    start = None;
                }
                _ => {}
            }
        }
    }
    batches
}

/// Number of fibres that each point still lacks.
struct Lacking(Vec<AtomicU64>);

impl Lacking {
    fn new(study: &Study, wanted: &[u64], batches: &[Batch], progress: &Progress) -> Self {
        let mut lacking = vec![0; wanted.len()];
        let mut steps = 0;
        for Batch { point, replicates } in batches {
            let count = replicates.end - replicates.start;
            lacking[*point] += count;
            steps += count * study.points[*point].case.run.steps;
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

fn records(trajectories: Vec<(usize, Trajectory)>, lost: Vec<Lost>) -> Vec<Record> {
    let measured = trajectories.into_iter().map(|(point, trajectory)| Record {
        point: point as u64,
        replicate: trajectory.replicate,
        landing: Landing::Measured(measured(&trajectory)),
    });
    let lost = lost.into_iter().filter_map(|(point, replicate, error)| match error {
        Error::NotFinite { node, time, .. } => {
            let landing = Landing::Lost { node: node as u64, time };
            Some(Record { point: point as u64, replicate, landing })
        }
        _ => None,
    });
    measured.chain(lost).collect()
}

/// Locks the journal. A panic of another thread leaves it whole, because records are added one at a time.
fn lock(journal: &Mutex<Journal>) -> MutexGuard<'_, Journal> {
    journal.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replicates_grow_to_what_the_error_asks_for() {
        let replicates = Replicates { at_least: 4, at_most: 100, until: vec![(0, 0.1)] };
        let results = |n: u64, mean: f64, error: f64| PointResults {
            n,
            lost: 0,
            mean: [mean; MEASURES.len()],
            errors: [error; MEASURES.len()],
        };
        assert_eq!(more_replicates(&replicates, &results(4, 1.0, 0.1), 4), None);
        assert_eq!(more_replicates(&replicates, &results(4, -1.0, 0.1), 4), None);
        assert_eq!(more_replicates(&replicates, &results(4, 1.0, 0.12), 4), Some(6));
        assert_eq!(more_replicates(&replicates, &results(4, 1.0, 0.1000001), 4), Some(5));
        assert_eq!(more_replicates(&replicates, &results(4, 1.0, 5.0), 4), Some(8));
        assert_eq!(more_replicates(&replicates, &results(4, 0.0, 5.0), 4), Some(8));
        assert_eq!(more_replicates(&replicates, &results(80, 1.0, 5.0), 80), Some(100));
        assert_eq!(more_replicates(&replicates, &results(100, 1.0, 5.0), 100), None);
        assert_eq!(more_replicates(&replicates, &results(4, 0.0, 0.0), 4), None);
        let nothing = PointResults { n: 0, lost: 4, ..results(0, f64::NAN, f64::NAN) };
        assert_eq!(more_replicates(&replicates, &nothing, 4), None);
    }
}
