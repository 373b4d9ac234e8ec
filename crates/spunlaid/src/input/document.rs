//! Reads the file of a case, or of a web with the case of its filament, into its values. Each remembers where it was written.
//!
//! A value has the full name of its key, `line.belt_speed`. In a list of tables the number of the entry stands in it,
//! `layer.2.line.rows.1.pitch`, and the list itself, `layer.2.line.rows`, has its length as value.

use super::entry::{Entry, VERSION, check_version, in_order, kind, root};
use super::source::{Source, fit};
use super::written_values::{WrittenValue, WrittenValues};
use super::{Overrides, values};
use crate::case::keys::{CASE, Key, KeyTable, TableList, Value};
use crate::error::{Error, Fault, Finding, Place};
use crate::layers::keys::WEB;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The entries of a file and of the overrides, and the problems found so far.
pub(super) struct Document<'a, T: 'static> {
    pub(super) keys: &'static KeyTable<T>,
    name: String,
    source: Source<'a>,
    version: Option<Entry<'a>>,
    pub(super) entries: BTreeMap<String, (&'static Key<T>, Entry<'a>)>,
    pub(super) key_values: WrittenValues,
    /// Whether the file has a list of tables at its top, whose entries have tables of their own.
    pub(super) layered: bool,
}

/// Reads the values of the file called `name` and of the overrides.
///
/// # Errors
/// If the text is not TOML, is a file of another kind, or has a format that is newer than this library.
pub(super) fn read<'a, T>(
    keys: &'static KeyTable<T>,
    text: &'a str,
    name: &str,
    overrides: &[Overrides<'a>],
) -> Result<WrittenValues, Error> {
    let source = Source::new(text, name);
    let key_values = WrittenValues::new(source.whole());
    let root = root(&source, text)?;
    for (key, value) in &root {
        if let Some(what) = other_file(keys, key.get_ref()) {
            let is_table = value.get_ref().is_table();
            let key_shown = if is_table { format!("[{}]", key.get_ref()) } else { key.get_ref().to_string() };
            let place = source.place(key.span().start);
            return Err(vec![Finding { place, key: key_shown, value: None, what }].into());
        }
    }
    let layered = keys.lists.iter().any(|list| root.contains_key(list.name));
    let (name, entries) = (name.to_owned(), BTreeMap::new());
    let mut document = Document { keys, name, source, version: None, entries, key_values, layered };
    document.take_table("", "", root, None);
    overrides.iter().for_each(|set| document.take_overrides(set));
    // A newer format may mean other things, so this check comes first.
    document.version.take().map_or(Ok(()), |entry| check_version(&entry))?;
    for (full, (key, entry)) in std::mem::take(&mut document.entries) {
        document.read_entry(full, key, entry);
    }
    Ok(document.key_values)
}

/// What a file is that has this key or table at its top, if it is of another kind.
fn other_file<T>(keys: &KeyTable<T>, name: &str) -> Option<Fault> {
    let (other, remedy, command) = match name {
        "vary" | "design" => ("a study", "read the file as a study", "`spunlaid sweep`"),
        _ if keys.tables.contains(&name) => return None,
        _ if WEB.tables.contains(&name) => ("the file of a web", "read it as a web", "`spunlaid web`"),
        _ => return None,
    };
    Some(Fault::new(format!("belongs to {other}, not to {}", keys.noun), remedy).option(command))
}

/// Whether a file has tables of a web, which a case has not.
pub(super) fn is_of_web(text: &str) -> bool {
    let is_own = |name: &str| WEB.tables.contains(&name) && !CASE.tables.contains(&name);
    // A study names its web.
    let is_of_web = |root: &DeTable<'_>| {
        root.iter().any(|(key, value)| is_own(key.get_ref()) && !value.get_ref().is_str())
    };
    DeTable::parse(text).is_ok_and(|root| is_of_web(root.get_ref()))
}

/// Whether the file of a web has a list of layers, whose numbers stand in the names of its keys.
pub(super) fn has_layers(text: &str) -> bool {
    DeTable::parse(text).is_ok_and(|root| root.get_ref().contains_key("layer"))
}

impl<'a, T> Document<'a, T> {
    /// Takes what stands in a table: keys, tables and lists. The top of the file is a table without a name.
    ///
    /// * `before` – what comes before its keys in their full names, `layer.2.line.`
    /// * `list` – the override in which it stands
    fn take_table(&mut self, before: &str, table: &'static str, keys: DeTable<'a>, list: Option<&Entry<'a>>) {
        for ((at, name), value) in in_order(keys) {
            let entry = self.entry(at, value, list);
            self.take(before, table, &name, entry);
        }
    }

