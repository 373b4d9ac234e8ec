//! Overrides of the keys of a web: each finds the layer, table and row that it is for.

use super::super::document::AUTO;
use super::super::entry::{Entry, VERSION};
use super::super::source::fit;
use super::document::{Entries, OF_A_LAYER, table_of};
use crate::error::{Fault, Finding};
use crate::layers::WEB_TABLES;

impl<'a> Entries<'a> {
    /// Takes an override, which replaces the value in the file. The value `auto` removes it.
    pub(super) fn take_override(&mut self, word: &str, key: &str, text: &'a str) {
        let entry = Entry::of_override(word, text);
        let (prefix, rest) = match self.layer_of(key) {
            Ok(of) => of,
            Err(what) => {
                self.written.problems.push(entry.problem(key, what));
                return;
            }
        };
        if text.trim().trim_matches('"') == AUTO {
            self.remove(&format!("{prefix}{rest}"));
            return;
        }
        let tables: &[&str] = if prefix.is_empty() { &WEB_TABLES[1..] } else { &OF_A_LAYER };
        match rest.split_once('.').map(|(table, key)| (table_of(tables, table), key)) {
            Some((Some(&"line"), "rows")) => self.take_rows(&prefix, entry),
            Some((Some(&"line"), of_row)) if of_row.starts_with("rows.") => {
                let rows = format!("{prefix}line.rows");
                let there = self.rows.get(&rows).map_or(0, |(.., count)| *count);
                let row = of_row.strip_prefix("rows.").and_then(|of| of.split_once('.'));
                match row.filter(|(row, _)| (1..=there).any(|number| number.to_string() == *row)) {
                    Some((row, key)) => self.take_entry(&format!("{rows}.{row}."), "line.rows", key, entry),
                    None => {
                        let what = Fault::new(
                            format!("is of a row of nozzles that is not there: line.rows has {there}"),
                            "write the whole list of rows",
                        );
                        self.written.problems.push(entry.problem(key, what));
                    }
                }
            }
            Some((Some(table), key)) => self.take_entry(&format!("{prefix}{table}."), table, key, entry),
            None if rest == VERSION => self.version = Some(entry),
            None if rest == "name" && !prefix.is_empty() => self.take_entry(&prefix, "layer", rest, entry),
            None if table_of(tables, rest).is_some() => {
                let wanted = format!("one of its keys, {word} {prefix}{rest}.key=value");
                let what = Fault::wrong_type("a table", wanted);
                self.written.problems.push(Finding { value: None, ..entry.problem(key, what) });
            }
            _ => self.unknown_at_top(rest, &entry),
        }
    }

    /// What comes before the names of the layer that an override is for, and the rest of its key.
    fn layer_of<'k>(&self, key: &'k str) -> Result<(String, &'k str), Fault> {
        let names = self.names.as_deref();
        let Some(rest) = key.strip_prefix("layer.") else {
            let (table, _) = key.split_once('.').unwrap_or((key, ""));
            let of_a_layer = names.is_some() && table_of(&OF_A_LAYER, table).is_some();
            let which = || {
                let remedy = format!("write layer.1.{}, or the layer's name in place of 1", fit(key));
                Fault::new("does not say of which layer", remedy)
            };
            return if of_a_layer { Err(which()) } else { Ok((String::new(), key)) };
        };
        let layers = names.map_or(0, <[_]>::len);
        let after = |name: &str| rest.strip_prefix(name)?.strip_prefix('.');
        let numbers = (1..=layers).find_map(|number| Some((number, after(&number.to_string())?)));
        let by_name =
            || (1..).zip(names?).find_map(|(number, name)| Some((number, after(name.as_deref()?)?)));
        let (number, rest) = numbers.or_else(by_name).ok_or_else(|| {
            let there = match layers {
                0 => "it has no [[layer]], so write the key without layer".to_owned(),
                1 => "it has one, layer.1".to_owned(),
                _ => format!("it has layer.1 to layer.{layers}, which may also be called by their names"),
            };
            Fault::new("is of a layer that the file does not have", there)
        })?;
        Ok((format!("layer.{number}."), rest))
    }
}
