//! `lay_web`: lays a web of many filaments, and `LaidWeb`, its results.

use crate::samples::locked;
use crate::save::{Figures, save};
use crate::source::Source;
use crate::value::overrides;
use crate::watched::{LOOK, Watch, read_file, watched};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use spunlaid::advice::{Advice, Change, advise, are_tried, steps};
use spunlaid::case::Note;
use spunlaid::error::FileKind;
use spunlaid::fabric::Fabric;
use spunlaid::input::{Overrides, WebFile, parse_changes, parse_guesses, parse_web};
use spunlaid::layers::{Flights, FlownWeb, Flyer};
use spunlaid::observe::OF_PATCHES;
use spunlaid::threads::look_while;
use spunlaid::web::{Findings, Map, PatchFindings};
use spunlaid_results::folders::web::{WebFolder, notes};
use spunlaid_results::output::web::{ENTRIES, Performance};
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Instant;

/// What is found of a web. spunlaid.Web shows it.
#[pyclass(frozen, module = "spunlaid._spunlaid")]
#[derive(Debug)]
pub(crate) struct LaidWeb {
    #[pyo3(get)]
    name: String,
    file: WebFile,
    flown: FlownWeb,
    findings: Findings,
    fabric: Fabric,
    advice: Option<Advice>,
    guesses: Option<Advice>,
    #[pyo3(get)]
    notes: Vec<String>,
    performance: Performance,
}

/// Lays a web. See spunlaid.web, which calls it.
#[pyfunction]
#[pyo3(signature = (path, changes, advice = false, guesses = true, threads = None, progress = None))]
pub(crate) fn lay_web(
    py: Python<'_>,
    path: Option<PathBuf>,
    changes: &Bound<'_, PyAny>,
    advice: bool,
    guesses: bool,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<LaidWeb> {
    let changes = overrides(changes)?;
    let set = Overrides { values: &changes, word: "web:" };
    let Source { name, text, file } = Source::read(py, path, FileKind::Web, "web")?;
    let changes = advice.then(|| read_file(py, threads, || parse_changes(text.clone(), &file, set)));
    let tried = changes.transpose()?;
    let guesses = guesses.then(|| read_file(py, threads, || parse_guesses(text.clone(), &file, set)));
    let guesses = guesses.transpose()?;
    let file = read_file(py, threads, || parse_web(&text, &file, set))?;
    let watch = Watch::default();
    let (flown, findings, [advice, guesses], performance) = watched(py, &watch, progress.as_ref(), || {
        let started = Instant::now();
        // The flights have a counter of their own; it is looked at while they fly.
        let follow = |Flights { done, steps, .. }: Flights<'_>, work: &mut (dyn FnMut() + Send)| {
            watch.total.store(steps, Ordering::Relaxed);
            let look = || watch.done.store(done.load(Ordering::Relaxed), Ordering::Relaxed);
            look_while(LOOK, look, work);
        };
        let laying = watch.lay_control(threads);
        let mut flyer = Flyer::new(laying.threads, laying.stop, &follow);
        let mut flown = flyer.web(&file.spec)?;
        watch.begin(flown.pieces()?);
        let findings = flown.find(laying)?;
        let compare = |changes: Vec<Change>| {
            watch.begin(steps(&file.spec, &changes));
            advise(&file.spec, (&flown.web, &findings), changes, laying)
        };
        let guesses = guesses.filter(|guesses| are_tried(&file.spec, &findings, guesses));
        let (guesses, advice) = (guesses.map(compare).transpose()?, tried.map(compare).transpose()?);
        let performance = Performance::measure(started, laying.threads, laying.isa).with_flights(&findings);
        Ok((flown, findings, [advice, guesses], performance))
    })?;
    let fabric = file.spec.fabric(&flown.web, &findings, watch.lay_control(threads).threads);
    let notes = [Note::notes_of_results(&file.notes), notes(&flown.web, &findings, &flown.layers)].concat();
    Ok(LaidWeb { name, file, flown, findings, fabric, advice, guesses, notes, performance })
}

/// Basis weight of every cell of a map [kg/m2], which cannot be written to.
pub(crate) fn weights<'py>(py: Python<'py>, map: &Map) -> PyResult<Bound<'py, PyAny>> {
    let weight = map.weight_of_quantum();
    let values = map.cells.iter().map(|cell| f64::from(*cell) * weight).collect();
    let array = PyArray1::from_vec(py, values).reshape([map.rows, map.columns])?;
    locked(array.as_any())
}

impl LaidWeb {
    fn folder(&self) -> WebFolder<'_> {
        WebFolder {
            name: &self.name,
            file: &self.file,
            web: &self.flown.web,
            layers: &self.flown.layers,
            findings: &self.findings,
            fabric: &self.fabric,
            advice: self.advice.as_ref(),
            guesses: self.guesses.as_ref(),
            notes: &self.notes,
            performance: self.performance,
        }
    }
}

#[pymethods]
impl LaidWeb {
    /// Text of summary.json.
    #[getter]
    fn summary(&self) -> String {
        self.folder().summary()
    }

    /// Side of a cell of the map [m].
    #[getter]
    const fn cell(&self) -> f64 {
        self.findings.laid.map.cell
    }

    /// Basis weight of every cell [kg/m2]: rows in machine direction x columns in cross direction.
    #[getter]
    fn map<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        weights(py, &self.findings.laid.map)
    }

    /// The unevenness over patches: side of the patch [m], every declared number of them, and the ends of the 95 % interval of the CV by chance.
    /// What is not known is NaN.
    #[getter]
    fn patches<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let patches = &self.findings.patches;
        let all = PyDict::new(py);
        let put = |name: &str, number: fn(&PatchFindings) -> Option<f64>| {
            let column = patches.iter().map(|patch| number(patch).unwrap_or(f64::NAN)).collect();
            all.set_item(name, PyArray1::from_vec(py, column))
        };
        put("patch_m", |patch| Some(patch.map.patch))?;
        for measure in OF_PATCHES {
            // The older name of these.
            put(&measure.name.replace("one_fibre", "single_fibres"), measure.number)?;
        }
        put("cv_low", |patch| Some(patch.interval()?[0]))?;
        put("cv_high", |patch| Some(patch.interval()?[1]))?;
        Ok(all)
    }

    /// Writes the folder that `spunlaid web` writes.
    fn save(&self, py: Python<'_>, path: PathBuf, force: bool, figures: Figures<'_>) -> PyResult<()> {
        save(py, (&path, force, figures), ENTRIES, |staging, watch| {
            self.folder().write(staging, watch.lay_control(None))
        })
    }
}
