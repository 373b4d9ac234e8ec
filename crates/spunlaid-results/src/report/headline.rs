//! Which patch a headline tells of, and how a basis weight is written.

use crate::numbers::{THIN, significant};
use spunlaid::web::{Findings, nearest_to_seen};

/// A basis weight in grams per square metre.
pub(super) fn grams(weight: f64) -> String {
    format!("{}{THIN}g/m²", significant(weight * 1e3, 3))
}

/// The patch nearest to what the eye judges first.
pub(super) fn headline_patch(findings: &Findings) -> Option<usize> {
    nearest_to_seen(findings.patches.iter().map(|patch| patch.map.patch))
}
