//! `find_fit`: which values of some keys make a web like a scan?

use crate::save::{Figures, figure_files};
use crate::source::stem;
use crate::value::overrides;
use crate::watched::{Watch, guarded, settled, watched};
use pyo3::prelude::*;
use spunlaid::experiment::fit::fit;
use spunlaid::experiment::{Journal, Question, Target, WebInProgress};
use spunlaid::fibre::Remark;
use spunlaid::ground::Error;
use spunlaid::input::{Overrides, Resources, read_fit};
use spunlaid::simulation::{Flights, Flyer, RunControl};
use spunlaid::web::LayControl;
use spunlaid_results::products::finished::read_measured_web;
use spunlaid_results::products::fit::{self as folder, FitInput, FoundFit, fit_json, sentences};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

/// Finds the values. See spunlaid.fit, which calls it. Returns the text of fit.json and what it says in sentences.
///
/// * `vary` – names of the keys, and of those that have a range its ends
/// * `out` – the folder of the results, with figures as asked; without one, nothing is kept when it is interrupted
#[pyfunction]
#[pyo3(signature = (path, to, vary, changes, spectrum, webs, out, figures, threads = None, progress = None))]
#[expect(clippy::too_many_arguments, reason = "the function of Python has them by name")]
pub(crate) fn find_fit(
    py: Python<'_>,
    path: PathBuf,
    to: PathBuf,
    vary: (Vec<String>, Bound<'_, PyAny>, Bound<'_, PyAny>),
    changes: &Bound<'_, PyAny>,
    spectrum: bool,
    webs: u64,
    out: Option<PathBuf>,
    figures: Figures<'_>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(String, Vec<String>)> {
    let changes = overrides(changes)?;
    let (names, low, high) = vary;
    let ends = overrides(&low)?.into_iter().zip(overrides(&high)?);
    let ranges: BTreeMap<String, String> =
        ends.map(|((key, low), (_, high))| (key, format!("{low}..{high}"))).collect();
    let vary = names
        .iter()
        .map(|name| ranges.get(name).map_or_else(|| name.clone(), |range| format!("{name}={range}")));
    let vary: Vec<String> = vary.collect();
    let set = Overrides::new(&changes, "set:");
    let file = settled(py, threads, |resources| read_fit(&path, set.with(resources), &vary, "vary:"))?;
    let target = guarded(py, || {
        let sheet = &file.start.spec.sheet;
        let target = Target::new(&read_measured_web(&to)?, sheet, spectrum);
        target.map_err(|fault| Error::folder(&to, fault))
    })?;
    let notes = Remark::notes_of_results(&file.start.notes);
    let (name, figures) = (stem(&path), figure_files(figures)?);
    let paths = [&path, &to].map(|path| path.display().to_string());
    let paths = [&*paths[0], &*paths[1]];
    let input = FitInput { name: &name, paths, file: &file, target: &target, webs, notes: &notes };
    let watch = Watch::new(webs);
    let found = watched(py, &watch, progress.as_ref(), || {
        let opened =
            out.as_ref().map(|out| folder::open(out, &input, false, None, &watch.stop)).transpose()?;
        let (place, mut journal) = match opened {
            Some((place, journal, _)) => (Some(place), journal),
            None => (None, Journal::in_memory()),
        };
        let flights = AtomicU64::new(0);
        let flying = RunControl { fibre_steps: &flights, ..watch.run_control(threads) };
        let web = |values: &[f64]| {
            let read = |resources: &Resources| file.web(values, resources);
            Resources::default().settle(read, |resources| resources.fly(flying))
        };
        let make = |values: &[f64]| Ok(web(values)?.spec);
        let question = Question { parameters: &file.parameters, target: &target, make: &make, webs };
        let follow = |_: Flights<'_>, work: &mut (dyn FnMut() + Send)| work();
        // Progress is counted in webs.
        let laid = AtomicU64::new(0);
        let laying = LayControl { laid: &laid, ..watch.lay_control(threads) };
        let flyer = Flyer::new(laying.threads, laying.stop, &follow);
        let tell = |now: WebInProgress<'_>| watch.done.store(now.web - 1, Ordering::Relaxed);
        let found = fit(question, flyer, laying, &mut journal, &tell)?;
        if let Some(mut place) = place {
            place.figures = figures;
            let values: Vec<f64> = found.keys.iter().map(|key| key.value).collect();
            let spec = web(&values)?.spec;
            place.write(&FoundFit { input, fit: &found, spec: &spec }, watch.making())?;
        }
        watch.done.store(webs, Ordering::Relaxed);
        Ok(found)
    })?;
    Ok((fit_json(&found, &target, paths, &notes), sentences(&found)))
}
