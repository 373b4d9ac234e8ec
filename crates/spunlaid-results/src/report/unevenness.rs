//! How uneven a web is, in the words that the reports of laid and of scanned webs share.

use super::words::millimetres;
use crate::numbers::{THIN, plus_minus, significant};
use spunlaid::web::Clouds;
use spunlaid::web::map::uniformity::Unevenness;
use spunlaid::web::map::{Findings, nearest_to_seen};

pub(super) const PER_CENT: f64 = 100.0;

/// What is said below every table of CVs.
pub(super) const CV_OF_PATCHES: &str = "Coefficient of variation of the basis weight over square patches, ± \
    one standard error, in percentage points as the CV is; the interval holds the CV of all such webs in 95 % of \
    the cases.";

/// A basis weight in grams per square metre.
pub(super) fn grams(weight: f64) -> String {
    format!("{}{THIN}g/m²", significant(weight * 1e3, 3))
}

/// A basis weight with its standard error.
pub(super) fn grams_with_error((weight, error): (f64, Option<f64>)) -> String {
    error.map_or_else(
        || grams(weight),
        |error| format!("{}{THIN}g/m²", plus_minus(weight * 1e3, Some(error * 1e3))),
    )
}

/// The patch nearest to what the eye judges first.
pub(super) fn headline_patch(findings: &Findings) -> Option<usize> {
    nearest_to_seen(findings.patches.iter().map(|patch| patch.map.patch))
}

/// * `weight` – mean basis weight and its standard error, if they are known [kg/m²]
/// * `is_bound` – whether its filaments are independent of each other, so that a real web is more uneven
pub(super) fn headline(
    weight: Option<(f64, Option<f64>)>,
    patch: Option<&Unevenness>,
    is_bound: bool,
) -> String {
    let web =
        weight.map_or_else(|| "A web".to_owned(), |weight| format!("A web of {}", grams_with_error(weight)));
    match patch {
        Some(unevenness) => format!(
            "{web} that varies by {}{} over patches of {}{}.",
            if is_bound { "at least " } else { "" },
            per_cent(unevenness.cv, unevenness.standard_error),
            millimetres(unevenness.patch),
            if is_bound { ": its filaments are independent of each other" } else { "" }
        ),
        None => format!("{web}."),
    }
}

pub(super) fn per_cent(cv: f64, error: Option<f64>) -> String {
    format!("{}{THIN}%", plus_minus(cv * PER_CENT, error.map(|error| error * PER_CENT)))
}

/// Longest wave of variance that is the grain of single fibres, and no clouds [m].
const FINEST_CLOUDS: f64 = 2e-3;

/// Which octave of wavelength holds most of the variance, in a sentence.
pub(super) fn largest_clouds(clouds: &Clouds) -> Option<String> {
    let octaves = clouds.octaves();
    let whole: f64 = octaves.iter().map(|(_, variance)| variance.mean).sum();
    let (waves, variance) = octaves.iter().max_by(|a, b| a.1.mean.total_cmp(&b.1.mean))?;
    Some(format!(
        "Of all octaves of wavelength, that of {} to {} holds most of the variance: {} % of what lies between {} and \
         {}{}.",
        millimetres(waves[0]),
        millimetres(waves[1]),
        significant(PER_CENT * variance.mean / whole, 2),
        millimetres(clouds.shortest()),
        millimetres(clouds.longest()),
        if waves[1] > FINEST_CLOUDS { "" } else { ", which single fibres make more than clouds do" }
    ))
}
