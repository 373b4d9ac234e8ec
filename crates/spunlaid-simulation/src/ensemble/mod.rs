//! Ensembles: replicates packed eight to a flight, flights shared out to threads.

mod finer;
mod order;
mod results;
mod shapes;
mod sources;
mod trajectory;
mod turbulence;

pub use crate::observe::Sample;
pub use finer::{
    Change, FinerCheck, FinerChecks, FinerPlan, FinerPlans, Refinement, Refinements, RunPaths, Silence,
    Statistic, Unchecked,
};
pub use order::in_order;
pub use results::{Collector, Curve, CurveValue, LostFibre, Number, Results};
pub use shapes::{Shape, Shapes};
pub use sources::{CellSource, HeatSums, LineFilaments, Sources};
pub use spunlaid_fibre::Job;
use spunlaid_fibre::{Case, LaidPoint};
use spunlaid_ground::threads::lock;
use spunlaid_ground::{Error, EvenSample, RunContext, Vec3, WIDTH};
use std::collections::{BTreeMap, VecDeque};
use std::ops::Range;
use std::sync::atomic::Ordering;
use std::sync::{Mutex, MutexGuard};
pub use trajectory::fly_each;
pub use trajectory::{KeepShapes, Recorded, Trajectory, fly_together, pace};
pub use turbulence::{SpectrumPoint, turbulence_spectrum, velocity_record};

/// Computes the replicates of a case and passes on each trajectory, in the order of the replicates.
///
/// * `keep` – whether curves are measured, and which shapes are stored
/// * `take` – receives the trajectories; an error that it returns ends the ensemble
///
/// # Errors
/// A fibre is lost, another thread stops the ensemble, or `take` returns an error.
pub fn fly<E: From<Error>>(
    case: &Case,
    keep: Recorded<'_>,
    computing: RunContext<'_>,
    mut take: impl FnMut(Trajectory) -> Result<(), E>,
) -> Result<(), E> {
    in_order(
        case.flights() as usize,
        computing.threads,
        |index| fly_one(case, index, keep, computing),
        |simulated| simulated?.into_iter().try_for_each(|trajectory| take(trajectory?)),
    )
}

/// [`fly`], where a fibre that is lost does not stop the others; `take` receives it in its turn. Returns what
/// the checks of the run compare: [`FinerPlans::check`] flies them.
///
/// * `plans` – those of the case
/// * `recall` – the trajectories of replicates that fly together, if they have been simulated before; it passes
///   on what was recorded of them
///
/// # Errors
/// Another thread stops the ensemble, `recall` or `take` returns an error; and with the reason of the first
/// lost fibre, if so many are lost that fewer than two are left, or none of a single one.
pub fn fly_for_checks<E: From<Error>>(
    case: &Case,
    plans: &FinerPlans,
    keep: Recorded<'_>,
    computing: RunContext<'_>,
    recall: impl Fn(Range<u64>, &dyn Recorder) -> Result<Option<Vec<Trajectory>>, Error> + Sync,
    mut take: impl FnMut(Result<Trajectory, LostFibre>) -> Result<(), E>,
) -> Result<RunPaths, E> {
    let paths = finer::Paths::from_run(plans.step.as_ref().ok(), keep.recorder);
    let watched = Recorded { recorder: Some(&paths), ..keep };
    let mut replicate = 0;
    let mut left = 0;
    let mut first_lost = None;
    in_order(
        case.flights() as usize,
        computing.threads,
        |index| {
            let replicates = replicates(case, index);
            let steps = case.run.steps * (replicates.end - replicates.start);
            match recall(replicates, &paths)? {
                Some(simulated) => {
                    computing.done.fetch_add(steps, Ordering::Relaxed);
                    Ok(simulated.into_iter().map(Ok).collect())
                }
                None => fly_one(case, index, watched, computing),
            }
        },
        |landed: Result<Vec<_>, Error>| {
            for landed in landed? {
                match landed {
                    Ok(trajectory) => {
                        left += 1;
                        take(Ok(trajectory))?;
                    }
                    Err(error) => {
                        paths.forget(replicate);
                        take(Err(LostFibre::new(replicate, &error)))?;
                        first_lost.get_or_insert(error);
                    }
                }
                replicate += 1;
            }
            Ok::<(), E>(())
        },
    )?;
    if let Some(error) = first_lost.filter(|_| left < case.run.replicates.min(2)) {
        return Err(error.into());
    }
    Ok(RunPaths(paths.into_paths()))
}

/// The replicates of a piece of work of a case.
fn replicates(case: &Case, index: usize) -> Range<u64> {
    let first = index as u64 * WIDTH as u64;
    first..case.run.replicates.min(first + WIDTH as u64)
}

/// Computes one piece of work of a case: for each replicate its trajectory, or the reason why its fibre is lost.
fn fly_one(
    case: &Case,
    index: usize,
    keep: Recorded<'_>,
    computing: RunContext<'_>,
) -> Result<Vec<Result<Trajectory, Error>>, Error> {
    let jobs: Vec<Job<'_>> = replicates(case, index).map(|replicate| Job::new(case, replicate)).collect();
    fly_each(&jobs, keep, computing)
}

