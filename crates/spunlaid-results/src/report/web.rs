//! `report.html` of a web: the web on a light table, what makes it uneven, and the figures.

use super::advice::{AdviceSection, is_known};
use super::fabric::{FabricSection, fabric_section};
use super::guesses::guess_words;
use super::headline::{grams, headline_patch};
use super::light_table::{Fibres, Sheet, Strands, picture_note, sheet};
use super::methods::{Methods, web_account};
use super::rendered;
use super::spinline::{self, LayerSpinline, SpinSection};
use super::words::{count, metres, millimetres, time};
use crate::Failure;
use crate::numbers::{THIN, number, plus_minus, significant};
use crate::output::web::{Layer, PatchTable, Performance, Reader};
use askama::Template;
use spunlaid::advice::Advice;
use spunlaid::fabric::Fabric;
use spunlaid::layers::WebSpec;
use spunlaid::statistics::Estimate;
use spunlaid::web::uniformity::Unevenness;
use spunlaid::web::{Clouds, Findings, Lever, PatchFindings, Sensitivity, Source, Strand, Web, Window};
use spunlaid_charts::Figure;

const PER_CENT: f64 = 100.0;

/// Content of the report.
#[derive(Clone, Copy, Debug)]
pub struct WebReport<'a> {
    /// What the web is called.
    pub name: &'a str,
    /// What is said of the web.
    pub spec: &'a WebSpec,
    /// The web.
    pub web: &'a Web,
    /// What was found.
    pub findings: &'a Findings,
    /// What is told of the fabric.
    pub fabric: &'a Fabric,
    /// What would make it more even; None if it was not tried.
    pub advice: Option<&'a Advice>,
    /// What guesses matter for it; None if it was not tried.
    pub guesses: Option<&'a Advice>,
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
    /// The spinlines from which its filaments come.
    pub spinlines: &'a [LayerSpinline],
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
pub(super) struct WebPage<'a> {
    /// The command that wrote it.
    pub(super) command: &'static str,
    pub(super) name: &'a str,
    pub(super) headline: String,
    pub(super) guesses: String,
    pub(super) summary: String,
    pub(super) notes: &'a [String],
    pub(super) caption: String,
    pub(super) sheet: Sheet,
    /// Whether there are single fibres to be seen.
    pub(super) fibres: bool,
    pub(super) verdict: Vec<String>,
    pub(super) heads: Vec<&'static str>,
    pub(super) patches: Vec<Vec<String>>,
    pub(super) about_patches: &'static str,
    pub(super) advice: AdviceSection,
    pub(super) lever_heads: Vec<String>,
    pub(super) levers: Vec<(String, Vec<String>)>,
    pub(super) fabric: FabricSection,
    pub(super) figures: &'a [Figure],
    pub(super) spinlines: Vec<SpinSection<'a>>,
    pub(super) methods_paragraph: Methods,
    pub(super) file: File<'a>,
    pub(super) cost: String,
}

/// What the web was made from.
pub(super) struct File<'a> {
    pub(super) title: &'static str,
    pub(super) heads: &'static [&'static str],
    pub(super) rows: Vec<Vec<String>>,
    pub(super) toml: &'a str,
    pub(super) caption: &'static str,
}

