//! The report of the sources of a line.

use super::files::openfoam::has_order_of_openfoam;
use crate::numbers::{THIN, number, plus_minus};
use crate::page::document::{Report, Section};
use crate::page::methods::{methods, of_case};
use crate::page::table::Table;
use crate::page::words::{estimate_text, quantity};
use spunlaid_fibre::{Case, ZERO_CELSIUS};
use spunlaid_ground::Estimate;
use spunlaid_simulation::Sources;

/// What filaments do to the cells of their field.
///
/// * `toml` – what the case is from, as a file
pub fn sources_report<'a>(case: &Case, toml: &str, sources: &Sources) -> Report<'a> {
    let force = |estimate: &Estimate| format!("{}{THIN}N/m", estimate_text(estimate, 1.0));
    let power = |estimate: &Estimate| format!("{}{THIN}kW/m", estimate_text(estimate, 1e-3));
    let celsius = |estimate: &Estimate| {
        let mean = estimate.mean - ZERO_CELSIUS;
        format!("{}{THIN}°C", plus_minus(mean, estimate.standard_error))
    };
    let and_heat = match &sources.heat {
        Ok(heat) => format!(" and give it {}", power(&heat.in_cells)),
        Err(_) => String::new(),
    };
    let headline = match sources.are_steady() {
        true => format!(
            "The filaments drive the air of the cells with {} along their way{and_heat}, per metre of width.",
            force(&sources.along)
        ),
        false => format!(
            "The flights are not steady, so there are no sources: from the inlet to 95 % of the way the filaments \
             drive the air with {} by their drag, and with {} by the balance of their momentum.",
            force(&sources.above_belt[0]),
            force(&sources.above_belt[1])
        ),
    };
    let without_heat = match &sources.heat {
        Ok(_) => String::new(),
        Err(fault) => format!(" Heat is left out: {}.", fault.message),
    };
    let met = sources.cells.iter().filter(|cell| cell.hits > 0).count();
    let lead = format!(
        "{} simulated filaments, for {} per metre of width, have met {met} of the {} cells of the field. The sources \
         are Su + Sp U per volume, means over time and replicates with standard errors.{without_heat}",
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
    let forces = facts.map(|(name, estimate)| (name, force(estimate)));
    let heats = sources.heat.iter().flat_map(|heat| {
        [
            ("Heat of the filaments in all cells", power(&heat.in_cells)),
            ("Outside of all cells", power(&heat.outside)),
            ("Temperature of the filaments at the inlet", quantity(heat.at_inlet - ZERO_CELSIUS, "°C")),
            ("At the belt", celsius(&heat.at_belt)),
            ("Temperature of the air", quantity(heat.of_air - ZERO_CELSIUS, "°C")),
        ]
    });
    let difference = match sources.are_steady() {
        true => {
            "they differ by the sampling error and, with elements longer than a hundredth of the path, by the \
             effect of the belt on the last elements"
        }
        false => "they differ significantly, so the motion is not steady and no fields are written",
    };
    let sums = Section::new("sums", "Sums")
        .open()
        .table(Table::of_facts(forces.into_iter().chain(heats)))
        .caption(format!(
            "Forces and heat per metre of width, ± one standard error. The force from the inlet to 95 % of the way \
             is found in two ways from the same flights: from the drag on each element, and from the momentum that \
             the filaments have lost; {difference}."
        ))
        .printed();
    let openfoam = match has_order_of_openfoam(case) {
        _ if !sources.are_steady() => "",
        true => {
            " The folder openfoam holds the same for OpenFOAM, in the order of the cells of its mesh, if foamToVTK has \
             written the field."
        }
        false => "",
    };
    let cooling = match sources.heat {
        Ok(_) => {
            " They begin with the temperature at the end of their spinline and cool by its law in air of one \
             temperature, theory (121)."
        }
        Err(_) => "",
    };
    let computed = Section::new("methods", "How it was computed").paragraph(format!(
        "The drag on each element counts in the cell in which its middle lies, theory (120). The filaments are \
         assumed to be uniform across the width.{cooling}"
    ));
    let arrays_of_heat = if sources.heat.is_ok() { "Sh, ShT, heat, " } else { "" };
    let fields = format!(
        "sources.vtu has the cells with Su, Sp, {arrays_of_heat}their standard errors, the force in the given air and \
         the number of hits.{openfoam} All sums are in summary.json, next to this page."
    );
    let fields = if sources.are_steady() {
        fields
    } else {
        "All sums are in summary.json, next to this page.".to_owned()
    };
    let file = Section::new("file", "The input").file("case-toml", toml).caption(fields);
    Report::new("air", headline)
        .lead(lead)
        .with(sums)
        .with(computed)
        .with(methods("air --sources", of_case(case), "case.toml of the results"))
        .with(file)
}
