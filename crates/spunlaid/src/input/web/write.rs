//! Writes a web as a file that reads back to the same bits.

use super::super::FORMAT_VERSION;
use super::super::write::{in_lines, lines, lines_of_case, own_value};
use super::super::written_values::WrittenValues;
use crate::fibre::case::keys;
use crate::simulation::layers::full_names::{DEFECTS, ROWS, entries};
use crate::simulation::layers::keys::WEB;
use crate::simulation::{LaydownSource, LayerSpec, WebSpec};

/// Writes a web as TOML, with the cases that it flies: every key, in SI units. Reading the text gives the
/// same web to the last bit.
pub fn write_web(spec: &WebSpec) -> String {
    let lines = |layer: &LayerSpec, _, table: &str| match &layer.source {
        LaydownSource::Case { case, .. } => lines_of_case(case, table),
        _ => Vec::new(),
    };
    write_with(spec, &lines)
}

/// [`write_web`] with nothing of the filaments but what is written: what follows from it follows anew where a
/// key varies.
///
/// * `filaments` – what is written of that of each layer
pub(in super::super) fn write_web_to_vary(spec: &WebSpec, filaments: &[Option<WrittenValues>]) -> String {
    let lines_of_case = |_: &LayerSpec, number: usize, table: &str| {
        lines(&keys::CASE, table, |key| filaments.get(number)?.as_ref()?.get(key.name)?.value.clone())
    };
    write_with(spec, &lines_of_case)
}

/// The lines of a table of the case that a layer flies, whose number from 0 is given.
type LinesOfCase<'a> = &'a dyn Fn(&LayerSpec, usize, &str) -> Vec<String>;

fn write_with(spec: &WebSpec, lines_of_case: LinesOfCase<'_>) -> String {
    let mut text = format!("version = {FORMAT_VERSION}\n");
    let layered = spec.layers.len() > 1 || spec.layers.iter().any(|layer| layer.name.is_some());
    let filaments: Vec<Option<Tables>> =
        (0..spec.layers.len()).map(|number| filament(spec, number, lines_of_case)).collect();
    let mut flown = filaments.iter().flatten();
    let first = flown.next().filter(|_| layered);
    let (common, _): (Tables, Tables) = first
        .cloned()
        .unwrap_or_default()
        .into_iter()
        .partition(|table| flown.clone().all(|other| other.contains(table)));
    text += &written(&common, "");
    for number in 0..spec.layers.len() {
        let before = if layered { "layer." } else { "" };
        let alone = spec.alone(number);
        if layered {
            text += &format!("\n[[layer]]\n{}", in_lines(&lines_of_web(&alone, "layer")));
        }
        let mut tables =
            filaments[number].clone().unwrap_or_else(|| vec![("fibre", lines_of_web(&alone, "fibre"))]);
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

/// The lines of `[line]` of a layer. All layers lie on one belt, whose speed is that of a flown case or is
/// written once.
fn line(spec: &WebSpec, number: usize) -> Vec<String> {
    let mut lines = lines_of_web(&spec.alone(number), "line");
    let no_belt = number > 0 || spec.flies();
    lines.retain(|line| !(no_belt && line.starts_with("belt_speed = ")));
    lines.retain(|line| !(number > 0 && line.starts_with("basis_weight = ")));
    lines
}

/// The tables of the case that a layer flies, without what keys of the web give.
fn filament(spec: &WebSpec, number: usize, lines_of_case: LinesOfCase<'_>) -> Option<Tables> {
    let layer = spec.layers.get(number).filter(|layer| matches!(layer.source, LaydownSource::Case { .. }))?;
    let alone = spec.alone(number);
    let giving = WEB.rows.iter().filter(|key| !key.is_derived(&alone) && key.get(&alone).is_some());
    let given: Vec<&str> = giving.flat_map(|key| key.relations.gives_case).copied().collect();
    let lines = |table: &'static str| {
        let mut lines = lines_of_case(layer, number, table);
        lines.retain(|line| {
            let short = line.split(" = ").next().unwrap_or(line);
            !given.contains(&&*format!("{table}.{short}"))
        });
        (table, lines)
    };
    Some(keys::TABLES.into_iter().map(lines).collect())
}
