//! Writes a study as a file, with every default.

use super::super::FORMAT_VERSION;
use super::super::write::{in_lines, lines, quoted};
use crate::study::{Factor, Levels, Replicates, STUDY, Study};
use crate::units::shortest;
use std::fmt::Write;

/// Writes a study as TOML; it names `case.toml`, `web.toml` or `spinline.toml`, in the same folder.
///
/// Reading the text with the same file gives exactly the same points.
///
/// * `set` – the keys that are the same at all points, with their values as TOML
pub(super) fn write_study(study: &Study, set: &[(String, String)]) -> String {
    let lines = |table: &str| in_lines(&lines(&STUDY, table, study, |_, value| value));
    let mut text = format!("version = {FORMAT_VERSION}\n{}", lines(""));
    let Replicates { until, .. } = &study.replicates;
    if !until.is_empty() {
        text += &format!("\n[replicates]\n{}\n[replicates.until]\n", lines("replicates"));
    }
    // Writing to a text cannot fail.
    for (measure, fraction) in until {
        let _ = writeln!(text, "{} = {}", study.quantities[*measure].name, shortest(*fraction));
    }
    write_values(&mut text, set, &study.factors);
    if !study.links.is_empty() {
        text.push_str("\n[link]\n");
        for link in &study.links {
            let _ = writeln!(text, "\"{}\" = \"{}\"", link.key, link.expression.text());
        }
    }
    if !study.claims.is_empty() {
        text.push_str("\n[claims]\n");
        for claim in &study.claims {
            let _ = writeln!(text, "{} = {}", quoted(&claim.sentence), quoted(&claim.text));
        }
    }
    text
}

/// Writes the tables `[set]` and `[vary]`.
fn write_values(text: &mut String, set: &[(String, String)], factors: &[Factor]) {
    if !set.is_empty() {
        text.push_str("\n[set]\n");
        for (key, value) in set {
            let _ = writeln!(text, "\"{key}\" = {value}");
        }
    }
    text.push_str("\n[vary]\n");
    for factor in factors {
        let exact = |value: f64| exact(factor, value);
        let _ = match &factor.levels {
            Levels::List(values) => {
                let values: Vec<String> = values.iter().map(|value| exact(*value)).collect();
                writeln!(text, "\"{}\" = [{}]", factor.key, values.join(", "))
            }
            Levels::Range { from, to, steps, spacing } => {
                let steps = steps.map_or_else(String::new, |steps| format!(", steps = {steps}"));
                let (from, to, spacing) = (exact(*from), exact(*to), spacing.name());
                writeln!(
                    text,
                    "\"{}\" = {{ from = {from}, to = {to}{steps}, spacing = \"{spacing}\" }}",
                    factor.key
                )
            }
        };
    }
}

/// A value in the form of a study file, without rounding.
fn exact(factor: &Factor, value: f64) -> String {
    match factor.input().word(value) {
        Some(word) => format!("\"{word}\""),
        None if factor.whole => format!("{value:.0}"),
        None => format!("\"{}\"", factor.dimension.exact(value)),
    }
}
