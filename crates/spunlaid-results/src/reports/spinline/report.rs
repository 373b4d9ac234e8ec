//! The report of a spinline, and the section about it in the reports of runs and of webs.

use super::files::{SpinResults, influence, model_error, numerical_error, solidification};
use crate::numbers::{THIN, number_to, significant};
use crate::page::document::{Part, Report, Section};
use crate::page::methods::methods;
use crate::page::table::Table;
use crate::page::words::length;
use spunlaid_charts::Figure;
use spunlaid_fibre::{
    Case, End, Law, PolymerSource, SPINLINE_MEASURES, Solution, SpinSpec, Surroundings, ZERO_CELSIUS,
};

/// Figures on the first screen: speed and temperature.
const MAIN: usize = 2;
/// Influences that are reported in a sentence each.
const LISTED: usize = 3;

/// A spinline.
///
/// * `toml` – with every default, as a file
pub fn spinline_report<'a>(
    spec: &SpinSpec,
    results: &SpinResults,
    figures: &'a [Figure],
    toml: &str,
) -> Report<'a> {
    let rows = &results.rows;
    let headline = rows.first().map_or_else(String::new, headline);
    let computed = Section::new("methods", "How it was computed").descriptions(model(spec));
    let file = Section::new("file", "The spinline")
        .paragraph(
            "With every default filled in. `spunlaid spin spinline.toml` in the folder of this page gives \
            the same numbers, to the last digit. In a case, the same table takes the place of `feed.speed` \
            and `fibre.diameter`.",
        )
        .file("spinline-toml", toml)
        .caption(
            "The filament from the die to the end is in spinline.parquet, all numbers are in summary.json, and \
            the numbers of each figure are in figures/, next to this page.",
        );
    let (main, others) = figures.split_at(MAIN.min(figures.len()));
    let thread = Section::new("thread", "The filament from the die to the end").figures(main).open();
    Report::new("spin", headline)
        .lead(summary(spec, rows))
        .with(thread)
        .with(section(Section::new("results", "Results"), Vec::new(), results, &[]).printed())
        .with(Section::of_figures(others).open())
        .with(computed)
        .with(methods("spin", vec![spec.drag.along.source()], "spinline.toml of the results"))
        .with(file)
}

/// What a terminal shows of a spinline.
pub fn spinline_text(results: &SpinResults) -> String {
    let results = SpinResults { influences: Vec::new(), ..results.clone() };
    section(Section::new("results", "Results"), Vec::new(), &results, &[]).text(usize::MAX)
}

/// What is known of a spinline.
///
/// * `sentences` – before everything else
pub(crate) fn section<'a>(
    section: Section<'a>,
    sentences: Vec<String>,
    SpinResults { rows, influences }: &SpinResults,
    figures: &'a [Figure],
) -> Section<'a> {
    let first = rows.first();
    let results = first.map(|first| Table::of_measures(SPINLINE_MEASURES, first)).unwrap_or_default();
    let is_low = first.is_some_and(|row| row.has_low_birefringence);
    let section = section.paragraphs(sentences.into_iter().chain(curtain(rows)));
    let sentences: Vec<String> = influences.iter().take(LISTED).map(influence).collect();
    let section = match &sentences[..] {
        [] => section,
        _ => section.heading("What decides the diameter").with(Part::List(sentences)),
    };
    section
        .heading("All numbers")
        .table(results)
        .heading("How far these numbers can be trusted")
        .paragraph(format!("{} {}", numerical_error(rows), model_error(is_low)))
        .figures(figures)
}

/// The filament in a sentence.
fn headline(solution: &Solution) -> String {
    format!(
        "A filament of {}{THIN}µm, {}{THIN}dtex, at {}{THIN}m/s.",
        significant(solution.final_diameter * 1e6, 3),
        significant(solution.linear_density * 1e7, 3),
        significant(solution.final_speed, 3)
    )
}

/// What is spun, and where it solidifies, in sentences.
fn summary(spec: &SpinSpec, rows: &[Solution]) -> String {
    let spinline = &spec.spinline;
    let mut text = format!(
        "{}{THIN}g/min of {} through a hole of {} at {}.",
        significant(spinline.throughput * 6e4, 3),
        polymer(&spinline.polymer),
        length(spinline.hole_diameter),
        celsius(spinline.die_temperature)
    );
    if let Some(solution) = rows.first() {
        text += " ";
        text += &solidification(solution);
    }
    text
}

