//! `spunlaid air --sources`: the force of filaments on the cells of their CFD field.

use crate::args::{Air, Invocation, is_standard, overrides};
use crate::commands::{counted, stem};
use crate::control::run_control;
use crate::delivery::{Asides, Delivery};
use crate::failure::Failure;
use crate::settled::settled;
use crate::{progress, say};
use spunlaid::fibre::{Case, Note, Remark};
use spunlaid::ground::{Error, Fault, FileKind, Problem};
use spunlaid::input::{WebFile, kind_of, read_web};
use spunlaid::simulation::{LineFilaments, Sources};
use spunlaid_results::files::kept_input::Input;
use spunlaid_results::products::run::lost;
use spunlaid_results::products::sources::{SourcesFolder, outside_of_cells, unsteady};
use std::sync::atomic::AtomicU64;

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
    let label = format!("flying {}", counted(replicates, "fibre"));
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
