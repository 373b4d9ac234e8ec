//! `fly`: flies a case.

use crate::case::Case;
use crate::computed::{Computed, Of};
use crate::warning::{warn, warn_of};
use crate::watched::{Watch, guarded, watched};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use spunlaid::ground::threads::{lock, unlock};
use spunlaid::simulation::{FinerPlans, Unchecked};
use spunlaid_results::files::folder::{ENTRIES, Staging};
use spunlaid_results::reports::run::{FlightRecords, LandedRun, RunFolder, fly as simulated, found};
use std::path::PathBuf;
use std::sync::Mutex;
use std::time::Instant;

/// Flies a case. See spunlaid.run, which calls it.
///
/// * `place` – the folder in which the tables are written meanwhile
#[pyfunction]
#[pyo3(signature = (case, place, threads = None, progress = None, check_step = true, shapes = true))]
pub(crate) fn fly(
    py: Python<'_>,
    case: &Case,
    place: PathBuf,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
    check_step: bool,
    shapes: bool,
) -> PyResult<Computed> {
    let (case, notes, name) = case.settled(py, threads).map(|(of, notes)| (of, notes, case.stem()))?;
    let plans = if check_step { FinerPlans::for_case(&case) } else { FinerPlans::none(Unchecked::NotAsked) };
    warn_of(py, &notes)?;
    let watch = Watch::new(case.run.steps.saturating_mul(case.run.replicates));
    let (started, computing) = (Instant::now(), watch.control(threads));
    let simulated = watched(py, &watch, progress.as_ref(), || {
        let mut staging = Staging::new(&place, ENTRIES, false, &watch.stop)?;
        let simulated = simulated(&case, &plans, computing, Some(&staging), shapes, |_| ())?;
        simulated.kept.iter().for_each(FlightRecords::finish);
        staging.publish().map(|()| simulated)
    })?;
    let (is_whole, paths) = (simulated.paths.is_some(), simulated.paths);
    let landed = LandedRun { results: simulated.results, replicates: simulated.replicates, is_whole };
    let mut run = RunFolder::new(name.clone(), case, &notes, landed, &plans, started, computing);
    let [lost, outside, _] = found(&run.case, &run.results);
    lost.iter().chain(&outside).try_for_each(|text| warn(py, text))?;
    // As many shapes as memory holds may be kept, and each open file counts.
    for (number, trajectory) in run.results.trajectories.iter_mut().enumerate() {
        let kept = place.with_file_name(format!("shapes_{number}"));
        guarded(py, || trajectory.shapes.close(&kept))?;
    }
    let checks = Mutex::new(plans.before_flight());
    watch.begin(plans.fibre_steps());
    let checked = watched(py, &watch, progress.as_ref().filter(|_| plans.all().next().is_some()), || {
        paths.iter().for_each(|paths| *lock(&checks) = plans.check(paths, computing));
        Ok(())
    });
    // What was simulated is kept: a check that Ctrl-C stops says so in its place.
    checked
        .or_else(|ended| if ended.is_instance_of::<PyKeyboardInterrupt>(py) { Ok(()) } else { Err(ended) })?;
    run.checks = unlock(checks);
    Ok(Computed { name, of: Of::Run(Box::new(run)) })
}
