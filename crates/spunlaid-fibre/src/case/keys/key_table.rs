//! The keys of a kind of input, and how its file is divided into tables.

use super::{Key, Omission, Value};
use crate::case::Case;
use spunlaid_ground::Fault;
use spunlaid_ground::error::{by_similarity, nearest_word};

/// The keys of a kind of input: those of a case, or those of a web.
#[derive(Debug)]
pub struct KeyTable<T: 'static = Case> {
    /// A row for each key, in the order of the file.
    pub rows: &'static [Key<T>],
    /// The tables at the top of its file, in order, and the lists of tables.
    pub tables: &'static [&'static str],
    /// Its lists of tables.
    pub lists: &'static [TableList],
    /// The input in words, `a case`.
    pub noun: &'static str,
    /// Its file in words, `a case file`.
    pub file: &'static str,
}

/// A list of tables in a file, like `[[layer]]`. An entry has a number in the full name of its keys,
/// `layer.2.line.belt_speed`.
#[derive(Debug)]
pub struct TableList {
    /// Its name with the table in which it stands, `line.rows`.
    pub name: &'static str,
    /// The tables that stand in each of its entries.
    pub tables: &'static [&'static str],
    /// Those of them that may also stand once, at the top of the file, and then hold for all entries.
    pub common: &'static [&'static str],
    /// What an entry is, `a layer`.
    pub entry: &'static str,
    /// What to write, in words.
    pub wanted: &'static str,
}

