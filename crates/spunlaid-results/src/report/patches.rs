//! The table of the unevenness over patches, the same in the report and on the terminal.

use super::table::{Row, Table};
use crate::numbers::{THIN, plus_minus, significant};
use crate::output::measured::text;
use spunlaid::ground::{ErrorRole, Measure, PERCENT, Unit};
use spunlaid::web::OF_PATCHES;
use spunlaid::web::map::{Findings, PatchFindings};

/// The unevenness over patches, a row for each size: what the map says, then every declared column that the web has.
pub(super) fn patch_table(findings: &Findings) -> Table {
    // That of a web of few filaments holds what these do too.
    let of_map = match findings.patches.iter().any(|patch| patch.few.is_some()) {
        true => ["Patch", "CV of this web", "by chance", "95 % interval"],
        false => ["Patch", "CV of this map", "by chance", "95 % by chance"],
    };
    let declared = columns(findings);
    let row = |patch: &PatchFindings| {
        let cells = declared.iter().map(|measure| cell(text(&measure.of(patch)), measure.unit));
        Row::from(cells_of_map(patch).into_iter().chain(cells).collect::<Vec<_>>())
    };
    let heads = of_map.into_iter().chain(declared.iter().map(|measure| measure.terse()));
    Table::of_numbers(heads).rows(findings.patches.iter().map(row))
}

/// The declared columns that a web has, in their order: after that of the CV its further errors,
/// then the other measures. The standard error of a measure stands with it.
fn columns(findings: &Findings) -> Vec<&'static Measure<PatchFindings>> {
    let of_measure = |measure: &'static Measure<PatchFindings>| {
        let further = measure.errors.iter().filter(|error| error.role == ErrorRole::Further);
        std::iter::once(measure).chain(further)
    };
    let is_shown = |measure: &&Measure<PatchFindings>| {
        !measure.terse().is_empty() && findings.patches.iter().any(measure.is_shown)
    };
    OF_PATCHES.iter().flat_map(of_measure).skip(1).filter(is_shown).collect()
}

/// A number with its unit, or a dash.
fn cell(number: Option<String>, unit: Unit) -> String {
    match (number, unit.shown) {
        (None, _) => "–".to_owned(),
        (Some(number), "") => number,
        (Some(number), unit) => format!("{number}{THIN}{unit}"),
    }
}

/// Side of the patches, CV with its error by all causes, or by chance alone if the others are not known,
/// error by chance, and interval.
fn cells_of_map(patch: &PatchFindings) -> [String; 4] {
    let (told, error) = (patch.told(), patch.whole_error());
    let whole = error.whole().or(error.chance);
    let ends = |ends: [f64; 2]| ends.map(|end| significant(100.0 * end, 3)).join(" to ");
    [
        format!("{}{THIN}mm", significant(patch.map.patch * 1e3, 3)),
        cell(told.map(|told| plus_minus(100.0 * told.cv, whole.map(|error| 100.0 * error))), PERCENT),
        cell(error.chance.map(|error| significant(100.0 * error, 2)), PERCENT),
        cell(patch.interval().map(ends), PERCENT),
    ]
}

#[cfg(test)]
mod tests {
    use super::{PERCENT, cell};
    use spunlaid::ground::RATIO;

    #[test]
    fn a_cell_has_the_unit_of_its_measure() {
        let number = |text: &str| Some(text.to_owned());
        assert_eq!(cell(number("5.3"), PERCENT), "5.3\u{202f}%");
        assert_eq!([cell(number("1.4"), RATIO), cell(None, RATIO)], ["1.4", "–"]);
    }
}
