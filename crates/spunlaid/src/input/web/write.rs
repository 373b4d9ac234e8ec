//! Writes a web as a file that reads back to the same bits.

use super::super::FORMAT_VERSION;
use super::super::write::{in_lines, lines};
use crate::layers::WebSpec;
use crate::layers::keys::WEB;
use crate::web::Filaments;

/// Writes a web as TOML: every key, in SI units. Reading the text gives the same web to the last bit.
pub fn write_web(spec: &WebSpec) -> String {
    let mut text = format!("version = {FORMAT_VERSION}\n");
    let lines_of_table = |spec: &WebSpec, table: &str| lines(&WEB, table, spec, |_, value| value);
    let layered = spec.layers.len() > 1 || spec.layers.iter().any(|layer| layer.name.is_some());
    for (number, layer) in spec.layers.iter().enumerate() {
        let alone = spec.alone(number);
        if layered {
            text += &format!("\n[[layer]]\n{}", in_lines(&lines_of_table(&alone, "layer")));
        }
        // All layers lie on one belt, whose speed is that of a flown case or is written once.
        let no_belt = number > 0 || spec.layers.iter().any(|layer| layer.source.case().is_some());
        for table in ["fibre", "laydown", "line"] {
            let header = if layered { format!("layer.{table}") } else { table.to_owned() };
            let mut lines = lines_of_table(&alone, table);
            lines.retain(|line| !(no_belt && line.starts_with("belt_speed = ")));
            lines.retain(|line| !(number > 0 && line.starts_with("basis_weight = ")));
            text += &format!("\n[{header}]\n{}", in_lines(&lines));
        }
        if let Filaments::Rows(rows) = &layer.filaments {
            let row = |row| {
                let mut with_row = alone.clone();
                with_row.layers.iter_mut().for_each(|layer| layer.filaments = Filaments::Rows(vec![row]));
                format!("{{ {} }}", lines_of_table(&with_row, "line.rows").join(", "))
            };
            let rows: Vec<String> = rows.iter().copied().map(row).collect();
            text += &format!("rows = [\n  {},\n]\n", rows.join(",\n  "));
        }
    }
    for table in ["web", "fabric"] {
        text += &format!("\n[{table}]\n{}", in_lines(&lines_of_table(spec, table)));
    }
    text
}
