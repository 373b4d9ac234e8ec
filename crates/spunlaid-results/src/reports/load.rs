//! What filaments do to their air: `curtain` in the summaries of webs and runs, a section of reports, and sentences.

use super::spinline::files::SpinResults;
use crate::files::measured::{text, values};
use crate::numbers::{THIN, plus_minus, significant};
use crate::page::document::Section;
use crate::page::table::{Row, Table};
use serde_json::Value as Json;
use spunlaid_fibre::{Case, LOAD_MEASURES, LOAD_POSITION_MEASURES, Load, LoadPlace, WayPlace};
use spunlaid_ground::{Measured, measure};

const TITLE: &str = "Force of the filaments on the air";

/// What is said where nothing of the way was seen.
const NOT_SEEN: &str =
    "The force on the way to the belt is not known, because no filament was recorded on it.";

/// Share of the momentum of the air from which on the given air is far from that of the line.
const LARGE: f64 = 0.2;

/// The load of the filaments of a case; None for a fibre of fixed length.
///
/// * `slot` – size in machine direction of the slot of the air [m], if it is known
/// * `way` – of a simulated filament; empty if none was simulated
pub fn load_of(case: &Case, filaments_per_metre: f64, slot: Option<f64>, way: &[WayPlace]) -> Option<Load> {
    let spun = SpinResults::from_case(case);
    let first = spun.as_ref().and_then(|spun| spun.rows.first());
    Load::new(case, filaments_per_metre, slot, way, first)
}

/// The load of the filaments of a case whose spinline has a curtain of them; None of any other.
pub fn load_of_spinline(case: &Case, way: &[WayPlace]) -> Option<Load> {
    let curtain = case.spinline.as_ref()?.curtain?;
    load_of(case, curtain.rows as f64 * curtain.filaments_per_metre, None, way)
}

/// Its measures, and those of each place where filaments were simulated.
pub fn summary(load: &Load) -> Json {
    let mut object = values(LOAD_MEASURES, load);
    if !load.places.is_empty() {
        object["places"] = load.places.iter().map(|place| values(LOAD_POSITION_MEASURES, place)).collect();
    }
    object
}

/// The section; none where nothing is known.
///
/// * `loads` – of each layer, with its name where there are several
pub(super) fn section_of_loads(loads: &[(Option<&str>, &Load)]) -> Option<Section<'static>> {
    if loads.is_empty() {
        return None;
    }
    let mut section = Section::new("curtain", TITLE);
    for (name, load) in loads {
        if let Some(name) = name {
            section = section.heading(format!("Layer {name}"));
        }
        section = section.paragraph(load_words(load)).table(Table::of_measures(LOAD_MEASURES, load));
        section = match load.places.is_empty() {
            true => section.paragraph(NOT_SEEN),
            false => section.table(along_way(load)),
        };
    }
    let heat = match loads.iter().all(|(_, load)| load.heat.is_none()) {
        true => " Their heat is not known, because they do not come from a spinline.",
        false => "",
    };
    Some(section.brief().caption(format!(
        "The force is the drag on the simulated filaments (without implicit tension: the balance of momentum), ± \
        one standard error, times the filaments per metre; docs/theory.md has the equations. The air of the slot is \
        taken to keep its mass flow.{heat}"
    )))
}

/// What filaments do to their air, in a few sentences.
pub fn load_words(load: &Load) -> String {
    let at_inlet = load.mass_loading().zip(load.momentum_loading()).map(|(mass, momentum)| {
        format!(
            "At the inlet the filaments have {} of the mass flow of the air and {} of its momentum flux.",
            per_cent(mass),
            per_cent(momentum)
        )
    });
    let missing = load.air.is_none().then(|| match load.places.is_empty() {
        true => {
            "The force of the filaments on the air can be computed from the size of the slot: line.slot_gap, next \
            to line.filaments_per_metre."
                .to_owned()
        }
        false => "Its ratio to the momentum of the air is not known without the size of the slot; a web has it in \
        line.slot_gap, next to line.filaments_per_metre."
            .to_owned(),
    });
    let on_way = load.at_belt().map(on_way);
    at_inlet.into_iter().chain(on_way).chain(missing).collect::<Vec<_>>().join(" ")
}

/// The force on the air down to the belt, and what it does to it.
fn on_way(belt: &LoadPlace) -> String {
    let force = format!(
        "Down to the belt they drive it with {}{THIN}N per metre of width",
        plus_minus(belt.force, belt.standard_error)
    );
    let Some(share) = belt.share_of_momentum() else { return format!("{force}.") };
    let effect = match belt.change_of_velocity() {
        Some(change) => format!("a free stream of the same width would be {} there", faster(change)),
        None => "they would stop a free stream of the same width".to_owned(),
    };
    let pressure = belt.pressure.map_or_else(String::new, |rise| {
        format!(", and between walls its pressure would change by {}{THIN}Pa", significant(rise, 2))
    });
    let verdict = if share.abs() > LARGE {
        "This is so large that the given air cannot be that of this line, unless it was measured or computed with \
        the filaments."
    } else {
        "The filaments are simulated in the given air."
    };
    format!("{force}, {} of its momentum flux: {effect}{pressure}. {verdict}", per_cent(share))
}

fn per_cent(share: f64) -> String {
    format!("{}{THIN}%", significant(100.0 * share, 2))
}

fn faster(change: f64) -> String {
    format!("{} {}", per_cent(change.abs()), if change < 0.0 { "slower" } else { "faster" })
}

/// The load at places on the way, as far as it is known.
fn along_way(load: &Load) -> Table {
    let is_known = |row: &Measured<LoadPlace>| row.value.is_some();
    let rows: Vec<Vec<Measured<LoadPlace>>> = load
        .places
        .iter()
        .map(|place| measure::measured(LOAD_POSITION_MEASURES, place).filter(is_known).collect())
        .collect();
    let head = |row: &Measured<LoadPlace>| match row.measure.unit.shown {
        "" => row.measure.label.to_owned(),
        unit => format!("{}, {unit}", row.measure.label),
    };
    let heads: Vec<String> = rows.last().into_iter().flatten().map(head).collect();
    let cells = |row: Vec<Measured<LoadPlace>>| {
        let mut cells = row.iter().map(|cell| text(cell).unwrap_or_default());
        Row::new(cells.next().unwrap_or_default(), cells.collect::<Vec<_>>())
    };
    Table::of_numbers(heads).rows(rows.into_iter().map(cells))
}
