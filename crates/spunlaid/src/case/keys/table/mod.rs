//! The table of keys: one row for each, in the order of a case file.

mod air;
mod belt;
mod drag;
mod feed;
mod fibre;
mod neighbours;
mod run;
mod spinline;

use super::Key;
use super::joined::{self, Table};
use crate::case::Case;

/// The tables of a case file and their keys, in one or several parts.
const TABLES: [Table<Case>; 9] = [
    ("spinline", spinline::KEYS),
    ("spinline.material", spinline::MATERIAL),
    ("fibre", &[fibre::KEYS]),
    ("feed", &[feed::KEYS]),
    ("belt", &[belt::KEYS]),
    ("air", air::KEYS),
    ("drag", &[drag::KEYS]),
    ("neighbours", &[neighbours::KEYS]),
    ("run", &[run::KEYS]),
];

/// The names of the tables.
pub(super) const NAMES: [&str; TABLES.len()] = joined::names(&TABLES);

/// Number of the keys.
pub(crate) const COUNT: usize = joined::count(&TABLES);

pub(super) static KEYS: [Key; COUNT] = joined::keys(&TABLES);

/// The same without access to a case, for the file of a web, in which they stand too.
pub(crate) static DESCRIBED: [Key<()>; COUNT] = joined::without_access(&KEYS);
