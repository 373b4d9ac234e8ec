//! `spunlaid web`: lays a web of many filaments and says how even it is.

use super::delivery::{Asides, Delivery};
use super::flown::flown;
use super::{lay_control, plural, stem};
use crate::args::{self, Invocation, overrides};
use crate::failure::Failure;
use crate::{progress, say};
use spunlaid::advice::{Advice, Change, advise, are_tried, judged_by, most_steps, steps};
use spunlaid::case::Note;
use spunlaid::error::{Error, Fault};
use spunlaid::input::{Changes, Unflown, Unread, WebFile, WebSpec, read_changes, read_web};
use spunlaid::layers::{Flights, FlownWeb, Flyer};
use spunlaid::web::{Findings, LayControl, Web};
use spunlaid_results::folders;
use spunlaid_results::folders::web::WebFolder;
use spunlaid_results::numbers::significant;
use spunlaid_results::output::web::{Performance, specification_sheet};
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicU64;
use std::time::Instant;

pub(crate) fn web(arguments: &args::Web, invocation: &Invocation) -> Result<(), Failure> {
    let (threads, output) = (arguments.threads, &arguments.output);
    let file = flown(read_web(&arguments.file, overrides(&arguments.set)), threads, output.quiet)?;
    file.notes.iter().for_each(say::note);
    let judged_by = arguments.judged_by.as_deref().map(|text| judged_by(&file.spec, text)).transpose()?;
    let (name, origin) = (stem(&arguments.file, "web"), invocation.origin_of([&arguments.file]));
    let (folder, figures) = (output.optional_folder(&name), arguments.figures.files());
    let delivery = Delivery::open::<WebFolder<'_>>(folder, origin, output, &figures)?;
    arguments.sheet.as_deref().map_or(Ok(()), |sheet| check_sheet(sheet, output.force))?;
    // Before anything is flown, because the file may change meanwhile.
    let trials = Trials { judged_by, ..Trials::read(arguments, &file.spec)? };

    let started = Instant::now();
    let (laid, follow) = (AtomicU64::new(0), flying(output.quiet));
    let by = lay_control(threads, &laid);
    let mut flown = Flyer::new(by.threads, by.stop, &follow).web(&file.spec)?;
    let label = format!("laying {} km of fibre", significant(flown.web.fibre_length() / 1e3, 3));
    let findings = progress::follow(&laid, flown.pieces()?, &label, output.quiet, || flown.find(by))?;
    let laying = format!("{label} took {:.2} s", started.elapsed().as_secs_f64());
    let FlownWeb { web, layers, .. } = &flown;
    let fabric = file.spec.fabric(web, &findings, by.threads);
    let tried = trials.run(arguments, (&file, web, &findings), by)?;

    let performance = Performance::measure(started, by.threads, by.isa).with_flights(&findings);
    let found = &folders::web::notes(&flown, &findings);
    let notes = &[Note::notes_of_results(&file.notes), found.clone()].concat();
    let lines = &[vec![laying], tried.lines].concat();
    let contents = WebFolder {
        name: &name,
        file: &file,
        web,
        layers,
        findings: &findings,
        fabric: &fabric,
        advice: tried.advice.as_ref(),
        guesses: tried.guesses.as_ref(),
        notes,
        performance,
    };
    delivery.deliver(&contents, threads, Asides { lines, found })?;
    if let Some(sheet) = &arguments.sheet {
        let page = specification_sheet(&name, (&findings, &fabric), notes)?;
        fs::write(sheet, page).map_err(|error| Error::unwritable(sheet)(error))?;
    }
    Ok(())
}

/// Whether a specification sheet can be written there, before anything is flown for it. One that is there already
/// is replaced with `--force` only.
fn check_sheet(sheet: &Path, force: bool) -> Result<(), Error> {
    let folder = sheet.parent().filter(|folder| !folder.as_os_str().is_empty());
    let fault = if folder.is_some_and(|folder| !folder.is_dir()) {
        Fault::new("lies in a folder that is not there", "name another file, or make the folder")
            .option("--sheet")
    } else if sheet.is_dir() {
        Fault::new("is a folder", "name a file").option("--sheet")
    } else if sheet.exists() && !force {
        Fault::new("is there already", "name another file, or replace it").option("--sheet, --force")
    } else {
        return Ok(());
    };
    Err(Error::folder(sheet, fault))
}

