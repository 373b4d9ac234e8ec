//! `lay_web`: lays a web of many filaments, and `LaidWeb`, its results.

use crate::save::save;
use crate::value::overrides;
use crate::watched::{LOOK, Watch, guarded, threads, watched};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use spunlaid::advice::{Advice, advise, steps};
use spunlaid::case::Note;
use spunlaid::input::{Overrides, WebFile, parse_changes, parse_web, read_changes, read_web};
use spunlaid::lanes::Isa;
use spunlaid::layers::{Flights, FlownWeb, Flyer};
use spunlaid::observe::OF_PATCHES;
use spunlaid::threads::look_while;
use spunlaid::web::{Findings, LayControl, PatchFindings};
use spunlaid_results::folders::web::{WebFolder, notes};
use spunlaid_results::output::web::{ENTRIES, Performance};
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Instant;

/// What is found of a web. spunlaid.Web shows it.
#[pyclass(frozen, module = "spunlaid._spunlaid")]
#[derive(Debug)]
pub(crate) struct LaidWeb {
    name: String,
    file: WebFile,
    flown: FlownWeb,
    findings: Findings,
    advice: Option<Advice>,
    notes: Vec<String>,
    performance: Performance,
}

/// Lays a web. See spunlaid.web, which calls it.
#[pyfunction]
#[pyo3(signature = (path, changes, advice = false, threads = None, progress = None))]
pub(crate) fn lay_web(
    py: Python<'_>,
    path: Option<PathBuf>,
    changes: &Bound<'_, PyAny>,
    advice: bool,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<LaidWeb> {
    let changes = overrides(changes)?;
    let set = Overrides { values: &changes, word: "web:" };
    let tried = advice.then(|| match &path {
        Some(path) => guarded(py, || read_changes(path, set)),
        None => guarded(py, || parse_changes(String::new(), "web", set)),
    });
    let tried = tried.transpose()?;
    let (name, file) = match path {
        Some(path) => {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            (name, guarded(py, || read_web(&path, set))?)
        }
        None => ("web".to_owned(), guarded(py, || parse_web("", "web", set))?),
    };
    let threads = self::threads(threads);
    let watch = Watch::default();
    let (flown, findings, advice, performance) = watched(py, &watch, progress.as_ref(), || {
        let started = Instant::now();
        // The flights have a counter of their own; it is looked at while they fly.
        let follow = |Flights { done, steps, .. }: Flights<'_>, work: &mut (dyn FnMut() + Send)| {
            watch.total.store(steps, Ordering::Relaxed);
            let look = || watch.done.store(done.load(Ordering::Relaxed), Ordering::Relaxed);
            look_while(LOOK, look, work);
        };
        let mut flyer = Flyer::new(threads, &watch.stop, &follow);
        let mut flown = flyer.web(&file.spec)?;
        watch.done.store(0, Ordering::Relaxed);
        watch.total.store(flown.pieces()?, Ordering::Relaxed);
        let laying = LayControl { threads, isa: Isa::detect(), stop: &watch.stop, laid: &watch.done };
        let findings = flown.find(laying)?;
        let advice = match tried {
            Some(changes) => {
                watch.done.store(0, Ordering::Relaxed);
                watch.total.store(steps(&changes), Ordering::Relaxed);
                Some(advise(&file.spec, (&flown.web, &findings), changes, laying)?)
            }
            None => None,
        };
        let wall_s = started.elapsed().as_secs_f64();
        let instruction_set = laying.isa.name();
        let performance = Performance { wall_s, threads, instruction_set, ..Performance::default() };
        let performance = performance.with_flights(&findings);
        Ok((flown, findings, advice, performance))
    })?;
    let notes = [Note::of_results(&file.notes), notes(&flown.web, &findings, &flown.layers)].concat();
    Ok(LaidWeb { name, file, flown, findings, advice, notes, performance })
}

impl LaidWeb {
    fn folder(&self) -> WebFolder<'_> {
        WebFolder {
            name: &self.name,
            file: &self.file,
            web: &self.flown.web,
            layers: &self.flown.layers,
            findings: &self.findings,
            advice: self.advice.as_ref(),
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

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// The file of the web with every default written out.
    #[getter]
    fn text(&self) -> &str {
        &self.file.text
    }

    /// Side of a cell of the map [m].
    #[getter]
    const fn cell(&self) -> f64 {
        self.findings.laid.map.cell
    }

    /// Basis weight of every cell [kg/m2]: rows in machine direction x columns in cross direction.
    #[getter]
    fn map<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let map = &self.findings.laid.map;
        let weight = map.weight_of_quantum();
        let values = map.cells.iter().map(|cell| f64::from(*cell) * weight).collect();
        let array = PyArray1::from_vec(py, values).reshape([map.rows, map.columns])?;
        crate::samples::locked(array.as_any())
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
        put("cv_low", |patch| Some(patch.map.interval()?[0]))?;
        put("cv_high", |patch| Some(patch.map.interval()?[1]))?;
        Ok(all)
    }

    /// Writes the folder that `spunlaid web` writes.
    #[pyo3(signature = (path, force, figures = None, figure_width = None))]
    fn save(
        &self,
        py: Python<'_>,
        path: PathBuf,
        force: bool,
        figures: Option<&Bound<'_, PyAny>>,
        figure_width: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        save(py, (&path, force), ENTRIES, [figures, figure_width], |staging, watch| {
            let (threads, isa) = (threads(None), Isa::detect());
            self.folder().write(staging, LayControl { threads, isa, stop: &watch.stop, laid: &watch.done })
        })
    }
}
