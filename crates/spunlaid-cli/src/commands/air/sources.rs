//! `spunlaid air --sources`: the force of filaments on the cells of their CFD field.

use crate::args::{Air, Invocation, is_standard, overrides};
use crate::commands::{counted, stem};
use crate::control::{control, settled};
use crate::delivery::Delivery;
use crate::failure::Failure;
use crate::{progress, say};
use spunlaid::fibre::Case;
use spunlaid::ground::{Diagnostic, Error, Fault, FileKind};
use spunlaid::input::{WebSpec, kind_of, read_web};
use spunlaid::simulation::{LineFilaments, Sources};
use spunlaid_results::files::kept_input::Input;
use spunlaid_results::reports::sources::SourcesFolder;
use std::sync::atomic::AtomicU64;

pub(super) fn sources(air: &Air, invocation: &Invocation) -> Result<(), Failure> {
    let (path, quiet) = (&air.source.case, air.output.quiet);
    let refuse = |fault: Fault| Error::File(Box::new(Diagnostic::with_path(path, fault)));
    let (web, alone);
    let (input, case, curtain, notes) = if !is_standard(path) && kind_of(path) == FileKind::Web {
        let set = overrides(&air.source.set);
        web = settled(air.threads, quiet, |resources| read_web(path, set.with(resources)))?;
        let case = flown_case(&web.spec).map_err(refuse)?;
        (Input::Web(&web.spec), case, web.spec.curtain(0), &web.notes)
    } else {
        alone = settled(air.threads, quiet, |resources| air.source.read(&[], resources))?;
        (Input::Case(&alone.0), &alone.0, LineFilaments::of_spinline(&alone.0), &alone.1)
    };
    Sources::fault(case).map_or(Ok(()), |fault| Err(refuse(fault)))?;
    let curtain = curtain.ok_or_else(|| refuse(no_filaments()))?;
    notes.iter().for_each(say::note);
    let name = stem(path, "case");
    let figures = air.figures.files();
    let delivery = Delivery::open::<SourcesFolder<'_>>(
        invocation,
        [path],
        format!("{name}_sources"),
        &air.output,
        figures,
    )?;
    let done = AtomicU64::new(0);
    let steps = case.run.steps * case.run.replicates;
    let replicates = case.run.replicates;
    let label = format!("simulating {}", counted(replicates, "fibre"));
    let fly = || Sources::fly(case, &curtain, control(air.threads, &done));
    let sources = progress::follow(&done, steps, &label, quiet, fly)?;
    let contents = SourcesFolder::new(name, input, case, notes, sources);
    delivery.deliver(&contents, air.threads, &[])?;
    let what = contents.lacking.join("\n");
    if what.is_empty() { Ok(()) } else { Err(Failure::Incomplete { what }) }
}

/// The case of the only layer of a web.
fn flown_case(web: &WebSpec) -> Result<&Case, Fault> {
    let [layer] = &web.layers[..] else {
        let layers = web.layers.len();
        let each = format!("has {layers} layers, each in its own air");
        let message = format!("{each}, and sources are those of the filaments of one");
        return Err(Fault::new(message, "write a file for each layer"));
    };
    let message = "lays known curves, and sources are those of simulated filaments";
    let remedy = "name a case in laydown.case, or write its tables into the file";
    layer.source.case().ok_or_else(|| Fault::new(message, remedy))
}

fn no_filaments() -> Fault {
    Fault::new(
        "does not say how many filaments there are, and sources are those of all filaments of a metre of width",
        "add [line] with filaments_per_metre = 5000 and [web] with the width and the length of a piece of its web, or \
         name the file of a web of this case",
    )
}
