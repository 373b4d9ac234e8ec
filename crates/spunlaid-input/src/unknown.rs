//! What is said of keys and tables that are not known where they stand, or are missing.

use super::document::Document;
use super::entry::{Entry, VERSION};
use super::text_with_lines::fit;
use spunlaid_fibre::case::keys::{Key, Kind, Omission, TableList};
use spunlaid_ground::error::one_of;
use spunlaid_ground::{Diagnostic, Fault};
use toml::de::DeValue;

impl<T> Document<'_, T> {
    /// Rejects a key or a table that is not known where it stands.
    pub(super) fn unknown(&mut self, before: &str, table: &'static str, name: &str, entry: &Entry<'_>) {
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
            // The top of the file is no table with a name.
            if let Some(meant) = table_meant.filter(|meant| !meant.is_empty()) {
                self.key_values.suppress_missing(format!("{before}{meant}."));
                nearest = Some(self.header(layer, meant));
            }
        } else if let Some(home) = keys.find_by_short_name(name) {
            self.key_values.suppress_missing(format!("{layer}{}", home.name));
            let what = Fault::misplaced(home.table(), home.short());
            self.reject(&key, entry, what);
            return;
        } else if let Some(meant) = keys.like(table, name).first() {
            let full = if meant.table() == table {
                format!("{before}{}", meant.short())
            } else {
                format!("{layer}{}", meant.name)
            };
            self.key_values.suppress_missing(full.clone());
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
        self.key_values.problems.push(Diagnostic { value, ..entry.problem(&key, what) });
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

    /// Rejects keys beside others that they stand instead of, and notes those that are missing.
    pub(super) fn check_relations(&mut self) {
        for key in self.keys.rows.iter().filter(|key| !self.keys.is_within(key.table())) {
            let is_written = |name: &str| self.key_values.get(name).is_some();
            let is_there = is_written(key.name) || self.named.iter().any(|named| named.row.name == key.name);
            let is_given = || self.keys.is_given(key.name, is_written);
            let fault = match key.omission {
                _ if is_written(key.name) => key.beside_alternative(is_written),
                Omission::Required(_)
                    if !is_there && !is_given() && !self.key_values.is_excused(key.name) =>
                {
                    let below = || format!("add it and below it a key, like {}", key.example());
                    let is_table = key.short() == "*";
                    Some(if is_table {
                        Fault::new("is missing", below())
                    } else {
                        Fault::missing(key.table(), &line(key))
                    })
                }
                _ => None,
            };
            if let Some(fault) = fault {
                let table = key.name.strip_suffix(".*").map(|table| self.keys.header(table));
                self.key_values.reject(&table.unwrap_or_else(|| key.name.to_owned()), fault);
            }
        }
    }
}

/// A line that would do where a key is missing, with the other words that it takes.
fn line<T>(key: &Key<T>) -> String {
    let example = key.example();
    let Kind::Choice(names) = key.kind else { return example };
    let others: Vec<&str> =
        names().into_iter().filter(|name| !example.contains(&format!("\"{name}\""))).collect();
    format!("{example} (or {})", one_of(&others))
}
