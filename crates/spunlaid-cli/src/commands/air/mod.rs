//! `spunlaid air`: the turbulent air of a case, looked at while it passes.

mod points;
mod sources;

use super::stem;
use crate::args::{Air, Invocation};
use crate::control::{settled_with, stop_on_ctrl_c};
use crate::delivery::Delivery;
use crate::failure::Failure;
use crate::{progress, say};
use spunlaid::air::Lateral;
use spunlaid::ground::{Diagnostic, Fault, FileError};
use spunlaid::input::Resources;
use spunlaid_results::reports::air::{AirFolder, AirViews, Slices};
use std::sync::atomic::AtomicU64;

/// What a reader is reported of a case whose fibres have turbulence of their own.
const UNIFORM: &str = "the case has air.lateral = \"uniform\": each of its fibres is simulated in independent \
    turbulence, which is the same across. What is shown is its air with air.lateral = \"von-karman\", as \
    neighbours share it";

pub(crate) fn air(air: &Air, invocation: &Invocation) -> Result<(), Failure> {
    if air.sources {
        return sources::sources(air, invocation);
    }
    if let Some(file) = &air.at {
        return points::points(air, file);
    }
    let mut resources = Resources::default();
    let (case, _) = air.source.read(&[], &resources)?;
    if !case.air.records.is_empty() {
        let fault = Fault::new(
            "has the air of a record (air.record), which was measured at one point, so nothing is known of its \
             eddies in space",
            "take the numbers and the spectrum of the record (spunlaid analyse) instead of it",
        );
        return Err(FileError::from(Diagnostic::with_path(&air.source.case, fault)).into());
    }
    let is_uniform = case.air.lateral == Lateral::Uniform;
    let more = is_uniform.then(|| ("air.lateral", "von-karman".to_owned()));
    let read = |resources: &Resources| air.source.read(more.as_slice(), resources);
    let (case, notes) = settled_with(&mut resources, air.threads, air.output.quiet, read)?;
    notes.iter().for_each(say::note);
    let mut remarks = Diagnostic::notes_of_results(&notes);
    if is_uniform {
        say::remark(false, &UNIFORM);
        remarks.push(UNIFORM.to_owned());
    }
    let name = stem(&air.source.case, "case");
    let figures = air.figures.files();
    let folder = format!("{name}_air");
    let delivery =
        Delivery::open::<AirFolder<'_>>(invocation, [&air.source.case], folder, &air.output, figures)?;
    let (replicate, threads) = (air.replicate - 1, air.threads.number());
    let looks = AirViews { replicate, frames: air.frames, duration: air.duration, threads };
    let done = AtomicU64::new(0);
    let slices = progress::follow(&done, air.frames, "the air passes", air.output.quiet, || {
        Slices::new(&case, &looks, &done, stop_on_ctrl_c())
    })?;
    let contents = AirFolder { name: &name, case: &case, slices: &slices, replicate, notes: &remarks };
    delivery.deliver(&contents, air.threads, &[])
}
