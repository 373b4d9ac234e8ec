//! Reads the file of a web into its values. Each remembers where it was written.

use super::super::entry::{Entry, VERSION, check_version, in_order, kind, root};
use super::super::source::{Source, fit};
use super::super::written::{WrittenValue, WrittenValues};
use super::super::{Overrides, values};
use crate::case::keys::{Value, nearest_word};
use crate::error::{Error, Fault, Finding, Place};
use crate::layers::{WEB_KEYS, WEB_TABLES, WebKey, keys};
use std::collections::BTreeMap;
use std::path::PathBuf;
use toml::de::{DeTable, DeValue};

/// The tables of which each layer has its own.
pub(super) const OF_A_LAYER: [&str; 3] = ["fibre", "laydown", "line"];
/// The only table that is not of a layer.
const OF_THE_WEB: &str = "web";
/// Tables that only a case has.
const OF_A_CASE: [&str; 5] = ["feed", "belt", "air", "drag", "run"];

/// What is written in the file of a web and in overrides.
pub(in crate::input) struct WebDocument {
    /// The values by full name: `line.belt_speed`; `layer.2.line.belt_speed` in a file with `[[layer]]`. The rows of nozzles
    /// are `line.rows.1.pitch` and so on, and `line.rows` is their number.
    pub(in crate::input) written: WrittenValues,
    /// What comes before the names of a layer's keys: `layer.2.`, or nothing in a file without `[[layer]]`.
    pub(super) layers: Vec<String>,
}

/// The entries of the file and of the overrides.
pub(super) struct Entries<'a> {
    source: Source<'a>,
    pub(super) written: WrittenValues,
    pub(super) version: Option<Entry<'a>>,
    /// The entries of keys by full name.
    entries: BTreeMap<String, (&'static WebKey, Entry<'a>)>,
    /// The lists of rows by full name, with their lengths.
    pub(super) rows: BTreeMap<String, (Place, Option<String>, u64)>,
    /// The names of the layers, if the file has `[[layer]]`.
    pub(super) names: Option<Vec<Option<String>>>,
}

/// Reads the values of the file called `name` and of the overrides.
///
/// # Errors
/// If the text is not TOML, is no web, or has a newer format.
pub(in crate::input) fn read(text: &str, name: &str, overrides: Overrides<'_>) -> Result<WebDocument, Error> {
    let source = Source::new(text, name);
    let written = WrittenValues::new(source.whole());
    let root = root(&source, text)?;
    if let Some((key, what)) = root.keys().find_map(|key| Some((key, other_file(key.get_ref())?))) {
        let (place, key) = (source.place(key.span().start), format!("[{}]", key.get_ref()));
        return Err(vec![Finding { place, key, value: None, what }].into());
    }
    let (entries, rows) = (BTreeMap::new(), BTreeMap::new());
    let mut document = Entries { source, written, version: None, entries, rows, names: None };
    document.take_root(root);
    for (key, value) in overrides.values {
        document.take_override(overrides.word, key.trim(), value);
    }
    // A newer format may mean other things, so this check comes first.
    document.version.take().map_or(Ok(()), |entry| check_version(&entry))?;
    Ok(document.read())
}

/// What a file is that has this key or table at its top, if it is no web.
fn other_file(key: &str) -> Option<Fault> {
    match key {
        "vary" | "design" => {
            let fault = Fault::new("belongs to a study, not to a web", "read the file as a study");
            Some(fault.option("`spunlaid sweep`"))
        }
        key if OF_A_CASE.contains(&key) => {
            let fault = Fault::new(
                "belongs to a case, not to a web",
                "a web names its case, as in [laydown] case = \"spunbond.toml\"",
            );
            Some(fault.option("`spunlaid run`"))
        }
        _ => None,
    }
}

/// The name of the table, if there is such a table.
pub(super) fn table_of<'t>(tables: &'t [&'static str], name: &str) -> Option<&'t &'static str> {
    tables.iter().find(|table| **table == name)
}

impl<'a> Entries<'a> {
    /// Reads the values of all keys.
    fn read(self) -> WebDocument {
        let Self { mut written, entries, rows, names, .. } = self;
        for (full, (key, entry)) in entries {
            // The paths are made where the files are read.
            let read = values::read(&key.kind, &entry.value, |named| PathBuf::from(named));
            let (value, fault) = match read {
                Ok(value) => (Some(value), None),
                Err(fault) => (None, Some(fault)),
            };
            written.set(full.clone(), WrittenValue { place: entry.place, shown: entry.shown, value });
            if let Some(fault) = fault {
                written.reject(&full, fault);
            }
        }
        for (full, (place, shown, count)) in rows {
            written.set(full, WrittenValue { place, shown, value: Some(Value::Whole(count)) });
        }
        let layers = match names {
            None => vec![String::new()],
            Some(names) => (1..=names.len()).map(|number| format!("layer.{number}.")).collect(),
        };
        WebDocument { written, layers }
    }