/// Takes what is recorded of the fibres of a case, some instants at a time.
///
/// Flights on several threads call it at the same time; the calls for one fibre come in the order of time.
pub trait Recorder: std::fmt::Debug + Sync {
    /// A fibre begins to fly. What was recorded of it before has to be forgotten: it flew beside a fibre that
    /// was lost, and flies again without it.
    fn begin(&self, replicate: u64);

    /// Receives the next recorded instants of a fibre, the start included.
    ///
    /// # Errors
    /// An error ends the flight.
    fn samples(&self, replicate: u64, samples: &[Sample]) -> Result<(), Error>;

    /// Receives the next points that a fed fibre has laid on the belt, in the order in which they were fed.
    ///
    /// # Errors
    /// An error ends the flight.
    fn lay(&self, replicate: u64, points: &[LaidPoint]) -> Result<(), Error>;

    /// Says where the shapes of a fibre are kept that begins to fly: in memory, or in a file.
    ///
    /// # Errors
    /// There is no such file.
    fn shapes(&self, replicate: u64) -> Result<Shapes, Error> {
        let _ = replicate;
        Ok(Shapes::default())
    }
}

/// Keeps in memory what the fed fibres of a case lay, for those who want it there.
#[derive(Debug, Default)]
pub struct LaidCurves(Mutex<BTreeMap<u64, Vec<LaidPoint>>>);

impl LaidCurves {
    /// Hands over the points of a replicate, in the order of feed; none if it has laid nothing.
    pub fn take(&self, replicate: u64) -> Vec<LaidPoint> {
        self.curves().remove(&replicate).unwrap_or_default()
    }

    fn curves(&self) -> MutexGuard<'_, BTreeMap<u64, Vec<LaidPoint>>> {
        lock(&self.0)
    }
}

impl Recorder for LaidCurves {
    fn begin(&self, replicate: u64) {
        self.curves().remove(&replicate);
    }

    fn samples(&self, _: u64, _: &[Sample]) -> Result<(), Error> {
        Ok(())
    }

    fn lay(&self, replicate: u64, points: &[LaidPoint]) -> Result<(), Error> {
        self.curves().entry(replicate).or_default().extend_from_slice(points);
        Ok(())
    }
}

/// Time [s] and place of the free end [m].
pub type EndPoint = (f64, Vec3<f64>);

/// The free end at all of the last recorded instants, and at evenly spaced ones of the whole flight.
#[derive(Clone, Debug, Default)]
pub struct EndPath {
    last: VecDeque<EndPoint>,
    whole: EvenSample<EndPoint>,
}

impl EndPath {
    /// Number of the last instants that are all kept.
    pub(crate) const LAST: usize = 20_000;

    /// Takes the next recorded instant.
    pub fn push(&mut self, sample: &Sample) {
        let point = (sample.time, sample.end);
        if self.last.len() == Self::LAST {
            self.last.pop_front();
        }
        self.last.push_back(point);
        self.whole.push(point);
    }

    /// All of the last recorded instants, `EndPath::LAST` at most.
    pub fn last(&self) -> impl Iterator<Item = &EndPoint> {
        self.last.iter()
    }

    /// The free end from a time [s] on: every recorded instant, or evenly spaced ones where not all are kept.
    pub fn since(&self, time: f64) -> impl Iterator<Item = &EndPoint> {
        let first = |points: Option<&EndPoint>| points.map_or(f64::INFINITY, |point| point.0);
        let all = first(self.last.front()) <= time.max(first(self.whole.values().first()));
        let last = all.then_some(&self.last);
        let whole = (!all).then_some(self.whole.values());
        let points = last.into_iter().flatten().chain(whole.into_iter().flatten());
        points.filter(move |point| point.0 >= time)
    }
}

impl<'a> FromIterator<&'a Sample> for EndPath {
    fn from_iter<I: IntoIterator<Item = &'a Sample>>(samples: I) -> Self {
        let mut path = Self::default();
        samples.into_iter().for_each(|sample| path.push(sample));
        path
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_whole_as_long_as_it_can_be() {
        let sample = |i: usize| Sample { time: i as f64, ..Sample::default() };
        let path = |count: usize| (0..count).map(sample).collect::<Vec<_>>().iter().collect::<EndPath>();
        let times = |path: &EndPath, from: f64| path.since(from).map(|point| point.0).collect::<Vec<_>>();
        let all = |from: usize, to: usize, every: usize| {
            (from..to).step_by(every).map(|i| i as f64).collect::<Vec<f64>>()
        };
        let short = path(EndPath::LAST);
        assert_eq!(times(&short, 0.0), all(0, EndPath::LAST, 1));
        assert_eq!(times(&short, 7.5), all(8, EndPath::LAST, 1));
        let long = path(50_000);
        assert_eq!(times(&long, 0.0), all(0, 50_000, 4));
        assert_eq!(times(&long, 29_999.0), all(30_000, 50_000, 4));
        assert_eq!(times(&long, 30_000.0), all(30_000, 50_000, 1));
        assert!(times(&path(0), 0.0).is_empty());
    }
}
