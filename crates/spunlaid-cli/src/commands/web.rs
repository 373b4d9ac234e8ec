//! `spunlaid web`: lays a web of many filaments and says how even it is.

use super::flown::flown;
use super::{aligned, fabric_table, lay_control, plural, say_report, staged, stem};
use crate::args::{self, Invocation, overrides};
use crate::failure::Failure;
use crate::{progress, say};
use spunlaid::advice::{Advice, Change, advise, are_tried, check_patch, most_steps, steps};
use spunlaid::case::Note;
use spunlaid::error::Error;
use spunlaid::input::{Changes, Unflown, Unread, WebFile, WebSpec, read_changes, read_web};
use spunlaid::layers::{Flights, FlownWeb, Flyer};
use spunlaid::web::{Findings, LayControl, PatchFindings, Web};
use spunlaid_results::folders;
use spunlaid_results::folders::web::WebFolder;
use spunlaid_results::numbers::significant;
use spunlaid_results::output::web::{ENTRIES, PatchTable, Performance, Reader};
use spunlaid_results::report::{advice_commands, advice_words, guess_words};
use std::path::PathBuf;
use std::sync::atomic::AtomicU64;
use std::time::Instant;

pub(crate) fn web(arguments: &args::Web, invocation: &Invocation) -> Result<(), Failure> {
    let set = overrides(&arguments.set);
    let (threads, quiet) = (arguments.threads, arguments.output.quiet);
    let file = flown(read_web(&arguments.file, set), threads, quiet)?;
    file.notes.iter().for_each(say::note);
    arguments.judged_by.map_or(Ok(()), |patch| check_patch(&file.spec, patch))?;
    let name = stem(&arguments.file, "web").to_string_lossy().into_owned();
    let folder = arguments.output.optional_folder(arguments.json, &name);
    let staged = |folder: &PathBuf| {
        let origin = invocation.origin(&[&arguments.file], folder);
        staged((folder, ENTRIES), &arguments.output, origin, &arguments.figures.files())
    };
    let staging = folder.as_ref().map(staged).transpose()?;
    // Before anything is flown, because the file may change meanwhile.
    let read = |read| match read {
        // What is too long to be tried is not flown for either.
        Err(Unread::Unflown(unflown)) if !arguments.advice && is_long(&file.spec, &unflown) => Ok(None),
        read => flown(read, threads, quiet).map(Some),
    };
    let guesses = read(read_changes(&arguments.file, set, Changes::OfGuesses))?;
    let guesses = guesses.filter(|guesses| !guesses.is_empty());
    let changes = (!arguments.no_advice)
        .then(|| read(read_changes(&arguments.file, set, Changes::OfLine)))
        .transpose()?
        .flatten();

    let started = Instant::now();
    let follow = flying(arguments.output.quiet);
    let laid = AtomicU64::new(0);
    let by = lay_control(arguments.threads, &laid);
    let mut flyer = Flyer::new(by.threads, by.stop, &follow);
    let mut flown = flyer.web(&file.spec)?;

    let label = format!("laying {} km of fibre", significant(flown.web.fibre_length() / 1e3, 3));
    let findings =
        progress::follow(&laid, flown.pieces()?, &label, arguments.output.quiet, || flown.find(by))?;
    let laying_s = started.elapsed().as_secs_f64();
    let FlownWeb { web, layers, .. } = &flown;
    let fabric = file.spec.fabric(web, &findings, by.threads);
    let is_tried = |all: &Vec<Change>| arguments.advice || are_tried(&file.spec, &findings, all);
    let mut tried = Vec::new();
    let mut compare =
        |changes: Option<Vec<Change>>, [noun, of, leave_out]: [&str; 3]| -> Result<Option<Advice>, Failure> {
            let Some(changes) = changes else { return Ok(None) };
            let (label, begun) =
                (format!("trying {} of {of}", plural(changes.len() as u64, noun)), Instant::now());
            match compare_with(changes, (&file, web, &findings), arguments.judged_by, by, (&label, quiet)) {
                Err(Failure::Error(error)) if !matches!(error, Error::Interrupted) => {
                    say::warning(&format!("{label} of {name} failed: {error}"));
                    Ok(None)
                }
                compared => {
                    tried.push(format!(
                        "{label} took {:.2} s; {leave_out} leaves it out",
                        begun.elapsed().as_secs_f64()
                    ));
                    compared.map(Some)
                }
            }
        };
    let guesses = compare(guesses.filter(is_tried), ["other value", "guesses", "--set web.guessed=none"])?;
    let advice = compare(changes.filter(is_tried), ["change", "the line", "--no-advice"])?;
    let performance = Performance::measure(started, by.threads, by.isa).with_flights(&findings);
    let found = folders::web::notes(&flown, &findings);
    let notes = [Note::notes_of_results(&file.notes), found.clone()].concat();
    let written = WebFolder {
        name: &name,
        file: &file,
        web,
        layers,
        findings: &findings,
        fabric: &fabric,
        advice: advice.as_ref(),
        guesses: guesses.as_ref(),
        notes: &notes,
        performance,
    };
    if let Some(staging) = staging {
        written.write(&staging, by)?;
        staging.publish()?;
    }
    if arguments.json {
        say::text(&written.summary());
    } else if !arguments.output.quiet {
        say::table(&terminal_table(&findings));
        say::table(&fabric_table(&fabric));
        let words = guess_words(&file.spec, &findings, guesses.as_ref());
        if !words.is_empty() {
            say::line(&format!("\n{words}"));
        }
        let words = advice_words(&file.spec, &findings, advice.as_ref());
        if !(words.is_empty() || arguments.no_advice) {
            say::line(&format!("\n{words}"));
            let commands = advice.as_ref().map(|advice| advice_commands(&findings, advice));
            commands.into_iter().flatten().for_each(|command| say::line(&format!("  {command}")));
        }
        say::line(&format!("\n{label} took {laying_s:.2} s"));
        tried.iter().for_each(|line| say::line(line));
        found.iter().for_each(|note| say::remark(false, note));
        folder.iter().for_each(say_report);
    }
    Ok(())
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

/// The table for the terminal.
fn terminal_table(findings: &Findings) -> String {
    let PatchTable { heads, rows } = PatchTable::new(findings, Reader::Terminal);
    let heads = heads.into_iter().map(str::to_owned).collect();
    let rows: Vec<Vec<String>> = std::iter::once(heads).chain(rows).collect();
    let is_flown = |patch: &PatchFindings| patch.independent.is_none() && patch.flown.is_some();
    let whole = if findings.patches.iter().any(is_flown) {
        "of this map ± its standard error by all causes (chance, few fibres flown, model: the surrogate against the flown curves)"
    } else if findings.patches.iter().any(|patch| patch.few.is_some()) {
        "of the web of all filaments, from the flown ones, ± its standard error by all causes (chance, few filaments flown)"
    } else {
        "of this map ± its standard error by chance alone"
    };
    let bound = match findings.laid.shared_air {
        Some(_) => "",
        None => "a lower bound, because the filaments are independent of each other; ",
    };
    format!(
        "basis weight {} g/m²\nunevenness, CV in %: {bound}{whole}, and as expected\n{}",
        significant(findings.within().basis_weight() * 1e3, 4),
        aligned(&rows)
    )
}
