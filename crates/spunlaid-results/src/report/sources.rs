//! The report of the sources of a line.

use super::document::{Report, Section};
use super::methods::{case_account, methods};
use super::table::Table;
use super::words::estimate_text;
use crate::numbers::{THIN, number};
use crate::output::sources::has_order_of_openfoam;
use spunlaid::case::Case;
use spunlaid::ensemble::Sources;
use spunlaid::statistics::Estimate;

/// What filaments do to the cells of their field.
///
/// * `case` – and what it is from, as a file
pub fn sources_report<'a>((case, toml): (&Case, &str), sources: &Sources) -> Report<'a> {
    let force = |estimate: &Estimate| format!("{}{THIN}N/m", estimate_text(estimate, 1.0));
    let headline = format!(
        "The filaments drive the air of the cells with {} along their way, per metre of width.",
        force(&sources.along)
    );
    let met = sources.cells.iter().filter(|cell| cell.hits > 0).count();
    let lead = format!(
        "{} flown filaments, for {} per metre of width, have met {met} of the {} cells of the field. The sources are \
         Su + Sp U per volume, means over time and replicates with standard errors.",
        sources.replicates,
        number(sources.filaments_per_metre),
        sources.cells.len()
    );
    let [x, y, z] = &sources.force;
    let [above, by_momentum] = &sources.above_belt;
    let facts = [
        ("Force on the air along x of the field", x),
        ("Along y", y),
        ("Along z", z),
        ("Along the way, outside of all cells", &sources.outside),
        ("Along the way, from the inlet to 95 % of it", above),
        ("The same by the balance of momentum", by_momentum),
    ];
    let sums = Section::new("sums", "Sums")
        .table(Table::of_facts(facts.map(|(name, estimate)| (name, force(estimate)))))
        .caption(
            "Forces per metre of width. The last two are found in two ways from the same flights: from the drag on each \
             element, and from what momentum the filaments have lost; they differ by chance.",
        )
        .on_terminal();
    let openfoam = match has_order_of_openfoam(case) {
        true => {
            " openfoam/Su and openfoam/Sp hold the same for OpenFOAM, in the order of the cells of its mesh, if \
             foamToVTK has written the field."
        }
        false => "",
    };
    let computed = Section::new("methods", "How it was computed").paragraph(
        "The drag on each element counts in the cell in which its middle lies, theory (120). Filaments are taken to be \
         the same everywhere across the width. Heat is left out, because the temperature of the fibres below the spinline \
         is not computed.",
    );
    let file = Section::new("file", "The input").file("case-toml", toml).caption(format!(
        "sources.vtu has the cells with Su, Sp, their standard errors, the force in the given air and the number of hits.\
         {openfoam} All sums are in summary.json, beside this page."
    ));
    let found = [lead.clone(), headline.clone()];
    Report::new("air", headline)
        .lead(lead)
        .with(sums)
        .with(computed)
        .with(methods("air --sources", case_account(case), found))
        .with(file)
}
