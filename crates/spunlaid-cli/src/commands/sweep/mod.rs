//! `spunlaid sweep`: flies a study and writes its results.

mod shown;

use super::{counted, stem};
use crate::args::{Invocation, Sweep, overrides};
use crate::control::{control, settled, stop_on_ctrl_c};
use crate::delivery::{begin, making, print_results};
use crate::failure::Failure;
use crate::{progress, say};
use shown::{print_point, say_begun, state};
use spunlaid::experiment::study::run;
use spunlaid::experiment::{Journal, Progress};
use spunlaid::ground::threads::unlock;
use spunlaid::input::{Resources, StudyChanges, StudyFile, read_study};
use spunlaid_results::folders::JournalFolder;
use spunlaid_results::reports::study::{self, lost};
use std::sync::Mutex;
use std::sync::atomic::AtomicU64;

pub(crate) fn sweep(sweep: &Sweep, invocation: &Invocation) -> Result<(), Failure> {
    let output = &sweep.output;
    let points = sweep.points;
    let replicates = sweep.replicates;
    let read = |resources: &Resources| {
        let set = overrides(&sweep.set).with(resources);
        read_study(&sweep.study, StudyChanges { points, replicates, set })
    };
    if let Some(number) = sweep.print_point {
        return print_point(&read(&Resources::default())?.study, number);
    }
    let path = output.folder(stem(&sweep.study, "study"));
    let file = settled(sweep.threads, output.quiet, read)?;
    file.notes.iter().for_each(say::study_note);
    let origin = invocation.origin_of([&sweep.study], &path);
    let (mut folder, journal, found) =
        study::open(&path, &file, output.force, origin.as_ref(), stop_on_ctrl_c())?;
    begin(&mut folder, sweep.figures.files(), output);
    say_begun(&file.study, found, output);

    let (before, journal) = (journal.total(), Mutex::new(journal));
    let (fibre_steps, progress) = (AtomicU64::new(0), Progress::default());
    let work = || run(&file.study, &journal, control(sweep.threads, &fibre_steps), &progress);
    let outcome = progress::follow_state(state(&file.study, &fibre_steps, &progress), output.quiet, work);
    let mut journal = unlock(journal);
    let (done, total) = (journal.total(), Some(file.study.most_fibres()));
    let written =
        outcome.map_err(Failure::from).and_then(|()| write(sweep, &file, &mut folder, &mut journal, before));
    written.map_err(|failure| failure.or_paused(done, total, file.study.noun()))
}

fn write(
    sweep: &Sweep,
    file: &StudyFile,
    folder: &mut JournalFolder<'_>,
    journal: &mut Journal,
    before: u64,
) -> Result<(), Failure> {
    let (name, by) = (stem(&sweep.study, "study"), making(sweep.threads));
    let (found, text) = study::write(folder, &name, file, journal, by)?;
    let fibres: u64 = found.results.iter().map(|point| point.n + point.lost).sum();
    let noun = file.study.noun();
    let done = if noun == "web" { "laid" } else { "simulated" };
    let complete =
        format!("the study was already complete: no {noun} was {done}, and the files were written again");
    let lines = &Vec::from_iter((before == fibres).then_some(complete));
    print_results(&found, folder.path(), &text, lines, &sweep.output);
    lost(&file.study, journal, fibres)?.map_or(Ok(()), |what| Err(Failure::Incomplete { what }))
}
