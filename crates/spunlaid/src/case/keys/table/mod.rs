//! The table of keys: one row for each, in the order of a case file.

mod air;
mod belt;
mod drag;
mod feed;
mod fibre;
mod run;
mod spinline;

use super::Key;
use super::joined::{self, Table};
use crate::case::Case;

/// The tables of a case file and their keys, in one or several parts.
const TABLES: [Table<Case>; 8] = [
    ("spinline", spinline::KEYS),
    ("spinline.material", spinline::MATERIAL),
    ("fibre", &[fibre::KEYS]),
    ("feed", &[feed::KEYS]),
    ("belt", &[belt::KEYS]),
    ("air", air::KEYS),
    ("drag", &[drag::KEYS]),
    ("run", &[run::KEYS]),
];

/// The names of the tables.
pub(super) const NAMES: [&str; TABLES.len()] = joined::names(&TABLES);

pub(super) static KEYS: [Key; joined::count(&TABLES)] = joined::keys(&TABLES);