impl<T> KeyTable<T> {
    /// The other keys whose values these keys give, if all of them are set: each may be replaced by them. Of a web
    /// with its cases these are also the keys of the cases that they give, and those that give one of these.
    pub fn replaced_by(&self, names: &[&str]) -> Vec<&'static str> {
        let mut replaced: Vec<&'static str> = Vec::new();
        let relations = || self.rows.iter().filter(|key| !key.relations.alternative_to.is_empty());
        loop {
            let gives = |name: &str| names.contains(&name) || replaced.contains(&name);
            let others = relations().flat_map(|key| match key.relations.alternative_to {
                others if gives(key.name) => others.to_vec(),
                others if others.iter().all(|other| gives(other)) => vec![key.name],
                _ => Vec::new(),
            });
            let Some(next) = others.into_iter().find(|other| !gives(other)) else { break };
            replaced.push(next);
        }
        let is_one_named = |key: &&Key<T>| {
            key.relations.gives_one && key.relations.alternative_to.iter().any(|other| names.contains(other))
        };
        replaced.extend(self.rows.iter().filter(is_one_named).map(|key| key.name));
        for key in self.rows {
            let of_case = key.relations.gives_case;
            if names.contains(&key.name) {
                replaced.extend(of_case);
            } else if of_case.iter().any(|name| names.contains(name) || replaced.contains(name)) {
                replaced.push(key.name);
            }
        }
        replaced.retain(|name| !names.contains(name));
        replaced
    }

    /// Whether a table may stand at the top of the file beside the list in whose entries it stands.
    pub fn is_common(&self, table: &str) -> bool {
        let top = table.split('.').next().unwrap_or(table);
        self.lists.iter().any(|list| list.common.contains(&top))
    }

    /// Whether written keys give the value of a key in other words.
    pub fn is_given(&self, name: &str, is_written: impl Fn(&str) -> bool) -> bool {
        let gives = |key: &Key<T>| key.relations.alternative_to.contains(&name) && is_written(key.name);
        self.rows.iter().any(gives)
    }

    /// Whether one of two keys gives the value of the other, by their names.
    pub fn are_alternatives(&self, one: &str, other: &str) -> bool {
        let gives = |name, other| self.is_given(other, |written| written == name);
        gives(one, other) || gives(other, one)
    }

    /// Sets a key of an input: what is written, or else what applies without it.
    ///
    /// * `written` – its value, if it is written; none if that cannot be read
    /// * `missing` – what is wrong if it is needed and missing
    ///
    /// # Errors
    /// What is wrong with its value, or that it is missing.
    pub fn fill(
        &self,
        key: &Key<T>,
        input: &mut T,
        written: Option<Option<Value>>,
        is_written: impl Fn(&str) -> bool,
        missing: impl FnOnce(&T) -> Option<Fault>,
    ) -> Result<(), Fault> {
        match (written, key.default_in(input)) {
            (Some(None), _) => Ok(()),
            (Some(Some(value)), _) => match key.beside_alternative(is_written) {
                Some(fault) => Err(fault),
                // They are settled when all else is known.
                None if key.read_last => Ok(()),
                None => key.apply(input, &value),
            },
            // A key without a meaning for this input refuses its default, which is then not needed.
            (None, Some(text)) => {
                if !key.read_last {
                    drop(key.set(input, text));
                }
                Ok(())
            }
            _ if key.infer(input) || !key.is_needed(input) || self.is_given(key.name, is_written) => Ok(()),
            _ => missing(input).map_or(Ok(()), Err),
        }
    }

    /// What applies if a key is left out, in words, with backquotes around values and names of keys.
    pub fn left_out(&self, key: &Key<T>) -> String {
        let required = |example| format!("required, like `{example}`");
        let mut words = match key.omission {
            Omission::Required(example) => required(example),
            Omission::Value(value) => format!("`{value}`"),
            Omission::Follows(words) => words.to_owned(),
        };
        if let Some((when, value)) = key.default_if {
            words += &format!("; {}, `{value}`", when.words);
        }
        if let Some((when, example)) = key.needed_if {
            words += &format!("; {}, {}", when.words, required(example));
        }
        let is_instead = |other: &&Key<T>| other.relations.alternative_to.contains(&key.name);
        let instead = self.rows.iter().filter(is_instead).map(|other| format!("`{}`", other.name));
        let instead = instead.collect::<Vec<_>>().join(" or ");
        match key.omission {
            Omission::Required(_) if !instead.is_empty() => words + &format!(", unless {instead} is written"),
            _ => words,
        }
    }

    /// The key with this full name, `air.velocity`.
    pub fn find(&self, name: &str) -> Option<&'static Key<T>> {
        self.rows.iter().find(|key| key.name == name)
    }

    /// The keys of a table.
    pub fn keys_of_table(&self, table: &str) -> impl Iterator<Item = &'static Key<T>> {
        self.rows.iter().filter(move |key| key.table() == table)
    }

    /// The key with this short name, if exactly one table has such a key.
    pub fn find_by_short_name(&self, name: &str) -> Option<&'static Key<T>> {
        // The air of a spinline has the names of the air, which are meant more often.
        let of_spinline = |key: &&Key<T>| key.table().starts_with("spinline");
        let only = |is_wanted: &dyn Fn(&&Key<T>) -> bool| {
            let homes = self.rows.iter().filter(|key| key.short() == name && !self.is_within(key.table()));
            let mut homes = homes.filter(is_wanted);
            let home = homes.next();
            if homes.next().is_some() { None } else { home }
        };
        only(&|key| !of_spinline(key)).or_else(|| only(&of_spinline))
    }

    /// The keys of any table that are similar to one written in `table`, or that have such a synonym, the most
    /// similar first.
    pub fn like(&self, table: &str, key: &str) -> Vec<&'static Key<T>> {
        // Of equally similar keys, prefer the one of the same table.
        let bonus = |home: &str| if home == table { 0.05 } else { 0.0 };
        let spellings = |known: &'static Key<T>| {
            let words = std::iter::once(known.short()).chain(known.synonyms.iter().copied());
            words.map(move |word| (known, word, bonus(known.table())))
        };
        let mut like = by_similarity(key, self.rows.iter().flat_map(spellings));
        let mut names = std::collections::BTreeSet::new();
        like.retain(|key| names.insert(key.name));
        like
    }

    /// The row of a table whose keys may have any name.
    pub fn of_any_name(&self, table: &str) -> Option<&'static Key<T>> {
        self.keys_of_table(table).find(|key| key.short() == "*")
    }

    /// Whether a table has no place of its own in the file: it stands in place of a value.
    pub fn is_within(&self, table: &str) -> bool {
        !table.is_empty() && !self.tables.contains(&table) && self.list(table).is_none()
    }

    /// The list with this name.
    pub fn list(&self, name: &str) -> Option<&'static TableList> {
        self.lists.iter().find(|list| list.name == name)
    }

    /// The tables that stand in a table, or at the top of the file: `spinline.material` stands in `spinline`.
    pub fn tables_in(&self, table: &str) -> Vec<&'static str> {
        match self.list(table) {
            Some(list) => list.tables.to_vec(),
            None => self.tables.iter().copied().filter(|inner| parent(inner) == table).collect(),
        }
    }

    /// The table that stands in another one, or at the top of the file.
    pub fn table_in(&self, table: &str, name: &str) -> Option<&'static str> {
        let is_named = |inner: &&str| inner.rsplit('.').next() == Some(name);
        self.tables_in(table).into_iter().find(|one| is_named(one) && self.list(one).is_none())
    }

    /// The table that is most similar to a misspelt one.
    pub fn nearest_table(&self, table: &str, name: &str) -> Option<&'static str> {
        nearest_word(name, self.tables_in(table).into_iter())
    }

    /// A table or list of the file as it is written, `[air]` or `[[layer]]`.
    pub fn header(&self, table: &str) -> String {
        match self.list(table) {
            Some(_) => format!("[[{table}]]"),
            None if self.is_within(table) => format!("a {table}"),
            None => format!("[{table}]"),
        }
    }
}

/// The table in which a table stands; empty for one at the top of the file.
fn parent(table: &str) -> &str {
    table.rsplit_once('.').map_or("", |(parent, _)| parent)
}

/// Name of a table, and its keys in one or several parts.
pub type Table<T> = (&'static str, &'static [&'static [Key<T>]]);

/// The names of tables.
pub const fn names<T, const TABLES: usize>(tables: &[Table<T>; TABLES]) -> [&'static str; TABLES] {
    let (mut names, mut i) = ([""; TABLES], 0);
    while i < names.len() {
        names[i] = tables[i].0;
        i += 1;
    }
    names
}

/// Number of keys of tables.
pub const fn count<T>(tables: &[Table<T>]) -> usize {
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
pub const fn joined<T, const COUNT: usize>(tables: &[Table<T>]) -> [Key<T>; COUNT] {
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
