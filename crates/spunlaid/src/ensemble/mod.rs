//! Ensembles: replicates packed eight to a flight, flights shared out to threads.

mod order;
mod results;
mod trajectory;
mod turbulence;

pub use crate::flight::Job;
pub use crate::observe::Sample;
pub use order::in_order;
pub use results::{Collector, Curve, Number, Place, Results};
pub use trajectory::{Keep, KeepShapes, Shape, Trajectory, fly_together, pace};
pub use turbulence::{SpectrumPoint, turbulence_spectrum, velocity_record};

use crate::case::Case;
use crate::error::Error;
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
}

/// Flies the replicates of a case and hands each trajectory over, in the order of the replicates.
///
/// * `keep` – whether curves are measured, and which fibres are kept whole over time
/// * `take` – receives the trajectories; an error it returns ends the ensemble
///
/// # Errors
/// A fibre that stops being finite, a stop from elsewhere, and what `take` returns.
pub fn fly<E: From<Error>>(
    case: &Case,
    keep: Keep,
    computing: Computing<'_>,
    mut take: impl FnMut(Trajectory) -> Result<(), E>,
) -> Result<(), E> {
    let flights = case.run.replicates.div_ceil(WIDTH as u64);
    in_order(
        flights as usize,
        computing.threads,
        |flight| {
            let first = flight as u64 * WIDTH as u64;
            let last = case.run.replicates.min(first + WIDTH as u64);
            let jobs: Vec<Job<'_>> = (first..last).map(|replicate| Job { case, replicate }).collect();
            fly_together(&jobs, keep, computing)
        },
        |trajectories| trajectories?.into_iter().try_for_each(&mut take),
    )
}
