//! A case file taken apart into its entries, each with the place it was written.

use super::layout::{self, VERSION};
use super::source::{Source, fit};
use crate::case::Note;
use crate::case::keys::Quantity;
use crate::error::{Error, Fault, Finding, Place, Problem};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A value as written.
pub(super) struct Entry<'a> {
    pub(super) place: Place,
    /// Source text, made fit for a message; none for tables, whose text is all over the file.
    pub(super) shown: Option<String>,
    pub(super) value: DeValue<'a>,
}

/// The entries of a case file and of the overrides, by full key, and what is wrong with them so far.
pub(super) struct Document<'a> {
    name: String,
    source: Source<'a>,
    entries: BTreeMap<String, Entry<'a>>,
    pub(super) problems: Vec<Problem>,
    /// What there is to remark so far.
    pub(super) notes: Vec<Note>,
    /// Keys that are missed only because they are misspelt or misplaced; tables end in a dot.
    excused: Vec<String>,
}

impl<'a> Document<'a> {
    /// Takes apart the text of the file called `name`.
    ///
    /// # Errors
    /// When the text is not TOML.
    pub(super) fn new(text: &'a str, name: &str, overrides: &'a [(String, String)]) -> Result<Self, Error> {
        let mut document = Self {
            name: name.to_owned(),
            source: Source::new(text, name),
            entries: BTreeMap::new(),
            problems: Vec::new(),
            notes: Vec::new(),
            excused: Vec::new(),
        };
        let (root, faults) = DeTable::parse_recoverable(text);
        if !faults.is_empty() {
            return Err(Error::Rejected(faults.iter().map(|fault| document.source.syntax(fault)).collect()));
        }
        document.take_root(root.into_inner());
        for (key, value) in overrides {
            document.take_override(key.trim(), value);
        }
        Ok(document)
    }

