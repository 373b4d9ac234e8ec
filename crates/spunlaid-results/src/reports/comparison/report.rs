//! The report of a comparison: a table for each pair of results, their curves in one picture each, and webs
//! beside each other.

use super::files::{Cause, ComparedMeasure, Comparison};
use super::maps::{Beside, ComparedPictures, caption};
use crate::page::document::{Report, Section, View};
use crate::page::methods::methods;
use crate::page::table::{Cell, Row, Table, Tone};
use spunlaid_charts::Figure;
use spunlaid_ground::Difference;

/// Results beside each other.
///
/// * `pictures` – of webs
pub fn comparison_report<'a>(
    comparisons: &[Comparison],
    figures: &'a [Figure],
    pictures: Option<&'a ComparedPictures>,
) -> Report<'a> {
    let title = title(comparisons);
    let beside = pictures.map(|webs| {
        let view = View::new(&Beside::new(webs), &[]);
        Section::new("pictures", "Pictures at the same scale").view(view).caption(caption(&webs.pictures))
    });
    Report::new("compare", title)
        .with_all(beside)
        .with_all(pairs(comparisons).map(Section::printed))
        .with(Section::of_figures(figures))
        .with(methods("compare", Vec::new(), ""))
}

fn pairs<'a>(comparisons: &[Comparison]) -> impl Iterator<Item = Section<'a>> {
    (1..).zip(comparisons).map(|(number, comparison)| pair(number, comparison))
}

/// A result against another one, measure by measure.
fn pair<'a>(number: usize, comparison: &Comparison) -> Section<'a> {
    let Comparison { run, against, reason, errors, measures, .. } = comparison;
    let (beyond, all) = comparison.significant();
    let table = Table::new(["Measure", against, run, "Difference"]).sentences(["Verdict"]);
    let section = Section::new(format!("pair-{number}"), format!("{run} against {against}"))
        .paragraph(format!(
            "Compared {reason}. {beyond} of {all} measures differ significantly at 95\u{202f}% (the confidence \
            interval of the difference excludes zero); of twenty equal measures, one is expected to."
        ))
        .table(table.rows(measures.iter().map(row)))
        .caption(format!("{errors} The difference has its standard error, towards the other value."));
    if comparison.causes.is_empty() {
        return section;
    }
    let row = |cause: &Cause| Row::new(&cause.what, [Cell::from(cause.words.clone())]);
    section
        .heading("Where the streaks may come from")
        .table(
            Table::new(["Streak"])
                .sentences(["Possible cause in the line"])
                .rows(comparison.causes.iter().map(row)),
        )
        .caption(CAUSES)
}

/// What is said below causes.
const CAUSES: &str = "A streak that lacks as much mass as one hole feeds, and is as wide as one filament is laid, is a \
    blocked hole. Widths are at half of the amplitude. To see one in a web, lay the line with it: line.defects.";

fn row(compared: &ComparedMeasure) -> Row {
    let is_sure = compared.difference.is_some_and(|difference| difference.is_significant());
    let tone = if is_sure { Tone::Plain } else { Tone::Faint };
    let [first, other, difference, verdict] = compared.cells();
    let unit =
        if compared.unit.shown.is_empty() { String::new() } else { format!(" ({})", compared.unit.shown) };
    let cells = [Cell::from(first), Cell::from(other), Cell::new(difference, tone), Cell::new(verdict, tone)];
    Row::new(format!("{}{unit}", compared.label), cells)
}

/// Why the first number that both have is not compared.
fn first_doubt(comparison: &Comparison) -> Option<&str> {
    let both = |measure: &&ComparedMeasure| measure.means.iter().all(|mean| mean.mean.is_finite());
    comparison.measures.iter().filter(both).find_map(|measure| measure.doubt.as_deref())
}

/// What is compared, how much of it differs, and what most clearly.
fn title(comparisons: &[Comparison]) -> String {
    let first = comparisons.first().map_or("", |comparison| comparison.against.as_str());
    let differing = |comparison: &Comparison| match comparison.significant() {
        (_, 0) => match first_doubt(comparison) {
            Some(doubt) => format!("what differs is not known: {doubt}"),
            None => "too few data to say what differs".to_owned(),
        },
        (0, all) => format!("none of {all} measures differs significantly at 95\u{202f}%"),
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

/// The measure whose difference is the most of its interval.
fn clearest(comparison: &Comparison) -> Option<String> {
    let beyond = comparison.measures.iter().filter_map(|measure| Some((measure, measure.difference?)));
    let beyond = beyond.filter(|(_, difference)| difference.is_significant());
    let clear = |difference: &Difference| difference.value.abs() / difference.half_width();
    let (measure, _) = beyond.max_by(|a, b| clear(&a.1).total_cmp(&clear(&b.1)))?;
    let [.., difference, _] = measure.cells();
    Some(
        format!(", most clearly “{}”: {difference} {}", measure.label, measure.unit.shown)
            .trim_end()
            .to_owned(),
    )
}
