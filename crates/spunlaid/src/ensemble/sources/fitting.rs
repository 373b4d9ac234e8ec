//! The cases whose sources can be found, and their fields.

use crate::air::{Flow, PlacedField, temperature_of};
use crate::case::Case;
use crate::chain::schemes::Scheme;
use crate::error::Fault;
use crate::field::FieldCells;
use crate::spinline::SolidFilament;
use crate::vec3::Vec3;

/// A case whose sources can be found, in its field.
#[derive(Debug)]
pub(super) struct Fitting<'a> {
    pub(super) placed: &'a PlacedField,
    pub(super) cells: FieldCells<'a>,
    /// Distance from the inlet to the belt [m].
    pub(super) distance: f64,
    /// The lowest place of the field across the width, and how wide it is [m].
    pub(super) across: [f64; 2],
    /// How the filament cools, or why this is not known.
    pub(super) filament: Result<SolidFilament<'a>, Fault>,
    /// Direction of the feed.
    pub(super) along: Vec3<f64>,
}

pub(super) fn fitting(case: &Case) -> Result<Fitting<'_>, Fault> {
    let Some(line) = case.line else {
        return Err(Fault::new(
            "the fibre has a fixed length, and sources are those of the filaments of a line",
            "give the case the tables [feed] and [belt]",
        ));
    };
    let Flow::Field(placed) = &case.air.flow else {
        return Err(Fault::new(
            "the air is no CFD field, so it has no cells for sources",
            "give the file of a CFD solution in air.field",
        ));
    };
    if case.run.scheme != Scheme::ImplicitTension {
        return Err(Fault::new(
            "the drag on each element is known with implicit tension only",
            "set run.scheme = \"implicit-tension\"",
        ));
    }
    let cells = placed.field.cells().ok_or_else(|| {
        Fault::new(
            "air.field has points without cells, so there are no cells for sources",
            "export the cells of the CFD solution, as .vtu or .vtk",
        )
    })?;
    let [_, _, across] = placed.axes();
    if placed.field.plane_axis().is_some_and(|plane| plane != across.index) {
        return Err(Fault::new(
            "air.field is a plane flow that does not lie across the width of the line, so its cells hold the \
             filaments of no known width",
            "write air.field_axis and air.field_machine_direction so that the air is the same along the cross \
             direction",
        ));
    }
    let (low, high) = placed.extent();
    let across = match cells.depth() {
        Some(depth) => [low.z - 0.5 * depth * placed.unit, depth * placed.unit],
        None => [low.z, high.z - low.z],
    };
    let (filament, along) = (filament(case), case.fibre.direction);
    Ok(Fitting { placed, cells, distance: line.distance, across, filament, along })
}

/// How the filament of a case cools below its spinline.
fn filament(case: &Case) -> Result<SolidFilament<'_>, Fault> {
    let line = case.spinline.as_deref().ok_or_else(|| {
        Fault::new(
            "the filaments come from no spinline, so their temperature is not known",
            "add [spinline] to know their heat too",
        )
    })?;
    let of_air = temperature_of(case.air.density).ok_or_else(|| {
        Fault::new(
            "the density of the air is not that of air in the atmosphere, so its temperature is not known",
            "write air.temperature in place of air.density to know the heat too",
        )
    })?;
    // The case could be read, so that its spinline has a steady state.
    let solution = line.solve(case.drag.along).map_err(|failure| failure.fault)?;
    Ok(SolidFilament::new(line, &solution, of_air))
}
