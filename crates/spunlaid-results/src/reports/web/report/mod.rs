//! The report of a web: the web on a light table, what makes it uneven, and the figures.

pub(crate) mod cards;
pub(crate) mod effects;
pub(crate) mod fabric;
pub(crate) mod light_table;
pub(crate) mod patch_cv;
pub(crate) mod scale;
pub(crate) mod spinlines;

use super::WebFolder;
use super::files::effects::Advised;
use super::files::picture::Pictures;
use super::files::summary::LayerSummary;
use crate::Failure;
use crate::effects::PER_CENT;
use crate::numbers::{THIN, number, significant};
use crate::page::document::{Part, Report, Section};
use crate::page::methods::{methods, of_web};
use crate::page::table::{Row, Table};
use crate::page::words::{cost, count, grams, grams_with_error, metres, millimetres};
use crate::reports::load::section_of_loads;
use cards::scale_card;
use effects::{advice_card, assumed_card, effects_table};
use fabric::fabric_section;
use light_table::{Fibres, MarkedPlaces, Strands, marks_note, picture_note, sheet};
use patch_cv::{CV_OF_PATCHES, headline, largest_clouds, patch_table, per_cent};
use scale::Judged;
use spinlines::{LayerSpinline, sections_of_web};
use spunlaid_charts::Figure;
use spunlaid_experiment::Advice;
use spunlaid_fibre::{BREAKDOWN, Load};
use spunlaid_ground::Dimension;
use spunlaid_input::WebFile;
use spunlaid_simulation::WebSpec;
use spunlaid_web::map::uniformity::PatchCv;
use spunlaid_web::map::{Evidence, Findings, PatchFindings};
use spunlaid_web::{ChargedCurtain, SubsampleEstimate, Web, WindowCurve};

/// A web.
///
/// * `toml` – the web as a file
/// * `strands` – the fibres in its window
///
/// # Errors
/// The picture cannot be drawn.
pub fn web_report<'a>(
    folder: &WebFolder,
    toml: &str,
    layers: &[LayerSummary],
    spinlines: &'a [LayerSpinline],
    pictures: &Pictures,
    strands: &[WindowCurve],
    figures: &'a [Figure],
) -> Result<Report<'a>, Failure> {
    let WebFolder { file: WebFile { spec, .. }, simulated, findings, fabric, .. } = folder;
    let web = &simulated.web;
    let tried = folder.advised();
    let diameter = spec.layers.first().map_or(0.0, |layer| layer.fed_filament().diameter());
    let strands = Strands { window: spec.window(), strands, diameter };
    let marks = Some(MarkedPlaces::new(fabric));
    let sheet = sheet(&findings.laid.map, pictures, Some(Fibres::new(strands)), marks)?;
    let caption = format!("{} {}{}", picture_note(&sheet), strands.words(), marks_note(fabric));
    let table = Section::new("web", "The web on a light table")
        .view(sheet.view())
        .with(Part::reading(caption))
        .picture();
    let loads = named_loads(layers);
    let spun = spinlines
        .first()
        .map_or("", |_| "Its filaments begin at the die: [from the melt to the web](#spinline).");
    let error = sentences([error_sentences(findings), air_sentence(findings)]);
    let judged = findings.seen().map(Judged::from);
    let scale = judged.map(|judged| scale_card(&findings.within(), judged)).transpose()?;
    let mut sentences = verdict(findings);
    Ok(Report::new("web", headline_of(spec, findings, tried))
        .lead(sentences.pop().unwrap_or_default())
        .lead(spun)
        .with(table)
        .with_all(scale)
        .with_all(
            [
                advice_card(spec, findings, tried),
                cards::line(spec, findings, layers),
                assumed_card(spec, findings, tried),
                cards::fabric(fabric),
            ]
            .map(Section::from),
        )
        .with(Section::new("doubt", "Contributions to its error").paragraph(error).printed())
        .with(uneven(web, findings, sentences))
        .with(effects(spec, findings, tried))
        .with(fabric_section(fabric))
        .with_all(section_of_loads(&loads))
        .with(charge(spec, findings))
        .with(Section::of_figures(figures))
        .with_all(sections_of_web(web, layers, spinlines))
        .with(methods("web", of_web(spec), "web.toml of the results"))
        .with(file_section(layers, toml))
        .costing(cost(folder.performance)))
}

