//! `spunlaid spin`: solves a spinline, from the hole of the spinneret to the solid filament.

use super::delivery::{Asides, Delivery};
use super::flown::settled;
use super::name_of;
use crate::args::{Invocation, Spin, Threads, overrides};
use crate::failure::Failure;
use crate::say;
use spunlaid::fibre::Note;
use spunlaid::ground::FileKind;
use spunlaid::input::{Resources, read_spinline};
use spunlaid_results::folders::products::SpinFolder;
use spunlaid_results::output::spinline::{SpinResults, remarks};

pub(crate) fn spin(spin: &Spin, invocation: &Invocation) -> Result<(), Failure> {
    let set = overrides(&spin.set);
    let read = |resources: &Resources| read_spinline(&spin.file, set.with(resources));
    let file = settled(Threads::default(), spin.output.quiet, read)?;
    file.notes.iter().for_each(say::note);
    let (name, origin) =
        (name_of(&spin.file, FileKind::Spinline, ["spinline"; 2]), invocation.origin_of([&spin.file]));
    let folder = spin.output.optional_folder(&name);
    let delivery = Delivery::open::<SpinFolder<'_>>(folder, origin, &spin.output, &spin.figures.files())?;
    let results = SpinResults::new(&file)?;
    let found = &remarks(&results.rows);
    let notes = &[Note::notes_of_results(&file.notes), found.clone()].concat();
    let contents = SpinFolder { name: &name, file: &file, results: &results, notes };
    delivery.deliver(&contents, Threads::default(), Asides { found, ..Asides::default() })
}
