//! `report.html` of a spinline, and the section about it in the reports of runs and of webs.

use super::methods::{Account, Methods};
use super::rendered;
use super::words::length;
use crate::numbers::{THIN, number_to, significant};
use crate::output::measured::text;
use crate::output::spinline::{SpinResults, freezing, influence, model_error, numerical_error};
use crate::output::web::Layer;
use askama::Template;
use spunlaid::case::Case;
use spunlaid::input::SpinFile;
use spunlaid::observe::{Measured, OF_SPINLINES, measured};
use spunlaid::spinline::{End, Law, PolymerSource, Solution, SpinSpec, Surroundings, ZERO_CELSIUS};
use spunlaid::web::Web;
use spunlaid_charts::Figure;

/// Influences that are told in a sentence each.
const TOLD: usize = 3;

/// Content of the report.
#[derive(Clone, Copy, Debug)]
pub struct SpinReport<'a> {
    /// What the spinline is called: the name of its file.
    pub name: &'a str,
    /// The spinline.
    pub file: &'a SpinFile,
    /// Its solution.
    pub results: &'a SpinResults,
    /// The figures.
    pub figures: &'a [Figure],
    /// Notes for the reader.
    pub notes: &'a [String],
    /// The spinline with every default, as a file.
    pub toml: &'a str,
}

/// Content of `assets/spinline.html`, which escapes everything that is not marked safe.
#[derive(Template)]
#[template(path = "spinline.html")]
struct SpinPage<'a> {
    name: &'a str,
    headline: String,
    summary: String,
    notes: &'a [String],
    spinline: SpinSection<'a>,
    methods: Vec<(&'static str, String)>,
    methods_paragraph: Methods,
    toml: &'a str,
}

/// Content of `assets/spinline_section.html`.
pub(super) struct SpinSection<'a> {
    pub(super) id: String,
    pub(super) title: String,
    pub(super) sentences: Vec<String>,
    pub(super) rows: Vec<Row>,
    pub(super) errors: String,
    pub(super) influences: Vec<String>,
    pub(super) figures: &'a [Figure],
}

/// A measure of the table.
pub(super) struct Row {
    pub(super) name: &'static str,
    pub(super) value: String,
    pub(super) unit: &'static str,
    pub(super) meaning: String,
}

impl<'a> SpinSection<'a> {
    /// * `id` – of the section in its page
    pub(super) fn new(
        id: &str,
        title: &str,
        sentences: Vec<String>,
        SpinResults { rows, influences }: &SpinResults,
        figures: &'a [Figure],
    ) -> Self {
        let of_row = |solution: &Solution| {
            let row = |row: Measured<Solution>| Row {
                name: row.measure.label,
                value: text(&row).unwrap_or_default(),
                unit: row.measure.unit.shown,
                meaning: row.meaning().to_owned(),
            };
            measured(OF_SPINLINES, solution).map(row).collect()
        };
        Self {
            id: id.to_owned(),
            title: title.to_owned(),
            sentences: sentences.into_iter().chain(curtain(rows)).collect(),
            rows: rows.first().map_or_else(Vec::new, of_row),
            errors: format!(
                "{} {}",
                numerical_error(rows),
                model_error(rows.first().is_some_and(|row| row.has_low_birefringence))
            ),
            influences: influences.iter().take(TOLD).map(influence).collect(),
            figures,
        }
    }
}

/// The report as one HTML file.
pub fn spinline_html(input: &SpinReport<'_>) -> String {
    let (spec, rows) = (&input.file.spec, &input.results.rows);
    let headline = rows.first().map_or_else(String::new, headline);
    let result = |row: Measured<Solution>| {
        let value = text(&row).unwrap_or_default();
        format!("{} {value} {}", row.measure.label, row.measure.unit.shown).trim_end().to_owned()
    };
    let results: Vec<String> =
        rows.iter().take(1).flat_map(|row| measured(OF_SPINLINES, row).map(result)).collect();
    let found = [headline.clone(), format!("{}.", results.join(", ")), numerical_error(rows)];
    let page = SpinPage {
        name: input.name,
        methods_paragraph: Methods::new("spin", account(spec, rows), found),
        headline,
        summary: summary(spec, rows),
        notes: input.notes,
        spinline: SpinSection::new("results", "Results", Vec::new(), input.results, input.figures),
        methods: methods(spec),
        toml: input.toml,
    };
    rendered(&page)
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

/// What is spun, and where it freezes, in sentences.
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
        text += &freezing(solution);
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
pub(super) fn section_of_fibre<'a>(
    case: &Case,
    results: &SpinResults,
    figures: &'a [Figure],
) -> SpinSection<'a> {
    let gives = match results.rows.first() {
        Some(solution) if solution.modulus_estimate == case.fibre.youngs_modulus => {
            "diameter, density and speed, and an estimate of its Young’s modulus"
        }
        _ => "diameter, density and speed",
    };
    let sentences = results.rows.first().map(|solution| {
        format!("{} {} This gives the fibre that flies its {gives}.", headline(solution), freezing(solution))
    });
    SpinSection::new("spinline", "Spinline", sentences.into_iter().collect(), results, figures)
}

