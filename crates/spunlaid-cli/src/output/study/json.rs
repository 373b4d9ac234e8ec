//! `results.json`: the points with their results, and the ranking.

use super::super::summary::InOrder;
use super::columns::{Value, values};
use serde::Serialize;
use serde_json::Value as Json;
use spunlaid::study::{Effect, MEASURES, PointResults, Ranking, Rankings, Study};

/// Version of the layout. It increases when a field is renamed or removed or changes its meaning.
const SCHEMA_VERSION: u32 = 1;

#[derive(Serialize)]
struct Document {
    schema_version: u32,
    spunlaid_version: &'static str,
    design: &'static str,
    common_phases: bool,
    points: Vec<Point>,
    /// By the columns of the results; empty if the factors cannot be ranked.
    ranking: InOrder<RankingOf>,
    /// Why the factors cannot be ranked.
    refusal: Option<String>,
}

#[derive(Serialize)]
struct Point {
    point: usize,
    seed: u64,
    inputs: InOrder<Json>,
    n: u64,
    lost: u64,
    results: InOrder<Mean>,
}

#[derive(Serialize)]
struct Mean {
    mean: f64,
    standard_error: Option<f64>,
}

#[derive(Serialize)]
struct RankingOf {
    /// Share of the variation between points that straight lines explain.
    explained: Option<f64>,
    effects: Vec<EffectOf>,
}

#[derive(Serialize)]
struct EffectOf {
    factor: &'static str,
    from: Json,
    to: Json,
    change: f64,
    /// Half the width of the 95 % interval.
    half_width: Option<f64>,
}

/// The study as JSON, numbers in SI units.
pub(crate) fn json(study: &Study, results: &[PointResults], rankings: &Rankings) -> String {
    let points = results.iter().enumerate().map(|(index, of)| point(study, index, of)).collect();
    let ranking = |of: &Ranking| {
        let explained = Some(of.explained).filter(|share| share.is_finite());
        let effects = of.effects.iter().map(|effect| effect_of(study, effect)).collect();
        (MEASURES[of.measure].column.to_owned(), RankingOf { explained, effects })
    };
    let document = Document {
        schema_version: SCHEMA_VERSION,
        spunlaid_version: env!("CARGO_PKG_VERSION"),
        design: study.design.name(),
        common_phases: study.common_phases,
        points,
        ranking: InOrder(rankings.of_measures.iter().map(ranking).collect()),
        refusal: rankings.refusal.as_ref().map(ToString::to_string),
    };
    // Serialising plain numbers and strings into memory cannot fail.
    let mut text = serde_json::to_string_pretty(&document).unwrap_or_default();
    text.push('\n');
    text
}

fn point(study: &Study, index: usize, of: &PointResults) -> Point {
    let inputs = study.inputs().zip(values(study, index));
    let inputs = inputs.map(|(input, value)| (input.column(), plain(value))).collect();
    let result = |i: usize| {
        let mean = Mean { mean: of.mean[i], standard_error: of.standard_error[i] };
        (MEASURES[i].column.to_owned(), mean)
    };
    let results = (0..MEASURES.len()).filter(|&i| of.mean[i].is_finite()).map(result).collect();
    Point {
        point: index + 1,
        seed: study.points[index].case.run.seed,
        inputs: InOrder(inputs),
        n: of.n,
        lost: of.lost,
        results: InOrder(results),
    }
}

fn effect_of(study: &Study, effect: &Effect) -> EffectOf {
    let factor = &study.factors[effect.factor];
    let end = |value: f64| factor.input().word(value).map_or_else(|| value.into(), Json::from);
    EffectOf {
        factor: factor.key,
        from: end(effect.from),
        to: end(effect.to),
        change: effect.change,
        half_width: effect.half_width,
    }
}

fn plain(value: Value) -> Json {
    match value {
        Value::Whole(value) => value.into(),
        Value::Number(value) => value.into(),
        Value::Word(word) => word.into(),
    }
}
