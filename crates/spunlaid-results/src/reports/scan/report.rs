//! The report of a scanned web: the web on a light table, how uneven it is, and the figures.

use crate::Failure;
use crate::files::measured::text as shown_number;
use crate::files::origin::Performance;
use crate::numbers::{THIN, plus_minus, significant};
use crate::page::document::{Part, Report, Section};
use crate::page::methods::methods;
use crate::page::table::{Row, Table};
use crate::page::words::{cost, grams, metres, millimetres};
use crate::reports::web::figures::clouds::SEEN;
use crate::reports::web::files::picture::Pictures;
use crate::reports::web::report::below;
use crate::reports::web::report::cards;
use crate::reports::web::report::cards::scale_card;
use crate::reports::web::report::fabric::{compare, fabric_section, shown as of_fabric};
use crate::reports::web::report::light_table::{MarkedPlaces, marks_note, picture_note, sheet};
use crate::reports::web::report::patch_cv::{CV_OF_PATCHES, headline, largest_clouds, per_cent};
use crate::reports::web::report::scale::Judged;
use spunlaid_charts::Figure;
use spunlaid_ground::{Measure, Measured, measure};
use spunlaid_web::map::nearest_to_seen;
use spunlaid_web::map::uniformity::PatchCv;
use spunlaid_web::scan::{Findings, PatchFindings, ScanWarning, StreakLimit};
use spunlaid_web::{
    Fabric, Map, SCAN_MEASURES, SCAN_PERIOD_MEASURES, SCAN_STREAK_MEASURES, SCANNED_PATCH_MEASURES,
    STREAK_LIMIT_MEASURES,
};
use std::borrow::Cow;

/// A scanned web.
///
/// * `file` – its path
/// * `findings` – of it
/// * `fabric` – what is reported of its fabric
///
/// # Errors
/// The picture cannot be drawn.
pub fn scan_report<'a>(
    file: &str,
    findings: &Findings,
    fabric: &Fabric,
    figures: &'a [Figure],
    performance: Performance,
) -> Result<Report<'a>, Failure> {
    let seen = nearest_to_seen(findings.patches.iter().map(|patch| patch.patch_cv.patch));
    let judged = seen.map(|i| judged(findings, &findings.patches[i]));
    let map = with_spots(findings);
    let pictures = Pictures::new(&map, None, below(judged));
    let sheet = sheet(&map, &pictures, None, Some(MarkedPlaces::new(fabric)))?;
    let headline = title(findings);
    let summary = format!(
        "A scan of {} across and {} along the web{}.",
        metres(findings.map.columns as f64 * findings.map.cell),
        metres(findings.map.rows as f64 * findings.map.cell),
        if findings.mean_known {
            format!(", of {}", grams(findings.map.basis_weight()))
        } else {
            String::new()
        }
    );
    let facts = facts(file, findings);
    let spots = if findings.aside.spots.is_empty() { "" } else { " Black spots were left out." };
    let caption = picture_note(&sheet) + spots + &marks_note(fabric);
    let read = Section::new("file", "The scan").table(Table::of_facts(facts)).caption(
        "The map is in map.npy (kg/m², or parts of the mean where that is not known; one row of the web after \
        the other), all numbers in summary.json, next to this page.",
    );
    let web = Section::new("web", "The web on a light table")
        .view(sheet.view())
        .with(Part::reading(caption))
        .picture();
    let scale = judged.map(|judged| scale_card(&findings.map, judged)).transpose()?;
    Ok(Report::new("analyse", headline)
        .lead(summary)
        .with(web)
        .with_all(scale)
        .with(uneven(findings).printed())
        .with(streaks(findings).printed())
        .with(fabric_section(fabric))
        .with(cards::fabric(fabric).into())
        .with(Section::of_figures(figures))
        .with(methods("analyse", Vec::new(), ""))
        .with(read)
        .costing(cost(performance)))
}

