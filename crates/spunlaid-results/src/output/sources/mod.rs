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
pub use summary::summary;
pub use vtk::{VTK, write_vtk};

use crate::numbers::plus_minus;
use spunlaid::case::Case;
use spunlaid::ensemble::Sources;
use spunlaid::units::Dimension;

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
            "the force of the filaments on the air is {drag} N/m by their drag and {balance} N/m by the balance of their \
             momentum, which differ by more than chance: the flights are not steady, most likely because run.spin_up = \
             {} is too short for filaments that need {} to come down. No fields are written; write run.spin_up = \
             \"{}\" or more, and lengthen run.duration by as much",
            time(spin_up),
            time(way),
            time(WAYS * way.max(spin_up))
        )
    })
}

/// Spin-up that is proposed, in ways down or in spin-ups that were too short.
const WAYS: f64 = 3.0;
