//! `spunlaid run`: flies a case and writes the results.

use super::finished_run::continued;
use super::{plural, run_control, say_report, staged, stem};
use crate::args::{Invocation, Output, Run};
use crate::failure::Failure;
use crate::{progress, say};
use spunlaid::case::Note;
use spunlaid::ensemble::FinerPlans;
use spunlaid_results::folders::run as files;
use spunlaid_results::output::folder::{ENTRIES, Staging};
use spunlaid_results::output::{finer, table};
use std::path::Path;
use std::sync::atomic::AtomicU64;
use std::time::Instant;

pub(crate) fn run(run: &Run, invocation: &Invocation) -> Result<(), Failure> {
    let (case, mut notes) = match run.until {
        Some(until) => continued(run, until)?,
        None => {
            let (case, notes) = run.source.read(&overrides(run))?;
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
    let (results, checks) = progress::follow(
        &fibre_steps,
        case.run.steps * case.fibres() + plans.fibre_steps(),
        &format!("flying {}", plural(case.fibres(), "fibre")),
        run.output.quiet,
        || files::fly(&case, &plans, computing, staging.as_ref()),
    )?;
    let performance = files::performance(&case, &results, &plans, computing, started.elapsed().as_secs_f64());

    let lost = files::lost(&case, &results);
    notes.extend(lost.clone());
    if let Some(outside) = files::outside(&results) {
        say::warning(&outside);
        notes.push(outside);
    }
    let coarse = files::coarse_shapes(&case, &results);
    notes.extend(coarse.clone());
    let written = files::Run {
        name: &name,
        case: &case,
        results: &results,
        checks: &checks,
        notes: &notes,
        performance,
    };
    if let Some(staging) = staging {
        written.write(&staging, computing)?;
        staging.publish()?;
        coarse.iter().for_each(|coarse| say::remark(false, coarse));
    }

    if run.json {
        say::text(&written.summary());
    } else if !run.output.quiet {
        say::text(&table::results(&results));
        say::text(&finer::text(&checks, &case, &results));
        let seconds = performance.wall_s;
        say::line(&format!(
            "\n{} in {seconds:.2} s, {:.1} ns per element and step and thread ({}, {})",
            plural(results.replicates() as u64, "fibre"),
            performance.ns_per_element_step,
            performance.instruction_set,
            plural(performance.threads as u64, "thread")
        ));
        folder.iter().for_each(say_report);
    }
    lost.map_or(Ok(()), |lost| Err(Failure::FibresLost { lost }))
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
    let own = [("run.replicates", run.replicates), ("run.seed", run.seed)];
    own.into_iter().filter_map(|(key, value)| Some((key, value?.to_string()))).collect()
}
