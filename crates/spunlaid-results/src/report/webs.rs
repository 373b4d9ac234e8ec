//! `report.html` of a study of webs.

use super::rendered;
use crate::figures::name_of_key;
use crate::numbers::{number, plus_minus, significant};
use crate::webs::PointOfWebs;
use askama::Template;
use spunlaid::input::{WebStudy, WebStudyFile};
use spunlaid_charts::Figure;

/// Largest number of points that are listed.
const LISTED: usize = 500;

/// Content of the report.
#[derive(Clone, Copy, Debug)]
pub struct WebStudyReport<'a> {
    /// What the study is called.
    pub name: &'a str,
    /// The study and its web as text.
    pub file: &'a WebStudyFile,
    /// The results of each point.
    pub results: &'a [PointOfWebs],
    /// The figures.
    pub figures: &'a [Figure],
    /// Notes for the reader.
    pub notes: &'a [String],
}

/// Content of `assets/webs.html`, which escapes everything that is not marked safe.
#[derive(Template)]
#[template(path = "webs.html")]
struct Page<'a> {
    name: &'a str,
    question: String,
    summary: String,
    notes: &'a [String],
    figures: &'a [Figure],
    heads: Vec<String>,
    rows: Vec<Row>,
    unlisted: usize,
    study_toml: &'a str,
    web_toml: &'a str,
    version: &'a str,
}

struct Row {
    number: usize,
    cells: Vec<String>,
}

/// The report as one HTML file.
pub fn webs_html(input: &WebStudyReport<'_>) -> String {
    let study = &input.file.study;
    let (heads, rows) = table(study, input.results);
    let page = Page {
        name: input.name,
        question: question(study),
        summary: summary(study, input.results),
        notes: input.notes,
        figures: input.figures,
        heads,
        rows,
        unlisted: study.points.len().saturating_sub(LISTED),
        study_toml: &input.file.text,
        web_toml: &input.file.web_text,
        version: env!("CARGO_PKG_VERSION"),
    };
    rendered(&page)
}

fn question(study: &WebStudy) -> String {
    let names: Vec<String> = study.factors.iter().map(|factor| name_of_key(factor.key)).collect();
    match names.as_slice() {
        [] => "How even is the web?".to_owned(),
        [one] => format!("How does the evenness of the web depend on the {one}?"),
        [first @ .., last] => {
            format!("How does the evenness of the web depend on the {} and the {last}?", first.join(", the "))
        }
    }
}

/// The most even and the least even point, over patches of one size.
fn summary(study: &WebStudy, results: &[PointOfWebs]) -> String {
    let webs: u64 = results.iter().map(|of| of.webs).sum();
    let middle = results.first().map_or(0, |of| of.patches.len() / 2);
    // Points are put in order by what the flown curves say, where all have them.
    let flown = results.iter().all(|of| of.patches.get(middle).is_some_and(|of| of.flown.is_some()));
    let cv = |point: usize| {
        let of = results[point].patches.get(middle)?;
        if flown { of.flown.map(|of| of.0) } else { Some(of.cv) }
    };
    let known: Vec<usize> = (0..results.len()).filter(|point| cv(*point).is_some()).collect();
    let order = |a: &&usize, b: &&usize| cv(**a).unwrap_or(0.0).total_cmp(&cv(**b).unwrap_or(0.0));
    let laid = format!("{} points, {webs} webs in all.", results.len());
    let ends = known.iter().min_by(order).zip(known.iter().max_by(order));
    let told = ends.filter(|(best, worst)| best != worst).and_then(|(best, worst)| {
        let values = |point: usize| {
            let values = study.factors.iter().zip(&study.points[point].values);
            let values =
                values.map(|(of, value)| format!("{} {}", name_of_key(of.key), of.input().pretty(*value)));
            values.collect::<Vec<_>>().join(", ")
        };
        let shown = |point: usize| {
            let of = results[point].patches.get(middle)?;
            let (cv, error) = match of.flown.filter(|_| flown) {
                Some((cv, error)) => (cv, Some(error)),
                None => (of.cv, of.error()),
            };
            Some(plus_minus(100.0 * cv, error.map(|error| 100.0 * error)))
        };
        let patch = results[*best].patches.get(middle)?.patch;
        Some(format!(
            " {} patches of {} mm the web is most even at {} (CV {} %) and least even at {} (CV {} %).",
            if flown { "By the flown curves, over" } else { "Over" },
            significant(patch * 1e3, 3),
            values(*best),
            shown(*best)?,
            values(*worst),
            shown(*worst)?
        ))
    });
    laid + &told.unwrap_or_default()
}

/// Heads and rows of the table of points.
fn table(study: &WebStudy, results: &[PointOfWebs]) -> (Vec<String>, Vec<Row>) {
    let first = results.first();
    let mut heads: Vec<String> = study.factors.iter().map(|factor| name_of_key(factor.key)).collect();
    let patches = || first.into_iter().flat_map(|of| &of.patches);
    heads.extend(patches().map(|of| format!("CV {} mm (%)", significant(of.patch * 1e3, 3))));
    let any_flown = results.iter().flat_map(|of| &of.patches).any(|patch| patch.flown.is_some());
    if any_flown {
        heads.extend(patches().map(|of| format!("flown CV {} mm (%)", significant(of.patch * 1e3, 3))));
    }
    heads.extend(["basis weight (g/m²)", "MD/CD", "webs"].map(str::to_owned));
    let row = |(point, of): (usize, &PointOfWebs)| {
        let values = study.factors.iter().zip(&study.points[point].values);
        let mut cells: Vec<String> = values.map(|(factor, value)| factor.input().pretty(*value)).collect();
        let cv = of
            .patches
            .iter()
            .map(|patch| plus_minus(100.0 * patch.cv, patch.error().map(|error| 100.0 * error)));
        cells.extend(cv);
        if any_flown {
            let flown = of.patches.iter().map(|patch| match patch.flown {
                Some((cv, error)) => plus_minus(100.0 * cv, Some(100.0 * error)),
                None => "–".to_owned(),
            });
            cells.extend(flown);
        }
        let mean = |name: &str| of.numbers.get(name).map_or(f64::NAN, |number| number.mean);
        cells.push(significant(1e3 * mean("basis_weight_kg_m2"), 4));
        cells.push(number(mean("md_cd_ratio")));
        cells.push(of.webs.to_string());
        Row { number: point + 1, cells }
    };
    (heads, results.iter().enumerate().take(LISTED).map(row).collect())
}
