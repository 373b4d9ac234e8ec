//! `report.html` of a web: the web on a light table, what makes it uneven, and the figures.

use super::rendered;
use super::words::{count, time};
use crate::Failure;
use crate::numbers::{THIN, number, plus_minus, significant};
use crate::output::web::{Layer, Performance, light_table};
use askama::Template;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;
use spunlaid::web::uniformity::Unevenness;
use spunlaid::web::{Clouds, Fibres as WebFibres, Findings, Lever, Map, Sensitivity, Strand, Web, Window};
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
pub struct WebReport<'a> {
    /// What the web is called.
    pub name: &'a str,
    /// The web.
    pub web: &'a Web,
    /// What was found.
    pub findings: &'a Findings,
    /// Its layers.
    pub layers: &'a [Layer],
    /// The fibres in the window, and the diameter of those of the first layer [m].
    pub strands: &'a [Strand],
    /// The window whose single fibres are shown.
    pub window: Window,
    /// Diameter of the fibres of the first layer [m].
    pub diameter: f64,
    /// The figures.
    pub figures: &'a [Figure],
    /// Notes for the reader.
    pub notes: &'a [String],
    /// The web file with every default.
    pub toml: &'a str,
    /// What it cost.
    pub performance: Performance,
}

/// Content of `assets/web.html`, which escapes everything that is not marked safe.
#[derive(Template)]
#[template(path = "web.html")]
pub(super) struct Page<'a> {
    /// The command that wrote it.
    pub(super) command: &'static str,
    pub(super) name: &'a str,
    pub(super) headline: String,
    pub(super) summary: String,
    pub(super) notes: &'a [String],
    pub(super) caption: String,
    /// Numbers and base64 only: nothing in it can end the script element it stands in.
    pub(super) data: String,
    /// Whether there are single fibres to be seen.
    pub(super) fibres: bool,
    pub(super) verdict: Vec<String>,
    pub(super) heads: Vec<&'static str>,
    pub(super) patches: Vec<Vec<String>>,
    pub(super) about_patches: &'static str,
    pub(super) lever_heads: Vec<String>,
    pub(super) levers: Vec<(&'static str, Vec<String>)>,
    pub(super) figures: &'a [Figure],
    pub(super) file: File<'a>,
    pub(super) cost: String,
    pub(super) version: &'static str,
}

/// What the web was made from.
pub(super) struct File<'a> {
    pub(super) title: &'static str,
    pub(super) heads: &'static [&'static str],
    pub(super) rows: Vec<Vec<String>>,
    pub(super) toml: &'a str,
    pub(super) caption: &'static str,
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
    window: Option<Fibres>,
}

#[derive(Serialize)]
pub(super) struct Fibres {
    corner: [f64; 2],
    sides: [f64; 2],
    diameter: f64,
    /// Number of points of each fibre.
    counts: Vec<usize>,
    /// Base64 of 32-bit numbers, low byte first: x and y of each point from the corner.
    points: String,
}

/// The report as one HTML file.
pub fn web_html(input: &WebReport<'_>) -> Result<String, Failure> {
    let of = input.findings;
    let (data, pixel) = light_table_data(&of.laid.map, Some(fibres(input)))?;
    let compared = compared(input.web);
    let mut heads = vec!["Patch", "CV of this map", "95 % interval", "CV expected, from single fibres"];
    heads.extend(compared);
    heads.push("Straight fibres");
    let page = Page {
        command: "web",
        name: input.name,
        headline: headline(Some(of.within().basis_weight()), seen(of).map(|i| &of.patches[i].map)),
        summary: summary(input.web),
        notes: input.notes,
        caption: caption(input, pixel),
        data,
        fibres: true,
        verdict: verdict(of),
        heads,
        patches: patches(of),
        about_patches: match compared {
            Some(_) => {
                "How well the surrogate speaks for the flown fibres is seen from the two expected columns."
            }
            None => "",
        },
        lever_heads: of.patches.iter().map(|patch| millimetres(patch.map.patch)).collect(),
        levers: of.sensitivities.iter().map(levers).collect(),
        figures: input.figures,
        file: File {
            title: "The web file",
            heads: &["Layer", "Filaments", "Basis weight", "σ MD", "σ CD", "A"],
            rows: input.layers.iter().map(layer).collect(),
            toml: input.toml,
            caption: "The map is in map.npy (kg/m², a row of the web after the other), map.png (16 bit) and map.parquet, the fibres of \
                      the window in fibres.vtp, all numbers in summary.json, beside this page.",
        },
        cost: cost(input.performance),
        version: env!("CARGO_PKG_VERSION"),
    };
    Ok(rendered(&page))
}

pub(super) fn cost(of: Performance) -> String {
    format!("computed in {} on {}", time(of.wall_s), count(of.threads as u64, "thread"))
}