/// What is known of the CV over patches; where it is assumed, nothing.
fn judged(findings: &Findings, PatchFindings { patch_cv, interval, .. }: &PatchFindings) -> Judged {
    let reported = findings.assumption.is_none().then_some((patch_cv.cv, patch_cv.standard_error));
    let patch = patch_cv.patch;
    let of_map = patch_cv.cv;
    let chance = None;
    Judged { patch, of_map, reported, interval: interval.ok().filter(|_| reported.is_some()), chance }
}

fn title(findings: &Findings) -> String {
    let nearest_patch = nearest_to_seen(findings.patches.iter().map(|patch| patch.patch_cv.patch));
    let patch = nearest_patch.map(|i| &findings.patches[i].patch_cv);
    let (Some(assumption), Some(patch)) = (findings.assumption, patch) else {
        return headline(patch, false, None);
    };
    let varies = |by: &str| {
        format!("CV {by} {} over {} patches: {assumption}.", rough(patch), millimetres(patch.patch))
    };
    match assumption {
        // The lamp is no lighter than the largest level, so the density is no larger than what was found.
        ScanWarning::White => varies("at least"),
        ScanWarning::Shading => varies("about"),
        _ => format!("CV not known: {assumption}."),
    }
}

/// A CV whose error is not known, to two digits.
fn rough(patch: &PatchCv) -> String {
    format!("{}{THIN}%", significant(100.0 * patch.cv, 2))
}

/// A CV with its error; to two digits where that is not known.
fn cv(patch: &PatchCv) -> String {
    match patch.standard_error {
        Some(_) => per_cent(patch.cv, patch.standard_error),
        None => rough(patch),
    }
}

/// How uneven it is.
fn uneven(findings: &Findings) -> Section<'static> {
    let heads = ["Patch", "CV", "95 % interval"].into_iter();
    let heads = heads.chain(reported_measures(findings).map(|measure| measure.label));
    let is_map = is_map(findings);
    Section::new("verdict", "What makes it non-uniform")
        .paragraphs(verdict(findings))
        .table(Table::new(heads).rows(findings.patches.iter().map(|patch| row(findings, patch))))
        .caption(format!(
            "{CV_OF_PATCHES} The interval is that of the web, of which the scan is one piece. The noise is as it \
            was given, and then taken out of the CV, or the most that it can be.{}",
            if is_map {
                ""
            } else {
                " Where one more pixel of blur changes little, the blur of the camera has also changed little."
            }
        ))
}

/// What is said below streaks.
const ABOUT_STREAKS: &str = "Fits of normal profiles to the mean along the machine, less a polynomial of fourth \
    degree over the whole width, so no shading counts and no streak is wider than a sixth of it. One scan \
    of twenty without streaks has one or a period. What the lamp or the scanner makes stays at its position when the \
    web is moved: move it, and scan again.";

/// The streaks along the machine.
fn streaks(findings: &Findings) -> Section<'static> {
    let section = Section::new("streaks", "Streaks along the machine");
    let Some(search) = &findings.streaks else {
        return section.paragraph(
            "No streaks were searched for: the scan is too small, or it holds too few clouds along the machine, \
             from which streaks could be distinguished. Scan a longer piece.",
        );
    };
    let least = |limit: &StreakLimit| {
        let [width, amplitude] = STREAK_LIMIT_MEASURES else { return String::new() };
        format!("{} if they are {} wide", of_fabric(amplitude, limit), of_fabric(width, limit))
    };
    let ends = [search.limits.first(), search.limits.last()].into_iter().flatten().map(least);
    let count = |number: usize, what: &str| match number {
        0 => format!("no {what} is"),
        1 => format!("one {what} is"),
        number => format!("{number} {what}s are"),
    };
    let section = section.paragraph(format!(
        "At 95{THIN}%, {} significant, and {} significant. This scan shows streaks from {} on.",
        count(search.streaks.len(), "streak"),
        count(search.periods.len(), "period across the web"),
        ends.collect::<Vec<_>>().join(", ")
    ));
    let [place, measures @ ..] = SCAN_STREAK_MEASURES else { return section };
    let rows: Vec<_> = search.streaks.iter().map(|streak| (of_fabric(place, streak), streak)).collect();
    let section = compare(section, "Streaks", place.label, measures, &rows);
    let [period, measures @ ..] = SCAN_PERIOD_MEASURES else { return section };
    let rows: Vec<_> = search.periods.iter().map(|wave| (of_fabric(period, wave), wave)).collect();
    compare(section, "Periods", period.label, measures, &rows).caption(ABOUT_STREAKS)
}

