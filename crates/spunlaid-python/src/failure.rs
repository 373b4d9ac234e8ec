//! Errors of the library as exceptions of Python; their classes are in `python/spunlaid/_errors.py`.

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use spunlaid::ground::error::Place;
use spunlaid::ground::{Diagnostic, Error, Position};
use spunlaid::input::StudyFile;
use std::any::Any;

/// An error as the exception that a Python user gets.
pub(crate) fn raised(py: Python<'_>, error: impl Into<Error>) -> PyErr {
    let error = error.into();
    let text = error.to_string();
    let made = match &error {
        Error::Rejected(problems) => {
            listed(py, problems).and_then(|problems| instance(py, "CaseError", (text, problems)))
        }
        Error::File(_) => instance(py, "FileError", (text,)),
        Error::Diverged { .. } | Error::NotLanding { .. } => instance(py, "FibreLost", (text,)),
        Error::Flight(_) => instance(py, "FlightError", (text,)),
        Error::Interrupted => instance(py, "Interrupted", (text,)),
        _ => instance(py, "FolderError", (text,)),
    };
    made.unwrap_or_else(|error| error)
}

/// What was read of texts that this package has made of dicts, under these names. The user did not write
/// their lines, so no error and no note reports one.
pub(crate) fn without_lines(read: Result<StudyFile, Error>, made: &[&str]) -> Result<StudyFile, Error> {
    let clear = |place: &mut Place| {
        if let Place::File { file, position, .. } = place
            && made.contains(&file.as_str())
        {
            *position = Position::Whole;
        }
    };
    match read {
        Ok(mut study) => {
            study.notes.iter_mut().for_each(|remark| clear(&mut remark.note.place));
            Ok(study)
        }
        Err(Error::Rejected(mut problems)) => {
            problems.iter_mut().for_each(|problem| clear(&mut problem.place));
            Err(Error::Rejected(problems))
        }
        Err(other) => Err(other),
    }
}

/// A panic, which is a fault of the library: an exception too, so that no session is lost.
pub(crate) fn raised_of_panic(py: Python<'_>, panic: &(dyn Any + Send)) -> PyErr {
    let message = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let message = message.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
    let text = format!("a fault of spunlaid itself: {message}; please report it with the case");
    instance(py, "InternalError", (text,)).unwrap_or_else(|error| error)
}

/// An exception of this package by the name of its class.
pub(crate) fn raised_as(py: Python<'_>, class: &str, text: String) -> PyErr {
    instance(py, class, (text,)).unwrap_or_else(|error| error)
}

fn instance<'py, A>(py: Python<'py>, class: &str, arguments: A) -> PyResult<PyErr>
where
    A: pyo3::call::PyCallArgs<'py>,
{
    let class = py.import("spunlaid._errors")?.getattr(class)?;
    Ok(PyErr::from_value(class.call1(arguments)?))
}

/// Problems as the fields of `spunlaid.Diagnostic`.
fn listed<'py>(py: Python<'py>, problems: &[Diagnostic]) -> PyResult<Vec<Bound<'py, PyTuple>>> {
    let fields = |problem: &Diagnostic| {
        let Diagnostic { key, value, cause, place, .. } = problem;
        let text = problem.to_string();
        let file = match place {
            Place::File { file, .. } | Place::Point { study: file, .. } => Some(file),
            Place::Code | Place::Override(_) => None,
        };
        let [key, remedy] = [&**key, &*cause.remedy].map(|text| Some(text).filter(|text| !text.is_empty()));
        (key, value, &*cause.message, remedy, file, place.line(), place.column(), text).into_pyobject(py)
    };
    problems.iter().map(fields).collect()
}
