//! The tables of a run: its results, and those of each replicate.

use crate::numbers::{capitalised, number, signed};
use crate::page::table::{Content, Layout, Row, Table};
use crate::page::words::{estimate_text, unbroken};
use spunlaid_ground::{Aggregate, Estimate};
use spunlaid_simulation::{Number, Results};

/// Most replicates whose own values are listed.
const LISTED: usize = 1000;

/// The mean of a result with its whole error, and why it has none.
pub(super) type Whole<'a> = dyn Fn(&Number) -> (Estimate, Option<String>) + 'a;

/// The results that stand under one heading.
pub(super) fn groups(results: &Results) -> Vec<&[Number]> {
    results.numbers.chunk_by(|a, b| a.measure.group == b.measure.group).collect()
}

fn title(group: &[Number]) -> String {
    capitalised(group.first().map_or("", |one| one.measure.group.title))
}

/// A row for each number, under the headings of the measures.
///
/// * `whole` – an estimate with its whole error
pub(super) fn result_table(results: &Results, whole: &Whole<'_>) -> Table {
    let columns = [
        ("Result", Content::Words),
        ("Value", Content::Numbers),
        ("Unit", Content::Words),
        ("n", Content::Asides),
        ("Meaning", Content::Meanings),
    ];
    let table = Table::of(columns).laid_out(Layout::Results);
    groups(results).into_iter().fold(table, |table, group| {
        let rows: Vec<Row> = group.iter().map(|one| row(one, whole)).collect();
        table.group(title(group), rows)
    })
}

fn row(one: &Number, whole: &Whole<'_>) -> Row {
    let measure = one.measure;
    let (estimate, why_unknown) = whole(one);
    let factor = measure.unit.per_si;
    // A median or a largest value has no error.
    let (value, note) = match measure.aggregate {
        Aggregate::Median => (number(one.value() * factor), "median over the replicates".to_owned()),
        Aggregate::Largest => (number(one.value() * factor), "the largest of all replicates".to_owned()),
        Aggregate::Mean => (estimate_text(&estimate, factor), String::new()),
    };
    let n = count(one);
    let cells = [value, measure.unit.shown.to_owned(), n.to_string(), unbroken(measure.meaning)];
    let note = if n > 1 { note } else { String::new() };
    let notes: Vec<String> =
        [Some(note), why_unknown].into_iter().flatten().filter(|note| !note.is_empty()).collect();
    Row::new(unbroken(measure.label), cells).detail(notes.join("; "))
}

/// Number of replicates that it is taken over.
fn count(one: &Number) -> usize {
    one.estimate.values.iter().filter(|value| value.is_finite()).count()
}

/// One row for each replicate that was not lost, and how many more there are.
pub(super) fn replicate_table(results: &Results) -> (Table, usize) {
    let is_lost = |i: &usize| results.lost.iter().any(|fibre| fibre.replicate == *i as u64);
    let all = results.replicates() + results.lost.len();
    let listed: Vec<usize> = (0..all).filter(|i| !is_lost(i)).take(LISTED).collect();
    let cells = |one: &Number| {
        let values: Vec<f64> = listed.iter().filter_map(|i| one.estimate.values.get(*i).copied()).collect();
        column(&values, one.measure.unit.per_si)
    };
    let columns: Vec<Vec<String>> = results.numbers.iter().map(cells).collect();
    let row = |(row, i): (usize, &usize)| {
        Row::new((i + 1).to_string(), columns.iter().filter_map(|column| column.get(row)))
    };
    let head = |one: &Number| unbroken(&format!("{} ({})", one.measure.label, one.measure.unit.shown));
    let heads = ["Replicate".to_owned()].into_iter().chain(results.numbers.iter().map(head));
    let table = Table::new(heads)
        .laid_out(Layout::Scrolled("all replicates and columns"))
        .spans(groups(results).into_iter().map(|group| (title(group), group.len())).collect())
        .rows(listed.iter().enumerate().map(row));
    (table, results.replicates().saturating_sub(LISTED))
}

/// Values with as many decimals as give the largest four digits; far from one each with its power of ten.
fn column(values: &[f64], factor: f64) -> Vec<String> {
    let scaled: Vec<f64> = values.iter().map(|v| v * factor).collect();
    let largest = scaled.iter().map(|v| v.abs()).fold(0.0, f64::max);
    let decimals = if largest > 0.0 { 3 - largest.log10().floor() as i32 } else { 0 };
    let plain = (0..=6).contains(&decimals) && scaled.iter().all(|v| v.is_finite());
    scaled.iter().map(|&v| if plain { signed(v, decimals as usize) } else { number(v) }).collect()
}
