//! Writes a study as a file, with every default.

use super::super::FORMAT_VERSION;
use super::{Varied, varied};
use crate::study::{Design, Factor, Levels, MEASURES, Study};
use crate::units::shortest;
use std::fmt::Write;

/// Writes a study as TOML; it names the case `case.toml`, in the same folder.
///
/// Reading the text with the same case gives exactly the same points.
///
/// * `set` – the keys that are the same at all points, with their values as TOML
pub(super) fn write_study(study: &Study, set: &[(String, String)]) -> String {
    let mut text = format!("version = {FORMAT_VERSION}\ncase = \"case.toml\"\n");
    // Writing to a text cannot fail.
    let _ = writeln!(text, "design = \"{}\"", study.design.name());
    if let Design::LatinHypercube(points) | Design::Sobol(points) = study.design {
        let _ = writeln!(text, "points = {points}");
    }
    let _ = writeln!(text, "seed = {}\ncommon_phases = {}", study.seed, study.common_phases);
    let replicates = &study.replicates;
    if replicates.until.is_empty() {
        let _ = writeln!(text, "replicates = {}", replicates.at_most);
    } else {
        let _ = writeln!(
            text,
            "\n[replicates]\nat_least = {}\nat_most = {}",
            replicates.at_least, replicates.at_most
        );
        text.push_str("\n[replicates.until]\n");
        for (measure, fraction) in &replicates.until {
            let _ = writeln!(text, "{} = {}", MEASURES[*measure].name, shortest(*fraction));
        }
    }
    let key = |name: &str| varied(name).map(Varied::from);
    write_values(&mut text, set, &study.factors, key);
    if !study.links.is_empty() {
        text.push_str("\n[link]\n");
        for link in &study.links {
            let _ = writeln!(text, "\"{}\" = \"{}\"", link.key, link.expression.text());
        }
    }
    text
}

/// Writes the tables `[set]` and `[vary]`.
///
/// * `key` – a key by its name
pub(super) fn write_values(
    text: &mut String,
    set: &[(String, String)],
    factors: &[Factor],
    key: impl Fn(&str) -> Option<Varied>,
) {
    if !set.is_empty() {
        text.push_str("\n[set]\n");
        for (key, value) in set {
            let _ = writeln!(text, "\"{key}\" = {value}");
        }
    }
    text.push_str("\n[vary]\n");
    for factor in factors {
        let exact = |value: f64| key(factor.key).map_or_else(String::new, |key| key.exact(value));
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
