//! `fly`: flies a case, and what can be asked of its results.

use crate::case::Case;
use crate::failure::raised;
use crate::flight::laid_columns;
use crate::samples::{SampleCollector, Samples, locked};
use crate::save::{Figures, page, save};
use crate::value::scale;
use crate::watched::{Watch, watched};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use spunlaid::fibre::{LaidPoint, Note};
use spunlaid::ground::threads::{lock, unlock};
use spunlaid::ground::units::udunits;
use spunlaid::ground::{Error, WIDTH};
use spunlaid::simulation::ensemble::{fly_for_checks, nothing_kept};
use spunlaid::simulation::{
    FinerCheck, FinerChecks, FinerPlans, Keep, KeepShapes, LaidCurves, LostFibre, MEASURES, Measure,
    Recorder, Results, RunControl, Trajectory, Unchecked,
};
use spunlaid_results::figures::Scale;
use spunlaid_results::folders::Contents;
use spunlaid_results::folders::run::{self as folder, POSITIONS};
use spunlaid_results::output::doubt;
use spunlaid_results::output::flown::{Flights, Tables};
use spunlaid_results::output::summary::Performance;
use spunlaid_results::output::tables::unit_of_column;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, OnceLock};
use std::time::Instant;

/// Number of trajectories that are kept whole, for the report.
const KEPT: usize = WIDTH;

/// Results of a run. `spunlaid.Run` shows them.
#[pyclass(frozen, module = "spunlaid._spunlaid")]
#[derive(Debug)]
pub(crate) struct RunResults {
    name: String,
    case: Arc<spunlaid::fibre::Case>,
    results: Results,
    checks: FinerChecks,
    #[pyo3(get)]
    notes: Vec<String>,
    performance: Performance,
    samples: Option<Samples>,
    laid: Vec<Vec<LaidPoint>>,
}

/// Flies a case. See spunlaid.run, which calls it.
#[pyfunction]
#[pyo3(signature = (case, threads = None, progress = None, check_step = true, samples = true, shapes = true))]
pub(crate) fn fly(
    py: Python<'_>,
    case: &Case,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
    check_step: bool,
    samples: bool,
    shapes: bool,
) -> PyResult<RunResults> {
    let (description, notes) = case.settled(py, threads)?;
    let run = description.run;
    let plans =
        if check_step { FinerPlans::for_case(&description) } else { FinerPlans::none(Unchecked::NotAsked) };
    let watch = Watch::new(run.steps.saturating_mul(run.replicates));
    let belt = LaidCurves::default();
    let recorder = description.line.is_some().then_some(&belt as &dyn Recorder);
    let computing = RunControl { recorder, ..watch.run_control(threads) };
    let (started, checks) = (Instant::now(), Mutex::new(plans.before_flight()));
    let (results, paths, collected) = watched(py, &watch, progress.as_ref(), || {
        let shapes = if shapes { KeepShapes::within(&description, POSITIONS) } else { KeepShapes::NONE };
        let (mut collector, mut collected) = (Results::collector(KEPT), SampleCollector::default());
        let take = |landed: Result<Trajectory, LostFibre>| {
            match landed {
                Ok(mut trajectory) => {
                    if samples {
                        collected.take(&std::mem::take(&mut trajectory.samples));
                    }
                    collector.take(trajectory);
                }
                Err(lost) => {
                    if samples {
                        collected.lose();
                    }
                    collector.lose(lost);
                }
            }
            Ok::<(), Error>(())
        };
        let keep = Keep { samples, shapes, ..Keep::CURVES };
        let paths = fly_for_checks(&description, &plans, keep, computing, nothing_kept, take)?;
        Ok((collector.finish(), paths, collected))
    })?;
    let performance = folder::performance(&description, &results, computing, started.elapsed().as_secs_f64());
    watch.begin(plans.fibre_steps());
    let flown = watched(py, &watch, progress.as_ref().filter(|_| plans.all().next().is_some()), || {
        *lock(&checks) = plans.check(&paths, RunControl { recorder: None, ..computing });
        Ok(())
    });
    // What was flown is kept: a check that Ctrl-C stops says so in its place.
    flown
        .or_else(|ended| if ended.is_instance_of::<PyKeyboardInterrupt>(py) { Ok(()) } else { Err(ended) })?;
    let checks = unlock(checks);
    let mut notes = Note::notes_of_results(&notes);
    notes.extend(folder::lost(&results.lost, description.run.replicates));
    notes.extend(folder::outside(&results));
    notes.extend(folder::coarse_shapes(&description, &results));
    notes.extend(doubt::notes(&checks, &description));
    let is_lost = |replicate| results.lost.iter().any(|fibre| fibre.replicate == replicate);
    let curves = (0..if description.line.is_some() { run.replicates } else { 0 })
        .map(|replicate| if is_lost(replicate) { Vec::new() } else { belt.take(replicate) })
        .collect();
    let samples = if samples { Some(collected.into_numpy(py)?) } else { None };
    Ok(RunResults {
        name: case.stem(),
        case: description,
        results,
        checks,
        notes,
        performance,
        samples,
        laid: curves,
    })
}

