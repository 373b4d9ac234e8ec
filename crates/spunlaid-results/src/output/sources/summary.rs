//! `summary.json` of the sources.

use super::has_order_of_openfoam;
use crate::output::in_order::OrderedObject;
use crate::output::summary::{LostSummary, resolved};
use crate::output::versioned_json;
use serde::Serialize;
use serde_json::Value as Json;
use spunlaid::case::Case;
use spunlaid::ensemble::Sources;
use spunlaid::spinline::ZERO_CELSIUS;
use spunlaid::statistics::Estimate;

/// Content of the file.
#[derive(Debug, Serialize)]
pub struct SourcesSummary<'a> {
    /// Filaments per metre of width [1/m].
    pub filaments_per_m: f64,
    /// Number of flown filaments without those that were lost.
    pub replicates: u64,
    /// Number of filaments that were lost. They are in no mean.
    pub lost: usize,
    /// Which, and why.
    pub lost_fibres: Vec<LostSummary<'a>>,
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
    /// Whether these two forces agree within chance. If not, there are no fields.
    pub steady: bool,
    /// Heat of the filaments between the inlet and the belt; none where it is not known, which a note says.
    #[serde(flatten)]
    pub heat: Option<HeatSummary>,
    /// Whether there are fields for OpenFOAM.
    pub openfoam: bool,
    /// Remarks.
    pub notes: Vec<String>,
    /// The resolved case.
    pub case: OrderedObject<OrderedObject<Json>>,
}

/// Heat of the filaments.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct HeatSummary {
    /// In all cells.
    pub heat_w_per_m: Number,
    /// Outside of all cells.
    pub heat_outside_w_per_m: Number,
    /// Temperature of the filaments at the inlet.
    pub inlet_temperature_c: f64,
    /// At the belt.
    pub belt_temperature_c: Number,
    /// Temperature of the air.
    pub air_temperature_c: f64,
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

impl<'a> SourcesSummary<'a> {
    /// The numbers of the sources of a case.
    pub fn new(case: &Case, sources: &'a Sources, notes: &[String]) -> Self {
        let [above, by_momentum] = &sources.above_belt;
        let heat = sources.heat.as_ref().ok().map(|heat| HeatSummary {
            heat_w_per_m: (&heat.in_cells).into(),
            heat_outside_w_per_m: (&heat.outside).into(),
            inlet_temperature_c: heat.at_inlet - ZERO_CELSIUS,
            belt_temperature_c: Number {
                mean: heat.at_belt.mean - ZERO_CELSIUS,
                standard_error: heat.at_belt.standard_error,
            },
            air_temperature_c: heat.of_air - ZERO_CELSIUS,
        });
        Self {
            filaments_per_m: sources.filaments_per_metre,
            replicates: sources.replicates,
            lost: sources.lost.len(),
            lost_fibres: sources.lost.iter().map(LostSummary::from).collect(),
            cells: sources.cells.len(),
            cells_met: sources.cells.iter().filter(|cell| cell.hits > 0).count(),
            force_n_per_m: sources.force.each_ref().map(Number::from),
            force_along_n_per_m: (&sources.along).into(),
            outside_n_per_m: (&sources.outside).into(),
            above_belt_n_per_m: above.into(),
            by_momentum_n_per_m: by_momentum.into(),
            steady: sources.are_steady(),
            heat,
            openfoam: sources.are_steady() && has_order_of_openfoam(case),
            notes: notes.to_vec(),
            case: resolved(case),
        }
    }

    /// The file's text.
    pub fn to_json(&self) -> String {
        versioned_json(1, self)
    }
}
