//! `lay_web`: lays a web of many filaments, and `LaidWeb`, its results.

use crate::samples::locked;
use crate::save::{Figures, save};
use crate::source::Source;
use crate::value::overrides;
use crate::watched::{LOOK, Watch, settled, watched};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use spunlaid::experiment::advice::{advise, are_tried, steps};
use spunlaid::experiment::{Advice, Change};
use spunlaid::fibre::Note;
use spunlaid::ground::threads::look_while;
use spunlaid::ground::{Error, FileKind};
use spunlaid::input::{Changes, Overrides, WebFile, parse_changes, parse_web};
use spunlaid::simulation::observe::with_errors;
use spunlaid::simulation::{Flights, FlownWeb, Flyer, Measure, OF_PATCHES};
use spunlaid::web::map::Findings;
use spunlaid::web::{Fabric, LayControl, Map};
use spunlaid_results::Failure;
use spunlaid_results::folders::Contents;
use spunlaid_results::folders::web::{WebFolder, notes};
use spunlaid_results::output::web::{Performance, specification_sheet};
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

/// The file of a web, and what is tried with it once it has been laid.
#[derive(Debug)]
struct Asked {
    name: String,
    file: WebFile,
    advice: Option<Vec<Change>>,
    guesses: Option<Vec<Change>>,
}

impl Asked {
    /// * `advice`, `guesses` – whether they are tried
    fn read(
        py: Python<'_>,
        path: Option<PathBuf>,
        changes: &Bound<'_, PyAny>,
        [advice, guesses]: [bool; 2],
        threads: Option<usize>,
    ) -> PyResult<Self> {
        let changes = overrides(changes)?;
        let set = Overrides::new(&changes, "web:");
        let Source { name, text, file } = Source::read(py, path, FileKind::Web, "web")?;
        let read = |of| {
            settled(py, threads, |resources| parse_changes(text.clone(), &file, set.with(resources), of))
        };
        let advice = advice.then(|| read(Changes::OfLine)).transpose()?;
        let guesses = guesses.then(|| read(Changes::OfGuesses)).transpose()?;
        let file = settled(py, threads, |resources| parse_web(&text, &file, set.with(resources)))?;
        Ok(Self { name, file, advice, guesses })
    }

    /// Looks at a web, which is laid unless it has been, and tries what is asked for.
    ///
    /// * `started` – when the computation began
    fn find(
        &self,
        mut flown: FlownWeb,
        started: Instant,
        (watch, laying): (&Watch, LayControl<'_>),
    ) -> Result<LaidWeb, Failure> {
        watch.begin(flown.pieces()?);
        let findings = flown.find(laying)?;
        let spec = &self.file.spec;
        let compare = |changes: Vec<Change>| {
            watch.begin(steps(spec, &changes));
            advise(spec, (&flown.web, &findings), changes, None, (None, laying))
        };
        let guesses = self.guesses.clone().filter(|all| !all.is_empty() && are_tried(spec, &findings, all));
        let guesses = guesses.map(compare).transpose()?;
        let advice = self.advice.clone().map(compare).transpose()?;
        let performance = Performance::measure(started, laying.threads, laying.isa).with_flights(&findings);
        let of_results = notes(&flown, &findings);
        let fabric = spec.fabric(&flown.web, &findings, laying.threads);
        let notes = [Note::notes_of_results(&self.file.notes), of_results].concat();
        let (name, file) = (self.name.clone(), self.file.clone());
        Ok(LaidWeb { name, file, flown, findings, fabric, advice, guesses, notes, performance })
    }
}

/// What flies fibres while a watch looks on.
fn flown_while_watched<T>(
    watch: &Watch,
    laying: LayControl<'_>,
    fly: impl FnOnce(&mut Flyer<'_>) -> Result<T, Error>,
) -> Result<T, Error> {
    // The flights have a counter of their own; it is looked at while they fly.
    let follow = |Flights { done, steps, .. }: Flights<'_>, work: &mut (dyn FnMut() + Send)| {
        watch.total.store(steps, Ordering::Relaxed);
        let look = || watch.done.store(done.load(Ordering::Relaxed), Ordering::Relaxed);
        look_while(LOOK, look, work);
    };
    fly(&mut Flyer::new(laying.threads, laying.stop, &follow))
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
    let asked = Asked::read(py, path, changes, [advice, guesses], threads)?;
    let watch = Watch::default();
    watched(py, &watch, progress.as_ref(), || {
        let (started, laying) = (Instant::now(), watch.lay_control(threads));
        let flown = flown_while_watched(&watch, laying, |flyer| flyer.web(&asked.file.spec))?;
        asked.find(flown, started, (&watch, laying))
    })
}

/// Basis weight of every cell of a map [kg/m2], which cannot be written to.
pub(crate) fn weights<'py>(py: Python<'py>, map: &Map) -> PyResult<Bound<'py, PyAny>> {
    let weight = map.weight_of_quantum();
    let values = map.cells.iter().map(|cell| f64::from(*cell) * weight).collect();
    let array = PyArray1::from_vec(py, values).reshape([map.rows, map.columns])?;
    locked(array.as_any())
}

/// The numbers over patches by name: side of the patch [m], every declared number, and the ends of the 95 %
/// interval of the CV by chance. What is not known is NaN.
///
/// * `about` – side and interval of a patch
pub(crate) fn patch_columns<'py, P: 'static>(
    py: Python<'py>,
    patches: &[P],
    measures: &'static [Measure<P>],
    about: fn(&P) -> (f64, Option<[f64; 2]>),
) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    let put = |name: &str, number: &dyn Fn(&P) -> f64| {
        all.set_item(name, PyArray1::from_vec(py, patches.iter().map(number).collect()))
    };
    put("patch_m", &|patch| about(patch).0)?;
    for measure in with_errors(measures) {
        // The older name of these.
        let name = measure.entry().replace("one_fibre", "single_fibres");
        put(&name, &|patch| measure.number(patch))?;
    }
    for (end, name) in ["cv_low", "cv_high"].into_iter().enumerate() {
        put(name, &|patch| about(patch).1.map_or(f64::NAN, |ends| ends[end]))?;
    }
    Ok(all)
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
            beside: &self.name,
            awaited: false,
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

    /// The unevenness over patches: side of the patch [m], every declared number of them, and the ends of the
    /// 95 % interval of the CV by chance. What is not known is NaN.
    #[getter]
    fn patches<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        patch_columns(py, &self.findings.patches, OF_PATCHES, |patch| (patch.map.patch, patch.interval()))
    }

    /// The specification sheet, as PDF.
    fn specification<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let watch = Watch::default();
        let page = watched(py, &watch, None, || {
            specification_sheet(&self.name, (&self.findings, &self.fabric), &self.notes)
        })?;
        Ok(PyBytes::new(py, &page))
    }

    /// Writes the folder that `spunlaid web` writes.
    fn save(&self, py: Python<'_>, path: PathBuf, force: bool, figures: Figures<'_>) -> PyResult<()> {
        save(py, (&path, force, figures), &self.folder(), |_| Ok(()))
    }
}
