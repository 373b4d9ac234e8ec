//! `spunlaid air --at`: the air of a case at given places.

use super::delivery::check_file;
use crate::args::Air;
use crate::failure::Failure;
use crate::say;
use spunlaid::air::LocalAir;
use spunlaid::error::{Error, Problem};
use spunlaid::input::{Resources, read_points};
use spunlaid::vec3::Vec3;
use spunlaid_results::output::air::points_csv;
use std::fs;
use std::path::Path;

/// * `file` – of the places
pub(super) fn points(air: &Air, file: &Path) -> Result<(), Failure> {
    let out = air.output.out.as_deref();
    out.map_or(Ok(()), |out| check_file(out, "--out", air.output.force))?;
    let (case, notes) = air.source.read(&[], &Resources::default())?;
    let places = read_points(file)?;
    let axes = air.axes.map_or(case.air.usual_axes(), Into::into);
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
        Error::Flight(fault) => Error::File(Box::new(Problem::with_path(file, fault))),
        other => other,
    }
}

/// What is said of places at which the air is not known.
fn outside(places: &[Vec3<f64>], found: &[Option<LocalAir>]) -> Option<String> {
    let outside = found.iter().filter(|air| air.is_none()).count();
    let (at, row) = places.iter().zip(1..).zip(found).find(|(_, air)| air.is_none())?.0;
    Some(format!(
        "{outside} of {} places lie where the air is not known, the first of them in row {row} ({}, {}, {} m): their cells \
         are empty",
        places.len(),
        at.x,
        at.y,
        at.z
    ))
}
