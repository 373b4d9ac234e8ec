//! The first screen of a web: what is asked of a line, answered in rows, in the words of its plant.

use super::scale;
use super::scale::{Judged, Scale};
use crate::Failure;
use crate::numbers::{THIN, significant};
use crate::page::document::{Part, Section, View};
use crate::page::table::{Layout, Row, Table};
use crate::page::words::{grams, grams_with_error};
use crate::reports::web::files::effects::HOUR;
use crate::reports::web::files::fabric::fabric_rows;
use crate::reports::web::files::summary::LayerSummary;
use spunlaid_experiment::plausible::implausible;
use spunlaid_fibre::FedFilament;
use spunlaid_ground::Dimension;
use spunlaid_simulation::{LayerSpec, WebSpec};
use spunlaid_web::map::Findings;
use spunlaid_web::{Fabric, Map};

/// What is asked, the answers, and what is to be said of them.
#[derive(Debug)]
pub(crate) struct Card {
    pub(crate) id: &'static str,
    pub(crate) title: &'static str,
    pub(crate) rows: Vec<Row>,
    /// Rows under a heading of their own; without rows, there is no heading.
    pub(crate) apart: (&'static str, Vec<Row>),
    pub(crate) words: Vec<String>,
    /// Below the rows the page shows this in place of the words, and the words after a click; None shows them.
    pub(crate) summary: Option<&'static str>,
}

impl From<Card> for Section<'static> {
    fn from(Card { id, title, rows, apart: (heading, apart), words, summary }: Card) -> Self {
        let summary = summary.filter(|_| !rows.is_empty() || !apart.is_empty());
        let table = Table::new(["", ""]).laid_out(Layout::Facts).rows(rows);
        let table = if apart.is_empty() { table } else { table.group(heading.to_owned(), apart) };
        let section = Section::new(id, title).table(table);
        let section = match summary {
            Some(summary) => {
                section.with(Part::Folded(summary, words.into_iter().map(Part::Paragraph).collect()))
            }
            None => section.paragraphs(words),
        };
        section.printed().card()
    }
}

/// Most kinds of layers whose filaments have rows of their own.
const MOST_LAYERS: usize = 3;

/// The line itself, and whether it is one.
pub(crate) fn line(spec: &WebSpec, findings: &Findings, layers: &[LayerSummary]) -> Card {
    let row = |name: &str, value: String| Row::new(name, [value]);
    let made = spec.weight();
    let faster = format!("a belt {FASTER}{THIN}% faster makes {}", grams(made / (1.0 + 0.01 * FASTER)));
    let piece = format!("this piece {}; {faster}", grams_with_error(findings.basis_weight()));
    let mut rows = vec![
        row("Per metre of width", shown(HOUR * spec.mass_flow(), "kg/h")),
        row("Belt", speed(spec.belt_speed)),
        row("Basis weight", grams(made)).detail(piece),
    ];
    let numbers =
        |(layer, of): (&LayerSummary, &LayerSpec)| numbers(layer, &of.fed_filament(), spec.sheet.width);
    let all: Vec<_> = layers.iter().zip(&spec.layers).map(numbers).collect();
    // Equal layers are shown once.
    let kinds = (0..all.len()).filter(|i| !all[..*i].contains(&all[*i]));
    let is_one_kind = kinds.clone().count() == 1;
    if is_one_kind && all.len() > 1 {
        rows.push(row("Beams", format!("{}, identical", all.len())));
    }
    for kind in kinds.take(MOST_LAYERS).map(|i| &all[i]) {
        let alike = layers.iter().zip(&all).filter(|(_, other)| *other == kind);
        let names: Vec<&str> = alike.map(|(layer, _)| layer.name.as_str()).collect();
        let of = if is_one_kind { String::new() } else { format!(" of layer {}", names.join(", ")) };
        rows.extend(kind.iter().map(|(name, value)| row(&format!("{name}{of}"), value.clone())));
    }
    let unusual = implausible(spec);
    rows.push(row(
        "Within usual ranges",
        if unusual.is_empty() { "yes" } else { "no, see below" }.to_owned(),
    ));
    let words = unusual.iter().map(|number| format!("{number}.")).collect();
    Card { id: "line", title: "The line", rows, apart: Default::default(), words, summary: None }
}

fn shown(value: f64, unit: &str) -> String {
    format!("{}{THIN}{unit}", significant(value, 3))
}

fn speed(speed: f64) -> String {
    format!("{}{THIN}m/min ({})", significant(60.0 * speed, 4), shown(speed, "m/s"))
}

/// The numbers of a layer, with their names.
///
/// * `of` – its filament
/// * `width` – of the sheet [m]
fn numbers(layer: &LayerSummary, of: &FedFilament, width: f64) -> Vec<(&'static str, String)> {
    let holes = significant(layer.filaments as f64 / width, 4);
    let slot =
        layer.air_at_slot_m_s.map_or_else(String::new, |air| format!(", {} at the slot", shown(air, "m/s")));
    let cabin = layer.cabin_pressure_pa.map(|cabin| {
        let cabin = Dimension::Pressure.pretty_to(cabin, 4).replace(' ', &THIN.to_string());
        ("Cabin pressure", cabin + &slot)
    });
    let filament =
        format!("{}, {}", shown(of.linear_density() * 1e7, "dtex"), shown(of.diameter() * 1e6, "µm"));
    let each = format!("{holes}, each {}", shown(of.throughput() * 6e4, "g/min"));
    let rows =
        [("Filament", filament), ("Spinning speed", speed(of.feed_speed())), ("Holes per metre", each)];
    rows.into_iter().chain(cabin).collect()
}

/// By how much faster a belt is reported of [%].
const FASTER: f64 = 10.0;

/// What a buyer counts.
pub(crate) fn fabric(fabric: &Fabric) -> Card {
    let rows = fabric_rows(fabric).into_iter().map(|[name, value]| Row::new(name, [value])).collect();
    let (apart, words) = (Default::default(), fabric.notes.clone());
    Card { id: "buyer", title: "Defects per area", rows, apart, words, summary: None }
}

/// The scale as a card; without pictures if the web is too small for them.
///
/// # Errors
/// If a picture cannot be drawn.
pub(crate) fn scale_card(map: &Map, judged: Judged) -> Result<Section<'static>, Failure> {
    let section = Section::new("scale", "How uniform is that?");
    let section = match Scale::new(map, judged)? {
        Some(scale) => section.view(View::new(&scale, &[])),
        None => section,
    };
    Ok(section.paragraph(scale::words(judged)).printed().picture())
}
