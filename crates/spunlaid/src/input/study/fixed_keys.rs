//! What to write in place of a key that a study cannot vary.

use crate::case::keys;

/// Advice for a key whose values a study cannot vary.
pub(super) const TAKE_A_NUMBER: &str = "take a key whose value is a number or one of a few words";

/// Advice for a name that a study cannot vary.
pub(super) fn advice(name: &str) -> String {
    if let Some(key) = keys::find(name) {
        let in_study = |line| format!("write {line} in the study file, above its tables");
        return key.relations.in_study.map_or_else(|| TAKE_A_NUMBER.to_owned(), in_study);
    }
    match keys::nearest(name) {
        Some(key) if key.varies => format!("did you mean {}?", key.name),
        _ => "write the full name of a key of the case, like air.velocity".to_owned(),
    }
}