/// The report as one HTML file.
pub fn web_html(input: &WebReport<'_>) -> Result<String, Failure> {
    let findings = input.findings;
    let strands = Strands { window: input.window, strands: input.strands, diameter: input.diameter };
    let sheet = sheet(&findings.laid.map, Some(Fibres::new(strands)))?;
    let is_shared = findings.laid.shared_air.is_some();
    let has_flown = !is_shared && findings.patches.iter().any(|patch| patch.flown.is_some());
    let PatchTable { heads, rows: patches } = PatchTable::new(findings, Reader::Report);
    let headline = headline(
        Some(findings.within().basis_weight()),
        headline_patch(findings).map(|i| whole(&findings.patches[i])).as_ref(),
        !is_shared,
    );
    let cvs = findings.patches.iter().map(whole).collect::<Vec<_>>();
    let found = [headline.clone(), unevenness(&cvs), error_sentences(findings)];
    let page = WebPage {
        command: "web",
        name: input.name,
        methods_paragraph: Methods::new(
            "web",
            web_account(
                input.spec,
                input.findings.laid.shared_air.as_ref().map(|together| &together.few[..]),
            ),
            found,
        ),
        headline,
        guesses: guess_words(input.spec, findings, input.guesses),
        summary: [summary(input.web), air_sentence(input.spec, findings), error_sentences(findings)]
            .join(" "),
        notes: input.notes,
        caption: format!("{} {}", picture_note(sheet.pixel), strands.words()),
        sheet,
        fibres: true,
        verdict: verdict(findings, input.advice.is_some()),
        heads,
        patches,
        about_patches: if is_shared && findings.patches.iter().any(|patch| patch.few.is_some()) {
            "Filaments were flown in one air, a few for all others. The error is by chance (another piece of the same web, in other gusts, has another CV) \
             and by the few filaments."
        } else if is_shared {
            "All filaments were flown in one air. The error is by chance: another piece of the same web, in other gusts, has another CV."
        } else if has_flown {
            "The error of the map is that of all its causes together: chance (another piece of the same web), the \
             few fibres that were flown, and the model (the CV of the surrogate against that of the flown \
             curves). It does not include what the flight itself leaves out."
        } else {
            "The error is by chance only: no fibre was flown, so it is not known how far the surrogate is from \
             real fibres."
        },
        advice: AdviceSection::new(input.spec, findings, input.advice),
        lever_heads: findings.patches.iter().map(|patch| millimetres(patch.map.patch)).collect(),
        levers: findings.sensitivities.iter().map(levers).collect(),
        fabric: fabric_section(input.fabric),
        figures: input.figures,
        spinlines: spinline::sections_of_web(input.web, input.layers, input.spinlines),
        file: File {
            title: "The web file",
            heads: &[
                "Layer",
                "Filaments",
                "Basis weight",
                "σ MD",
                "σ CD",
                "A",
                "Residual of the fit",
                "of which chance",
            ],
            rows: input.layers.iter().map(layer).collect(),
            toml: input.toml,
            caption: "The map is in map.npy (kg/m², a row of the web after the other), map.png (16 bit) and map.parquet, the fibres of \
                      the window in fibres.vtp, all numbers in summary.json, beside this page.",
        },
        cost: cost(input.performance),
    };
    Ok(rendered(&page))
}

pub(super) fn cost(performance: Performance) -> String {
    format!("computed in {} on {}", time(performance.wall_s), count(performance.threads as u64, "thread"))
}

/// * `weight` – mean basis weight, if it is known [kg/m²]
/// * `is_bound` – whether its filaments are independent of each other, so that a real web is more uneven
pub(super) fn headline(weight: Option<f64>, patch: Option<&Unevenness>, is_bound: bool) -> String {
    let web = weight.map_or_else(|| "A web".to_owned(), |weight| format!("A web of {}", grams(weight)));
    match patch {
        Some(unevenness) => format!(
            "{web} that varies by {}{} over patches of {}{}.",
            if is_bound { "at least " } else { "" },
            per_cent(unevenness.cv, unevenness.standard_error),
            millimetres(unevenness.patch),
            if is_bound { ": its filaments are independent of each other" } else { "" }
        ),
        None => format!("{web}."),
    }
}

/// The CV over each size of patches, in a sentence.
pub(super) fn unevenness(patches: &[Unevenness]) -> String {
    let one = |patch: &Unevenness| {
        format!("{} over patches of {}", per_cent(patch.cv, patch.standard_error), millimetres(patch.patch))
    };
    let all: Vec<String> = patches.iter().map(one).collect();
    format!(
        "Its CV (standard deviation over mean of the basis weight) is {}, ± one standard error.",
        all.join(", ")
    )
}

