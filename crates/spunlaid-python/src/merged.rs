//! A case file with changes, as one text.

use spunlaid::case::keys::{self, Kind};
use std::collections::BTreeMap;
use std::path::{Path, absolute};
use toml::de::{DeTable, DeValue};

/// The text of a case file in which values are changed. Other values stay as they are written. Files that are named in
/// changes are seen from the working directory, so their names become full paths.
///
/// The text and the changes have been read as a case before; what cannot be read is left out here.
pub(crate) fn merged(text: &str, changes: &[(String, String)]) -> String {
    let mut tables: BTreeMap<String, BTreeMap<String, String>> = BTreeMap::new();
    let mut put = |table: &str, key: &str, value: Option<String>| {
        let entries = tables.entry(table.to_owned()).or_default();
        match value {
            Some(value) => drop(entries.insert(key.to_owned(), value)),
            None => drop(entries.remove(key)),
        }
    };
    let (root, _) = DeTable::parse_recoverable(text);
    for (name, value) in root.into_inner() {
        let span = value.span();
        match value.into_inner() {
            DeValue::Table(keys) => {
                for (key, value) in keys {
                    put(name.get_ref(), key.get_ref(), text.get(value.span()).map(str::to_owned));
                }
            }
            _ => put("", name.get_ref(), text.get(span).map(str::to_owned)),
        }
    }
    for name in replaced(changes) {
        let (table, key) = name.split_once('.').unwrap_or(("", name));
        put(table, key, None);
    }
    for (name, value) in changes {
        let (table, key) = name.split_once('.').unwrap_or(("", name));
        let removed = value.trim().trim_matches('"') == "auto";
        put(table, key, (!removed).then(|| written(name, value)));
    }
    let mut merged = String::new();
    for (table, keys) in tables {
        // The keys above all tables come first, because their table has an empty name.
        if !table.is_empty() {
            merged.push_str(&format!("\n[{table}]\n"));
        }
        keys.iter().for_each(|(key, value)| merged.push_str(&format!("{key} = {value}\n")));
    }
    merged
}

/// The keys that changes replace in other words.
pub(crate) fn replaced(changes: &[(String, String)]) -> Vec<&'static str> {
    let is_set = |value: &str| value.trim().trim_matches('"') != "auto";
    let set = changes.iter().filter(|(_, value)| is_set(value)).map(|(key, _)| key.trim());
    keys::CASE.replaced_by(&set.collect::<Vec<_>>())
}

/// The value of a change as TOML. What is not TOML is a text.
fn written(name: &str, value: &str) -> String {
    let read = DeValue::parse(value).ok();
    let text = match read.as_ref().map(|read| read.get_ref()) {
        Some(DeValue::String(text)) => text.to_string(),
        Some(DeValue::Array(_)) if is_file(name) => return full_paths(value),
        Some(_) => return value.to_owned(),
        None => value.to_owned(),
    };
    crate::value::quoted(&if is_file(name) { full(name, &text) } else { text })
}

fn is_file(name: &str) -> bool {
    keys::find(name).is_some_and(|key| matches!(key.kind, Kind::File(_)))
}

/// The full path of a file; a spectrum or a polymer may also be a name.
fn full(name: &str, text: &str) -> String {
    let is_name =
        keys::find(name).is_some_and(|key| matches!(key.kind, Kind::File(kind) if kind.is_word(text)));
    if is_name { text.to_owned() } else { full_path(text) }
}

fn full_path(text: &str) -> String {
    absolute(Path::new(text)).map_or_else(|_| text.to_owned(), |path| path.to_string_lossy().into_owned())
}

fn full_paths(list: &str) -> String {
    let Ok(read) = DeValue::parse(list) else { return list.to_owned() };
    let DeValue::Array(parts) = read.get_ref() else { return list.to_owned() };
    let parts = parts.iter().filter_map(|part| part.get_ref().as_str());
    format!("[{}]", parts.map(|part| crate::value::quoted(&full_path(part))).collect::<Vec<_>>().join(", "))
}
