//! What is reported of a fabric, for `summary.json`, the terminal and the report.

use crate::files::measured::{joined, json, known};
use crate::numbers::{HARD, THIN, in_sentence, number, number_to, plus_minus, range};
use serde_json::{Value as Json, json};
use spunlaid_ground::{Known, Measure, Measured, Value, measure};
use spunlaid_web::{
    FABRIC_MEASURES, FABRIC_PATCH_MEASURES, Fabric, STREAK_MEASURES, STRIP_MEASURES, THINNEST_PATCH_MEASURES,
};

/// The fabric in `summary.json`: all numbers that are known.
pub(super) fn summary(fabric: &Fabric) -> Json {
    let [strips_md, strips_cd] = fabric.strips.each_ref().map(Option::as_ref);
    let parts = json!({
        "patches": all(FABRIC_PATCH_MEASURES, &fabric.patches),
        "thinnest": some(THINNEST_PATCH_MEASURES, &fabric.marks.thinnest),
        "strips_md": strips_md.map(|strips| entries(STRIP_MEASURES, strips)),
        "strips_cd": strips_cd.map(|strips| entries(STRIP_MEASURES, strips)),
        // Of the defects of the line, in the order of the file.
        "streaks": some(STREAK_MEASURES, &fabric.streaks),
        "notes": (!fabric.notes.is_empty()).then_some(&fabric.notes),
    });
    joined([entries(FABRIC_MEASURES, fabric), known(parts)])
}

fn entries<T>(measures: &'static [Measure<T>], of: &T) -> Json {
    let known =
        measure::measured(measures, of).filter_map(|row| Some((row.measure.entry(), json(row.value?))));
    known.collect()
}

pub(super) fn all<T>(measures: &'static [Measure<T>], of: &[T]) -> Json {
    of.iter().map(|part| entries(measures, part)).collect()
}

fn some<T>(measures: &'static [Measure<T>], of: &[T]) -> Option<Json> {
    (!of.is_empty()).then(|| all(measures, of))
}

/// Side of the patches of which the terminal reports [m].
const SHOWN: f64 = 5e-3;

/// What is reported in two units.
const AIR: &str = "Air permeability";

/// Most streaks of which the terminal reports.
const MOST_STREAKS: usize = 5;

/// What a buyer counts of a fabric: names and numbers. Thin places and strips come first.
pub fn fabric_rows(fabric: &Fabric) -> Vec<[String; 2]> {
    let is_near = |value: f64, shown: f64| (value / shown - 1.0).abs() < 0.05;
    let mut all = Vec::new();
    for patch in fabric.patches.iter().filter(|patch| is_near(patch.thin.patch, SHOWN)) {
        let before = format!("{} mm patches ", number(patch.thin.patch * 1e3));
        all.extend(rows(&before, &FABRIC_PATCH_MEASURES[2..4], patch));
    }
    for (strips, direction) in fabric.strips.iter().zip(["MD", "CD"]) {
        let name = |[_, value]: [String; 2]| [format!("Weakest strip along {direction}"), value];
        all.extend(strips.iter().flat_map(|strips| rows("", &STRIP_MEASURES[2..3], strips)).map(name));
    }
    // The width of a piece without edges says nothing of the fabric.
    let of_edges = if fabric.trim.is_some() { 0 } else { 1 };
    for row in rows("", &FABRIC_MEASURES[of_edges..], fabric) {
        let is_air = row[0] == AIR;
        all.push(row);
        // As tests give it.
        let litres =
            fabric.air.filter(|_| is_air).map(|air| shown(air.permeability.times(1e3), "l/(m² s)", None));
        all.extend(litres.map(|litres| ["the same".to_owned(), litres]));
    }
    let (name, measures) = (&STREAK_MEASURES[0], &STREAK_MEASURES[3..]);
    for streak in fabric.streaks.iter().take(MOST_STREAKS) {
        let place = known_text(&name.of(streak)).unwrap_or_default();
        all.extend(rows(&format!("Streak at {place}: "), measures, streak));
    }
    all
}

fn rows<T>(before: &str, measures: &'static [Measure<T>], of: &T) -> Vec<[String; 2]> {
    let row = |row: Measured<T>| {
        let label = row.measure.terse();
        let name = if before.is_empty() { label.to_owned() } else { before.to_owned() + &in_sentence(label) };
        Some([name, known_text(&row)?])
    };
    measure::measured(measures, of).filter_map(row).collect()
}

/// The number of a row in words, with its unit; none if it has none.
pub fn known_text<T>(row: &Measured<T>) -> Option<String> {
    let Some(Value::Reported(known)) = &row.value else { return None };
    let unit = row.measure.unit.readable(known.value());
    Some(shown(known.times(unit.per_si), unit.shown, row.measure.digits))
}

/// A number in words, with its unit.
fn shown(known: Known, unit: &str, digits: Option<i32>) -> String {
    let shown = match known {
        Known::Exact(value) => number_to(value, digits.unwrap_or(3)),
        Known::Value(value, error) => plus_minus(value, error),
        Known::AtLeast(least) => format!("at least {}", number(least)),
        Known::AtMost(most) => format!("at most {}", number(most)),
        Known::Between([low, high]) if high >= 1e6 => format!("{} to {}", number(low), number(high)),
        Known::Between([low, high]) if low < 1e-3 => format!("at most {}", number(high)),
        Known::Between([low, high]) => range(low, high),
    };
    match unit.strip_prefix("1/") {
        Some(area) => format!("{shown} per{HARD}{area}"),
        None if unit.is_empty() => shown,
        None => format!("{shown}{THIN}{unit}"),
    }
}
