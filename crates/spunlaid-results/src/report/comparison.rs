//! `report.html` of a comparison: a table for each pair of runs, and their curves in one picture each.

use super::rendered;
use crate::output::comparison::{Compared, Comparison};
use askama::Template;
use spunlaid_charts::Figure;

/// Content of the report.
#[derive(Clone, Copy, Debug)]
pub struct ComparisonReport<'a> {
    /// The comparisons.
    pub comparisons: &'a [Comparison],
    /// The figures.
    pub figures: &'a [Figure],
    /// Version of the program.
    pub version: &'a str,
}

/// Content of `assets/comparison.html`, which escapes everything that is not marked safe.
#[derive(Template)]
#[template(path = "comparison.html")]
struct ComparisonPage<'a> {
    title: String,
    tables: Vec<PairTable<'a>>,
    figures: &'a [Figure],
    version: &'a str,
}

struct PairTable<'a> {
    comparison: &'a Comparison,
    rows: Vec<MeasureRow<'a>>,
    beyond: usize,
    all: usize,
}

struct MeasureRow<'a> {
    name: &'a str,
    unit: &'static str,
    cells: [String; 4],
    /// Whether the difference is within chance.
    faint: bool,
}

fn row(compared: &Compared) -> MeasureRow<'_> {
    MeasureRow {
        name: &compared.label,
        unit: compared.unit,
        cells: compared.cells(),
        faint: !compared.difference.is_some_and(|difference| difference.is_beyond_chance()),
    }
}

/// The report as one HTML file.
pub fn comparison_html(input: &ComparisonReport<'_>) -> String {
    let tables = input.comparisons.iter().map(|comparison| {
        let (beyond, all) = comparison.beyond_chance();
        PairTable { comparison, rows: comparison.measures.iter().map(row).collect(), beyond, all }
    });
    let first = input.comparisons.first().map_or("", |comparison| comparison.against.as_str());
    let others: Vec<&str> = input.comparisons.iter().map(|comparison| comparison.run.as_str()).collect();
    let page = ComparisonPage {
        title: format!("{} against {first}", others.join(", ")),
        tables: tables.collect(),
        figures: input.figures,
        version: input.version,
    };
    rendered(&page)
}
