//! `lay_web`: lays a web of many filaments, and `LaidWeb`, its results.

use crate::save::{Figures, save};
use crate::source::Source;
use crate::value::overrides;
use crate::watched::{LOOK, Watch, guarded, watched};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use spunlaid::advice::{Advice, advise, steps};
use spunlaid::case::Note;
use spunlaid::error::FileKind;
use spunlaid::input::{Overrides, WebFile, parse_changes, parse_web};
use spunlaid::layers::{Flights, FlownWeb, Flyer};
use spunlaid::threads::look_while;
use spunlaid::web::Findings;
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
    advice: Option<Advice>,
    #[pyo3(get)]
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
    let Source { name, text, file } = Source::read(py, path, FileKind::Web, "web")?;
    let (tried, file) = guarded(py, || {
        let tried = advice.then(|| parse_changes(text.clone(), &file, set)).transpose()?;
        Ok((tried, parse_web(&text, &file, set)?))
    })?;
    let watch = Watch::default();
    let (flown, findings, advice, performance) = watched(py, &watch, progress.as_ref(), || {
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
        let advice = match tried {
            Some(changes) => {
                watch.begin(steps(&changes));
                Some(advise(&file.spec, (&flown.web, &findings), changes, laying)?)
            }
            None => None,
        };
        let performance = Performance::measure(started, laying.threads, laying.isa).with_flights(&findings);
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

    /// The unevenness over patches: side of the patch [m], CV of the map with its standard errors by cause and the ends of its 95 % interval by
    /// chance, the CV expected from single fibres, from flown curves and from the surrogate with their standard errors, CV of straight fibres. What is not known is NaN.
    #[getter]
    fn patches<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let patches = &self.findings.patches;
        let all = PyDict::new(py);
        type Number = fn(&spunlaid::web::PatchFindings) -> f64;
        let columns: [(&str, Number); 17] = [
            ("patch_m", |patches| patches.map.patch),
            ("cv", |patch| patch.map.cv),
            ("cv_standard_error", |patch| patch.map.standard_error.unwrap_or(f64::NAN)),
            ("cv_low", |patch| patch.map.interval().map_or(f64::NAN, |ends| ends[0])),
            ("cv_high", |patch| patch.map.interval().map_or(f64::NAN, |ends| ends[1])),
            ("cv_flight_error", |patch| patch.whole_error().flight.unwrap_or(f64::NAN)),
            ("cv_model_error", |patch| patch.whole_error().model.unwrap_or(f64::NAN)),
            ("cv_whole_error", |patch| patch.whole_error().whole().unwrap_or(f64::NAN)),
            ("cv_independent", |patch| patch.independent.map_or(f64::NAN, |expected| expected.0)),
            ("cv_independent_standard_error", |patch| {
                patch.independent.map_or(f64::NAN, |expected| expected.1)
            }),
            ("cv_flown", |patch| patch.flown.map_or(f64::NAN, |patch| patch.0)),
            ("cv_flown_standard_error", |patch| patch.flown.map_or(f64::NAN, |patch| patch.1)),
            ("cv_surrogate", |patch| patch.surrogate.map_or(f64::NAN, |patch| patch.0)),
            ("cv_surrogate_standard_error", |patch| patch.surrogate.map_or(f64::NAN, |patch| patch.1)),
            ("cv_single_fibres", |patch| patch.single_fibres.0),
            ("cv_single_fibres_standard_error", |patch| patch.single_fibres.1),
            ("cv_straight_fibres", |patch| patch.straight_fibres),
        ];
        for (name, column) in columns {
            all.set_item(name, PyArray1::from_vec(py, patches.iter().map(column).collect()))?;
        }
        Ok(all)
    }

    /// Writes the folder that `spunlaid web` writes.
    fn save(&self, py: Python<'_>, path: PathBuf, force: bool, figures: Figures<'_>) -> PyResult<()> {
        save(py, (&path, force, figures), ENTRIES, |staging, watch| {
            self.folder().write(staging, watch.lay_control(None))
        })
    }
}
