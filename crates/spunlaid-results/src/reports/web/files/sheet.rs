//! The specification sheet of a web: one page that has every number with its error.

use super::fabric::fabric_rows;
use crate::Failure;
use crate::failure::undrawable;
use crate::files::pictures::SOFTWARE;
use crate::numbers::{HARD, THIN, capitalised, number, plus_minus};
use spunlaid_charts::label::lines;
use spunlaid_charts::palette::{GREY, GRID, INK};
use spunlaid_charts::picture::{Anchor, Stroke, Text};
use spunlaid_charts::{Picture, pdf};
use spunlaid_web::Fabric;
use spunlaid_web::map::Findings;

/// A page of A4, its margin, and where the values begin [px].
const PAGE: [f64; 2] = [793.7, 1122.5];
const MARGIN: f64 = 62.0;
const VALUES: f64 = 430.0;
/// Sizes of texts, and the largest distance of two rows [px].
const HEAD: f64 = 20.0;
const SIZE: f64 = 12.0;
const SMALL: f64 = 9.5;
const ROW: f64 = 19.0;
/// Room that is kept for the notes, and the distance of their lines [px].
const NOTES: f64 = 250.0;
const LINE: f64 = 13.0;

/// What the numbers are, below them.
const MEANING: &str = "Simulated, not measured. A number has its standard error, or is a bound or a \
    range. One without an error is counted, given, or exactly that of the simulated sheet. Bonds, finish and \
    the thickness that a calender makes are not in any of them. What each number is: docs/fabric.md.";

/// The page, as PDF.
///
/// * `name` – of the web
/// * `notes` – for the reader
///
/// # Errors
/// If the page cannot be drawn.
pub fn specification_sheet(
    name: &str,
    findings: &Findings,
    fabric: &Fabric,
    notes: &[String],
) -> Result<Vec<u8>, Failure> {
    let title = format!("Specification of the web {name}");
    let page = page(&title, &rows(findings, fabric), &[&fabric.notes[..], notes].concat());
    pdf(&page, &title, SOFTWARE).map_err(|error| undrawable("sheet", &error.to_string()))
}

/// Names and values, in their order.
fn rows(findings: &Findings, fabric: &Fabric) -> Vec<[String; 2]> {
    let within = findings.within();
    let size = |cells: usize| format!("{}{THIN}m", number(cells as f64 * within.cell));
    let sheet = format!("{}{HARD}×{HARD}{}", size(within.columns), size(within.rows));
    let (weight, error) = findings.basis_weight();
    let mut rows = vec![
        ["Sheet, across and along".to_owned(), sheet],
        [
            "Basis weight, of the sheet".to_owned(),
            format!("{}{THIN}g/m²", plus_minus(1e3 * weight, error.map(|error| 1e3 * error))),
        ],
    ];
    for patch in &findings.patches {
        let cv = patch.with_total_error().map(|reported| {
            let error = reported.standard_error.map(|error| 100.0 * error);
            format!("{}{THIN}%", plus_minus(100.0 * reported.cv, error))
        });
        let cv = cv.unwrap_or_else(|| "not known: too few filaments simulated".to_owned());
        let side = number(1e3 * patch.map.patch);
        rows.push([format!("CV of the basis weight over patches of {side}{THIN}mm"), cv]);
    }
    let along = &findings.orientation.cos_squared;
    rows.push([
        "Orientation along MD, mean cos², 0.5 without".to_owned(),
        plus_minus(along.mean, along.standard_error),
    ]);
    rows.extend(fabric_rows(fabric));
    rows
}

/// A note as a sentence.
fn sentence(note: &str) -> String {
    let begun = capitalised(note);
    if begun.ends_with('.') { begun } else { begun + "." }
}

fn page(title: &str, rows: &[[String; 2]], notes: &[String]) -> Picture {
    let [width, height] = PAGE;
    let mut page = Picture::new(width, height, title);
    let text = |size, colour| Text { size, colour, anchor: Anchor::Start, upright: true };
    // Names of files may hold what labels take for mark-up, and the font has no narrow space.
    let plain = |text: &str| text.replace('*', " ").replace(THIN, &HARD.to_string());
    let mut at = MARGIN;
    for line in lines(&plain(title), HEAD, width - 2.0 * MARGIN) {
        page.text((MARGIN, at), &line, text(HEAD, INK));
        at += 1.3 * HEAD;
    }
    let room = height - NOTES - at - MARGIN;
    let step = (room / rows.len().max(1) as f64).min(ROW);
    let size = SIZE.min(0.75 * step);
    for [name, value] in rows {
        page.text((MARGIN, at + 0.7 * step), &plain(name), text(size, INK));
        page.text((VALUES, at + 0.7 * step), &plain(value), text(size, INK));
        at += step;
        page.line((MARGIN, at), (width - MARGIN, at), &Stroke::solid(GRID, 0.7));
    }
    at += 1.5 * LINE;
    for note in std::iter::once(MEANING).chain(notes.iter().map(String::as_str)) {
        for line in lines(&sentence(&plain(note)), SMALL, width - 2.0 * MARGIN) {
            // What does not fit on the page is in the report.
            if at > height - MARGIN {
                return page;
            }
            page.text((MARGIN, at), &line, text(SMALL, GREY));
            at += LINE;
        }
        at += 0.4 * LINE;
    }
    page
}
