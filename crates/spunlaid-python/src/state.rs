//! Results of a run as plain values of Python, for pickling, and back.

use crate::failure::raised;
use crate::results::RunResults;
use crate::samples::Samples;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use spunlaid::chain::schemes::Scheme;
use spunlaid::ensemble::{
    Change, Curve, FinerCheck, FinerChecks, LostFibre, Number, Place, Refinement, Results, Shape, Statistic,
    Trajectory, Unchecked,
};
use spunlaid::flight::LaidPoint;
use spunlaid::input::{parse_case, write_case};
use spunlaid::lanes::Isa;
use spunlaid::observe::{DECLARED, Measure};
use spunlaid::statistics::Estimate;
use spunlaid::vec3::Vec3;
use spunlaid_results::output::summary::Performance;
use std::sync::Arc;

/// The function that makes the results again, and its argument.
pub(crate) fn reduced<'py>(py: Python<'py>, run: &RunResults) -> PyResult<Bound<'py, PyAny>> {
    let state = PyDict::new(py);
    state.set_item("name", &run.name)?;
    state.set_item("case", write_case(&run.case.with_files_at(full_path)))?;
    state.set_item("notes", &run.notes)?;
    state.set_item("lost", run.lost())?;
    let p = run.performance;
    state.set_item("performance", (p.wall_s, p.threads, p.element_steps, p.ns_per_element_step))?;
    for (name, check) in [("step_check", &run.checks.step), ("mesh_check", &run.checks.mesh)] {
        match check {
            Ok(check) => state.set_item(name, check_state(py, check)?)?,
            Err(why) => state.set_item(name, why.to_string())?,
        }
    }
    let numbers = PyList::empty(py);
    for number in &run.results.numbers {
        numbers.append((number.measure.name, estimate(py, &number.estimate)))?;
    }
    state.set_item("numbers", numbers)?;
    let curves = PyList::empty(py);
    for curve in &run.results.curves {
        let flat = curve.places.iter().flat_map(|place| {
            [place.at, place.mean, place.standard_error.unwrap_or(f64::NAN), place.largest]
        });
        curves.append((curve.measure.name, PyArray1::from_vec(py, flat.collect())))?;
    }
    state.set_item("curves", curves)?;
    let trajectories = PyList::empty(py);
    for trajectory in &run.results.trajectories {
        let shapes = PyList::empty(py);
        for shape in trajectory.shapes.iter() {
            let shape = shape.map_err(|error| raised(py, error))?;
            let flat = shape.position.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
            shapes.append((shape.time, PyArray1::from_vec(py, flat)))?;
        }
        trajectories.append((trajectory.replicate, shapes, points(py, &trajectory.laid)))?;
    }
    state.set_item("trajectories", trajectories)?;
    let curves = run.laid.iter().map(|curve| points(py, curve)).collect::<Vec<_>>();
    state.set_item("laid", curves)?;
    if let Some(samples) = &run.samples {
        let columns: Vec<_> = samples.columns.iter().map(|column| column.clone_ref(py)).collect();
        state.set_item("samples", (samples.times.clone_ref(py), columns))?;
    }
    let make = py.import("spunlaid._spunlaid")?.getattr("flown_from")?;
    Ok((make, (state,)).into_pyobject(py)?.into_any())
}

