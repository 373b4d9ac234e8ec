//! Tables of keys, joined into one list while the program is compiled.

use super::Key;

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
