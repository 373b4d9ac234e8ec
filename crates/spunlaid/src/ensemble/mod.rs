//! Ensembles: replicates packed eight to a flight, flights shared out to threads.

mod companions;
mod end_path;
mod finer;
mod order;
mod recorder;
mod results;
mod shapes;
mod trajectory;
mod turbulence;

pub use crate::flight::Job;
pub use crate::observe::Sample;
pub use end_path::{EndPath, EndPoint};
pub use finer::{Change, FinerCheck, FinerChecks, FinerPlan, FinerPlans, Refinement, Refinements, Statistic};
pub use order::in_order;
pub use recorder::{LaidCurves, Recorder};
pub use results::{Collector, Curve, LostFibre, Number, Place, Results};
pub use shapes::{Shape, Shapes};
pub use trajectory::{Keep, KeepShapes, Trajectory, fly_each, fly_together, pace};
pub use turbulence::{SpectrumPoint, turbulence_spectrum, velocity_record};

use crate::case::Case;
use crate::error::Error;
use crate::lanes::{Isa, WIDTH};
use std::sync::atomic::{AtomicBool, AtomicU64};

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
        pieces(case, keep),
        computing.threads,
        |index| fly_one(case, index, keep, computing),
        |flown| flown?.into_iter().try_for_each(|trajectory| take(trajectory?)),
    )
}

/// [`fly`], and computes what finer steps and finer elements change. The checks are some more flights beside the others;
/// `plans` are those of the case.
///
/// A fibre that is lost does not stop the others; `take` receives it in its turn.
///
/// # Errors
/// Another thread stops the ensemble, or `take` returns an error; and with the reason of the first lost fibre, if so many
/// are lost that fewer than two are left, or none of a single one. A check whose own fibres are lost says so in its place.
pub fn fly_and_check<E: From<Error>>(
    case: &Case,
    plans: &FinerPlans,
    keep: Keep,
    computing: RunControl<'_>,
    mut take: impl FnMut(Result<Trajectory, LostFibre>) -> Result<(), E>,
) -> Result<FinerChecks, E> {
    enum FlightResult {
        Run(Result<Vec<Result<Trajectory, Error>>, Error>),
        Check(Result<finer::Flight, Error>),
    }
    let pieces = pieces(case, keep);
    let more: Vec<_> = plans.all().flat_map(|plan| plan.flights().map(move |case| (plan, case))).collect();
    let paths = finer::Paths::from_run(plans.step.as_ref(), computing.recorder);
    let watched = RunControl { recorder: Some(&paths), ..computing };
    let (mut flown, mut replicate, mut left, mut first_lost) = (Vec::new(), 0, 0, None);
    in_order(
        pieces + more.len(),
        computing.threads,
        |index| match index.checked_sub(pieces).and_then(|index| more.get(index)) {
            Some((plan, case)) => FlightResult::Check(plan.fly(case, computing)),
            None => FlightResult::Run(fly_one(case, index, keep, watched)),
        },
        |landed| {
            match landed {
                // A run is not lost with a check of it.
                FlightResult::Check(Err(Error::Interrupted)) => return Err(Error::Interrupted.into()),
                FlightResult::Check(check) => flown.push(check),
                FlightResult::Run(landed) => {
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
                }
            }
            Ok::<(), E>(())
        },
    )?;
    if let Some(error) = first_lost.filter(|_| left < case.run.replicates.min(2)) {
        return Err(error.into());
    }
    let (paths, mut flown) = (paths.into_paths(), flown.into_iter());
    Ok(plans.and_then(|plan| {
        let flights: Vec<_> = flown.by_ref().take(plan.flights().count()).collect();
        let flights: Result<Vec<_>, Error> = flights.into_iter().collect();
        plan.compare(&paths, &flights.map_err(|lost| format!("a fibre of the check was lost: {lost}"))?)
    }))
}

/// Number of pieces of work of a case: flights of eight replicates, or replicates with their companions.
fn pieces(case: &Case, keep: Keep) -> usize {
    if has_companions(case, keep) {
        case.run.replicates as usize
    } else {
        case.run.replicates.div_ceil(WIDTH as u64) as usize
    }
}

/// Whether companions fly beside the replicates. What is measured of them are curves.
fn has_companions(case: &Case, keep: Keep) -> bool {
    keep.curves && !case.neighbours.is_empty()
}

/// Computes one piece of work of a case: for each replicate its trajectory, or the reason why its fibre is lost.
fn fly_one(
    case: &Case,
    index: usize,
    keep: Keep,
    computing: RunControl<'_>,
) -> Result<Vec<Result<Trajectory, Error>>, Error> {
    if has_companions(case, keep) {
        return Ok(vec![companions::fly_beside(case, index as u64, keep, computing)?]);
    }
    let first = index as u64 * WIDTH as u64;
    let last = case.run.replicates.min(first + WIDTH as u64);
    let jobs: Vec<Job<'_>> = (first..last).map(|replicate| Job::new(case, replicate)).collect();
    fly_each(&jobs, keep, computing)
}