pub(super) fn per_cent(cv: f64, error: Option<f64>) -> String {
    format!("{}{THIN}%", plus_minus(cv * PER_CENT, error.map(|error| error * PER_CENT)))
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

/// The map with its error by all causes, or by chance alone if the others are not known.
fn whole(patch: &PatchFindings) -> Unevenness {
    Unevenness { standard_error: patch.whole_error().whole().or(patch.map.standard_error), ..patch.map }
}

/// What the filaments of a web without independent filaments have in common, and what those with airs of their own leave out, in
/// a sentence or two.
fn air_sentence(spec: &WebSpec, findings: &Findings) -> String {
    let patch = headline_patch(findings).map(|i| &findings.patches[i]);
    match (&findings.laid.shared_air, patch.and_then(|patch| Some((patch, patch.independent?.cv)))) {
        (Some(_), Some((patch, independent))) => format!(
            "In airs of their own the same filaments would give {}, {} times less: here neighbours hang in the same gusts, which carry them \
             aside together and lay them in ropes and clouds.",
            per_cent(independent, None),
            significant(patch.map.cv / independent, 2)
        ),
        (Some(_), None) => "All filaments were flown in one air.".to_owned(),
        (None, _) if is_known(spec) => "This is a lower bound: in a line neighbours hang in the same gusts and come down together, and σ and A of one filament do \
                      not say how. Name a case whose filament lies as this one (laydown.case) in place of the numbers to fly them in one air."
            .to_owned(),
        (None, _) => "This is a lower bound: in a line neighbours hang in the same gusts and come down together. Name a case (laydown.case) and leave \
                      web.method out to fly them in one air."
            .to_owned(),
    }
}

/// What the error in the headline is made of, and what the flown curves say, in sentences.
fn error_sentences(findings: &Findings) -> String {
    let Some(patch) = headline_patch(findings).map(|i| &findings.patches[i]) else { return String::new() };
    if patch.independent.is_some() && patch.few.is_none() {
        return "The error is by chance: every filament of the sheet was flown.".to_owned();
    }
    let error = patch.whole_error();
    let part = |part: Option<f64>| match part {
        Some(part) => format!("{}{THIN}%", significant(part * PER_CENT, 2)),
        None => "an unknown part".to_owned(),
    };
    if let (Some(_), Some(together)) = (patch.few, &findings.laid.shared_air) {
        let filaments = together.few.iter().map(|few| few.filaments).sum();
        let sheets = together.few.iter().map(|few| few.sheet.map(metres).join(" × "));
        let mut sheets: Vec<String> = sheets.collect();
        sheets.dedup();
        return format!(
            "{} of all were flown, evenly across, on a sheet of {}; the others follow from them. Chance contributes {} to the error, because the \
             clouds on that sheet are few, and the small number of flown filaments {}.",
            count(filaments, "filament"),
            sheets.join(" and of "),
            part(error.chance),
            part(error.flight)
        );
    }
    let Some((flown, of_flown)) = patch.flown else {
        return "The error is by chance only; that of the surrogate is not known, because no fibre was flown.".to_owned();
    };
    format!(
        "Chance contributes {} to the error, the small number of flown fibres {}, and the model {}. The CV \
         expected from the flown curves themselves is {}.",
        part(error.chance),
        part(error.flight),
        part(error.model),
        per_cent(flown, Some(of_flown))
    )
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

fn levers(sensitivity: &Sensitivity) -> (String, Vec<String>) {
    let cell = |elasticity: &Option<Estimate>| match elasticity {
        Some(estimate) => format!("{}{THIN}%", plus_minus(estimate.mean, estimate.standard_error)),
        None => "not known".to_owned(),
    };
    let source = match sensitivity.source {
        Source::FlownFibres => ", from the flown curves",
        Source::Surrogate => ", from the surrogate",
        Source::Law => "",
    };
    (format!("{}{source}", words(sensitivity.lever)), sensitivity.elasticity.iter().map(cell).collect())
}

fn layer(layer: &Layer) -> Vec<String> {
    let spread = |sigma: Option<f64>| sigma.map_or("–".to_owned(), millimetres);
    vec![
        layer.name.clone(),
        layer.filaments.to_string(),
        grams(layer.basis_weight_kg_m2),
        spread(layer.sigma_md_m),
        spread(layer.sigma_cd_m),
        layer
            .noise_per_sqrt_m
            .map_or("–".to_owned(), |noise| format!("{}{THIN}m^-½", significant(noise, 3))),
        layer.fit_residual.map_or("–".to_owned(), |residual| significant(residual, 2)),
        layer.fit_residual_by_chance.map_or("–".to_owned(), |residual| significant(residual, 2)),
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
///
/// * `has_advice` – whether the settings of the line say what would
fn verdict(findings: &Findings, has_advice: bool) -> Vec<String> {
    let mut sentences: Vec<String> = findings.clouds.as_ref().and_then(largest_clouds).into_iter().collect();
    let Some(i) = headline_patch(findings) else { return sentences };
    let patch = &findings.patches[i];
    // The flown curves are believed where there are some.
    let is_shared = patch.independent.is_some();
    let cv = if is_shared { patch.map.cv } else { patch.flown.unwrap_or(patch.single_fibres).0 };
    let ratio = cv / patch.straight_fibres;
    let why = if is_shared {
        "filaments that come down together make clouds"
    } else if ratio > 1.05 {
        "each fibre comes back to its own place again and again, which makes clouds"
    } else {
        "nozzles at an even pitch make up for the unevenness of the loops"
    };
    sentences.push(format!(
        "Over patches of {} the {}CV is {} times that of straight fibres of the same mass at random: {why}.",
        millimetres(patch.map.patch),
        if is_shared { "" } else { "expected " },
        significant(ratio, 3)
    ));
    if has_advice {
        return sentences;
    }
    let known = findings
        .sensitivities
        .iter()
        .filter_map(|sensitivity| Some((sensitivity, sensitivity.elasticity[i].as_ref()?)));
    if let Some((most, elasticity)) = known.max_by(|a, b| a.1.mean.abs().total_cmp(&b.1.mean.abs())) {
        let way = if elasticity.mean < 0.0 { "more" } else { "less" };
        let effect =
            plus_minus(10.0 * elasticity.mean.abs(), elasticity.standard_error.map(|error| 10.0 * error));
        sentences.push(format!(
            "Among the numbers of the line whose effect is known, {} lowers the CV over patches of {} most: 10 % \
             {way} of it lowers the CV by about {effect} % of its value.",
            words(most.lever),
            millimetres(patch.map.patch)
        ));
    }
    sentences
}
