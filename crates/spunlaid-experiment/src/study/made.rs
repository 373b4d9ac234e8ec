//! Makes the replicates of a study that are not flights: lays its webs, one after another, and solves its spinlines.

use super::batch::Batch;
use super::measures::{Record, ReplicateOutcome, measured_of_spinline, measured_of_web};
use super::{Point, seed_of_point};
use spunlaid_ground::{Error, RunContext};
use spunlaid_simulation::ensemble::in_order;
use spunlaid_simulation::{Flights, Flyer, WebSpec};
use std::sync::atomic::{AtomicU64, Ordering};

/// Lays the webs of some batches. The fibres of a point are simulated once for all its webs, unless all filaments
/// of a web fly in shared turbulence.
///
/// * `sides` – of the patches of the study [m]
/// * `steps` – the number of steps and pieces to do becomes larger by those of each case and each web
/// * `take` – receives the record of each web, in their order
///
/// # Errors
/// If fibres cannot be simulated or read, if a web cannot be laid, and every error of `take`.
pub(super) fn lay_webs(
    points: &[Point],
    sides: &[f64],
    batches: &[Batch],
    computing: RunContext<'_>,
    steps: &AtomicU64,
    mut take: impl FnMut(Record) -> Result<(), Error>,
) -> Result<(), Error> {
    let follow = |Flights { done, steps: all, .. }: Flights<'_>, work: &mut (dyn FnMut() + Send)| {
        steps.fetch_add(all, Ordering::Relaxed);
        work();
        computing.done.fetch_add(done.load(Ordering::Relaxed), Ordering::Relaxed);
    };
    let flyer = Flyer::new(computing.threads, computing.stop, &follow);
    for Batch { point, replicates } in batches {
        let Some(spec) = points[*point].experiment.web() else { continue };
        for replicate in replicates.clone() {
            let seed = seed_of_web(spec, replicate);
            let spec = WebSpec { seed, ..spec.clone() };
            let mut simulated = flyer.web(&spec)?;
            steps.fetch_add(simulated.pieces()?, Ordering::Relaxed);
            let found = simulated.find(computing)?;
            let fabric = spec.fabric(&simulated.web, &found, computing.threads);
            let outcome = ReplicateOutcome::Measured(measured_of_web(sides, &found, &fabric));
            take(Record { point: *point as u64, replicate, outcome })?;
        }
    }
    Ok(())
}

/// The seed of a web of a point, or of a trial. The same webs lie at each, as far as the keys allow: what differs is
/// then less by chance.
pub(crate) fn seed_of_web(spec: &WebSpec, replicate: u64) -> u64 {
    if replicate == 0 { spec.seed } else { seed_of_point(spec.seed, replicate) }
}

/// Solves the spinlines of some batches. One without a steady state is a lost replicate.
///
/// * `take` – receives the record of each, in their order
///
/// # Errors
/// When the computation is stopped, and every error of `take`.
pub(super) fn solve_spinlines(
    points: &[Point],
    batches: &[Batch],
    computing: RunContext<'_>,
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
