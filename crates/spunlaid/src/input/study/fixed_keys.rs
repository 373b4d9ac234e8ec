//! What to write in place of a key that a study cannot vary.

use crate::case::keys;

/// Advice for a key whose values a study cannot vary.
pub(super) const TAKE_A_NUMBER: &str = "take a key whose value is a number or one of a few words";

/// Advice for a name that a study cannot vary.
pub(super) fn advice(name: &str) -> String {
    match name {
        "run.replicates" => return "write replicates = 10 in the study file, above its tables".to_owned(),
        "run.seed" => return "write seed = 1 in the study file, above its tables".to_owned(),
        _ => {}
    }
    if keys::find(name).is_some() {
        return TAKE_A_NUMBER.to_owned();
    }
    match keys::nearest(name) {
        Some(key) if key.varies => format!("did you mean {}?", key.name),
        _ => "write the full name of a key of the case, like air.velocity".to_owned(),
    }
}
