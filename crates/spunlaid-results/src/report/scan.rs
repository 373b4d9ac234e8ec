//! `report.html` of a scanned web: the web on a light table, how uneven it is, and the figures.

use super::advice::AdviceSection;
use super::fabric::FabricSection;
use super::light_table::{picture_note, sheet};
use super::methods::Methods;
use super::rendered;
use super::web::{File, WebPage, cost, headline, largest_clouds, per_cent, unevenness};
use super::words::{metres, millimetres};
use crate::Failure;
use crate::figures::SEEN;
use crate::numbers::{THIN, plus_minus, significant};
use crate::output::web::Performance;
use spunlaid::observe::{OF_SCANNED_PATCHES, OF_SCANS, ScanMeasure, Unit};
use spunlaid::scan::{Findings, PatchFindings};
use spunlaid::web::{Map, nearest_to_seen};
use spunlaid_charts::Figure;
use std::borrow::Cow;

/// Content of the report.
#[derive(Clone, Copy, Debug)]
pub struct ScanReport<'a> {
    /// What the scan is called.
    pub name: &'a str,
    /// Path of its file.
    pub file: &'a str,
    /// What was found.
    pub findings: &'a Findings,
    /// The figures.
    pub figures: &'a [Figure],
    /// Notes for the reader.
    pub notes: &'a [String],
    /// What it cost.
    pub performance: Performance,
}

/// The report as one HTML file.
pub fn scan_html(input: &ScanReport<'_>) -> Result<String, Failure> {
    let findings = input.findings;
    let sheet = sheet(&with_spots(findings), None)?;
    let nearest_patch = nearest_to_seen(findings.patches.iter().map(|patch| patch.unevenness.patch));
    let weight = findings.mean_known.then(|| findings.map.basis_weight());
    let headline = headline(weight, nearest_patch.map(|i| &findings.patches[i].unevenness), false);
    let summary = format!(
        "A scan of {} across and {} along the web.",
        metres(findings.map.columns as f64 * findings.map.cell),
        metres(findings.map.rows as f64 * findings.map.cell)
    );
    let facts = reading_rows(input);
    let numbers = facts.iter().map(|fact| fact.join(" ")).collect::<Vec<_>>().join(", ");
    let cvs = findings.patches.iter().map(|patch| patch.unevenness).collect::<Vec<_>>();
    let texts = vec![summary.clone(), format!("{numbers}.")];
    let found = [headline.clone(), unevenness(&cvs)].into_iter().chain(verdict(findings));
    let page = WebPage {
        command: "analyse",
        name: input.name,
        methods_paragraph: Methods::new("analyse", (texts, Vec::new()), found),
        headline,
        summary,
        notes: input.notes,
        caption: picture_note(sheet.pixel)
            + if findings.aside.spots.is_empty() { "" } else { " Black spots were left out." },
        sheet,
        fibres: false,
        verdict: verdict(findings),
        heads: ["Patch", "CV", "95 % interval"]
            .into_iter()
            .chain(OF_SCANNED_PATCHES.iter().map(|measure| measure.label))
            .collect(),
        patches: findings.patches.iter().map(row).collect(),
        about_patches: "The interval is that of the web, of which the scan is one piece. The noise of the camera \
            is as it was given, and then taken out of the CV, or the most that it can be. Where one more pixel of \
            blur changes little, the camera’s own blur has changed little as well.",
        guesses: String::new(),
        advice: AdviceSection::default(),
        lever_heads: Vec::new(),
        levers: Vec::new(),
        fabric: FabricSection::default(),
        figures: input.figures,
        spinlines: Vec::new(),
        file: File {
            title: "The scan",
            heads: &[],
            rows: facts,
            toml: "",
            caption: "The map is in map.npy (kg/m², or parts of the mean where that is not known; a row of the web after the other), all \
                      numbers in summary.json, beside this page.",
        },
        cost: cost(input.performance),
    };
    Ok(rendered(&page))
}

fn row(patch: &PatchFindings) -> Vec<String> {
    let mut cells = vec![
        millimetres(patch.unevenness.patch),
        per_cent(patch.unevenness.cv, patch.unevenness.standard_error),
        patch.interval.map_or_else(
            |doubt| format!("none: {doubt}"),
            |[low, high]| {
                format!("{} to {}{THIN}%", significant(100.0 * low, 3), significant(100.0 * high, 3))
            },
        ),
    ];
    cells.extend(OF_SCANNED_PATCHES.iter().map(|measure| shown(measure, patch).unwrap_or_default()));
    cells
}

/// The value of a declared measure with its unit; none if there is no value.
fn shown<T>(measure: &ScanMeasure<T>, findings: &T) -> Option<String> {
    let Unit { shown, per_si } = measure.unit;
    let number = significant((measure.number)(findings)? * per_si, measure.digits);
    Some(if shown.is_empty() { number } else { format!("{number}{THIN}{shown}") })
}

/// The map with the spots that were left out, as dark as they were.
fn with_spots(findings: &Findings) -> Cow<'_, Map> {
    if findings.aside.mask.is_empty() {
        return Cow::Borrowed(&findings.map);
    }
    let darkest = findings.map.cells.iter().copied().max().unwrap_or(0);
    let cells = findings.map.cells.iter().zip(&findings.aside.mask);
    let cells = cells.map(|(cell, is_spot)| if *is_spot { darkest } else { *cell }).collect();
    Cow::Owned(Map { cells, ..findings.map.clone() })
}

fn verdict(findings: &Findings) -> Vec<String> {
    let Some(clouds) = &findings.clouds else { return Vec::new() };
    let (index, error) = clouds.cloudiness(SEEN[0], SEEN[1]);
    let texture = clouds.texture_md();
    let mut sentences: Vec<String> = largest_clouds(clouds).into_iter().collect();
    sentences.push(format!(
        "Cloudiness index, wavelengths from {} to {}: {}.",
        millimetres(SEEN[0]),
        millimetres(SEEN[1]),
        per_cent(index, error.filter(|_| findings.guess.is_none()))
    ));
    sentences.push(format!(
        "Texture along the machine direction: {}; ½ is no direction, 1 is all fine streaks along the machine direction, 0 all across.",
        plus_minus(texture.mean, texture.standard_error)
    ));
    sentences
}

/// How the scan was read: a name and a value each.
fn reading_rows(input: &ScanReport<'_>) -> Vec<Vec<String>> {
    let findings = input.findings;
    let mut facts = vec![
        ("File", input.file.to_owned()),
        (
            "Pixels",
            format!("{} × {} of {}", findings.map.columns, findings.map.rows, millimetres(findings.map.cell)),
        ),
    ];
    // What is zero has not been found.
    let is_found = |measure: &&ScanMeasure<Findings>| {
        !measure.label.is_empty() && (measure.number)(findings) != Some(0.0)
    };
    let labelled = OF_SCANS.iter().filter(is_found);
    facts.extend(labelled.filter_map(|measure| Some((measure.label, shown(measure, findings)?))));
    if let Some(largest) = findings.aside.spots.first() {
        let spots = format!(
            "{}, {}{THIN}mm² in all; the largest {}{THIN}mm², {} from the left and {} from the top of the picture",
            findings.aside.spots.len(),
            significant(findings.aside.masked * 1e6, 3),
            significant(largest.area * 1e6, 3),
            millimetres(largest.place[0]),
            millimetres(largest.place[1])
        );
        facts.push(("Dark spots that were left out", spots));
    }
    facts.into_iter().map(|(name, value)| vec![name.to_owned(), value]).collect()
}
