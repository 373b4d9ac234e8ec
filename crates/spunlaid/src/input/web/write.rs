//! Writes a web as a file that reads back to the same bits.

use super::super::FORMAT_VERSION;
use super::super::write::toml_value;
use crate::layers::{WebSpec, keys};
use crate::web::Filaments;
use std::fmt::Write;

/// Writes a web as TOML: every key, in SI units. Reading the text gives the same web to the last bit.
pub fn write_web(spec: &WebSpec) -> String {
    let mut text = format!("version = {FORMAT_VERSION}\n");
    let layered = spec.layers.len() > 1 || spec.layers.iter().any(|layer| layer.name.is_some());
    for (number, layer) in spec.layers.iter().enumerate() {
        let alone = spec.alone(number);
        if layered {
            text.push_str("\n[[layer]]\n");
            text.push_str(&lines(&alone, "layer").join(""));
        }
        for name in ["fibre", "laydown", "line"] {
            // Writing to a text cannot fail.
            let _ = writeln!(text, "\n[{}{name}]", if layered { "layer." } else { "" });
            text.push_str(&lines(&alone, name).join(""));
        }
        if let Filaments::Rows(rows) = &layer.filaments {
            let row = |row| {
                let mut with_row = alone.clone();
                with_row.layers.iter_mut().for_each(|of| of.filaments = Filaments::Rows(vec![row]));
                let lines = lines(&with_row, "line.rows");
                format!("{{ {} }}", lines.iter().map(|line| line.trim_end()).collect::<Vec<_>>().join(", "))
            };
            let rows: Vec<String> = rows.iter().copied().map(row).collect();
            let _ = writeln!(text, "rows = [\n  {},\n]", rows.join(",\n  "));
        }
    }
    text.push_str("\n[web]\n");
    text.push_str(&lines(spec, "web").join(""));
    text
}

/// A line for each key of a table that has a value.
fn lines(spec: &WebSpec, table: &str) -> Vec<String> {
    let line =
        |key: &keys::WebKey| Some(format!("{} = {}\n", key.short(), toml_value(&key.kind, key.get(spec)?)));
    keys::of_table(table).filter_map(line).collect()
}
