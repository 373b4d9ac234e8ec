//! The report of the air of a case.

use super::files::Slices;
use crate::numbers::{THIN, significant};
use crate::page::document::{Report, Section};
use crate::page::methods::{methods, of_case};
use crate::page::words::length;
use spunlaid_charts::Figure;
use spunlaid_fibre::Case;

/// The air of a case, in pictures.
///
/// * `toml` – the case as a file
/// * `field` – how it lies around the line, if it is a CFD field
/// * `headline` – how strong the eddies are
pub fn air_report<'a>(
    case: &Case,
    toml: &str,
    slices: &Slices,
    [field, pictures]: [&'a [Figure]; 2],
    headline: String,
) -> Report<'a> {
    let summary = summary(case, slices);
    let computed = Section::new("methods", "How it was computed").paragraph(
        "The air is a field of eddies in space with the lateral structure of von Kármán’s isotropic \
        turbulence, carried by the mean flow (air.lateral = \"von-karman\"). Fibres of this case \
        with the same seed and replicate meet this air. Waves across the flow \
        that are shorter than 2π length scales over air.lateral_cutoff are left out.",
    );
    let file = Section::new("file", "The case").file("case-toml", toml).caption(
        "along.pvd and across.pvd open the velocities, all three components, in ParaView, which shows \
        them one after the other; all numbers are in summary.json, next to this page.",
    );
    Report::new("air", headline)
        .lead(summary)
        .with_all(
            field
                .chunks(1)
                .map(|field| Section::new("field", "The field and the line").figures(field).open()),
        )
        .with(Section::new("pictures", "At the first instant").figures(pictures).open())
        .with(computed)
        .with(methods("air", of_case(case), "case.toml of the results"))
        .with(file)
}

/// What is seen, in sentences.
fn summary(case: &Case, slices: &Slices) -> String {
    let extent = case.extent_of_air();
    let duration = slices.times.last().copied().unwrap_or_default();
    let frames = slices.times.len();
    format!(
        "{} of air on a way of {}, at {frames} instants. Its turbulence repeats \
        itself after {} in machine direction and {} across.",
        format_args!("{}{THIN}ms", significant(duration * 1e3, 3)),
        length(case.way_of_air()),
        length(extent.y),
        length(extent.z)
    )
}
