//! `report.html` of a comparison: a table for each pair of runs, their curves in one picture each, and webs beside each other.

use super::methods::Methods;
use super::rendered;
use super::words::{metres, millimetres};
use crate::numbers::{THIN, significant};
use crate::output::comparison::{ComparedMeasure, Comparison};
use crate::output::web::Pictures;
use askama::Template;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use spunlaid::statistics::Difference;
use spunlaid_charts::Figure;

/// Content of the report.
#[derive(Clone, Copy, Debug)]
pub struct ComparisonReport<'a> {
    /// The comparisons.
    pub comparisons: &'a [Comparison],
    /// The figures.
    pub figures: &'a [Figure],
    /// Pictures of webs.
    pub pictures: Option<&'a ComparedPictures>,
    /// What is missing, and why.
    pub notes: &'a [String],
}

/// Pictures of webs with their names.
#[derive(Clone, Debug)]
pub struct ComparedPictures {
    /// Names of the webs.
    pub names: Vec<String>,
    /// Their pictures, in the same order.
    pub pictures: Pictures,
}

/// Content of `assets/comparison.html`, which escapes everything that is not marked safe.
#[derive(Template)]
#[template(path = "comparison.html")]
struct ComparisonPage<'a> {
    title: String,
    tables: Vec<PairTable<'a>>,
    notes: &'a [String],
    beside: Option<PicturePair<'a>>,
    figures: &'a [Figure],
    methods_paragraph: Methods,
}

struct PairTable<'a> {
    comparison: &'a Comparison,
    rows: Vec<MeasureRow<'a>>,
    beyond: usize,
    all: usize,
}

struct MeasureRow<'a> {
    name: &'a str,
    unit: &'static str,
    cells: [String; 4],
    /// Whether the difference is within chance.
    faint: bool,
}

/// Pictures beside each other.
struct PicturePair<'a> {
    /// Names and pictures, as base64.
    webs: Vec<(&'a str, String)>,
    /// Width over height of each.
    aspect: f64,
    /// Length of the bar below a picture, and its share of the width in per cent.
    bar: (String, f64),
    /// Below white and below black.
    ends: [String; 2],
    caption: String,
}

impl<'a> PicturePair<'a> {
    fn new(webs: &'a ComparedPictures) -> Self {
        let Pictures { sides: [width, length], pixel, contrast, files } = &webs.pictures;
        let names = webs.names.iter().map(String::as_str);
        let contrast = |sign: char| format!("{sign}{}{THIN}%", significant(100.0 * contrast, 2));
        let bar = round_length(0.4 * width);
        Self {
            webs: names.zip(files.iter().map(|file| STANDARD.encode(file))).collect(),
            aspect: width / length,
            bar: (metres(bar), 100.0 * bar / width),
            ends: ['−', '+'].map(contrast),
            caption: format!(
                "The middle of each web, {} across and {} along it, at the same scale and in the same shades: the same shade is the same \
                 basis weight relative to the mean of the piece, lighter where there is less fibre. Black and white are three standard \
                 deviations of the most uneven piece apart from the mean. The machine direction runs downwards. A pixel is {} wide in all \
                 pictures; finer maps are averaged to it.",
                metres(*width),
                metres(*length),
                millimetres(*pixel)
            ),
        }
    }
}

/// The longest of 1, 2 and 5 times a power of ten that is no longer than a length.
fn round_length(most: f64) -> f64 {
    let power = 10f64.powf(most.log10().floor());
    [5.0, 2.0].into_iter().map(|step| step * power).find(|length| *length <= most).unwrap_or(power)
}

fn row(compared: &ComparedMeasure) -> MeasureRow<'_> {
    MeasureRow {
        name: &compared.label,
        unit: compared.unit,
        cells: compared.cells(),
        faint: !compared.difference.is_some_and(|difference| difference.is_beyond_chance()),
    }
}

/// What is compared, how much of it differs, and what most clearly.
fn title(comparisons: &[Comparison]) -> String {
    let first = comparisons.first().map_or("", |comparison| comparison.against.as_str());
    let differing = |comparison: &Comparison| match comparison.beyond_chance() {
        (_, 0) => "too few data to tell what differs".to_owned(),
        (0, all) => format!("none of {all} measures differs beyond chance"),
        (beyond, all) => {
            format!("{beyond} of {all} measures differ{}", clearest(comparison).unwrap_or_default())
        }
    };
    match comparisons {
        [one] => format!("{} against {first}: {}", one.run, differing(one)),
        all => {
            let each: Vec<String> =
                all.iter().map(|one| format!("{}, {}", one.run, differing(one))).collect();
            format!("Against {first}: {}", each.join("; "))
        }
    }
}

/// How two results were compared, in sentences.
fn method(comparison: &Comparison) -> String {
    let Comparison { run, against, reason, errors, .. } = comparison;
    format!(
        "The results {run} and {against} were compared {reason}. {errors} A difference is beyond chance if its 95\u{a0}% interval leaves out zero."
    )
}

/// Each difference beyond chance, in a sentence.
fn differences(comparison: &Comparison) -> impl Iterator<Item = String> {
    let is_beyond = |measure: &&ComparedMeasure| {
        measure.difference.is_some_and(|difference| difference.is_beyond_chance())
    };
    comparison.measures.iter().filter(is_beyond).map(move |measure| {
        let [first, other, difference, _] = measure.cells();
        let Comparison { run, against, .. } = comparison;
        let unit = if measure.unit.is_empty() { String::new() } else { format!(" ({})", measure.unit) };
        format!("{}{unit}: {first} in {against}, {other} in {run}, difference {difference}.", measure.label)
    })
}

/// The measure whose difference is the most of its interval.
fn clearest(comparison: &Comparison) -> Option<String> {
    let beyond = comparison.measures.iter().filter_map(|measure| Some((measure, measure.difference?)));
    let beyond = beyond.filter(|(_, difference)| difference.is_beyond_chance());
    let clear = |difference: &Difference| difference.value.abs() / difference.half_width();
    let (measure, _) = beyond.max_by(|a, b| clear(&a.1).total_cmp(&clear(&b.1)))?;
    let [.., difference, _] = measure.cells();
    Some(format!(", most clearly “{}”: {difference} {}", measure.label, measure.unit).trim_end().to_owned())
}

/// The report as one HTML file.
pub fn comparison_html(input: &ComparisonReport<'_>) -> String {
    let tables = input.comparisons.iter().map(|comparison| {
        let (beyond, all) = comparison.beyond_chance();
        PairTable { comparison, rows: comparison.measures.iter().map(row).collect(), beyond, all }
    });
    let title = title(input.comparisons);
    let found = [format!("{title}.")].into_iter().chain(input.comparisons.iter().flat_map(differences));
    let sentences = input.comparisons.iter().map(method).collect();
    let page = ComparisonPage {
        methods_paragraph: Methods::new("compare", (sentences, Vec::new()), found),
        title,
        tables: tables.collect(),
        notes: input.notes,
        beside: input.pictures.map(PicturePair::new),
        figures: input.figures,
    };
    rendered(&page)
}