/// All that was changed, and all that was assumed.
fn effects(spec: &WebSpec, findings: &Findings, tried: Advised<'_>) -> Section<'static> {
    let all = [
        ("What would make it more uniform", tried.advice),
        ("Influence of the assumed values", tried.assumed_values),
    ];
    let tables = all.into_iter().filter_map(|(heading, effects)| {
        Some((heading, effects_table(spec, findings, effects?, tried.beside)?))
    });
    tables.fold(
        Section::new("tried", "All changes and assumed values"),
        |section, (heading, (table, caption))| section.heading(heading).table(table).caption(caption),
    )
}

/// How uneven it is over patches of each size.
///
/// * `verdict` – what makes it so, without what is said first
fn uneven(web: &Web, findings: &Findings, verdict: Vec<String>) -> Section<'static> {
    Section::new("verdict", "CV of the basis weight over patches of each size")
        .paragraphs(verdict)
        .table(patch_table(findings))
        .caption(format!("{CV_OF_PATCHES} Its error is explained [above](#doubt)."))
        .paragraph(sentences([summary(web), laid_weight(web, findings)]))
        .both()
}

/// The loads of the layers on their air, with the names of these where there are several.
fn named_loads(layers: &[LayerSummary]) -> Vec<(Option<&str>, &Load)> {
    layers
        .iter()
        .filter_map(|layer| {
            Some((Some(&layer.name[..]).filter(|_| layers.len() > 1), layer.curtain.as_ref()?))
        })
        .collect()
}

/// What the web was made from.
fn file_section(layers: &[LayerSummary], toml: &str) -> Section<'static> {
    let heads = [
        "Layer",
        "Filaments",
        "Basis weight",
        "σ MD",
        "σ CD",
        "A",
        "Residual of the fit",
        "of which sampling error",
    ];
    Section::new("file", "The web file")
        .table(Table::new(heads).rows(layers.iter().map(layer)))
        .file("web-toml", toml)
        .caption(
            "The map is in map.npy (kg/m², one row of the web after the other), map.png (16 bit), the \
            fibres of the window in fibres.vtp. All numbers are in summary.json, next to this page.",
        )
}

/// Sentences behind each other, without the empty ones.
fn sentences<const N: usize>(all: [String; N]) -> String {
    all.into_iter().filter(|words| !words.is_empty()).collect::<Vec<_>>().join(" ")
}

fn summary(web: &Web) -> String {
    let filaments: u64 = web.layers.iter().map(|layer| layer.count(&web.sheet)).sum();
    let length = web.fibre_length();
    let length = if length >= 2000.0 {
        format!("{} km", number(length / 1e3))
    } else {
        format!("{} m", number(length))
    };
    format!(
        "{} across, {} along the web: {} of {}.",
        metres(web.sheet.width),
        metres(web.sheet.length),
        length,
        count(filaments, "filament")
    )
}

/// That the piece is lighter or heavier than the web that the line makes; nothing where it is as heavy.
fn laid_weight(web: &Web, findings: &Findings) -> String {
    let (laid, made) = (findings.basis_weight(), web.basis_weight());
    if (laid.0 / made - 1.0).abs() < AS_HEAVY {
        return String::new();
    }
    format!(
        "The line makes {} on average, and this piece has {}, because its ends and edges cut some clouds.",
        grams(made),
        grams_with_error(laid)
    )
}

/// Relative difference of two basis weights up to which they are shown as one.
const AS_HEAVY: f64 = 0.005;

