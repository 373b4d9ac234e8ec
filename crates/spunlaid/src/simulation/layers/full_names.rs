//! Keys of a web by their full names, which have the numbers of a layer and of a row: `layer.2.line.rows.1.pitch`.

use super::keys::{WEB, WebKey};
use super::{LayerSpec, WebSpec};
use crate::fibre::case::keys::{CASE, Value};
use crate::web::map::Filaments;

/// The key of a full name, `layer.2.line.rows.1.pitch`.
pub fn web_key(full: &str) -> Option<&'static WebKey> {
    let name = without_numbers(full);
    let in_layer = || name.strip_prefix("layer.");
    let in_named_layer = || in_layer()?.split_once('.').map(|(_, rest)| rest);
    WEB.find(&name).or_else(|| WEB.find(in_layer()?)).or_else(|| WEB.find(in_named_layer()?))
}

/// Whether one of two keys of a case or a web gives the value of the other, by their full names.
pub(crate) fn are_alternatives(one: &str, other: &str) -> bool {
    let (key, found) = match [one, other].map(web_key) {
        [Some(key), Some(found)] => (key, found),
        [Some(key), None] => return WEB.gives(key.name, other),
        [None, Some(found)] => return WEB.gives(found.name, one),
        [None, None] => return CASE.are_alternatives(one, other),
    };
    let is_of_same_layer = || one.strip_suffix(key.name) == other.strip_suffix(found.name);
    WEB.are_alternatives(key.name, found.name) && (key.relations.of_all_layers || is_of_same_layer())
}

/// Whether keys of a case or a web give all that another one gives, by their full names, and so replace it.
pub(crate) fn is_replaced(other: &str, names: &[&str]) -> bool {
    let is_of_web = |name: &str| web_key(name).is_some() || web_key(other).is_some();
    let gives = |name: &&str| is_of_web(name) && are_alternatives(name, other);
    !names.contains(&other) && (CASE.replaced_by(names).contains(&other) || names.iter().any(gives))
}

/// The full name of a key that a user has named, with the number of its layer in place of the layer's name.
///
/// # Errors
/// What to write if the name does not say of which layer or row it is, or names one that is not there.
pub(crate) fn full_name(web: &WebSpec, name: &str) -> Result<String, String> {
    let layers = web.layers.len();
    let named = |layer: &LayerSpec| {
        name.strip_prefix("layer.")?.strip_prefix(layer.name.as_deref()?)?.strip_prefix('.')
    };
    let by_name = (1..).zip(&web.layers).find_map(|(number, layer)| Some((number, named(layer)?)));
    let full = by_name.map_or_else(|| name.to_owned(), |(number, rest)| format!("layer.{number}.{rest}"));
    let table = WEB.find(name).map_or("", WebKey::table);
    for (list, entry, what) in [("line.rows", "rows", "row"), ("line.defects", "defects", "defect")] {
        if table == list {
            let numbered = name.replace(entry, &format!("{entry}.1"));
            return Err(format!("write the number of the {what}, as in {numbered}"));
        }
    }
    if layers > 1 && WEB.lists.iter().any(|list| list.tables.contains(&table)) {
        return Err(format!("write layer.1.{name}, or the layer's name in place of 1"));
    }
    if web_key(&full).is_some() && layer_and_row(web, &full).is_none() {
        let layers = if layers == 1 { "1 layer".to_owned() } else { format!("{layers} layers") };
        return Err(format!("there is no such layer, row or defect; the web has {layers}"));
    }
    Ok(full)
}

/// The value of a key by its full name, `layer.2.line.rows.1.pitch`.
pub(crate) fn value(web: &WebSpec, full: &str) -> Option<Value> {
    web_key(full)?.get(&layer_and_row(web, full)?)
}

/// The web with nothing but the layer and the row that a full name gives by their numbers; None if one is not there.
fn layer_and_row(web: &WebSpec, full: &str) -> Option<WebSpec> {
    let mut numbers = full.split('.').filter_map(|word| word.parse::<usize>().ok());
    let layer = if full.starts_with("layer.") { numbers.next()? } else { 1 };
    let mut alone = web.alone(layer.checked_sub(1)?);
    let Some(number) = numbers.next() else { return Some(alone) };
    let (one, number) = (alone.layers.first_mut()?, number.checked_sub(1)?);
    if full.contains(".defects.") {
        one.defects = vec![*one.defects.get(number)?];
    } else {
        let Filaments::Rows(rows) = &mut one.filaments else { return None };
        *rows = vec![*rows.get(number)?];
    }
    Some(alone)
}

/// The layer and the row or the defect of a full name in words, ` of layer 2, row 1`; nothing without them.
pub fn place_in_web(full: &str) -> String {
    let words: Vec<&str> = full.split('.').collect();
    let number = |list: &str| words.iter().position(|word| *word == list).and_then(|at| words.get(at + 1));
    let places = [("layer", number("layer")), ("row", number("rows")), ("defect", number("defects"))];
    let places: Vec<String> =
        places.into_iter().filter_map(|(what, number)| Some(format!("{what} {}", number?))).collect();
    if places.is_empty() { String::new() } else { format!(" of {}", places.join(", ")) }
}

/// A full name without the numbers of layers and rows.
pub(crate) fn without_numbers(full: &str) -> String {
    let words: Vec<&str> =
        full.split('.').filter(|word| !word.is_empty() && word.parse::<u64>().is_err()).collect();
    words.join(".")
}
