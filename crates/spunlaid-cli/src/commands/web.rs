//! `spunlaid web`: lays a web of many filaments and says how even it is.

use super::{counted, stem};
use crate::args::{self, Invocation, Output, overrides};
use crate::control::lay_control;
use crate::delivery::{Asides, Delivery};
use crate::failure::Failure;
use crate::file::check_file;
use crate::settled::{settled, settled_with};
use crate::{progress, say};
use spunlaid::experiment::advice::{advise, are_tried, judged_by, steps};
use spunlaid::experiment::{Advice, Change, KEPT_OUTCOMES, MOST_STEPS};
use spunlaid::ground::{Error, Log};
use spunlaid::input::{Changes, Resources, WebSpec, read_changes, read_web};
use spunlaid::simulation::{Flights, Flyer};
use spunlaid::web::LayControl;
use spunlaid::web::map::Findings;
use spunlaid_results::numbers::significant;
use spunlaid_results::products::web::WebFolder;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

pub(crate) fn web(arguments: &args::Web, invocation: &Invocation) -> Result<(), Failure> {
    let (threads, output) = (arguments.threads, &arguments.output);
    let read = |resources: &Resources| read_web(&arguments.file, overrides(&arguments.set).with(resources));
    let file = settled(threads, output.quiet, read)?;
    file.notes.iter().for_each(say::note);
    let judged_by = arguments.judged_by.as_deref().map(|text| judged_by(&file.spec, text)).transpose()?;
    let (name, origin) = (stem(&arguments.file, "web"), invocation.origin_of([&arguments.file]));
    let (folder, figures) = (output.optional_folder(&name), arguments.figures.files());
    let beside = output.folder(&name).display().to_string();
    let mut delivery = Delivery::open::<WebFolder>(folder, origin, output, &figures)?;
    arguments.sheet.as_deref().map_or(Ok(()), |sheet| check_file(sheet, "--sheet", output.force))?;
    // Before anything is flown, because the file may change meanwhile.
    let trials = Trials { judged_by, ..Trials::read(arguments, &file.spec)? };

    let started = Instant::now();
    let (laid, follow) = (AtomicU64::new(0), flying(output.quiet));
    let by = lay_control(threads, &laid);
    let mut flown = Flyer::new(by.threads, by.stop, &follow).web(&file.spec)?;
    let label = format!("laying {} km of fibre", significant(flown.web.fibre_length() / 1e3, 3));
    let findings = progress::follow(&laid, flown.pieces()?, &label, output.quiet, || flown.find(by))?;
    let laying = format!("{label} took {:.2} s", started.elapsed().as_secs_f64());
    let trials = trials.worth_it(arguments, (&file.spec, &findings));
    let mut web = WebFolder::new((name, beside), file, (flown, findings), (started, by));
    web.awaited = !trials.is_empty();
    if let Some(sheet) = &arguments.sheet {
        fs::write(sheet, web.specification()?).map_err(|error| Error::unwritable(sheet)(error))?;
    }
    delivery.publish(&web, threads)?;
    // The web is safe now, whatever becomes of what is tried with it.
    delivery.say(Asides { lines: &[laying], found: web.found() });
    trials.run(output, web, by, &mut delivery)
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

impl Trials {
    fn read(arguments: &args::Web, spec: &WebSpec) -> Result<Self, Failure> {
        let (file, set) = (&arguments.file, overrides(&arguments.set));
        let read = |changes| {
            let mut resources = Resources::default();
            let read = |resources: &Resources| read_changes(file, set.with(resources), changes);
            let all = read(&resources)?;
            match resources.wanted() {
                0 => Ok(Some(all)),
                // What is too long to be tried is not flown for either.
                _ if !arguments.advice && steps(spec, &all) + resources.most_steps() > MOST_STEPS => Ok(None),
                _ => settled_with(&mut resources, arguments.threads, arguments.output.quiet, read).map(Some),
            }
        };
        let guesses = read(Changes::OfGuesses)?.filter(|all: &Vec<Change>| !all.is_empty());
        let changes = match arguments.no_advice {
            true => None,
            false => read(Changes::OfLine)?,
        };
        Ok(Self { guesses, changes, judged_by: None })
    }

    /// Those that say enough and do not take too long, or are asked for.
    fn worth_it(self, arguments: &args::Web, (spec, findings): (&WebSpec, &Findings)) -> Self {
        let is_tried = |all: &Vec<Change>| arguments.advice || are_tried(spec, findings, all);
        Self { guesses: self.guesses.filter(is_tried), changes: self.changes.filter(is_tried), ..self }
    }

    const fn is_empty(&self) -> bool {
        self.guesses.is_none() && self.changes.is_none()
    }

    /// Tries the guesses, then the changes of the line, and delivers what each says as soon as it is known.
    fn run(
        self,
        output: &Output,
        mut web: WebFolder,
        by: LayControl<'_>,
        delivery: &mut Delivery<'_>,
    ) -> Result<(), Failure> {
        // Beside the folder until all is told. Nothing here ends the command: what is not kept is flown again.
        let file = delivery.folder().map(|folder| {
            let name = folder.file_name().unwrap_or_default().to_string_lossy();
            folder.with_file_name(format!(".{name}.trials"))
        });
        let kept = file.as_ref().and_then(|file| Log::open(file, KEPT_OUTCOMES).ok());
        if let Some(kept) =
            kept.as_ref().filter(|kept| !kept.keys().is_empty() || kept.torn || kept.damaged > 0)
        {
            let torn =
                if kept.torn || kept.damaged > 0 { "; a torn or damaged record is flown again" } else { "" };
            let flights = counted(kept.keys().len() as u64, "flight");
            delivery.line(&format!("continuing: {flights} of an earlier command are kept{torn}"));
        }
        let (judged_by, quiet) = (self.judged_by, output.quiet);
        let by = (kept.as_ref(), by);
        let of_guesses = ["other value", "guesses", "--set web.guessed=none"];
        if let Some(all) = self.guesses {
            web.guesses = try_changes(all, of_guesses, (&mut web, judged_by), by, (quiet, delivery))?;
        }
        web.awaited = self.changes.is_some();
        if web.guesses.is_some() {
            delivery.rewrite(&web)?;
            delivery.say(Asides::default());
        }
        let of_line = ["change", "the line", "--no-advice"];
        if let Some(all) = self.changes {
            web.advice = try_changes(all, of_line, (&mut web, judged_by), by, (quiet, delivery))?;
            web.awaited = false;
            delivery.rewrite(&web)?;
            delivery.say(Asides::default());
        }
        drop(kept);
        file.iter().for_each(|file| drop(fs::remove_file(file)));
        delivery.finish(&web);
        Ok(())
    }
}

/// What changes do to a web; nothing if that cannot be found, which is told. If it is interrupted, the web
/// and what was tried before stay in their folder.
fn try_changes(
    changes: Vec<Change>,
    [noun, of, without]: [&str; 3],
    (web, judged_by): (&mut WebFolder, Option<f64>),
    (kept, by): (Option<&Log>, LayControl<'_>),
    (quiet, delivery): (bool, &mut Delivery<'_>),
) -> Result<Option<Advice>, Failure> {
    let label = format!("trying {} of {of}", counted(changes.len() as u64, noun));
    let (begun, done, spec) = (Instant::now(), AtomicU64::new(0), &web.file.spec);
    let (all, by) = (steps(spec, &changes), LayControl { laid: &done, ..by });
    let work = || advise(spec, (&web.flown.web, &web.findings), changes, judged_by, (kept, by));
    match progress::follow(&done, all, &label, quiet, work) {
        Err(Error::Interrupted) => {
            by.stop.store(false, Ordering::Relaxed);
            web.awaited = false;
            delivery.rewrite(web)?;
            Err(Failure::Kept { folder: delivery.folder().map(Path::to_owned) })
        }
        Err(error) => {
            say::warning(&format!("{label} of {} failed: {error}", web.name));
            Ok(None)
        }
        Ok(advice) => {
            let seconds = begun.elapsed().as_secs_f64();
            delivery.line(&format!("{label} took {seconds:.2} s; {without} leaves it out"));
            Ok(Some(advice))
        }
    }
}

/// Shows the progress of the flights of a case.
fn flying(quiet: bool) -> impl Fn(Flights<'_>, &mut (dyn FnMut() + Send)) {
    move |flights, work| {
        let Flights { path, fibres, done, steps, time_step } = flights;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let seconds = significant(steps as f64 * time_step, 3);
        let label = format!("flying {} of {name}, {seconds} fibre-seconds", counted(fibres, "fibre"));
        progress::follow(done, steps, &label, quiet, work);
    }
}
