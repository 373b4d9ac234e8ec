//! Reads the file of a case, of a web with the case of its filament, or of a study into its values, by a
//! table of keys. Each value remembers where it was written.
//!
//! A value has the full name of its key, `line.belt_speed`. In a list of tables the number of the entry stands in it,
//! `layer.2.line.rows.1.pitch`, and the list itself, `layer.2.line.rows`, has its length as value.

use super::Overrides;
use super::entry::{Entry, VERSION, check_version, in_order, kind, read as read_value, root};
use super::text_with_lines::TextWithLines;
use super::written_values::{WrittenValue, WrittenValues};
use spunlaid_fibre::case::keys::{CASE, Key, KeyTable, Kind, Omission, Relative, TableList, Value};
use spunlaid_ground::error::Place;
use spunlaid_ground::{Diagnostic, Error, Fault};
use spunlaid_simulation::layers::full_names::without_numbers;
use spunlaid_simulation::layers::keys::{WEB, WEB_FILE};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The entries of a file and of the overrides, and the problems found so far.
pub(super) struct Document<'a, T: 'static> {
    pub(super) keys: &'static KeyTable<T>,
    name: String,
    source: TextWithLines<'a>,
    version: Option<Entry<'a>>,
    pub(super) key_values: WrittenValues,
    /// What is wrong with values that cannot be read.
    faults: BTreeMap<String, Fault>,
    /// What stands in tables whose keys have any name, and values that another key reads.
    pub(super) named: Vec<Named<'a, T>>,
    /// Whether the file has a list of tables at its top, whose entries have tables of their own.
    pub(super) layered: bool,
}

/// A value that is read by what has its name: a key of another file, or a result.
pub(super) struct Named<'a, T: 'static> {
    pub(super) row: &'static Key<T>,
    pub(super) name: String,
    pub(super) entry: Entry<'a>,
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
    Ok(open(keys, text, name, overrides)?.key_values)
}

/// [`read`], with what is named by keys of other files.
///
/// # Errors
/// As [`read`].
pub(super) fn open<'a, T>(
    keys: &'static KeyTable<T>,
    text: &'a str,
    name: &str,
    overrides: &[Overrides<'a>],
) -> Result<Document<'a, T>, Error> {
    let source = TextWithLines::new(text, name);
    let key_values = WrittenValues::new(source.whole());
    let root = root(&source, text)?;
    check_kind(keys, &root, &source)?;
    let layered = keys.lists.iter().any(|list| root.contains_key(list.name));
    let name = name.to_owned();
    let faults = BTreeMap::new();
    let named = Vec::new();
    let mut document = Document { keys, name, source, version: None, key_values, faults, named, layered };
    document.take_table("", "", root, None);
    overrides.iter().for_each(|set| document.take_overrides(set));
    // A newer format may mean other things, so that no other problem counts.
    document.version.take().map_or(Ok(()), |entry| check_version(&entry))?;
    document.reject_unreadable();
    Ok(document)
}

/// Rejects a file of another kind, by a key or table at its top.
fn check_kind<T>(
    keys: &KeyTable<T>,
    root: &DeTable<'_>,
    source: &TextWithLines<'_>,
) -> Result<(), Vec<Diagnostic>> {
    type IsOf = fn(&str) -> bool;
    const KINDS: [(IsOf, &str, &str, &str, &str); 3] = [
        (|name| ["vary", "design"].contains(&name), "a study", "the file as a study", "`spunlaid sweep`", ""),
        (is_of_web_alone, "the file of a web", "it as a web", "`spunlaid web`", "web"),
        (|name| CASE.tables.contains(&name), "a case", "it as a case", "`spunlaid run`", "case"),
    ];
    for (is_of, kind, it, command, base) in KINDS.into_iter().filter(|(_, kind, ..)| *kind != keys.noun) {
        let is_other = |name: &str, value: &DeValue<'_>| {
            // A study names its web or spinline; a web or a case has tables.
            let is_own_key = keys.find(name).is_some() && !value.is_table();
            is_of(name) && !is_own_key && keys.table_in("", name).is_none() && keys.list(name).is_none()
        };
        let others = root.iter().filter(|(key, value)| is_other(key.get_ref(), value.get_ref()));
        if let Some((key, value)) = others.min_by_key(|(key, _)| key.span().start) {
            let (name, place) = (key.get_ref(), source.place(key.span().start));
            let key = if value.get_ref().is_table() { format!("[{name}]") } else { name.to_string() };
            let remedy = match keys.find(base) {
                Some(_) => format!("name its file, as in {base} = \"{base}.toml\", or read {it}"),
                None => format!("read {it}"),
            };
            let what = Fault::new(format!("belongs to {kind}, not to {}", keys.noun), remedy).option(command);
            return Err(vec![Diagnostic { place, key, ..what.into() }]);
        }
    }
    Ok(())
}

/// Whether a table at the top of a file is one of a web, which a case has not.
fn is_of_web_alone(name: &str) -> bool {
    WEB.tables.contains(&name) && !CASE.tables.contains(&name)
}

