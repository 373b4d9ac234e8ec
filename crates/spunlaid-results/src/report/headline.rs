//! Which patch a headline tells of, and how a basis weight is written.

use crate::numbers::{THIN, significant};
use spunlaid::web::Findings;

/// Size of the patches that the eye judges first [m].
const SEEN: f64 = 10e-3;

/// A basis weight in grams per square metre.
pub(super) fn grams(weight: f64) -> String {
    format!("{}{THIN}g/m²", significant(weight * 1e3, 3))
}

/// The patch nearest to what the eye judges first.
pub(super) fn headline_patch(findings: &Findings) -> Option<usize> {
    nearest(findings.patches.iter().map(|patch| patch.map.patch))
}

/// Which of the sides of patches is nearest to what the eye judges first.
pub(super) fn nearest(patches: impl Iterator<Item = f64>) -> Option<usize> {
    let far = |patch: f64| (patch / SEEN).ln().abs();
    patches.map(far).enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
}
