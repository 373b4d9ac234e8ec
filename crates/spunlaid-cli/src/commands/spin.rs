//! `spunlaid spin`: solves a spinline, from the hole of the spinneret to the solid filament.

use super::flown::flown;
use super::{say_report, staged, stem};
use crate::args::{Invocation, Spin, Threads, overrides};
use crate::failure::Failure;
use crate::say;
use spunlaid::case::Note;
use spunlaid::input::read_spinline;
use spunlaid_results::folders::spinline::SpinFolder;
use spunlaid_results::output::spinline::{ENTRIES, SpinResults, remarks, text};

pub(crate) fn spin(spin: &Spin, invocation: &Invocation) -> Result<(), Failure> {
    let read = read_spinline(&spin.file, overrides(&spin.set));
    let file = flown(read, Threads::default(), spin.output.quiet)?;
    file.notes.iter().for_each(say::note);
    let name = stem(&spin.file, "spinline").to_string_lossy().into_owned();
    let results = SpinResults::new(&file)?;
    let found = remarks(&results.rows);
    let notes = [Note::notes_of_results(&file.notes), found.clone()].concat();
    let written = SpinFolder { name: &name, file: &file, results: &results, notes: &notes };
    let folder = spin.output.optional_folder(spin.json, &name);
    if let Some(folder) = &folder {
        let origin = invocation.origin(&[&spin.file], folder);
        let staging = staged((folder, ENTRIES), &spin.output, origin, &spin.figures.files())?;
        written.write(&staging)?;
        staging.publish()?;
    }
    if spin.json {
        say::text(&written.summary());
    } else if !spin.output.quiet {
        say::table(&text(&results.rows, &results.influences));
        found.iter().for_each(|note| say::remark(false, note));
        folder.iter().for_each(say_report);
    }
    Ok(())
}