/// Whether a file has tables of a web, which a case has not.
pub(super) fn is_of_web(text: &str) -> bool {
    // A study names its web.
    let is_of_web = |root: &DeTable<'_>| {
        root.iter().any(|(key, value)| is_of_web_alone(key.get_ref()) && !value.get_ref().is_str())
    };
    DeTable::parse(text).is_ok_and(|root| is_of_web(root.get_ref()))
}

/// Whether this is the full name of a table of a case or a web, which may be one of a layer: `air`, `layer.2.line`.
fn is_table_of_other(full: &str) -> bool {
    let in_layer = full.strip_prefix("layer.").and_then(|rest| rest.split_once('.'));
    let name = without_numbers(in_layer.map_or(full, |(_, rest)| rest));
    WEB_FILE.tables.contains(&&*name) || WEB.list(&name).is_some()
}

impl<'a, T> Document<'a, T> {
    /// Takes what stands in a table: keys, tables and lists. The top of the file is a table without a name.
    ///
    /// * `before` – what comes before its keys in their full names, `layer.2.line.`
    /// * `list` – the override in which it stands
    pub(super) fn take_table(
        &mut self,
        before: &str,
        table: &'static str,
        keys: DeTable<'a>,
        list: Option<&Entry<'a>>,
    ) {
        for ((at, name), value) in in_order(keys) {
            let entry = self.entry(at, value, list);
            self.take(before, table, &name, entry);
        }
    }

