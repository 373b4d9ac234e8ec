//! Keys of a web by their full names, which have the numbers of a layer and of a row: `layer.2.line.rows.1.pitch`.

use super::keys::{WEB, WEB_FILE, WebKey};
use super::{LayerSpec, WebSpec};
use spunlaid_fibre::case::keys::Value;
use spunlaid_web::map::Filaments;
use spunlaid_web::{Defect, Row};

/// The key of a full name, `layer.2.line.rows.1.pitch`.
pub fn web_key(full: &str) -> Option<&'static WebKey> {
    let name = without_numbers(full);
    let in_layer = || name.strip_prefix("layer.");
    let in_named_layer = || in_layer()?.split_once('.').map(|(_, rest)| rest);
    WEB.find(&name).or_else(|| WEB.find(in_layer()?)).or_else(|| WEB.find(in_named_layer()?))
}

/// Says of a key whether these, which are set, take its place: they give its value in other words, or are it for
/// all layers at once. All are keys of a case or a web by their full names.
///
/// * `layered` – whether the file has a list of layers
pub fn replaced_by<'s>(set: &'s [&'s str], layered: bool) -> impl Fn(&str) -> bool + 's {
    let names: Vec<(&str, String)> = set.iter().map(|full| layer_and_name(full)).collect();
    let of_all_layers =
        |name: &&str| WEB_FILE.find(name).is_some_and(|key| key.relations.of_all_layers.is_some());
    // Each with the layer in which it is displaced; with none, in all.
    let mut displaced: Vec<(Option<&str>, String)> = Vec::new();
    for (layer, _) in &names {
        let here: Vec<&str> = names.iter().filter(|(of, _)| of == layer).map(|(_, name)| &**name).collect();
        let common: Vec<&str> = here.iter().copied().filter(of_all_layers).collect();
        let everywhere = WEB_FILE.replaced_by(&common);
        let is_common = layered && layer.is_empty();
        for name in WEB_FILE.replaced_by(&here).into_iter().chain(here.into_iter().filter(|_| is_common)) {
            let in_all = is_common || of_all_layers(&name) || everywhere.contains(&name);
            displaced.push(((!in_all).then_some(*layer), name.to_owned()));
        }
    }
    move |other| {
        let (layer, name) = layer_and_name(other);
        let is_it =
            |(of, displaced): &(Option<&str>, String)| *displaced == name && of.is_none_or(|of| of == layer);
        !set.contains(&other) && displaced.iter().any(is_it)
    }
}

/// What says of which layer a full name is, `layer.2.`, if anything; and the name without numbers.
pub fn layer_and_name(full: &str) -> (&str, String) {
    let dot = full.strip_prefix("layer.").and_then(|rest| rest.find('.'));
    let (layer, name) = full.split_at(dot.map_or(0, |dot| "layer.".len() + dot + 1));
    (layer, without_numbers(name))
}

/// The full name of a key that a user has named, with the number of its layer in place of the layer's name.
///
/// # Errors
/// What to write if the name does not say of which layer or row it is, or names one that is not there.
pub fn full_name(web: &WebSpec, name: &str) -> Result<String, String> {
    let layers = web.layers.len();
    let named = |layer: &LayerSpec| {
        name.strip_prefix("layer.")?.strip_prefix(layer.name.as_deref()?)?.strip_prefix('.')
    };
    let by_name = (1..).zip(&web.layers).find_map(|(number, layer)| Some((number, named(layer)?)));
    let full = by_name.map_or_else(|| name.to_owned(), |(number, rest)| format!("layer.{number}.{rest}"));
    let table = WEB.find(name).map_or("", WebKey::table);
    for (list, entry, what) in [(ROWS, "rows", "row"), (DEFECTS, "defects", "defect")] {
        if table == list {
            let numbered = name.replace(entry, &format!("{entry}.1"));
            return Err(format!("write the number of the {what}, as in {numbered}"));
        }
    }
    if layers > 1 && WEB.lists.iter().any(|list| list.tables.contains(&table)) {
        return Err(format!("write layer.1.{name}, or the layer's name instead of 1"));
    }
    if web_key(&full).is_some() && layer_and_row(web, &full).is_none() {
        let layers = if layers == 1 { "1 layer".to_owned() } else { format!("{layers} layers") };
        return Err(format!("there is no such layer, row or defect; the web has {layers}"));
    }
    Ok(full)
}

/// The value of a key by its full name, `layer.2.line.rows.1.pitch`.
pub fn value(web: &WebSpec, full: &str) -> Option<Value> {
    web_key(full)?.get(&layer_and_row(web, full)?)
}

/// The web with nothing but the layer and the row that a full name gives by their numbers; None if one is not there.
fn layer_and_row(web: &WebSpec, full: &str) -> Option<WebSpec> {
    let mut numbers = full.split('.').filter_map(|word| word.parse::<usize>().ok());
    let layer = if full.starts_with("layer.") { numbers.next()? } else { 1 };
    let alone = web.alone(layer.checked_sub(1)?);
    let Some(number) = numbers.next() else { return Some(alone) };
    let list = if full.contains(".defects.") { DEFECTS } else { ROWS };
    entries(&alone, list).into_iter().nth(number.checked_sub(1)?)
}

/// The lists of a layer.
pub const ROWS: &str = "line.rows";
/// The list of defects of a line.
pub const DEFECTS: &str = "line.defects";

/// The web of one layer, once for each entry of a list of it, and with that entry alone.
pub fn entries(web: &WebSpec, list: &str) -> Vec<WebSpec> {
    let Some(layer) = web.layers.first() else { return Vec::new() };
    let with_row = |row: &Row| LayerSpec { filaments: Filaments::Rows(vec![*row]), ..layer.clone() };
    let with_defect = |defect: &Defect| LayerSpec { defects: vec![*defect], ..layer.clone() };
    let layers: Vec<LayerSpec> = match &layer.filaments {
        _ if list == DEFECTS => layer.defects.iter().map(with_defect).collect(),
        Filaments::Rows(rows) => rows.iter().map(with_row).collect(),
        Filaments::AtRandom { .. } | Filaments::Slot { .. } => Vec::new(),
    };
    layers.into_iter().map(|layer| WebSpec { layers: vec![layer], ..web.clone() }).collect()
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
pub fn without_numbers(full: &str) -> String {
    let words: Vec<&str> =
        full.split('.').filter(|word| !word.is_empty() && word.parse::<u64>().is_err()).collect();
    words.join(".")
}
