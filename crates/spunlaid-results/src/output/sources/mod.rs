//! The force of filaments on the cells of their CFD field, as files for CFD programs.
//!
//! ```text
//! vtk       all cells as tetrahedra or boxes, with their sources
//! openfoam  the same as fields of OpenFOAM, in the order of its cells
//! summary   the sums, and how sure they are
//! ```

mod openfoam;
mod summary;
mod vtk;

pub use openfoam::{OPENFOAM, has_order_of_openfoam, write_openfoam};
pub use summary::SourcesSummary;
pub use vtk::{VTK, write_vtk};

use spunlaid::air::{Flow, PlacedField};
use spunlaid::case::Case;

/// The field of a case, if its air is one.
pub(crate) fn field_of(case: &Case) -> Option<&PlacedField> {
    match &case.air.flow {
        Flow::Field(placed) => Some(placed),
        _ => None,
    }
}
