//! The tables of a study of webs.

use super::folder::Staging;
use super::json_text;
use super::summary::InOrder;
use crate::Failure;
use crate::webs::PointOfWebs;
use spunlaid::input::WebStudy;
use spunlaid::study::{Factor, Input};
use spunlaid_charts::shortest;
use std::collections::BTreeMap;

/// Names and values of the columns of a point.
fn columns(of: &PointOfWebs) -> Vec<(String, Option<f64>)> {
    let mut columns = vec![("webs".to_owned(), Some(of.webs as f64))];
    for patch in &of.patches {
        let side = shortest((patch.patch * 1e9).round() / 1e6);
        columns.extend([
            (format!("cv_{side}_mm"), Some(patch.cv)),
            (format!("cv_{side}_mm_standard_error"), patch.standard_error),
            (format!("cv_{side}_mm_whole_error"), patch.whole_error()),
            (format!("cv_{side}_mm_one_fibre"), Some(patch.one_fibre)),
            (format!("cv_{side}_mm_flown"), patch.flown.map(|of| of.0)),
            (format!("cv_{side}_mm_flown_standard_error"), patch.flown.map(|of| of.1)),
            (format!("cv_{side}_mm_straight_fibres"), Some(patch.straight_fibres)),
        ]);
    }
    columns.extend(of.numbers.iter().map(|(name, value)| (name.clone(), Some(value.mean))));
    columns
}

/// Writes `results.csv`, a row for each point, and `results.json`.
pub(crate) fn write(staging: &Staging<'_>, study: &WebStudy, results: &[PointOfWebs]) -> Result<(), Failure> {
    let rows: Vec<BTreeMap<String, Option<f64>>> =
        results.iter().map(|of| columns(of).into_iter().collect()).collect();
    // Points may differ in what they have; every column that any has, in the order of the first.
    let mut names: Vec<String> = Vec::new();
    for (name, _) in results.iter().flat_map(columns) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let inputs: Vec<_> = study.factors.iter().map(Factor::input).collect();
    let name = "results.csv";
    let (now, later) = staging.place(name);
    let failed = |error: csv::Error| Failure::unwritable(&later)(error.into());
    let mut writer = csv::Writer::from_path(now).map_err(failed)?;
    let head = ["point".to_owned()].into_iter().chain(inputs.iter().map(|input| input.column()));
    writer.write_record(head.chain(names.iter().cloned())).map_err(failed)?;
    for (number, (point, row)) in (1..).zip(study.points.iter().zip(&rows)) {
        let value = |(input, value): (&Input<'_>, &f64)| {
            input.word(*value).map_or_else(|| shortest(*value), str::to_owned)
        };
        let values = inputs.iter().zip(&point.values).map(value);
        let cells =
            names.iter().map(|name| row.get(name).copied().flatten().map(shortest).unwrap_or_default());
        let number: u64 = number;
        writer.write_record([number.to_string()].into_iter().chain(values).chain(cells)).map_err(failed)?;
    }
    writer.flush().map_err(Failure::unwritable(&later))?;
    let points: Vec<InOrder<serde_json::Value>> = (study.points.iter().zip(results))
        .map(|(point, of)| {
            let value = |(input, value): (&Input<'_>, &f64)| {
                (input.column(), input.word(*value).map_or_else(|| (*value).into(), Into::into))
            };
            let mut entries: Vec<_> = inputs.iter().zip(&point.values).map(value).collect();
            entries.extend(columns(of).into_iter().map(|(name, value)| (name, value.into())));
            InOrder(entries)
        })
        .collect();
    let about = [
        ("spunlaid_version".to_owned(), serde_json::Value::from(env!("CARGO_PKG_VERSION"))),
        ("design".to_owned(), study.design.name().into()),
        ("webs_per_point".to_owned(), study.replicates.into()),
        ("points".to_owned(), serde_json::to_value(&points).unwrap_or_default()),
    ];
    staging.write("results.json", json_text(&InOrder(about.to_vec())))
}
