//! The rows of the keys of a web, in the order of its file. A row says what its values are, where a web has it and what
//! it has to do with other keys.

mod defects;
mod fabric;
mod fibre;
mod laydown;
mod layer;
mod line;
mod web;

pub(crate) use laydown::{NUMBERS, ONE_SOURCE};
pub(crate) use web::METHODS;

use super::access::WebKey;
use crate::case::keys::joined::{self, Table};
use crate::case::keys::row::{NewKey, quantity};
use crate::case::keys::{self as case_keys, Key, Sign};
use crate::layers::WebSpec;
use crate::units::Dimension;

/// Most filaments of a row, and per metre.
pub(super) const MOST_FILAMENTS: u64 = 10_000_000;
/// Why two numbers cannot both be written.
pub(crate) const EITHER: &str = "either gives the other; write one of the two";

/// A length, speed or other quantity above zero, which a study may vary.
pub(super) const fn positive(name: &'static str, dimension: Dimension) -> NewKey {
    quantity(name, dimension, Sign::Positive)
}

/// The tables of the file of a web and their keys.
const TABLES: [Table<WebSpec>; 6] = [
    ("layer", &[layer::KEYS]),
    ("fibre", &[fibre::KEYS]),
    ("laydown", &[laydown::KEYS]),
    ("line", &[line::KEYS, defects::KEYS]),
    ("web", &[web::KEYS]),
    ("fabric", &[fabric::KEYS]),
];

/// The tables of the file of a web, in order. A file with several layers has the first ones, up to `line`, in each `[[layer]]`.
pub const WEB_TABLES: [&str; TABLES.len()] = joined::names(&TABLES);

/// Every key of the file of a web, in its order.
pub const WEB_KEYS: &[WebKey] = &KEYS;

static KEYS: [WebKey; joined::count(&TABLES)] = joined::keys(&TABLES);

/// Every key of the file of a web and of the filament that it flies. A key that both have stands here once, as that of the filament.
pub(super) static OF_FILE: [Key<()>; case_keys::COUNT + OWN] = {
    let (web, mut all) = (joined::without_access(&KEYS), [case_keys::DESCRIBED[0]; _]);
    let (mut count, mut i) = (0, 0);
    while i < case_keys::DESCRIBED.len() {
        all[count] = case_keys::DESCRIBED[i];
        (count, i) = (count + 1, i + 1);
    }
    i = 0;
    while i < web.len() {
        // Those of `[fibre]` are the first of a layer after its name.
        if i < layer::KEYS.len() || i >= layer::KEYS.len() + fibre::KEYS.len() {
            all[count] = web[i];
            count += 1;
        }
        i += 1;
    }
    all
};
const OWN: usize = joined::count(&TABLES) - fibre::KEYS.len();

/// The tables and the list of layers of such a file.
pub(super) static TABLES_OF_FILE: [&str; case_keys::TABLES.len() + TABLES.len() - 1] = {
    let (mut all, mut i) = ([""; case_keys::TABLES.len() + TABLES.len() - 1], 0);
    while i < case_keys::TABLES.len() {
        all[i] = case_keys::TABLES[i];
        i += 1;
    }
    let mut j = 0;
    while j < WEB_TABLES.len() {
        if !is_of_case(WEB_TABLES[j]) {
            all[i] = WEB_TABLES[j];
            i += 1;
        }
        j += 1;
    }
    all
};

/// Whether a table is one of the filament too.
const fn is_of_case(table: &str) -> bool {
    let mut i = 0;
    while i < case_keys::TABLES.len() {
        let (a, b) = (table.as_bytes(), case_keys::TABLES[i].as_bytes());
        let mut same = 0;
        while same < a.len() && same < b.len() && a[same] == b[same] {
            same += 1;
        }
        if same == a.len() && same == b.len() {
            return true;
        }
        i += 1;
    }
    false
}
