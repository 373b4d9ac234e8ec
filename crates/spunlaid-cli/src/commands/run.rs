//! `spunlaid run`: flies a case and writes the results.

use super::{counted, name_of};
use crate::args::{Invocation, Run};
use crate::control::{control, settled};
use crate::delivery::{Delivery, aside};
use crate::failure::Failure;
use crate::{progress, say};
use spunlaid::ground::FileKind;
use spunlaid::simulation::FinerPlans;
use spunlaid_results::reports::finished::read_summary_of_run;
use spunlaid_results::reports::run::{FlightRecords, LandedRun, RunFolder, SimulatedRun, fly, found};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

pub(crate) fn run(run: &Run, invocation: &Invocation) -> Result<(), Failure> {
    let (quiet, set) = (run.output.quiet, run.changes());
    let (case, notes) = settled(run.threads, quiet, |resources| run.source.read(&set, resources))?;
    notes.iter().for_each(say::note);
    let name = name_of(&run.source.case, FileKind::Case, ["case", "fibre"]);
    let files = [&run.source.case];
    let figures = run.figures.files();
    let mut delivery = Delivery::open::<RunFolder>(invocation, files, &name, &run.output, figures)?;

    let fibre_steps = AtomicU64::new(0);
    let by = control(run.threads, &fibre_steps);
    let started = Instant::now();
    let plans = FinerPlans::for_case(&case);
    let asked = case.run.replicates;
    let fibres = counted(asked, "fibre");
    let before = |left| aside(&run.output, &format!("going on: {left} of {fibres} were simulated before"));
    let work = || fly(&case, &plans, by, delivery.staging(), delivery.folder().is_some(), before);
    let (steps, label) = (case.run.steps * asked, format!("simulating {fibres}"));
    let simulated = progress::follow(&fibre_steps, steps, &label, quiet, work)?;
    let SimulatedRun { results, paths, replicates, kept } = simulated;
    let paused = || Failure::Paused { done: replicates, total: Some(asked), noun: "fibre" };
    // Results of as many replicates are not replaced by those of a part of them.
    let holds_more = |folder| {
        read_summary_of_run(folder).is_ok_and(|held| held["replicates"].as_u64() >= Some(replicates))
    };
    if paths.is_none() && delivery.folder().is_some_and(holds_more) {
        return Err(paused());
    }
    let landed = LandedRun { results, replicates, is_whole: paths.is_some() };
    let mut written = RunFolder::new(name, Arc::new(case), &notes, landed, &plans, started, by);
    let [lost, outside, coarse] = found(&written.case, &written.results);
    outside.iter().for_each(|outside| say::warning(outside));
    delivery.publish(&written, run.threads)?;
    // The results are safe now, whatever becomes of the checks.
    let checked = paths.as_ref().filter(|_| plans.fibre_steps() > 0);
    coarse.iter().filter(|_| delivery.folder().is_some()).for_each(|coarse| say::remark(false, coarse));
    if let Some(paths) = checked {
        fibre_steps.store(0, Ordering::Relaxed);
        let (total, label) = (plans.fibre_steps(), "checking time step and mesh");
        written.checks = progress::follow(&fibre_steps, total, label, quiet, || plans.check(paths, by));
        delivery.rewrite(&written)?;
    }
    delivery.finish(&written, &[]);
    if paths.is_none() {
        return Err(paused());
    }
    kept.iter().for_each(FlightRecords::finish);
    lost.map_or(Ok(()), |what| Err(Failure::Incomplete { what }))
}
