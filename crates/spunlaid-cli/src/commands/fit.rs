//! `spunlaid fit`: which values of some keys make a web like a scan?

use super::{counted, stem};
use crate::args::{self, Invocation, overrides};
use crate::control::{control, settled, stop_on_ctrl_c};
use crate::delivery::{begin, making, print_results, say_continued};
use crate::failure::Failure;
use crate::{progress, say};
use spunlaid::experiment::{Journal, WebInProgress};
use spunlaid::ground::Error;
use spunlaid::input::{Resources, read_fit};
use spunlaid_results::reports::fit::{self, FitInput, FoundFit, pretty};
use std::sync::atomic::AtomicU64;

pub(crate) fn fit(arguments: &args::Fit, invocation: &Invocation) -> Result<(), Failure> {
    let set = overrides(&arguments.set);
    let threads = arguments.threads;
    let output = &arguments.output;
    let (web, webs) = (&arguments.web, arguments.webs);
    let read = |resources: &Resources| read_fit(web, set.with(resources), &arguments.vary, "--vary");
    let file = &settled(threads, output.quiet, read)?;
    file.start.notes.iter().for_each(say::note);
    let target = &fit::target(&arguments.to, file, arguments.spectrum)?;
    let name = stem(web, "web");
    let paths = [web, &arguments.to].map(|path| path.display().to_string());
    let path = output.folder(format!("{name}_fit"));
    let input = FitInput { name, paths, file, target, webs };
    let origin = invocation.origin_of([web], &path);
    let opened = fit::open(&path, &input, output.force, origin.as_ref(), stop_on_ctrl_c())?;
    let (mut folder, mut journal, state) = opened;
    begin(&mut folder, arguments.figures.files(), output);
    if let Some(state) = state {
        let done = format!("{} already laid", counted(state.fibres, "web"));
        say_continued(&state, &done, "web", output);
    }
    let paused = |error, done| Failure::from(error).or_paused(done, None, "web");
    let found = search(arguments, &input, &mut journal).map_err(|error| paused(error, journal.total()))?;
    let trials = counted(found.fit.trials.len() as u64, "trial");
    let lines = [format!("{trials} of {} each", counted(found.fit.webs, "web"))];
    let text = folder.write(&found, making(threads))?;
    print_results(&found, &path, &text, &lines, output);
    Ok(())
}

/// Columns of what stands before the words of the bar.
const BEFORE: usize = 56;

/// Searches, and shows how far it is.
fn search<'a>(
    arguments: &args::Fit,
    input: &'a FitInput<'_>,
    journal: &mut Journal,
) -> Result<FoundFit<'a>, Error> {
    let (threads, laid) = (arguments.threads, AtomicU64::new(0));
    let web = |values: &[f64]| settled(threads, true, |resources| input.file.web(values, resources));
    // How many trials there will be is not known.
    let template = "[{bar:20}] web {pos} of {len}  {elapsed} elapsed  {msg}";
    let bar = progress::bar(arguments.webs, template, arguments.output.quiet);
    let watch = |WebInProgress { trial, web, webs, values }: WebInProgress<'_>| {
        let values = input.file.parameters.iter().zip(values);
        let values = values.map(|(key, value)| format!("{} = {}", key.key.name, pretty(key, *value)));
        bar.set_length(webs);
        bar.set_position(web - 1);
        let words = format!("trial {trial}: {}", values.collect::<Vec<_>>().join(", "));
        bar.set_message(progress::fitting(&words, BEFORE));
    };
    let found = input.find(&web, control(threads, &laid), journal, &watch);
    bar.finish_and_clear();
    found
}
