//! What a run has flown.

use crate::samples::Samples;
use pyo3::prelude::*;
use spunlaid::ensemble::{FinerChecks, Results};
use spunlaid::flight::LaidPoint;
use spunlaid_results::output::summary::Performance;
use std::sync::Arc;

/// Results of a run. `spunlaid.Run` shows them.
#[pyclass(frozen, module = "spunlaid._spunlaid")]
#[derive(Debug)]
pub(crate) struct RunResults {
    pub(crate) name: String,
    pub(crate) case: Arc<spunlaid::case::Case>,
    pub(crate) results: Results,
    pub(crate) checks: FinerChecks,
    #[pyo3(get)]
    pub(crate) notes: Vec<String>,
    pub(crate) performance: Performance,
    pub(crate) samples: Option<Samples>,
    pub(crate) laid: Vec<Vec<LaidPoint>>,
}
