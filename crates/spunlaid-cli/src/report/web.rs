//! `report.html` of a web: the web on a light table, what makes it uneven, and the figures.

use super::rendered;
use super::words::{count, time};
use crate::failure::Failure;
use crate::numbers::{THIN, number, plus_minus, significant};
use crate::output::web::{Layer, Performance, light_table};
use askama::Template;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use spunlaid::web::{Fibres as WebFibres, Findings, Lever, Sensitivity, Strand, Web, Window};
use spunlaid_charts::Figure;

const MM: f64 = 1e3;
const PER_CENT: f64 = 100.0;
/// Largest side of the picture of the web [px].
const PICTURE: usize = 1400;
/// Most points of fibres in the page.
const POINTS: usize = 150_000;
/// Size of the patches that the eye judges first [m].
const SEEN: f64 = 10e-3;

/// Content of the report.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WebReport<'a> {
    /// What the web is called.
    pub(crate) name: &'a str,
    pub(crate) web: &'a Web,
    pub(crate) findings: &'a Findings,
    pub(crate) layers: &'a [Layer],
    /// The fibres in the window, and the diameter of those of the first layer [m].
    pub(crate) strands: &'a [Strand],
    pub(crate) window: Window,
    pub(crate) diameter: f64,
    pub(crate) figures: &'a [Figure],
    pub(crate) notes: &'a [String],
    /// The web file with every default.
    pub(crate) toml: &'a str,
    pub(crate) performance: Performance,
}

/// Content of `assets/web.html`, which escapes everything that is not marked safe.
#[derive(Template)]
#[template(path = "web.html")]
struct Page<'a> {
    name: &'a str,
    headline: String,
    summary: String,
    notes: &'a [String],
    caption: String,
    /// Numbers and base64 only: nothing in it can end the script element it stands in.
    data: String,
    verdict: Vec<String>,
    patches: Vec<Vec<String>>,
    /// Heading of the column of the other description of the filaments.
    compared: Option<&'static str>,
    lever_heads: Vec<String>,
    levers: Vec<(&'static str, Vec<String>)>,
    layers: Vec<[String; 6]>,
    figures: &'a [Figure],
    toml: &'a str,
    cost: String,
    version: &'static str,
}

/// What the script of the light table gets; lengths in mm.
#[derive(Serialize)]
struct Data {
    /// Base64 of the picture.
    image: String,
    width: f64,
    length: f64,
    /// Side of a pixel of the picture.
    pixel: f64,
    window: Fibres,
}

#[derive(Serialize)]
struct Fibres {
    corner: [f64; 2],
    sides: [f64; 2],
    diameter: f64,
    /// Number of points of each fibre.
    counts: Vec<usize>,
    /// Base64 of 32-bit numbers, low byte first: x and y of each point from the corner.
    points: String,
}

/// The report as one HTML file.
pub(crate) fn web_html(input: &WebReport<'_>) -> Result<String, Failure> {
    let of = input.findings;
    let map = &of.laid.map;
    let failed = |reason| Failure::Figure { name: "web".to_owned(), reason };
    let (picture, each) = light_table(map, PICTURE).map_err(failed)?;
    let data = Data {
        image: STANDARD.encode(picture),
        width: map.columns as f64 * map.cell * MM,
        length: map.rows as f64 * map.cell * MM,
        pixel: each as f64 * map.cell * MM,
        window: fibres(input),
    };
    let page = Page {
        name: input.name,
        headline: headline(of),
        summary: summary(input.web),
        notes: input.notes,
        caption: caption(input, each),
        data: serde_json::to_string(&data).map_err(|error| failed(error.to_string()))?,
        verdict: verdict(of),
        patches: patches(of),
        compared: compared(input.web),
        lever_heads: of.patches.iter().map(|patch| millimetres(patch.map.patch)).collect(),
        levers: of.sensitivities.iter().map(levers).collect(),
        layers: input.layers.iter().map(layer).collect(),
        figures: input.figures,
        toml: input.toml,
        cost: format!(
            "computed in {} on {}",
            time(input.performance.wall_s),
            count(input.performance.threads as u64, "thread")
        ),
        version: env!("CARGO_PKG_VERSION"),
    };
    Ok(rendered(&page))
}

fn millimetres(length: f64) -> String {
    format!("{}{THIN}mm", significant(length * MM, 3))
}

fn grams(weight: f64) -> String {
    format!("{}{THIN}g/m²", significant(weight * 1e3, 3))
}

/// The patch nearest to what the eye judges first.
fn seen(of: &Findings) -> Option<usize> {
    let far = |i: &usize| (of.patches[*i].map.patch / SEEN).ln().abs();
    (0..of.patches.len()).min_by(|a, b| far(a).total_cmp(&far(b)))
}

