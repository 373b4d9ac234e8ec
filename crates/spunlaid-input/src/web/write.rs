//! Writes a web as a file that reads back to the same bits.

use super::super::FORMAT_VERSION;
use super::super::write::{in_lines, lines, own_value, value_to_write};
use super::super::written_values::WrittenValues;
use spunlaid_fibre::case::keys::{self, Key, Value};
use spunlaid_simulation::layers::full_names::{DEFECTS, ROWS, entries};
use spunlaid_simulation::layers::keys::WEB;
use spunlaid_simulation::{WebKey, WebSpec};

/// Writes a web as TOML, with the cases that it flies: every key, in SI units. WebParser the text gives the
/// same web to the last bit.
pub fn write_web(spec: &WebSpec) -> String {
    write_with(spec, &|number, key| value_to_write(spec.layers.get(number)?.source.case()?, key))
}

/// [`write_web`] with nothing of the filaments but what is written: what follows from it follows again where a
/// key varies.
///
/// * `filaments` – what is written of that of each layer
pub(in super::super) fn write_web_to_vary(spec: &WebSpec, filaments: &[Option<WrittenValues>]) -> String {
    write_with(spec, &|number, key| filaments.get(number)?.as_ref()?.get(key.name)?.value.clone())
}

/// The value of a key of the case that a layer flies, whose number from 0 is given.
type ValueOfCase<'a> = &'a dyn Fn(usize, &Key) -> Option<Value>;

fn write_with(spec: &WebSpec, value: ValueOfCase<'_>) -> String {
    let mut text = format!("version = {FORMAT_VERSION}\n");
    let layered = spec.layers.len() > 1 || spec.layers.iter().any(|layer| layer.name.is_some());
    let filaments: Vec<Option<Tables>> =
        (0..spec.layers.len()).map(|number| filament(spec, number, value)).collect();
    let mut simulated = filaments.iter().flatten();
    let first = simulated.next().filter(|_| layered);
    let (common, _): (Tables, Tables) = first
        .cloned()
        .unwrap_or_default()
        .into_iter()
        .partition(|table| simulated.clone().all(|other| other.contains(table)));
    text += &written(&common, "");
    for (number, filament) in filaments.iter().enumerate() {
        let before = if layered { "layer." } else { "" };
        let alone = spec.alone(number);
        if layered {
            text += &format!("\n[[layer]]\n{}", in_lines(&lines_of_web(&alone, "layer")));
        }
        let mut tables = filament.clone().unwrap_or_else(|| vec![("fibre", lines_of_web(&alone, "fibre"))]);
        tables.retain(|table| !common.contains(table));
        tables.push(("laydown", lines_of_web(&alone, "laydown")));
        tables.push(("line", line(spec, number)));
        text += &written(&tables, before);
        for list in [ROWS, DEFECTS] {
            let entry = |web: &WebSpec| format!("{{ {} }}", lines_of_web(web, list).join(", "));
            let entries: Vec<String> = entries(&alone, list).iter().map(entry).collect();
            if !entries.is_empty() {
                let short = list.trim_start_matches("line.");
                text += &format!("{short} = [\n  {},\n]\n", entries.join(",\n  "));
            }
        }
    }
    for table in ["web", "fabric"] {
        text += &format!("\n[{table}]\n{}", in_lines(&lines_of_web(spec, table)));
    }
    text
}

/// Tables with their lines.
type Tables = Vec<(&'static str, Vec<String>)>;

fn lines_of_web(spec: &WebSpec, table: &str) -> Vec<String> {
    lines(&WEB, table, |key| own_value(key, spec))
}

/// Tables as text, without those that are empty; `[line]` is always there, because rows may follow.
fn written(tables: &Tables, before: &str) -> String {
    let is_there = |(table, lines): &&(&str, Vec<String>)| *table == "line" || !lines.is_empty();
    tables
        .iter()
        .filter(is_there)
        .map(|(table, lines)| format!("\n[{before}{table}]\n{}", in_lines(lines)))
        .collect()
}

/// The lines of `[line]` of a layer; what all layers have in common is written once.
fn line(spec: &WebSpec, number: usize) -> Vec<String> {
    let alone = spec.alone(number);
    let is_here = |key: &WebKey| number == 0 || key.relations.of_all_layers.is_none();
    lines(&WEB, "line", |key| own_value(key, &alone).filter(|_| is_here(key)))
}

/// The tables of the case that a layer flies, without what keys of the web give.
fn filament(spec: &WebSpec, number: usize, value: ValueOfCase<'_>) -> Option<Tables> {
    let alone = spec.alone(number);
    let giving = WEB.rows.iter().filter(|key| own_value(key, &alone).is_some());
    let given: Vec<&str> = giving.flat_map(|key| key.relations.gives_case).copied().collect();
    let own = |key: &Key| value(number, key).filter(|_| !given.contains(&key.name));
    let table = |table| (table, lines(&keys::CASE, table, own));
    alone.flies().then(|| keys::TABLES.into_iter().map(table).collect())
}
