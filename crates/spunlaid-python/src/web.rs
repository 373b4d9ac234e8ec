//! `lay_web`: lays a web of many filaments.

use crate::computed::{Computed, Of};
use crate::source::Source;
use crate::value::overrides;
use crate::warning::warn_of;
use crate::watched::{LOOK, Watch, settled, watched};
use pyo3::prelude::*;
use spunlaid::experiment::Change;
use spunlaid::experiment::advice::{advise, are_tried, steps};
use spunlaid::ground::threads::look_while;
use spunlaid::ground::{FileKind, Measure, measure};
use spunlaid::input::{Changes, Overrides, read_changes, read_web};
use spunlaid::simulation::{Flights, Flyer};
use spunlaid::web::{PATCH_MEASURES, SCANNED_PATCH_MEASURES};
use spunlaid_results::reports::web::WebFolder;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Instant;

/// Lays a web. See spunlaid.web, which calls it.
#[pyfunction]
#[pyo3(signature = (path, changes, advice = false, assumed_values = true, threads = None, progress = None))]
pub(crate) fn lay_web(
    py: Python<'_>,
    path: Option<PathBuf>,
    changes: &Bound<'_, PyAny>,
    advice: bool,
    assumed_values: bool,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Computed> {
    let changes = overrides(changes)?;
    let set = Overrides::new(&changes, "web:");
    let Source { name, text, file } = Source::read(py, path, FileKind::Web, "web")?;
    let read = |of| settled(py, threads, |resources| read_changes((&text, &file), set.with(resources), of));
    let advice = advice.then(|| read(Changes::OfLine)).transpose()?;
    let assumed_values = assumed_values.then(|| read(Changes::OfAssumedValues)).transpose()?;
    let file = settled(py, threads, |resources| read_web((&text, &file), set.with(resources)))?;
    warn_of(py, &file.notes)?;
    let watch = Watch::default();
    // The flights have a counter of their own; it is looked at while they fly.
    let follow = |Flights { done, steps, .. }: Flights<'_>, work: &mut (dyn FnMut() + Send)| {
        watch.total.store(steps, Ordering::Relaxed);
        look_while(LOOK, || watch.done.store(done.load(Ordering::Relaxed), Ordering::Relaxed), work);
    };
    let web = watched(py, &watch, progress.as_ref(), || {
        let (started, by) = (Instant::now(), watch.control(threads));
        let mut simulated = Flyer::new(by.threads, by.stop, &follow).web(&file.spec)?;
        watch.begin(simulated.pieces()?);
        let findings = simulated.find(by)?;
        let mut web = WebFolder::new(name.clone(), name.clone(), file, simulated, findings, started, by);
        let tried = |web: &WebFolder, changes: Vec<Change>| {
            watch.begin(steps(&web.file.spec, &changes));
            advise(&web.file.spec, &web.simulated.web, &web.findings, changes, None, None, by)
        };
        let are_tried = |all: &Vec<Change>| !all.is_empty() && are_tried(&web.file.spec, &web.findings, all);
        let assumed_values = assumed_values.filter(are_tried);
        web.assumed_values = assumed_values.map(|changes| tried(&web, changes)).transpose()?;
        web.advice = advice.map(|changes| tried(&web, changes)).transpose()?;
        Ok(web)
    })?;
    Ok(Computed { name, of: Of::Web(Box::new(web)) })
}

/// The numbers of patches, of a web that was laid and of a scan.
#[pyfunction]
pub(crate) fn patch_numbers() -> [Vec<&'static str>; 2] {
    [
        measure::with_errors(PATCH_MEASURES).map(Measure::entry).collect(),
        measure::with_errors(SCANNED_PATCH_MEASURES).map(Measure::entry).collect(),
    ]
}