fn headline(of: &Findings) -> String {
    let weight = grams(of.laid.map.basis_weight());
    match seen(of).map(|i| &of.patches[i]) {
        Some(patch) => format!(
            "A web of {weight} that varies by {}{THIN}% over patches of {}.",
            plus_minus(patch.map.cv * PER_CENT, patch.map.standard_error.map(|error| error * PER_CENT)),
            millimetres(patch.map.patch)
        ),
        None => format!("A web of {weight}."),
    }
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

fn metres(length: f64) -> String {
    if length < 1.0 { millimetres(length) } else { format!("{}{THIN}m", significant(length, 3)) }
}

fn caption(input: &WebReport<'_>, each: usize) -> String {
    let map = &input.findings.laid.map;
    format!(
        "Lighter where there is less fibre; black and white are three standard deviations apart from the mean. The machine \
         direction runs downwards. A pixel is {} wide. In the frame, {} by {}, the single fibres are drawn in their true width: zoom in with \
         the wheel, the buttons or + and −.",
        millimetres(each as f64 * map.cell),
        millimetres(input.window.sides[0]),
        millimetres(input.window.sides[1])
    )
}

fn fibres(input: &WebReport<'_>) -> Fibres {
    let mut points = Vec::new();
    let mut counts = Vec::new();
    for strand in input.strands {
        if points.len() / 8 + strand.points.len() > POINTS {
            break;
        }
        counts.push(strand.points.len());
        points.extend(strand.points.iter().flatten().flat_map(|x| ((x * MM) as f32).to_le_bytes()));
    }
    Fibres {
        corner: input.window.corner.map(|x| x * MM),
        sides: input.window.sides.map(|x| x * MM),
        diameter: input.diameter * MM,
        counts,
        points: STANDARD.encode(points),
    }
}

/// What the other description of the filaments is.
fn compared(web: &Web) -> Option<&'static str> {
    match web.layers.first()?.compared.as_ref()? {
        WebFibres::Surrogate(_) => Some("CV expected, from the surrogate"),
        WebFibres::Curves(_) => Some("CV expected, from the flown curves"),
    }
}

fn patches(of: &Findings) -> Vec<Vec<String>> {
    let per_cent = |cv: f64, error: Option<f64>| {
        format!("{}{THIN}%", plus_minus(cv * PER_CENT, error.map(|error| error * PER_CENT)))
    };
    let row = |patch: &spunlaid::web::PatchFindings| {
        let mut cells = vec![
            millimetres(patch.map.patch),
            per_cent(patch.map.cv, patch.map.standard_error),
            per_cent(patch.one_fibre.0, Some(patch.one_fibre.1)),
        ];
        cells.extend(patch.compared.map(|(cv, error)| per_cent(cv, Some(error))));
        cells.push(format!("{}{THIN}%", significant(patch.straight_fibres * PER_CENT, 3)));
        cells
    };
    of.patches.iter().map(row).collect()
}

const fn words(lever: Lever) -> &'static str {
    match lever {
        Lever::SigmaMd => "spread of the lay-down in machine direction, σ MD",
        Lever::SigmaCd => "spread of the lay-down in cross direction, σ CD",
        Lever::Noise => "noise of the direction, A",
        Lever::BeltSpeed => "belt speed",
        Lever::Filaments => "filaments",
    }
}

fn levers(of: &Sensitivity) -> (&'static str, Vec<String>) {
    let cell = |elasticity: &spunlaid::statistics::Estimate| {
        format!("{}{THIN}%", plus_minus(elasticity.mean, elasticity.standard_error))
    };
    (words(of.lever), of.elasticity.iter().map(cell).collect())
}

fn layer(of: &Layer) -> [String; 6] {
    let spread = |sigma: Option<f64>| sigma.map_or("–".to_owned(), millimetres);
    [
        of.name.clone(),
        of.filaments.to_string(),
        grams(of.basis_weight_kg_m2),
        spread(of.sigma_md_m),
        spread(of.sigma_cd_m),
        of.noise_per_sqrt_m.map_or("–".to_owned(), |noise| format!("{}{THIN}m^-½", significant(noise, 3))),
    ]
}

/// What makes the web uneven, and what would make it more even, in sentences.
fn verdict(of: &Findings) -> Vec<String> {
    let mut sentences = Vec::new();
    if let Some(clouds) = &of.clouds {
        let octaves = clouds.octaves();
        let whole: f64 = octaves.iter().map(|(_, variance)| variance.mean).sum();
        if let Some((waves, variance)) = octaves.iter().max_by(|a, b| a.1.mean.total_cmp(&b.1.mean)) {
            sentences.push(format!(
                "Clouds with wavelengths of {} to {} hold the most: {} % of the variance between {} and {}.",
                millimetres(waves[0]),
                millimetres(waves[1]),
                significant(PER_CENT * variance.mean / whole, 2),
                millimetres(clouds.shortest()),
                millimetres(clouds.longest())
            ));
        }
    }
    let Some(i) = seen(of) else { return sentences };
    let patch = &of.patches[i];
    let ratio = patch.one_fibre.0 / patch.straight_fibres;
    let why = if ratio > 1.05 {
        "a fibre that visits its own place again and again clouds the web"
    } else {
        "nozzles at an even pitch take out what loops would make uneven"
    };
    sentences.push(format!(
        "Over patches of {} the expected CV is {} times that of straight fibres of the same mass at random: {why}.",
        millimetres(patch.map.patch),
        significant(ratio, 3)
    ));
    let change = |sensitivity: &&Sensitivity| sensitivity.elasticity[i].mean.abs();
    if let Some(most) = of.sensitivities.iter().max_by(|a, b| change(a).total_cmp(&change(b))) {
        let elasticity = &most.elasticity[i];
        let way = if elasticity.mean < 0.0 { "more" } else { "less" };
        let effect =
            plus_minus(10.0 * elasticity.mean.abs(), elasticity.standard_error.map(|error| 10.0 * error));
        sentences.push(format!(
            "Of the line’s numbers, {} lowers the CV over patches of {} most: 10 % {way} of it lowers the CV by about {effect} % of its value.",
            words(most.lever),
            millimetres(patch.map.patch)
        ));
    }
    sentences
}
