//! The report of a fit: the values, what they are worth, the figures.

use super::files::{pretty, refused, sentences as sentences_of, value_and_interval, warning};
use crate::numbers::{plus_minus, significant};
use crate::page::document::{Report, Section};
use crate::page::methods::{MOMENTS, methods, of_web};
use crate::page::table::{Row, Table};
use spunlaid_charts::Figure;
use spunlaid_experiment::{Fit, FittedKey, FittedNumber, KeyWarning, Target, Texture};
use spunlaid_ground::Dimension;
use spunlaid_simulation::WebSpec;

/// Values of a web that make it like a scan.
///
/// * `scan` – its results folder
/// * `target` – what of the scan was compared
/// * `spec` – the web with the values that were found
/// * `toml` – this web as a file
pub fn fit_report<'a>(
    fit: &Fit,
    scan: &str,
    target: &Target,
    spec: &WebSpec,
    toml: &str,
    figures: &'a [Figure],
) -> Report<'a> {
    let title = title(fit);
    let [width, length] = target.sides().map(|side| Dimension::Length.pretty(side));
    let summary = format!(
        "Fitted to {scan}: a piece of {width} across and {length} along the web, against {} simulated webs of \
        each trial.",
        fit.webs
    );
    let cited = of_web(spec).into_iter().chain([MOMENTS]).collect();
    let methods = methods("fit", cited, "web.toml of the results");
    let file = Section::new("file", "The web with these values")
        .paragraph("This file is web.toml in the folder of this page; `spunlaid web web.toml` lays it.")
        .file("web-toml", toml);
    Report::new("fit", title)
        .lead(summary)
        .with(values(fit).printed())
        .with(Section::of_figures(figures))
        .with(numbers(fit))
        .with(methods)
        .with(file)
}

/// The values, and what they are worth.
fn values(fit: &Fit) -> Section<'static> {
    let table = Table::new(["Key", "Start", "Fit", "95\u{202f}% interval"]).sentences(["Remark"]);
    let name = |key: &FittedKey| key.parameter.key.name.clone();
    let heads = std::iter::once("Correlation of the errors".to_owned()).chain(fit.keys.iter().map(name));
    let correlations = fit.keys.iter().zip(&fit.correlations).filter(|_| fit.keys.len() > 1);
    let rows =
        correlations.map(|(key, row)| Row::new(name(key), row.iter().map(|number| significant(*number, 2))));
    Section::new("values", "The values")
        .table(table.rows(fit.keys.iter().map(row)))
        .paragraphs(sentences_of(fit).into_iter().chain(refused(fit)))
        .caption(
            "The interval is that of a scan of this size: each simulated web in turn replaced the scan, and the \
            values fitted to it scatter like those of a real scan. It includes the noise and the blur of the \
            camera, the sample of simulated fibres and the surrogate, as far as they are known. It excludes errors \
            of the model of the line: other values of keys that were not fitted give other results.",
        )
        .table(Table::new(heads).rows(rows))
}

/// What was compared.
fn numbers(fit: &Fit) -> Section<'static> {
    let heads = ["Number", "Scan", "Start", "Fit ± scatter of a web", "Residual"];
    let caption = format!(
        "The same part of every web is measured in the same way as the scan. The residual is the logarithm \
        of scan over fit, in standard deviations of a single web. {} trials of {} webs were laid, all with \
        the same random numbers; trials.csv has them, fit.json all numbers.",
        fit.trials.len(),
        fit.webs
    );
    Section::new("numbers", "What was compared")
        .table(Table::new(heads).rows(fit.numbers.iter().map(number)))
        .caption(caption)
}

/// The answer.
fn title(fit: &Fit) -> String {
    let values: Vec<String> = fit
        .keys
        .iter()
        .map(|key| {
            let [value, interval] = value_and_interval(key);
            let name = &key.parameter.key.name;
            match (key.warning, &key.interval) {
                (Some(KeyWarning::Unknown | KeyWarning::NoEffect), _) => format!("{name} is not determined"),
                (_, Ok(_)) => format!("{name} = {value} ({interval})"),
                (_, Err(_)) => format!("{name} = {value}"),
            }
        })
        .collect();
    let values = values.join(", ");
    if fit.worse == 0 { format!("Closest, but not like the scan: {values}") } else { values }
}

fn row(key: &FittedKey) -> Row {
    let [value, interval] = value_and_interval(key);
    let parameter = &key.parameter;
    let pretty = |value: f64| pretty(parameter, value);
    let [low, high] = parameter.range.map(pretty);
    let remark =
        key.warning.map_or_else(|| format!("sought from {low} to {high}"), |found| warning(found).to_owned());
    Row::new(&parameter.key.name, [pretty(parameter.start), value, interval, remark])
}

fn number(number: &FittedNumber) -> Row {
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
    let found = plus_minus(scale * number.found, Some(scale * number.found * number.scatter));
    let residual = significant(number.residual(), 2);
    Row::new(name, [shown(number.scan), shown(number.start), format!("{found} {unit}"), residual])
}
