//! `spunlaid spin`: solves a spinline, from the hole of the spinneret to the solid filament.

use super::name_of;
use crate::args::{Invocation, Spin, Threads, overrides};
use crate::control::settled;
use crate::delivery::Delivery;
use crate::failure::Failure;
use crate::say;
use spunlaid::ground::FileKind;
use spunlaid::input::{Resources, read_spinline};
use spunlaid_results::reports::spinline::SpinFolder;

pub(crate) fn spin(spin: &Spin, invocation: &Invocation) -> Result<(), Failure> {
    let set = overrides(&spin.set);
    let read = |resources: &Resources| read_spinline(&spin.file, set.with(resources));
    let file = settled(Threads::default(), spin.output.quiet, read)?;
    file.notes.iter().for_each(say::note);
    let name = name_of(&spin.file, FileKind::Spinline, ["spinline"; 2]);
    let figures = spin.figures.files();
    let delivery = Delivery::open::<SpinFolder>(invocation, [&spin.file], &name, &spin.output, figures)?;
    delivery.deliver(&SpinFolder::solve(name, file)?, Threads::default(), &[])
}
