//! `spunlaid spin`: solves a spinline, from the hole of the spinneret to the solid filament.

use super::name_of;
use crate::args::{Invocation, Spin, Threads, overrides};
use crate::delivery::{Asides, Delivery};
use crate::failure::Failure;
use crate::say;
use crate::settled::settled;
use spunlaid::ground::FileKind;
use spunlaid::input::{Resources, read_spinline};
use spunlaid_results::products::spinline::SpinFolder;

pub(crate) fn spin(spin: &Spin, invocation: &Invocation) -> Result<(), Failure> {
    let set = overrides(&spin.set);
    let read = |resources: &Resources| read_spinline(&spin.file, set.with(resources));
    let file = settled(Threads::default(), spin.output.quiet, read)?;
    file.notes.iter().for_each(say::note);
    let (name, origin) =
        (name_of(&spin.file, FileKind::Spinline, ["spinline"; 2]), invocation.origin_of([&spin.file]));
    let folder = spin.output.optional_folder(&name);
    let delivery = Delivery::open::<SpinFolder>(folder, origin, &spin.output, &spin.figures.files())?;
    let contents = SpinFolder::solve(name, file)?;
    delivery.deliver(&contents, Threads::default(), Asides { found: &contents.found, ..Asides::default() })
}