fn polymer(source: &PolymerSource) -> String {
    match source {
        PolymerSource::Known(polymer) => polymer.name().to_uppercase(),
        PolymerSource::File(file) => {
            file.path().file_name().unwrap_or_default().to_string_lossy().into_owned()
        }
    }
}

fn celsius(temperature: f64) -> String {
    format!("{}{THIN}°C", significant(temperature - ZERO_CELSIUS, 4))
}

/// The spinline from which a fibre in flight is fed.
pub(crate) fn section_of_fibre<'a>(case: &Case, results: &SpinResults, figures: &'a [Figure]) -> Section<'a> {
    let gives = match results.rows.first() {
        Some(solution) if solution.modulus_estimate == case.fibre.youngs_modulus => {
            "diameter, density and speed, and an estimate of its Young’s modulus"
        }
        _ => "diameter, density and speed",
    };
    let sentences = results.rows.first().map(|solution| {
        format!(
            "{} {} This gives the simulated fibre its {gives}.",
            headline(solution),
            solidification(solution)
        )
    });
    section(Section::new("spinline", "Spinline"), sentences.into_iter().collect(), results, figures)
}

/// How far the rows of a curtain are apart, in a sentence.
fn curtain(rows: &[Solution]) -> Option<String> {
    let [first, .., last] = rows else { return None };
    let micrometres = |row: &Solution| format!("{}{THIN}µm", number_to(row.final_diameter * 1e6, 4));
    Some(format!(
        "The filaments of the first of {} rows, on the side of the quench, have {}, those of the last row \
        {}. The table is that of the first row.",
        rows.len(),
        micrometres(first),
        micrometres(last)
    ))
}

/// What the model is, in a few words each.
fn model(spec: &SpinSpec) -> Vec<(&'static str, String)> {
    let spinline = &spec.spinline;
    let melt = match spinline.law {
        Law::Newtonian => "a Newtonian melt whose viscosity rises as it cools",
        Law::Giesekus => "Giesekus’s law of a viscoelastic melt, with one relaxation time",
        Law::Ptt => {
            "the linear law of Phan-Thien and Tanner of a viscoelastic melt, with one relaxation time"
        }
        Law::PttExponential => {
            "the exponential law of Phan-Thien and Tanner of a viscoelastic melt, with one relaxation time"
        }
    };
    let crystals = if spinline.crystallisation {
        " Crystals form by Nakamura’s law, faster in an oriented melt; how much faster was chosen, and \
        docs/theory.md says why."
    } else {
        ""
    };
    let end = match spinline.end {
        End::Tension(0.0) => "no tension: it is free".to_owned(),
        End::Tension(tension) | End::Flown(tension) => {
            format!("a tension of {}{THIN}mN", number_to(tension * 1e3, 3))
        }
        End::TakeUp(speed) => format!("a take-up speed of {}{THIN}m/s", number_to(speed, 4)),
    };
    let air = match &spinline.air {
        Surroundings::Uniform(_) => "It is the same along the whole line.".to_owned(),
        Surroundings::Table(_) => {
            "Its velocities and its temperature are those of the table of the case, linear between the rows."
                .to_owned()
        }
        Surroundings::Field { temperature, .. } => format!(
            "Its velocity is that of the CFD field of the case, upstream of the inlet. Its temperature is {} \
            everywhere (spinline.temperature), because none is read from the field.",
            celsius(*temperature)
        ),
        Surroundings::Behind(_) => String::new(),
    };
    vec![
        (
            "The filament",
            format!(
                "One filament in steady state, with values averaged over its cross-section: {melt}. It is \
                solid below the solidification temperature of the polymer.{crystals}"
            ),
        ),
        (
            "The air",
            format!(
                "{air} It drags the filament by the friction law of the case (drag.along = {}), and cools it by the \
                law of Kase and Matsuo for air along and across it.",
                spec.drag.along.name()
            ),
        ),
        ("The ends", format!("The tension at the die is sought such that the end of the line has {end}.")),
        (
            "What is not verified",
            format!(
                "{} The constants of the polymers are the usual ones of the literature, and most were not \
                checked against their source; docs/theory.md lists them.",
                model_error(spinline.has_low_birefringence())
            ),
        ),
    ]
}
