//! `spunlaid air`: the turbulent air of a case, looked at while it passes.

use super::delivery::{Asides, Delivery, check_file};
use super::flown::{settled, settled_with};
use super::{plural, run_control, stem, stop_on_ctrl_c};
use crate::args::{Air, Invocation, is_standard, overrides};
use crate::failure::Failure;
use crate::{progress, say};
use spunlaid::air::{Lateral, LocalAir};
use spunlaid::fibre::{Case, Note, Remark};
use spunlaid::ground::{Error, Fault, FileKind, Problem, Vec3};
use spunlaid::input::{Resources, WebFile, kind_of, read_points, read_web};
use spunlaid::simulation::{LineFilaments, Sources};
use spunlaid_results::files::kept_input::Input;
use spunlaid_results::numbers::significant;
use spunlaid_results::products::air::{AirFolder, AirViews, Slices, points_csv};
use spunlaid_results::products::run::lost;
use spunlaid_results::products::sources::{SourcesFolder, unsteady};
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicU64;

/// What a reader is told of a case whose fibres have turbulence of their own.
const UNIFORM: &str = "the case has air.lateral = \"uniform\": each of its fibres flies in turbulence of its \
    own, which is the same across. What is shown is its air with air.lateral = \"von-karman\", as neighbours \
    share it";

pub(crate) fn air(air: &Air, invocation: &Invocation) -> Result<(), Failure> {
    if air.sources {
        return sources(air, invocation);
    }
    if let Some(file) = &air.at {
        return points(air, file);
    }
    let mut resources = Resources::default();
    let is_uniform = air.source.read(&[], &resources)?.0.air.lateral == Lateral::Uniform;
    let more = is_uniform.then(|| ("air.lateral", "von-karman".to_owned()));
    let read = |resources: &Resources| air.source.read(more.as_slice(), resources);
    let (case, notes) = settled_with(&mut resources, air.threads, air.output.quiet, read)?;
    notes.iter().for_each(say::note);
    let mut remarks = Remark::notes_of_results(&notes);
    if is_uniform {
        say::remark(false, &UNIFORM);
        remarks.push(UNIFORM.to_owned());
    }
    let (name, origin) = (stem(&air.source.case, "case"), invocation.origin_of([&air.source.case]));
    let folder = air.output.optional_folder(format!("{name}_air"));
    let delivery = Delivery::open::<AirFolder<'_>>(folder, origin, &air.output, &air.figures.files())?;
    let (replicate, threads) = (air.replicate - 1, air.threads.number());
    let looks = AirViews { replicate, frames: air.frames, duration: air.duration, threads };
    let done = AtomicU64::new(0);
    let slices = progress::follow(&done, air.frames, "the air passes", air.output.quiet, || {
        Slices::new(&case, &looks, &done, stop_on_ctrl_c())
    })?;
    let contents = AirFolder { name: &name, case: &case, slices: &slices, replicate, notes: &remarks };
    delivery.deliver(&contents, air.threads, Asides::default())
}

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
        Error::Flight(fault) => Error::File(Box::new(Problem::with_path(file, fault))),
        other => other,
    }
}

/// What is said of places at which the air is not known.
fn outside(places: &[Vec3<f64>], found: &[Option<LocalAir>]) -> Option<String> {
    let outside = found.iter().filter(|air| air.is_none()).count();
    let (at, row) = places.iter().zip(1..).zip(found).find(|(_, air)| air.is_none())?.0;
    Some(format!(
        "{outside} of {} places lie where the air is not known, the first of them in row {row} ({}, {}, {} m): their \
         cells are empty",
        places.len(),
        at.x,
        at.y,
        at.z
    ))
}

/// Share of the force outside of the cells from which on it is told.
const MUCH_OUTSIDE: f64 = 0.01;

/// What was read.
enum LineFile {
    /// The file of a web, with one layer.
    Web(Box<WebFile>),
    /// A case.
    Case(Box<Case>, Vec<Note>),
}

