//! `summary.json` of a spinline, and the part `spinline` of the summaries of runs and of webs.

use super::SpinResults;
use super::words::model_error;
use crate::output::in_order::OrderedObject;
use crate::output::measured::{json as number, values};
use crate::output::versioned_json;
use serde::Serialize;
use serde_json::{Value as Json, json};
use spunlaid::case::Case;
use spunlaid::input::{Influence, OfFilament};
use spunlaid::observe::OF_SPINLINES;
use spunlaid::spinline::Solution;
use spunlaid_charts::label::plain;

/// The content of `summary.json` of a spinline.
#[derive(Debug, Serialize)]
pub struct Summary<'a> {
    spinline: SpinSummary,
    notes: &'a [String],
}

impl<'a> Summary<'a> {
    /// Gathers everything.
    pub fn new(rows: &[Solution], influences: &[Influence], notes: &'a [String]) -> Self {
        let spinline = SpinSummary::new(rows, influences);
        Self { spinline, notes }
    }

    /// The text of the file.
    pub fn to_json(&self) -> String {
        versioned_json(1, self)
    }
}

/// The measures of a spinline. Those of a curtain are of its first row.
#[derive(Clone, Debug, Serialize)]
#[serde(transparent)]
pub struct SpinSummary(OrderedObject<Json>);

impl SpinSummary {
    /// * `rows` – the solution of each row, the quenched side first
    pub fn new(rows: &[Solution], influences: &[Influence]) -> Self {
        let mut entries = rows.first().map_or_else(Vec::new, measured);
        if rows.len() > 1 {
            let rows: Vec<Json> = rows.iter().map(|row| object(measured(row))).collect();
            entries.push(("rows".to_owned(), rows.into()));
        }
        let influences: Vec<Json> = influences.iter().map(summarise_influence).collect();
        entries.push(("influences".to_owned(), influences.into()));
        let is_low = rows.first().is_some_and(|row| row.has_low_birefringence);
        entries.push(("model_error".to_owned(), model_error(is_low).into()));
        Self(OrderedObject(entries))
    }

    /// That of the spinline from which a case is fed; `None` if it has none.
    pub fn from_case(case: &Case) -> Option<Self> {
        let results = SpinResults::from_case(case)?;
        Some(Self::new(&results.rows, &results.influences))
    }
}

/// An object; serde_json keeps its entries by their names.
fn object(entries: Vec<(String, Json)>) -> Json {
    Json::Object(entries.into_iter().collect())
}

/// The measures of a row, those of a group together.
fn measured(solution: &Solution) -> Vec<(String, Json)> {
    let mut entries: Vec<(String, Json)> = Vec::new();
    let mut put = |name: &str, value: Json| match name.split_once('.') {
        None => entries.push((name.to_owned(), value)),
        Some((group, name)) => {
            if !entries.iter().any(|(known, _)| known == group) {
                entries.push((group.to_owned(), Json::Object(serde_json::Map::new())));
            }
            let members = entries.iter_mut().find(|(known, _)| known == group).map(|(_, members)| members);
            if let Some(Json::Object(members)) = members {
                members.insert(name.to_owned(), value);
            }
        }
    };
    for (name, value) in values(OF_SPINLINES, solution).0 {
        put(&name, number(value));
    }
    put("freezing.by", solution.freezing.by.name().into());
    put("second_steady_state", solution.has_second.into());
    entries
}

/// An influence: what is changed, how, and what it does.
fn summarise_influence(influence: &Influence) -> Json {
    let setting = influence.change.setting;
    let change = if influence.change.keys[0].by_kelvin { "10 K" } else { "relative" };
    let value = |of: OfFilament| influence.on(of).map(|effect| effect.difference.value);
    json!({
        "key": setting.name,
        "label": plain(setting.words),
        "change": change,
        "diameter": value(OfFilament::Diameter),
        "speed": value(OfFilament::Speed),
    })
}
