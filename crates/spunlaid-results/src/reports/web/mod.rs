//! A laid web.

mod checked;
pub(crate) mod figures;
pub(crate) mod files;
pub(crate) mod report;

pub use checked::{about_web, expected_of_web, numbers_of_line};

use crate::Failure;
use crate::failure::undrawable;
use crate::files::folder::{CASE_FILES, Staging};
use crate::files::kept_input::Input;
use crate::files::origin::{ORIGIN, Performance};
use crate::files::paraview;
use crate::files::table::TABLES;
use crate::folders::{Contents, Maker, Making, Page};
use crate::reports::load::load_of;
use crate::reports::run::figures::air::field_figure;
use crate::reports::spinline::figures::{SPINLINE, spinline_figures};
use crate::reports::spinline::files::{STATIONS, SpinResults, part_of_case, write_stations};
use figures::effects::effects_figure;
use figures::web_figures;
use files::effects::Advised;
use files::picture::Pictures;
use files::summary::LayerSummary;
use report::spinlines::LayerSpinline;
use report::web_report;
use spunlaid_charts::Figure;
use spunlaid_experiment::Advice;
use spunlaid_fibre::{Case, Load, Solution};
use spunlaid_ground::{Diagnostic, Isa, RunContext};
use spunlaid_input::{LayerSpec, WebFile, WebSpec};
use spunlaid_simulation::FlownWeb;
use spunlaid_web::map::{Filaments, Findings, strands};
use spunlaid_web::{Fabric, FlownFibres, Web};
use std::sync::atomic::AtomicU64;
use std::time::Instant;

/// The file of a web with the numbers of its simulations, from which a smaller error goes on.
pub const KEPT: &str = "kept";

/// Everything of a web that goes into the files.
#[derive(Debug)]
pub struct WebFolder {
    /// What the web is called: the name of its file.
    pub name: String,
    /// The file.
    pub file: WebFile,
    /// The web that was laid, with the fibres of its layers.
    pub simulated: FlownWeb,
    /// What was found of it.
    pub findings: Findings,
    /// What is reported of the fabric.
    pub fabric: Fabric,
    /// What would make it more even; None if it was not tried.
    pub advice: Option<Advice>,
    /// What assumed values matter for it; None if it was not tried.
    pub assumed_values: Option<Advice>,
    /// The folder of the web, beside which those of changed webs lie.
    pub beside: String,
    /// Whether what was not tried is tried next.
    pub awaited: bool,
    /// Notes about the file, and about what was found.
    notes: [Vec<String>; 2],
    /// What it cost.
    performance: Performance,
}

impl WebFolder {
    /// A web of which nothing has been tried.
    ///
    /// * `beside` – the folder of the web, next to which the folders of changed webs are
    /// * `started` – when it began to be laid
    pub fn new(
        name: String,
        beside: String,
        file: WebFile,
        simulated: FlownWeb,
        findings: Findings,
        started: Instant,
        by: RunContext<'_>,
    ) -> Self {
        let fabric = file.spec.fabric(&simulated.web, &findings, by.threads);
        let performance = Performance::measure(started, by.threads, by.isa).with_flights(&findings);
        let notes = [Diagnostic::notes_of_results(&file.notes), notes(&simulated, &findings)];
        let advice = None;
        let assumed_values = None;
        let awaited = false;
        Self {
            name,
            file,
            simulated,
            findings,
            fabric,
            advice,
            assumed_values,
            beside,
            awaited,
            notes,
            performance,
        }
    }

    /// What was tried with it.
    fn advised(&self) -> Advised<'_> {
        Advised {
            advice: self.advice.as_ref(),
            assumed_values: self.assumed_values.as_ref(),
            awaited: self.awaited,
            beside: &self.beside,
        }
    }

    /// The specification sheet, one page of PDF.
    ///
    /// # Errors
    /// If it cannot be drawn.
    pub fn specification(&self) -> Result<Vec<u8>, Failure> {
        files::sheet::specification_sheet(&self.name, &self.findings, &self.fabric, &self.notes.concat())
    }
}

impl Contents for WebFolder {
    /// With the cases of earlier versions.
    const ENTRIES: &'static [&'static str] = &[
        ORIGIN,
        "web.toml",
        "cases",
        CASE_FILES,
        "map.npy",
        "map.png",
        "fibres.vtp",
        STATIONS,
        TABLES,
        "figures",
        "report.html",
        KEPT,
        "summary.json",
    ];
    const OF_ONE_FORMAT: &'static [&'static str] = &["map.npy"];

    fn summary(&self) -> String {
        let web = &self.simulated.web;
        let rows = rows(&self.file.spec, web);
        files::summary::summary_of_web(
            web,
            &self.findings,
            &self.fabric,
            self.advised(),
            &rows,
            self.performance,
            &self.notes.concat(),
        )
    }

    fn found(&self) -> &[String] {
        &self.notes[1]
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let Self { simulated: FlownWeb { web, .. }, findings, .. } = self;
        let spec = &self.file.spec;
        let input = maker.keep(Input::Web(spec))?;
        let Making { threads, stop, .. } = maker.making;
        let by = RunContext { threads, isa: Isa::detect(), stop, done: &AtomicU64::new(0) };
        let strands = match findings.laid.simulated.is_empty() {
            true => strands(web, spec.window(), by)?,
            false => findings.laid.strands(),
        };
        let tried = self.advice.iter().chain(&self.assumed_values);
        let effects = tried.filter_map(|tried| effects_figure(spec, tried));
        let field = spec.cases().find_map(|case| field_figure(case, None));
        let figures: Vec<Figure> =
            web_figures(web, findings).into_iter().chain(effects).chain(field).collect();
        let spinlines = spinlines(spec);
        let of_spinlines = spinlines.iter().flat_map(|spinline| &spinline.figures);
        let all: Vec<&Figure> = figures.iter().chain(of_spinlines).collect();
        let pictures =
            Pictures::new(&findings.laid.map, Some(web), report::below(findings.seen().map(Into::into)));
        let files = |staging: &Staging<'_>| {
            let first = |spinline: &LayerSpinline| spinline.layers.first().map_or(1, |layer| layer + 1);
            let threads = spinlines.iter().map(|spinline| (first(spinline), &spinline.results.rows[..]));
            let threads: Vec<(usize, &[Solution])> = threads.collect();
            if !threads.is_empty() {
                write_stations(staging, &threads)?;
            }
            paraview::write_strands(staging, &strands)?;
            let slide = pictures.slide(&self.name).map_err(|reason| undrawable("web_picture", &reason))?;
            staging.write("figures/web_picture.png", slide)?;
            files::map::write(staging, &findings.laid.map)
        };
        let report = || web_report(self, &input, &rows(spec, web), &spinlines, &pictures, &strands, &figures);
        maker.finish(&self.name, &self.notes.concat(), &all, files, report)
    }
}

