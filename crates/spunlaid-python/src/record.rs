//! `analyse`: the statistics of the air in a velocity record.

use crate::watched::{Watch, watched};
use numpy::{PyArray1, PyReadonlyArrayDyn};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use spunlaid::air::record::{analyse as analysed, read_record};
use spunlaid::air::{Analysis, IntegralRule, Layout, Reading, Record, Samples, Settings};
use spunlaid::ground::{Error, Spectrum};
use spunlaid_results::output::analysis::{air_block, analysis_json};
use std::path::PathBuf;

/// What a record is read from.
enum Source {
    File(PathBuf, Layout),
    Array(Record),
}

/// Analyses a velocity record. See spunlaid.analyse, which calls it.
#[pyfunction]
#[pyo3(signature = (record, rate = None, mean_velocity = None, flat_until = None, integral = None, columns = Vec::new()))]
pub(crate) fn analyse<'py>(
    py: Python<'py>,
    record: &Bound<'py, PyAny>,
    rate: Option<f64>,
    mean_velocity: Option<f64>,
    flat_until: Option<f64>,
    integral: Option<&str>,
    columns: Vec<String>,
) -> PyResult<Bound<'py, PyDict>> {
    let integral = match integral {
        Some(text) => match IntegralRule::parse(text) {
            Some(Ok(rule)) => rule,
            Some(Err(fault)) => return Err(PyValueError::new_err(format!("integral = {text:?} {fault}"))),
            None => {
                let text = format!(
                    "integral = {text:?} is not a rule; write \"first-zero\", \"e-fold\" or \"fixed=20 ms\""
                );
                return Err(PyValueError::new_err(text));
            }
        },
        None => IntegralRule::default(),
    };
    for (name, value) in [("rate", rate), ("mean_velocity", mean_velocity), ("flat_until", flat_until)] {
        let positive = name != "mean_velocity";
        if value.is_some_and(|value| !value.is_finite() || positive && value <= 0.0) {
            return Err(PyValueError::new_err(format!(
                "{name} must be a {}finite number",
                if positive { "positive " } else { "" }
            )));
        }
    }
    let settings = Settings { integral, flat_until, mean_velocity, ..Settings::default() };
    let source = source(record, rate, columns)?;
    let (record, analysis) = watched(py, &Watch::default(), None, || {
        let record = match source {
            Source::File(path, layout) => read_record(&path, &layout).map_err(Error::File)?,
            Source::Array(record) => record,
        };
        let analysis = analysed(&record, &settings).map_err(Error::File)?;
        Ok((record, analysis))
    })?;
    results(py, &record, &analysis)
}

fn source(record: &Bound<'_, PyAny>, rate: Option<f64>, columns: Vec<String>) -> PyResult<Source> {
    if let Ok(path) = record.extract::<PathBuf>() {
        return Ok(Source::File(path, Layout { rate, columns, ..Layout::default() }));
    }
    let array = record.py().import("numpy")?.call_method1("asarray", (record, "float64")).map_err(|_| {
        PyTypeError::new_err(
            "a record is the path of a file, or an array of velocities [m/s]: samples, or \
            samples x components",
        )
    })?;
    let array: PyReadonlyArrayDyn<'_, f64> = array.extract()?;
    let array = array.as_array();
    let rate =
        rate.ok_or_else(|| PyValueError::new_err("an array needs its sampling rate: rate = 20e3 [Hz]"))?;
    let columns: Vec<Vec<f64>> = match array.shape() {
        [_] => vec![array.iter().copied().collect()],
        [samples, components @ 1..=3] => {
            let (samples, components) = (*samples, *components);
            (0..components).map(|c| (0..samples).map(|i| array[[i, c]]).collect()).collect()
        }
        shape => {
            return Err(PyValueError::new_err(format!(
                "an array of velocities has the shape (samples,) or (samples, 1 to 3 components), not {shape:?}"
            )));
        }
    };
    if let Some(at) =
        columns[0].iter().enumerate().position(|(i, _)| columns.iter().any(|c| !c[i].is_finite()))
    {
        let text =
            format!("sample {at} is not finite; interpolate it, or take a part of the record without gaps");
        return Err(PyValueError::new_err(text));
    }
    let named = columns.into_iter().zip(["u", "v", "w"]);
    let components = named.map(|(values, name)| Samples { name: name.to_owned(), values }).collect();
    let (file, reading) = ("array".to_owned(), Reading::default());
    Ok(Source::Array(Record { file, interval: 1.0 / rate, components, reading }))
}

/// The text of analysis.json and air.toml, and the curves.
fn results<'py>(py: Python<'py>, record: &Record, analysis: &Analysis) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    all.set_item("json", analysis_json(record, analysis))?;
    all.set_item("air_toml", air_block(&record.file, analysis))?;
    let curves = PyList::empty(py);
    for component in &analysis.components {
        let curve = PyDict::new(py);
        let Spectrum { step, density, .. } = &component.spectrum;
        let frequencies = (0..density.len()).map(|i| (i + 1) as f64 * step).collect();
        curve.set_item("frequency_hz", PyArray1::from_vec(py, frequencies))?;
        curve.set_item("density", PyArray1::from_slice(py, density))?;
        let values = &component.autocorrelation.coefficients;
        let lags = (0..values.len()).map(|i| i as f64 * analysis.interval).collect();
        curve.set_item("lag_s", PyArray1::from_vec(py, lags))?;
        curve.set_item("autocorrelation", PyArray1::from_slice(py, values))?;
        curves.append(curve)?;
    }
    all.set_item("curves", curves)?;
    Ok(all)
}
