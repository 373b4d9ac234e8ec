//! `spunlaid web`: lays a web of many filaments and says how even it is.

use super::flown::flown;
use super::{aligned, fabric_table, lay_control, plural, say_report, staged, stem};
use crate::args::{self, Invocation, overrides};
use crate::failure::Failure;
use crate::{progress, say};
use spunlaid::advice::{Advice, Change, advise, are_tried, steps};
use spunlaid::case::Note;
use spunlaid::error::{Error, Fault};
use spunlaid::input::{Method, Unflown, Unread, WebFile, WebSpec, read_changes, read_guesses, read_web};
use spunlaid::layers::{Flights, FlownWeb, Flyer};
use spunlaid::web::{Findings, LayControl, PatchFindings, Web};
use spunlaid_results::folders;
use spunlaid_results::folders::web::WebFolder;
use spunlaid_results::numbers::significant;
use spunlaid_results::output::web::{ENTRIES, PatchTable, Performance, Reader, specification_sheet};
use spunlaid_results::report::{advice_commands, advice_words, guess_words};
use std::fs;
use std::path::PathBuf;
use std::sync::atomic::AtomicU64;
use std::time::Instant;

pub(crate) fn web(arguments: &args::Web, invocation: &Invocation) -> Result<(), Failure> {
    let set = overrides(&arguments.set);
    let (threads, quiet) = (arguments.threads, arguments.output.quiet);
    let file = flown(read_web(&arguments.file, set), threads, quiet)?;
    file.notes.iter().for_each(say::note);
    let name = stem(&arguments.file, "web").to_string_lossy().into_owned();
    let folder = arguments.output.optional_folder(arguments.json, &name);
    let staged = |folder: &PathBuf| {
        let origin = invocation.origin(&[&arguments.file], folder);
        staged((folder, ENTRIES), &arguments.output, origin, &arguments.figures.files())
    };
    let staging = folder.as_ref().map(staged).transpose()?;
    if let Some(sheet) = arguments.sheet.as_ref().filter(|sheet| sheet.exists() && !arguments.output.force) {
        let fault =
            Fault::new("is there already", "name another file, or replace it").option("--sheet, --force");
        return Err(Error::folder(sheet, fault).into());
    }
    // Before anything is flown, because the file may change meanwhile.
    let read = |read| match read {
        // What is too long to be tried is not flown for either.
        Err(Unread::Unflown(unflown)) if !arguments.advice && is_long(&file.spec, &unflown) => Ok(None),
        read => flown(read, threads, quiet).map(Some),
    };
    let guesses = read(read_guesses(&arguments.file, set))?;
    let changes = if arguments.no_advice { None } else { read(read_changes(&arguments.file, set))? };

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
    let is_short = |changes: &Vec<Change>| {
        says_enough(&file.spec, &findings) && steps(&file.spec, changes) <= most_steps(file.spec.method)
    };
    let mut tried = Vec::new();
    let mut compare =
        |changes: Option<Vec<Change>>, [noun, of, leave_out]: [&str; 3]| -> Result<Option<Advice>, Failure> {
            let Some(changes) = changes else { return Ok(None) };
            let (label, begun) =
                (format!("trying {} of {of}", plural(changes.len() as u64, noun)), Instant::now());
            match compare_with(changes, (&file, web, &findings), by, (&label, quiet)) {
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
    let is_asked = |guesses: &[Change]| arguments.advice && !guesses.is_empty();
    let guesses = guesses.filter(|all| is_asked(all) || are_tried(&file.spec, &findings, all));
    let guesses = compare(guesses, ["other value", "guesses", "--set web.guessed=none"])?;
    let changes = changes.filter(|changes| arguments.advice || is_short(changes));
    let advice = compare(changes, ["change", "the line", "--no-advice"])?;
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
    if let Some(sheet) = &arguments.sheet {
        let page = specification_sheet(&name, (&findings, &fabric), &notes)?;
        fs::write(sheet, page).map_err(|error| Error::unwritable(sheet)(error))?;
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

/// Most steps of all fibres that are flown for advice without `--advice`: a minute or two of a processor, of filaments in one air too, whose steps are shorter.
const fn most_steps(method: Method) -> u64 {
    match method {
        Method::Surrogate | Method::Dynamics => 4_000_000,
        Method::SharedAir => 20_000_000,
    }
}

/// Whether changes take longer with the flights for their tensions.
fn is_long(spec: &WebSpec, unflown: &Unflown<Vec<Change>>) -> bool {
    let flights = unflown.without_flights().map_or(0, |changes| steps(spec, changes));
    flights + unflown.most_steps() > most_steps(spec.method)
}

/// Whether changes of a web can be told from chance. Where all filaments in one air are flown, two maps are compared, and only large effects are seen.
fn says_enough(spec: &WebSpec, findings: &Findings) -> bool {
    let few = findings.laid.shared_air.as_ref().map(|together| together.few.len());
    few.is_none_or(|layers| layers == spec.layers.len())
}

/// What changes do to a web, with their progress.
fn compare_with(
    changes: Vec<Change>,
    (file, web, findings): (&WebFile, &Web, &Findings),
    by: LayControl<'_>,
    (label, quiet): (&str, bool),
) -> Result<Advice, Failure> {
    let done = AtomicU64::new(0);
    let (all, by) = (steps(&file.spec, &changes), LayControl { laid: &done, ..by });
    let work = || advise(&file.spec, (web, findings), changes, by);
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
