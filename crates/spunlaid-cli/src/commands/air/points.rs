//! `spunlaid air --at`: the air at places of a table.

use crate::args::Air;
use crate::failure::Failure;
use crate::file::check_file;
use crate::say;
use spunlaid::ground::{Diagnostic, Error};
use spunlaid::input::{Resources, read_points};
use spunlaid_results::reports::air::{outside, points_csv};
use std::fs;
use std::path::Path;

/// * `file` – of the places
pub(super) fn points(air: &Air, file: &Path) -> Result<(), Failure> {
    let out = air.output.out.as_deref();
    out.map_or(Ok(()), |out| check_file(out, "--out", air.output.force))?;
    let (case, notes) = air.source.read(&[], &Resources::default())?;
    let places = read_points(file)?;
    let axes = air.axes.unwrap_or(case.air.usual_axes());
    let found = case.air.at_points(&places, axes).map_err(|error| at(file, error))?;
    notes.iter().for_each(say::note);
    outside(&places, &found).into_iter().for_each(|words| say::remark(true, &words));
    let table = points_csv(&places, &found);
    match out {
        Some(out) => Ok(fs::write(out, table).map_err(Error::unwritable(out))?),
        None => {
            say::text(&table);
            Ok(())
        }
    }
}

/// The error with the file of the places.
fn at(file: &Path, error: Error) -> Error {
    match error {
        Error::Flight(fault) => Error::File(Box::new(Diagnostic::with_path(file, fault))),
        other => other,
    }
}
