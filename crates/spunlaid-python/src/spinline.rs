//! `solve_spinline`: from the hole of the spinneret to the solid filament, and `SolvedSpinline`, its results.

use crate::save::save;
use crate::value::overrides;
use crate::watched::guarded;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use spunlaid::case::Note;
use spunlaid::input::{Overrides, SpinFile, parse_spinline, read_spinline, write_spinline};
use spunlaid_results::folders::spinline::SpinFolder;
use spunlaid_results::output::spinline::{COLUMNS, ENTRIES, SpinResults, remarks};
use std::path::PathBuf;

/// A solved spinline. spunlaid.Spinline shows it.
#[pyclass(frozen, module = "spunlaid._spunlaid")]
#[derive(Debug)]
pub(crate) struct SolvedSpinline {
    name: String,
    file: SpinFile,
    results: SpinResults,
    notes: Vec<String>,
}

/// Solves a spinline. See spunlaid.spin, which calls it.
#[pyfunction]
#[pyo3(signature = (path, changes))]
pub(crate) fn solve_spinline(
    py: Python<'_>,
    path: Option<PathBuf>,
    changes: &Bound<'_, PyAny>,
) -> PyResult<SolvedSpinline> {
    let changes = overrides(changes)?;
    let set = Overrides { values: &changes, word: "spin:" };
    let (name, file) = match path {
        Some(path) => {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            (name, guarded(py, || read_spinline(&path, set))?)
        }
        None => ("spinline".to_owned(), guarded(py, || parse_spinline("", "spinline", set))?),
    };
    let results = guarded(py, || SpinResults::new(&file))?;
    let notes = [Note::of_results(&file.notes), remarks(&results.rows)].concat();
    Ok(SolvedSpinline { name, file, results, notes })
}

impl SolvedSpinline {
    fn folder(&self) -> SpinFolder<'_> {
        SpinFolder { name: &self.name, file: &self.file, results: &self.results, notes: &self.notes }
    }
}

#[pymethods]
impl SolvedSpinline {
    /// Text of summary.json.
    #[getter]
    fn summary(&self) -> String {
        self.folder().summary()
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// The spinline with every default written out, as a file.
    #[getter]
    fn text(&self) -> String {
        write_spinline(&self.file.spec)
    }

    /// The thread from the die to the end, for each row of the curtain: the columns of spinline.parquet.
    #[getter]
    fn stations<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let all = PyList::empty(py);
        for row in &self.results.rows {
            let columns = PyDict::new(py);
            for (name, value) in COLUMNS {
                let values: Vec<f64> = row.stations.iter().map(value).collect();
                columns.set_item(name, PyArray1::from_vec(py, values))?;
            }
            all.append(columns)?;
        }
        Ok(all)
    }

    /// The report, one page of HTML that works offline.
    fn report(&self, py: Python<'_>) -> String {
        py.detach(|| self.folder().report())
    }

    /// Writes the folder that `spunlaid spin` writes.
    #[pyo3(signature = (path, force, figures = None, figure_width = None))]
    fn save(
        &self,
        py: Python<'_>,
        path: PathBuf,
        force: bool,
        figures: Option<&Bound<'_, PyAny>>,
        figure_width: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        save(py, (&path, force), ENTRIES, [figures, figure_width], |staging, _| self.folder().write(staging))
    }
}
