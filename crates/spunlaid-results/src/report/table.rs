//! The rows of the results table.

use super::words::{estimate_text, unbroken};
use crate::numbers::{number, signed};
use spunlaid::ensemble::{Number, Results};
use spunlaid::observe::Aggregate;

/// Results under a heading.
pub(super) struct Group {
    pub(super) title: String,
    pub(super) rows: Vec<ResultRow>,
}

/// A result with its unit.
pub(super) struct ResultRow {
    pub(super) name: String,
    pub(super) value: String,
    pub(super) unit: &'static str,
    /// Number of replicates it is taken over.
    pub(super) n: usize,
    pub(super) meaning: String,
}

/// The results of one replicate.
pub(super) struct ReplicateRow {
    pub(super) number: usize,
    pub(super) values: Vec<String>,
}

/// A row for each number, under the headings of the measures.
pub(super) fn groups(results: &Results) -> Vec<Group> {
    let same = |a: &Number, b: &Number| a.measure.group == b.measure.group;
    let group = |numbers: &[Number]| Group {
        title: capitalised(numbers.first().map_or("", |one| one.measure.group.title)),
        rows: numbers.iter().map(row).collect(),
    };
    results.numbers.chunk_by(same).map(group).collect()
}

/// The results of a group in a sentence.
pub(super) fn sentence(group: &Group) -> String {
    let result = |row: &ResultRow| format!("{} {} {}", row.name, row.value, row.unit).trim_end().to_owned();
    let n = group.rows.iter().map(|row| row.n).max().unwrap_or(0);
    let errors = if n > 1 {
        format!(" (mean ± one standard error of the mean over {n} replicates)")
    } else {
        String::new()
    };
    let all: Vec<String> = group.rows.iter().map(result).collect();
    format!("{}: {}{errors}.", group.title, all.join(", "))
}

fn row(one: &Number) -> ResultRow {
    let (measure, factor) = (one.measure, one.measure.unit.per_si);
    let (value, note) = match measure.aggregate {
        Aggregate::Mean => (estimate_text(&one.estimate, factor), ""),
        Aggregate::Median => (number(one.value() * factor), "; median over the replicates"),
        Aggregate::Largest => (number(one.value() * factor), "; the largest of all replicates"),
    };
    let n = one.estimate.values.iter().filter(|value| value.is_finite()).count();
    let note = if n > 1 { note } else { "" };
    ResultRow {
        name: unbroken(measure.label),
        value,
        unit: measure.unit.shown,
        n,
        meaning: unbroken(&format!("{}{note}", measure.meaning)),
    }
}

fn capitalised(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |first| first.to_uppercase().chain(chars).collect())
}

/// Heads of the columns of [`replicate_rows`].
pub(super) fn replicate_heads(results: &Results) -> Vec<String> {
    let head = |one: &Number| unbroken(&format!("{} ({})", one.measure.label, one.measure.unit.shown));
    results.numbers.iter().map(head).collect()
}

/// One row per replicate that was not lost, up to `most`.
pub(super) fn replicate_rows(results: &Results, most: usize) -> Vec<ReplicateRow> {
    let is_lost = |i: &usize| results.lost.iter().any(|fibre| fibre.replicate == *i as u64);
    let all = results.replicates() + results.lost.len();
    let listed: Vec<usize> = (0..all).filter(|i| !is_lost(i)).take(most).collect();
    let cell = |one: &Number| {
        let values: Vec<f64> = listed.iter().filter_map(|i| one.estimate.values.get(*i).copied()).collect();
        column(&values, one.measure.unit.per_si)
    };
    let columns: Vec<Vec<String>> = results.numbers.iter().map(cell).collect();
    let values = |row: usize| columns.iter().filter_map(|c| c.get(row).cloned()).collect();
    listed.iter().enumerate().map(|(row, i)| ReplicateRow { number: i + 1, values: values(row) }).collect()
}

/// Values with as many decimals as give the largest four digits; far from one each with its power of ten.
fn column(values: &[f64], factor: f64) -> Vec<String> {
    let scaled: Vec<f64> = values.iter().map(|v| v * factor).collect();
    let largest = scaled.iter().map(|v| v.abs()).fold(0.0, f64::max);
    let decimals = if largest > 0.0 { 3 - largest.log10().floor() as i32 } else { 0 };
    let plain = (0..=6).contains(&decimals) && scaled.iter().all(|v| v.is_finite());
    scaled.iter().map(|&v| if plain { signed(v, decimals as usize) } else { number(v) }).collect()
}
