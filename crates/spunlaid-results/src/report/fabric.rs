//! The fabric in a report.

use super::document::Section;
use super::table::{Content, Layout, Row, Table};
use crate::output::web::fabric_rows;
use spunlaid::fabric::Fabric;

/// Everything that is told of a fabric.
pub(super) fn fabric_section(fabric: &Fabric) -> Section<'static> {
    let windows = fabric.holes.as_ref().map_or_else(String::new, |holes| {
        let area = (holes.area * 1e6).round();
        format!(" Holes were counted in {} windows, {area} mm² together, in which fibres were drawn with their width.", holes.windows)
    });
    let columns = [("Number", Content::Words), ("Value", Content::Numbers), ("Meaning", Content::Sentences)];
    let rows = fabric_rows(fabric, false);
    let rows = rows.into_iter().map(|row| Row::new(row.name, [row.value.as_str(), row.meaning]));
    let section = Section::new("fabric", "Fabric")
        .table(Table::of(columns).laid_out(Layout::Results).rows(rows))
        .caption(format!(
            "From the map, from the curves of the fibres and from what the file says of the fabric ([fabric]); bonds and finishes are not known.{windows}"
        ));
    fabric.notes.iter().fold(section, |section, note| section.caption(note))
}
