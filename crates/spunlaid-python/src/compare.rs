//! `compare_folders`: the results of runs or of webs side by side, and `Compared`, what differs.

use crate::save::{Figures, page, save};
use crate::watched::guarded;
use pyo3::prelude::*;
use spunlaid_results::folders::Contents;
use spunlaid_results::folders::comparison::{ComparedFolders, Folders};
use std::path::PathBuf;

/// What a comparison has found. spunlaid.Comparison shows it.
#[pyclass(frozen, module = "spunlaid._spunlaid")]
#[derive(Debug)]
pub(crate) struct Compared {
    found: ComparedFolders,
    #[pyo3(get)]
    name: String,
}

/// Compares folders. See spunlaid.compare, which calls it.
#[pyfunction]
pub(crate) fn compare_folders(py: Python<'_>, folders: Vec<PathBuf>) -> PyResult<Compared> {
    guarded(py, || {
        let folders = Folders::new(&folders)?;
        Ok(Compared { found: folders.compare()?, name: folders.joined() })
    })
}

#[pymethods]
impl Compared {
    /// Text of comparison.json.
    #[getter]
    fn summary(&self) -> String {
        self.found.summary()
    }

    /// What is missing, and why.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.found.notes().to_vec()
    }

    /// The report, one page of HTML that works offline.
    fn report(&self, py: Python<'_>) -> PyResult<String> {
        page(py, &self.found)
    }

    /// Writes the folder that `spunlaid compare` writes.
    fn save(&self, py: Python<'_>, path: PathBuf, force: bool, figures: Figures<'_>) -> PyResult<()> {
        save(py, (&path, force, figures), &self.found, |_| Ok(()))
    }
}
