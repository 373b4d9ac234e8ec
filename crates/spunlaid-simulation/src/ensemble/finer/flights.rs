//! The flights of a check, and the paths of the free ends that are compared.

use super::plan::case_of_air;
use super::{FinerChecks, FinerPlan, FinerPlans, Unchecked};
use crate::ensemble::trajectory::fly_in_air;
use crate::ensemble::{Recorded, Recorder, Sample, Shapes, Trajectory};
use spunlaid_fibre::{Case, Job, LaidPoint, SurroundingRun};
use spunlaid_ground::threads::{lock, par_map, unlock};
use spunlaid_ground::{Error, RunContext};
use std::sync::{Mutex, MutexGuard};

/// The position across the flow at the recorded instants after the start [m].
pub(super) type Path = Vec<[f64; 2]>;

/// What one flight of a check has simulated: the numbers of its fibres, and the paths by replicate if they are
/// compared.
#[derive(Debug)]
pub(super) struct Flight {
    pub(super) trajectories: Vec<Trajectory>,
    pub(super) paths: Vec<Option<Path>>,
}

/// The paths of a run's free ends that the check of its step compares.
#[derive(Clone, Debug)]
pub struct RunPaths(pub(in crate::ensemble) Vec<Option<Path>>);

impl FinerPlans {
    /// Flies the checks of a run that has been simulated. A check that is stopped, or whose own fibres are lost,
    /// says so in its place.
    pub fn check(&self, paths: &RunPaths, computing: RunContext<'_>) -> FinerChecks {
        let flights: Vec<_> =
            self.all().flat_map(|plan| plan.flights().map(move |case| (plan, case))).collect();
        let simulated = par_map(computing.threads, flights.len(), |index| {
            let (plan, case) = flights[index];
            plan.fly(case, computing)
        });
        let mut simulated = simulated.into_iter();
        self.and_then(|plan| {
            let flights: Vec<_> = simulated.by_ref().take(plan.flights().count()).collect();
            let flights: Result<Vec<_>, Error> = flights.into_iter().collect();
            let flights = flights.map_err(|ended| match ended {
                Error::Interrupted => Unchecked::Stopped,
                lost => Unchecked::Other(format!("a fibre of the check was lost: {lost}")),
            })?;
            plan.compare(&paths.0, &flights)
        })
    }

    /// What is known if the checks are not simulated because the run was stopped.
    pub fn stopped(&self) -> FinerChecks {
        self.and_then(|_| Err(Unchecked::Stopped))
    }

    /// What is known before the checks are simulated.
    pub fn before_flight(&self) -> FinerChecks {
        self.and_then(|_| Err(Unchecked::Pending))
    }
}

impl FinerPlan {
    /// Flies one of its cases. Nothing that is recorded is kept, but for the paths that are compared.
    fn fly(&self, case: &Case, computing: RunContext<'_>) -> Result<Flight, Error> {
        let jobs: Vec<Job<'_>> = (0..self.replicates).map(|replicate| Job::new(case, replicate)).collect();
        let finest = self.finest.as_ref().unwrap_or(&self.fine);
        let air = SurroundingRun { case: case_of_air(case, finest), horizon: self.horizon, field: None };
        let paths = Paths { stride: 1, ..Paths::from_run(Some(self), None) };
        let keep = Recorded { recorder: Some(&paths), ..Recorded::NUMBERS };
        let trajectories = fly_in_air(&jobs, keep, air, computing)?;
        Ok(Flight { trajectories, paths: paths.into_paths() })
    }
}

/// Passes on what is recorded, and keeps the paths that a check compares.
#[derive(Debug)]
pub(in crate::ensemble) struct Paths<'a> {
    passed_on: Option<&'a dyn Recorder>,
    /// One recorded instant in this many is kept after the start.
    stride: u64,
    /// Largest number of instants that are kept.
    most: u64,
    /// Number of replicates whose paths are kept.
    replicates: u64,
    /// Recorded instants so far and the path, of each of the first replicates, as many as are kept.
    paths: Mutex<Vec<Option<(u64, Path)>>>,
}

impl<'a> Paths<'a> {
    /// The paths of a run that the plan of its time step needs; none where it needs none.
    pub(in crate::ensemble) fn from_run(
        plan: Option<&FinerPlan>,
        passed_on: Option<&'a dyn Recorder>,
    ) -> Self {
        let (replicates, stride, most) = match plan {
            Some(plan) if plan.coarse.is_none() => {
                (plan.replicates, plan.stride, plan.fine.run.steps / plan.fine.run.output_steps)
            }
            _ => (0, 1, 0),
        };
        Self { passed_on, stride, most, replicates, paths: Mutex::new(vec![None; replicates as usize]) }
    }

    /// Leaves out the path of a fibre that was lost.
    pub(in crate::ensemble) fn forget(&self, replicate: u64) {
        if let Some(path) = self.paths().get_mut(replicate as usize) {
            *path = None;
        }
    }

    /// The path of each of the first replicates, if its fibre was not lost.
    pub(in crate::ensemble) fn into_paths(self) -> Vec<Option<Path>> {
        unlock(self.paths).into_iter().map(|path| Some(path?.1)).collect()
    }

    fn paths(&self) -> MutexGuard<'_, Vec<Option<(u64, Path)>>> {
        lock(&self.paths)
    }
}

impl Recorder for Paths<'_> {
    fn begin(&self, replicate: u64) {
        self.forget(replicate);
        if let Some(recorder) = self.passed_on {
            recorder.begin(replicate);
        }
    }

    fn samples(&self, replicate: u64, samples: &[Sample]) -> Result<(), Error> {
        // The threads of all other fibres need not wait for one another.
        if replicate < self.replicates
            && let Some(path) = self.paths().get_mut(replicate as usize)
        {
            let (instants, path) = path.get_or_insert_default();
            for Sample { end, .. } in samples {
                if *instants > 0
                    && instants.is_multiple_of(self.stride)
                    && *instants / self.stride <= self.most
                {
                    path.push([end.y, end.z]);
                }
                *instants += 1;
            }
        }
        self.passed_on.map_or(Ok(()), |recorder| recorder.samples(replicate, samples))
    }

    fn lay(&self, replicate: u64, points: &[LaidPoint]) -> Result<(), Error> {
        self.passed_on.map_or(Ok(()), |recorder| recorder.lay(replicate, points))
    }

    fn shapes(&self, replicate: u64) -> Result<Shapes, Error> {
        self.passed_on.map_or_else(|| Ok(Shapes::default()), |recorder| recorder.shapes(replicate))
    }
}