pub(crate) fn sources(air: &Air, invocation: &Invocation) -> Result<(), Failure> {
    let line = read(air)?;
    let refuse = |fault: Fault| Error::File(Box::new(Problem::with_path(&air.source.case, fault)));
    let (case, curtain, input, notes) = match &line {
        LineFile::Web(file) => {
            let case = match &file.spec.layers[..] {
                [layer] => layer.source.case().ok_or_else(|| refuse(no_case()))?,
                layers => return Err(refuse(several(layers.len())).into()),
            };
            (case, file.spec.curtain(0), Input::Web(&file.spec), &file.notes)
        }
        LineFile::Case(case, notes) => (&**case, LineFilaments::of_spinline(case), Input::Case(case), notes),
    };
    if let Some(fault) = Sources::fault(case) {
        return Err(refuse(fault).into());
    }
    let curtain = curtain.ok_or_else(|| refuse(no_filaments()))?;
    notes.iter().for_each(say::note);
    let (name, origin) = (stem(&air.source.case, "case"), invocation.origin_of([&air.source.case]));
    let folder = air.output.optional_folder(format!("{name}_sources"));
    let delivery = Delivery::open::<SourcesFolder<'_>>(folder, origin, &air.output, &air.figures.files())?;
    let done = AtomicU64::new(0);
    let (steps, replicates) = (case.run.steps * case.run.replicates, case.run.replicates);
    let label = format!("flying {}", plural(replicates, "fibre"));
    let sources = progress::follow(&done, steps, &label, air.output.quiet, || {
        Sources::fly(case, &curtain, run_control(air.threads, &done))
    })?;
    let lost = lost(&sources.lost, replicates);
    let unsteady = unsteady(case, &sources);
    let found: Vec<String> = outside_of_cells(&sources).into_iter().collect();
    let notes =
        [Remark::notes_of_results(notes), lost.iter().chain(&unsteady).cloned().collect(), found.clone()]
            .concat();
    let contents = SourcesFolder { name: &name, case, input, sources: &sources, notes: &notes };
    delivery.deliver(&contents, air.threads, Asides { lines: &[], found: &found })?;
    let lacking: Vec<String> = lost.into_iter().chain(unsteady).collect();
    if lacking.is_empty() { Ok(()) } else { Err(Failure::Incomplete { what: lacking.join("\n") }) }
}

/// The line, from the file of a web or from a case.
fn read(air: &Air) -> Result<LineFile, Failure> {
    let (path, quiet) = (&air.source.case, air.output.quiet);
    if !is_standard(path) && kind_of(path) == FileKind::Web {
        let set = overrides(&air.source.set);
        let file = settled(air.threads, quiet, |resources| read_web(path, set.with(resources)))?;
        return Ok(LineFile::Web(Box::new(file)));
    }
    let (case, notes) = settled(air.threads, quiet, |resources| air.source.read(&[], resources))?;
    Ok(LineFile::Case(Box::new(case), notes))
}

fn no_filaments() -> Fault {
    Fault::new(
        "does not say how many filaments there are, and sources are those of all filaments of a metre of width",
        "add [line] with filaments_per_metre = 5000 and [web] with the width and the length of a piece of its web, or \
         name the file of a web that flies this case",
    )
}

fn no_case() -> Fault {
    Fault::new(
        "lays known curves, and sources are those of flown filaments",
        "name a case in laydown.case, or write its tables into the file",
    )
}

fn several(layers: usize) -> Fault {
    Fault::new(
        format!("has {layers} layers, each in air of its own, and sources are those of the filaments of one"),
        "write a file for each layer",
    )
}

/// What is said if much of the force is outside of the cells.
fn outside_of_cells(sources: &Sources) -> Option<String> {
    let (outside, inside) = (sources.outside.mean, sources.along.mean);
    let share = outside.abs() / (outside.abs() + inside.abs());
    (share > MUCH_OUTSIDE).then(|| {
        format!(
            "{} % of the force of the filaments on the air is outside of the cells of air.field and is in no source: \
             {} N/m beside {} N/m. Does the field reach from the inlet to the belt, and as far to both sides as the \
             filaments swing?",
            significant(share * 100.0, 2),
            significant(outside, 3),
            significant(inside, 3)
        )
    })
}
