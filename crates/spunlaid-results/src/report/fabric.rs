//! The fabric in a report.

use crate::output::web::{FabricRow, fabric_rows};
use spunlaid::fabric::Fabric;

/// The section of a fabric.
#[derive(Clone, Debug, Default)]
pub(super) struct FabricSection {
    /// The rows of its table.
    pub(super) rows: Vec<FabricRow>,
    /// What it is made of, and what is not in it.
    pub(super) caption: String,
    /// What is not told, and why.
    pub(super) notes: Vec<String>,
}

/// Everything that is told of a fabric.
pub(super) fn fabric_section(fabric: &Fabric) -> FabricSection {
    let windows = fabric.holes.as_ref().map_or_else(String::new, |holes| {
        let area = (holes.area * 1e6).round();
        format!(" Holes were counted in {} windows, {area} mm² together, in which fibres were drawn with their width.", holes.windows)
    });
    FabricSection {
        rows: fabric_rows(fabric, false),
        caption: format!(
            "From the map, from the curves of the fibres and from what the file says of the fabric ([fabric]); bonds and finishes are not known.{windows}"
        ),
        notes: fabric.notes.clone(),
    }
}