/// A spinline from which filaments of a web come.
#[derive(Clone, Debug)]
pub struct LayerSpinline {
    /// The layers of these filaments, from 0.
    pub layers: Vec<usize>,
    /// Mass flow of a hole [kg/s].
    pub throughput: f64,
    /// Its solution.
    pub results: SpinResults,
    /// Its figures.
    pub figures: Vec<Figure>,
}

/// The spinlines of a web, a section for each.
pub(super) fn sections_of_web<'a>(
    web: &Web,
    layers: &[Layer],
    spinlines: &'a [LayerSpinline],
) -> Vec<SpinSection<'a>> {
    let section = |(number, spinline): (usize, &'a LayerSpinline)| {
        let own = |layer: &usize| {
            let row = layers.get(*layer)?;
            Some(way(row, row.filaments as f64 / web.sheet.width, spinline, layers.len() > 1))
        };
        let about = spinline.results.rows.first().map(freezing);
        let sentences = spinline.layers.iter().filter_map(own).chain(about).collect();
        let (id, title) = match number {
            0 => ("spinline".to_owned(), "From the die to the web"),
            _ => (format!("spinline-{}", number + 1), "Another spinline"),
        };
        SpinSection::new(&id, title, sentences, &spinline.results, &spinline.figures)
    };
    spinlines.iter().enumerate().map(section).collect()
}

/// The way from the die to the web, with its basis weight from the holes, in a sentence.
///
/// * `holes` – filaments per metre of width [1/m]
fn way(layer: &Layer, holes: f64, spinline: &LayerSpinline, is_named: bool) -> String {
    let Some(solution) = spinline.results.rows.first() else { return String::new() };
    let from_holes = holes * spinline.throughput / layer.belt_speed_m_s;
    let apart = (from_holes / layer.basis_weight_kg_m2 - 1.0).abs();
    let verdict = if apart < 0.005 {
        "the same".to_owned()
    } else {
        format!("{}{THIN}% apart", significant(100.0 * apart, 2))
    };
    let grams = |weight: f64| format!("{}{THIN}g/m²", significant(weight * 1e3, 3));
    format!(
        "Die → diffuser → belt → web{}: {} holes per metre with {}{THIN}g/min each; filaments of {}{THIN}µm that enter at {}{THIN}m/s; a belt of \
         {}{THIN}m/s. Holes × throughput / belt speed is {}, and the web has {}: {verdict}.",
        if is_named { format!(", layer {}", layer.name) } else { String::new() },
        significant(holes, 4),
        significant(spinline.throughput * 6e4, 3),
        significant(solution.final_diameter * 1e6, 3),
        significant(solution.final_speed, 3),
        significant(layer.belt_speed_m_s, 3),
        grams(from_holes),
        grams(layer.basis_weight_kg_m2)
    )
}

/// How far the rows of a curtain are apart, in a sentence.
fn curtain(rows: &[Solution]) -> Option<String> {
    let [first, .., last] = rows else { return None };
    let micrometres = |row: &Solution| format!("{}{THIN}µm", number_to(row.final_diameter * 1e6, 4));
    Some(format!(
        "The filaments of the first of {} rows, on the side of the quench, have {}, those of the last row {}. The table is that of the \
         first row.",
        rows.len(),
        micrometres(first),
        micrometres(last)
    ))
}

/// What is computed of a spinline and how, with what is cited for it.
pub(super) fn account(spec: &SpinSpec, rows: &[Solution]) -> Account {
    let texts = methods(spec).into_iter().map(|(_, text)| text);
    let length = format!("The line is {} long.", length(spec.spinline.length));
    ([summary(spec, rows), length].into_iter().chain(texts).collect(), vec![spec.drag.along.source()])
}

/// What the model is, in a few words each.
fn methods(spec: &SpinSpec) -> Vec<(&'static str, String)> {
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
        " Crystals form by Nakamura’s law, faster in an oriented melt; how much faster was chosen, and docs/spinline.md says why."
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
            "Its velocity is that of the CFD field of the case, upstream of the inlet. Its temperature is {} everywhere \
             (spinline.temperature), because none is read from the field.",
            celsius(*temperature)
        ),
        Surroundings::Behind(_) => String::new(),
    };
    vec![
        (
            "The thread",
            format!(
                "One filament in steady state, with values averaged over its cross-section: {melt}. It is solid from the temperature at \
                 which the polymer freezes.{crystals}"
            ),
        ),
        (
            "The air",
            format!(
                "{air} It drags the thread by the friction law of the case (drag.along = {}), and cools it by the law of Kase and Matsuo for air \
                 along and across it.",
                spec.drag.along.name()
            ),
        ),
        ("The ends", format!("The tension at the die is sought such that the end of the line has {end}.")),
        (
            "What is not verified",
            format!(
                "{} The constants of the polymers are the usual ones of the literature, and most were not checked against their \
                 source; docs/spinline.md lists them.",
                model_error(spinline.has_low_birefringence())
            ),
        ),
    ]
}
