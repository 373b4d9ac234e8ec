//! The table of results on the terminal.

use crate::numbers::{number, rounded};
use spunlaid::ensemble::{Number, Results};
use spunlaid::observe::{Aggregate, Group, Kind, Measure};
use spunlaid::units::Dimension;
use std::fmt::Write;

/// The results of a run, with a heading for each group of measures and a row for each result.
pub fn results(results: &Results) -> String {
    let n = results.replicates() as u64;
    let mut text = format!("mean ± standard error over {n} replicate{}\n", if n == 1 { "" } else { "s" });
    let widest = results.numbers.iter().map(|number| number.measure.label.chars().count()).max().unwrap_or(0);
    let mut heading: Option<Group> = None;
    for one in &results.numbers {
        let measure = one.measure;
        if heading != Some(measure.group) {
            let _ = writeln!(text, "{}", measure.group.title);
            heading = Some(measure.group);
        }
        let row = format!("  {:<widest$}  {}", measure.label, value(one));
        let _ = writeln!(text, "{} {}{}", row, measure.unit.shown, remark(measure.aggregate, n));
    }
    text + &neighbours(results)
}

/// The correlations with companions: a heading for each direction in which they are, and a row for each distance.
fn neighbours(results: &Results) -> String {
    let (mut text, mut heading) = (String::new(), "");
    for curve in results.curves.iter().filter(|curve| curve.measure.kind == Kind::Neighbour) {
        let Measure { figure, series, .. } = curve.measure;
        if heading != figure.title {
            let _ = writeln!(text, "{}", figure.title.to_lowercase());
            heading = figure.title;
        }
        for place in &curve.places {
            let (distance, series) = (Dimension::Length.pretty(place.at), series.trim_matches('*'));
            let (mean, error) = rounded(place.mean, place.standard_error);
            let error = error.map_or_else(String::new, |error| format!(" ± {error}"));
            let _ = writeln!(text, "  {series} at {distance}  {mean}{error}");
        }
    }
    text
}

/// The mean and its error, aligned at the sign ±. A median or a largest value has no error.
fn value(row: &Number) -> String {
    let factor = row.measure.unit.per_si;
    if row.measure.aggregate != Aggregate::Mean {
        return format!("{:>10}", number(row.value() * factor));
    }
    let (mean, error) =
        rounded(row.estimate.mean * factor, row.estimate.standard_error.map(|error| error * factor));
    error.map_or_else(|| format!("{mean:>10}"), |error| format!("{mean:>10} ± {error}"))
}

fn remark(aggregate: Aggregate, replicates: u64) -> &'static str {
    match aggregate {
        Aggregate::Median if replicates > 1 => "  (median)",
        Aggregate::Largest if replicates > 1 => "  (largest)",
        Aggregate::Mean | Aggregate::Median | Aggregate::Largest => "",
    }
}