impl RunResults {
    fn folder(&self) -> folder::Run<'_> {
        folder::Run {
            name: &self.name,
            case: &self.case,
            results: &self.results,
            checks: &self.checks,
            notes: &self.notes,
            performance: self.performance,
            drawn: OnceLock::new(),
        }
    }

    fn table<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyDict>> {
        let columns = PyDict::new(py);
        if let Some(samples) = &self.samples {
            for (column, values) in samples.table(py, name, self.case.line.is_some())? {
                columns.set_item(column, values)?;
            }
        }
        Ok(columns)
    }
}

#[pymethods]
impl RunResults {
    /// Text of summary.json.
    #[getter]
    fn summary(&self) -> String {
        self.folder().summary()
    }

    /// The fibres that were lost: replicate, counted from 1, time and reason of each.
    #[getter]
    fn lost(&self) -> Vec<(u64, f64, String)> {
        let lost = self.results.lost.iter();
        lost.map(|fibre| (fibre.replicate + 1, fibre.time, fibre.reason.clone())).collect()
    }

    /// Columns of the free ends: times, or replicates x times.
    #[getter]
    fn end_node<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.table(py, "end_node.parquet")
    }

    /// Columns of the energies, likewise.
    #[getter]
    fn energy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.table(py, "energy.parquet")
    }

    /// The measures that are numbers: a dict for each.
    #[getter]
    fn numbers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let all = PyList::empty(py);
        for number in &self.results.numbers {
            let dict = described(py, number.measure)?;
            dict.set_item("mean", number.estimate.mean)?;
            dict.set_item("standard_error", number.estimate.standard_error)?;
            let whole = doubt::with_error_of_checks(
                number.estimate.clone(),
                number.measure.name,
                &self.checks,
                &self.case,
            );
            dict.set_item("error", whole.standard_error)?;
            dict.set_item("shown", number.value())?;
            let values = PyArray1::from_slice(py, &number.estimate.values);
            dict.set_item("values", locked(values.as_any())?)?;
            all.append(dict)?;
        }
        Ok(all)
    }

    /// The measures that are curves: a dict for each.
    #[getter]
    fn curves<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let all = PyList::empty(py);
        for curve in &self.results.curves {
            let dict = described(py, curve.measure)?;
            let column = |quantity: &dyn Fn(&spunlaid::simulation::Place) -> f64| {
                locked(PyArray1::from_vec(py, curve.places.iter().map(quantity).collect()).as_any())
            };
            dict.set_item("at", column(&|place| place.at)?)?;
            dict.set_item("mean", column(&|place| place.mean)?)?;
            dict.set_item("standard_error", column(&|place| place.standard_error.unwrap_or(f64::NAN))?)?;
            dict.set_item("largest", column(&|place| place.largest)?)?;
            all.append(dict)?;
        }
        Ok(all)
    }

    /// Times, and positions of all nodes: replicates x times x nodes x 3, NaN where a fibre has fewer nodes.
    #[getter]
    fn shapes<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let trajectories: Vec<&Trajectory> =
            self.results.trajectories.iter().filter(|trajectory| !trajectory.shapes.is_empty()).collect();
        let count = trajectories.first().map_or(0, |trajectory| trajectory.shapes.len());
        let nodes = trajectories.iter().map(|trajectory| trajectory.shapes.most_nodes()).max().unwrap_or(0);
        let mut times = Vec::with_capacity(trajectories.len() * count);
        let mut flat = Vec::with_capacity(trajectories.len() * count * nodes * 3);
        for shape in trajectories.iter().flat_map(|trajectory| trajectory.shapes.iter()) {
            let shape = shape.map_err(|error| raised(py, error))?;
            times.push(shape.time);
            flat.extend(shape.position.iter().flat_map(|p| [p.x, p.y, p.z]));
            flat.extend(std::iter::repeat_n(f64::NAN, 3 * (nodes - shape.position.len())));
        }
        times.truncate(count);
        let shape = [trajectories.len(), count, nodes, 3];
        let positions = PyArray1::from_vec(py, flat).reshape(shape)?;
        Ok((locked(PyArray1::from_vec(py, times).as_any())?, locked(positions.as_any())?))
    }

    /// What each replicate laid on the belt: fed length, time, place along and across the belt.
    #[getter]
    fn laid<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let all = PyList::empty(py);
        for points in &self.laid {
            all.append(laid_columns(py, points)?)?;
        }
        Ok(all)
    }

    /// The report, a page of HTML.
    fn report(&self, py: Python<'_>) -> PyResult<String> {
        page(py, &self.folder())
    }

    /// Writes the folder that `spunlaid run` writes.
    ///
    /// * whole: whether a run without samples, which has no tables, is refused
    #[pyo3(signature = (path, force, figures, whole = true))]
    fn save(
        &self,
        py: Python<'_>,
        path: PathBuf,
        force: bool,
        figures: Figures<'_>,
        whole: bool,
    ) -> PyResult<()> {
        if whole && self.samples.is_none() {
            let text = "the run was flown with samples=False, so its tables cannot be written";
            return Err(crate::failure::raised_as(py, "FolderError", text.to_owned()));
        }
        let samples = self.samples.as_ref().map(|samples| samples.borrowed(py).all());
        save(py, (&path, force, figures), &self.folder(), |staging| {
            let Some(samples) = samples else { return Ok(()) };
            let flights = Flights::open(staging, &self.case, None)?;
            let mut tables = Tables::create(staging, &flights)?;
            for (replicate, samples) in (0..).zip(samples) {
                if self.results.lost.iter().any(|fibre| fibre.replicate == replicate) {
                    continue;
                }
                let points = self.laid.get(replicate as usize).map_or(&[][..], Vec::as_slice);
                flights.samples(replicate, &samples)?;
                flights.lay(replicate, points)?;
                tables.add(replicate)?;
            }
            tables.finish()
        })
    }

    /// The shares that a finer time step changes.
    #[getter]
    fn step_check<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        self.checks.step.as_ref().ok().map(|check| differences(py, check)).transpose()
    }

    /// The shares that elements of half the length change.
    #[getter]
    fn mesh_check<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        self.checks.mesh.as_ref().ok().map(|check| differences(py, check)).transpose()
    }
}

