//! Solves the spinlines of a study.

use super::Point;
use super::batch::Batch;
use super::measures::{Record, ReplicateOutcome, measured_of_spinline};
use crate::ground::Error;
use crate::simulation::RunControl;
use crate::simulation::ensemble::in_order;
use std::sync::atomic::Ordering;

/// Solves the spinlines of some batches. One without a steady state is a lost replicate.
///
/// * `take` – receives the record of each, in their order
///
/// # Errors
/// When the computation is stopped, and every error of `take`.
pub(super) fn solve(
    points: &[Point],
    batches: &[Batch],
    computing: RunControl<'_>,
    mut take: impl FnMut(Record) -> Result<(), Error>,
) -> Result<(), Error> {
    let of_spinlines = |batch: &&Batch| points[batch.point].experiment.spinline().is_some();
    let batches: Vec<&Batch> = batches.iter().filter(of_spinlines).collect();
    in_order(
        batches.len(),
        computing.threads,
        |index| {
            let Batch { point, replicates } = batches[index];
            let stopped = computing.stop.load(Ordering::Relaxed);
            let solved = points[*point].experiment.spinline().filter(|_| !stopped).map(|spec| spec.solve());
            (*point, replicates.clone(), solved)
        },
        |(point, replicates, solved)| {
            let Some(solved) = solved else { return Err(Error::Interrupted) };
            let outcome = match &solved {
                Ok(found) => ReplicateOutcome::Measured(measured_of_spinline(found)),
                Err(_) => ReplicateOutcome::Lost { node: 0, time: 0.0 },
            };
            for replicate in replicates {
                take(Record { point: point as u64, replicate, outcome: outcome.clone() })?;
            }
            Ok(())
        },
    )
}