    /// An entry that stands at byte `at` of the file, or in an override; a position in it is not one in the file.
    fn entry(&self, at: usize, value: Spanned<DeValue<'a>>, list: Option<&Entry<'a>>) -> Entry<'a> {
        let mut entry = Entry::from_file(&self.source, at, value);
        if let Some(Entry { place, shown, .. }) = list {
            (entry.place, entry.shown) = (place.clone(), shown.clone());
        }
        entry
    }

    fn reject(&mut self, key: &str, entry: &Entry<'_>, what: Fault) {
        self.key_values.problems.push(entry.problem(key, what));
    }

    /// Takes what stands in a table by its name: a key, a table or a list. What is unknown is rejected.
    pub(super) fn take(&mut self, before: &str, table: &'static str, name: &str, entry: Entry<'a>) {
        let full = format!("{before}{name}");
        let path = if table.is_empty() { name.to_owned() } else { format!("{table}.{name}") };
        if full == VERSION {
            self.version = Some(entry);
        } else if let Some(list) = self.keys.list(&path) {
            self.take_list(&full, list, entry);
        } else if let Some(inner) = self.keys.table_in(table, name) {
            self.take_inner(&full, inner, entry);
        } else if let Some(key) = self.keys.find(&path).filter(|key| key.table() == table) {
            self.entries.insert(full, (key, entry));
        } else {
            self.unknown(before, table, name, &entry);
        }
    }

    /// Takes a table within another one, or at the top of the file.
    fn take_inner(&mut self, full: &str, table: &'static str, mut entry: Entry<'a>) {
        let header = if full == table { format!("[{table}]") } else { format!("[layer.{table}]") };
        if self.layered && full == table && self.list_of(table).is_some() && !self.keys.is_common(table) {
            let remedy = format!("write [layer.{table}] below the [[layer]] that it belongs to");
            entry.shown = None;
            self.reject(&header, &entry, Fault::new("cannot stand beside [[layer]]", remedy));
            return;
        }
        let what = match (&entry.place, std::mem::replace(&mut entry.value, DeValue::Boolean(false))) {
            (Place::Override(word), _) => {
                entry.shown = None;
                Fault::wrong_type("a table", format!("one of its keys, {word} {full}.key=value"))
            }
            (_, DeValue::Table(keys)) => return self.take_table(&format!("{full}."), table, keys, None),
            (_, other) => Fault::wrong_type(kind(&other), format!("a table, {header}")),
        };
        self.key_values.excuse(format!("{full}."));
        self.reject(full, &entry, what);
    }

    /// Takes a list of tables in place of the one there was.
    fn take_list(&mut self, full: &str, list: &'static TableList, mut entry: Entry<'a>) {
        self.remove(full);
        let tables = match std::mem::replace(&mut entry.value, DeValue::Boolean(false)) {
            DeValue::Array(tables) if !tables.is_empty() => Ok(tables),
            DeValue::Array(_) => Err("an empty list"),
            other => Err(kind(&other)),
        };
        let value = tables.as_ref().ok().map(|tables| Value::Whole(tables.len() as u64));
        let (place, shown) = (entry.place.clone(), entry.shown.clone());
        self.key_values.set(full.to_owned(), WrittenValue { place, shown, value });
        if let Err(found) = tables {
            self.reject(full, &entry, Fault::wrong_type(found, list.wanted));
        }
        let of_override = Some(&entry).filter(|entry| matches!(entry.place, Place::Override(_)));
        for (number, table) in (1..).zip(tables.into_iter().flatten()) {
            let item = self.entry(table.span().start, table, of_override);
            let full = format!("{full}.{number}");
            if let DeValue::Table(keys) = item.value {
                self.take_table(&format!("{full}."), list.name, keys, of_override);
            } else {
                self.reject(&full, &item, Fault::wrong_type(kind(&item.value), list.wanted));
                self.key_values.excuse(format!("{full}."));
            }
        }
    }

    /// The list at the top of the file in whose entries this table can stand.
    pub(super) fn list_of(&self, table: &str) -> Option<&'static TableList> {
        self.keys.lists.iter().find(|list| list.tables.contains(&table))
    }

    /// Removes a key, or a list with all its entries.
    pub(super) fn remove(&mut self, full: &str) {
        self.key_values.remove(full);
        let in_list = |name: &str| name.strip_prefix(full).is_some_and(|rest| rest.starts_with('.'));
        self.entries.retain(|name, _| name != full && !in_list(name));
    }

    /// Rejects a key or a table that is not known where it stands.
    fn unknown(&mut self, before: &str, table: &'static str, name: &str, entry: &Entry<'_>) {
        let keys = self.keys;
        let word = name.split_once('.').map_or(name, |(word, _)| word);
        let is_of_table = word != name && keys.table_in(table, word).is_none();
        let is_table = !keys.tables_in(table).is_empty() && (entry.value.is_table() || is_of_table);
        let key = if is_table && before.is_empty() {
            format!("[{}]", fit(word))
        } else {
            format!("{before}{name}")
        };
        // The part of the name that says which layer it is of.
        let layer = before.match_indices('.').nth(1).map_or("", |(dot, _)| &before[..=dot]);
        let layer = if self.layered { layer } else { "" };
        let mut nearest = None;
        if is_table {
            let mut table_meant = keys.nearest_table(table, word);
            // If the table's name is not similar to a known one, its keys may show which table is meant.
            if let DeValue::Table(inner) = &entry.value {
                for (key, _) in inner {
                    table_meant =
                        table_meant.or_else(|| keys.find_by_short_name(key.get_ref()).map(Key::table));
                }
            }
            if let Some(meant) = table_meant {
                self.key_values.excuse(format!("{before}{meant}."));
                nearest = Some(self.header(layer, meant));
            }
        } else if let Some(home) = keys.find_by_short_name(name) {
            self.key_values.excuse(format!("{layer}{}", home.name));
            let what = Fault::misplaced(home.table(), home.short());
            self.reject(&key, entry, what);
            return;
        } else if let Some(meant) = keys.like(table, name).first() {
            let full = if meant.table() == table {
                format!("{before}{}", meant.short())
            } else {
                format!("{layer}{}", meant.name)
            };
            self.key_values.excuse(full.clone());
            nearest = Some(full);
        }
        let message = format!("is not a {} of {}", if is_table { "table" } else { "key" }, keys.file);
        let takes = if table.is_empty() {
            "the top of the file takes".to_owned()
        } else {
            format!("{} takes", self.header(layer, table))
        };
        let what = Fault::unknown(message, nearest, &takes, &self.known(table));
        let value = entry.shown.clone().filter(|_| !is_table);
        self.key_values.problems.push(Finding { value, ..entry.problem(&key, what) });
    }

    /// A table of the file as it is written.
    fn header(&self, layer: &str, table: &str) -> String {
        let of_a_layer = !layer.is_empty() && self.list_of(table).is_some();
        if of_a_layer { format!("[layer.{table}]") } else { self.keys.header(table) }
    }

    /// What a table or the top of the file takes.
    fn known(&self, table: &'static str) -> Vec<String> {
        let keys = self.keys;
        let version = table.is_empty().then(|| VERSION.to_owned());
        let names = keys.keys_of_table(table).map(|key| key.short().to_owned());
        let tables = keys
            .tables_in(table)
            .into_iter()
            .map(|inner| self.header(if table.is_empty() { "" } else { "layer." }, inner));
        let in_table = |list: &TableList| Some(list.name.strip_prefix(table)?.strip_prefix('.')?.to_owned());
        version.into_iter().chain(names).chain(tables).chain(keys.lists.iter().filter_map(in_table)).collect()
    }

    fn read_entry(&mut self, full: String, key: &'static Key<T>, entry: Entry<'_>) {
        let Entry { place, shown, value, .. } = entry;
        let value = match value {
            DeValue::String(unit) if key.relations.takes_unit && unit.chars().all(char::is_alphabetic) => {
                DeValue::String(format!("1 {unit}").into())
            }
            value => value,
        };
        let read = match value.as_str() {
            Some(word) if key.words.contains(&word) => Ok(word.into()),
            _ => values::read(&key.kind, &value, |named| self.beside(&place, named)),
        };
        let (value, fault) = match read {
            Ok(value) => (Some(value), None),
            Err(fault) => (None, Some(fault.or_words(key.words))),
        };
        self.key_values.set(full.clone(), WrittenValue { place, shown, value });
        if let Some(fault) = fault {
            self.key_values.reject(&full, fault);
        }
    }

    /// The path that an entry names. It is relative to the folder of the file, or to the working directory if
    /// the entry is an override.
    fn beside(&self, place: &Place, named: &str) -> PathBuf {
        match (place, Path::new(&self.name).parent()) {
            (Place::Override(_), _) | (_, None) => PathBuf::from(named),
            (_, Some(folder)) => folder.join(named),
        }
    }
}
