//! The table of a study on the terminal.

use super::super::aligned;
use spunlaid::study::{PointResults, Study};
use spunlaid_results::output::study::shown;
use std::fmt::Write;

/// Largest number of points that are listed.
const LISTED: usize = 24;
/// Number of measures that are shown.
const SHOWN: usize = 4;

/// A line per point: the values that vary, then mean ± standard error of the results.
pub(super) fn results(study: &Study, results: &[PointResults]) -> String {
    let mut rows: Vec<Vec<String>> = Vec::new();
    let measures = shown::measures(study);
    let measures = || measures.iter().take(SHOWN);
    let mut heads = vec!["point".to_owned()];
    heads.extend(study.inputs().map(|of| of.key.rsplit('.').next().unwrap_or(of.key).to_owned()));
    heads.extend(measures().map(|name| shown::head(name)));
    heads.push("n".to_owned());
    rows.push(heads);
    for (index, point) in results.iter().enumerate().take(LISTED) {
        let mut row = vec![(index + 1).to_string()];
        let values = study.points[index].values.iter().zip(study.inputs());
        row.extend(values.map(|(value, input)| input.pretty(*value)));
        row.extend(measures().map(|name| shown::cell(point, name)));
        row.push(point.n.to_string());
        rows.push(row);
    }
    let mut text = aligned(&rows);
    if results.len() > LISTED {
        let _ = writeln!(text, "  and {} more points in results.csv", results.len() - LISTED);
    }
    text
}
