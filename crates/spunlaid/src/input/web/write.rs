//! Writes a web as a file that reads back to the same bits.

use super::super::FORMAT_VERSION;
use super::super::write::toml_value;
use super::keys::{self, EDGES, METHODS};
use super::{LaydownSource, LayerSpec, Method, WebSpec};
use crate::case::keys::Value;
use crate::web::{Edges, Filaments, Row};
use std::fmt::Write;
use std::path::Path;

/// Writes a web as TOML: every key, in SI units. Reading the text gives the same web to the last bit.
pub fn write_web(spec: &WebSpec) -> String {
    let mut text = format!("version = {FORMAT_VERSION}\n");
    let layered = spec.layers.len() > 1 || spec.layers.iter().any(|layer| layer.name.is_some());
    for layer in &spec.layers {
        if layered {
            text.push_str("\n[[layer]]\n");
            table(&mut text, "layer", |name| of_layer(layer, name));
        }
        for name in ["fibre", "laydown", "line"] {
            // Writing to a text cannot fail.
            let _ = writeln!(text, "\n[{}{name}]", if layered { "layer." } else { "" });
            table(&mut text, name, |key| of_layer(layer, key));
        }
        if let Filaments::Rows(rows) = &layer.filaments {
            let rows: Vec<String> = rows.iter().map(row).collect();
            let _ = writeln!(text, "rows = [\n  {},\n]", rows.join(",\n  "));
        }
    }
    text.push_str("\n[web]\n");
    table(&mut text, "web", |key| of_sheet(spec, key));
    text
}

/// Adds the keys of a table that have a value.
fn table(text: &mut String, name: &str, value: impl Fn(&str) -> Option<Value>) {
    for key in keys::of_table(name) {
        if let Some(value) = value(key.name) {
            let _ = writeln!(text, "{} = {}", key.short(), toml_value(&key.kind, value));
        }
    }
}

fn row(row: &Row) -> String {
    let value = |key: &keys::WebKey| {
        let value = match key.short() {
            "offset" => Value::Number(row.offset),
            "pitch" => Value::Number(row.pitch),
            _ => Value::Whole(row.filaments),
        };
        format!("{} = {}", key.short(), toml_value(&key.kind, value))
    };
    format!("{{ {} }}", keys::of_table("line.rows").map(value).collect::<Vec<_>>().join(", "))
}

/// The value of a key of a layer.
fn of_layer(layer: &LayerSpec, key: &str) -> Option<Value> {
    let path = |path: &Path| Some(Value::Text(path.to_string_lossy().into_owned()));
    Some(match (key, &layer.source, &layer.filaments) {
        ("layer.name", ..) => layer.name.clone()?.into(),
        ("fibre.diameter", ..) => layer.diameter.into(),
        ("fibre.density", ..) => layer.density.into(),
        ("laydown.case", LaydownSource::Case { path: of, .. }, _) => return path(of),
        ("laydown.results", LaydownSource::Results { folder, .. }, _) => return path(folder),
        ("laydown.sigma_md", LaydownSource::Surrogate(surrogate), _) => surrogate.sigma_md.into(),
        ("laydown.sigma_cd", LaydownSource::Surrogate(surrogate), _) => surrogate.sigma_cd.into(),
        ("laydown.noise", LaydownSource::Surrogate(surrogate), _) => surrogate.noise.into(),
        ("line.feed_speed", ..) => layer.feed_speed.into(),
        ("line.belt_speed", ..) => layer.belt_speed.into(),
        ("line.filaments_per_metre", _, Filaments::AtRandom { per_metre }) => {
            Value::Whole(per_metre.round() as u64)
        }
        _ => return None,
    })
}

/// The value of a key of the whole web.
fn of_sheet(spec: &WebSpec, key: &str) -> Option<Value> {
    let sheet = &spec.sheet;
    Some(match key {
        "web.width" => sheet.width.into(),
        "web.length" => sheet.length.into(),
        "web.patches" => Value::Numbers(sheet.patches.clone()),
        "web.cell" => sheet.cell.into(),
        "web.seed" => spec.seed.into(),
        "web.edges" => EDGES[usize::from(sheet.edges == Edges::Cut)].into(),
        "web.method" => METHODS[usize::from(spec.method == Method::Dynamics)].into(),
        "web.window" => spec.window.into(),
        _ => return None,
    })
}
