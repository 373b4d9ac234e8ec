//! `report.html` of a fit: the values, what they are worth, the figures.

use super::methods::{MOMENTS, Methods, web_account};
use super::rendered;
use crate::numbers::significant;
use crate::output::fit::{doubt, pretty, refused, sentences as sentences_of, value_and_interval};
use askama::Template;
use spunlaid::fit::{Fit, FittedKey, FittedNumber, Target, Texture};
use spunlaid::layers::WebSpec;
use spunlaid::units::Dimension;
use spunlaid_charts::Figure;

/// Content of the report.
#[derive(Clone, Copy, Debug)]
pub struct FitReport<'a> {
    /// What the fit is called: the name of the web's file.
    pub name: &'a str,
    /// The results folder of the scan.
    pub scan: &'a str,
    /// What was found.
    pub fit: &'a Fit,
    /// What it was compared with.
    pub target: &'a Target,
    /// The web with the values that were found.
    pub spec: &'a WebSpec,
    /// The figures.
    pub figures: &'a [Figure],
    /// Notes for the reader.
    pub notes: &'a [String],
    /// The web with the values that were found, as a file.
    pub toml: &'a str,
}

/// Content of `assets/fit.html`, which escapes everything that is not marked safe.
#[derive(Template)]
#[template(path = "fit.html")]
struct FitPage<'a> {
    title: String,
    name: &'a str,
    summary: String,
    notes: &'a [String],
    sentences: Vec<String>,
    keys: Vec<[String; 5]>,
    correlation_heads: Vec<String>,
    correlations: Vec<(String, Vec<String>)>,
    numbers: Vec<[String; 5]>,
    methods_paragraph: Methods,
    trials: usize,
    webs: u64,
    figures: &'a [Figure],
    toml: &'a str,
}

/// The report as one HTML file.
pub fn fit_html(input: &FitReport<'_>) -> String {
    let fit = input.fit;
    let [width, length] = input.target.sides().map(|side| Dimension::Length.pretty(side));
    let several = fit.keys.len() > 1;
    let head = |key: &FittedKey| if several { key.parameter.key.clone() } else { String::new() };
    let correlations = fit.keys.iter().zip(&fit.correlations).filter(|_| several);
    let page = FitPage {
        title: title(fit),
        name: input.name,
        summary: format!(
            "Fitted to {}: a piece of {width} across and {length} along the web, beside {} simulated webs of each trial.",
            input.scan, fit.webs
        ),
        notes: input.notes,
        sentences: sentences_of(fit).into_iter().chain(refused(fit)).collect(),
        keys: fit.keys.iter().map(row).collect(),
        correlation_heads: fit.keys.iter().filter(|_| several).map(head).collect(),
        correlations: correlations
            .map(|(key, row)| {
                (key.parameter.key.clone(), row.iter().map(|number| significant(*number, 2)).collect())
            })
            .collect(),
        numbers: fit.numbers.iter().map(number).collect(),
        methods_paragraph: methods(input),
        trials: fit.trials.len(),
        webs: fit.webs,
        figures: input.figures,
        toml: input.toml,
    };
    rendered(&page)
}

/// The paragraph for a paper.
fn methods(input: &FitReport<'_>) -> Methods {
    let fit = input.fit;
    let (mut sentences, mut cited) = web_account(input.spec, None);
    let [width, length] = input.target.sides().map(|side| Dimension::Length.pretty(side));
    sentences.push(format!(
        "These values were found by a simulated method of moments ({}): the logarithms of {} numbers (CV over square patches{}) of a piece of {width} × {length} \
         were compared with the mean of {} simulated webs, weighted by the inverse of their covariance from web to web. A 95 % interval holds the values with \
         which simulated webs, each in the place of the scan, differ from the others as much as the scan does.",
        MOMENTS.short,
        fit.numbers.len(),
        if fit.numbers.iter().any(|number| matches!(number.texture, Texture::Band { .. })) {
            ", variance of octaves of the spectrum"
        } else {
            ""
        },
        fit.webs,
    ));
    cited.push(MOMENTS);
    let found =
        std::iter::once(format!("Values with 95 % intervals: {}.", title(fit))).chain(sentences_of(fit));
    Methods::new("fit", (sentences, cited), found)
}

/// The answer.
fn title(fit: &Fit) -> String {
    let values: Vec<String> = fit
        .keys
        .iter()
        .map(|key| {
            let [value, interval] = value_and_interval(key);
            let interval = if key.interval.is_ok() { format!(" ({interval})") } else { String::new() };
            format!("{} = {value}{interval}", key.parameter.key)
        })
        .collect();
    let values = values.join(", ");
    if fit.worse == 0 { format!("Closest, but not like the scan: {values}") } else { values }
}

fn row(key: &FittedKey) -> [String; 5] {
    let [value, interval] = value_and_interval(key);
    let parameter = &key.parameter;
    let pretty = |value: f64| pretty(parameter, value);
    let [low, high] = parameter.range.map(pretty);
    [
        parameter.key.clone(),
        pretty(parameter.start),
        value,
        interval,
        key.doubt.map_or_else(|| format!("sought from {low} to {high}"), |found| doubt(found).to_owned()),
    ]
}

fn number(number: &FittedNumber) -> [String; 5] {
    let millimetres = |size: f64| significant(size * 1e3, 3);
    let (name, scale, unit) = match number.texture {
        Texture::Patch(side) => (format!("CV over patches of {} mm", millimetres(side)), 100.0, "%"),
        Texture::Band { direction, waves } => {
            let along = if direction == 0 { "across" } else { "along" };
            (
                format!(
                    "Variance of waves of {} to {} mm {along}",
                    millimetres(waves[0]),
                    millimetres(waves[1])
                ),
                1e4,
                "%²",
            )
        }
    };
    let shown = |value: f64| format!("{} {unit}", significant(scale * value, 3));
    [
        name,
        shown(number.scan),
        shown(number.start),
        format!("{} ± {}", significant(scale * number.found, 3), shown(number.found * number.scatter)),
        significant(number.residual(), 2),
    ]
}