    /// Takes out the entry of a full key, `fibre.length`.
    pub(super) fn take(&mut self, key: &str) -> Option<Entry<'a>> {
        self.entries.remove(key)
    }

    /// Has nothing told of keys that are missed; a table ends in a dot.
    pub(super) fn excuse(&mut self, keys: &str) {
        self.excused.push(keys.to_owned());
    }

    /// Whether there is an entry of a key.
    pub(super) fn has(&self, quantity: &Quantity) -> bool {
        self.entries.contains_key(quantity.key)
    }

    /// Place and text of every entry, by full key.
    pub(super) fn sources(&self) -> BTreeMap<String, (Place, Option<String>)> {
        let source = |entry: &Entry<'_>| (entry.place.clone(), entry.shown.clone());
        self.entries.iter().map(|(key, entry)| (key.clone(), source(entry))).collect()
    }

    /// The file as a place, for what it does not say.
    pub(super) fn whole(&self) -> Place {
        self.source.whole()
    }

    /// Whether a missing key has been told of as misspelt or misplaced.
    pub(super) fn is_excused(&self, key: &str) -> bool {
        self.excused.iter().any(|excuse| excuse == key || excuse.ends_with('.') && key.starts_with(excuse))
    }

    /// The problems in the order of the file, then of the overrides.
    pub(super) fn sorted<W>(mut findings: Vec<Finding<W>>) -> Vec<Finding<W>> {
        findings.sort_by(|a, b| a.place.cmp(&b.place));
        findings
    }

    fn place(&self, byte: usize) -> Place {
        self.source.place(byte)
    }

    fn take_root(&mut self, root: DeTable<'a>) {
        for (key, value) in root {
            let (place, name) = (self.place(key.span().start), key.into_inner());
            let entry = self.entry(place, value);
            match (layout::table(&name), entry.value) {
                (Some(table), DeValue::Table(keys)) => {
                    for (key, value) in keys {
                        let (place, key) = (self.place(key.span().start), key.into_inner());
                        let entry = self.entry(place, value);
                        self.take_entry(table, &key, entry);
                    }
                }
                (Some(table), other) => {
                    self.excused.push(format!("{table}."));
                    let wanted = format!("a table, [{table}]");
                    let what = Fault::WrongType { found: kind(&other), wanted };
                    self.reject(entry.place, table, entry.shown, what);
                }
                (None, DeValue::Table(keys)) => self.reject_table(entry.place, &name, &keys),
                (None, value) => self.take_entry("", &name, Entry { value, ..entry }),
            }
        }
    }

    fn entry(&self, place: Place, value: Spanned<DeValue<'a>>) -> Entry<'a> {
        let text = self.source.shown(value.span());
        let is_headed = value.get_ref().is_table() && !text.starts_with('{') || text.starts_with("[[");
        let shown = Some(text).filter(|_| !is_headed);
        Entry { place, shown, value: value.into_inner() }
    }

    /// An override replaces what the file says.
    fn take_override(&mut self, key: &str, text: &'a str) {
        let value = match DeValue::parse(text) {
            Ok(value) => value.into_inner(),
            Err(_) => DeValue::String(text.into()),
        };
        let shown = if value.is_str() && !text.trim_start().starts_with(['"', '\'']) {
            format!("\"{}\"", fit(text))
        } else {
            fit(text)
        };
        let entry = Entry { place: Place::Override, shown: Some(shown), value };
        match key.split_once('.') {
            Some((table, key)) => match layout::table(table) {
                Some(table) => self.take_entry(table, key, entry),
                None => self.reject_table(entry.place, table, &DeTable::new()),
            },
            None => match layout::table(key) {
                Some(table) => {
                    let wanted = format!("one of its keys, --set {table}.key=value");
                    let what = Fault::WrongType { found: "a table", wanted };
                    self.reject(entry.place, table, None, what);
                }
                None => self.take_entry("", key, entry),
            },
        }
    }

    /// Takes in an entry of a table, or of the top of the file, if it is known there.
    fn take_entry(&mut self, table: &'static str, key: &str, entry: Entry<'a>) {
        let full = full_key(table, key);
        if layout::keys_of(table).contains(&key) {
            self.entries.insert(full, entry);
            return;
        }
        let what = if let Some((table, key)) = layout::home_of(key) {
            self.excused.push(full_key(table, key));
            Fault::Misplaced { table, key }
        } else {
            let nearest = match layout::nearest_key(table, key) {
                Some((home, known)) => {
                    let nearest = full_key(home, known);
                    self.excused.push(nearest.clone());
                    Some(nearest)
                }
                None => None,
            };
            let (where_, known) = if table.is_empty() {
                ("the top of the file".to_owned(), vec![VERSION, "[fibre]", "[air]", "[drag]", "[run]"])
            } else {
                (format!("[{table}]"), layout::keys_of(table).to_vec())
            };
            Fault::UnknownKey { nearest, where_, known }
        };
        self.reject(entry.place, &full, entry.shown, what);
    }

    fn reject_table(&mut self, place: Place, name: &str, keys: &DeTable<'_>) {
        let mut nearest = layout::nearest_table(name);
        // By its keys, where its name tells nothing.
        for (key, _) in keys {
            nearest = nearest.or_else(|| layout::home_of(key.get_ref()).map(|(table, _)| table));
        }
        if let Some(table) = nearest {
            self.excused.push(format!("{table}."));
        }
        let nearest = nearest.map(|table| format!("[{table}]"));
        self.reject(place, &format!("[{}]", fit(name)), None, Fault::UnknownTable { nearest });
    }

    /// The path that an entry names: from the folder of the file, or from here where it is an override.
    pub(super) fn beside(&self, place: &Place, named: &str) -> PathBuf {
        match (place, Path::new(&self.name).parent()) {
            (Place::Override, _) | (_, None) => PathBuf::from(named),
            (_, Some(folder)) => folder.join(named),
        }
    }

    /// Notes down a problem.
    pub(super) fn reject(&mut self, place: Place, key: &str, value: Option<String>, what: Fault) {
        self.problems.push(Finding { place, key: fit(key), value, what });
    }
}

fn full_key(table: &str, key: &str) -> String {
    if table.is_empty() { key.to_owned() } else { format!("{table}.{key}") }
}

/// What kind of value this is, with its article.
pub(super) fn kind(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a text",
        DeValue::Integer(_) => "a whole number",
        DeValue::Float(_) => "a decimal number",
        DeValue::Boolean(_) => "a truth value",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}
