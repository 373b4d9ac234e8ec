//! `find_fit`: which values of some keys make a web like a scan?

use crate::save::{Figures, figure_files};
use crate::source::stem;
use crate::value::overrides;
use crate::warning::warn_of;
use crate::watched::{Watch, guarded, settled, watched};
use pyo3::prelude::*;
use spunlaid::experiment::{Journal, WebInProgress};
use spunlaid::ground::RunContext;
use spunlaid::input::{Overrides, Resources, read_fit};
use spunlaid_results::folders::Contents;
use spunlaid_results::reports::fit::{self as folder, FitInput, sentences};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

/// Finds the values. See spunlaid.fit, which calls it. Returns the text of fit.json and what it says in sentences.
///
/// * `names` – of the keys that are varied; `low`, `high` – ends of the ranges of those that have one
/// * `out` – the folder of the results, with figures as asked; without one, nothing is kept when it is interrupted
#[pyfunction]
#[pyo3(signature = (
    path, to, names, low, high, changes, spectrum, webs, out, figures, threads = None, progress = None
))]
#[expect(clippy::too_many_arguments, reason = "the function of Python has them by name")]
pub(crate) fn find_fit(
    py: Python<'_>,
    path: PathBuf,
    to: PathBuf,
    names: Vec<String>,
    low: &Bound<'_, PyAny>,
    high: &Bound<'_, PyAny>,
    changes: &Bound<'_, PyAny>,
    spectrum: bool,
    webs: u64,
    out: Option<PathBuf>,
    figures: Figures<'_>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(String, Vec<String>)> {
    let changes = overrides(changes)?;
    let ends = overrides(low)?.into_iter().zip(overrides(high)?);
    let ranges: BTreeMap<String, String> =
        ends.map(|((key, low), (_, high))| (key, format!("{low}..{high}"))).collect();
    let vary = names
        .iter()
        .map(|name| ranges.get(name).map_or_else(|| name.clone(), |range| format!("{name}={range}")));
    let vary: Vec<String> = vary.collect();
    let set = Overrides::new(&changes, "set:");
    let file = settled(py, threads, |resources| read_fit(&path, set.with(resources), &vary, "vary:"))?;
    warn_of(py, &file.start.notes)?;
    let target = guarded(py, || folder::target(&to, &file, spectrum))?;
    let (name, figures) = (stem(&path), figure_files(figures)?);
    let paths = [&path, &to].map(|path| path.display().to_string());
    let input = FitInput { name, paths, file: &file, target: &target, webs };
    let watch = Watch::new(webs);
    watched(py, &watch, progress.as_ref(), || {
        let opened =
            out.as_ref().map(|out| folder::open(out, &input, false, None, &watch.stop)).transpose()?;
        let (place, mut journal) = match opened {
            Some((place, journal, _)) => (Some(place), journal),
            None => (None, Journal::in_memory()),
        };
        // Progress is counted in webs.
        let aside = AtomicU64::new(0);
        let by = RunContext { done: &aside, ..watch.control(threads) };
        let web = |values: &[f64]| {
            let read = |resources: &Resources| file.web(values, resources);
            Resources::default().resolve_tension(read, |resources| resources.fly(by))
        };
        let report_progress = |now: WebInProgress<'_>| watch.done.store(now.web - 1, Ordering::Relaxed);
        let found = input.find(&web, by, &mut journal, &report_progress)?;
        if let Some(mut place) = place {
            place.figures = figures;
            place.write(&found, watch.making())?;
        }
        watch.done.store(webs, Ordering::Relaxed);
        Ok((found.summary(), sentences(&found.fit)))
    })
}
