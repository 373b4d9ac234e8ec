//! `spunlaid web`: lays a web of many filaments and says how even it is.

mod kept;
mod trials;
mod tried;

use super::{counted, stem};
use crate::args::{self, Invocation, overrides};
use crate::control::{control, settled, settled_with};
use crate::delivery::Delivery;
use crate::failure::Failure;
use crate::file::check_file;
use crate::{progress, say};
use kept::Kept;
use spunlaid::experiment::advice::judged_by;
use spunlaid::ground::Error;
use spunlaid::input::{Resources, read_web};
use spunlaid::simulation::{Flights, Flyer};
use spunlaid_results::numbers::significant;
use spunlaid_results::reports::web::WebFolder;
use std::fs;
use std::sync::atomic::AtomicU64;
use std::time::Instant;
use trials::Trials;

pub(crate) fn web(arguments: &args::Web, invocation: &Invocation) -> Result<(), Failure> {
    let file = &arguments.file;
    let output = &arguments.output;
    let threads = arguments.threads;
    let read = |resources: &Resources| read_web(file, overrides(&arguments.set).with(resources));
    let web = settled(threads, output.quiet, read)?;
    web.notes.iter().for_each(say::note);
    let judged_by = arguments.judged_by.as_deref().map(|text| judged_by(&web.spec, text)).transpose()?;
    let name = stem(file, "web");
    let figures = arguments.figures.files();
    let beside = output.folder(&name).display().to_string();
    let mut delivery = Delivery::open::<WebFolder>(invocation, [file], &name, output, figures)?;
    arguments.sheet.as_deref().map_or(Ok(()), |sheet| check_file(sheet, "--sheet", output.force))?;
    // Before anything is simulated, because the file may change meanwhile.
    let trials = Trials::read(arguments, &web.spec)?;

    let started = Instant::now();
    let laid = AtomicU64::new(0);
    let follow = flying(output.quiet);
    let by = control(threads, &laid);
    let kept = if web.spec.flies() { Kept::open(&delivery) } else { None };
    let flyer = Flyer::new(by.threads, by.stop, &follow).keeping(kept.as_ref().map(|kept| &kept.log));
    let simulated = flyer.web(&web.spec).map_err(Failure::from);
    let mut simulated = simulated.map_err(|failure| Kept::after(kept.as_ref(), failure))?;
    let label = format!("laying {} km of fibre", significant(simulated.web.fibre_length() / 1e3, 3));
    let findings = progress::follow(&laid, simulated.pieces()?, &label, output.quiet, || simulated.find(by))?;
    let laying = format!("{label} took {:.2} s", started.elapsed().as_secs_f64());
    let trials = trials.worth_it(arguments.advice, &web.spec, &findings);
    let mut web = WebFolder::new(name, beside, web, simulated, findings, started, by);
    web.awaited = !trials.is_empty();
    if let Some(sheet) = &arguments.sheet {
        fs::write(sheet, web.specification()?).map_err(|error| Error::unwritable(sheet)(error))?;
    }
    delivery.publish(&web, threads)?;
    // The web is safe now, whatever becomes of what is tried with it.
    delivery.say(&web, &[laying]);
    trials.run(web, judged_by, kept, by, &mut delivery)
}

/// Shows the progress of the flights of a case.
fn flying(quiet: bool) -> impl Fn(Flights<'_>, &mut (dyn FnMut() + Send)) {
    move |flights, work| {
        let Flights { path, fibres, done, steps, time_step } = flights;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let seconds = significant(steps as f64 * time_step, 3);
        let label = format!("simulating {} of {name}, {seconds} fibre-seconds", counted(fibres, "fibre"));
        progress::follow(done, steps, &label, quiet, work);
    }
}