    fn take_root(&mut self, root: DeTable<'a>) {
        let layered = root.keys().any(|key| key.get_ref() == "layer");
        self.names = layered.then(Vec::new);
        for ((at, name), value) in in_order(root) {
            let entry = Entry::of_file(&self.source, at, value);
            match name.as_str() {
                VERSION => self.version = Some(entry),
                "layer" => self.take_layers(entry),
                OF_THE_WEB => self.take_table("", OF_THE_WEB, entry),
                name => match table_of(&OF_A_LAYER, name) {
                    Some(table) if layered => {
                        let what = Fault::new(
                            "cannot stand beside [[layer]]",
                            format!("write [layer.{table}] below the [[layer]] that it belongs to"),
                        );
                        let problem = entry.problem(&format!("[{table}]"), what);
                        self.written.problems.push(Finding { value: None, ..problem });
                    }
                    Some(table) => self.take_table("", table, entry),
                    None => self.unknown_at_top(name, &entry),
                },
            }
        }
    }

    fn take_layers(&mut self, entry: Entry<'a>) {
        let wanted = || {
            "a list of tables: [[layer]], and below it [layer.fibre], [layer.laydown] and [layer.line]"
                .to_owned()
        };
        let place = entry.place.clone();
        let list = match entry.value {
            DeValue::Array(list) if !list.is_empty() => list,
            other => {
                let found = if other.is_array() { "an empty list" } else { kind(&other) };
                let what = Fault::wrong_type(found, wanted());
                self.written.problems.push(Finding {
                    place,
                    key: "layer".to_owned(),
                    value: entry.shown,
                    what,
                });
                return;
            }
        };
        for (number, layer) in (1..).zip(list) {
            let entry = Entry::of_file(&self.source, layer.span().start, layer);
            let prefix = format!("layer.{number}.");
            let mut name = None;
            if let DeValue::Table(table) = entry.value {
                name = table.get("name").and_then(|name| name.get_ref().as_str()).map(ToOwned::to_owned);
                self.take_layer(&prefix, table);
            } else {
                self.written.excuse(prefix.clone());
                let what = Fault::wrong_type(kind(&entry.value), wanted());
                let key = format!("layer.{number}");
                self.written.problems.push(entry.problem(&key, what));
            }
            self.names.get_or_insert_default().push(name);
        }
    }

    fn take_layer(&mut self, prefix: &str, layer: DeTable<'a>) {
        for ((at, name), value) in in_order(layer) {
            let entry = Entry::of_file(&self.source, at, value);
            match (name.as_str(), table_of(&OF_A_LAYER, &name)) {
                ("name", _) => self.take_entry(prefix, "layer", "name", entry),
                (_, Some(table)) => self.take_table(prefix, table, entry),
                (name, None) => {
                    let nearest = nearest_word(name, OF_A_LAYER.into_iter());
                    nearest.iter().for_each(|table| self.written.excuse(format!("{prefix}{table}.")));
                    let nearest = nearest.map(|table| format!("[layer.{table}]"));
                    let known = ["name", "[layer.fibre]", "[layer.laydown]", "[layer.line]"];
                    let what = unknown(nearest, "[[layer]]", &known);
                    self.written.problems.push(entry.problem(&format!("{prefix}{name}"), what));
                }
            }
        }
    }

    /// Takes a table, which is of a layer if there is a prefix.
    fn take_table(&mut self, prefix: &str, table: &'static str, entry: Entry<'a>) {
        let DeValue::Table(keys) = entry.value else {
            self.written.excuse(format!("{prefix}{table}."));
            let wanted = format!("a table, [{}{table}]", if prefix.is_empty() { "" } else { "layer." });
            let what = Fault::wrong_type(kind(&entry.value), wanted);
            self.written.problems.push(entry.problem(&format!("{prefix}{table}"), what));
            return;
        };
        for ((at, key), value) in in_order(keys) {
            let entry = Entry::of_file(&self.source, at, value);
            if (table, key.as_str()) == ("line", "rows") {
                self.take_rows(prefix, entry);
            } else {
                self.take_entry(&format!("{prefix}{table}."), table, &key, entry);
            }
        }
    }