/// What is reported of the web first. Where a few filaments do not give how uneven it is, so many as would.
fn headline_of(spec: &WebSpec, findings: &Findings, tried: Advised<'_>) -> String {
    let patch = findings.seen();
    if patch.is_none_or(|patch| patch.warning.is_none()) {
        let reported = patch.and_then(PatchFindings::with_total_error);
        let assumed = reported.as_ref().filter(|_| !spec.assumed.is_empty());
        let assumed = assumed.map(|reported| assumed_words(reported, tried.assumed_values));
        return headline(reported.as_ref(), findings.laid.evidence() == Evidence::Known, assumed);
    }
    let few = findings.laid.few().filter(|few| few.warning().is_some());
    let enough = few.map(|few| few.enough_per_metre().unwrap_or(f64::INFINITY)).fold(0.0, f64::max);
    let remedy = match enough.is_finite() {
        true => {
            format!("Leave web.simulated out to simulate as many as needed, {enough} or more for each metre")
        }
        false => "Simulate all of them, web.simulated = \"all\"".to_owned(),
    };
    format!("CV not known: too few filaments simulated. {remedy}.")
}

/// What half and twice of the assumed values make of the CV, for a headline.
fn assumed_words(reported: &PatchCv, assumed_values: Option<&Advice>) -> String {
    let known = |advice: &&Advice| advice.tried.iter().any(|tried| tried.on(reported.patch).is_some());
    match assumed_values.filter(known).map(|assumed_values| assumed_values.range(reported.patch)) {
        None => "the error excludes assumed values".to_owned(),
        Some([1.0, 1.0]) => "and no other with the assumed values".to_owned(),
        Some(ends) => {
            let [from, to] = ends.map(|end| significant(PER_CENT * end * reported.cv, 2));
            format!("{from} to {to}{THIN}% with the assumed values")
        }
    }
}

/// What is said below the pictures of a web and of what chance makes of it.
pub(crate) fn below(judged: Option<Judged>) -> [String; 2] {
    let Some(Judged { patch, reported, chance, .. }) = judged else { return Default::default() };
    let over = format!(" over {}", millimetres(patch));
    [
        reported
            .map_or_else(String::new, |(cv, error)| format!("CV of this web: {}{over}", per_cent(cv, error))),
        chance.map_or_else(String::new, |cv| {
            format!("Random straight fibres: {}{THIN}%", significant(PER_CENT * cv, 3))
        }),
    ]
}

/// What the filaments of a web without independent filaments have in common, and what those with airs of
/// their own leave out, in a sentence or two.
fn air_sentence(findings: &Findings) -> String {
    let independent = findings.seen().and_then(|patch| Some((patch, patch.independent()?)));
    match (findings.laid.evidence(), independent) {
        (Evidence::Known, _) => "This is a lower bound: in a line, neighbours move in the same eddies and land \
            together, and σ and A of one filament do not say how. Name a case whose filament lies like this one \
            (laydown.case) instead of the numbers to simulate them in shared turbulence."
            .to_owned(),
        (_, Some((patch, independent))) if patch.warning.is_some() => format!(
            "In independent turbulence the same filaments would give {}, which is a lower bound.",
            per_cent(independent, None)
        ),
        (_, Some((patch, independent))) => format!(
            "In independent turbulence the same filaments would give {}, {} times less. Here neighbours are in the \
            same eddies, which move them together and lay them in ropes and clouds.",
            per_cent(independent, None),
            significant(patch.map.cv / independent, 2)
        ),
        (Evidence::AllInOneAir, None) => "All filaments were simulated in shared turbulence.".to_owned(),
        (Evidence::FewInOneAir, None) => {
            "All filaments are in shared turbulence; a sample of them was simulated.".to_owned()
        }
    }
}

/// What the charge of the filaments does; nothing of filaments without charge.
fn charge(spec: &WebSpec, findings: &Findings) -> Section<'static> {
    let reported = |(number, charged): (usize, &ChargedCurtain)| {
        let layer = spec.layers.get(number)?;
        let last = charged.heights.last()?;
        let [behind, .., before] = last.places;
        Some(format!(
            "Charged with {}, the filaments{} repel each other: 95 % of their length is within {} along the machine \
            direction just above the belt. The field next to them is {} at most, and air breaks down at {}.",
            Dimension::SpecificCharge.pretty(layer.charge?),
            if spec.layers.len() > 1 { format!(" of layer {}", number + 1) } else { String::new() },
            Dimension::Length.pretty_to(before - behind, 3),
            Dimension::ElectricField.pretty_to(charged.edge_field, 2),
            Dimension::ElectricField.pretty(BREAKDOWN),
        ))
    };
    Section::new("charge", "Charge").paragraphs(findings.laid.charged().filter_map(reported)).printed()
}