/// Whether basis weights were read, which no camera has blurred.
fn is_map(findings: &Findings) -> bool {
    findings.patches.iter().all(|patch| patch.blur.is_none())
}

/// The measures that stand behind the interval.
fn reported_measures(findings: &Findings) -> impl Iterator<Item = &'static Measure<PatchFindings>> + use<'_> {
    let is_known = |measure: &&'static Measure<PatchFindings>| {
        findings.patches.iter().any(|patch| measure.of(patch).value.is_some())
    };
    SCANNED_PATCH_MEASURES.iter().skip(1).filter(is_known)
}

fn row(findings: &Findings, patch: &PatchFindings) -> Row {
    let mut cells = vec![
        cv(&patch.patch_cv),
        patch.interval.map_or_else(
            |doubt| format!("none: {doubt}"),
            |[low, high]| {
                format!("{} to {}{THIN}%", significant(100.0 * low, 3), significant(100.0 * high, 3))
            },
        ),
    ];
    // The CV stands before the interval.
    cells.extend(reported_measures(findings).map(|measure| shown(&measure.of(patch)).unwrap_or_default()));
    Row::new(millimetres(patch.patch_cv.patch), cells)
}

/// The value of a measure with its unit; none if there is no value.
fn shown<T>(row: &Measured<T>) -> Option<String> {
    let (number, unit) = (shown_number(row)?, row.measure.unit.shown);
    Some(if unit.is_empty() { number } else { format!("{number}{THIN}{unit}") })
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
        per_cent(index, error.filter(|_| findings.assumption.is_none()))
    ));
    let of_texture = format!(
        "Texture along the machine direction: {}; ½ is no direction, 1 is all fine streaks along the machine \
        direction, 0 all across.",
        plus_minus(texture.mean, texture.standard_error)
    );
    sentences.extend(texture.mean.is_finite().then_some(of_texture));
    sentences
}

/// How the scan was read: a name and a value each.
fn facts(file: &str, findings: &Findings) -> Vec<(&'static str, String)> {
    let mut facts = vec![
        ("File", file.to_owned()),
        (
            "Pixels",
            format!("{} × {} of {}", findings.map.columns, findings.map.rows, millimetres(findings.map.cell)),
        ),
    ];
    if findings.aside.corner != [0, 0] {
        let [right, down] =
            findings.aside.corner.map(|pixels| millimetres(pixels as f64 * findings.map.cell));
        let place = format!(
            "{right} from the left and {down} from the top of the picture; all places are of the web"
        );
        facts.push(("The web begins", place));
    }
    // What is zero has not been found.
    let is_found =
        |row: &Measured<Findings>| !row.measure.label.is_empty() && row.measure.number(findings) != 0.0;
    let labelled = measure::measured(SCAN_MEASURES, findings).filter(is_found);
    facts.extend(labelled.filter_map(|row| Some((row.measure.label, shown(&row)?))));
    if let Some(largest) = findings.aside.spots.first() {
        let spots = format!(
            "{}, {}{THIN}mm² in all; the largest {}{THIN}mm², {} from the left and {} from the top of the web",
            findings.aside.spots.len(),
            significant(findings.aside.masked * 1e6, 3),
            significant(largest.area * 1e6, 3),
            millimetres(largest.place[0]),
            millimetres(largest.place[1])
        );
        facts.push(("Dark spots that were left out", spots));
    }
    facts
}