/// The results that [`reduced`] wrote.
#[pyfunction]
pub(crate) fn flown_from(py: Python<'_>, state: &Bound<'_, PyDict>) -> PyResult<RunResults> {
    let need = |key: &str| {
        state
            .get_item(key)?
            .ok_or_else(|| PyValueError::new_err(format!("these are not the results of a run: no {key}")))
    };
    let text: String = need("case")?.extract()?;
    let (case, _) = crate::watched::guarded(py, || parse_case(&text, "case.toml", &[]))?;
    let (wall_s, threads, element_steps, ns_per_element_step) = need("performance")?.extract()?;
    let instruction_set = Isa::detect().name();
    let performance = Performance { wall_s, threads, element_steps, ns_per_element_step, instruction_set };
    let checked = |name: &str, refined: Refinement| -> PyResult<Result<FinerCheck, Unchecked>> {
        let state = need(name)?;
        match state.extract::<String>() {
            Ok(why) => Ok(Err(Unchecked::Other(why))),
            Err(_) => check_of(&state, refined).map(Ok),
        }
    };
    let checks = FinerChecks {
        step: checked("step_check", Refinement::TimeStep)?,
        mesh: checked("mesh_check", Refinement::Elements)?,
    };
    let lost: Vec<(u64, f64, String)> = need("lost")?.extract()?;
    let lost =
        lost.into_iter().map(|(number, time, reason)| LostFibre { replicate: number - 1, time, reason });
    let mut results =
        Results { numbers: Vec::new(), curves: Vec::new(), trajectories: Vec::new(), lost: lost.collect() };
    let numbers: Vec<(String, EstimateState)> = need("numbers")?.extract()?;
    for (name, estimate) in numbers {
        results.numbers.push(Number { measure: measure(&name)?, estimate: restored_estimate(estimate)? });
    }
    let curves: Vec<(String, PyReadonlyArray1<'_, f64>)> = need("curves")?.extract()?;
    for (name, flat) in curves {
        let places = flat.as_slice()?.chunks_exact(4).map(|row| Place {
            at: row[0],
            mean: row[1],
            standard_error: Some(row[2]).filter(|error| !error.is_nan()),
            largest: row[3],
        });
        results.curves.push(Curve { measure: measure(&name)?, places: places.collect() });
    }
    type TrajectoryState<'py> = (u64, Vec<(f64, PyReadonlyArray1<'py, f64>)>, PyReadonlyArray2<'py, f64>);
    let trajectories: Vec<TrajectoryState<'_>> = need("trajectories")?.extract()?;
    let samples = match state.get_item("samples")? {
        Some(samples) => {
            let (times, columns): (Bound<'_, PyArray1<f64>>, Vec<Bound<'_, PyArray2<f64>>>) =
                samples.extract()?;
            let columns = columns.into_iter().map(Bound::unbind).collect();
            Some(Samples { times: times.unbind(), columns })
        }
        None => None,
    };
    for (replicate, shapes, laid) in trajectories {
        let shape = |(time, flat): (f64, PyReadonlyArray1<'_, f64>)| -> PyResult<Shape> {
            let vectors =
                flat.as_slice()?.chunks_exact(3).map(|vector| Vec3::new(vector[0], vector[1], vector[2]));
            Ok(Shape { time, position: vectors.collect() })
        };
        let recorded = samples.as_ref().map(|samples| samples.borrowed(py).samples(replicate as usize));
        results.trajectories.push(Trajectory {
            replicate,
            values: Vec::new(),
            samples: Vec::new(),
            path: recorded.iter().flatten().collect(),
            shapes: shapes.into_iter().map(shape).collect::<PyResult<_>>()?,
            laid: points_of(&laid),
        });
    }
    let laid: Vec<PyReadonlyArray2<'_, f64>> = need("laid")?.extract()?;
    Ok(RunResults {
        name: need("name")?.extract()?,
        case: Arc::new(case),
        results,
        checks,
        notes: need("notes")?.extract()?,
        performance,
        samples,
        laid: laid.iter().map(points_of).collect(),
    })
}

/// A check as plain values.
fn check_state<'py>(py: Python<'py>, check: &FinerCheck) -> PyResult<Bound<'py, PyDict>> {
    let state = PyDict::new(py);
    let FinerCheck { time_step, element_length, duration, replicates, share_of_run, .. } = *check;
    state.set_item("scheme", check.scheme.name())?;
    state.set_item("numbers", (time_step, element_length, duration, replicates, share_of_run))?;
    state.set_item("kind", (check.is_fed, check.is_resolved))?;
    state.set_item("path", check.path.as_ref().map(|path| estimate(py, path)))?;
    let changes = check.changes.iter().map(|change| {
        let quarter = change.from_quarter.as_ref().map(|(length, found)| (*length, estimate(py, found)));
        (change.statistic.name, estimate(py, &change.estimate), quarter, change.is_second_order)
    });
    state.set_item("changes", changes.collect::<Vec<_>>())?;
    Ok(state)
}

