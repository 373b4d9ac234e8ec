//! Writes a case as a file that reads back to the same bits.

use super::FORMAT_VERSION;
use spunlaid_fibre::Case;
use spunlaid_fibre::case::keys::{self, Key, KeyTable, Kind, Value};
use spunlaid_fibre::case::whole_parts;
use spunlaid_ground::Dimension;
use spunlaid_ground::units::shortest;
use std::path::Path;

/// Writes a case as TOML: every key, in SI units.
///
/// For every case that passes [`Case::check`], reading the text gives the same case to the last bit, and writing
/// it again gives the same text.
pub fn write_case(case: &Case) -> String {
    let mut text = format!("version = {FORMAT_VERSION}\n");
    for table in keys::TABLES {
        let lines = lines(&keys::CASE, table, |key| value_to_write(case, key));
        if !lines.is_empty() {
            text += &format!("\n[{table}]\n{}", in_lines(&lines));
        }
    }
    text
}

/// The value of a key of a case as it is written.
pub(super) fn value_to_write(case: &Case, key: &Key) -> Option<Value> {
    match own_value(key, case)? {
        Value::Number(value) if key.read_last => Some(Value::Number(tidy(case, key, value))),
        value => Some(value),
    }
}

/// The value of a key, unless the flow gives it.
pub(super) fn own_value<T>(key: &Key<T>, input: &T) -> Option<Value> {
    key.get(input).filter(|_| !key.is_derived(input))
}

/// A line for each key of a table that has a value.
pub(super) fn lines<T>(
    keys: &KeyTable<T>,
    table: &str,
    value: impl Fn(&Key<T>) -> Option<Value>,
) -> Vec<String> {
    let line = |key| Some(format!("{} = {}", Key::short(key), toml_value(&key.kind, value(key)?)));
    keys.keys_of_table(table).filter_map(line).collect()
}

/// Lines as a text.
pub(super) fn in_lines(lines: &[String]) -> String {
    lines.iter().map(|line| format!("{line}\n")).collect()
}

/// A value as TOML, in SI units.
pub(super) fn toml_value(kind: &Kind, value: Value) -> String {
    let lengths = |lengths: &[f64]| {
        let quoted = |x: &f64| format!("\"{}\"", Dimension::Length.exact(*x));
        format!("[{}]", lengths.iter().map(quoted).collect::<Vec<_>>().join(", "))
    };
    match (kind, value) {
        (Kind::Quantity(Dimension::Ratio, _), Value::Number(value)) => float(value),
        (Kind::Quantity(dimension, _), Value::Number(value)) => format!("\"{}\"", dimension.exact(value)),
        (_, Value::Number(value)) => float(value),
        (_, Value::Whole(value)) => value.to_string(),
        (Kind::Switch, Value::Text(word)) => word,
        (_, Value::Text(name)) => quoted(&name),
        (_, Value::Numbers(values)) => lengths(&values),
        (Kind::Point, Value::Vector(v)) => lengths(&[v.x, v.y, v.z]),
        (_, Value::Vector(v)) => format!("[{}]", [v.x, v.y, v.z].map(float).join(", ")),
        (_, Value::Paths(paths)) => listed(&paths.iter().map(|path| path.as_path()).collect::<Vec<_>>()),
        (_, Value::Content(content)) => listed(&content.paths()),
    }
}

/// A file, or a list of files.
fn listed(paths: &[&Path]) -> String {
    let texts: Vec<String> = paths.iter().map(|path| text(path)).collect();
    if let [one] = &texts[..] { one.clone() } else { format!("[{}]", texts.join(", ")) }
}

/// A path as a TOML string.
fn text(path: &Path) -> String {
    quoted(&path.to_string_lossy())
}

/// A text as a TOML string.
pub(super) fn quoted(text: &str) -> String {
    let escaped = text.chars().fold(String::new(), |mut text, c| {
        match c {
            '"' | '\\' => text.extend(['\\', c]),
            c if c.is_control() => text.push_str(&format!("\\u{:04X}", u32::from(c))),
            c => text.push(c),
        }
        text
    });
    format!("\"{escaped}\"")
}

/// A TOML float that reads back to the same bits.
fn float(value: f64) -> String {
    let text = shortest(value);
    if text.contains(['.', 'e']) { text } else { format!("{text}.0") }
}

/// A length or time that is counted in elements or steps, without the rounding noise in its last digits. The value
/// is left as it is if the reader would not make the same number of it.
fn tidy(case: &Case, key: &Key, value: f64) -> f64 {
    let (step, run) = (case.run.time_step, case.run);
    let same = |tidied: f64| match key.name {
        "fibre.element_length" => match case.line {
            Some(line) => {
                let mut again = case.fibre;
                again.span(line.distance, tidied);
                again == case.fibre
            }
            None => whole_parts(case.fibre.length, tidied) == (case.fibre.elements as u64, true),
        },
        "run.duration" => whole_parts(tidied, step) == (run.steps, true),
        "run.spin_up" => whole_parts(tidied, step) == (run.spin_up_steps, true),
        "run.output_interval" => whole_parts(tidied, step) == (run.output_steps, true),
        _ => false,
    };
    format!("{value:.14e}").parse().ok().filter(|tidied| same(*tidied)).unwrap_or(value)
}
