//! `spunlaid sweep`: flies a study and writes its results.

use super::{counted, stem};
use crate::args::{Invocation, Sweep, overrides};
use crate::control::{run_control, stop_on_ctrl_c};
use crate::delivery::{Asides, making, say_continued, say_replaced, tell};
use crate::failure::Failure;
use crate::settled::settled;
use crate::{progress, say};
use spunlaid::experiment::study::run;
use spunlaid::experiment::{Journal, JournalState, Progress, Study};
use spunlaid::ground::threads::{lock, unlock};
use spunlaid::ground::{Error, Fault};
use spunlaid::input::{Resources, StudyChanges, StudyFile, read_study, write_experiment};
use spunlaid_results::folders::JournalFolder;
use spunlaid_results::products::study;
use spunlaid_results::products::study::lost;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

pub(crate) fn sweep(sweep: &Sweep, invocation: &Invocation) -> Result<(), Failure> {
    let (points, replicates) = (sweep.points, sweep.replicates);
    let read = |resources: &Resources| {
        let set = overrides(&sweep.set).with(resources);
        read_study(&sweep.study, StudyChanges { points, replicates, set })
    };
    if let Some(number) = sweep.print_point {
        return print_point(&read(&Resources::default())?.study, number);
    }
    let path = sweep.output.folder(stem(&sweep.study, "study"));
    let file = settled(sweep.threads, sweep.output.quiet, read)?;
    file.notes.iter().for_each(say::study_note);
    let origin = invocation.origin_of([&sweep.study])(&path);
    let (mut folder, journal, found) =
        study::open(&path, &file, sweep.output.force, origin.as_ref(), stop_on_ctrl_c())?;
    if folder.replaces() {
        say_replaced(&path, &sweep.output);
    }
    folder.figures = sweep.figures.files();
    report_found(sweep, &file.study, found);

    let journal = Mutex::new(journal);
    let before = lock(&journal).total();
    let outcome = fly(sweep, &file.study, &journal);
    let mut journal = unlock(journal);
    let done = journal.total();
    let written =
        outcome.map_err(Failure::from).and_then(|()| write(sweep, &file, &mut folder, &mut journal, before));
    written.map_err(|failure| match failure {
        Failure::Error(Error::Interrupted) => {
            let what = match file.study.noun() {
                "web" => "webs",
                "spinline" => "spinlines",
                _ => "fibres",
            };
            Failure::Paused { done, total: Some(file.study.most_fibres()), what }
        }
        other => other,
    })
}

fn print_point(study: &Study, number: u64) -> Result<(), Failure> {
    let points = study.points.len() as u64;
    let point = number.checked_sub(1).and_then(|index| study.points.get(usize::try_from(index).ok()?));
    let point = point.ok_or_else(|| {
        Fault::plain(format!("--print-point {number}: the study has {points} points, counted from 1"))
    })?;
    say::line(&format!("# point {number} of {points}"));
    say::text(&write_experiment(&point.experiment));
    Ok(())
}

/// Says what will be done, or what of it has been done before.
fn report_found(sweep: &Sweep, study: &Study, found: Option<JournalState>) {
    let Some(found) = found else {
        let phases = match (study.noun(), study.common_phases) {
            ("web" | "spinline", _) => "",
            (_, true) => ", common phases",
            (_, false) => ", independent phases",
        };
        if !sweep.output.quiet {
            let points = counted(study.points.len() as u64, "point");
            say::aside(&format!("{points}, each with {}{phases}", times(study)));
        }
        return;
    };
    let noun = study.noun();
    let done = format!("{} of {} already done", counted(found.fibres, noun), study.most_fibres());
    say_continued(&found, &done, noun, &sweep.output);
    if found.torn {
        say::aside(&format!("the last record of the journal was incomplete; its {noun} is made again"));
    }
}

/// `10 replicates`, `8 to 100 replicates`.
fn times(study: &Study) -> String {
    let replicates = &study.replicates;
    if replicates.until.is_empty() {
        counted(replicates.at_most, if study.noun() == "fibre" { "replicate" } else { study.noun() })
    } else {
        format!("{} to {} replicates", replicates.at_least, replicates.at_most)
    }
}

fn fly(sweep: &Sweep, study: &Study, journal: &Mutex<Journal>) -> Result<(), Error> {
    let (fibre_steps, progress) = (AtomicU64::new(0), Progress::default());
    let computing = run_control(sweep.threads, &fibre_steps);
    let (begun, mut before) = (Instant::now(), None);
    let state = || {
        let load = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
        let (points, of_points) = (load(&progress.points_done), study.points.len());
        let (done, fibres, noun) = (load(&progress.fibres_done), load(&progress.fibres), study.noun());
        let mut words = format!("points {points}/{of_points}, {noun}s {done}/{fibres}");
        // Fibres that were finished before the program began are not of its work.
        let finished = done - if fibres > 0 { *before.get_or_insert(done) } else { done };
        if finished > 0 {
            let rate = finished as f64 / begun.elapsed().as_secs_f64();
            words += &format!(", {rate:.prec$} {noun}s/s", prec = usize::from(rate < 10.0));
        }
        (load(&fibre_steps), load(&progress.steps), words)
    };
    progress::follow_state(state, sweep.output.quiet, || run(study, journal, computing, &progress))
}

fn write(
    sweep: &Sweep,
    file: &StudyFile,
    folder: &mut JournalFolder<'_>,
    journal: &mut Journal,
    before: u64,
) -> Result<(), Failure> {
    let name = stem(&sweep.study, "study");
    let (found, text) = study::write(folder, &name, file, journal, making(sweep.threads))?;
    let fibres: u64 = found.results.iter().map(|point| point.n + point.lost).sum();
    let noun = file.study.noun();
    let done = if noun == "web" { "laid" } else { "flown" };
    let complete =
        format!("the study was already complete: no {noun} was {done}, and the files were written again");
    let lines = &Vec::from_iter((before == fibres).then_some(complete));
    tell(&found, (Some(folder.path()), &text), &sweep.output, Asides { lines, ..Asides::default() });
    lost(&file.study, journal, fibres)?.map_or(Ok(()), |what| Err(Failure::Incomplete { what }))
}