/// The check that [`check_state`] wrote.
fn check_of(state: &Bound<'_, PyAny>, refined: Refinement) -> PyResult<FinerCheck> {
    let name: String = state.get_item("scheme")?.extract()?;
    let scheme = Scheme::ALL.into_iter().find(|scheme| scheme.name() == name);
    let (time_step, element_length, duration, replicates, share_of_run) =
        state.get_item("numbers")?.extract()?;
    let (is_fed, is_resolved) = state.get_item("kind")?.extract()?;
    let path: Option<EstimateState<'_>> = state.get_item("path")?.extract()?;
    let changes: Vec<ChangeState<'_>> = state.get_item("changes")?.extract()?;
    let changes = changes.into_iter().map(|(name, estimate, quarter, is_second_order)| {
        let statistic = Statistic::all().find(|statistic| statistic.name == name);
        let statistic = statistic.ok_or_else(|| unknown("statistic", &name))?;
        let from_quarter =
            quarter.map(|(length, found)| PyResult::Ok((length, restored_estimate(found)?))).transpose()?;
        Ok(Change { statistic, estimate: restored_estimate(estimate)?, from_quarter, is_second_order })
    });
    Ok(FinerCheck {
        refined,
        scheme: scheme.ok_or_else(|| unknown("scheme", &name))?,
        time_step,
        element_length,
        is_fed,
        is_resolved,
        duration,
        replicates,
        share_of_run,
        path: path.map(restored_estimate).transpose()?,
        changes: changes.collect::<PyResult<_>>()?,
    })
}

/// Name, estimate, element length and estimate of the second refinement, and whether both show the second order.
type ChangeState<'py> = (String, EstimateState<'py>, Option<(f64, EstimateState<'py>)>, bool);
/// Mean, standard error and values.
type EstimateState<'py> = (f64, Option<f64>, PyReadonlyArray1<'py, f64>);

fn estimate<'py>(py: Python<'py>, estimate: &Estimate) -> (f64, Option<f64>, Bound<'py, PyArray1<f64>>) {
    (estimate.mean, estimate.standard_error, PyArray1::from_slice(py, &estimate.values))
}

fn restored_estimate((mean, standard_error, values): EstimateState<'_>) -> PyResult<Estimate> {
    Ok(Estimate { mean, standard_error, values: values.as_slice()?.to_vec() })
}

fn measure(name: &str) -> PyResult<&'static Measure> {
    let mut all = DECLARED.iter().flat_map(|declaration| declaration.measures);
    all.find(|measure| measure.name == name).ok_or_else(|| unknown("measure", name))
}

fn unknown(what: &str, name: &str) -> PyErr {
    PyValueError::new_err(format!("this version of spunlaid has no {what} {name}"))
}

fn points<'py>(py: Python<'py>, curve: &[LaidPoint]) -> Bound<'py, PyArray2<f64>> {
    let flat: Vec<f64> = curve.iter().flat_map(|p| [p.fed, p.time, p.md, p.cd]).collect();
    let array = numpy::ndarray::Array2::from_shape_vec((curve.len(), 4), flat).unwrap_or_default();
    PyArray2::from_owned_array(py, array)
}

fn points_of(array: &PyReadonlyArray2<'_, f64>) -> Vec<LaidPoint> {
    let rows = array.as_array();
    let laid_point = |row: numpy::ndarray::ArrayView1<'_, f64>| LaidPoint {
        fed: row[0],
        time: row[1],
        md: row[2],
        cd: row[3],
    };
    if rows.ncols() == 4 { rows.rows().into_iter().map(laid_point).collect() } else { Vec::new() }
}

/// The full path of a file, so that it is found from any folder.
pub(crate) fn full_path(file: &std::path::Path) -> std::path::PathBuf {
    std::path::absolute(file).unwrap_or_else(|_| file.to_owned())
}