/// What layers were laid from, for the files.
fn rows(spec: &WebSpec, web: &Web) -> Vec<LayerSummary> {
    let row = |(i, (layer, drawn)): (usize, (&LayerSpec, &spunlaid_web::Layer))| {
        let fit = drawn.fibres.simulated().and_then(|simulated| simulated.residual);
        let surrogate = drawn.fibres.surrogate();
        LayerSummary {
            name: layer.name.clone().unwrap_or_else(|| (i + 1).to_string()),
            linear_density_kg_m: drawn.linear_density,
            feed_speed_m_s: drawn.feed_speed,
            belt_speed_m_s: drawn.belt_speed,
            filaments: drawn.count(&web.sheet),
            cabin_pressure_pa: layer.source.case().and_then(|case| case.air.cabin_pressure),
            air_at_slot_m_s: layer.source.case().and_then(|case| case.air.velocity_at_slot()),
            basis_weight_kg_m2: drawn.basis_weight(&web.sheet),
            sigma_md_m: surrogate.map(|drawn| drawn.sigma_md),
            sigma_cd_m: surrogate.map(|drawn| drawn.sigma_cd),
            laid_sigma_cd_m: drawn.fibres.sigma_cd(),
            hole_pitch_m: match &drawn.filaments {
                Filaments::AtRandom { .. } => Vec::new(),
                Filaments::Slot { per_metre, .. } => vec![1.0 / per_metre],
                Filaments::Rows(rows) => rows.iter().map(|row| row.pitch).collect(),
            },
            noise_per_sqrt_m: surrogate.map(|drawn| drawn.noise),
            fit_residual: fit.map(|fit| fit.rms),
            fit_residual_by_chance: fit.and_then(|fit| fit.by_chance),
            lateral_cutoff: spec.lateral_cutoff(i),
            curtain: curtain(
                layer,
                drawn.count(&web.sheet) as f64 / web.sheet.width,
                drawn.fibres.simulated(),
            ),
            spinline: layer.source.case().and_then(part_of_case),
        }
    };
    spec.layers.iter().zip(&web.layers).enumerate().map(row).collect()
}

/// What the filaments of a layer do to their air.
fn curtain(layer: &LayerSpec, filaments_per_metre: f64, simulated: Option<&FlownFibres>) -> Option<Load> {
    let way = simulated.map_or(&[][..], |simulated| &simulated.way);
    load_of(layer.source.case()?, filaments_per_metre, layer.filaments.slot(), way)
}

/// The spinlines from which the filaments of the layers come, each with all of its layers.
fn spinlines(spec: &WebSpec) -> Vec<LayerSpinline> {
    let mut found: Vec<(&Case, Vec<usize>)> = Vec::new();
    for (layer, LayerSpec { source, .. }) in spec.layers.iter().enumerate() {
        let Some(case) = source.case().filter(|case| case.spinline.is_some()) else { continue };
        let same = |known: &Case| known.spinline == case.spinline && known.drag.along == case.drag.along;
        match found.iter_mut().find(|(known, _)| same(known)) {
            Some((_, layers)) => layers.push(layer),
            None => found.push((case, vec![layer])),
        }
    }
    let solved = |(number, (case, layers)): (usize, (&Case, Vec<usize>))| {
        let results = SpinResults::from_case(case)?;
        let prefix = if number == 0 { SPINLINE.to_owned() } else { format!("{SPINLINE}_{}", number + 1) };
        let figures = spinline_figures(&prefix, &results.rows, &results.influences);
        let throughput = case.spinline.as_ref()?.throughput;
        Some(LayerSpinline { layers, throughput, results, figures })
    };
    found.into_iter().enumerate().filter_map(solved).collect()
}

/// What a reader must know of what was found.
fn notes(simulated: &FlownWeb, findings: &Findings) -> Vec<String> {
    let mut notes: Vec<String> = simulated.warnings(findings).iter().map(ToString::to_string).collect();
    if findings.laid.map.cells.len() > files::MOST_CELLS {
        notes.push(
            "the map is only in map.npy, because it has more cells than a table or a picture can hold"
                .to_owned(),
        );
    }
    notes
}
