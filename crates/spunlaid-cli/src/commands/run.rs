//! `spunlaid run`: flies a case and writes the results.

use super::finished_run::continued;
use super::flown::flown;
use super::{plural, run_control, say_report, staged, stem};
use crate::args::{Invocation, Output, Run};
use crate::failure::Failure;
use crate::{progress, say};
use spunlaid::case::Note;
use spunlaid::ensemble::FinerPlans;
use spunlaid_results::folders::read_summary_of_run;
use spunlaid_results::folders::run as files;
use spunlaid_results::output::folder::{ENTRIES, Staging};
use spunlaid_results::output::{finer, table};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

pub(crate) fn run(run: &Run, invocation: &Invocation) -> Result<(), Failure> {
    let (mut case, mut notes) = match run.until {
        Some(until) => continued(run, &overrides(run), until)?,
        None => {
            let read = run.source.read(&overrides(run));
            let (case, notes) = flown(read, run.threads, run.output.quiet)?;
            notes.iter().for_each(say::note);
            (case, Note::notes_of_results(&notes))
        }
    };
    let name = name(run);
    let folder = match run.until {
        Some(_) if run.output.out.is_none() => Some(run.source.case.clone()),
        _ => run.output.optional_folder(run.json, &name),
    };
    let staging = folder.as_ref().map(|folder| staging(run, invocation, folder)).transpose()?;

    let fibre_steps = AtomicU64::new(0);
    let computing = run_control(run.threads, &fibre_steps);
    let started = Instant::now();
    let plans = FinerPlans::for_case(&case);
    let told = |left| {
        if !run.output.quiet {
            say::aside(&format!(
                "going on: {left} of {} were flown before",
                plural(case.run.replicates, "fibre")
            ));
        }
    };
    let mut flown = progress::follow(
        &fibre_steps,
        case.run.steps * case.fibres(),
        &format!("flying {}", plural(case.fibres(), "fibre")),
        run.output.quiet,
        || files::fly(&case, &plans, computing, staging.as_ref(), told),
    )?;
    let asked = case.run.replicates;
    let paused = || Failure::Paused { done: flown.replicates, total: Some(asked), what: "fibres" };
    if flown.paths.is_none() && folder.as_ref().is_some_and(|folder| holds_more(folder, flown.replicates)) {
        return Err(paused());
    }
    // The results of an interrupted run are those of the fibres that have landed.
    case.run.replicates = flown.replicates;
    notes.extend(flown.paths.is_none().then(|| interrupted(flown.replicates, asked)));
    let results = &flown.results;
    let performance = files::performance(&case, results, computing, started.elapsed().as_secs_f64());

    let lost = files::lost(&case, results);
    notes.extend(lost.clone());
    if let Some(outside) = files::outside(results) {
        say::warning(&outside);
        notes.push(outside);
    }
    let coarse = files::coarse_shapes(&case, results);
    notes.extend(coarse.clone());
    let before = match flown.paths {
        Some(_) => plans.before_flight(),
        None => plans.stopped(),
    };
    let first = files::Run { name: &name, case: &case, results, checks: &before, notes: &notes, performance };
    let drawn = match staging.as_ref().map(|staging| first.write(staging, computing)).transpose() {
        Ok(drawn) => drawn,
        Err(failure) => {
            // What is kept goes first, since the folder above it is removed only if it is empty.
            drop(flown);
            return Err(failure.into());
        }
    };
    let published = staging
        .zip(drawn)
        .map(|(staging, drawn)| Ok::<_, spunlaid_results::Failure>((staging.publish_first()?, drawn)));
    let published = published.transpose()?;
    coarse.iter().filter(|_| published.is_some()).for_each(|coarse| say::remark(false, coarse));

    // The results are safe now, whatever becomes of the checks.
    fibre_steps.store(0, Ordering::Relaxed);
    let (total, label) = (plans.fibre_steps(), "checking time step and mesh");
    let checked = flown.paths.as_ref().map(|paths| {
        progress::follow(&fibre_steps, total, label, run.output.quiet, || plans.check(paths, computing))
    });
    let written = files::Run { checks: checked.as_ref().unwrap_or(&before), ..first };
    if let Some((folder, drawn)) = published.as_ref().filter(|_| total > 0 && checked.is_some()) {
        written.write_checks(folder, drawn)?;
    }

    if run.json {
        say::text(&written.summary());
    } else if !run.output.quiet {
        show(&written);
        folder.iter().for_each(say_report);
    }
    if checked.is_none() {
        return Err(paused());
    }
    flown.forget_kept();
    lost.map_or(Ok(()), |lost| Err(Failure::FibresLost { lost }))
}

/// Whether a folder holds results of as many replicates, which those of a part of them do not replace.
fn holds_more(folder: &Path, replicates: u64) -> bool {
    read_summary_of_run(folder).is_ok_and(|held| held["replicates"].as_u64() >= Some(replicates))
}

/// A note about results of a part of the replicates.
fn interrupted(flown: u64, asked: u64) -> String {
    format!("{flown} of {asked} replicates: the run was interrupted, and the same command flies the others")
}

/// Prints the results.
fn show(run: &files::Run<'_>) {
    let files::Run { case, results, checks, performance, .. } = *run;
    say::table(&table::results(results));
    say::table(&finer::text(checks, case, results));
    let seconds = performance.wall_s;
    say::line(&format!(
        "\n{} in {seconds:.2} s, {:.1} ns per element and step and thread ({}, {})",
        plural(results.replicates() as u64, "fibre"),
        performance.ns_per_element_step,
        performance.instruction_set,
        plural(performance.threads as u64, "thread")
    ));
}

/// Collects the results. A continued run replaces its own ones. It took longer, so that the run from which it began does not replace
/// it.
fn staging(run: &Run, invocation: &Invocation, folder: &Path) -> Result<Staging<'static>, Failure> {
    let is_continued = run.until.is_some();
    let origin = (!is_continued).then(|| invocation.origin(&[&run.source.case], folder)).flatten();
    let force = run.output.force || is_continued && run.output.out.is_none();
    staged((folder, ENTRIES), &Output { force, ..run.output.clone() }, origin, &run.figures.files())
}

/// What the results are called: as the case file, or as the folder of a run that is continued.
fn name(run: &Run) -> String {
    let case = &run.source.case;
    let folder = run.until.and_then(|_| Some(case.canonicalize().ok()?.file_name()?.to_owned()));
    folder.as_deref().unwrap_or_else(|| stem(case, "case")).to_string_lossy().into_owned()
}

/// The changes to the case on the command line.
fn overrides(run: &Run) -> Vec<(&'static str, String)> {
    let numbers = [("run.replicates", run.replicates), ("run.seed", run.seed)];
    let numbers = numbers.into_iter().filter_map(|(key, value)| Some((key, value?.to_string())));
    numbers.chain(run.checks.map(|checks| ("run.checks", format!("\"{}\"", checks.name())))).collect()
}
