//! The table of keys: one row for each, in the order of a case file.

// What the air is: its flow, its properties and its turbulence.
mod air {
    pub(super) mod flow;
    pub(super) mod numbers;
    pub(super) mod turbulence;
}
mod belt;
mod drag;
mod fibre;
mod run;
mod spinline;

use super::Key;
use super::key_table::{Table, count, joined, names};
use crate::case::Case;

/// The tables of a case file and their keys, in one or several parts.
const TABLES: [Table<Case>; 8] = [
    ("spinline", spinline::KEYS),
    ("spinline.material", spinline::MATERIAL),
    ("fibre", &[fibre::KEYS]),
    ("feed", &[belt::FEED]),
    ("belt", &[belt::KEYS]),
    ("air", &[air::flow::KEYS, air::numbers::KEYS, air::turbulence::KEYS]),
    ("drag", &[drag::KEYS]),
    ("run", &[run::KEYS]),
];

/// The names of the tables.
pub(super) const NAMES: [&str; TABLES.len()] = names(&TABLES);

pub(super) static KEYS: [Key; count(&TABLES)] = joined(&TABLES);
