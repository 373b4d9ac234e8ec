//! The tables of keys and of measures, and the program, which comes with the package.

use crate::value::scale;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use spunlaid::fibre::case::keys::{CASE, Key, KeyTable, Omission};
use spunlaid::ground::units::udunits;
use spunlaid::simulation::{FibreMeasure, MEASURES, WEB};
use spunlaid_results::reports::run::unit_of_column;
use spunlaid_results::reports::study::Scale;
use std::ffi::OsString;

/// Every key of a case or of a web: the fields of `spunlaid.Key`. See spunlaid.keys, which calls it.
#[pyfunction]
#[pyo3(signature = (web = false))]
pub(crate) fn keys(py: Python<'_>, web: bool) -> PyResult<Vec<Bound<'_, PyTuple>>> {
    if web {
        WEB.rows.iter().map(|key| about(py, &WEB, key)).collect()
    } else {
        CASE.rows.iter().map(|key| about(py, &CASE, key)).collect()
    }
}

/// The properties of a key.
fn about<'py, T>(py: Python<'py>, table: &KeyTable<T>, key: &Key<T>) -> PyResult<Bound<'py, PyTuple>> {
    let unit = key.dimension().map(|dimension| dimension.si_unit());
    let (left_out, required) = match key.omission {
        Omission::Required(example) => (example.to_owned(), true),
        _ => (table.left_out(key).replace('`', ""), false),
    };
    let takes = (key.name, unit, key.allowed(), key.kind.words(), required, left_out);
    let means = (key.meaning, key.synonyms, key.label, key.varies, key.in_flight, key.slider);
    takes.into_pyobject(py)?.add(means)?.cast_into().map_err(PyErr::from)
}

/// Does what a command line asks for, as the program `spunlaid` does, and returns its exit code.
#[pyfunction]
#[pyo3(signature = (words))]
pub(crate) fn program(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| spunlaid_cli::main(words))
}

/// Name and meaning of a measure, and the scales of its axes: of a curve along and up.
pub(crate) fn described<'py>(py: Python<'py>, measure: &FibreMeasure) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("column", measure.column)?;
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
pub(crate) fn measures(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
    MEASURES.iter().map(|measure| described(py, measure)).collect()
}

/// The unit of a column of the free end or of the energies.
#[pyfunction]
pub(crate) fn column_unit(name: &str) -> String {
    udunits(unit_of_column(name))
}
