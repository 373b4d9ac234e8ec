//! `summary.json` of a spinline, and the part `spinline` of the summaries of runs and of webs.

use super::SpinResults;
use super::words::model_error;
use crate::output::measured::values;
use crate::output::versioned_json;
use serde_json::{Value as Json, json};
use spunlaid::case::Case;
use spunlaid::input::{Influence, OfFilament};
use spunlaid::observe::OF_SPINLINES;
use spunlaid::spinline::Solution;
use spunlaid_charts::label::plain;

/// The text of `summary.json`.
pub fn summary(results: &SpinResults, notes: &[String]) -> String {
    versioned_json(1, json!({"spinline": part(results), "notes": notes}))
}

/// That of the spinline from which a case is fed; `None` if it has none.
pub fn part_of_case(case: &Case) -> Option<Json> {
    SpinResults::from_case(case).as_ref().map(part)
}

/// The measures of a spinline. Those of a curtain are of its first row.
fn part(SpinResults { rows, influences }: &SpinResults) -> Json {
    let mut told = rows.first().map_or_else(|| json!({}), measures);
    if rows.len() > 1 {
        told["rows"] = rows.iter().map(measures).collect();
    }
    told["influences"] = influences.iter().map(influence).collect();
    told["model_error"] = model_error(rows.first().is_some_and(|row| row.has_low_birefringence)).into();
    told
}

fn measures(row: &Solution) -> Json {
    let mut told = values(OF_SPINLINES, row);
    told["freezing"]["by"] = row.freezing.by.name().into();
    told["second_steady_state"] = row.has_second.into();
    told
}

/// What is changed, how, and what it does.
fn influence(influence: &Influence) -> Json {
    let setting = influence.change.setting;
    let value = |of: OfFilament| influence.on(of).map(|effect| effect.difference.value);
    json!({
        "key": setting.name,
        "label": plain(setting.words),
        "change": if influence.change.keys[0].by_kelvin { "10 K" } else { "relative" },
        "diameter": value(OfFilament::Diameter),
        "speed": value(OfFilament::Speed),
    })
}
