//! Reads a case file into its entries. Each entry remembers where it was written.

use super::entry::{Entry, VERSION, check_version, kind, root};
use super::source::{Source, fit};
use super::written::{WrittenValue, WrittenValues};
use super::{Overrides, values};
use crate::case::keys::{self, Key, TAYLOR};
use crate::error::{Error, Fault, Finding, Place};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::de::{DeTable, DeValue};

/// The value of an override that removes a key, so that its default applies.
pub(super) const AUTO: &str = "auto";

/// The entries of a case file and of the overrides, and the problems found so far.
pub(super) struct Document<'a> {
    name: String,
    source: Source<'a>,
    version: Option<Entry<'a>>,
    entries: BTreeMap<&'static str, Entry<'a>>,
    written: WrittenValues,
}

impl<'a> Document<'a> {
    /// Reads the values of the file called `name` and of the overrides.
    ///
    /// # Errors
    /// If the text is not TOML, or if its format is newer than this library.
    pub(super) fn read(
        text: &'a str,
        name: &str,
        overrides: &[Overrides<'a>],
    ) -> Result<WrittenValues, Error> {
        let source = Source::new(text, name);
        let written = WrittenValues::new(source.whole());
        let mut document =
            Self { name: name.to_owned(), source, version: None, entries: BTreeMap::new(), written };
        let root = root(&document.source, text)?;
        if let Some((key, what)) = root.keys().find_map(|key| Some((key, other_file(key.get_ref())?))) {
            let (place, key) = (document.place(key.span().start), key.get_ref().to_string());
            return Err(vec![Finding { place, key, value: None, what }].into());
        }
        document.take_root(root);
        for Overrides { values, word } in overrides {
            values.iter().for_each(|(key, value)| document.take_override(word, key.trim(), value));
        }
        // A newer format may mean other things, so this check comes first.
        document.version.take().map_or(Ok(()), |entry| check_version(&entry))?;
        for key in keys::all() {
            if let Some(entry) = document.entries.remove(key.name) {
                document.read_entry(key, entry);
            }
        }
        Ok(document.written)
    }

    fn read_entry(&mut self, key: &'static Key, entry: Entry<'_>) {
        let Entry { place, shown, value, .. } = entry;
        // A unit alone is one of it.
        let value = match value {
            DeValue::String(unit)
                if key.name == "air.field_unit" && unit.chars().all(char::is_alphabetic) =>
            {
                DeValue::String(format!("1 {unit}").into())
            }
            value => value,
        };
        let read = match value.as_str() {
            Some(name @ TAYLOR) if key.name == "air.cutoff_frequency" => Ok(name.into()),
            _ => values::read(&key.kind, &value, |named| self.beside(&place, named)),
        };
        let (value, fault) = match read {
            Ok(value) => (Some(value), None),
            Err(fault) => (None, Some(fault)),
        };
        self.written.set(key.name, WrittenValue { place, shown, value });
        if let Some(fault) = fault {
            self.written.reject(key.name, fault);
        }
    }

    fn place(&self, byte: usize) -> Place {
        self.source.place(byte)
    }

    fn take_root(&mut self, root: DeTable<'a>) {
        for (key, value) in root {
            let (at, name) = (key.span().start, key.into_inner());
            let entry = Entry::of_file(&self.source, at, value);
            match (table_named(&name), entry.value) {
                (Some(table), DeValue::Table(keys)) => {
                    for (key, value) in keys {
                        let (at, key) = (key.span().start, key.into_inner());
                        let entry = Entry::of_file(&self.source, at, value);
                        self.take_entry(table, &key, entry);
                    }
                }
                (Some(table), other) => {
                    self.written.excuse(format!("{table}."));
                    let wanted = format!("a table, [{table}]");
                    let what = Fault::wrong_type(kind(&other), wanted);
                    self.reject(entry.place, table, entry.shown, what);
                }
                (None, DeValue::Table(keys)) => self.reject_table(entry.place, &name, &keys),
                (None, value) => self.take_entry("", &name, Entry { value, ..entry }),
            }
        }
    }

    /// Takes an override, which replaces the value in the file. The value `auto` removes it.
    fn take_override(&mut self, word: &str, key: &str, text: &'a str) {
        if let Some(key) = keys::find(key).filter(|_| text.trim().trim_matches('"') == AUTO) {
            self.entries.remove(key.name);
            return;
        }
        let entry = Entry::of_override(word, text);
        match key.split_once('.') {
            Some((table, key)) => match table_named(table) {
                Some(table) => self.take_entry(table, key, entry),
                None => self.reject_table(entry.place, table, &DeTable::new()),
            },
            None => match table_named(key) {
                Some(table) => {
                    let wanted = format!("one of its keys, {word} {table}.key=value");
                    let what = Fault::wrong_type("a table", wanted);
                    self.reject(entry.place, table, None, what);
                }
                None => self.take_entry("", key, entry),
            },
        }
    }

    /// Takes an entry of a table or of the top of the file. Unknown keys are rejected.
    fn take_entry(&mut self, table: &'static str, key: &str, entry: Entry<'a>) {
        let full = if table.is_empty() { key.to_owned() } else { format!("{table}.{key}") };
        if full == VERSION {
            self.version = Some(entry);
            return;
        }
        if let Some(key) = keys::find(&full).filter(|key| key.table() == table) {
            self.entries.insert(key.name, entry);
            return;
        }
        let what = if let Some(home) = home_of(key) {
            self.written.excuse(home.name);
            Fault::misplaced(home.table(), home.short())
        } else {
            let nearest = keys::like_in(table, key).first().map(|key| key.name.to_owned());
            nearest.iter().for_each(|key| self.written.excuse(key));
            let (takes, known) = if table.is_empty() {
                (
                    "the top of the file takes".to_owned(),
                    std::iter::once(VERSION.to_owned()).chain(tables()).collect(),
                )
            } else {
                let known = keys::of_table(table).map(|key| key.short().to_owned());
                (format!("[{table}] takes"), known.collect::<Vec<_>>())
            };
            Fault::unknown("is not a key of a case file", nearest, &takes, &known)
        };
        self.reject(entry.place, &full, entry.shown, what);
    }

    fn reject_table(&mut self, place: Place, name: &str, keys: &DeTable<'_>) {
        let mut nearest = keys::nearest_word(name, keys::TABLES.into_iter());
        // If the table's name is not similar to a known one, its keys may show which table is meant.
        for (key, _) in keys {
            nearest = nearest.or_else(|| home_of(key.get_ref()).map(Key::table));
        }
        if let Some(table) = nearest {
            self.written.excuse(format!("{table}."));
        }
        let nearest = nearest.map(|table| format!("[{table}]"));
        self.reject(
            place,
            &format!("[{}]", fit(name)),
            None,
            Fault::unknown(
                "is not a table of a case file",
                nearest,
                "the tables are",
                &tables().collect::<Vec<_>>(),
            ),
        );
    }

    /// The path that an entry names. It is relative to the folder of the case file, or to the working directory if
    /// the entry is an override.
    fn beside(&self, place: &Place, named: &str) -> PathBuf {
        match (place, Path::new(&self.name).parent()) {
            (Place::Override(_), _) | (_, None) => PathBuf::from(named),
            (_, Some(folder)) => folder.join(named),
        }
    }

    /// Records a problem with something that is not a key.
    fn reject(&mut self, place: Place, key: &str, value: Option<String>, what: Fault) {
        self.written.problems.push(Finding { place, key: fit(key), value, what });
    }
}

/// What a file is that has this key or table at its top, if it is no case.
fn other_file(key: &str) -> Option<Fault> {
    match key {
        "vary" | "design" => {
            let fault = Fault::new("belongs to a study, not to a case", "read the file as a study");
            Some(fault.option("`spunlaid sweep`"))
        }
        "web" | "layer" | "laydown" => {
            let fault = Fault::new("belongs to the file of a web, not to a case", "read it as a web");
            Some(fault.option("`spunlaid web`"))
        }
        _ => None,
    }
}

/// The name of the table, if there is such a table.
pub(super) fn table_named(name: &str) -> Option<&'static str> {
    keys::TABLES.into_iter().find(|table| *table == name)
}

/// The tables as they are written: `[fibre]`.
fn tables() -> impl Iterator<Item = String> {
    keys::TABLES.into_iter().map(|table| format!("[{table}]"))
}

/// The key with this short name, if exactly one table has such a key.
fn home_of(name: &str) -> Option<&'static Key> {
    let mut homes = keys::all().iter().filter(|key| key.short() == name);
    let home = homes.next();
    if homes.next().is_some() { None } else { home }
}
