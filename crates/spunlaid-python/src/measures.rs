//! Measures of runs and columns of their tables, as Python has them.

use crate::value::scale;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use spunlaid::ground::units::udunits;
use spunlaid::simulation::{FibreMeasure, MEASURES};
use spunlaid_results::products::run::unit_of_column;
use spunlaid_results::products::study::Scale;

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
