//! The tables of keys.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use spunlaid::case::keys::{Key, Omission, all};
use spunlaid::layers::WEB_KEYS;

/// Every key of a case or of a web: a dict for each. See spunlaid.keys, which calls it.
#[pyfunction]
#[pyo3(signature = (web = false))]
pub(crate) fn keys(py: Python<'_>, web: bool) -> PyResult<Bound<'_, PyList>> {
    let list = PyList::empty(py);
    if web {
        WEB_KEYS.iter().try_for_each(|key| list.append(about(py, key)?))?;
    } else {
        all().iter().try_for_each(|key| list.append(about(py, key)?))?;
    }
    Ok(list)
}

/// The properties of a key.
fn about<'py, T>(py: Python<'py>, key: &Key<T>) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("name", key.name)?;
    dict.set_item("unit", key.dimension().map(|dimension| dimension.si_unit()))?;
    dict.set_item("allowed", key.allowed())?;
    dict.set_item("words", key.kind.words())?;
    dict.set_item("required", matches!(key.omission, Omission::Required(_)))?;
    let (Omission::Required(text) | Omission::Value(text) | Omission::Follows(text)) = key.omission;
    dict.set_item("left_out", text)?;
    dict.set_item("meaning", key.meaning)?;
    dict.set_item("synonyms", key.synonyms)?;
    dict.set_item("label", key.label)?;
    dict.set_item("varies", key.varies)?;
    dict.set_item("in_flight", key.in_flight)?;
    dict.set_item("usual", key.slider)?;
    Ok(dict)
}
