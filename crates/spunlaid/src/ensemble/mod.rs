//! Ensembles: replicates packed eight to a flight, flights shared out to threads.

mod order;
mod results;
mod step_check;
mod trajectory;
mod turbulence;

pub use crate::flight::Job;
pub use crate::observe::Sample;
pub use order::in_order;
pub use results::{Collector, Curve, Number, Place, Results};
pub use step_check::{StepCheck, StepCheckPlan};
use trajectory::fly_with_plan;
pub use trajectory::{Keep, KeepShapes, Shape, Trajectory, fly_together, pace};
pub use turbulence::{SpectrumPoint, turbulence_spectrum, velocity_record};

use crate::case::Case;
use crate::error::Error;
use crate::flight::LaidPoint;
use crate::lanes::{Isa, WIDTH};
use std::sync::atomic::{AtomicBool, AtomicU64};

/// How an ensemble is computed. None of it changes a bit of the results.
#[derive(Clone, Copy, Debug)]
pub struct Computing<'a> {
    /// Number of threads.
    pub threads: usize,
    /// Instruction set.
    pub isa: Isa,
    /// Set from elsewhere to stop early.
    pub stop: &'a AtomicBool,
    /// Counts fibre steps done, for a progress display.
    pub fibre_steps: &'a AtomicU64,
    /// Takes what fed fibres lay.
    pub laid: Option<&'a dyn TakeLaid>,
}

/// Takes what fed fibres lay on the belt while they fly, so that no run has to keep it in memory.
pub trait TakeLaid: std::fmt::Debug + Sync {
    /// Receives the next points of a replicate, in the order in which they were fed. Flights of other replicates may call
    /// it at the same time.
    ///
    /// # Errors
    /// An error ends the flight.
    fn take(&self, replicate: u64, points: &[LaidPoint]) -> Result<(), Error>;
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
    computing: Computing<'_>,
    mut take: impl FnMut(Trajectory) -> Result<(), E>,
) -> Result<(), E> {
    in_order(
        flights(case),
        computing.threads,
        |index| fly_one(case, index, keep, None, computing),
        |flown| flown?.0.into_iter().try_for_each(&mut take),
    )
}

/// [`fly`], and computes what half the time step changes. The check is one more flight beside the others; `plan` is
/// that of the case.
///
/// Returns `None` without a plan, and if the fibres do not move across the flow or lay nothing down.
///
/// # Errors
/// Those of [`fly`].
pub fn fly_and_check_step<E: From<Error>>(
    case: &Case,
    plan: Option<StepCheckPlan>,
    keep: Keep,
    computing: Computing<'_>,
    mut take: impl FnMut(Trajectory) -> Result<(), E>,
) -> Result<Option<StepCheck>, E> {
    enum Landed {
        Flight(Vec<Trajectory>, Vec<step_check::Path>),
        HalfStep(Vec<step_check::Path>),
    }
    let flights = flights(case);
    let (mut own, mut half) = (Vec::new(), Vec::new());
    in_order(
        flights + usize::from(plan.is_some()),
        computing.threads,
        |index| match plan {
            Some(plan) if index == flights => plan.fly(case, computing).map(Landed::HalfStep),
            _ => {
                let flown = fly_one(case, index, keep, plan, computing);
                flown.map(|(trajectories, paths)| Landed::Flight(trajectories, paths))
            }
        },
        |landed| {
            match landed? {
                Landed::HalfStep(paths) => half = paths,
                Landed::Flight(trajectories, paths) => {
                    own.extend(paths);
                    trajectories.into_iter().try_for_each(&mut take)?;
                }
            }
            Ok::<(), E>(())
        },
    )?;
    Ok(plan.and_then(|plan| plan.compare(case, &own, &half)))
}

/// Number of flights of a case.
fn flights(case: &Case) -> usize {
    case.run.replicates.div_ceil(WIDTH as u64) as usize
}

/// Computes one flight of a case.
fn fly_one(
    case: &Case,
    index: usize,
    keep: Keep,
    plan: Option<StepCheckPlan>,
    computing: Computing<'_>,
) -> Result<(Vec<Trajectory>, Vec<step_check::Path>), Error> {
    let first = index as u64 * WIDTH as u64;
    let last = case.run.replicates.min(first + WIDTH as u64);
    let jobs: Vec<Job<'_>> = (first..last).map(|replicate| Job { case, replicate }).collect();
    fly_with_plan(&jobs, keep, plan, computing)
}
