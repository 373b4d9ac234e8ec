//! The fabric in a report.

use crate::page::document::Section;
use crate::page::table::{Content, Layout, Row, Table};
use crate::page::words::millimetres;
use crate::reports::web::files::fabric::known_text;
use spunlaid_ground::{Measure, PERCENT, measure};
use spunlaid_web::{
    FABRIC_MEASURES, FABRIC_PATCH_MEASURES, Fabric, STREAK_MEASURES, STRIP_MEASURES, THINNEST_PATCH_MEASURES,
};

/// Everything that is reported of a fabric.
pub(crate) fn fabric_section(fabric: &Fabric) -> Section<'static> {
    let columns = [("Number", Content::Words), ("Value", Content::Numbers), ("Meaning", Content::Sentences)];
    let rows = measure::measured(FABRIC_MEASURES, fabric).filter_map(|row| {
        let value = known_text(&row)?;
        Some(Row::new(row.measure.label, [value.as_str(), row.measure.meaning]))
    });
    let mut section = Section::new("fabric", "Fabric")
        .table(Table::of(columns).laid_out(Layout::Results).rows(rows))
        .caption(format!(
            "{}; bonds and finishes are not known.",
            match fabric.is_of_map_alone {
                true => "From the map",
                false => {
                    "From the map, from the directions of the fibres and from what the file says of the fabric \
                     ([fabric])"
                }
            }
        ));
    for note in &fabric.notes {
        section = section.caption(note);
    }
    let [patch, places @ ..] = FABRIC_PATCH_MEASURES else { return section };
    let weights = places.iter().position(|measure| measure.unit == PERCENT).unwrap_or(places.len());
    let (places, weights) = places.split_at(weights);
    let sides: Vec<_> = fabric.patches.iter().map(|of| (shown(patch, of), of)).collect();
    section = compare(section, "Thin and thick spots", patch.label, places, &sides);
    section = compare(section, "Weight of patches over the mean", patch.label, weights, &sides);
    let thinnest: Vec<_> =
        (1..).zip(&fabric.marks.thinnest).map(|(i, place)| (i.to_string(), place)).collect();
    let heading = format!("The thinnest spots, patches of {}", millimetres(fabric.marks.patch));
    section = compare(section, &heading, "Place", THINNEST_PATCH_MEASURES, &thinnest);
    let strips = ["Along MD", "Along CD"].into_iter().zip(&fabric.strips);
    let strips: Vec<_> = strips.filter_map(|(along, of)| Some((along.to_owned(), of.as_ref()?))).collect();
    section = compare(section, "Strips", "Direction", STRIP_MEASURES, &strips);
    let [place, measures @ ..] = STREAK_MEASURES else { return section };
    let streaks: Vec<_> = fabric.streaks.iter().map(|streak| (shown(place, streak), streak)).collect();
    compare(section, "Streaks of the defects", place.label, measures, &streaks)
}

/// A row for each of several parts of the fabric, a column for each measure; below it, what the measures mean.
///
/// * `heading` – above the table
/// * `head` – above the names of its rows
pub(crate) fn compare<T>(
    section: Section<'static>,
    heading: &str,
    head: &'static str,
    measures: &'static [Measure<T>],
    parts: &[(String, &T)],
) -> Section<'static> {
    if parts.is_empty() {
        return section;
    }
    let heads = std::iter::once(head).chain(measures.iter().map(|measure| measure.label));
    let row = |(name, of): &(String, &T)| Row::new(name, measures.iter().map(|measure| shown(measure, *of)));
    let mut meanings: Vec<String> = Vec::new();
    for measure in measures {
        let meaning = format!("{}: {}.", measure.label, measure.meaning);
        if !meanings.iter().any(|other| other.ends_with(&format!(": {}.", measure.meaning))) {
            meanings.push(meaning);
        }
    }
    section.heading(heading).table(Table::new(heads).rows(parts.iter().map(row))).caption(meanings.join(" "))
}

/// A dash where there is no such number.
pub(crate) fn shown<T>(measure: &'static Measure<T>, of: &T) -> String {
    known_text(&measure.of(of)).unwrap_or_else(|| "–".to_owned())
}
