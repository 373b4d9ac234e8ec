//! Ensembles: replicates packed eight to a flight, flights shared out to threads.

mod finer;
mod order;
mod results;
mod trajectory;
mod turbulence;

pub use crate::flight::Job;
pub use crate::observe::Sample;
pub use finer::{Change, FinerCheck, FinerChecks, FinerPlan, FinerPlans, Refined, Statistic};
pub use order::in_order;
pub use results::{Collector, Curve, Number, Place, Results};
pub use trajectory::{Keep, KeepShapes, Shape, Trajectory, fly_together, pace};
pub use turbulence::{SpectrumPoint, turbulence_spectrum, velocity_record};

use crate::case::Case;
use crate::error::Error;
use crate::flight::LaidPoint;
use crate::lanes::{Isa, WIDTH};
use std::collections::BTreeMap;
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
        |index| fly_one(case, index, keep, computing),
        |flown| flown?.into_iter().try_for_each(&mut take),
    )
}

/// [`fly`], and computes what finer steps and finer elements change. The checks are some more flights beside the others;
/// `plans` are those of the case.
///
/// # Errors
/// Those of [`fly`]. A check whose own fibres are lost says so in its place.
pub fn fly_and_check<E: From<Error>>(
    case: &Case,
    plans: &FinerPlans,
    keep: Keep,
    computing: Computing<'_>,
    mut take: impl FnMut(Trajectory) -> Result<(), E>,
) -> Result<FinerChecks, E> {
    let flights = flights(case);
    let more: Vec<_> = plans.all().flat_map(|plan| plan.flights().map(move |which| (plan, which))).collect();
    let (mut paths, mut flown) = (Vec::new(), BTreeMap::new());
    let mut index = 0;
    in_order(
        flights + more.len(),
        computing.threads,
        |index| match index.checked_sub(flights).and_then(|index| more.get(index)) {
            Some((plan, which)) => plan.fly(*which, computing),
            None => fly_one(case, index, keep, computing).map(finer::Flight::of_run),
        },
        |landed| {
            if index >= flights {
                // A run is not lost with a check of it.
                if matches!(landed, Err(Error::Interrupted)) {
                    landed?;
                } else {
                    flown.insert(index - flights, landed);
                }
            } else {
                for trajectory in landed?.into_trajectories() {
                    paths.extend(
                        plans.step.iter().map(|plan| plan.path(&trajectory)).filter(|p| !p.is_empty()),
                    );
                    take(trajectory)?;
                }
            }
            index += 1;
            Ok::<(), E>(())
        },
    )?;
    let mut flown = more.iter().map(|(plan, which)| (plan.refined, *which)).zip(flown.into_values());
    let mut compare = |plan: &Result<FinerPlan, String>| {
        let plan = plan.as_ref().map_err(String::clone)?;
        let mut pair = [finer::Flight::default(), finer::Flight::default()];
        for which in plan.flights() {
            let landed = flown.next().map_or_else(|| Ok(finer::Flight::default()), |(_, landed)| landed);
            pair[usize::from(which == finer::Flown::Fine)] =
                landed.map_err(|lost| format!("a fibre of the check was lost: {lost}"))?;
        }
        plan.compare(&paths, &pair[0], &pair[1])
    };
    Ok(FinerChecks { step: compare(&plans.step), mesh: compare(&plans.mesh) })
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
    computing: Computing<'_>,
) -> Result<Vec<Trajectory>, Error> {
    let first = index as u64 * WIDTH as u64;
    let last = case.run.replicates.min(first + WIDTH as u64);
    let jobs: Vec<Job<'_>> = (first..last).map(|replicate| Job { case, replicate }).collect();
    fly_together(&jobs, keep, computing)
}
