//! The table of keys.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use spunlaid::case::keys::{LeftOut, all};

/// Every key of a case: a dict for each. See spunlaid.keys, which calls it.
#[pyfunction]
pub(crate) fn keys(py: Python<'_>) -> PyResult<Bound<'_, PyList>> {
    let list = PyList::empty(py);
    for key in all() {
        let of = PyDict::new(py);
        of.set_item("name", key.name)?;
        of.set_item("unit", key.dimension().map(|dimension| dimension.si_unit()))?;
        of.set_item("allowed", key.allowed())?;
        of.set_item("words", key.kind.words())?;
        of.set_item("required", matches!(key.left_out, LeftOut::Required(_)))?;
        let (LeftOut::Required(text) | LeftOut::Value(text) | LeftOut::Follows(text)) = key.left_out;
        of.set_item("left_out", text)?;
        of.set_item("meaning", key.meaning)?;
        of.set_item("label", key.label)?;
        of.set_item("varies", key.varies)?;
        of.set_item("in_flight", key.in_flight)?;
        of.set_item("usual", key.slider)?;
        list.append(of)?;
    }
    Ok(list)
}
