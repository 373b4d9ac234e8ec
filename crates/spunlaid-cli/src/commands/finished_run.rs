//! The case for flying a finished run for longer.

use crate::args::Run;
use crate::failure::Failure;
use crate::say;
use spunlaid::case::{Case, Note, Remark, keys};
use spunlaid::error::{Error, Fault, Finding, Place};
use spunlaid::input::{Unread, read_case};
use spunlaid::units::Dimension;
use spunlaid_results::folders::read_summary_of_run;

/// The option of `run` that asks for a longer flight.
const UNTIL: &str = "--until";

/// The case of a finished run with a longer duration, and the notes about it, which have been told.
///
/// Time step and harmonics of the turbulence stay those of the first flight, so that the first part of the longer one
/// has the same bits.
///
/// * `changes` – to the case
/// * `until` – the new duration [s]
///
/// # Errors
/// If the folder does not hold the results of a run, or if the run cannot be continued.
pub(super) fn continued(
    run: &Run,
    changes: &[(&'static str, String)],
    until: f64,
) -> Result<(Case, Vec<String>), Failure> {
    let folder = &run.source.case;
    let flown_by = read_summary_of_run(folder)?;
    let changes: Vec<_> = changes.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect();
    let (mut case, mut notes) = read_case(&folder.join("case.toml"), &changes).map_err(Unread::refuse)?;
    let refused = |reason: String, remedy: &'static str| {
        let fault = Fault::new(format!("cannot be continued: {reason}"), remedy);
        Err(Error::folder(folder, fault).into())
    };
    if !case.air.records.is_empty() {
        return refused(
            "its air follows a record, and the duration decides which stretches of the record the fibres fly \
             through"
                .to_owned(),
            "run its case.toml with --set run.duration=… and name another folder with --out",
        );
    }
    let (before, asked) = (case.run.duration(), Dimension::Time.pretty(until));
    let at_option = |problem| Finding { place: Place::Override(UNTIL.to_owned()), ..problem };
    let rejected = |problems: Vec<_>| Error::Rejected(problems.into_iter().map(at_option).collect());
    if let Some(duration) = keys::find("run.duration") {
        duration.set(&mut case, until).map_err(|problem| rejected(vec![*problem]))?;
    }
    if case.run.duration() <= before {
        let known = Dimension::Time.pretty(before);
        let reason = format!("it lasts for {known} already, and {UNTIL} says {asked}");
        return refused(reason, "write a longer time");
    }
    case.check().map_err(rejected)?;
    let (time, folder) = (case.run.duration(), folder.display());
    if (time - until).abs() > 1e-9 * until {
        notes.push(Finding {
            place: Place::Override(UNTIL.to_owned()),
            key: "run.duration".to_owned(),
            value: Some(asked),
            what: Remark::TimeRounded { time },
        });
    }
    notes.iter().for_each(say::note);
    let mut notes = Note::notes_of_results(&notes);
    let (harmonics, usual) = (case.air.harmonics, case.air.default_harmonics(time));
    if case.air.rms() > 0.0 && harmonics != usual {
        notes.push(format!(
            "{folder}: the turbulence keeps the {harmonics} harmonics of the first flight, with new phases every \
             {}; a new flight to {} would have {usual}",
            Dimension::Time.pretty(0.75 * case.air.repeat_time()),
            Dimension::Time.pretty(time)
        ));
        notes.last().iter().for_each(|note| say::remark(false, note));
    }
    let version = flown_by["spunlaid_version"].as_str().unwrap_or("an unknown version");
    let this = env!("CARGO_PKG_VERSION");
    if version != this {
        notes.push(format!(
            "{folder}: was flown by spunlaid {version}, and this is {this}: the first part may differ in its last bits"
        ));
        notes.last().iter().for_each(|note| say::warning(note));
    }
    if !run.output.quiet {
        let times = [time, before].map(|time| Dimension::Time.pretty(time));
        say::aside(&format!("flying again from the start, to {} in place of {}", times[0], times[1]));
    }
    Ok((case, notes))
}