/// What the script of the light table gets, and the side of a pixel of its picture [m].
pub(super) fn light_table_data(map: &Map, window: Option<Fibres>) -> Result<(String, f64), Failure> {
    let failed = |reason| Failure::Figure { name: "web".to_owned(), reason };
    let (picture, each) = light_table(map, PICTURE).map_err(failed)?;
    let pixel = each as f64 * map.cell;
    let data = Data {
        image: STANDARD.encode(picture),
        width: map.columns as f64 * map.cell * MM,
        length: map.rows as f64 * map.cell * MM,
        pixel: pixel * MM,
        window,
    };
    Ok((serde_json::to_string(&data).map_err(|error| failed(error.to_string()))?, pixel))
}

pub(super) fn millimetres(length: f64) -> String {
    format!("{}{THIN}mm", significant(length * MM, 3))
}

fn grams(weight: f64) -> String {
    format!("{}{THIN}g/m²", significant(weight * 1e3, 3))
}

/// The patch nearest to what the eye judges first.
fn seen(of: &Findings) -> Option<usize> {
    nearest(of.patches.iter().map(|patch| patch.map.patch))
}

/// Which of the sides of patches is nearest to what the eye judges first.
pub(super) fn nearest(patches: impl Iterator<Item = f64>) -> Option<usize> {
    let far = |patch: f64| (patch / SEEN).ln().abs();
    patches.map(far).enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
}

/// * `weight` – mean basis weight, if it is known [kg/m²]
pub(super) fn headline(weight: Option<f64>, seen: Option<&Unevenness>) -> String {
    let web = weight.map_or_else(|| "A web".to_owned(), |weight| format!("A web of {}", grams(weight)));
    match seen {
        Some(of) => format!(
            "{web} that varies by {} over patches of {}.",
            per_cent(of.cv, of.standard_error),
            millimetres(of.patch)
        ),
        None => format!("{web}."),
    }
}

pub(super) fn per_cent(cv: f64, error: Option<f64>) -> String {
    format!("{}{THIN}%", plus_minus(cv * PER_CENT, error.map(|error| error * PER_CENT)))
}

/// `5.1 to 7.2 %`, or a dash.
pub(super) fn interval(of: Option<[f64; 2]>) -> String {
    of.map_or_else(
        || "–".to_owned(),
        |[low, high]| {
            format!("{} to {}{THIN}%", significant(PER_CENT * low, 3), significant(PER_CENT * high, 3))
        },
    )
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

pub(super) fn metres(length: f64) -> String {
    if length < 1.0 { millimetres(length) } else { format!("{}{THIN}m", significant(length, 3)) }
}

/// * `pixel` – side of a pixel of the picture [m]
pub(super) fn about_light_table(pixel: f64) -> String {
    format!(
        "Lighter where there is less fibre; black and white are three standard deviations apart from the mean. The machine \
         direction runs downwards. A pixel is {} wide.",
        millimetres(pixel)
    )
}

fn caption(input: &WebReport<'_>, pixel: f64) -> String {
    format!(
        "{} In the frame, {} by {}, the single fibres are drawn in their true width: zoom in with \
         the wheel, the buttons or + and −.",
        about_light_table(pixel),
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
    let row = |patch: &spunlaid::web::PatchFindings| {
        let mut cells = vec![
            millimetres(patch.map.patch),
            per_cent(patch.map.cv, patch.map.standard_error),
            interval(patch.map.interval()),
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

fn layer(of: &Layer) -> Vec<String> {
    let spread = |sigma: Option<f64>| sigma.map_or("–".to_owned(), millimetres);
    vec![
        of.name.clone(),
        of.filaments.to_string(),
        grams(of.basis_weight_kg_m2),
        spread(of.sigma_md_m),
        spread(of.sigma_cd_m),
        of.noise_per_sqrt_m.map_or("–".to_owned(), |noise| format!("{}{THIN}m^-½", significant(noise, 3))),
    ]
}

/// Which clouds hold most of the variance, in a sentence.
pub(super) fn largest_clouds(clouds: &Clouds) -> Option<String> {
    let octaves = clouds.octaves();
    let whole: f64 = octaves.iter().map(|(_, variance)| variance.mean).sum();
    let (waves, variance) = octaves.iter().max_by(|a, b| a.1.mean.total_cmp(&b.1.mean))?;
    Some(format!(
        "Clouds with wavelengths of {} to {} hold the most: {} % of the variance between {} and {}.",
        millimetres(waves[0]),
        millimetres(waves[1]),
        significant(PER_CENT * variance.mean / whole, 2),
        millimetres(clouds.shortest()),
        millimetres(clouds.longest())
    ))
}

/// What makes the web uneven, and what would make it more even, in sentences.
fn verdict(of: &Findings) -> Vec<String> {
    let mut sentences: Vec<String> = of.clouds.as_ref().and_then(largest_clouds).into_iter().collect();
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
