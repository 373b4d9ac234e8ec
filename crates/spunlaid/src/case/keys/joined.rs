//! Tables of keys, joined into one list while the program is compiled.

use super::{Key, Relations};

/// Name of a table, and its keys in one or several parts.
pub(crate) type Table<T> = (&'static str, &'static [&'static [Key<T>]]);

/// The names of tables.
pub(crate) const fn names<T, const TABLES: usize>(tables: &[Table<T>; TABLES]) -> [&'static str; TABLES] {
    let (mut names, mut i) = ([""; TABLES], 0);
    while i < names.len() {
        names[i] = tables[i].0;
        i += 1;
    }
    names
}

/// Number of keys of tables.
pub(crate) const fn count<T>(tables: &[Table<T>]) -> usize {
    let (mut count, mut i) = (0, 0);
    while i < tables.len() {
        let (parts, mut j) = (tables[i].1, 0);
        while j < parts.len() {
            count += parts[j].len();
            j += 1;
        }
        i += 1;
    }
    count
}

/// The keys of tables, one after another.
pub(crate) const fn keys<T, const COUNT: usize>(tables: &[Table<T>]) -> [Key<T>; COUNT] {
    let mut all = [tables[0].1[0][0]; COUNT];
    let (mut count, mut i) = (0, 0);
    while i < tables.len() {
        let (parts, mut j) = (tables[i].1, 0);
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
}

/// What a key says of its values and of other keys, without access to an input: for a file that describes
/// several inputs.
pub(crate) fn described<T>(key: &Key<T>) -> Key<()> {
    let of = &key.relations;
    let relations = Relations {
        alternative_to: of.alternative_to,
        remedy: of.remedy,
        read_after: of.read_after,
        gives: of.gives,
        takes_unit: of.takes_unit,
        in_study: of.in_study,
        same_in_case: of.same_in_case,
        gives_case: of.gives_case,
        of_all_layers: of.of_all_layers,
        ..Relations::NONE
    };
    Key {
        name: key.name,
        kind: key.kind,
        omission: key.omission,
        meaning: key.meaning,
        synonyms: key.synonyms,
        label: key.label,
        varies: key.varies,
        in_flight: key.in_flight,
        slider: key.slider,
        usual: key.usual,
        read_last: key.read_last,
        words: key.words,
        relations,
        get: |()| None,
        set: |(), _| Ok(()),
        derived: |()| false,
    }
}
