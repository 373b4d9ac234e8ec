//! `spunlaid fit`: which values of some keys make a web like a scan?

use super::{counted, stem};
use crate::args::{self, Invocation, overrides};
use crate::control::{lay_control, stop_on_ctrl_c};
use crate::delivery::{Asides, making, say_continued, say_replaced, tell};
use crate::failure::Failure;
use crate::settled::settled;
use crate::{progress, say};
use spunlaid::experiment::fit::fit as find;
use spunlaid::experiment::{Fit, Journal, Question, Target, WebInProgress};
use spunlaid::fibre::Remark;
use spunlaid::ground::Error;
use spunlaid::input::{FitFile, Resources, read_fit};
use spunlaid::simulation::{Flights, Flyer};
use spunlaid_results::products::finished::read_measured_web;
use spunlaid_results::products::fit::{self, FitInput, FoundFit, pretty};
use std::sync::atomic::AtomicU64;

pub(crate) fn fit(arguments: &args::Fit, invocation: &Invocation) -> Result<(), Failure> {
    let set = overrides(&arguments.set);
    let read =
        |resources: &Resources| read_fit(&arguments.web, set.with(resources), &arguments.vary, "--vary");
    let (threads, quiet) = (arguments.threads, arguments.output.quiet);
    let file = settled(threads, quiet, read)?;
    file.start.notes.iter().for_each(say::note);
    let scan = read_measured_web(&arguments.to)?;
    let target = Target::new(&scan, &file.start.spec.sheet, arguments.spectrum)
        .map_err(|fault| Error::folder(&arguments.to, fault))?;
    let notes = Remark::notes_of_results(&file.start.notes);
    let name = stem(&arguments.web, "web");
    let paths = [arguments.web.display().to_string(), arguments.to.display().to_string()];
    let input = FitInput {
        name: &name,
        paths: [&paths[0], &paths[1]],
        file: &file,
        target: &target,
        webs: arguments.webs,
        notes: &notes,
    };
    let path = arguments.output.folder(format!("{name}_fit"));
    let origin = invocation.origin_of([&arguments.web])(&path);
    let (mut folder, mut journal, state) =
        fit::open(&path, &input, arguments.output.force, origin.as_ref(), stop_on_ctrl_c())?;
    if folder.replaces() {
        say_replaced(&path, &arguments.output);
    }
    if let Some(state) = state {
        let done = format!("{} already laid", counted(state.fibres, "web"));
        say_continued(&state, &done, "web", &arguments.output);
    }
    let found = search(arguments, &file, &target, &mut journal).map_err(|error| match error {
        Error::Interrupted => Failure::Paused { done: journal.total(), what: "webs", total: None },
        other => other.into(),
    })?;
    folder.figures = arguments.figures.files();
    let values: Vec<f64> = found.keys.iter().map(|key| key.value).collect();
    let web = settled(threads, quiet, |resources| file.web(&values, resources))?;
    let trials = counted(found.trials.len() as u64, "trial");
    let lines = &[format!("{trials} of {} each", counted(found.webs, "web"))];
    let contents = FoundFit { input, fit: &found, spec: &web.spec };
    let text = folder.write(&contents, making(arguments.threads))?;
    let asides = Asides { lines, ..Asides::default() };
    tell(&contents, (Some(&path), &text), &arguments.output, asides);
    Ok(())
}

/// Columns of what stands before the words of the bar.
const BEFORE: usize = 56;

/// Searches, and shows how far it is.
fn search(
    arguments: &args::Fit,
    file: &FitFile,
    target: &Target,
    journal: &mut Journal,
) -> Result<Fit, Error> {
    let make =
        |values: &[f64]| Ok(settled(arguments.threads, true, |resources| file.web(values, resources))?.spec);
    let question = Question { parameters: &file.parameters, target, make: &make, webs: arguments.webs };
    let laid = AtomicU64::new(0);
    let by = lay_control(arguments.threads, &laid);
    // How many trials there will be is not known.
    let template = "[{bar:20}] web {pos} of {len}  {elapsed} elapsed  {msg}";
    let bar = progress::bar(arguments.webs, template, arguments.output.quiet);
    let follow = |_: Flights<'_>, work: &mut (dyn FnMut() + Send)| work();
    let flyer = Flyer::new(by.threads, by.stop, &follow);
    let watch = |WebInProgress { trial, web, webs, values }: WebInProgress<'_>| {
        let values = file.parameters.iter().zip(values);
        let values = values.map(|(key, value)| format!("{} = {}", key.key.name, pretty(key, *value)));
        bar.set_length(webs);
        bar.set_position(web - 1);
        let words = format!("trial {trial}: {}", values.collect::<Vec<_>>().join(", "));
        bar.set_message(progress::fitting(&words, BEFORE));
    };
    let found = find(question, flyer, by, journal, &watch);
    bar.finish_and_clear();
    found
}