    /// Takes a list of rows of nozzles in place of the one there was.
    pub(super) fn take_rows(&mut self, prefix: &str, entry: Entry<'a>) {
        let full = format!("{prefix}line.rows");
        self.remove(&full);
        let wanted = || {
            "a list of rows, like [{ offset = \"0 mm\", pitch = \"0.2 mm\", filaments = 5000 }]".to_owned()
        };
        let (place, shown) = (entry.place.clone(), entry.shown.clone());
        let list = match entry.value {
            DeValue::Array(list) if !list.is_empty() => list,
            other => {
                self.written.excuse(format!("{prefix}line.filaments_per_metre"));
                let found = if other.is_array() { "an empty list" } else { kind(&other) };
                let what = Fault::wrong_type(found, wanted());
                self.written.problems.push(Finding { place, key: full, value: shown, what });
                return;
            }
        };
        self.rows.insert(full.clone(), (place.clone(), shown.clone(), list.len() as u64));
        for (number, row) in (1..).zip(list) {
            let of_row = format!("{full}.{number}.");
            match row.into_inner() {
                DeValue::Table(keys) => {
                    for ((at, key), value) in in_order(keys) {
                        let read = Entry::of_file(&self.source, at, value);
                        // Positions in an override are not positions in the file.
                        let entry = match &place {
                            Place::Override(_) => {
                                Entry { place: place.clone(), shown: shown.clone(), ..read }
                            }
                            _ => read,
                        };
                        self.take_entry(&of_row, "line.rows", &key, entry);
                    }
                }
                other => {
                    self.written.excuse(of_row);
                    let what = Fault::wrong_type(kind(&other), wanted());
                    let (place, value) = (place.clone(), shown.clone());
                    self.written.problems.push(Finding { place, key: full.clone(), value, what });
                }
            }
        }
    }

    /// Takes an entry of a table. Unknown keys are rejected.
    ///
    /// * `before` – what comes before its key in its full name
    pub(super) fn take_entry(&mut self, before: &str, table: &str, key: &str, entry: Entry<'a>) {
        let full = format!("{before}{key}");
        if let Some(known) = keys::of_table(table).find(|known| known.short() == key) {
            self.entries.insert(full, (known, entry));
            return;
        }
        let what = match home_of(key) {
            Some(home) => {
                self.written.excuse(home.name);
                Fault::misplaced(home.table(), home.short())
            }
            None => {
                let nearest = keys::nearest(table, key).map(|key| {
                    if key.table() == table {
                        format!("{before}{}", key.short())
                    } else {
                        key.name.to_owned()
                    }
                });
                nearest.iter().for_each(|key| self.written.excuse(key));
                let known =
                    keys::of_table(table).map(WebKey::short).chain((table == "line").then_some("rows"));
                unknown(nearest, &format!("[{table}]"), &known.collect::<Vec<_>>())
            }
        };
        self.written.problems.push(entry.problem(&full, what));
    }

    /// Removes a key, or a list of rows.
    pub(super) fn remove(&mut self, full: &str) {
        self.rows.remove(full);
        let of_a_row = |name: &str| name.strip_prefix(full).is_some_and(|rest| rest.starts_with('.'));
        self.entries.retain(|name, _| name != full && !of_a_row(name));
    }

    /// Rejects a key or table that the top of the file does not have.
    pub(super) fn unknown_at_top(&mut self, name: &str, entry: &Entry<'_>) {
        let is_table = entry.value.is_table();
        let word = name.split_once('.').map_or(name, |(table, _)| table);
        let what = match home_of(name).filter(|_| !is_table) {
            Some(home) => {
                self.written.excuse(home.name);
                Fault::misplaced(home.table(), home.short())
            }
            None => {
                let nearest = nearest_word(word, WEB_TABLES.into_iter());
                nearest.iter().for_each(|table| self.written.excuse(format!("{table}.")));
                let nearest =
                    nearest.map(
                        |table| if table == "layer" { "[[layer]]".to_owned() } else { format!("[{table}]") },
                    );
                let known = [VERSION, "[fibre]", "[laydown]", "[line]", "[web]", "[[layer]]"];
                unknown(nearest, "the top of the file", &known)
            }
        };
        let key = if is_table { format!("[{}]", fit(name)) } else { name.to_owned() };
        self.written.problems.push(entry.problem(&key, what));
    }
}

/// The fault of a name that `place`, a table or the top of the file, does not take.
fn unknown(nearest: Option<String>, place: &str, known: &[&str]) -> Fault {
    Fault::unknown("is unknown in the file of a web", nearest, &format!("{place} takes"), known)
}

/// The key with this short name, if exactly one table has such a key.
fn home_of(name: &str) -> Option<&'static WebKey> {
    let mut homes = WEB_KEYS.iter().filter(|key| key.short() == name);
    let home = homes.next();
    if homes.next().is_some() { None } else { home }
}
