//! `analyse`: the statistics of the air in a velocity record.

use crate::value::positive;
use crate::warning::warn;
use crate::watched::{Watch, watched};
use numpy::{PyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use spunlaid::air::record::{analyse as analysed, read_record};
use spunlaid::air::{Component, IntegralRule, Layout, Reading, Record, Samples, Settings};
use spunlaid::ground::{Dimension, Error};
use spunlaid_results::reports::record::{air_block, analysis_json};
use std::path::PathBuf;

/// What a record is read from.
enum Source {
    File(PathBuf, Layout),
    Array(Record),
}

/// Of a component: frequencies and the spectral density there, lags and the autocorrelation there.
type Curves<'py> = [Bound<'py, PyArray1<f64>>; 4];

/// Analyses a velocity record. See spunlaid.analyse, which calls it. The text of analysis.json and air.toml, and the
/// curves.
///
/// * `record` – the path of a file, or an array of samples x components
#[pyfunction]
#[pyo3(signature = (
    record, rate = None, mean_velocity = None, flat_until = None, integral = None, columns = Vec::new()
))]
pub(crate) fn analyse<'py>(
    py: Python<'py>,
    record: &Bound<'py, PyAny>,
    rate: Option<Bound<'py, PyAny>>,
    mean_velocity: Option<f64>,
    flat_until: Option<f64>,
    integral: Option<&str>,
    columns: Vec<String>,
) -> PyResult<(String, String, Vec<Curves<'py>>)> {
    let rule = |text: &str| match IntegralRule::parse(text) {
        Some(rule) => rule.map_err(|fault| format!("{text:?} {fault}")),
        None => Err(format!("{text:?} is not a rule; write \"first-zero\", \"e-fold\" or \"fixed=20 ms\"")),
    };
    let integral =
        integral.map(rule).transpose().map_err(|text| PyValueError::new_err(format!("integral = {text}")))?;
    let integral = integral.unwrap_or_default();
    let rate = rate.map(|rate| positive("rate", &rate, Dimension::Frequency)).transpose()?;
    for (name, value) in [("mean_velocity", mean_velocity), ("flat_until", flat_until)] {
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
    analysis.warnings.iter().try_for_each(|text| warn(py, &text.to_string()))?;
    let curves = |component: &Component| {
        let density = &component.spectrum.density;
        let coefficients = &component.autocorrelation.coefficients;
        let frequencies = (0..density.len()).map(|i| component.spectrum.frequency(i));
        let lags = (0..coefficients.len()).map(|i| i as f64 * analysis.interval);
        let [frequencies, lags] = [frequencies.collect(), lags.collect()].map(|x| PyArray1::from_vec(py, x));
        [frequencies, PyArray1::from_slice(py, density), lags, PyArray1::from_slice(py, coefficients)]
    };
    let curves = analysis.components.iter().map(curves).collect();
    Ok((analysis_json(&record, &analysis), air_block(&record.file, &analysis), curves))
}

fn source(record: &Bound<'_, PyAny>, rate: Option<f64>, columns: Vec<String>) -> PyResult<Source> {
    if let Ok(path) = record.extract::<PathBuf>() {
        return Ok(Source::File(path, Layout { rate, columns, ..Layout::default() }));
    }
    let array: PyReadonlyArray2<'_, f64> = record.extract()?;
    let rate =
        rate.ok_or_else(|| PyValueError::new_err("an array needs its sampling rate: rate = 20e3 [Hz]"))?;
    let columns = array.as_array();
    let named = ["u", "v", "w"].into_iter().zip(columns.columns());
    let components =
        named.map(|(name, values)| Samples { name: name.to_owned(), values: values.to_vec() }).collect();
    let (file, reading) = ("array".to_owned(), Reading::default());
    Ok(Source::Array(Record { file, interval: 1.0 / rate, components, reading }))
}
