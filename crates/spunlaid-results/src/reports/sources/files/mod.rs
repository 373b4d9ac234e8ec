//! The force of filaments on the cells of their CFD field, as files for CFD programs.
//!
//! ```text
//! vtk       all cells as tetrahedra or boxes, with their sources
//! openfoam  the same as fields of OpenFOAM, in the order of its cells
//! ```

pub(crate) mod openfoam;
pub(crate) mod vtk;

use openfoam::has_order_of_openfoam;

use crate::files::measured::{known, mean};
use crate::files::versioned_json;
use crate::numbers::{plus_minus, significant};
use crate::reports::run::summary::{lost_fibres, resolved};

use serde_json::json;
use spunlaid_fibre::{Case, ZERO_CELSIUS};
use spunlaid_ground::{Dimension, Estimate};
use spunlaid_simulation::Sources;

/// What is said of flights that are not steady: no field is written for a CFD program, which would read it without a
/// word of doubt. None if they are.
pub fn unsteady(case: &Case, sources: &Sources) -> Option<String> {
    let [drag, balance] =
        sources.above_belt.each_ref().map(|force| plus_minus(force.mean, force.standard_error));
    let spin_up = case.run.spin_up();
    let way = case.line.map_or(0.0, |line| line.distance / line.feed_speed);
    let time = |seconds: f64| Dimension::Time.pretty_to(seconds, 2);
    (!sources.are_steady()).then(|| {
        format!(
            "the force of the filaments on the air is {drag} N/m by their drag and {balance} N/m by the balance of \
             their momentum, which differ significantly. The motion is not steady, most likely because \
             run.spin_up = {} is too short for filaments that need {} to land. No fields are written; write \
             run.spin_up = \"{}\" or more, and lengthen run.duration by as much",
            time(spin_up),
            time(way),
            time(WAYS * way.max(spin_up))
        )
    })
}

/// Spin-up that is proposed, in ways down or in spin-ups that were too short.
const WAYS: f64 = 3.0;

/// Share of the force outside of the cells from which on it is reported.
const MUCH_OUTSIDE: f64 = 0.01;

/// What is said if much of the force is outside of the cells.
pub fn outside_of_cells(sources: &Sources) -> Option<String> {
    let (outside, inside) = (sources.outside.mean, sources.along.mean);
    let share = outside.abs() / (outside.abs() + inside.abs());
    (share > MUCH_OUTSIDE).then(|| {
        format!(
            "{} % of the force of the filaments on the air is outside of the cells of air.field and is in no source: \
             {} N/m of {} N/m. Does the field reach from the inlet to the belt, and as far to both sides as the \
             filaments move?",
            significant(share * 100.0, 2),
            significant(outside, 3),
            significant(inside, 3)
        )
    })
}

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