/// Changes that are tried once a web has been laid.
struct Trials {
    /// Other values of numbers that are guesses.
    guesses: Option<Vec<Change>>,
    /// Changes of the line.
    changes: Option<Vec<Change>>,
    /// Side of the patches by whose CV they are judged, if it was asked for [m].
    judged_by: Option<f64>,
}

/// What was tried.
#[derive(Default)]
struct Tried {
    guesses: Option<Advice>,
    advice: Option<Advice>,
    /// How long it took.
    lines: Vec<String>,
}

impl Trials {
    fn read(arguments: &args::Web, spec: &WebSpec) -> Result<Self, Failure> {
        let (file, set) = (&arguments.file, overrides(&arguments.set));
        let read = |read| match read {
            // What is too long to be tried is not flown for either.
            Err(Unread::Unflown(unflown)) if !arguments.advice && is_long(spec, &unflown) => Ok(None),
            read => flown(read, arguments.threads, arguments.output.quiet).map(Some),
        };
        let guesses = read(read_changes(file, set, Changes::OfGuesses))?.filter(|all| !all.is_empty());
        let changes = match arguments.no_advice {
            true => None,
            false => read(read_changes(file, set, Changes::OfLine))?,
        };
        Ok(Self { guesses, changes, judged_by: None })
    }

    /// Tries what says enough and does not take too long, or is asked for.
    fn run(
        self,
        arguments: &args::Web,
        (file, web, findings): (&WebFile, &Web, &Findings),
        by: LayControl<'_>,
    ) -> Result<Tried, Failure> {
        let (spec, mut tried) = (&file.spec, Tried::default());
        let is_tried = |all: &Vec<Change>| arguments.advice || are_tried(spec, findings, all);
        let (guesses, changes) = (self.guesses.filter(is_tried), self.changes.filter(is_tried));
        let mut compare = |changes: Option<Vec<Change>>, [noun, of, without]: [&str; 3]| {
            let Some(changes) = changes else { return Ok(None) };
            let (label, begun) =
                (format!("trying {} of {of}", plural(changes.len() as u64, noun)), Instant::now());
            let (judged_by, quiet) = (self.judged_by, arguments.output.quiet);
            match compare_with(changes, (file, web, findings), judged_by, by, (&label, quiet)) {
                Err(Failure::Error(error)) if !matches!(error, Error::Interrupted) => {
                    let name = stem(&arguments.file, "web");
                    say::warning(&format!("{label} of {name} failed: {error}"));
                    Ok(None)
                }
                compared => {
                    let seconds = begun.elapsed().as_secs_f64();
                    tried.lines.push(format!("{label} took {seconds:.2} s; {without} leaves it out"));
                    compared.map(Some)
                }
            }
        };
        let guesses = compare(guesses, ["other value", "guesses", "--set web.guessed=none"])?;
        let advice = compare(changes, ["change", "the line", "--no-advice"])?;
        Ok(Tried { guesses, advice, ..tried })
    }
}

/// Whether changes take longer with the flights for their tensions.
fn is_long(spec: &WebSpec, unflown: &Unflown<Vec<Change>>) -> bool {
    let flights = unflown.without_flights().map_or(0, |changes| steps(spec, changes));
    flights + unflown.most_steps() > most_steps(spec.method)
}

/// What changes do to a web, with their progress.
fn compare_with(
    changes: Vec<Change>,
    (file, web, findings): (&WebFile, &Web, &Findings),
    judged_by: Option<f64>,
    by: LayControl<'_>,
    (label, quiet): (&str, bool),
) -> Result<Advice, Failure> {
    let done = AtomicU64::new(0);
    let (all, by) = (steps(&file.spec, &changes), LayControl { laid: &done, ..by });
    let work = || advise(&file.spec, (web, findings), changes, judged_by, by);
    Ok(progress::follow(&done, all, label, quiet, work)?)
}

/// Shows the progress of the flights of a case.
fn flying(quiet: bool) -> impl Fn(Flights<'_>, &mut (dyn FnMut() + Send)) {
    move |flights, work| {
        let Flights { path, fibres, done, steps, time_step } = flights;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let seconds = significant(steps as f64 * time_step, 3);
        let label = format!("flying {} of {name}, {seconds} fibre-seconds", plural(fibres, "fibre"));
        progress::follow(done, steps, &label, quiet, work);
    }
}
