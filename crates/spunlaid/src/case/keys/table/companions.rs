//! The companions of each replicate.

use super::super::Key;
use super::super::row::{Access, key};
use super::super::value::{Kind, Value};
use crate::air::Lateral;
use crate::case::companions::without_shared_air;
use crate::error::Fault;

/// Most companions in a direction.
const MOST: usize = 64;

pub(super) const KEYS: &[Key] = &[
    key("neighbours.cd", Kind::Lengths).access(of_companions!(cd)).follows("no companions").meaning(
        "Distances in cross direction at which companions fly beside each replicate, in the same air. The \
         results say how their motion, or the place where they come down, is correlated with that of the \
         replicate.",
    ),
    key("neighbours.md", Kind::Lengths)
        .access(of_companions!(md))
        .follows("no companions")
        .meaning("The same in machine direction."),
];

/// Distances that can be flown, in rising order.
fn distances(value: &Value) -> Result<Vec<f64>, Fault> {
    let Value::Numbers(distances) = value else {
        return Err(Fault::wrong_type(value.what(), Kind::Lengths.wanted()));
    };
    if distances.len() > MOST {
        let found = format!("names {} distances, and at most {MOST} are flown", distances.len());
        return Err(Fault::new(found, "leave some out"));
    }
    let mut distances = distances.clone();
    distances.sort_by(f64::total_cmp);
    distances.dedup();
    Ok(distances)
}
