//! `solve_spinline`: from the hole of the spinneret to the solid filament, and `SolvedSpinline`, its results.

use crate::save::{Figures, page, save};
use crate::source::Source;
use crate::value::overrides;
use crate::watched::{guarded, settled};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use spunlaid::fibre::Note;
use spunlaid::ground::FileKind;
use spunlaid::input::{Overrides, SpinFile, parse_spinline, write_spinline};
use spunlaid_results::folders::Contents;
use spunlaid_results::folders::products::SpinFolder;
use spunlaid_results::output::spinline::{COLUMNS, SpinResults, remarks};
use std::path::PathBuf;

/// A solved spinline. spunlaid.Spinline shows it.
#[pyclass(frozen, module = "spunlaid._spunlaid")]
#[derive(Debug)]
pub(crate) struct SolvedSpinline {
    #[pyo3(get)]
    name: String,
    file: SpinFile,
    results: SpinResults,
    #[pyo3(get)]
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
    let set = Overrides::new(&changes, "spin:");
    let Source { name, text, file } = Source::read(py, path, FileKind::Case, "spinline")?;
    let file = settled(py, None, |resources| parse_spinline(&text, &file, set.with(resources)))?;
    let results = guarded(py, || SpinResults::new(&file))?;
    let notes = [Note::notes_of_results(&file.notes), remarks(&results.rows)].concat();
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
    fn report(&self, py: Python<'_>) -> PyResult<String> {
        page(py, &self.folder())
    }

    /// Writes the folder that `spunlaid spin` writes.
    fn save(&self, py: Python<'_>, path: PathBuf, force: bool, figures: Figures<'_>) -> PyResult<()> {
        save(py, (&path, force, figures), &self.folder(), |_| Ok(()))
    }
}
