//! Sets keys in the text of a file, whose comments stay.

use toml_edit::{DocumentMut, InlineTable, Item, TableLike, Value, table, value};

/// The text of a file with other values of keys.
///
/// * `removed` – full names of keys that are taken out
/// * `set` – full names of keys, `layer.2.line.rows.1.md`, and their values as an override has them; a table that is
///   not there is added
///
/// Returns None if the text is not TOML, or if a list does not have an entry.
pub(super) fn with_keys<'a>(
    text: &str,
    removed: impl IntoIterator<Item = &'a str>,
    set: impl IntoIterator<Item = (&'a str, &'a str)>,
) -> Option<String> {
    let mut document = text.parse::<DocumentMut>().ok()?;
    for (full, new) in set {
        // What is no TOML is a text, as in an override.
        let new = new.parse().unwrap_or_else(|_| Value::from(new));
        let (table, name) = place_of(&mut document, full)?;
        match table.get_mut(name).and_then(Item::as_value_mut) {
            Some(old) => {
                // The comment at the end of the line stays.
                let around = old.decor().clone();
                *old = new;
                *old.decor_mut() = around;
            }
            None => drop(table.insert(name, value(new))),
        }
    }
    for full in removed {
        let (table, name) = place_of(&mut document, full)?;
        table.remove(name);
    }
    Some(document.to_string())
}

/// The table in which a key stands or may stand, and its name there.
fn place_of<'t, 'n>(
    document: &'t mut DocumentMut,
    full: &'n str,
) -> Option<(&'t mut dyn TableLike, &'n str)> {
    let (mut table, mut is_inline): (&mut dyn TableLike, bool) = (document.as_table_mut(), false);
    let mut rest = full;
    while let Some((name, after)) = rest.split_once('.') {
        let numbered =
            after.split_once('.').and_then(|(number, rest)| Some((number.parse::<usize>().ok()?, rest)));
        let empty = || if is_inline { value(InlineTable::new()) } else { self::table() };
        let item = table.entry(name).or_insert_with(empty);
        is_inline |= item.is_value();
        (table, rest) = match numbered {
            Some((number, rest)) => (entry(item, number)?, rest),
            None => (item.as_table_like_mut()?, after),
        };
    }
    Some((table, rest))
}

/// An entry of a list of tables, counted from 1.
fn entry(list: &mut Item, number: usize) -> Option<&mut dyn TableLike> {
    let number = number.checked_sub(1)?;
    match list {
        Item::ArrayOfTables(tables) => tables.get_mut(number).map(|table| table as &mut dyn TableLike),
        Item::Value(Value::Array(tables)) => Some(tables.get_mut(number)?.as_inline_table_mut()?),
        _ => None,
    }
}
