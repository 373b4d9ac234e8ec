//! The tables of keys, and the program, which comes with the package.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use spunlaid::fibre::case::keys::{CASE, Key, KeyTable, Omission};
use spunlaid::ground::Removed;
use spunlaid::simulation::WEB;
use std::ffi::OsString;

/// Every key of a case or of a web: a dict for each. See spunlaid.keys, which calls it.
#[pyfunction]
#[pyo3(signature = (web = false))]
pub(crate) fn keys(py: Python<'_>, web: bool) -> PyResult<Bound<'_, PyList>> {
    let list = PyList::empty(py);
    if web {
        WEB.rows.iter().try_for_each(|key| list.append(about(py, &WEB, key)?))?;
    } else {
        CASE.rows.iter().try_for_each(|key| list.append(about(py, &CASE, key)?))?;
    }
    Ok(list)
}

/// What to do without a function or a class that the package had once, if it had one of this name.
#[pyfunction]
pub(crate) fn removed(name: &str) -> Option<String> {
    Removed::Python.fault(&format!("spunlaid.{name}")).map(|fault| fault.to_string())
}

/// The properties of a key.
fn about<'py, T>(py: Python<'py>, table: &KeyTable<T>, key: &Key<T>) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("name", key.name)?;
    dict.set_item("unit", key.dimension().map(|dimension| dimension.si_unit()))?;
    dict.set_item("allowed", key.allowed())?;
    dict.set_item("words", key.kind.words())?;
    dict.set_item("required", matches!(key.omission, Omission::Required(_)))?;
    let left_out = match key.omission {
        Omission::Required(example) => example.to_owned(),
        _ => table.left_out(key).replace('`', ""),
    };
    dict.set_item("left_out", left_out)?;
    dict.set_item("meaning", key.meaning)?;
    dict.set_item("synonyms", key.synonyms)?;
    dict.set_item("label", key.label)?;
    dict.set_item("varies", key.varies)?;
    dict.set_item("in_flight", key.in_flight)?;
    dict.set_item("usual", key.slider)?;
    Ok(dict)
}

/// Does what a command line asks for, as the program `spunlaid` does, and returns its exit code.
#[pyfunction]
#[pyo3(signature = (words))]
pub(crate) fn program(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| spunlaid_cli::main(words))
}
