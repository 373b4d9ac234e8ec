//! Warnings that the program prints, as warnings of Python.

use pyo3::prelude::*;
use pyo3::types::IntoPyDict;
use spunlaid::ground::Diagnostic;

/// Frames of Python from a function of Rust to the line of the user: the line calls it, or a function of
/// `python/spunlaid` does.
pub(crate) const CALLED: usize = 1;
const BELOW: usize = 2;

/// Warns of what may make results mislead; of notes it says nothing.
pub(crate) fn warn_of<'a>(py: Python<'_>, notes: impl IntoIterator<Item = &'a Diagnostic>) -> PyResult<()> {
    warn_of_at(py, BELOW, notes)
}

/// The same with the frames to the line of the user.
pub(crate) fn warn_of_at<'a>(
    py: Python<'_>,
    level: usize,
    notes: impl IntoIterator<Item = &'a Diagnostic>,
) -> PyResult<()> {
    let warnings = notes.into_iter().filter(|note| note.is_warning());
    warnings.into_iter().try_for_each(|note| warn_at(py, level, &note.key, &note.to_string()))
}

/// Warns of something that is about no key.
pub(crate) fn warn(py: Python<'_>, text: &str) -> PyResult<()> {
    warn_at(py, BELOW, "", text)
}

/// Warns with a `spunlaid.SpunlaidWarning`.
///
/// * `level` – frames to the line of the user
/// * `key` – that it is about; empty if it is about none
pub(crate) fn warn_at(py: Python<'_>, level: usize, key: &str, text: &str) -> PyResult<()> {
    let key = Some(key).filter(|key| !key.is_empty());
    let warning = py.import("spunlaid._errors")?.getattr("SpunlaidWarning")?.call1((text, key))?;
    let level = [("stacklevel", level)].into_py_dict(py)?;
    py.import("warnings")?.call_method("warn", (warning,), Some(&level)).map(drop)
}
