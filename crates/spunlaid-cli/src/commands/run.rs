//! `spunlaid run`: flies a case and writes the results.

use super::{counted, name_of};
use crate::args::{Invocation, Run};
use crate::control::run_control;
use crate::delivery::{Asides, Delivery};
use crate::failure::Failure;
use crate::settled::settled;
use crate::{progress, say};
use spunlaid::fibre::{Case, Remark};
use spunlaid::ground::FileKind;
use spunlaid::simulation::{FinerChecks, FinerPlans, RunControl, RunPaths};
use spunlaid_results::products::finished::read_summary_of_run;
use spunlaid_results::products::run::{self as files, Flights};

use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::Instant;

pub(crate) fn run(run: &Run, invocation: &Invocation) -> Result<(), Failure> {
    let (mut case, mut notes) = read(run)?;
    let (name, output) = (name_of(&run.source.case, FileKind::Case, ["case", "fibre"]), &run.output);
    let (folder, origin) = (output.optional_folder(&name), invocation.origin_of([&run.source.case]));
    let mut delivery = Delivery::open::<files::RunFolder>(folder, origin, output, &run.figures.files())?;

    let fibre_steps = AtomicU64::new(0);
    let computing = run_control(run.threads, &fibre_steps);
    let (started, plans) = (Instant::now(), FinerPlans::for_case(&case));
    let flown = fly(&case, &plans, computing, &delivery, output.quiet)?;
    let asked = case.run.replicates;
    let paused = || Failure::Paused { done: flown.replicates, total: Some(asked), what: "fibres" };
    if flown.paths.is_none() && delivery.folder().is_some_and(|folder| holds_more(folder, flown.replicates)) {
        return Err(paused());
    }
    // The results of an interrupted run are those of the fibres that have landed.
    case.run.replicates = flown.replicates;
    notes.extend(flown.paths.is_none().then(|| interrupted(flown.replicates, asked)));
    let results = flown.results;
    let performance = files::performance(&case, &results, computing, started.elapsed().as_secs_f64());
    let [lost, outside, coarse] = files::found(&case, &results);
    outside.iter().for_each(|outside| say::warning(outside));
    notes.extend([&lost, &outside, &coarse].into_iter().flatten().cloned());
    let checks = if flown.paths.is_some() { plans.before_flight() } else { plans.stopped() };
    let (case, drawn) = (Arc::new(case), OnceLock::new());
    let mut written = files::RunFolder { name, case, results, checks, notes, performance, drawn };
    if let Err(failure) = delivery.publish(&written, run.threads) {
        // What is kept goes first, since the folder above it is removed only if it is empty.
        drop(flown.kept);
        return Err(failure);
    }
    // The results are safe now, whatever becomes of the checks.
    let is_checked = plans.fibre_steps() > 0 && flown.paths.is_some();
    if is_checked {
        delivery.say_headline();
    }
    coarse.iter().filter(|_| delivery.folder().is_some()).for_each(|coarse| say::remark(false, coarse));
    if let Some(paths) = &flown.paths {
        written.checks = check(&plans, paths, computing, output.quiet);
    }
    if is_checked {
        delivery.rewrite(&written)?;
    }
    delivery.say(Asides::default());
    delivery.finish(&written);
    if flown.paths.is_none() {
        return Err(paused());
    }
    flown.kept.iter().for_each(Flights::finish);
    lost.map_or(Ok(()), |what| Err(Failure::Incomplete { what }))
}

/// The case, and the notes about it, which are told.
fn read(run: &Run) -> Result<(Case, Vec<String>), Failure> {
    let set = overrides(run);
    let (case, notes) = settled(run.threads, run.output.quiet, |resources| run.source.read(&set, resources))?;
    notes.iter().for_each(say::note);
    Ok((case, Remark::notes_of_results(&notes)))
}

/// Flies the fibres that have not been flown.
fn fly(
    case: &Case,
    plans: &FinerPlans,
    computing: RunControl<'_>,
    delivery: &Delivery<'_>,
    quiet: bool,
) -> Result<files::Flown, Failure> {
    let told = |left| {
        if !quiet {
            let all = counted(case.run.replicates, "fibre");
            say::aside(&format!("going on: {left} of {all} were flown before"));
        }
    };
    let (steps, label) =
        (case.run.steps * case.run.replicates, format!("flying {}", counted(case.run.replicates, "fibre")));
    let work = || files::fly(case, plans, computing, delivery.staging(), delivery.folder().is_some(), told);
    Ok(progress::follow(computing.fibre_steps, steps, &label, quiet, work)?)
}

/// Checks time step and mesh.
fn check(plans: &FinerPlans, paths: &RunPaths, computing: RunControl<'_>, quiet: bool) -> FinerChecks {
    computing.fibre_steps.store(0, Ordering::Relaxed);
    let (total, label) = (plans.fibre_steps(), "checking time step and mesh");
    progress::follow(computing.fibre_steps, total, label, quiet, || plans.check(paths, computing))
}

/// Whether a folder holds results of as many replicates, which those of a part of them do not replace.
fn holds_more(folder: &Path, replicates: u64) -> bool {
    read_summary_of_run(folder).is_ok_and(|held| held["replicates"].as_u64() >= Some(replicates))
}

/// A note about results of a part of the replicates.
fn interrupted(flown: u64, asked: u64) -> String {
    format!("{flown} of {asked} replicates: the run was interrupted, and the same command flies the others")
}

/// The changes to the case on the command line.
fn overrides(run: &Run) -> Vec<(&'static str, String)> {
    let numbers = [("run.replicates", run.replicates), ("run.seed", run.seed)];
    let numbers = numbers.into_iter().filter_map(|(key, value)| Some((key, value?.to_string())));
    numbers.chain(run.checks.map(|checks| ("run.checks", format!("\"{}\"", checks.name())))).collect()
}
