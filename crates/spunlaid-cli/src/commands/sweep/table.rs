//! The table of a study on the terminal.

use super::super::{LISTED, aligned};
use spunlaid::study::{PointResults, Study};
use spunlaid_results::output::study::shown;
use std::fmt::Write;

/// Number of measures that are shown.
const SHOWN: usize = 4;

/// A line per point: the values that vary, then mean ± standard error of the results.
pub(super) fn results(study: &Study, results: &[PointResults]) -> String {
    let is_of_webs = study.noun() == "web";
    let shown = shown::quantities(study);
    let shown = || shown.iter().take(if is_of_webs { usize::MAX } else { SHOWN });
    let head = |quantity: &usize| {
        let quantity_shown = &study.quantities[*quantity];
        match quantity_shown.figure.name {
            "cv" => quantity_shown.series.clone(),
            "cv_flown" => format!("flown {}", quantity_shown.series),
            _ => shown::head(quantity_shown),
        }
    };
    let mut heads = vec!["point".to_owned()];
    heads.extend(study.inputs().map(|input| input.key.rsplit('.').next().unwrap_or(input.key).to_owned()));
    heads.extend(shown().map(head));
    heads.push("n".to_owned());
    let mut rows = vec![heads];
    for (index, point) in results.iter().enumerate().take(LISTED) {
        let mut row = vec![(index + 1).to_string()];
        let values = study.points[index].values.iter().zip(study.inputs());
        row.extend(values.map(|(value, input)| input.pretty(*value)));
        row.extend(shown().map(|quantity| shown::cell(study, point, *quantity)));
        row.push(point.n.to_string());
        rows.push(row);
    }
    let mut text = String::new();
    if is_of_webs {
        text.push_str(
            "unevenness, CV in % ± its error by all causes that are known, over patches of this side; \
            flown: expected from the flown curves\n",
        );
    }
    text.push_str(&aligned(&rows));
    if results.len() > LISTED {
        let _ = writeln!(text, "  and {} more points in results.csv", results.len() - LISTED);
    }
    text
}
