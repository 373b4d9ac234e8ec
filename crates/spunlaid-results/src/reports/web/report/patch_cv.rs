//! How uneven a web is, in the words that the reports of laid and of scanned webs share, and the table of its patches.

use crate::files::measured::text;
use crate::numbers::{THIN, plus_minus, significant};
use crate::page::table::{Row, Table};
use crate::page::words::millimetres;
use spunlaid_ground::{ErrorRole, Measure, PERCENT, Unit};
use spunlaid_web::map::uniformity::PatchCv;
use spunlaid_web::map::{Findings, PatchFindings};
use spunlaid_web::{Clouds, PATCH_MEASURES};

pub(super) const PER_CENT: f64 = 100.0;

/// What is said below every table of CVs.
pub(crate) const CV_OF_PATCHES: &str = "Coefficient of variation of the basis weight over square patches, ± one \
    standard error in percentage points. The confidence interval contains the CV of all such webs in 95 % of cases.";

/// * `is_bound` – whether its filaments are independent of each other, so that a real web is more uneven
/// * `assumed` – what is to be said of assumed values, because the error is that of sampling alone
pub(crate) fn headline(patch: Option<&PatchCv>, is_bound: bool, assumed: Option<String>) -> String {
    let Some(PatchCv { cv, standard_error, patch, .. }) = patch else {
        return "CV not known: the web is smaller than the patches.".to_owned();
    };
    let at_least = if is_bound { "at least " } else { "" };
    let independent = is_bound.then(|| "the filaments are independent of each other".to_owned());
    let further: String = assumed.into_iter().chain(independent).map(|words| format!("; {words}")).collect();
    let cv = per_cent(*cv, *standard_error);
    format!("CV {at_least}{cv} over {} patches{further}.", millimetres(*patch))
}

pub(crate) fn per_cent(cv: f64, error: Option<f64>) -> String {
    format!("{}{THIN}%", plus_minus(cv * PER_CENT, error.map(|error| error * PER_CENT)))
}

/// Longest wave of variance that is the grain of single fibres, and no clouds [m].
const FINEST_CLOUDS: f64 = 2e-3;

/// Which octave of wavelength holds most of the variance, in a sentence.
pub(crate) fn largest_clouds(clouds: &Clouds) -> Option<String> {
    let octaves = clouds.octaves();
    let whole: f64 = octaves.iter().map(|(_, variance)| variance.mean).sum();
    let (waves, variance) = octaves.iter().max_by(|a, b| a.1.mean.total_cmp(&b.1.mean))?;
    Some(format!(
        "The octave of wavelengths from {} to {} contributes most of the variance: {} % of that between {} and \
         {}{}.",
        millimetres(waves[0]),
        millimetres(waves[1]),
        significant(PER_CENT * variance.mean / whole, 2),
        millimetres(clouds.shortest()),
        millimetres(clouds.longest()),
        if waves[1] > FINEST_CLOUDS { "" } else { ", which single fibres make more than clouds do" }
    ))
}

/// The CV over patches, a row for each size: what the map says, then every declared column that the web has.
pub(super) fn patch_table(findings: &Findings) -> Table {
    // That of a web of few filaments holds what these do too.
    let of_map = match findings.patches.iter().any(|patch| patch.few.is_some()) {
        true => ["Patch", "CV of this web", "sampling error", "95 % interval"],
        false => ["Patch", "CV of this map", "sampling error", "95 % interval"],
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
    PATCH_MEASURES.iter().flat_map(of_measure).skip(1).filter(is_shown).collect()
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
    let reported = patch.with_total_error();
    let ends = |ends: [f64; 2]| {
        let [low, high] = ends.map(|end| significant(100.0 * end, 3));
        if ends[1].is_finite() { format!("{low} to {high}") } else { format!("at least {low}") }
    };
    [
        format!("{}{THIN}mm", significant(patch.map.patch * 1e3, 3)),
        reported.map_or("–".to_owned(), |reported| per_cent(reported.cv, reported.standard_error)),
        cell(patch.map.standard_error.map(|error| significant(100.0 * error, 2)), PERCENT),
        cell(patch.interval().map(ends), PERCENT),
    ]
}

#[cfg(test)]
mod tests {
    use super::{PERCENT, cell};
    use spunlaid_ground::RATIO;

    #[test]
    fn a_cell_has_the_unit_of_its_measure() {
        let number = |text: &str| Some(text.to_owned());
        assert_eq!(cell(number("5.3"), PERCENT), "5.3\u{202f}%");
        assert_eq!([cell(number("1.4"), RATIO), cell(None, RATIO)], ["1.4", "–"]);
    }
}