/// What the error in the headline is made of, in sentences.
fn error_sentences(findings: &Findings) -> String {
    let Some(patch) = findings.seen() else { return String::new() };
    let error = patch.total_error();
    let part = |part: Option<f64>| match part {
        Some(part) => format!("{}{THIN}%", significant(part * PER_CENT, 2)),
        None => "an unknown part".to_owned(),
    };
    match (patch.evidence, patch.warning) {
        (Evidence::Known, _) => {
            "The error is the sampling error only; that of the surrogate is not known, because no fibre \
            was simulated."
                .to_owned()
        }
        (Evidence::AllInOneAir, _) => {
            "The error is the sampling error: every filament of the sheet was simulated, and another \
            piece of the same web, in other eddies, has another CV."
                .to_owned()
        }
        (Evidence::FewInOneAir, Some(_)) => {
            format!(
                "{}; the sample is too small to give the CV of all filaments, and so is its map.",
                simulated(findings)
            )
        }
        (Evidence::FewInOneAir, None) => format!(
            "{}; the web of all filaments is estimated from them. The area contributes {} to the error, because it \
            has few clouds, and the size of the sample {}.",
            simulated(findings),
            part(error.chance),
            part(error.flight)
        ),
    }
}

/// How many filaments were simulated for all, and where.
fn simulated(findings: &Findings) -> String {
    let filaments: u64 = findings.laid.few().map(|few| few.filaments).sum();
    let mut sheets: Vec<String> = findings.laid.few().map(|few| few.sheet.map(metres).join(" × ")).collect();
    sheets.dedup();
    let sheets = sheets.join(" and of ");
    let area: f64 = findings.laid.few().map(|few| few.area).sum();
    let coarse = match findings.laid.few().any(SubsampleEstimate::is_of_two_levels) {
        true => format!(
            ", and as many with a coarse mesh in other turbulence: {} m² in all",
            significant(area, 2)
        ),
        false => String::new(),
    };
    format!("{filaments} filaments were simulated, evenly spaced across, on a sheet of {sheets}{coarse}")
}

fn layer(layer: &LayerSummary) -> Row {
    let spread = |sigma: Option<f64>| sigma.map_or("–".to_owned(), millimetres);
    let cells = [
        layer.filaments.to_string(),
        grams(layer.basis_weight_kg_m2),
        spread(layer.sigma_md_m),
        spread(layer.sigma_cd_m),
        layer
            .noise_per_sqrt_m
            .map_or("–".to_owned(), |noise| format!("{}{THIN}m^-½", significant(noise, 3))),
        layer.fit_residual.map_or("–".to_owned(), |residual| significant(residual, 2)),
        layer.fit_residual_by_chance.map_or("–".to_owned(), |residual| significant(residual, 2)),
    ];
    Row::new(&layer.name, cells)
}

/// What makes the web uneven, in sentences.
fn verdict(findings: &Findings) -> Vec<String> {
    let mut sentences: Vec<String> = findings.clouds.as_ref().and_then(largest_clouds).into_iter().collect();
    let Some(patch) = findings.seen() else { return sentences };
    if patch.warning.is_some() {
        return Vec::new();
    }
    let is_shared = patch.evidence != Evidence::Known;
    let cv = patch.single_fibres.filter(|_| !is_shared).map_or(patch.map.cv, |(cv, _)| cv);
    let ratio = cv / patch.straight_fibres;
    let why = if is_shared {
        "filaments that land together make clouds"
    } else if ratio > 1.05 {
        "each fibre returns to its own position repeatedly, which makes clouds"
    } else {
        "holes at a constant pitch compensate for the variation of the loops"
    };
    sentences.push(format!(
        "Over patches of {} the {}CV is {} times that of straight fibres of the same mass at random: {why}.",
        millimetres(patch.map.patch),
        if is_shared { "" } else { "expected " },
        significant(ratio, 3)
    ));
    sentences
}
