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

/// The tables of a case file and their keys, in one or several parts.
const TABLES: [(&str, &[&[Key]]); 9] = [
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
pub(super) const NAMES: [&str; TABLES.len()] = {
    let (mut names, mut i) = ([""; TABLES.len()], 0);
    while i < names.len() {
        names[i] = TABLES[i].0;
        i += 1;
    }
    names
};

const COUNT: usize = {
    let (mut count, mut i) = (0, 0);
    while i < TABLES.len() {
        let (parts, mut j) = (TABLES[i].1, 0);
        while j < parts.len() {
            count += parts[j].len();
            j += 1;
        }
        i += 1;
    }
    count
};

pub(super) static KEYS: [Key; COUNT] = {
    let mut all = [TABLES[0].1[0][0]; COUNT];
    let (mut count, mut i) = (0, 0);
    while i < TABLES.len() {
        let (parts, mut j) = (TABLES[i].1, 0);
        while j < parts.len() {
            let (keys, mut k) = (parts[j], 0);
            while k < keys.len() {
                all[count] = keys[k];
                count += 1;
                k += 1;
            }
            j += 1;
        }
        i += 1;
    }
    all
};