    /// An entry that stands at byte `at` of the file, or in an override; a position in it is not one in the file.
    pub(super) fn entry(
        &self,
        at: usize,
        value: Spanned<DeValue<'a>>,
        list: Option<&Entry<'a>>,
    ) -> Entry<'a> {
        let mut entry = Entry::from_file(&self.source, at, value);
        if let Some(Entry { place, shown, .. }) = list {
            (entry.place, entry.shown) = (place.clone(), shown.clone());
        }
        entry
    }

    pub(super) fn reject(&mut self, key: &str, entry: &Entry<'_>, what: Fault) {
        self.key_values.problems.push(entry.problem(key, what));
    }

    /// Takes what stands in a table by its name: a key, a table or a list. What is unknown is rejected.
    pub(super) fn take(&mut self, before: &str, table: &'static str, name: &str, entry: Entry<'a>) {
        let full = format!("{before}{name}");
        let path = if table.is_empty() { name.to_owned() } else { format!("{table}.{name}") };
        let key = self.keys.find(&path).filter(|key| key.table() == table);
        let is_inner = key.is_none() || entry.value.is_table();
        if full == VERSION {
            self.version = Some(entry);
        } else if let Some(list) = self.keys.list(&path) {
            self.take_list(&full, list, entry);
        } else if let Some(inner) = self.keys.table_in(table, name).filter(|_| is_inner) {
            self.take_inner(&full, inner, entry);
        } else if let Some(row) = key.filter(|key| matches!(key.kind, Kind::Other(_))) {
            self.named.push(Named { row, name: full, entry });
        } else if let Some(key) = key {
            self.read_entry(&full, key, entry);
        } else if let Some(row) = self.keys.of_any_name(table) {
            self.take_named(row, "", name, entry);
        } else {
            self.unknown(before, table, name, &entry);
        }
    }

    /// Takes a value with the name of a key of another file, or what stands in a table of that file:
    /// `air.velocity = …` and `"air.velocity" = …` are equal.
    fn take_named(&mut self, row: &'static Key<T>, before: &str, name: &str, entry: Entry<'a>) {
        let name = format!("{before}{name}");
        match entry.value {
            DeValue::Table(keys) if before == "layer." || is_table_of_other(&name) => {
                for ((at, inner), value) in in_order(keys) {
                    let entry = self.entry(at, value, None);
                    self.take_named(row, &format!("{name}."), &inner, entry);
                }
            }
            value => self.named.push(Named { row, name, entry: Entry { value, ..entry } }),
        }
    }

    /// What is named in a table, in the order of the file.
    pub(super) fn named(&mut self, table: &str) -> Vec<Named<'a, T>> {
        let all = std::mem::take(&mut self.named).into_iter();
        let (mut of_table, others): (Vec<_>, _) = all.partition(|named| named.row.table() == table);
        self.named = others;
        of_table.sort_by_key(|named| named.entry.at);
        of_table
    }

    /// Takes a table within another one, or at the top of the file.
    fn take_inner(&mut self, full: &str, table: &'static str, mut entry: Entry<'a>) {
        let header = if full == table { format!("[{table}]") } else { format!("[layer.{table}]") };
        if self.layered && full == table && self.list_of(table).is_some() && !self.keys.is_common(table) {
            let remedy = format!("write [layer.{table}] below the [[layer]] that it belongs to");
            entry.shown = None;
            self.reject(&header, &entry, Fault::new("cannot be combined with [[layer]]", remedy));
            return;
        }
        let what = match (&entry.place, std::mem::replace(&mut entry.value, DeValue::Boolean(false))) {
            (Place::Override(word), _) => {
                entry.shown = None;
                Fault::wrong_type("a table", format!("one of its keys, {word} {full}.key=value"))
            }
            (_, DeValue::Table(keys)) => {
                let needed =
                    self.keys.of_any_name(table).filter(|row| matches!(row.omission, Omission::Required(_)));
                match needed.filter(|_| keys.is_empty()) {
                    None => return self.take_table(&format!("{full}."), table, keys, None),
                    Some(row) => Fault::new("is empty", format!("add a key, like {}", row.example())),
                }
            }
            (_, other) => Fault::wrong_type(kind(&other), format!("a table, {header}")),
        };
        self.key_values.suppress_missing(format!("{full}."));
        self.reject(full, &entry, what);
    }

    /// Takes a list of tables in place of the one there was.
    fn take_list(&mut self, full: &str, list: &'static TableList, mut entry: Entry<'a>) {
        self.key_values.remove(full);
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
                self.key_values.suppress_missing(format!("{full}."));
            }
        }
    }

    /// The list at the top of the file in whose entries this table can stand.
    pub(super) fn list_of(&self, table: &str) -> Option<&'static TableList> {
        self.keys.lists.iter().find(|list| list.tables.contains(&table))
    }

    /// An entry as a value of this kind.
    pub(super) fn as_kind(&self, kind: &Kind, entry: &Entry<'_>) -> Result<Value, Fault> {
        read_value(kind, &entry.value, |named| self.beside(&entry.place, named))
    }

    /// The value of a key: what is written, or else its default.
    pub(super) fn value(&self, name: &str) -> Option<Value> {
        match (self.key_values.get(name), self.keys.find(name)?) {
            (Some(written_value), _) => written_value.value.clone(),
            (None, Key { kind, omission: Omission::Value(text), .. }) => kind.accept((*text).into()).ok(),
            (None, _) => None,
        }
    }

    /// The number that a key has so far, written or by default.
    fn number_before(&self, full: &str, key: &Key<T>) -> Option<f64> {
        // A web may say it in its own words, and in those of a case.
        let of_case = key.relations.same_in_case.and_then(|name| {
            let layer = full.strip_suffix(key.name).unwrap_or_default();
            self.key_values.get(&format!("{layer}{name}")).or_else(|| self.key_values.get(name))
        });
        match (self.key_values.get(full).or(of_case), key.omission) {
            (Some(written_value), _) => written_value.value.as_ref()?.number(),
            // Its default does not count where another key gives the value.
            (None, Omission::Value(_)) if self.is_said_in_other_words(key) => None,
            (None, Omission::Value(text)) => key.kind.accept(text.into()).ok()?.number(),
            (None, _) => None,
        }
    }

    /// Whether a key is written, in any layer, in whose place this one would stand.
    fn is_said_in_other_words(&self, key: &Key<T>) -> bool {
        let others = self.keys.replaced_by(&[key.name]);
        self.key_values.all().any(|(full, _)| {
            let name = without_numbers(full);
            others.contains(&name.strip_prefix("layer.").unwrap_or(&name))
        })
    }

    /// Reads the value of a key in place of the one there was.
    fn read_entry(&mut self, full: &str, key: &'static Key<T>, entry: Entry<'_>) {
        let Entry { place, shown, value, .. } = entry;
        let value = match value {
            DeValue::String(unit) if key.relations.takes_unit && unit.chars().all(char::is_alphabetic) => {
                DeValue::String(format!("1 {unit}").into())
            }
            value => value,
        };
        let change = match (&place, value.as_str()) {
            (Place::Override(_), Some(text)) => Relative::read(&key.kind, text),
            _ => Ok(None),
        };
        let read = match (value.as_str(), change) {
            (Some(word), _) if key.words.contains(&word) => Ok(word.into()),
            (_, Ok(Some(change))) => {
                let remedy = match (key.omission, key.needed_if) {
                    (Omission::Follows(from), None) => format!("write the value itself; without one, {from}"),
                    _ => format!("write the value itself, like {}", key.example()),
                };
                change.of(self.number_before(full, key), &key.kind, remedy)
            }
            (_, Ok(None)) => read_value(&key.kind, &value, |named| self.beside(&place, named)),
            (_, Err(fault)) => Err(fault),
        };
        let (value, fault) = match read {
            Ok(value) => (Some(value), None),
            Err(fault) => (None, Some(fault.or_words(key.words))),
        };
        self.key_values.set(full.to_owned(), WrittenValue { place, shown, value });
        self.faults.extend(fault.map(|fault| (full.to_owned(), fault)));
    }

    /// Records what is wrong with the values that have been taken and cannot be read, unless others replace them.
    pub(super) fn reject_unreadable(&mut self) {
        for (full, fault) in std::mem::take(&mut self.faults) {
            if self.key_values.get(&full).is_some_and(|written_value| written_value.value.is_none()) {
                self.key_values.reject(&full, fault);
            }
        }
    }

    /// The path that an entry names. It is relative to the folder of the file, or to the working directory if
    /// the entry is an override.
    pub(super) fn beside(&self, place: &Place, named: &str) -> PathBuf {
        match (place, Path::new(&self.name).parent()) {
            (Place::Override(_), _) | (_, None) => PathBuf::from(named),
            (_, Some(folder)) => folder.join(named),
        }
    }
}
