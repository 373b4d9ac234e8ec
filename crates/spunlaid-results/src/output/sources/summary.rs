//! `summary.json` of the sources.

use super::has_order_of_openfoam;
use crate::output::measured::{known, mean};
use crate::output::summary::{lost_fibres, resolved};
use crate::output::versioned_json;
use serde_json::json;
use spunlaid::case::Case;
use spunlaid::ensemble::Sources;
use spunlaid::spinline::ZERO_CELSIUS;
use spunlaid::statistics::Estimate;

/// The text of the file.
pub fn summary(case: &Case, sources: &Sources, notes: &[String]) -> String {
    let [above, by_momentum] = &sources.above_belt;
    // None where it is not known, which a note says.
    let heat = sources.heat.as_ref().ok();
    let at_belt = |at_belt: &Estimate| Estimate { mean: at_belt.mean - ZERO_CELSIUS, ..at_belt.clone() };
    let content = json!({
        "filaments_per_m": sources.filaments_per_metre,
        "replicates": sources.replicates,
        "lost": sources.lost.len(),
        "lost_fibres": lost_fibres(&sources.lost),
        "cells": sources.cells.len(),
        "cells_met": sources.cells.iter().filter(|cell| cell.hits > 0).count(),
        "force_n_per_m": sources.force.each_ref().map(mean),
        "force_along_n_per_m": mean(&sources.along),
        "outside_n_per_m": mean(&sources.outside),
        "above_belt_n_per_m": mean(above),
        "by_momentum_n_per_m": mean(by_momentum),
        "steady": sources.are_steady(),
        "heat_w_per_m": heat.map(|heat| mean(&heat.in_cells)),
        "heat_outside_w_per_m": heat.map(|heat| mean(&heat.outside)),
        "inlet_temperature_c": heat.map(|heat| heat.at_inlet - ZERO_CELSIUS),
        "belt_temperature_c": heat.map(|heat| mean(&at_belt(&heat.at_belt))),
        "air_temperature_c": heat.map(|heat| heat.of_air - ZERO_CELSIUS),
        "openfoam": sources.are_steady() && has_order_of_openfoam(case),
        "notes": notes,
        "case": resolved(case),
    });
    versioned_json(1, known(content))
}
