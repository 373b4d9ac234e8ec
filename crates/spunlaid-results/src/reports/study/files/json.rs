//! `results.json`: the points with their results, and the ranking.

use super::inputs_of;
use crate::files::table::Value;
use serde_json::{Value as Json, json};
use spunlaid_experiment::{Claim, Contrast, PointResults, Ranking, Rankings, Study};
use spunlaid_ground::Effect;
use std::io::Write;

/// Version of the layout. It increases when a field is renamed or removed or changes its meaning.
const SCHEMA_VERSION: u32 = 1;

/// Writes `results.json`, numbers in SI units, a line per point. It is written as it is made, so that memory does not
/// grow with the number of points.
pub fn write_json(
    out: &mut dyn Write,
    study: &Study,
    results: &[PointResults],
    rankings: &Rankings,
    claims: &[Claim],
) -> std::io::Result<()> {
    let ranking = |ranking: &Ranking| {
        let effects: Json = ranking.effects.iter().map(|effect| effect_of(study, effect)).collect();
        // `explained`: share of the variation between points that straight lines explain.
        let object = json!({"explained": ranking.explained, "effects": effects});
        (study.quantities[ranking.measure].column.clone(), object)
    };
    // By the columns of the results; empty if the factors cannot be ranked.
    let ranking: Json = rankings.of_measures.iter().map(ranking).collect();
    let refusal = rankings.refusal.as_ref().map(ToString::to_string);
    let version = env!("CARGO_PKG_VERSION");
    let design = study.design.name();
    let common = study.common_phases;
    writeln!(out, "{{\n\"schema_version\": {SCHEMA_VERSION},\n\"spunlaid_version\": \"{version}\",")?;
    write!(out, "\"design\": \"{design}\",\n\"common_phases\": {common},\n\"points\": [")?;
    for (index, point_results) in results.iter().enumerate() {
        out.write_all(if index == 0 { b"\n" } else { b",\n" })?;
        serde_json::to_writer(&mut *out, &point(study, index, point_results))?;
    }
    out.write_all(b"\n],\n\"ranking\": ")?;
    serde_json::to_writer(&mut *out, &ranking)?;
    out.write_all(b",\n\"refusal\": ")?;
    serde_json::to_writer(&mut *out, &refusal)?;
    if !claims.is_empty() {
        out.write_all(b",\n\"claims\": ")?;
        serde_json::to_writer(&mut *out, claims)?;
    }
    out.write_all(b"\n}\n")
}

fn point(study: &Study, index: usize, measured: &PointResults) -> Json {
    let inputs = study.inputs().zip(inputs_of(study, index));
    let inputs: Json = inputs.map(|(input, value)| (input.column(), plain(value))).collect();
    let result = |i: usize| {
        let mut numbers = json!({"mean": measured.mean(i), "standard_error": measured.standard_error(i)});
        // By all causes, if there are others than the scatter of the replicates.
        if let Some(error) = measured.total_error(&study.quantities, i) {
            numbers["total_error"] = error.into();
        }
        (study.quantities[i].column.clone(), numbers)
    };
    let results = (0..study.quantities.len()).filter(|&i| measured.mean(i).is_finite()).map(result);
    json!({
        "point": index + 1,
        "seed": study.points[index].experiment.seed(),
        "inputs": inputs,
        "n": measured.n,
        "lost": measured.lost,
        "results": results.collect::<Json>(),
    })
}

fn effect_of(study: &Study, effect: &Effect<Contrast>) -> Json {
    let Contrast { factor, from, to } = effect.of;
    let factor = &study.factors[factor];
    let end = |value: f64| factor.key.word(value).map_or_else(|| value.into(), Json::from);
    let half_width = effect.difference.known_half_width();
    json!({
        "factor": factor.key.name,
        "from": end(from),
        "to": end(to),
        "change": effect.difference.value,
        "standard_error": half_width.map(|_| effect.difference.standard_error),
        // Of the 95 % interval.
        "half_width": half_width,
    })
}

fn plain(value: Value) -> Json {
    match value {
        Value::Whole(value) => value.into(),
        Value::Number(value) => value.into(),
        Value::Word(word) => word.into(),
    }
}