/// What a finer discretisation changes, by name.
fn differences<'py>(py: Python<'py>, check: &FinerCheck) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("duration_s", check.duration)?;
    dict.set_item("share_of_run", check.share_of_run)?;
    for (name, difference, factor) in check.differences() {
        dict.set_item(&name, difference.mean)?;
        dict.set_item(format!("{name}_standard_error"), difference.standard_error)?;
        let statistic = name.trim_end_matches("_difference");
        dict.set_item(format!("{statistic}_error_over_difference"), factor)?;
    }
    Ok(dict)
}

/// Name and meaning of a measure, and the scales of its axes: of a curve along and up.
fn described<'py>(py: Python<'py>, measure: &Measure) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("column", measure.column)?;
    dict.set_item("name", measure.name)?;
    dict.set_item("label", measure.label)?;
    dict.set_item("meaning", measure.meaning)?;
    dict.set_item("group", measure.group.name)?;
    dict.set_item("unit", measure.unit.of_values())?;
    let scales = match Scale::from_curve(measure) {
        Some(scales) => scales.map(scale).to_vec(),
        None => vec![scale(Scale::from_quantity(measure.label, measure.unit))],
    };
    dict.set_item("scales", scales)?;
    Ok(dict)
}

/// The measures that are numbers: a dict for each.
#[pyfunction]
pub(crate) fn measures(py: Python<'_>) -> PyResult<Bound<'_, PyList>> {
    let all = PyList::empty(py);
    for measure in MEASURES {
        all.append(described(py, measure)?)?;
    }
    Ok(all)
}

/// The unit of a column of the free end or of the energies.
#[pyfunction]
pub(crate) fn column_unit(name: &str) -> String {
    udunits(unit_of_column(name))
}
