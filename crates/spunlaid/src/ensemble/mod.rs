//! Ensembles: replicates packed eight to a flight, flights shared out to threads.

mod end_path;
mod finer;
mod order;
mod recorder;
mod results;
mod shapes;
mod sources;
mod trajectory;
mod turbulence;

pub use crate::flight::Job;
pub use crate::observe::Sample;
pub use end_path::{EndPath, EndPoint};
pub use finer::{
    Change, FinerCheck, FinerChecks, FinerPlan, FinerPlans, Refinement, Refinements, RunPaths, Statistic,
    Unchecked,
};
pub use order::in_order;
pub use recorder::{LaidCurves, Recorder};
pub use results::{Collector, Curve, LostFibre, Number, Place, Results};
pub use shapes::{Shape, Shapes};
pub use sources::{CellSource, Curtain, HeatSums, Sources};
pub use trajectory::{Keep, KeepShapes, Trajectory, fly_each, fly_together, pace};
pub use turbulence::{SpectrumPoint, turbulence_spectrum, velocity_record};

use crate::case::Case;
use crate::error::Error;
use crate::lanes::{Isa, WIDTH};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// How an ensemble is computed. None of it changes a bit of the results.
#[derive(Clone, Copy, Debug)]
pub struct RunControl<'a> {
    /// Number of threads.
    pub threads: usize,
    /// Instruction set.
    pub isa: Isa,
    /// Set from elsewhere to stop early.
    pub stop: &'a AtomicBool,
    /// Counts fibre steps done, for a progress display.
    pub fibre_steps: &'a AtomicU64,
    /// Takes what is recorded of the fibres. Flights of several cases take none.
    pub recorder: Option<&'a dyn Recorder>,
}

/// Computes the replicates of a case and passes on each trajectory, in the order of the replicates.
///
/// * `keep` – whether curves are measured, and which shapes are stored
/// * `take` – receives the trajectories; an error that it returns ends the ensemble
///
/// # Errors
/// A fibre is lost, another thread stops the ensemble, or `take` returns an error.
pub fn fly<E: From<Error>>(
    case: &Case,
    keep: Keep,
    computing: RunControl<'_>,
    mut take: impl FnMut(Trajectory) -> Result<(), E>,
) -> Result<(), E> {
    in_order(
        case.flights() as usize,
        computing.threads,
        |index| fly_one(case, index, keep, computing),
        |flown| flown?.into_iter().try_for_each(|trajectory| take(trajectory?)),
    )
}

/// [`fly`], where a fibre that is lost does not stop the others; `take` receives it in its turn. Returns what
/// the checks of the run compare: [`FinerPlans::check`] flies them.
///
/// * `plans` – those of the case
/// * `recall` – the trajectories of replicates that fly together, if they have been flown before; it passes
///   on what was recorded of them. [`nothing_kept`] recalls none
///
/// # Errors
/// Another thread stops the ensemble, `recall` or `take` returns an error; and with the reason of the first
/// lost fibre, if so many are lost that fewer than two are left, or none of a single one.
pub fn fly_for_checks<E: From<Error>>(
    case: &Case,
    plans: &FinerPlans,
    keep: Keep,
    computing: RunControl<'_>,
    recall: impl Fn(Range<u64>, &dyn Recorder) -> Result<Option<Vec<Trajectory>>, Error> + Sync,
    mut take: impl FnMut(Result<Trajectory, LostFibre>) -> Result<(), E>,
) -> Result<RunPaths, E> {
    let paths = finer::Paths::from_run(plans.step.as_ref().ok(), computing.recorder);
    let watched = RunControl { recorder: Some(&paths), ..computing };
    let (mut replicate, mut left, mut first_lost) = (0, 0, None);
    in_order(
        case.flights() as usize,
        computing.threads,
        |index| {
            let replicates = replicates(case, index);
            let steps = case.run.steps * (replicates.end - replicates.start);
            match recall(replicates, &paths)? {
                Some(flown) => {
                    computing.fibre_steps.fetch_add(steps, Ordering::Relaxed);
                    Ok(flown.into_iter().map(Ok).collect())
                }
                None => fly_one(case, index, keep, watched),
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

/// Recalls nothing for [`fly_for_checks`].
///
/// # Errors
/// None.
pub fn nothing_kept(_: Range<u64>, _: &dyn Recorder) -> Result<Option<Vec<Trajectory>>, Error> {
    Ok(None)
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
    keep: Keep,
    computing: RunControl<'_>,
) -> Result<Vec<Result<Trajectory, Error>>, Error> {
    let jobs: Vec<Job<'_>> = replicates(case, index).map(|replicate| Job::new(case, replicate)).collect();
    fly_each(&jobs, keep, computing)
}
