//! `summary.json` of the sources.

use super::has_order_of_openfoam;
use crate::output::in_order::OrderedObject;
use crate::output::summary::resolved;
use crate::output::versioned_json;
use serde::Serialize;
use serde_json::Value as Json;
use spunlaid::case::Case;
use spunlaid::ensemble::Sources;
use spunlaid::statistics::Estimate;

/// Content of the file.
#[derive(Debug, Serialize)]
pub struct SourcesSummary {
    /// Filaments per metre of width [1/m].
    pub filaments_per_m: f64,
    /// Number of flown filaments.
    pub replicates: u64,
    /// Number of cells.
    pub cells: usize,
    /// Number of those that a filament has met.
    pub cells_met: usize,
    /// Force on the air in all cells, along x, y and z of the field [N/m].
    pub force_n_per_m: [Number; 3],
    /// The same along the way of the filaments.
    pub force_along_n_per_m: Number,
    /// Force along the way outside of all cells.
    pub outside_n_per_m: Number,
    /// Force along the way between the inlet and 95 % of the way to the belt, of the drag.
    pub above_belt_n_per_m: Number,
    /// The same by the balance of the momentum of the same flights.
    pub by_momentum_n_per_m: Number,
    /// Whether there are fields for OpenFOAM.
    pub openfoam: bool,
    /// Remarks.
    pub notes: Vec<String>,
    /// The resolved case.
    pub case: OrderedObject<OrderedObject<Json>>,
}

/// A mean over the flown filaments.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Number {
    /// The mean.
    pub mean: f64,
    /// Its standard error; none of a single replicate.
    pub standard_error: Option<f64>,
}

impl From<&Estimate> for Number {
    fn from(estimate: &Estimate) -> Self {
        Self { mean: estimate.mean, standard_error: estimate.standard_error }
    }
}

impl SourcesSummary {
    /// The numbers of the sources of a case.
    pub fn new(case: &Case, sources: &Sources, notes: &[String]) -> Self {
        let [above, by_momentum] = &sources.above_belt;
        Self {
            filaments_per_m: sources.filaments_per_metre,
            replicates: sources.replicates,
            cells: sources.cells.len(),
            cells_met: sources.cells.iter().filter(|cell| cell.hits > 0).count(),
            force_n_per_m: sources.force.each_ref().map(Number::from),
            force_along_n_per_m: (&sources.along).into(),
            outside_n_per_m: (&sources.outside).into(),
            above_belt_n_per_m: above.into(),
            by_momentum_n_per_m: by_momentum.into(),
            openfoam: has_order_of_openfoam(case),
            notes: notes.to_vec(),
            case: resolved(case),
        }
    }

    /// The file's text.
    pub fn to_json(&self) -> String {
        versioned_json(1, self)
    }
}
