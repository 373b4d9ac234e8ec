//! The rows of the keys of a web, in the order of its file. A row says what its values are, where a web has it and what
//! it has to do with other keys.

mod fibre;
mod line;
mod web;

pub use fibre::{NUMBERS, ONE_SOURCE};

use super::access::WebKey;
use crate::layers::WebSpec;
use spunlaid_fibre::case::keys::Sign;
use spunlaid_fibre::case::keys::key_table::{Table, count, joined, names};
use spunlaid_fibre::case::keys::row::{NewKey, quantity};
use spunlaid_ground::Dimension;

/// Most filaments of a row, and per metre.
pub(super) const MOST_FILAMENTS: u64 = 10_000_000;
/// Why two numbers cannot both be written.
pub const EITHER: &str = "either gives the other; write one of the two";

/// A length, speed or other quantity above zero, which a study may vary.
pub(super) const fn positive(name: &'static str, dimension: Dimension, usual: (f64, f64)) -> NewKey {
    quantity(name, dimension, Sign::Positive, usual)
}

/// The tables of the file of a web and their keys.
const TABLES: [Table<WebSpec>; 6] = [
    ("layer", &[fibre::LAYER]),
    ("fibre", &[fibre::KEYS]),
    ("laydown", &[fibre::LAYDOWN]),
    ("line", &[line::KEYS, line::DEFECTS]),
    ("web", &[web::KEYS]),
    ("fabric", &[web::FABRIC]),
];

/// The tables of the file of a web, in order. A file with several layers has the first ones, up to `line`, in
/// each `[[layer]]`.
pub const WEB_TABLES: [&str; TABLES.len()] = names(&TABLES);

/// Every key of the file of a web, in its order.
pub const WEB_KEYS: &[WebKey] = &KEYS;

static KEYS: [WebKey; count(&TABLES)] = joined(&TABLES);
